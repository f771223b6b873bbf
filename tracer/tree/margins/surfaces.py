"""Margins of what a ray meets: edges, silhouettes, and surfaces at nearly the same distance."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tracer.formulas.double_double import U
from tracer.kernel.world import World
from tracer.tree.margins import gaps
from tracer.tree.margins.candidates import REACH, Rays, pairs
from tracer.tree.margins.coplanar import in_one_plane
from tracer.tree.margins.outlines import Outlines, Table, outlines

EDGE, SILHOUETTE, PARALLEL, ORDER, START = range(5)  # decisions, as `margins.DECISIONS` numbers them
OUTLINE = 24.0  # rounding errors of the tests whether a ray passes an edge, relative to the coordinates, in u
PARALLEL_NORMALS = 1e-9  # sine of the angle between normals of one face, whichever way they were computed


class Doubt(NamedTuple):
    """Margins of some decisions of one kind."""

    decision: int
    ray: np.ndarray  # index in `Rays`
    margin: np.ndarray
    surface: np.ndarray  # that the decision is about


class Ends(NamedTuple):
    """The surfaces at which rays start and end, one entry each."""

    start: np.ndarray  # id of the surface, -1 for the eye
    start_normal: np.ndarray  # (n, 3) of the face; nan for the eye
    hit: np.ndarray  # id of the surface, -1 for none
    hit_normal: np.ndarray  # (n, 3) of the face; nan for none
    error: np.ndarray  # of the hit point


def surface_margins(world: World, rays: Rays, ends: Ends) -> Iterator[Doubt]:
    """The margins of all decisions about surfaces, each ray against each surface that it passes."""
    ray, ids = pairs(rays, world.boxes)
    ids, surface = np.unique(ids, return_inverse=True)
    items = outlines(world, ids)
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        for decision, table, distance in (
            (EDGE, items.segments, gaps.to_segments),
            (EDGE, items.circles, gaps.to_circles),
            (SILHOUETTE, items.spheres, gaps.to_spheres),
            (SILHOUETTE, items.sides, gaps.to_sides),
        ):
            k, item = expand(ray, surface, table)
            gap, t = distance(rays.o[k], rays.d[k], *(column[item] for column in table.columns))
            size = extent(table, item)
            error = rays.error(k, t) + OUTLINE * U * size
            # Where a face is seen edge-on, the nearest point of its edge is far from the hit.
            slack = REACH * (ends.error[k] + error)
            ahead = (t >= -slack) & (t <= rays.end[k] + slack)
            yield Doubt(decision, k[ahead], (gap / error)[ahead], table.surface[item][ahead])
        yield from order_margins(world, items, rays, ends, ray, surface)


def order_margins(
    world: World, items: Outlines, rays: Rays, ends: Ends, ray: np.ndarray, surface: np.ndarray
) -> Iterator[Doubt]:
    """The margins of which surface comes first: of all crossings with their distance from the ray's end and start."""
    k, item = expand(ray, surface, items.planes)
    point, normal, low, infinite = (column[item] for column in items.planes.columns)
    t, speed, height = gaps.to_planes(rays.o[k], rays.d[k], point, normal, low, infinite)
    own = items.planes.surface[item]
    error = (rays.error(k, t) + OUTLINE * U * np.abs(point).sum(axis=1)) / np.abs(speed)
    level = infinite & ~(t > rays.end[k]) & ~is_face(own, normal, ends.start[k], ends.start_normal[k])
    # A ray that does not cross the plane before its end would have to turn farther, by an angle that takes it there.
    there = np.where((t > 0.0) | (height == 0.0), 0.0, np.abs(height) / rays.end[k])
    turned = np.abs(speed) + there
    yield Doubt(PARALLEL, k[level], (turned / (rays.turn[k] + 4.0 * U))[level], own[level])
    for decision, margin, where in against_ends(rays, ends, k, t, error):
        faces = is_face(own, normal, where[0], where[1])
        near = np.flatnonzero(~faces & (margin < REACH))
        kept = [j for j in near.tolist() if matters(world, rays, k[j], t[j], error[j], int(own[j]), int(where[0][j]))]
        yield Doubt(decision, k[kept], margin[kept], own[kept])
    for table, roots in ((items.spheres, gaps.sphere_roots), (items.sides, gaps.side_roots)):
        k, item = expand(ray, surface, table)
        own, columns = table.surface[item], [column[item] for column in table.columns]
        for t, slant in roots(rays.o[k], rays.d[k], *columns):
            error = 2.0 * (rays.error(k, t) + OUTLINE * U * extent(table, item)) * slant
            for decision, margin, (which, _) in against_ends(rays, ends, k, t, error):
                same = world.arrays.surfaces["coincident"][own] == world.arrays.surfaces["coincident"][which]
                near = (margin < REACH) & ~(same & (which >= 0))
                yield Doubt(decision, k[near], margin[near], own[near])


def against_ends(
    rays: Rays, ends: Ends, k: np.ndarray, t: np.ndarray, error: np.ndarray
) -> Iterator[tuple[int, np.ndarray, tuple[np.ndarray, np.ndarray]]]:
    """(decision, margins, (surface there, its normal)) of crossings at distance t, against both ends of their rays."""
    # For a ray without a hit, no crossing is near its end.
    yield ORDER, np.abs(t - rays.end[k]) / (error + ends.error[k]), (ends.hit[k], ends.hit_normal[k])
    yield START, np.abs(t) / error, (ends.start[k], ends.start_normal[k])


def is_face(own: np.ndarray, normal: np.ndarray, surface: np.ndarray, face: np.ndarray) -> np.ndarray:
    """Whether planes belong to the face at which a ray starts or ends: to the same surface, with a parallel normal."""
    turned = np.abs(np.cross(normal, face)).max(axis=1)
    return (own == surface) & (turned < PARALLEL_NORMALS)


def matters(world: World, rays: Rays, k: int, t: float, error: float, surface: int, other: int) -> bool:
    """Whether a crossing near an end is a decision: the ray may hit the face there, and the surface at the end does not
    lie in the same plane.
    """
    point = rays.o[k] + t * rays.d[k]
    objects = world.arrays.surfaces["object"]
    box = world.boxes[surface]
    slack = error + np.abs(box[np.isfinite(box)]).sum() * 2.0**-40
    if ((point < box[0] - slack) | (point > box[1] + slack)).any():
        return False
    if other < 0:
        return True
    first = [int(np.searchsorted(objects, objects[s])) for s in (surface, other)]
    shapes = [world.scene.objects[objects[s]].shape for s in (surface, other)]
    return not in_one_plane(shapes[0], surface - first[0], shapes[1], other - first[1], point)


def expand(ray: np.ndarray, surface: np.ndarray, table: Table) -> tuple[np.ndarray, np.ndarray]:
    """(rays, items) for pairs of a ray and a surface (its place in the table): one for each item of the surface."""
    first = table.starts[surface]
    count = table.starts[surface + 1] - first
    k = np.repeat(ray, count)
    ahead = np.repeat(first - np.concatenate([[0], np.cumsum(count)[:-1]]), count) if len(count) else first
    return k, ahead + np.arange(len(k))


def extent(table: Table, item: np.ndarray) -> np.ndarray:
    """The size of the numbers that an item is made of."""
    total = np.zeros(len(item))
    for column in table.columns:
        part = np.abs(column[item])
        total += part if part.ndim == 1 else part.sum(axis=1)
    return total
