"""Hits of rays on shapes. Floats are taken as exact; the digits are those of the current context.

Nothing here is taken from the tracer. The formulas are the textbook's: with enough digits their cancellation does no
harm. Until the last root all numbers are rational, so a decision needs only enough digits for what cancels.
"""

from collections.abc import Sequence
from decimal import Context, Decimal
from typing import NamedTuple

from tracer.formulas.vector import Vector
from tracer.measure.check.case import decimal
from tracer.measure.check.exact_optics import Number, Point, along, dot, point

DECIDING = Context(prec=150)  # for hit or miss of far away shapes at small margins

Vectors = Sequence[Sequence[Number]]


class Tube(NamedTuple):
    """The side of a cone or cylinder: its ends, and its radii there."""

    base: Vector
    base_radius: float
    apex: Vector
    apex_radius: float


def minus(a: Sequence[Decimal], b: Sequence[Decimal]) -> Point:
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a: Sequence[Decimal], b: Sequence[Decimal]) -> Point:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normal(corners: Vectors) -> Point:
    """The normal of a triangle, as long as twice its area."""
    a, b, c = (point(corner) for corner in corners)
    return cross(minus(b, a), minus(c, a))


def solutions(a: Decimal, b: Decimal, c: Decimal) -> list[Decimal]:
    """The solutions above 0 of a t^2 + 2 b t + c = 0, in order."""
    square = b * b - a * c
    if square < 0:
        return []
    half = square.sqrt()
    return sorted(t for t in ((-b - half) / a, (-b + half) / a) if t > 0)


def beside(origin: Sequence[float], direction: Sequence[float], place: Sequence[float]) -> Decimal:
    """The squared distance of a point from the line of a ray."""
    d = point(direction)
    across = cross(minus(point(origin), point(place)), d)
    return dot(across, across) / dot(d, d)


def sphere(
    origin: Sequence[float], direction: Sequence[float], center: Sequence[float], radius: float
) -> list[Decimal]:
    """The distances to a sphere, in order."""
    f, d = minus(point(origin), point(center)), point(direction)
    return solutions(dot(d, d), dot(f, d), dot(f, f) - decimal(radius) ** 2)


def tube(origin: Sequence[float], direction: Sequence[float], shape: Tube) -> list[Decimal]:
    """The distances to the side of a cone or cylinder, in order."""
    d, base = point(direction), point(shape.base)
    axis, arm = minus(point(shape.apex), base), minus(point(origin), base)
    square = dot(axis, axis)
    height, climb = dot(arm, axis) / square, dot(d, axis) / square  # as shares of the axis
    f, g = along(arm, axis, -height), along(d, axis, -climb)
    wider = decimal(shape.apex_radius) - decimal(shape.base_radius)
    radius, rise = decimal(shape.base_radius) + wider * height, wider * climb
    found = solutions(dot(g, g) - rise * rise, dot(f, g) - rise * radius, dot(f, f) - radius * radius)
    return [t for t in found if 0 <= height + t * climb <= 1]


def box(
    origin: Sequence[float], direction: Sequence[float], low: Sequence[float], high: Sequence[float]
) -> tuple[Decimal, Decimal]:
    """The distances at which a line enters and leaves a box. It misses if it enters after it leaves."""
    slabs = [
        sorted(((decimal(a) - decimal(o)) / decimal(d), (decimal(b) - decimal(o)) / decimal(d)))
        for o, d, a, b in zip(origin, direction, low, high, strict=True)
    ]
    return max(near for near, _ in slabs), min(far for _, far in slabs)


def plane(
    origin: Sequence[float], direction: Sequence[float], place: Sequence[Number], upright: Sequence[Number]
) -> Decimal:
    """The distance to a plane through a place, with a normal of any length; below 0 if it is behind the origin."""
    n = point(upright)
    return dot(n, minus(point(place), point(origin))) / dot(n, point(direction))


def distance_to_face(p: Sequence[float], corners: Vectors) -> Decimal:
    """The distance of a point from a triangle."""
    a, b, c = (point(corner) for corner in corners)
    q, n = point(p), normal(corners)
    if all(dot(cross(minus(y, x), minus(q, x)), n) >= 0 for x, y in ((a, b), (b, c), (c, a))):
        return abs(dot(n, minus(q, a))) / dot(n, n).sqrt()
    least = Decimal("Infinity")
    for x, y in ((a, b), (b, c), (c, a)):
        side = minus(y, x)
        share = min(max(dot(minus(q, x), side) / dot(side, side), Decimal(0)), Decimal(1))
        beside = minus(q, along(x, side, share))
        least = min(least, dot(beside, beside).sqrt())
    return least
