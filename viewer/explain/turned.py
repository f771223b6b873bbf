"""A hit as it would be at another angle of incidence: the same place and the same media, met by a ray given by hand."""

import math
from dataclasses import replace

import numpy as np

import tracer
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree

STEEPEST = 89.0  # degrees: beyond, the ray grazes the surface
SHARES = (1e-3, 1e-6)  # of the ray's length: how far from the hit the turned ray starts, so that nothing is in its way


def turned(world: World, tree: RayTree, row: int, angle: float) -> RayTree | None:
    """The tree of a ray that meets the surface at the hit of `row`, in its plane of incidence, at this angle from the
    normal in degrees, 0 to STEEPEST. It is of the kind of the traced ray. The tree is as deep as that below the hit,
    but has the rays that the hit sends out.

    None if there is no such ray: another surface is too near.
    """
    hit = tree.nodes[row]
    point, normal, direction = hit["point"], hit["normal"], hit["direction"]
    along = direction - float(direction @ normal) * normal
    length = float(np.linalg.norm(along))
    # At normal incidence every plane through the normal is one of incidence.
    along = along / length if length > 0.0 else _across(normal)
    theta = math.radians(angle)
    towards = math.sin(theta) * along - math.cos(theta) * normal
    for share in SHARES:
        away = share * float(hit["t"])
        depth = max(1, tree.depth - int(hit["depth"]))
        found = tracer.trace(world, ray=(point - away * towards, towards), depth=depth, model=tree.model)
        met = found.nodes[0]
        if met["object"] == hit["object"] and np.linalg.norm(met["point"] - point) <= _rounding(hit, met):
            nodes = found.nodes.copy()
            nodes["kind"][0] = hit["kind"]
            nodes.flags.writeable = False
            return replace(found, nodes=nodes)
    return None


def _across(normal: np.ndarray) -> np.ndarray:
    """A unit vector at right angles to the normal."""
    axis = np.zeros(3)
    axis[int(np.argmin(np.abs(normal)))] = 1.0
    across = np.cross(normal, axis)
    return across / np.linalg.norm(across)


def _rounding(hit: np.void, met: np.void) -> float:
    """The largest distance of two hits that are one but for rounding: of both, and of the start of the turned ray,
    which moves its hit along the surface by up to 1 / cos(theta1) times as much.
    """
    start = 4.0 * np.finfo(float).eps * float(np.abs(hit["point"]).max())
    return float(hit["error"] + met["error"]) + start / math.cos(float(met["theta1"]))
