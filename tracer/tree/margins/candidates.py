"""Pairs of rays and surfaces that a decision may hang on: the ray passes the surface's box no farther than REACH times
its own error.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tracer.formulas.double_double import U

REACH = 1e6  # larger margins are not worked out
OWN = 24.0  # rounding errors of tests of a ray against surfaces, relative to the distances, in u
GROUP = 64  # surfaces whose boxes are first tested together
MOST = 1 << 20  # pairs that are tested at a time


class Rays(NamedTuple):
    """Rays with the errors of their numbers, one entry each."""

    row: np.ndarray  # in the node table
    o: np.ndarray  # (n, 3)
    d: np.ndarray  # (n, 3)
    end: np.ndarray  # distance to the hit, or to the light; inf for none
    off: np.ndarray  # error of the origin
    turn: np.ndarray  # error of the direction, radians
    size: np.ndarray  # of the numbers that the origin was computed from

    def error(self, k: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Bound on the sideways error of rays k at distance t."""
        t = np.abs(t)
        return self.off[k] + t * self.turn[k] + OWN * U * (self.size[k] + t)


def pairs(rays: Rays, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(indices of rays, ids of surfaces) of all pairs. `boxes` (m, 2, 3) may be infinite."""
    starts = np.arange(0, len(boxes), GROUP)
    if len(starts) == 0 or len(rays.row) == 0:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    groups = np.stack([np.minimum.reduceat(boxes[:, 0], starts), np.maximum.reduceat(boxes[:, 1], starts)], axis=1)
    found = []
    for ray, group in in_parts(len(rays.row), len(groups)):
        near = may_pass(rays, ray, groups[group])
        ray, first = ray[near], group[near] * GROUP
        ray, surface = np.repeat(ray, GROUP), (first[:, None] + np.arange(GROUP)).ravel()
        ray, surface = ray[surface < len(boxes)], surface[surface < len(boxes)]
        near = may_pass(rays, ray, boxes[surface])
        found.append((ray[near], surface[near]))
    return np.concatenate([part[0] for part in found]), np.concatenate([part[1] for part in found])


def in_parts(rays: int, groups: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """All pairs of a ray and a group, some at a time."""
    step = max(1, MOST // (groups * GROUP))
    for first in range(0, rays, step):
        some = np.arange(first, min(first + step, rays))
        yield np.repeat(some, groups), np.tile(np.arange(groups), len(some))


def may_pass(rays: Rays, k: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Whether ray k[j] passes box j, enlarged by REACH times its error, between its origin and its end."""
    o, d = rays.o[k], rays.d[k]
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        far = np.maximum(np.abs(boxes[:, 0] - o), np.abs(boxes[:, 1] - o)).sum(axis=1)
        wide = REACH * rays.error(k, np.minimum(far, rays.end[k]))[:, None]
        one, other = (boxes[:, 0] - wide - o) / d, (boxes[:, 1] + wide - o) / d
        enter = np.nan_to_num(np.minimum(one, other), nan=-np.inf, posinf=np.inf, neginf=-np.inf).max(axis=1)
        leave = np.nan_to_num(np.maximum(one, other), nan=np.inf, posinf=np.inf, neginf=-np.inf).min(axis=1)
    return (enter <= leave) & (leave >= -wide[:, 0]) & (enter <= rays.end[k] + wide[:, 0])
