"""A cubic lattice: a ball at every point of a cube with integer coordinates, rods along its edges."""

import numpy as np

from benchmarks.scenes.entities import ball, fill, light, rod, text, view

BALL = 0.2
ROD = 0.05


def lattice(side: int = 9) -> str:
    """side^3 balls and 3 side^2 (side - 1) rods."""
    far = float(side - 1)
    middle = 0.5 * far * np.ones(3)
    lines = [
        view(middle + far * np.array([1.15, 0.85, 1.0]), middle, (0.0, 0.0, 1.0), 50.0),
        light(middle + far * np.array([2.0, -1.0, 3.0])),
        light(middle + far * np.array([0.5, 3.0, 1.0])),
        fill((0.9, 0.5, 0.3), 0.5, mirror=0.5, shine=20.0),
    ]
    points = list(np.ndindex(side, side, side))
    lines += [ball(point, BALL) for point in points]
    lines.append(fill((0.8, 0.8, 0.9), 0.7, mirror=0.3, shine=10.0))
    for point in points:
        for axis in range(3):
            if point[axis] + 1 < side:
                lines.append(rod(point, np.array(point) + np.eye(3)[axis], ROD))
    return text(lines)
