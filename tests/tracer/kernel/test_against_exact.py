"""Every number of a ray tree against the same tree traced with 50 digits.

An error is stated in units u = 2^-53 times a condition number: the change of the answer, in u, when its inputs
change by u. Consider a ray with origin o that hits a surface at angle theta after the distance t. The surface has
position a (|a| + r for a ball); c1 and c2 are the cosines of incidence and refraction, eta = n1/n2:

normal      `sharp`. A ball's is (p - c) / r from a p near c + r n: (|c| + r) / r. A face's is a cross product of
edges:
            longest^2 / area. A plane's and a box's: 1.
point, t    sharp (|o| + |a| + t) / c1: the height above the surface is a difference of such numbers, and along the
ray
            its error is longer by 1 / c1. The t of a box is one difference with a given plane: |o| + t.
radicand    sharp (1 + eta)^2: 1 - s2^2, where s2 = eta s1 can be as large as eta. theta2      sharp (1 + eta) / c2,
as d(theta2) = eta c1/c2 d(theta1), and c2 is the root of the radicand. direction   reflected: sharp. Refracted:
sharp (1 + eta) / c2, for theta2's reason. factor      kt sharp 2 n1 n2 (1/A^2 + 1/B^2) (c2 + c1 (1 + eta) / c2) + 1,
where A = n1 c1 + n2 c2, B = n2 c1 + n1 c2:
            the derivatives of Fresnel's amplitudes (n1 c1 - n2 c2) / A and (n2 c1 - n1 c2) / B by c1 and c2.

Near the critical angle c2 goes to 0, at grazing incidence c1: there the condition numbers grow without bound.
"""

import math
from collections.abc import Iterator
from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given, settings, strategies as st
from mpmath import mp, mpf

import tracer
from tests.exact import exact, face, surface
from tests.judge import Exact, exact_step, exact_tree, off
from tests.scenes import world_of
from tracer.choices import MODELS
from tracer.kernel.nodes import BLOCKED
from tracer.scene import Light, Material, Object, Shape
from tracer.shapes.box import Box
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle
from tracer.tree.raytree import RayTree

U = mpf(2) ** -53

# In these units. The largest error seen in some thousands of random scenes is about half of each.
ALLOWED = {
    "direction": 16,
    "factor": 4,
    "weight": 4,
    "t": 4,
    "point": 4,
    "normal": 4,
    "theta1": 4,
    "theta2": 4,
    "radicand": 8,
}


def units(tree: RayTree, i: int) -> Iterator[tuple[str, mpf]]:
    """For each field of row i its error in one exact step, in u times its condition number."""
    row, true = tree.nodes[i], exact_step(tree, i)
    if row["parent"] >= 0:
        direction, factor = leaving(tree, i)
        yield "direction", off(row["direction"], true.direction) / (U * direction)
        if row["light"] < 0:
            above = mpf(tree.nodes["weight"][row["parent"]][0])
            yield "factor", off(row["factor"][0], true.factor) / (U * factor)
            yield "weight", off(row["weight"][0], true.weight) / (U * factor * above)
    if row["light"] >= 0:
        if row["end"] != BLOCKED and math.isfinite(row["t"]):
            yield "t", off(row["t"], true.t) / (U * true.t)
            yield "point", off(row["point"], true.point) / (U * (mp.norm(true.origin, 1) + true.t))
    elif row["object"] >= 0:
        way, sharp, eta = meeting(tree, i, true), sharpness(tree, i), mpf(row["n1"]) / mpf(row["n2"])
        yield "t", off(row["t"], true.t) / (U * way)
        yield "point", off(row["point"], true.point) / (U * way)
        yield "normal", off(row["normal"], true.normal) / (U * sharp)
        yield "theta1", off(row["theta1"], true.theta1) / (U * sharp)
        if not math.isnan(row["radicand"]):
            yield "radicand", off(row["radicand"], true.radicand) / (U * sharp * (1 + eta) ** 2)
        if not math.isnan(row["theta2"]):
            yield "theta2", off(row["theta2"], true.theta2) * mp.cos(true.theta2) / (U * sharp * (1 + eta))


def meeting(tree: RayTree, i: int, true: Exact) -> mpf:
    """Condition number of the hit of ray i."""
    row = tree.nodes[i]
    shape = tree.scene.objects[row["object"]].shape
    if isinstance(shape, Box):
        return mp.norm(true.origin, 1) + true.t
    form = surface(shape, row)
    size = mp.norm(form.at, 1) + mp.sqrt(-form.h)
    return sharpness(tree, i) * (mp.norm(true.origin, 1) + size + true.t) / abs(mp.cos(true.theta1))


def sharpness(tree: RayTree, i: int) -> mpf:
    """Condition number of the normal where ray i hits a surface."""
    row = tree.nodes[i]
    shape = tree.scene.objects[row["object"]].shape
    match shape:
        case Sphere(center, radius):
            return (mp.norm(exact(center), 1) + radius) / radius
        case Polygon() | Triangle() | Mesh():
            corners = face(shape, row) if isinstance(shape, Mesh) else shape.vertices
            longest = max(math.dist(a, b) for a, b in combinations(corners, 2))
            return longest**2 / mp.norm(surface(shape, row).g)
    return mpf(1)


def leaving(tree: RayTree, i: int) -> tuple[mpf, mpf]:
    """Condition numbers of the direction and of the factor of a reflected or transmitted ray."""
    k = int(tree.nodes["parent"][i])
    above, true = tree.nodes[k], exact_step(tree, k)
    item = tree.scene.objects[above["object"]]
    sharp = sharpness(tree, k)
    if tree.kind(i) == "shadow":
        return mpf(1), mpf(1)
    if tree.kind(i) == "tir" or item.material.transmit == 0.0:
        return sharp, mpf(1)
    n1, n2 = mpf(above["n1"]), mpf(item.material.ior if item.thin else above["n2"])
    c1 = mp.cos(true.theta1)
    square = 1 - (n1 / n2) ** 2 * (1 - c1**2)
    if square <= 0:  # a thin sheet: the same medium on both sides
        return sharp, mpf(1)
    c2 = mp.sqrt(square)
    slopes = 2 * n1 * n2 * ((n1 * c1 + n2 * c2) ** -2 + (n2 * c1 + n1 * c2) ** -2)
    factor = 1 + item.material.transmit * sharp * slopes * (c2 + c1 * (1 + n1 / n2) / c2)
    bent = tree.kind(i) == "refraction" and not item.thin
    return (sharp * (1 + n1 / n2) / c2 if bent else sharp), factor


def chain_units(tree: RayTree) -> Iterator[tuple[int, str, mpf]]:
    """Errors of the first two levels against the exact tree: the second level also has the propagated error of the
    first.

    A hit that moves by `drift` along a ball of radius r turns the normal by drift / r. It turns the ray that is sent
    out by `stretch` times as much: 1 for a reflection, (1 + eta) / c2 for a refraction. The next hit moves by (drift
    + t turn) / c1.
    """
    rows = exact_tree(tree)
    for i, (row, true) in enumerate(zip(tree.nodes, rows, strict=True)):
        if row["depth"] > 1 or row["light"] >= 0:
            continue
        turn = drift = mpf(0)
        if row["parent"] >= 0:
            k = int(row["parent"])
            drift = meeting(tree, k, rows[k])
            shape = tree.scene.objects[tree.nodes["object"][k]].shape
            turn, sharp = leaving(tree, i)[0], sharpness(tree, k)
            if isinstance(shape, Sphere):
                turn *= 1 + drift / shape.radius / sharp
            yield i, "direction", off(row["direction"], true.direction) / (U * turn)
            yield i, "origin", off(row["origin"], true.origin) / (U * drift)
        assert math.isnan(row["t"]) == mp.isnan(true.t)
        if row["object"] >= 0:
            way = meeting(tree, i, true) + (drift + true.t * turn) / mp.cos(true.theta1)
            yield i, "t", off(row["t"], true.t) / (U * way)
            yield i, "point", off(row["point"], true.point) / (U * way)


def check(tree: RayTree) -> None:
    for i, row in enumerate(tree.nodes):
        if row["parent"] >= 0:
            assert row["origin"].tolist() == tree.nodes["point"][row["parent"]].tolist()
        for field, found in units(tree, i):
            assert found <= ALLOWED[field], (i, field, float(found))
    for i, field, found in chain_units(tree):
        assert found <= ALLOWED.get(field, 4), (i, field, float(found))


@pytest.mark.parametrize("model", MODELS)
def test_shipped_scenes(world: tracer.World, model: str) -> None:
    width, height = world.scene.image.width, world.scene.image.height
    for x in range(11, width, 211):
        for y in range(13, height, 131):
            tree = tracer.trace(world, (x, y), model=model)
            check(tree)


MATERIALS = st.sampled_from(
    [
        Material("glass", diffuse=0.1, reflect=0.1, transmit=0.9, ior=1.5),
        Material("diamond", transmit=1.0, ior=2.42),
        Material("air", transmit=0.5, reflect=0.25),
        Material("mirror", diffuse=0.3, reflect=0.9),
    ]
)


def vectors(size: float) -> st.SearchStrategy[tuple[float, float, float]]:
    """Vectors that include simple numbers and zeros, which a uniform distribution never yields."""
    number = st.floats(-size, size).map(lambda x: round(x, 12))
    return st.tuples(number, number, number)


@st.composite
def shapes(draw: st.DrawFn) -> Shape:
    a, b, c = draw(vectors(3.0)), draw(vectors(3.0)), draw(vectors(3.0))
    match draw(st.integers(0, 4)):
        case 0:
            return Sphere(a, draw(st.floats(0.05, 1.5)))
        case 1:
            assume(any(b))
            return Plane(a, b)
        case 2:
            shape = Triangle((a, b, c))
        case 3:
            shape = Polygon(tuple(np.add(a, arm).tolist() for arm in ((0, 0, 0), b, np.add(b, c), c)))
        case _:
            shape = Box(tuple(np.minimum(a, b).tolist()), tuple(np.maximum(a, b).tolist()))
    assume(not shape.faults())
    return shape


OBJECTS = st.builds(Object, shapes(), MATERIALS, thin=st.booleans())


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.lists(OBJECTS, min_size=1, max_size=5), vectors(6.0), vectors(1.0), vectors(8.0), st.sampled_from(MODELS))
def test_random_scenes(
    objects: list[Object],
    eye: tuple[float, float, float],
    aside: tuple[float, float, float],
    lamp: tuple[float, float, float],
    model: str,
) -> None:
    """Rays towards the first object, offset by up to 1 along each axis."""
    aim = objects[0].shape
    boxes = aim.bounds()
    if boxes is None:
        assert isinstance(aim, Plane)
        middle = np.array(aim.point)
    else:
        middle = boxes.mean(axis=(0, 1))
    direction = (middle + aside - eye).tolist()
    assume(any(direction))
    lights = [Light("lamp", position=(lamp[0], lamp[1] + 20.0, lamp[2])), Light("sun", direction=(1.0, -2.0, 0.5))]
    tree = tracer.trace(world_of(*objects, lights=lights, model=model), ray=(eye, direction), depth=3)
    check(tree)


def test_judge_against_a_ball_with_a_closed_form() -> None:
    """A ball of radius 5, hit 4 above its centre: cos = 3/5. Inside, chords of length 10 c2; Fresnel's law in its
    angles.
    """
    world = world_of(Object(Sphere((0.0, 0.0, 0.0), 5.0), Material("glass", transmit=1.0, ior=1.5)), model="fresnel")
    tree = tracer.trace(world, ray=((-7.0, 4.0, 0.0), (1.0, 0.0, 0.0)), depth=2)
    rows = {tree.kind(i): true for i, true in reversed(list(enumerate(exact_tree(tree))))}  # the first of each kind
    a, b = mp.asin(mpf(4) / 5), mp.asin(mpf(8) / 15)
    r = (mp.sin(a - b) ** 2 / mp.sin(a + b) ** 2 + mp.tan(a - b) ** 2 / mp.tan(a + b) ** 2) / 2
    digits = mpf(10) ** -47
    assert mp.norm(rows["camera"].point - np.array([-3, 4, 0])) <= digits
    assert abs(rows["camera"].theta2 - b) <= digits
    assert mp.norm(rows["reflection"].direction - np.array([mpf(7) / 25, mpf(24) / 25, 0])) <= digits
    assert abs(rows["reflection"].factor - r) <= digits
    assert abs(rows["refraction"].t - 10 * mp.cos(b)) <= digits
    assert abs(rows["refraction"].weight - (1 - r)) <= digits
    assert abs(rows["refraction"].direction[1] + mp.sin(a - b)) <= digits


SIZES = (1e-9, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12)


@pytest.mark.parametrize("size", SIZES)
def test_large_and_small_and_far_away(size: float) -> None:
    """The condition numbers hold for any size, and near the surface as well as far from it."""
    corners = ((-size, 0.25 * size, -size), (0.0, 0.125 * size, size), (size, 0.5 * size, -size))
    far = (size, -0.75 * size, 0.5 * size)
    for shape, eye in (
        (Sphere((0.0, -size, 0.0), size), (0.25, 1.0, 0.5)),
        (Sphere((0.0, -1.0 - size, 0.0), 1.0), (0.0, 1.0, 0.0)),
        (Sphere(far, 1.0), (size, -0.75 * size + 2.0, 0.5 * size)),
        (Triangle(corners), (0.0, 0.3 * size + 1e-3, 0.0)),
        (Polygon(corners), (0.0, 0.3 * size + 1e-3, 0.0)),
        (Box((-size, -1.0, -size), (size, 0.0, size)), (0.0, 1e-3, 0.0)),
        (Plane(far, (0.3, 1.0, 0.2)), (0.1, 1.0, 0.2)),
    ):
        world = world_of(Object(shape, Material("glass", reflect=0.1, transmit=0.9, ior=1.5)), model="fresnel")
        for way in ((0.0, -1.0, 0.0), (0.01, -1.0, 0.02), (0.3, -1.0, -0.1), (-0.1, -1.0, 0.4)):
            check(tracer.trace(world, ray=(eye, way), depth=1))
