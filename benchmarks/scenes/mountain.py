"""A fractal mountain of small triangles, and four glass balls above it.

Heights by midpoint displacement: every new point is the mean of its neighbours plus a random number that shrinks
with the distance (Fournier, Fussell & Carpenter, "Computer Rendering of Stochastic Models", CACM 25(6), 1982; here
by diamonds and squares).
"""

import numpy as np

from benchmarks.scenes.entities import ball, face, fill, light, text, view

ROUGHNESS = 0.5  # factor of the random part at half the distance
RADIUS = 0.17


def mountain(cells: int = 64, seed: int = 1987) -> str:
    """cells x cells squares of two triangles; `cells` is a power of two."""
    z = heights(cells, np.random.default_rng(seed))
    x = np.linspace(-1.0, 1.0, cells + 1)
    points = np.stack([*np.meshgrid(x, x, indexing="ij"), z], axis=-1)
    lines = [
        view((-1.7, 1.7, 1.6), (0.0, 0.0, 0.1), (0.0, 0.0, 1.0), 44.0),
        light((-100.0, -100.0, 100.0)),
        fill((1.0, 1.0, 1.0), 0.1, mirror=0.1, shine=100.0, transmit=0.9, ior=1.5),
    ]
    lines += [ball(center, RADIUS) for center in glass()]
    lines.append(fill((0.5, 0.45, 0.35), 1.0))
    for i in range(cells):
        for j in range(cells):
            a, b, c, d = points[i, j], points[i + 1, j], points[i + 1, j + 1], points[i, j + 1]
            lines += [face((a, b, c)), face((a, c, d))]
    return text(lines)


def glass() -> np.ndarray:
    """Four balls at the corners of a regular tetrahedron, with gaps between them."""
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
    return np.array([-0.75, 0.75, 1.0]) + 0.15 * corners


def heights(cells: int, random: np.random.Generator) -> np.ndarray:
    """A periodic surface (cells + 1, cells + 1), highest in the middle."""
    z = np.zeros((cells, cells))
    step, swing = cells, 0.5
    while step > 1:
        half = step // 2
        corners = z[::step, ::step]
        middle = mean_of(corners, np.roll(corners, -1, 0), np.roll(corners, -1, 1), np.roll(corners, -1, (0, 1)))
        z[half::step, half::step] = middle = middle + swing * random.normal(size=middle.shape)
        across = mean_of(corners, np.roll(corners, -1, 0), middle, np.roll(middle, 1, 1))
        along = mean_of(corners, np.roll(corners, -1, 1), middle, np.roll(middle, 1, 0))
        swing *= ROUGHNESS
        z[half::step, ::step] = across + swing * random.normal(size=across.shape)
        z[::step, half::step] = along + swing * random.normal(size=along.shape)
        step = half
    z = np.pad(z, ((0, 1), (0, 1)), mode="wrap")
    hill = np.sin(np.linspace(0.0, np.pi, cells + 1))
    return 0.35 * (z - z.min()) / np.ptp(z) + 0.55 * np.outer(hill, hill) ** 2 - 0.2


def mean_of(*parts: np.ndarray) -> np.ndarray:
    return np.mean(parts, axis=0)
