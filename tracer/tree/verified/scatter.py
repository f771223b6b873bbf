"""The rays that a hit sends out, in balls, by the formulas of the lecture."""

from typing import NamedTuple

from tracer.choices import MODELS, WHITTED
from tracer.scene import Object
from tracer.tree.verified.balls import Ball, BallVector, add, ball, cross, dot, scale, sign, square, subtract


class Sent(NamedTuple):
    """A ray that a hit sends out."""

    factor: Ball
    direction: BallVector
    refracted: bool


class Hit(NamedTuple):
    """A hit with all that the rays sent out depend on. The normals are on the side that the ray comes from."""

    item: Object
    d: BallVector
    face_normal: BallVector
    normal: BallVector
    n1: float
    n2: float  # of a thin sheet: n1


def mirrored(d: BallVector, n: BallVector) -> BallVector:
    return subtract(d, scale(2 * dot(n, d), n))


def radicand(d: BallVector, n: BallVector, n1: float, n2: float) -> Ball:
    return 1 - (ball(n1) / ball(n2)) ** 2 * square(cross(d, n))


def refracted(d: BallVector, n: BallVector, n1: float, n2: float, root: Ball) -> BallVector:
    eta = ball(n1) / ball(n2)
    return add(scale(eta, d), scale(-eta * dot(d, n) - root.sqrt(), n))


def reflectance(c1: Ball, c2: Ball, n1: Ball, n2: Ball) -> Ball:
    across = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
    along = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    return (across * across + along * along) / 2


def usable_normal(hit: Hit, shading: BallVector) -> BallVector | None:
    """The normal to shade with: an interpolated one only if it sends the reflected ray to the front of the face and
    the refracted one behind. None if that is not certain.
    """
    d, n = hit.d, hit.face_normal
    tests = [sign(dot(mirrored(d, shading), n))]
    if hit.item.material.transmit > 0.0:
        tests.append(sign(-dot(d, shading)))
        root = radicand(d, shading, hit.n1, hit.n2)
        passes = sign(root)
        if passes is None:
            return None
        if passes > 0:
            tests.append(sign(-dot(refracted(d, shading, hit.n1, hit.n2, root), n)))
    if None in tests:
        return n if any(test in (-1, 0) for test in tests) else None
    return shading if all(test == 1 for test in tests) else n


def scattered(hit: Hit, model: str) -> dict[str, Sent] | None:
    """The rays by kind; None if total internal reflection is not decided."""
    material, d, n = hit.item.material, hit.d, hit.normal
    kr, kt = ball(material.reflect), ball(material.transmit)
    mirror = mirrored(d, n)
    if material.transmit == 0.0:
        return {"reflection": Sent(kr, mirror, False)}
    whitted, thin = model == MODELS[WHITTED], hit.item.thin
    n1, n2 = hit.n1, material.ior if thin else hit.n2
    if n1 == n2 and not thin:
        return {"refraction": Sent(kt if whitted else kr + kt, d, True)}
    if thin and whitted:
        return {"reflection": Sent(kr, mirror, False), "refraction": Sent(kt, d, True)}
    root = radicand(d, n, n1, n2)
    passes = sign(root)
    if passes is None:
        return None
    if passes <= 0:
        return {"reflection" if thin else "tir": Sent(kr + kt, mirror, False)}
    through = d if thin else refracted(d, n, n1, n2, root)
    if whitted:
        return {"reflection": Sent(kr, mirror, False), "refraction": Sent(kt, through, True)}
    share = reflectance(-dot(d, n), root.sqrt(), ball(n1), ball(n2))
    return {
        "reflection": Sent((kr + kt) * share, mirror, False),
        "refraction": Sent((kr + kt) * (1 - share), through, True),
    }
