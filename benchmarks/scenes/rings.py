"""Chain mail: rings of short rods with a ball at every joint, each tilted and threaded through its neighbours."""

import math

import numpy as np

from benchmarks.scenes.entities import ball, fill, floor, light, rod, text, view

JOINTS = 24
WIRE = 0.08  # of a ring's radius
APART = 1.25  # distance of neighbouring rings in ring radii: less than two, so that they are linked
TILT = math.radians(35.0)


def rings(count: int = 13) -> str:
    """count x count rings. Every other row is shifted by half a step, so that rings do not intersect."""
    middle = 0.5 * APART * (count - 1)
    lines = [
        view((0.1 * middle, -2.5 * middle, 2.1 * middle), (0.0, -0.1 * middle, 0.0), (0.0, 0.0, 1.0), 41.0),
        light((-2.0 * middle, -3.0 * middle, 4.0 * middle)),
        light((3.0 * middle, -1.0 * middle, 3.0 * middle)),
        fill((0.8, 0.8, 0.85), 0.7, mirror=0.2, shine=10.0),
        floor(2.0 * middle, -1.0),
    ]
    for i in range(count):
        for j in range(count):
            here = np.array([APART * (i + 0.5 * (j % 2)) - middle, APART * j - middle, 0.0])
            lines.append(fill((0.9, 0.6 + 0.3 * (i % 2), 0.3 + 0.4 * (j % 2)), 0.4, mirror=0.4, shine=20.0))
            lines += ring(here, TILT if (i + j) % 2 else -TILT)
    return text(lines)


def ring(center: np.ndarray, tilt: float) -> list[str]:
    """A ring of radius 1, rotated about the x axis."""
    turns = 2.0 * math.pi * np.arange(JOINTS) / JOINTS
    circle = np.stack([np.cos(turns), math.cos(tilt) * np.sin(turns), math.sin(tilt) * np.sin(turns)], axis=1)
    places = center + circle
    balls = [ball(place, 1.5 * WIRE) for place in places]
    rods = [rod(start, end, WIRE) for start, end in zip(places, np.roll(places, -1, axis=0), strict=True)]
    return balls + rods
