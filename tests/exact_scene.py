"""Surfaces with 100 digits, from the scene as its author wrote it: where a line crosses each of them.

A vector is a tuple of three mpf. `surfaces(scene)` lists the surfaces of all objects; `crossings` of one gives all
its (distance, outward unit normal, normal to shade with) along a line, in front of the origin and behind it. The
formulas are the textbook's: with so many digits their cancellation does no harm.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

from mpmath import mp, mpf

from tracer.scene import Object, Scene
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

DIGITS = 100  # a ray that grazes a plane loses 30 of them

V = tuple[Any, Any, Any]
Crossing = tuple[mpf, V, V]


def vec(values: Iterable[Any]) -> V:
    x, y, z = map(mpf, values)
    return (x, y, z)


def add(a: V, b: V) -> V:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a: V, b: V) -> V:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(s: Any, a: V) -> V:
    return (s * a[0], s * a[1], s * a[2])


def dot(a: V, b: V) -> mpf:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: V, b: V) -> V:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a: V) -> Any:
    return mp.sqrt(dot(a, a))


def unit(a: V) -> V:
    return mul(1 / norm(a), a)


def newell(corners: Sequence[V]) -> V:
    """Twice the vector area of an outline, counter-clockwise seen from its tip."""
    total = vec((0, 0, 0))
    for a, b in pairwise(sub(corner, corners[0]) for corner in corners[1:]):
        total = add(total, cross(a, b))
    return total


def is_inside(p: V, corners: Sequence[V], normal: V) -> bool:
    """Whether a point of the plane lies inside an outline, seen along the normal's largest axis."""
    drop = max(range(3), key=lambda k: abs(normal[k]))
    u, v = (k for k in range(3) if k != drop)
    inside = False
    a = corners[-1]
    for b in corners:
        ax, ay, bx, by = a[u] - p[u], a[v] - p[v], b[u] - p[u], b[v] - p[v]
        if (ay > 0) != (by > 0) and (ax * by - ay * bx > 0) == (by > ay):
            inside = not inside
        a = b
    return inside


@dataclass(frozen=True, eq=False)
class Surface:
    owner: int  # number of its object
    crossings: Callable[[V, V], Iterator[Crossing]]  # of a line: origin, unit direction


def sphere(shape: Sphere) -> Iterator[Callable[[V, V], Iterator[Crossing]]]:
    center, r = vec(shape.center), mpf(shape.radius)

    def crossings(o: V, d: V) -> Iterator[Crossing]:
        f = sub(o, center)
        b, c = dot(f, d), dot(f, f) - r * r
        square = b * b - c
        if square > 0:
            for t in (-b - mp.sqrt(square), -b + mp.sqrt(square)):
                n = mul(1 / r, add(f, mul(t, d)))
                yield t, n, n

    yield crossings


def face(
    corners: Sequence[V] | None, point: V, normal: V, within: Callable[[V], bool] | None = None, smooth: Any = None
) -> Callable[[V, V], Iterator[Crossing]]:
    n = unit(normal)

    def crossings(o: V, d: V) -> Iterator[Crossing]:
        speed = dot(n, d)
        if speed == 0:
            return
        t = dot(n, sub(point, o)) / speed
        p = add(o, mul(t, d))
        if (corners is None or is_inside(p, corners, n)) and (within is None or within(p)):
            yield t, n, n if smooth is None else mixed(p, n)

    def mixed(p: V, n: V) -> V:
        assert corners is not None
        total = vec((0, 0, 0))
        for k in range(3):
            b, c = sub(corners[(k + 1) % 3], p), sub(corners[(k + 2) % 3], p)
            total = add(total, mul(dot(cross(b, c), n), smooth[k]))
        return unit(total) if dot(total, n) > 0 else n

    return crossings


def plane(shape: Plane) -> Iterator[Callable]:
    yield face(None, vec(shape.point), vec(shape.normal))


def polygon(shape: Polygon | Triangle) -> Iterator[Callable]:
    corners = [vec(corner) for corner in shape.vertices]
    yield face(corners, corners[0], newell(corners))


def disc(shape: Disc) -> Iterator[Callable]:
    center, r2 = vec(shape.center), mpf(shape.radius) ** 2
    yield face(None, center, vec(shape.normal), lambda p: dot(sub(p, center), sub(p, center)) <= r2)


def box(shape: Box) -> Iterator[Callable]:
    low, high = vec(shape.min), vec(shape.max)
    for k in range(3):
        for end, sign in ((low, -1), (high, 1)):
            n = vec(sign * (j == k) for j in range(3))

            def within(p: V, k: int = k) -> bool:
                return all(low[j] <= p[j] <= high[j] for j in range(3) if j != k)

            yield face(None, end, n, within)


def cone(shape: Cone) -> Iterator[Callable]:
    base, axis = vec(shape.base), sub(vec(shape.apex), vec(shape.base))
    height = norm(axis)
    w, r, slope = unit(axis), mpf(shape.base_radius), (mpf(shape.apex_radius) - mpf(shape.base_radius)) / norm(axis)

    def crossings(o: V, d: V) -> Iterator[Crossing]:
        f = sub(o, base)
        s0, s1 = dot(f, w), dot(d, w)
        f, d0 = sub(f, mul(s0, w)), sub(d, mul(s1, w))
        p0, p1 = r + slope * s0, slope * s1
        a, b, c = dot(d0, d0) - p1 * p1, dot(f, d0) - p0 * p1, dot(f, f) - p0 * p0
        if abs(a) < mpf(10) ** -40:
            roots = [-c / (2 * b)] if b != 0 else []
        else:
            square = b * b - a * c
            roots = [] if square <= 0 else [(-b - mp.sqrt(square)) / a, (-b + mp.sqrt(square)) / a]
        for t in roots:
            s = s0 + t * s1
            if 0 <= s <= height and p0 + t * p1 > 0:
                n = unit(sub(unit(add(f, mul(t, d0))), mul(slope, w)))
                yield t, n, n

    yield crossings
    if shape.closed:
        for end, n, radius in ((base, mul(-1, w), r), (vec(shape.apex), w, mpf(shape.apex_radius))):
            if radius > 0:
                yield face(None, end, n, lambda p, e=end, r=radius: dot(sub(p, e), sub(p, e)) <= r * r)


def rotation(degrees: Sequence[float]) -> list[V]:
    """The rows of the matrix that rotates about x, then y, then z."""
    rows = [vec((1, 0, 0)), vec((0, 1, 0)), vec((0, 0, 1))]
    for axis, angle in enumerate(degrees):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        c, s = mp.cospi(mpf(angle) / 180), mp.sinpi(mpf(angle) / 180)
        turned = list(rows)
        turned[i] = sub(mul(c, rows[i]), mul(s, rows[j]))
        turned[j] = add(mul(s, rows[i]), mul(c, rows[j]))
        rows = turned
    return rows


def mesh(shape: Mesh) -> Iterator[Callable]:
    """The placement is exact, too: the rounded vertices are the tracer's affair."""
    rows, move, geometry = rotation(shape.rotate), vec(shape.translate), shape.geometry

    def turned(v: V) -> V:
        return (dot(rows[0], v), dot(rows[1], v), dot(rows[2], v))

    points = [add(mul(mpf(shape.scale), turned(vec(v))), move) for v in geometry.vertices.tolist()]
    normals = None if geometry.normals is None else [turned(vec(n)) for n in geometry.normals.tolist()]
    indices = geometry.faces if geometry.normal_faces is None else geometry.normal_faces
    for k, corners in enumerate(geometry.faces.tolist()):
        outline = [points[j] for j in corners]
        smooth = None if normals is None else [normals[j] for j in indices[k].tolist()]
        yield face(outline, outline[0], newell(outline), None, smooth)


SHAPES: dict[str, Callable[[Any], Iterator[Callable]]] = {
    "sphere": sphere,
    "plane": plane,
    "polygon": polygon,
    "triangle": polygon,
    "box": box,
    "cone": cone,
    "disc": disc,
    "mesh": mesh,
}


@lru_cache(maxsize=64)
def surfaces(scene: Scene) -> tuple[Surface, ...]:
    """Every surface of a scene, in the file's order."""
    with mp.workdps(DIGITS):
        return _surfaces(scene)


def _surfaces(scene: Scene) -> tuple[Surface, ...]:
    return tuple(Surface(k, one) for k, item in enumerate(scene.objects) for one in of_object(item))


def of_object(item: Object) -> Iterator[Callable]:
    if item.shape.name not in SHAPES:
        raise ValueError(f"the judge does not know the shape {item.shape.name}: add it to SHAPES")
    return SHAPES[item.shape.name](item.shape)
