"""Two linked tori of smooth patches above a checkered floor: each corner has the normal of the true surface."""

import math

import numpy as np

from benchmarks.scenes.entities import face, fill, light, patch, text, view

RADIUS = 1.5  # of the circle in a torus
TUBE = 0.5
TILES = 6


def patches(round_: int = 48, across: int = 24) -> str:
    """2 round_ across patches, and TILES^2 / 2 squares of the floor in either colour."""
    lines = [
        view((3.4, 5.6, 4.0), (0.0, 0.0, -0.1), (0.0, 0.0, 1.0), 42.0),
        light((-3.0, 10.0, 12.0)),
        light((11.0, 5.0, 9.0)),
    ]
    for odd, color in enumerate(((0.9, 0.9, 0.9), (0.5, 0.15, 0.1))):
        lines.append(fill(color, 0.5, mirror=0.3, shine=10.0))
        lines += [tile(i, j) for i in range(TILES) for j in range(TILES) if (i + j) % 2 == odd]
    lying = (np.array([-0.75, 0.0, 0.0]), np.eye(3))
    standing = (np.array([0.75, 0.0, 0.0]), np.array([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)]))
    for (center, turn), color in ((lying, (0.9, 0.75, 0.4)), (standing, (0.5, 0.7, 0.9))):
        lines.append(fill(color, 0.5, mirror=0.5, shine=20.0))
        lines += torus(center, turn, round_, across)
    return text(lines)


def tile(i: int, j: int) -> str:
    side, low = 8.0 / TILES, -4.0
    x, y, z = low + side * i, low + side * j, -RADIUS - TUBE
    return face([(x, y, z), (x + side, y, z), (x + side, y + side, z), (x, y + side, z)])


def torus(center: np.ndarray, turn: np.ndarray, round_: int, across: int) -> list[str]:
    """Patches counter-clockwise seen from outside."""
    u = 2.0 * math.pi * np.arange(round_ + 1)[:, None] / round_
    v = 2.0 * math.pi * np.arange(across + 1)[None, :] / across
    out = np.stack([np.cos(u) + 0 * v, np.sin(u) + 0 * v, 0 * u + 0 * v], axis=-1)
    normals = np.cos(v)[..., None] * out + np.sin(v)[..., None] * np.array([0.0, 0.0, 1.0])
    points = center + (RADIUS * out + TUBE * normals) @ turn
    normals = normals @ turn
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    return [
        patch([points[i + a, j + b] for a, b in corners], [normals[i + a, j + b] for a, b in corners])
        for i in range(round_)
        for j in range(across)
    ]
