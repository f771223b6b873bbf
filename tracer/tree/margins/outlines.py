"""Edges, rims, silhouettes and planes of surfaces, on which decisions about hits depend, as arrays by kind."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tracer.kernel.world import World
from tracer.shapes import CODES
from tracer.shapes.cone import CLOSED


class Table(NamedTuple):
    """Items that belong to surfaces, in the order of these: those of the k-th are starts[k] .. starts[k + 1]."""

    surface: np.ndarray  # (m,) ids
    starts: np.ndarray  # (surfaces + 1,)
    columns: tuple[np.ndarray, ...]  # one row for each item

    @staticmethod
    def of(surface: np.ndarray, ids: np.ndarray, *columns: np.ndarray) -> "Table":
        """`surface` are indices of `ids`."""
        order = np.argsort(surface, kind="stable")
        starts = np.searchsorted(surface[order], np.arange(len(ids) + 1))
        return Table(ids[surface[order]], starts, tuple(column[order] for column in columns))


@dataclass(frozen=True, eq=False)
class Outlines:
    """The items of some surfaces of a world."""

    segments: Table  # first end (m, 3), second end (m, 3)
    circles: Table  # centre (m, 3), unit axis (m, 3), radius (m,)
    spheres: Table  # centre, radius
    sides: Table  # of cones: narrow end (m, 3), unit axis, radius there, (cosine, sine, wide radius) (m, 3), height
    planes: Table  # point (m, 3), unit normal (m, 3), its low part (m, 3), whether it is infinite (m,)


def outlines(world: World, surfaces: np.ndarray) -> Outlines:
    """The items of surfaces with these ids."""
    rows = np.asarray(world.arrays.surfaces)[surfaces]
    code = rows["shape_code"]

    def ids(name: str) -> np.ndarray:
        return np.flatnonzero(code == CODES[name])

    ends: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    flats: list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]] = []
    rims: list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]] = []

    def add_planes(surface: np.ndarray, point: np.ndarray, normal: np.ndarray, low: np.ndarray, whole: bool) -> None:
        flats.append((surface, point, normal, low, np.full(len(surface), whole)))

    for name in ("triangle", "polygon", "disc", "plane"):
        s = ids(name)
        add_planes(s, rows["a"][s], rows["normal"][s], rows["normal_low"][s], name == "plane")
    s = ids("triangle")
    corners = np.stack([rows["a"][s], rows["b"][s], rows["c"][s]], axis=1)
    ends += [(s, corners[:, k], corners[:, (k + 1) % 3]) for k in range(3)]
    for s in ids("polygon").tolist():
        first, n = rows["first"][s], rows["count"][s]
        own = np.asarray(world.arrays.corners)[first : first + n]
        ends.append((np.full(n, s), own, np.roll(own, -1, axis=0)))
    s = ids("disc")
    rims.append((s, rows["a"][s], rows["normal"][s], rows["b"][s][:, 0]))
    s = ids("box")
    low, high, nothing = rows["a"][s], rows["b"][s], np.zeros((len(s), 3))
    for k in range(3):
        n = np.tile(np.eye(3)[k], (len(s), 1))
        add_planes(s, low, -n, nothing, False)
        add_planes(s, high, n, nothing, False)
        for one in (low, high):
            for other in (low, high):
                start, end = low.copy(), high.copy()
                start[:, (k + 1) % 3] = end[:, (k + 1) % 3] = one[:, (k + 1) % 3]
                start[:, (k + 2) % 3] = end[:, (k + 2) % 3] = other[:, (k + 2) % 3]
                ends.append((s, start, end))
    s = ids("cone")
    narrow, way, axis = rows["a"][s], rows["normal"][s], rows["b"][s]
    rims.append((s, narrow, axis, rows["r"][s]))
    rims.append((s, narrow + way, axis, rows["c"][s][:, 2]))
    sides = Table.of(s, surfaces, narrow, axis, rows["r"][s], rows["c"][s], np.linalg.norm(way, axis=1))
    shut = rows["count"][s] == CLOSED
    s, narrow, way, axis = s[shut], narrow[shut], way[shut], axis[shut]
    add_planes(s, narrow, -axis, np.zeros_like(axis), False)
    add_planes(s, narrow + way, axis, np.zeros_like(axis), False)
    s = ids("sphere")
    spheres = Table.of(s, surfaces, rows["a"][s], rows["r"][s])
    return Outlines(joined(ends, surfaces), joined(rims, surfaces), spheres, sides, joined(flats, surfaces))


def joined(parts: list[tuple[np.ndarray, ...]], surfaces: np.ndarray) -> Table:
    """A table of parts, each (surfaces, columns ...)."""
    surface, *columns = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Table.of(surface, surfaces, *columns)


def columns_of(v: np.ndarray) -> Any:
    """The three coordinates of vectors (n, 3), as one vector of arrays."""
    return (v[:, 0], v[:, 1], v[:, 2])


def dd_columns(high: np.ndarray, low: np.ndarray) -> Any:
    """Vectors (n, 3) with their low parts, as one double-double vector of arrays."""
    return ((high[:, 0], low[:, 0]), (high[:, 1], low[:, 1]), (high[:, 2], low[:, 2]))
