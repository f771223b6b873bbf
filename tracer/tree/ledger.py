"""The weight balance of a tree: the camera ray's weight of 1, split into three parts."""

import math
from typing import NamedTuple

import numpy as np

from tracer.choices import MODELS, WHITTED
from tracer.kernel.nodes import BACKGROUND, SHADOW, SURFACE
from tracer.scene import Scene


class Ledger(NamedTuple):
    """The three shares add up to 1, up to rounding."""

    leaves: float  # rays that ended: on opaque surfaces, in the background
    cut: float  # rays that were not followed
    absorbed: float  # weight that surfaces on the way absorbed


def make_ledger(nodes: np.ndarray, residual: float, scene: Scene, model: str) -> Ledger:
    """The ledger of a node table. Weights count by their largest component; each sum is rounded once."""
    rays = nodes[nodes["kind"] != SHADOW]
    weights = rays["weight"].max(axis=1)
    ended = np.isin(rays["end"], (SURFACE, BACKGROUND))
    absorbed = np.array([_absorbed(scene, model, row) for row in rays[~ended]])
    return Ledger(math.fsum(weights[ended]), residual, math.fsum(weights[~ended] * absorbed))


def _absorbed(scene: Scene, model: str, row: np.void) -> float:
    """The fraction of a ray's weight that the surface absorbs."""
    item = scene.objects[row["object"]]
    material = item.material
    straight_on = material.transmit > 0.0 and row["n1"] == row["n2"] and not item.thin
    if straight_on and model == MODELS[WHITTED]:
        return 1.0 - material.transmit
    return 1.0 - material.reflect - material.transmit
