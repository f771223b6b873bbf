"""What can be missing from a tree that was cut: a bound that holds for every scene, and the ledger of its weights.

Let every hit's local term be at most L and the factors of the rays it sends out add up to at most s < 1. Then no ray
brings more than B = max(background, L / (1 - s)), for L + s B <= B. So a tree lacks at most residual * B: the weights
that were cut, each with the most light its ray could have brought. Where s reaches 1 and something shines, light may
add up without end and nothing bounds it. (Hall & Greenberg, IEEE CG&A 3(8), 1983, cut rays by weight; one weight is no
bound, their sum is.)
"""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tracer.kernel.nodes import BACKGROUND, SHADOW, SURFACE
from tracer.scene import Material, Scene

if TYPE_CHECKING:
    from tracer.tree.raytree import RayTree


def radiance_bound(scene: Scene) -> float:
    """B: the most that any ray of this scene can bring, in its largest component; infinite where nothing bounds it."""
    materials = {item.material for item in scene.objects}
    shining = max((local_bound(scene, material) for material in materials), default=0.0)
    passed_on = max((material.reflect + material.transmit for material in materials), default=0.0)
    background = max(scene.background.color)
    if passed_on < 1.0:
        return max(background, shining / (1.0 - passed_on))
    if shining > 0.0 or (passed_on > 1.0 and background > 0.0):
        return math.inf
    return background


def local_bound(scene: Scene, material: Material) -> float:
    """The most that a surface of this material can send out by itself: every light facing it, every highlight met."""
    colors = [material.color] + ([material.checker.color] if material.checker else [])
    most = 0.0
    for k in range(3):
        color = max(color[k] for color in colors)
        light = sum(light.color[k] for light in scene.lights)
        ambient = scene.tracing.ambient[k] * material.ambient * color
        most = max(most, ambient + light * (material.diffuse * color + material.specular))
    return most


class Ledger(NamedTuple):
    """Where a tree's weight of 1 went; the three add up to 1 but for rounding."""

    leaves: float  # rays that ended: on opaque surfaces, in the background
    cut: float  # rays that were not followed
    absorbed: float  # what surfaces on the way kept for themselves


def ledger(tree: "RayTree") -> Ledger:
    """Weights by their largest component, each sum rounded once."""
    nodes = tree.nodes[tree.nodes["kind"] != SHADOW]
    weights = nodes["weight"].max(axis=1)
    ended = np.isin(nodes["end"], (SURFACE, BACKGROUND))
    kept = np.array([_absorbed(tree, row) for row in nodes[~ended]])
    return Ledger(math.fsum(weights[ended]), tree.residual, math.fsum(weights[~ended] * kept))


def _absorbed(tree: "RayTree", row: np.void) -> float:
    """The share that a surface passes on to no ray."""
    item = tree.scene.objects[row["object"]]
    material = item.material
    if material.transmit > 0.0 and row["n1"] == row["n2"] and not item.thin:
        return 1.0 - material.transmit
    return 1.0 - material.reflect - material.transmit
