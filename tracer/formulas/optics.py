"""Reflection, refraction and Fresnel's equations: the lecture's formulas under the lecture's names.

    v         direction of the incoming ray, towards the surface
    r, t      directions of the reflected and the refracted ray
    n         unit normal on the side that v comes from
    n1, n2    indices of refraction before and behind the surface; eta = n1/n2 (the slide calls it n)
    c1, c2    cosines of the angles of incidence and refraction; s1, s2 their sines

Slides: "Ray Tracing Reflection Formula", "Snell's Law", "Critical Angle", "Computing the Transmission Direction".
The slides' expressions suffer cancellation: 1 - c1^2 at normal incidence, eta c1 - c2 where the indices nearly
match, 1 - R at grazing incidence. Each is replaced by an equal product that does not.
"""

import math

from tracer.compile.jit import inlined
from tracer.formulas.vector import (
    Vector,
    VectorLike,
    add,
    cross,
    dot,
    length,
    renormalize,
    rescale,
    scale,
    subtract,
    unit,
)


@inlined
def mirrored(v: Vector, n: Vector) -> Vector:
    """r = v - 2 (n.v) n for unit v. The factor 2 - n.n approximates 1/n.n, so that rounding in n's length does not
    change the direction of r.
    """
    return renormalize(subtract(v, scale(2.0 * (dot(n, v) * (2.0 - dot(n, n))), n)))


@inlined
def cosine(v: Vector, n: Vector) -> float:
    """c1 = -v.n for unit v."""
    return -dot(v, n)


@inlined
def sine(v: Vector, n: Vector) -> float:
    """s1 = |v x n| for unit v: accurate also where sqrt(1 - c1^2) cancels."""
    return length(cross(v, n))


@inlined
def radicand(s1: float, n1: float, n2: float) -> float:
    """1 - eta^2 (1 - c1^2), the number under the slide's root. Total internal reflection where it is <= 0."""
    s2 = n1 / n2 * s1
    return (1.0 - s2) * (1.0 + s2)


@inlined
def transmission(v: Vector, n: Vector, n1: float, n2: float, c1: float, c2: float) -> Vector:
    """t = eta v + (eta c1 - c2) n for unit v, with eta c1 - c2 written as (n1^2 - n2^2) / (n2 (n1 c1 + n2 c2))."""
    bend = (n1 - n2) * (n1 + n2) / (n2 * (n1 * c1 + n2 * c2))
    return unit(add(scale(n1 / n2, v), scale(bend, n)))


@inlined
def fresnel_shares(c1: float, s1: float, c2: float, n1: float, n2: float) -> tuple[float, float]:
    """(R, T): reflectance and transmittance for unpolarised light, computed separately.

    The mean of r_s = (n1 c1 - n2 c2)/(n1 c1 + n2 c2) and r_p = (n2 c1 - n1 c2)/(n2 c1 + n1 c2), squared. The
    numerators are multiplied out, so that no difference of rounded numbers is left (Born & Wolf, Principles of
    Optics, 1.5.2).
    """
    s2 = n1 / n2 * s1
    along_s = n1 * c1 + n2 * c2
    along_p = n2 * c1 + n1 * c2
    r_s = (n2 - n1) / along_s * ((n2 + n1) / along_s)
    r_p = (n2 - n1) / along_p * ((n2 + n1) / along_p) * (c1 - s2) * (c1 + s2)
    both = 4.0 * n1 * n2 * c1 * c2
    t_s = both / (along_s * along_s)
    t_p = both / (along_p * along_p)
    r, t = 0.5 * (r_s * r_s + r_p * r_p), 0.5 * (t_s + t_p)
    # The smaller share keeps its accuracy and the other is its complement to 1, so rounding creates or loses no light.
    return (r, 1.0 - r) if r < t else (1.0 - t, t)


@inlined
def shares(c1: float, s1: float, n1: float, n2: float) -> tuple[float, float]:
    """`fresnel_shares` for any angle of incidence; (1, 0) on total internal reflection."""
    root = radicand(s1, n1, n2)
    if root <= 0.0:
        return (1.0, 0.0)
    return fresnel_shares(c1, s1, math.sqrt(root), n1, n2)


@inlined
def angle(a: Vector, b: Vector) -> float:
    """The angle between two vectors in radians, 0 to pi. Accurate at both ends, unlike acos."""
    return math.atan2(length(cross(a, b)), dot(a, b))


# The functions below are the public interface: they take any sequence of three numbers and vectors of any length above
# 0.


def reflect(v: VectorLike, n: VectorLike) -> Vector:
    """The direction of the reflected ray.

    `v` is the incoming direction, `n` the normal on the side `v` comes from. Returns a unit vector.
    """
    return mirrored(unit(rescale(v)), unit(rescale(n)))


def refract(v: VectorLike, n: VectorLike, n1: float, n2: float) -> Vector | None:
    """The direction of the refracted ray, a unit vector; None on total internal reflection.

    `v` is the incoming direction, `n` the normal on the side `v` comes from, `n1` and `n2` are the indices of
    refraction before and behind the surface.
    """
    d, n = unit(rescale(v)), unit(rescale(n))
    s1 = sine(d, n)
    root = radicand(s1, n1, n2)
    if root <= 0.0:
        return None
    return transmission(d, n, n1, n2, cosine(d, n), math.sqrt(root))


def fresnel(cos1: float, n1: float, n2: float) -> tuple[float, float]:
    """(R, T): Fresnel reflectance and transmittance for unpolarised light, R + T = 1.

    `cos1`, the cosine of the angle of incidence, is in 0..1. (1.0, 0.0) on total internal reflection.
    """
    return shares(cos1, math.sqrt((1.0 - cos1) * (1.0 + cos1)), n1, n2)


def critical_angle(n1: float, n2: float) -> float | None:
    """asin(n2/n1) in radians: from this angle on no light leaves n1 for n2. None where n1 <= n2."""
    if n1 <= n2:
        return None
    return math.atan2(n2, math.sqrt((n1 - n2) * (n1 + n2)))
