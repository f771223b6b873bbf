"""Random ray trees of any form: tables made up, not traced, because scenes give too few forms."""

import random

import numpy as np

import tracer
from tests.scenes import box
from tracer.kernel.nodes import (
    BACKGROUND,
    BLOCKED,
    CAMERA,
    DEPTH,
    LIT,
    NONE,
    PUBLIC,
    REFLECTION,
    REFRACTION,
    SHADOW,
    SURFACE,
    TIR,
)
from tracer.scene import Light, Material, Scene
from tracer.tree.margins.margins import Details
from tracer.tree.raytree import RayTree

BOTH = (REFLECTION, REFRACTION)
NAMES = ("a", "ball", "glass ball", "a name that is too long for any box")


def random_tree(seed: int, most: int, lights: int, depth: int) -> RayTree:
    """At most `most` hits, level by level as the tracer has them, each with a shadow ray to every light."""
    dice = random.Random(seed)
    bushy = dice.uniform(0.1, 1.0)
    glass = Material("glass", transmit=0.5, reflect=0.5)
    objects = tuple(box((k, 0, 0), (k + 1, 1, 1), glass, name=name) for k, name in enumerate(NAMES))
    scene = Scene(objects, lights=tuple(Light(f"lamp {j}", position=(0.0, 9.0, j)) for j in range(lights)))
    rows: list[dict] = [{"parent": NONE, "kind": CAMERA, "depth": 0, "weight": 1.0, "factor": 1.0}]
    level, hits = [0], 1
    while level:
        for i in level:
            rows[i]["object"] = dice.randrange(len(NAMES)) if dice.random() < 0.95 else NONE
            if rows[i]["object"] == NONE:
                rows[i]["end"] = BACKGROUND
                continue
            for j in range(lights):
                end = dice.choice((LIT, BLOCKED))
                stub = {"parent": i, "kind": SHADOW, "depth": rows[i]["depth"], "factor": 1.0, "light": j, "end": end}
                rows.append(stub | {"object": 0 if end == BLOCKED else NONE})
        below = []
        for i in level:
            if rows[i]["object"] == NONE:
                continue
            if rows[i]["depth"] == depth:
                rows[i]["end"] = DEPTH
                continue
            kinds = BOTH if dice.random() < bushy else dice.choice(((), (REFLECTION,), (REFRACTION,), (TIR,)))
            if not kinds or hits + len(kinds) > most:
                rows[i]["end"] = SURFACE
                continue
            for kind in kinds:
                factor = dice.choice((1.0, 0.5, 0.0823, 0.9)) / len(kinds)
                below.append(len(rows))
                depth_below, weight = rows[i]["depth"] + 1, rows[i]["weight"] * factor
                rows.append({"parent": i, "kind": kind, "depth": depth_below, "weight": weight, "factor": factor})
            hits += len(kinds)
        level = below
    nodes = np.zeros(len(rows), PUBLIC)
    for name in ("t", "n1", "n2", "theta1", "theta2", "radicand", "error", "turn"):
        nodes[name] = np.nan
    nodes["light"] = nodes["end"] = NONE
    nodes["normal"] = nodes["direction"] = (0.0, 0.0, 1.0)
    for i, row in enumerate(rows):
        nodes["id"][i] = i
        for name, value in row.items():
            nodes[name][i] = value
    nodes["t"] = 1.0
    count = len(nodes)
    none, zero = np.full(count, -1), np.zeros(count)
    nothing = Details(none, none, zero, nodes["normal"], zero)
    return RayTree(tracer.prepare(scene), nodes, nothing, 0.0, depth, "whitted", (0, 0), (640, 480))
