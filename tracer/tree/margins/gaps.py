"""Distances of rays from edges, rims and silhouettes, and to planes and spheres, for many pairs of both at once.

Each function takes rays o + t d with unit d, (n, 3), and items of one kind. The differences that decide are taken in
double-double, so that far and large items cost no digits.
"""

from typing import Any

import numpy as np

from tracer.formulas.double_double import (
    dd_cross,
    dd_dot,
    dd_quotient,
    dd_subtract,
    dd_vector,
    exact_difference,
    two_product,
)
from tracer.tree.margins.outlines import columns_of, dd_columns

Found = tuple[np.ndarray, np.ndarray]  # (gap, t): how far the ray passes, and where
Roots = tuple[Found, Found]  # (t, slant) of both: nan for no hit; how far the hit moves if the ray moves sideways by 1


def to_segments(o: np.ndarray, d: np.ndarray, a: np.ndarray, b: np.ndarray) -> Found:
    """The distance of the ray's line from the nearest point of a segment."""
    e, w = b - a, a - o
    ee, de, dw, ew = _dot(e, e), _dot(d, e), _dot(d, w), _dot(e, w)
    across = ee - de * de
    share = np.divide(de * dw - ew, across, out=np.zeros_like(ee), where=across > 0.0)
    between = (share > 0.0) & (share < 1.0)
    q = w + np.clip(share, 0.0, 1.0)[:, None] * e
    way, arm = dd_vector(columns_of(d)), exact_difference(columns_of(a), columns_of(o))
    normal = dd_cross(way, exact_difference(columns_of(b), columns_of(a)))
    size = np.sqrt(dd_dot(normal, normal)[0])
    lines = np.divide(np.abs(dd_dot(normal, arm)[0]), size, out=np.zeros_like(size), where=size > 0.0)
    end = np.where((share > 0.5)[:, None], b, a)
    off = dd_cross(exact_difference(columns_of(end), columns_of(o)), way)
    return np.where(between & (size > 0.0), lines, np.sqrt(dd_dot(off, off)[0])), _dot(q, d)


def to_circles(o: np.ndarray, d: np.ndarray, center: np.ndarray, axis: np.ndarray, radius: np.ndarray) -> Found:
    """The distance of the ray's line from the tangent at the nearest point of a circle; of a point, from itself."""
    speed, height = _dot(axis, d), _dot(axis, center - o)
    along = np.abs(speed) < 1e-12
    t = np.where(along, _dot(center - o, d), height / np.where(along, 1.0, speed))
    arm = o + t[:, None] * d - center
    size = _length(arm)
    radial = arm / np.where(size > 0.0, size, 1.0)[:, None]
    tangent = np.cross(axis, radial)
    across = np.cross(d, tangent)
    slant = np.abs(_dot(radial, across)) / np.maximum(_length(across), 1e-300)
    slant = np.where(size > 1e-12 * radius, slant, np.abs(speed))  # at the centre no tangent is nearest
    gap = np.where(along, np.abs(height), np.abs(size - radius) * slant)
    point = radius == 0.0
    return np.where(point, _length(np.cross(center - o, d)), gap), np.where(point, _dot(center - o, d), t)


def to_spheres(o: np.ndarray, d: np.ndarray, center: np.ndarray, radius: np.ndarray) -> Found:
    """The distance of the ray's line from the silhouette of a sphere."""
    f, way = exact_difference(columns_of(o), columns_of(center)), dd_vector(columns_of(d))
    across = dd_cross(f, way)
    beside = dd_dot(across, across)
    difference = dd_subtract(beside, _squared(radius))[0]
    gap = np.abs(difference) / (np.sqrt(np.maximum(beside[0], 0.0)) + radius)
    return gap, -np.asarray(dd_dot(f, way)[0])


def sphere_roots(o: np.ndarray, d: np.ndarray, center: np.ndarray, radius: np.ndarray) -> Roots:
    """The hits of the ray's line on a sphere."""
    f, way = exact_difference(columns_of(o), columns_of(center)), dd_vector(columns_of(d))
    across, b = dd_cross(f, way), dd_dot(f, way)[0]
    discriminant = dd_subtract(_squared(radius), dd_dot(across, across))[0]
    c = dd_subtract(dd_dot(f, f), _squared(radius))[0]
    one, other, root = _roots(np.ones_like(b), b, c, discriminant)
    slant = np.divide(radius, root, out=np.full_like(b, np.inf), where=root > 0.0)
    return ((one, slant), (other, slant))


def to_sides(
    o: np.ndarray, d: np.ndarray, narrow: np.ndarray, axis: np.ndarray, r: np.ndarray, c: np.ndarray, _: np.ndarray
) -> Found:
    """A bound below the distance of the ray's line from the silhouette of a cone's side (`tracer.shapes.cone`)."""
    cosine, sine = c[:, 0], c[:, 1]
    arm = o - narrow
    height, climb = _dot(axis, arm), _dot(axis, d)
    f = cosine[:, None] * (arm - height[:, None] * axis)
    g = cosine[:, None] * (d - climb[:, None] * axis)
    rho, rise = cosine * r + sine * height, sine * climb
    bend = _length(rho[:, None] * g - rise[:, None] * f)
    beside = np.abs(_dot(axis, np.cross(f, g)))
    slope = cosine * (_length(g) + np.abs(rise)) + np.abs(sine) * _length(g)
    a, b = _dot(g, g) - rise * rise, _dot(f, g) - rho * rise
    t = np.divide(-b, a, out=np.zeros_like(a), where=a != 0.0)
    # A ray along the axis of a cylinder keeps its distance from it.
    level = np.abs(_length(f) - np.abs(rho))
    return np.where(slope > 0.0, np.abs(beside - bend) / np.maximum(slope, 1e-300), level), t


def side_roots(
    o: np.ndarray, d: np.ndarray, narrow: np.ndarray, axis: np.ndarray, r: np.ndarray, c: np.ndarray, height: np.ndarray
) -> Roots:
    """The hits of the ray's line on a cone's side, between its ends."""
    cosine, sine = c[:, 0], c[:, 1]
    arm = o - narrow
    s0, s1 = _dot(axis, arm), _dot(axis, d)
    f, g = arm - s0[:, None] * axis, d - s1[:, None] * axis
    slope = np.divide(sine, cosine, out=np.zeros_like(sine), where=cosine > 0.0)
    rho, rise = r + slope * s0, slope * s1
    a, b, cc = _dot(g, g) - rise * rise, _dot(f, g) - rho * rise, _dot(f, f) - rho * rho
    one, other, root = _roots(a, b, cc, b * b - a * cc)
    slack = 1e-9 * height
    found = []
    for t in (one, other):
        between = (s0 + t * s1 >= -slack) & (s0 + t * s1 <= height + slack)
        steep = np.abs(rho + t * rise) * np.sqrt(1.0 + slope * slope)
        slant = np.divide(steep, root, out=np.full_like(b, np.inf), where=root > 0.0)
        found.append((np.where(between, t, np.nan), np.maximum(slant, 1.0)))
    return (found[0], found[1])


def to_planes(
    o: np.ndarray, d: np.ndarray, point: np.ndarray, normal: np.ndarray, low: np.ndarray, _: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(distance along the ray, nan for a parallel one, cosine of the angle to the normal, height of the plane above the
    ray's origin).
    """
    n = dd_columns(normal, low)
    height = dd_dot(n, exact_difference(columns_of(point), columns_of(o)))
    speed = dd_dot(n, dd_vector(columns_of(d)))
    flat = np.asarray(speed[0]) == 0.0
    safe: Any = (np.where(flat, 1.0, speed[0]), speed[1])
    return np.where(flat, np.nan, dd_quotient(height, safe)[0]), np.asarray(speed[0]), np.asarray(height[0])


def _roots(a: Any, b: Any, c: Any, discriminant: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(both roots of a t^2 + 2 b t + c = 0, root of the discriminant b^2 - a c); nan for none. Neither root cancels."""
    root = np.sqrt(np.where(discriminant >= 0.0, discriminant, np.nan))
    q = np.where(b < 0.0, root - b, -root - b)
    one = np.divide(c, q, out=np.full_like(q, np.nan), where=q != 0.0)
    other = np.divide(q, a, out=np.full_like(q, np.nan), where=a != 0.0)
    return one, other, root


def _squared(radius: Any) -> Any:
    return two_product(radius, radius)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return (a * b).sum(axis=1)


def _length(a: np.ndarray) -> np.ndarray:
    return np.sqrt(_dot(a, a))
