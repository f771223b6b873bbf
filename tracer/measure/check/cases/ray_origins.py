"""Group C: the origin of the next ray: close surfaces, thin gaps, and rounding errors that must not cause a
self-intersection.
"""

import math
import random
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal

from tracer.formulas.vector import Vector
from tracer.measure.check import textbook
from tracer.measure.check.case import DIGITS, Reading, U, case, decimal, exactly, root
from tracer.measure.check.scenes import DARK, MATTE, MIRROR, ball, glass, path, plane, world
from tracer.scene import Light, Material, Object
from tracer.shapes.polygon import Polygon
from tracer.tree.raytree import RayTree

COAT, CENTER = (0.2, 0.0, 5.0), (0.0, 0.0, 0.0)
GROUND = Material("ground", diffuse=1.0, reflect=0.5)


def second_way(tree: RayTree, radius: float, inner: float) -> Decimal:
    """The distance from a glass ball, n = 1.5, to the ball inside it, with 50 digits. Both are around the origin, the
    ray along -z.
    """
    x, r = decimal(float(tree.nodes[0]["origin"][0])), decimal(radius)
    s, c = DIGITS.divide(x, r), root(1 - DIGITS.divide(x, r) ** 2)
    sine = DIGITS.divide(s, Decimal("1.5"))
    along = r * root(1 - sine**2)  # to the ray's closest point to the centre
    beside = r * sine
    return along - root(decimal(inner) ** 2 - beside**2) if c > 0 else Decimal("NaN")


@case("C1", "glass over an opaque core, a gap of 1e-3 to 1e-15")
def coat() -> Iterator[Reading]:
    """A ray that has just entered the glass must not meet the surface that it starts on, so the textbook discards all
    hits nearer than 1e-4. From a gap of 4e-5 on, it discards the core as well: the ray passes through the opaque
    ball to its far side, 2 units on. Nothing is discarded if the ray stores the surface that it starts on.
    """
    for gap in (1e-3, 4e-5, 1e-6, 1e-9, 1e-12, 1e-15):
        radius = 1.0 + gap
        scene = world(ball(CENTER, radius, glass(1.5), "coat"), ball(CENTER, 1.0, DARK, "core"))
        tree = path(scene, COAT, (0, 0, -1), depth=1)
        hit = textbook.at(COAT, (0, 0, -1), textbook.sphere(COAT, (0, 0, -1), CENTER, radius))
        bent = textbook.refract((0, 0, -1), textbook.unit(hit), 1.0, 1.5) or (0, 0, 0)
        inner, outer = (textbook.sphere(hit, bent, CENTER, r) for r in (1.0, radius))
        yield Reading(
            f"g = {gap:g}", second_way(tree, radius, 1.0), float(tree.nodes["t"][1]), U, 8.0, min(inner, outer)
        )
        beyond = min(inner, outer) > 1.0
        yield exactly(f"g = {gap:g}: met", "core", tree.object_name(1) or "", "far side" if beyond else "core")


def leaning(size: float) -> tuple[Vector, ...]:
    """A square that is parallel to no axis, its normal up and to the side."""
    u, v = textbook.unit((0.8, -0.3, 0.1)), textbook.unit((0.1, 0.2, -0.9))
    return tuple(
        (size * (a * u[0] + b * v[0]), size * (a * u[1] + b * v[1]), size * (a * u[2] + b * v[2]))
        for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))
    )


@case("C2", "a square in the light, from 1e-7 to 1e16 across", seconds=0.07)
def lit_at_any_size() -> Iterator[Reading]:
    """A smallest distance of 1e-4 fits scenes of size 1. At 1e-7 it discards the whole scene. At 1e13 rounding puts
    hits 1e-3 under the square, which then casts a dotted shadow on itself (shadow acne). No number is right for all
    sizes, so none is used.
    """
    chance = random.Random(5)
    for size in (1e-7, 1.0, 1e4, 1e7, 1e13, 1e16):
        corners = leaning(size)
        face = [[y - x for x, y in zip(corners[0], corners[k], strict=True)] for k in (1, 3)]
        n = textbook.unit(textbook.cross(face[0], face[1]))
        n = n if n[1] > 0.0 else [-x for x in n]
        lamp = (0.2 * size, 3.0 * size, 0.1 * size)
        scene = world(Object(Polygon(corners), MATTE, "square"), lights=[Light("lamp", position=lamp)])
        lit = usual = 0
        for _ in range(40):
            aim = [0.3 * size * chance.uniform(-1, 1) for _ in range(3)]
            origin = (-0.5 * size, 2.0 * size, 0.7 * size)
            way = textbook.unit([x - y for x, y in zip(aim, origin, strict=True)])
            tree = path(scene, origin, way)
            lit += any(tree.end(i) == "lit" for i in range(len(tree)))
            t = textbook.plane(origin, way, corners[0], n)
            if t < math.inf:
                hit = textbook.at(origin, way, t)
                up = textbook.unit([x - y for x, y in zip(lamp, hit, strict=True)])
                usual += textbook.plane(hit, up, corners[0], n) == math.inf
        yield exactly(f"s = {size:g}: of 40 points lit", 40, lit, usual)


@case("C4", "a thin clear layer above the ground")
def thin_layer() -> Iterator[Reading]:
    """From the last clear plane the ground is at most 7e-5 away, and the textbook takes everything below 1e-4 for the
    plane that it starts on. It misses the ground, and shows what is behind it.
    """
    for gap in (7e-5, 7e-7, 7e-10, 7e-13):
        low = -1.0 - gap
        scene = world(
            replace(plane((0, 1, 0), (0, 1, 0), glass(1.0), "top"), thin=True),
            replace(plane((0, -1, 0), (0, 1, 0), glass(1.0), "bottom"), thin=True),
            plane((0, low, 0), (0, 1, 0), DARK, "ground"),
        )
        rows = path(scene, (0.25, 3, 0.25), (0, -1, 0), depth=2).nodes
        usual = textbook.plane((0.25, -1.0, 0.25), (0, -1, 0), (0, low, 0), (0, 1, 0))
        for k, (exact, name) in enumerate(((Decimal(2), "top"), (Decimal(2), "bottom"), (-1 - decimal(low), "ground"))):
            got = float(rows["t"][k]) if k < len(rows) else math.nan
            yield Reading(f"g = {gap:g}: to the {name}", exact, got, U, 4.0, usual if k == 2 else None)


@case("C5", "a mirror ball of any size, anywhere: it never meets itself", seconds=0.3)
def never_again() -> Iterator[Reading]:
    """The hit is rounded to the digits of its coordinates: 1e8 from the origin these are 1e-8. The reflected ray then
    starts inside its ball as often as outside, and without a smallest distance (the count shown) many meet it again.
    A smallest distance of 1e-4 hides that, and balls of radius 1e-4 with it.
    """
    chance = random.Random(6)
    again = usual = count = 0
    for _ in range(100):
        radius = 10.0 ** chance.uniform(-4, 4)
        center = [chance.choice((-1, 1)) * 10.0 ** chance.uniform(-8, 8) for _ in range(3)]
        scene = world(ball(center, radius, MIRROR))
        for _ in range(10):
            n, side = ([chance.gauss(0, 1) for _ in range(3)] for _ in range(2))
            eye = [c + 3.0 * radius * x for c, x in zip(center, textbook.unit(n), strict=True)]
            aim = [c + 0.7 * radius * x for c, x in zip(center, textbook.unit(side), strict=True)]
            tree = path(scene, eye, [x - y for x, y in zip(aim, eye, strict=True)], depth=1)
            if len(tree) > 1:
                count += 1
                again += tree.object_name(1) is not None
                start, way = tree.nodes[0]["point"].tolist(), tree.nodes[1]["direction"].tolist()
                usual += textbook.sphere(start, way, center, radius, tmin=0.0) < math.inf
    yield exactly(f"{count} rays: meet their own ball", 0, again, usual)


@case("C7", "a sheet just above the floor casts its shadow")
def thin_shadow() -> Iterator[Reading]:
    """The shadow ray starts on the floor, and the sheet is 1e-5 away. With a smallest distance of 1e-4 the ray passes
    through it, and the floor under the sheet is lit: shadows are detached from objects that stand on the floor.
    """
    lamp, corners = (0.0, 5.0, 0.0), ((-1.0, 1e-5, -1.0), (-1.0, 1e-5, 1.0), (1.0, 1e-5, 1.0), (1.0, 1e-5, -1.0))
    for gap in (1e-3, 1e-5, 1e-9, 1e-15):
        corners = tuple((x, gap, z) for x, _, z in corners)
        scene = world(
            plane((0, 0, 0), (0, 1, 0), MATTE, "floor"),
            Object(Polygon(corners), DARK, "sheet"),
            lights=[Light("lamp", position=lamp)],
        )
        # The camera ray comes in from the side, between sheet and floor.
        tree = path(scene, (1.5, 0.5 * gap, 0), (-1.0, -0.5 * gap, 0))
        up = textbook.unit([x - y for x, y in zip(lamp, tree.nodes[0]["point"].tolist(), strict=True)])
        free = textbook.plane(tree.nodes[0]["point"].tolist(), up, corners[0], (0, 1, 0)) == math.inf
        yield exactly(
            f"{gap:g} above the floor",
            "shadow",
            "shadow" if tree.end(1) == "blocked" else "lit",
            "lit" if free else "shadow",
        )


@case("C9", "a ray that grazes the floor on its way to a wall")
def relay() -> Iterator[Reading]:
    """The other usual method starts the next ray 1e-4 above the floor, along its normal. This ray comes down 1e-4 over
    a kilometre and rises as much: the wall is met at twice the height, wrong by 100 %. The start must be where the
    hit is.
    """
    scene = world(plane((0, 0, 0), (0, 1, 0), GROUND, "floor"), plane((1000, 0, 0), (-1, 0, 0), DARK, "wall"))
    tree = path(scene, (-1000, 1e-4, 0), textbook.unit((1, -1e-7, 0)), depth=1)
    (x, y, _), (dx, dy, _) = (tree.nodes[0][field].tolist() for field in ("origin", "direction"))
    way = DIGITS.divide(-decimal(y), decimal(dy))
    floor = decimal(x) + way * decimal(dx)
    wall = DIGITS.divide((1000 - floor) * -decimal(dy), decimal(dx))
    hit = tree.nodes[0]["point"].tolist()
    yield Reading("x on the floor", floor, hit[0], U * 1000, 4.0)
    up = textbook.reflect((dx, dy, 0.0), (0, 1, 0))
    start = textbook.offset(hit, (0, 1, 0), up)
    usual = textbook.at(start, up, textbook.plane(start, up, (1000, 0, 0), (-1, 0, 0)))[1]
    yield Reading("height on the wall", wall, float(tree.nodes[1]["point"][1]), U * float(wall), 4.0, usual)
