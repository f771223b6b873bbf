"""The judge of accuracy: a recorded ray tree traced again in mpmath with 50 digits.

exact_tree(tree)     the whole tree from the recorded camera ray on: the rows without any rounding (forward error)
exact_step(tree, i)  row i alone, each number from the recorded numbers it was computed from: the rounding of one
step

The scene's numbers and the recorded camera ray are taken as exact. Which surface a ray hits and which rays are sent
out is read from the tree. Distances and directions are computed again, by the textbook's formulas: with 50 digits
their cancellation does no harm. Of several roots the one nearest to the recorded t is taken. NaN means absent: a ray
that hits nothing, or one that does not exist exactly, because the surface is missed or all light is reflected.
"""

from typing import Any, NamedTuple

import numpy as np
from mpmath import mp, mpf

from tests.exact import NAN, NOWHERE, Vector, dot, exact, root, surface, unit
from tracer.scene import Light, Object
from tracer.tree.raytree import RayTree


class Exact(NamedTuple):
    """A row of the node table without rounding; the fields have the same names. A factor is one number, equal for RGB.

    A shadow ray has its direction, and the distance and position of its light, whether the light is blocked or not.
    """

    origin: Vector
    direction: Vector
    factor: mpf
    weight: mpf
    t: mpf
    point: Vector
    normal: Vector
    theta1: mpf
    theta2: mpf
    radicand: mpf


def exact_tree(tree: RayTree) -> list[Exact]:
    """All rows with 50 digits. Each ray starts at the exact hit of its parent, so errors of earlier rows count too."""
    rows: list[Exact] = []
    for i, row in enumerate(tree.nodes):
        if row["parent"] < 0:
            origin, direction, factor, weight = exact(row["origin"]), unit(exact(row["direction"])), mpf(1), mpf(1)
        else:
            above = rows[row["parent"]]
            origin = above.point
            direction, factor = sent(tree, i, above.point, above.direction, above.normal)
            weight = above.weight * factor
        t, point = met(tree, i, origin, direction)
        rows.append(Exact(origin, direction, factor, weight, t, point, *facing(tree, i, point, direction)))
    return rows


def exact_step(tree: RayTree, i: int) -> Exact:
    """Row i with 50 digits, from recorded values.

    Direction and factor are exact for the parent's recorded point and direction, t and point for the row's recorded
    origin and direction, normal and angles for its recorded point and direction.
    """
    row = tree.nodes[i]
    origin, along = exact(row["origin"]), unit(exact(row["direction"]))
    direction, factor, weight = along, mpf(1), mpf(1)
    k = int(row["parent"])
    if k >= 0:
        point, before = exact(tree.nodes["point"][k]), unit(exact(tree.nodes["direction"][k]))
        direction, factor = sent(tree, i, point, before, facing(tree, k, point, before)[0])
        weight = factor * mpf(tree.nodes["weight"][k][0])
    t, point = met(tree, i, origin, along)
    return Exact(origin, direction, factor, weight, t, point, *facing(tree, i, exact(row["point"]), along))


def off(value: Any, true: Any) -> mpf:
    """Euclidean distance of a recorded number or vector from the exact one."""
    return mp.norm(exact(value) - true) if isinstance(true, np.ndarray) else abs(mpf(value) - true)


def met(tree: RayTree, i: int, origin: Vector, direction: Vector) -> tuple[mpf, Vector]:
    """(t, point) at which the ray hits the recorded object. For a shadow ray, those of its light."""
    row = tree.nodes[i]
    if row["light"] >= 0:
        place = tree.scene.lights[row["light"]].position
        return (mp.inf, NOWHERE) if place is None else (mp.norm(exact(place) - origin), exact(place))
    if row["object"] < 0:
        return NAN, NOWHERE
    form = surface(tree.scene.objects[row["object"]].shape, row)
    q = origin - form.at
    a, b = dot(direction, form.map(direction)), dot(direction, form.map(q) + form.g)
    c = dot(q, form.map(q) + form.g * 2) + form.h
    t = min(roots(a, b, c), key=lambda candidate: abs(candidate - mpf(row["t"])))
    return t, origin + direction * t


def roots(a: mpf, b: mpf, c: mpf) -> list[mpf]:
    """The real roots of a t^2 + 2 b t + c = 0."""
    if a == 0:
        return [-c / (2 * b) if b != 0 else NAN]
    s = root(b * b - a * c)
    return [(-b - s) / a, (-b + s) / a]


def facing(tree: RayTree, i: int, point: Vector, d: Vector) -> tuple[Vector, mpf, mpf, mpf]:
    """(normal, theta1, theta2, radicand) at a point of the surface that ray i hit, on the side the ray comes from."""
    row = tree.nodes[i]
    if row["light"] >= 0 or row["object"] < 0:
        return NOWHERE, NAN, NAN, NAN
    form = surface(tree.scene.objects[row["object"]].shape, row)
    n = unit(form.map(point - form.at) + form.g)
    n = -n if dot(n, d) > 0 else n
    s1 = mp.norm(np.cross(d, n))
    s2 = mpf(row["n1"]) / mpf(row["n2"]) * s1  # NaN on an opaque surface
    return n, mp.atan2(s1, -dot(d, n)), mp.atan2(s2, root(1 - s2**2)), 1 - s2**2


def sent(tree: RayTree, i: int, point: Vector, d: Vector, n: Vector) -> tuple[Vector, mpf]:
    """(direction, factor) of ray i, sent out by a ray along d that hit a surface with normal n."""
    row, kind = tree.nodes[i], tree.kind(i)
    if row["light"] >= 0:
        return to_light(tree.scene.lights[row["light"]], point), NAN
    above = tree.nodes[row["parent"]]
    item: Object = tree.scene.objects[above["object"]]
    kr, kt = mpf(item.material.reflect), mpf(item.material.transmit)
    n1, n2 = mpf(above["n1"]), mpf(item.material.ior if item.thin else above["n2"])
    c1 = -dot(d, n)
    mirrored = d + n * (2 * c1)
    if kind == "tir" or kt == 0:
        return mirrored, kr + kt
    c2 = root(1 - (n1 / n2) ** 2 * (1 - c1**2))
    fresnel = tree.model == "fresnel"
    share = reflectance(c1, c2, n1, n2) if fresnel else mpf(0)
    if kind == "reflection":
        return mirrored, (kr + kt) * share if fresnel else kr
    return d if item.thin else d * (n1 / n2) + n * (n1 / n2 * c1 - c2), (kr + kt) * (1 - share) if fresnel else kt


def reflectance(c1: mpf, c2: mpf, n1: mpf, n2: mpf) -> mpf:
    """Fresnel reflectance, the mean of both polarisations; 1 for total internal reflection."""
    if mp.isnan(c2):
        return mpf(1)
    along = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
    across = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    return (along**2 + across**2) / 2


def to_light(light: Light, point: Vector) -> Vector:
    if light.direction is not None:
        return -unit(exact(light.direction))
    assert light.position is not None
    return unit(exact(light.position) - point)
