"""Group B, meshes: no ray passes between two triangles, and none meets both of them."""

import math
import random
from collections.abc import Iterator, Sequence

import numpy as np

from tracer.measure.check import textbook
from tracer.measure.check.case import Reading, case, exactly
from tracer.measure.check.scenes import DARK, glass, path, world
from tracer.scene import Object
from tracer.shapes.mesh import Geometry, Mesh


def sphere_mesh(rings: int = 16, sectors: int = 32, radius: float = 2.0) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a closed ball of triangles."""
    points = [(0.0, radius, 0.0)]
    for i in range(1, rings):
        for j in range(sectors):
            a, b = math.pi * i / rings, 2.0 * math.pi * j / sectors
            points.append(
                (radius * math.sin(a) * math.cos(b), radius * math.cos(a), radius * math.sin(a) * math.sin(b))
            )
    points.append((0.0, -radius, 0.0))
    last, faces = len(points) - 1, []
    for j in range(sectors):
        k = (j + 1) % sectors
        faces += [(0, 1 + k, 1 + j), (last, last - sectors + j, last - sectors + k)]
        for i in range(rings - 2):
            a, b = 1 + i * sectors, 1 + (i + 1) * sectors
            faces += [(a + j, a + k, b + j), (a + k, b + k, b + j)]
    return np.array(points), np.array(faces)


@case("B1", "no gap in a closed mesh: rays from inside, at corners and edges", seconds=0.6)
def closed() -> Iterator[Reading]:
    """Moeller and Trumbore's test computes u and v of every triangle by itself. On a shared edge, each of the two
    neighbours may be rounded to just outside, -1e-17, and the ray passes through the crack: about one in ten of
    those aimed at corners and edges. Ours gives a corner the same two numbers for every triangle. The textbook's
    test is slow in Python, so it is run for the first 100 rays only (marked *).
    """
    points, faces = sphere_mesh()
    scene = world(Object(Mesh(Geometry(points, faces)), DARK, "mesh"))
    chance = random.Random(1)
    for aimed, rays in (("anywhere", 200), ("at corners", 800), ("at edges", 800)):
        missed = missed_usual = 0
        for ray in range(rays):
            origin = [chance.uniform(-1, 1) for _ in range(3)]
            face = faces[chance.randrange(len(faces))]
            a, b, c = (points[k].tolist() for k in face)
            u, v = chance.random(), chance.random()
            if aimed == "at corners":
                u = v = 0.0
            elif aimed == "at edges":
                v = 0.0
            elif u + v > 1.0:
                u, v = 1.0 - u, 1.0 - v
            aim = [a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]) - origin[k] for k in range(3)]
            row = path(scene, origin, aim).nodes[0]
            missed += row["object"] < 0
            if ray < 100:
                missed_usual += not textbook_hits(origin, row["direction"].tolist(), points, faces, face)
        yield exactly(f"missed of {rays} {aimed} *", 0, int(missed), missed_usual)


def textbook_hits(
    origin: Sequence[float], direction: Sequence[float], points: np.ndarray, faces: np.ndarray, face: np.ndarray
) -> bool:
    """Whether any face is hit. The faces beside the one that is aimed at are tested first."""
    beside = np.isin(faces, face).any(axis=1)
    return any(
        textbook.triangle(origin, direction, points[corners].tolist()) < math.inf
        for some in (faces[beside], faces[~beside])
        for corners in some
    )


@case("B3", "along the diagonals of a cube of 12 triangles")
def parity() -> Iterator[Reading]:
    # A cube of 12 triangles. Every ray passes through the diagonals of two faces.
    """A ray that meets the diagonal of a face meets both of its triangles, at the same distance. A program that takes
    each as a surface counts the face twice: inside and outside are exchanged, or glass is entered twice. Here,
    surfaces at the same distance to the last bit are one interface.
    """
    points = np.array([(x, y, z) for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    faces = np.array([side for a, b, c, d in quads for side in ((a, b, c), (a, c, d))])
    scene = world(Object(Mesh(Geometry(points, faces)), glass(1.0), "cube"))
    crossings, usual, right = 0, 0, 0
    for k in range(-15, 16):
        origin = (k / 16, k / 16, -3.0)
        t = path(scene, origin, (0, 0, 1), depth=4).nodes["t"]
        met = t[np.isfinite(t)]
        crossings += len(met)
        right += bool(np.array_equal(met, (2.0, 2.0)))
        usual += sum(textbook.triangle(origin, (0, 0, 1), points[face].tolist()) < math.inf for face in faces)
    yield exactly("31 rays: faces of the cube met", 62, crossings, usual)
    yield exactly("31 rays: 2 to the cube and 2 through it, to the bit", 31, right)
