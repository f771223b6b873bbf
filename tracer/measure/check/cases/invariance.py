"""Groups C and J: changes of a scene that must not change its tree: scale, place, mirroring, order of ties; and bad
input.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tracer.formulas.vector import Vector
from tracer.kernel.world import World
from tracer.measure.check import textbook
from tracer.measure.check.case import Reading, U, case, decimal, exactly
from tracer.measure.check.cases.ray_origins import second_way
from tracer.measure.check.scenes import DARK, MATTE, ball, box, glass, path, plane, world
from tracer.scene import Light, Material, Object
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle

LENGTHS = ("origin", "point", "t", "error")
TURNED = ("origin", "point", "direction", "normal")
SHINY = Material("shiny", diffuse=0.4, specular=0.3, shininess=20, reflect=0.5)
BALL, RADIUS = (0.1, 0.2, 0.3), 0.9


def mixed(s: float = 1.0, side: float = 1.0) -> World:
    """A glass ball, a box, a mirror triangle and a floor. Every length is multiplied by s, x also by `side`."""

    def at(x: float, y: float, z: float) -> Vector:
        return (side * s * x, s * y, s * z)

    low, high = sorted((side * s * 1.1, side * s * 2.3))
    corners = (at(-3, -1, -2), at(-1, -1, -4), at(-2, 3, -3))
    return world(
        ball(at(*BALL), s * RADIUS, glass(1.5)),
        box((low, -s, -1.3 * s), (high, 0.7 * s, s), SHINY),
        Object(Triangle(corners if side > 0.0 else corners[::-1]), SHINY, "triangle"),
        plane(at(0, -1, 0), (0, 1, 0), SHINY, "floor"),
        lights=[Light("lamp", position=at(3, 6, 4))],
        background=(0.2, 0.3, 0.4),
        model="fresnel",
    )


def aims() -> Iterator[tuple[Vector, Vector]]:
    for x in (-2.3, -0.7, 0.4, 1.6):
        for y in (-0.8, 0.35, 0.9):
            origin = (0.7, 1.1, 5.3)
            yield origin, (x - origin[0], y - origin[1], -origin[2])


def differing(k: int, side: float) -> int:
    """The number of values in the trees of a scaled or mirrored scene that differ from the scaled or mirrored values of
    the original.
    """
    s = 2.0**k
    one, other, count = mixed(), mixed(s, side), 0
    turn = np.array((side, 1.0, 1.0))
    for origin, aim in aims():
        a = path(one, origin, aim, depth=4).nodes
        b = path(other, (turn * s * origin).tolist(), (turn * aim).tolist(), depth=4).nodes
        if len(a) != len(b):
            return 10**6
        for field in a.dtype.names or ():
            expected = a[field] * (s if field in LENGTHS else 1) * (turn if field in TURNED else 1)
            count += int(np.sum((expected != b[field]) & ~((expected != expected) & (b[field] != b[field]))))
    return count


def textbook_differing(k: int) -> int:
    """The number of distances to the ball that are not 2^k times the original ones."""
    s, count = 2.0**k, 0
    for origin, aim in aims():
        d = textbook.unit(aim)
        one = textbook.sphere(origin, d, BALL, RADIUS)
        other = textbook.sphere([s * x for x in origin], d, [s * x for x in BALL], s * RADIUS)
        count += other != s * one
    return count


@case("C3", "a scene times 2^-200 to 2^200: the same trees, bit for bit", seconds=0.1)
def scales() -> Iterator[Reading]:
    """A power of two changes no digit of a number, so it should change none of a tree. Any length that is built into a
    program does: with a smallest distance of 1e-4 every hit is lost in a scene of size 1e-6, and the same scene in
    other units is another picture.
    """
    for k in (-200, -60, -20, 1, 60, 200):
        yield exactly(f"times 2^{k}: numbers that differ", 0, differing(k, 1.0), textbook_differing(k))


@case("C10", "glass over a core, moved up to 2^38 away")
def places() -> Iterator[Reading]:
    """Far from the origin the coordinates have fewer digits for the gap between the two surfaces. The order of hits
    must stay correct as long as the gap has any digit: at 2^38 a step of the coordinates is 6e-5, and the gap is
    1e-3. If the difference to the centre is exact, the distance must be the same to the last bit.
    """
    gap = 2.0**-10
    for k in (0, 10, 20, 30, 38):
        far = 2.0**k
        origin, center, aim = (far, 0.0, 5.0), (far, 0.0, 0.0), (0, 0, -1)
        scene = world(ball(center, 1.0 + gap, glass(1.5), "coat"), ball(center, 1.0, DARK, "core"))
        tree = path(scene, origin, aim, depth=1)
        yield Reading(f"moved by 2^{k}: through the coat", decimal(gap), float(tree.nodes["t"][1]), U, 8.0)
    still = path(world(ball((0, 0, 0), 1.0 + gap, glass(1.5)), ball((0, 0, 0), 1.0, DARK)), (0.25, 0, 5), aim, depth=1)
    exact, bits = second_way(still, 1.0 + gap, 1.0), float(still.nodes["t"][0])
    yield Reading("slanting, not moved", exact, float(still.nodes["t"][1]), U, 8.0)
    for k in (10, 30, 38):
        far = 2.0**k
        scene = world(ball((far, 0, 0), 1.0 + gap, glass(1.5), "coat"), ball((far, 0, 0), 1.0, DARK, "core"))
        tree = path(scene, (far + 0.25, 0, 5), aim, depth=1)
        own = "core" if len(tree) > 1 and tree.object_name(1) == "core" else "other"
        yield exactly(f"slanting, moved by 2^{k}: met", "core", own)
        usual = textbook.sphere((far + 0.25, 0, 5), aim, (far, 0, 0), 1.0 + gap)
        yield exactly(f"slanting, moved by 2^{k}: same t", decimal(bits), float(tree.nodes["t"][0]), usual)


@case("J2", "a mirrored scene has the mirrored trees, bit for bit")
def mirrored() -> Iterator[Reading]:
    """Rounding is symmetric: changing the sign of every x changes no digit. A program that sums in another order on one
    side, or chooses a side by a sign, draws an asymmetric picture of a symmetric scene.
    """
    yield exactly("12 trees, x to -x: numbers that differ", 0, differing(0, -1.0))


@case("J4", "invalid rays: NaN, infinite, without direction")
def bad_rays() -> Iterator[Reading]:
    """Every comparison with NaN is false, so the usual test reports a miss, the pixel shows the background, and nobody
    notices. Here such a ray is refused with a message.
    """
    scene, nan, inf = world(ball((0, 0, 0), 1.0, MATTE)), math.nan, math.inf
    rays: tuple[tuple[str, Sequence[float], Sequence[float]], ...] = (
        ("direction NaN", (0, 0, 5), (0, nan, -1)),
        ("direction infinite", (0, 0, 5), (0, 0, -inf)),
        ("direction 0", (0, 0, 5), (0, 0, 0)),
        ("origin NaN", (nan, 0, 5), (0, 0, -1)),
        ("origin infinite", (0, 0, inf), (0, 0, -1)),
    )
    for setting, origin, aim in rays:
        try:
            own = f"t = {path(scene, origin, aim).nodes['t'][0]}"
        except ValueError:
            own = "refused"
        t = textbook.sphere(origin, aim, (0, 0, 0), 1.0)
        yield exactly(setting, "refused", own, "a miss" if t == math.inf else f"t = {t}")


@case("J6", "lengths near the smallest double")
def subnormal() -> Iterator[Reading]:
    """Squares of lengths below 1e-162 are 0, and the quadratic has no coefficients left. The answer must be right, or
    the scene refused. The worst is a wrong number without a message.
    """
    for s in (1e-150, 1e-310):
        try:
            own = float(path(world(ball((0, 0, 0), s, MATTE)), (0, 0, 5 * s), (0, 0, -1)).nodes["t"][0])
        except ValueError:
            yield exactly(f"radius {s:g}", "refused", "refused")
            continue
        exact = decimal(5 * s) - decimal(s)
        usual = textbook.sphere((0, 0, 5 * s), (0, 0, -1), (0, 0, 0), s)
        yield Reading(f"radius {s:g}", exact, own, max(U * 4 * s, 5e-324), 4.0, usual)


@case("J7", "two surfaces at the same distance: the first in the file is met")
def ties() -> Iterator[Reading]:
    """Without a rule, the search decides by its order, which may change if any object is added elsewhere: the picture
    flickers.
    """
    corners = ((-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0))
    faces = {"square": Object(Polygon(corners), DARK, "square"), "box": box((-1, -1, -1), (1, 1, 0), DARK, "box")}
    for crowd in (0, 40):  # with more objects a BVH is built, and its traversal has another order
        others = [ball((3 * k - 60, 9, -5), 1, DARK, f"other {k}") for k in range(crowd)]
        for first, second in (("square", "box"), ("box", "square")):
            scene = world(faces[first], *others, faces[second])
            own = path(scene, (0.3, 0.2, 4), (0, 0, -1)).object_name(0) or "none"
            yield exactly(f"{first} before {second}, {crowd} others", first, own)
