"""The tests of a ray against a sphere, a polygon and a triangle, with their numbers: the lecture's formulas at a hit.

The numbers are those of the table, computed in exact fractions and rounded once: a textbook's formula in float64 would
show rounding errors that the tracer does not make.

A test is that of the object that ray i meets, or of the object with a number, which it may miss.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from tracer.formulas.exact import area, dot, exact, minus, plane_of
from tracer.shapes.mesh import Mesh
from tracer.shapes.polygon import Polygon
from tracer.shapes.shape import Shape
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section

DIGITS = 5


@dataclass(frozen=True)
class SphereRoots:
    """a t^2 + b t + c = 0 for the distances at which the line of a ray meets a sphere, and its roots."""

    a: float
    b: float
    c: float
    discriminant: float
    roots: tuple[float, float]  # the smaller first

    @property
    def misses(self) -> bool:
        """Whether the line of the ray does not meet the sphere, if it is not known to hit it."""
        return self.discriminant < 0.0

    def nearest(self, t: float) -> int:
        """The number, 0 or 1, of the root that a hit at distance t is."""
        return min((0, 1), key=lambda k: abs(self.roots[k] - t))


def sphere_roots(origin: tuple, direction: tuple, sphere: Sphere) -> SphereRoots:
    """The quadratic of a ray and a sphere. A discriminant below 0, by rounding or at a miss, counts as 0 for the roots.

    The root of larger magnitude is q/a, the other c/q with q = -(b + sign(b) sqrt(D))/2, so that nothing cancels.
    """
    d, arm = exact(direction), minus(exact(origin), exact(sphere.center))
    a, b = dot(d, d), 2 * dot(d, arm)
    c = dot(arm, arm) - Fraction(sphere.radius) ** 2
    discriminant = b * b - 4 * a * c
    q = -0.5 * (float(b) + math.copysign(math.sqrt(max(0.0, float(discriminant))), float(b)))
    found = (q / float(a), float(c) / q) if q else (0.0, 0.0)
    return SphereRoots(float(a), float(b), float(c), float(discriminant), (min(found), max(found)))


def shape_tested(tree: RayTree, i: int, number: int | None = None) -> Shape | None:
    """The shape of object `number`, or of the one that ray i meets; None if it meets none."""
    number = int(tree.nodes["object"][i]) if number is None else number
    return tree.scene.objects[number].shape if number >= 0 else None


def is_hit(tree: RayTree, i: int, number: int | None) -> bool:
    """Whether ray i meets object `number`, or no object is named."""
    return number is None or number == int(tree.nodes["object"][i])


def hit_roots(tree: RayTree, i: int, number: int | None = None) -> SphereRoots | None:
    """The quadratic of ray i; None if the object is not a sphere."""
    row, shape = tree.nodes[i], shape_tested(tree, i, number)
    if not isinstance(shape, Sphere):
        return None
    return sphere_roots(tuple(map(float, row["origin"])), tuple(map(float, row["direction"])), shape)


def sphere_section(tree: RayTree, i: int, number: int | None = None) -> Section | None:
    """The quadratic of ray i with its numbers, and which root is its distance; None if it is no sphere's."""
    found = hit_roots(tree, i, number)
    if found is None:
        return None
    section = Section("Ray and sphere", Lecture.QUADRATIC)
    hits = is_hit(tree, i, number)
    error = start_error(tree, i) if hits else 0.0
    on_sphere = abs(found.roots[0]) <= error  # then c is rounding error
    for symbol, value in (
        (Lecture.QUADRATIC_A, found.a),
        (Lecture.QUADRATIC_B, found.b),
        (Lecture.QUADRATIC_C, 0.0 if on_sphere else found.c),
        (Lecture.DISCRIMINANT, found.discriminant),
    ):
        section.add(symbol, format_number(value, DIGITS))
    doubt = float(tree.nodes["error"][i]) if hits else 0.0  # of the point, and so of the distance
    if hits or not found.misses:
        section.add(Lecture.ROOTS)
        for symbol, root in zip((Lecture.ROOT_1, Lecture.ROOT_2), found.roots, strict=True):
            section.add(symbol, format_number(0.0 if abs(root) <= error else root, DIGITS, doubt))
    if not hits:
        section.add(miss_reason(found))
        return section
    t = float(tree.nodes["t"][i])
    chosen = found.nearest(t)
    section.add("t of the ray", f"{format_number(t, DIGITS, doubt)} = t{'₁₂'[chosen]}")
    section.add(root_reason(found, chosen, error))
    return section


def start_error(tree: RayTree, i: int) -> float:
    """A bound on the distance along ray i at which it meets the sphere that it starts on, which would be 0 exactly.

    0 for a ray that starts elsewhere: a ray that grazes a sphere has no bound on its error.
    """
    row = tree.nodes[i]
    parent = int(row["parent"])
    if parent < 0 or tree.nodes["object"][parent] != row["object"]:
        return 0.0
    before = float(tree.nodes["error"][parent])
    return 2.0 * (float(row["error"]) + before) / max(math.cos(float(row["theta1"])), float(row["turn"]), 1e-8)


def root_reason(found: SphereRoots, chosen: int, error: float) -> str:
    """Why this root is the distance of the hit."""
    if found.roots[0] == found.roots[1]:
        return "both roots are one: the ray grazes the sphere"
    if chosen == 0:
        return "the smaller root above 0"
    if abs(found.roots[0]) <= error:
        return "the ray starts on the sphere"
    return "from inside: t₁ < 0" if found.roots[0] < 0.0 else "t₁ is no hit of the ray"


def miss_reason(found: SphereRoots) -> str:
    """Why neither root is the distance of a hit."""
    if found.misses:
        return "no root, the ray misses"
    return "both roots are below 0: behind the ray" if found.roots[1] < 0.0 else "another hit is nearer"


@dataclass(frozen=True)
class Flat:
    """A face and a point of it, projected along the axis in which its normal is longest."""

    outline: tuple[tuple[float, float], ...]
    point: tuple[float, float]
    axes: str  # the two coordinates that are kept, like "xy"

    def crossings(self) -> list[tuple[float, float]]:
        """The places where a ray from the point, in the direction of the first coordinate, crosses the outline.

        A side counts if one of its ends is above the ray, and the other is not: a corner on the ray counts once.
        """
        (px, py), found = self.point, []
        for (x0, y0), (x1, y1) in zip(self.outline, (*self.outline[1:], self.outline[0]), strict=True):
            if (y0 > py) != (y1 > py):
                x = x0 + (py - y0) / (y1 - y0) * (x1 - x0)
                if x > px:
                    found.append((x, py))
        return sorted(found)


def flattened(corners: np.ndarray, point: np.ndarray) -> Flat:
    """The projection of a face (n, 3) and a point (3,)."""
    normal = np.abs([float(x) for x in area([exact(corner) for corner in corners])])
    u, v = (k for k in range(3) if k != int(np.argmax(normal)))
    outline = tuple((float(corner[u]), float(corner[v])) for corner in corners)
    return Flat(outline, (float(point[u]), float(point[v])), "xyz"[u] + "xyz"[v])


def barycentric(corners: np.ndarray, point: np.ndarray) -> tuple[float, float, float]:
    """The areas of the three triangles that a point (3,) makes with the sides of a triangle (3, 3), each opposite its
    corner, as shares of its area; negative beyond that side. The point is projected to the plane along the normal.
    """
    a, b, c, p = (exact(place) for place in (*corners, point))
    whole = area((a, b, c))
    alpha, beta, gamma = (
        float(dot(area(part), whole) / dot(whole, whole)) for part in ((p, b, c), (a, p, c), (a, b, p))
    )
    return alpha, beta, gamma


def format_share(share: float, decimals: int = 3) -> str:
    """A barycentric coordinate; a dash for NaN."""
    return format_number(share) if math.isnan(share) else f"{share:z.{decimals}f}".replace("-", "−")


def hit_face(tree: RayTree, i: int, number: int | None = None) -> np.ndarray | None:
    """The corners (n, 3) of the polygon, the triangle or the face of a mesh that ray i meets; None for other shapes,
    and for a mesh that it does not meet.
    """
    match shape_tested(tree, i, number):
        case Polygon() as shape:
            return shape.outline()
        case Triangle(vertices=vertices):
            return np.array(vertices)
        case Mesh() as shape if is_hit(tree, i, number):
            point = tree.nodes["point"][i]
            return _face_at(_near(shape, point, float(tree.nodes["error"][i])), point)
    return None


def plane_point(tree: RayTree, i: int, number: int | None = None) -> tuple[float, np.ndarray] | None:
    """(t, point (3,)) where ray i meets the plane of its face, which may be outside the face; None if it meets none."""
    if is_hit(tree, i, number):
        return float(tree.nodes["t"][i]), tree.nodes["point"][i]
    corners = hit_face(tree, i, number)
    if corners is None:
        return None
    o, d = exact(tree.nodes["origin"][i]), exact(tree.nodes["direction"][i])
    p, normal = plane_of([exact(corner) for corner in corners])
    across = dot(normal, d)
    t = dot(normal, minus(p, o)) / across if across else Fraction(0)
    if t <= 0:
        return None
    return float(t), np.array([float(x + t * y) for x, y in zip(o, d, strict=True)])


def _near(mesh: Mesh, point: np.ndarray, error: float) -> np.ndarray:
    """The faces (m, 3, 3) of a mesh whose boxes have this point in them, which may be wrong by `error`. Of a million
    faces only some are left for the tests that take longer.
    """
    vertices, faces = mesh.vertices(), mesh.geometry.faces
    for k in range(3):
        slack = 4.0 * error + float(np.spacing(np.abs(point[k])))
        below, above = vertices[:, k] <= point[k] + slack, vertices[:, k] >= point[k] - slack
        a, b, c = faces.T
        kept = (below[a] | below[b] | below[c]) & (above[a] | above[b] | above[c])
        if not kept.any():
            break
        faces = faces[kept]
    return vertices[faces]


def _face_at(faces: np.ndarray, point: np.ndarray) -> np.ndarray:
    """The face (3, 3) of these (m, 3, 3) that a point lies in: of those whose sides it does not lie beyond, the one
    whose plane is nearest.
    """
    a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
    whole = np.cross(b - a, c - a)
    size = np.einsum("ij,ij->i", whole, whole)
    arms = [np.cross(q - p, point - p) for p, q in ((b, c), (c, a), (a, b))]
    least = np.min([np.einsum("ij,ij->i", arm, whole) for arm in arms], axis=0) / size
    heights = np.abs(np.einsum("ij,ij->i", point - a, whole)) / np.sqrt(size)
    reach = np.sqrt(np.sqrt(size))
    return faces[int(np.argmin(heights + reach * np.maximum(0.0, -least)))]


def inside_section(tree: RayTree, i: int, number: int | None = None) -> Section | None:
    """The test of ray i against its face: barycentric coordinates of a triangle, the number of crossings of
    a polygon; None for other shapes, and for a plane that it does not meet.
    """
    corners, met = hit_face(tree, i, number), plane_point(tree, i, number)
    if corners is None or met is None:
        return None
    _, point = met
    if len(corners) == 3:
        section = Section("Point in triangle", Lecture.BARYCENTRIC)
        shares = barycentric(corners, point)
        for symbol, share in zip((Lecture.ALPHA, Lecture.BETA, Lecture.GAMMA), shares, strict=True):
            section.add(symbol, format_share(share, 4))
        section.add(Lecture.BARYCENTRIC_SUM, format_number(sum(shares), DIGITS))
        section.add("none is below 0: inside" if min(shares) >= 0.0 else "one is below 0: outside")
        return section
    flat = flattened(corners, point)
    count = len(flat.crossings())
    section = Section("Point in polygon", Lecture.CROSSINGS)
    section.add(f"projected to {flat.axes[0]} and {flat.axes[1]}")
    section.add("p", f"({format_number(flat.point[0], 4)}, {format_number(flat.point[1], 4)})")
    section.add("corners", str(len(corners)))
    section.add("sides crossed", str(count))
    section.add(verdict(count))
    return section


def intersection_sections(tree: RayTree, i: int) -> list[Section]:
    """The test that found the hit of ray i, with its numbers; none for shapes without one here."""
    return [section for section in (sphere_section(tree, i), inside_section(tree, i)) if section is not None]


def verdict(count: int) -> str:
    """The decision that a number of crossings makes."""
    return f"{count} is odd: inside" if count % 2 else f"{count} is even: outside"
