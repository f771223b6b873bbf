"""Sphereflake: a mirror ball with nine balls of a third of its radius on it, each of those with nine, and so on.

The nine are placed as in the closest packing of equal balls (six around the middle, three on top), so that they do
not intersect and the side towards the parent is free. Level L has 9^L balls.
"""

import math
from collections.abc import Iterator

import numpy as np

from benchmarks.scenes.entities import ball, fill, floor, light, text, view

SHRINK = 1.0 / 3.0


def sphereflake(level: int = 4, size: tuple[int, int] = (512, 512)) -> str:
    return text(
        [
            view((2.2, 1.4, 1.6), (0.0, 0.0, 0.05), (0.0, 0.0, 1.0), 42.0, size),
            *(light(place) for place in ((4.0, 3.0, 2.0), (1.0, -4.0, 4.0), (-3.0, 1.0, 5.0))),
            fill((1.0, 0.8, 0.4), 0.8),
            floor(12.0, -0.5),
            fill((1.0, 0.9, 0.7), 0.5, mirror=0.5, shine=5.0),
            *(ball(center, radius) for center, radius in flake(np.zeros(3), 0.5, np.eye(3), level)),
        ]
    )


def flake(center: np.ndarray, radius: float, frame: np.ndarray, level: int) -> Iterator[tuple[np.ndarray, float]]:
    """(centre, radius) of a ball and of all that grow on it. The frame's last row points away from the parent."""
    yield center, radius
    if level == 0:
        return
    for direction in NINE @ frame:
        away = center + radius * (1.0 + SHRINK) * direction
        yield from flake(away, SHRINK * radius, frame_along(direction), level - 1)


def around(count: int, polar: float, start: float) -> np.ndarray:
    turns = start + 2.0 * math.pi * np.arange(count) / count
    level = np.full(count, math.cos(polar))
    return np.stack([math.sin(polar) * np.cos(turns), math.sin(polar) * np.sin(turns), level], axis=1)


NINE = np.concatenate([around(6, math.pi / 2, 0.0), around(3, math.asin(1.0 / math.sqrt(3.0)), math.pi / 6)])


def frame_along(z: np.ndarray) -> np.ndarray:
    """Three orthogonal unit vectors, as rows; the last one is z."""
    aside = np.eye(3)[np.abs(z).argmin()]
    x = np.cross(aside, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])
