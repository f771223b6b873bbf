"""A hit as it would be at another angle of incidence: the same place and the same media, met by a ray given by hand."""

import math
from dataclasses import replace

import numpy as np

import tracer
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree

NORMAL_INCIDENCE = 1e-14  # radians: below this angle rounding decides on the plane of incidence
SHARES = (1e-3, 1e-6)  # of the ray's length: how far from the hit the turned ray starts, so that nothing is in its way


def turned(world: World, tree: RayTree, row: int, angle: float) -> RayTree | None:
    """The tree of a ray that meets the surface at the hit of `row`, in its plane of incidence, at this angle from the
    normal in degrees, 0 to STEEPEST_INCIDENCE (`viewer.base.values`). It is of the kind of the traced ray. The tree is
    as deep as that below the hit, but has the rays that the hit sends out.

    None if there is no such ray: another surface is too near.
    """
    hit = tree.nodes[row]
    point, normal, direction = hit["point"], hit["normal"], hit["direction"]
    theta = math.radians(angle)
    towards = math.sin(theta) * along_surface(direction, normal) - math.cos(theta) * normal
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


def along_surface(direction: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The unit vector in the surface and the plane of incidence, to where a ray of this direction runs.

    At normal incidence, every plane through the normal is one of incidence, and the vector is one of any of them.
    """
    along = direction - (direction @ normal) * normal
    if np.linalg.norm(along) < NORMAL_INCIDENCE:
        along = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    return along / np.linalg.norm(along)


def _rounding(hit: np.void, met: np.void) -> float:
    """The largest distance of two hits that are one but for rounding: of both, and of the start of the turned ray,
    which moves its hit along the surface by up to 1 / cos(theta1) times as much.
    """
    start = 4.0 * np.finfo(float).eps * float(np.abs(hit["point"]).max())
    return float(hit["error"] + met["error"]) + start / math.cos(float(met["theta1"]))
