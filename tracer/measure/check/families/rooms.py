"""Families of closed rooms of mirrors: no ray that is aimed at an edge or a corner leaves."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tracer.formulas.vector import Vector, scale, subtract
from tracer.kernel.world import World
from tracer.measure.check.case import Reading, case, exactly
from tracer.measure.check.draws import Draws, perpendicular, plus
from tracer.measure.check.exact_shapes import Tube
from tracer.measure.check.scenes import MIRROR, box, paths, world
from tracer.measure.check.textbook_shapes import Wall, box_walls, leaves, mesh_walls, tube_walls
from tracer.scene import Object
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.polygon import Polygon

BOUNCES = 4
OFFSET = 1e-4  # the textbook's smallest distance and offset, in sizes of the room

# The corners of a box are numbered 4x + 2y + z. Its faces are counter-clockwise seen from outside.
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
EDGES = [(a, b) for a in range(8) for b in range(a) if (a ^ b) in (1, 2, 4)]


class Room(NamedTuple):
    scenes: Sequence[World]  # the same room in different shapes
    walls: Sequence[Wall]  # the textbook's
    size: float
    eyes: Sequence[Vector]
    targets: Sequence[Vector]


def extents(chance: Draws, size: float) -> Vector:
    return (size * chance.size(-1, 0), size * chance.size(-1, 0), size * chance.size(-1, 0))


def blend(low: Sequence[float], high: Sequence[float], shares: Sequence[float]) -> Vector:
    x, y, z = (a if s == 0.0 else b if s == 1.0 else a + s * (b - a) for a, b, s in zip(low, high, shares, strict=True))
    return (x, y, z)


def inside(low: Vector, sides: Sequence[Vector], shares: Sequence[float]) -> Vector:
    """A point of a box with one corner and three edges given."""
    return plus(low, *(scale(share, side) for share, side in zip(shares, sides, strict=True)))


def aims(chance: Draws, corners: Sequence[Vector], count: int) -> Iterator[Vector]:
    """Corners, and points of edges up to rounding."""
    for k in range(count):
        a, b = chance.choice(EDGES)
        share = chance.random() if k % 2 else 0.0
        yield blend(corners[a], corners[b], (share, share, share))


def inner(chance: Draws) -> Vector:
    return (chance.uniform(0.1, 0.9), chance.uniform(0.1, 0.9), chance.uniform(0.1, 0.9))


def boxes(chance: Draws, rooms: int, rays: int) -> Iterator[Room]:
    """Boxes parallel to the axes. The points that are aimed at lie on edges exactly; directions are rounded."""
    for _ in range(rooms):
        size = chance.size(-6, 6)
        low = chance.place(size * chance.size(-3, 3))
        high = plus(low, extents(chance, size))
        corners = [blend(low, high, (k >> 2 & 1, k >> 1 & 1, k & 1)) for k in range(8)]
        eyes = [blend(low, high, inner(chance)) for _ in range(rays)]
        stage = world(box(low, high, MIRROR))
        yield Room([stage], box_walls(low, high, OFFSET * size), size, eyes, list(aims(chance, corners, rays)))


def turned(chance: Draws, rooms: int, rays: int) -> Iterator[Room]:
    """Rotated boxes, as a mesh of twelve triangles and as six polygons."""
    for _ in range(rooms):
        size = chance.size(-6, 6)
        low = chance.place(size * chance.size(-3, 3))
        sides = [scale(e, axis) for e, axis in zip(extents(chance, size), chance.frame(), strict=True)]
        corners = [inside(low, sides, (k >> 2 & 1, k >> 1 & 1, k & 1)) for k in range(8)]
        faces = [three for a, b, c, d in QUADS for three in ((a, b, c), (a, c, d))]
        mesh = Mesh(Geometry(np.array(corners), np.array(faces)))
        polygons = [Polygon(tuple(corners[k] for k in quad)) for quad in QUADS]
        scenes = [
            world(Object(mesh, MIRROR)),
            world(*(Object(one, MIRROR, f"wall {k}") for k, one in enumerate(polygons))),
        ]
        walls = mesh_walls([[corners[k] for k in face] for face in faces], OFFSET * size)
        eyes = [inside(low, sides, inner(chance)) for _ in range(rays)]
        yield Room(scenes, walls, size, eyes, list(aims(chance, corners, rays)))


def drums(chance: Draws, kind: str, rooms: int, rays: int) -> Iterator[Room]:
    """Closed cylinders, frustums, or cones with a tip; the points that are aimed at lie on a rim or at the tip, up to
    rounding.
    """
    for _ in range(rooms):
        radius = chance.size(-6, 6)
        base, axis = chance.place(radius * chance.size(-3, 3)), chance.direction()
        length = radius * chance.size(-1, 1)
        narrowing = {"cylinders": 1.0, "cones": 0.0}.get(kind)
        narrow = radius * (chance.size(-1, 0) if narrowing is None else narrowing)
        shape = Tube(base, radius, plus(base, scale(length, axis)), narrow)
        eyes, targets = [], []
        for _ in range(rays):
            out, aside = (perpendicular(axis, chance.direction()) for _ in range(2))
            share = chance.uniform(0.1, 0.9)
            beside = chance.uniform(0.0, 0.8) * (shape.base_radius * (1.0 - share) + shape.apex_radius * share)
            eyes.append(plus(base, scale(share * length, axis), scale(beside, aside)))
            center, rim = chance.choice(((shape.base, shape.base_radius), (shape.apex, shape.apex_radius)))
            targets.append(plus(center, scale(rim, out)))
        size = min(shape.apex_radius or radius, length)
        scene = world(Object(Cone(*shape, closed=True), MIRROR))
        yield Room([scene], tube_walls(shape, OFFSET * size), size, eyes, targets)


def escapes(rooms: Iterator[Room], names: Sequence[str]) -> Iterator[Reading]:
    """The number of rays that leave after any of the first bounces, for each shape of the rooms."""
    found, usual, count = np.zeros(len(names), int), 0, 0
    for room in rooms:
        ways = [subtract(target, eye) for eye, target in zip(room.eyes, room.targets, strict=True)]
        for k, scene in enumerate(room.scenes):
            trees = paths(scene, room.eyes, ways, depth=BOUNCES)
            gone = np.flatnonzero(trees.nodes["object"] < 0)
            found[k] += len(np.unique(np.searchsorted(trees.starts, gone, "right")))
        start = paths(room.scenes[0], room.eyes, ways).hits["direction"].tolist()
        for eye, way in zip(room.eyes, start, strict=True):
            usual += leaves(eye, way, room.walls, BOUNCES, OFFSET * room.size)
        count += len(ways)
    for name, ours in zip(names, found.tolist(), strict=True):
        yield exactly(f"{name}: leave, of {count} rays", 0, ours, usual)


@case("B11", "rooms of mirrors: no ray leaves through an edge or a corner", seconds=0.3)
def any_room() -> Iterator[Reading]:
    """At a corner three walls are met at once. A ray that was moved off one wall is behind another one, or so close to
    it that the smallest distance discards the hit, and leaves the room at its second or third bounce. Of rotated
    triangles, each tests its edges by itself, and rays pass between two of them. The textbook's offset and smallest
    distance are a ten-thousandth of the room here, so that small rooms are not lost altogether.
    """
    yield from escapes(boxes(Draws(31), 50, 20), ["boxes"])
    yield from escapes(turned(Draws(32), 30, 10), ["rotated meshes", "rotated polygons"])


@case("K3", "closed cylinders, frustums and cones of mirrors: no ray leaves through a rim or a tip", seconds=0.4)
def any_drum() -> Iterator[Reading]:
    """At a rim the quadratic's hit lies beyond the end by a rounding error, and the disc's hit beyond the radius: both
    are discarded. After a bounce, the start that was moved off the side is in front of the end by less than the
    smallest distance. At the tip of a cone the normal is all rounding, and with it the side on which the ray goes on.
    """
    yield from escapes(drums(Draws(33), "cylinders", 50, 20), ["cylinders"])
    yield from escapes(drums(Draws(34), "frustums", 25, 20), ["frustums"])
    yield from escapes(drums(Draws(35), "cones", 25, 20), ["cones with a tip"])
