"""The tests of a ray against a sphere, a polygon and a triangle, with their numbers: the lecture's formulas at a hit.

The numbers are those of the table, computed in exact fractions and rounded once: a textbook's formula in float64 would
show rounding errors that the tracer does not make.
"""

import math
from dataclasses import dataclass
from fractions import Fraction

from tracer.formulas.exact import dot, exact, minus
from tracer.shapes.sphere import Sphere
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

    def nearest(self, t: float) -> int:
        """The number, 0 or 1, of the root that a hit at distance t is."""
        return min((0, 1), key=lambda k: abs(self.roots[k] - t))


def sphere_roots(origin: tuple, direction: tuple, sphere: Sphere) -> SphereRoots:
    """The quadratic of a ray and a sphere that it hits. A discriminant below 0 by rounding counts as 0 for the roots.

    The root of larger magnitude is q/a, the other c/q with q = -(b + sign(b) sqrt(D))/2, so that nothing cancels.
    """
    d, arm = exact(direction), minus(exact(origin), exact(sphere.center))
    a, b = dot(d, d), 2 * dot(d, arm)
    c = dot(arm, arm) - Fraction(sphere.radius) ** 2
    discriminant = b * b - 4 * a * c
    q = -0.5 * (float(b) + math.copysign(math.sqrt(max(0.0, float(discriminant))), float(b)))
    found = (q / float(a), float(c) / q) if q else (0.0, 0.0)
    return SphereRoots(float(a), float(b), float(c), float(discriminant), (min(found), max(found)))


def hit_roots(tree: RayTree, i: int) -> SphereRoots | None:
    """The quadratic of the hit of ray i; None if it is not on a sphere."""
    row = tree.nodes[i]
    shape = tree.scene.objects[int(row["object"])].shape if row["object"] >= 0 else None
    if not isinstance(shape, Sphere):
        return None
    return sphere_roots(tuple(map(float, row["origin"])), tuple(map(float, row["direction"])), shape)


def sphere_section(tree: RayTree, i: int) -> Section | None:
    """The quadratic at the hit of ray i with its numbers, and which root is its distance; None if it is no sphere's."""
    found = hit_roots(tree, i)
    if found is None:
        return None
    section = Section("Ray and sphere", Lecture.QUADRATIC)
    error = start_error(tree, i)
    on_sphere = abs(found.roots[0]) <= error  # then c is rounding error
    for symbol, value in (
        (Lecture.QUADRATIC_A, found.a),
        (Lecture.QUADRATIC_B, found.b),
        (Lecture.QUADRATIC_C, 0.0 if on_sphere else found.c),
        (Lecture.DISCRIMINANT, found.discriminant),
    ):
        section.add(symbol, format_number(value, DIGITS))
    section.add(Lecture.ROOTS)
    for symbol, root in zip((Lecture.ROOT_1, Lecture.ROOT_2), found.roots, strict=True):
        section.add(symbol, format_number(0.0 if abs(root) <= error else root, DIGITS))
    t = float(tree.nodes["t"][i])
    chosen = found.nearest(t)
    section.add("t of the ray", f"{format_number(t, DIGITS)} = t{'₁₂'[chosen]}")
    section.add(root_reason(found, chosen, error))
    return section


def start_error(tree: RayTree, i: int) -> float:
    """A bound on the distance along ray i at which it meets the sphere that it starts on, which would be 0 exactly."""
    row = tree.nodes[i]
    before = float(tree.nodes["error"][row["parent"]]) if row["parent"] >= 0 else 0.0
    return 2.0 * (float(row["error"]) + before) / max(math.cos(float(row["theta1"])), float(row["turn"]), 1e-8)


def root_reason(found: SphereRoots, chosen: int, error: float) -> str:
    """Why this root is the distance of the hit."""
    if chosen == 0:
        return "the smaller root above 0"
    if abs(found.roots[0]) <= error:
        return "the ray starts on the sphere"
    return "from inside: t₁ < 0" if found.roots[0] < 0.0 else "t₁ is no hit of the ray"
