"""Group E: long chains of reflections, where each bounce inherits the rounding errors of the one before."""

import math
from collections.abc import Iterator
from decimal import Decimal

import numpy as np

from tracer.measure.check import exact_optics, textbook
from tracer.measure.check.case import Reading, U, case, exactly
from tracer.measure.check.scenes import MIRROR, ball, box, glass, path, plane, world
from tracer.scene import Object
from tracer.shapes.cone import Cone

MANY = 2 * 10**6


def far_from(points: np.ndarray, row: int, exact: list[Decimal]) -> float:
    """The distance of a recorded point from the exact one."""
    return math.hypot(*(float(x - y) for x, y in zip(exact_optics.point(points[row].tolist()), exact, strict=False)))


@case("E1", "two mirrors face to face: the height after 100 000 bounces", seconds=0.2)
def parallel() -> Iterator[Reading]:
    """If each start is moved off its mirror by 1e-4 along the normal, each crossing is shorter by that much. The ray
    gains too little height, 1e-4 of a step per bounce, always in the same direction: after 10 000 bounces it is 1e-3
    too low. A start that stays on the mirror has only rounding errors.
    """
    walls = (plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((1, 0, 0), (-1, 0, 0), MIRROR, "right"))
    nodes = path(world(*walls), (0.5, 0, 0), (1, 2.0**-10, 0), 100_000, max_nodes=MANY).nodes
    dx, dy, _ = exact_optics.point(nodes["direction"][0].tolist())
    sides = [((0, 0, 0), (1, 0, 0)), ((1, 0, 0), (-1, 0, 0))]
    for bounces in (1000, 10_000, 100_000):
        exact = (bounces - Decimal("0.5")) * dy / dx
        usual = textbook.mirrors((0.5, 0, 0), (1, 2.0**-10, 0), sides, bounces)[0][1] if bounces <= 10_000 else None
        got = float(nodes["point"][bounces - 1, 1])
        yield Reading(f"height after {bounces}", exact, got, U * bounces * float(exact), 4.0, usual)


@case("E2", "a ray that circles inside a glass ball, totally reflected", seconds=0.09)
def gallery() -> Iterator[Reading]:
    """A start that is moved inwards by 1e-4 lies on another chord. The angle of incidence changes with each bounce, and
    the error of the position grows with the square of their number: 1e-2 after ten bounces, anywhere on the circle
    after a thousand.
    """
    start, d = (math.sin(math.radians(50.0)), 0.0, 0.0), (0.0, 1.0, 0.0)
    nodes = path(world(ball((0, 0, 0), 1.0, glass(1.5))), start, d, 100_000, max_nodes=MANY).nodes
    for bounces in (10, 1000, 100_000):
        exact = exact_optics.round_and_round(start[:2], d[:2], bounces)
        other = textbook.inside_ball(start, d, bounces) if bounces <= 1000 else None
        usual = math.hypot(*(float(e) - x for e, x in zip(exact, other, strict=False))) if other else None
        got = far_from(nodes["point"], bounces, exact)
        yield Reading(f"error of the point, {bounces} bounces", 0, got, U * bounces**2, 2.0, usual)
        yield exactly(f"weight, {bounces} bounces", 1, float(nodes["weight"][bounces, 0]))


@case("E3", "a light guide: how far along it the ray is after 100 000 reflections", seconds=0.2)
def guide() -> Iterator[Reading]:
    """As between two mirrors, every start that is moved off the wall by 1e-4 costs 3e-4 of the path, and all these
    errors have the same sign. After 1000 reflections the point is wrong by 0.3, after 10 000 by 3.
    """
    slab = box((-10, -1, -10), (1e6, 1, 10), glass(1.5))
    nodes = path(world(slab, model="fresnel"), (0, 0, 0), (3, 1, 0), 100_000, max_nodes=MANY).nodes
    dx, dy, _ = exact_optics.point(nodes["direction"][0].tolist())
    for bounces in (1000, 10_000, 100_000):
        exact = (2 * bounces - 1) * dx / dy
        sides = [((0, -1, 0), (0, 1, 0)), ((0, 1, 0), (0, -1, 0))]
        usual = textbook.mirrors((0, 0, 0), (3, 1, 0), sides, bounces)[0][0] if bounces <= 10_000 else None
        got = float(nodes["point"][bounces - 1, 0])
        yield Reading(f"distance along it after {bounces}", exact, got, U * bounces * float(exact), 4.0, usual)


@case("E4", "a skew ray in a mirrored tube", seconds=0.1)
def fibre() -> Iterator[Reading]:
    """The ray winds around the tube by the same angle at each bounce. With starts that are moved off the wall, the
    angle drifts: the error of the position on the wall grows with the square of the number of bounces, that along
    the tube with their number.
    """
    start = (0.2, 0.4, 0.0)
    tube = Object(Cone((0.0, 0.0, -10.0), 1.0, (0.0, 0.0, 1e6), 1.0), MIRROR, "tube")
    nodes = path(world(tube), start, (-2, 1, 2), 100_000, max_nodes=MANY).nodes
    d = nodes["direction"][0].tolist()
    near, far = exact_optics.chord(start[:2], d[:2])
    size = exact_optics.root(sum((exact_optics.decimal(x) ** 2 for x in d[:2]), Decimal(0)))
    length = exact_optics.root(sum(((x - y) ** 2 for x, y in zip(near, far, strict=True)), Decimal(0)))
    first = exact_optics.root(
        sum(((x - exact_optics.decimal(y)) ** 2 for x, y in zip(far, start, strict=False)), Decimal(0))
    )
    for bounces in (10, 1000, 100_000):
        around = exact_optics.round_and_round(start[:2], d[:2], bounces)
        exact = [*around, (first + bounces * length) * exact_optics.decimal(d[2]) / size]
        other = textbook.inside_ball(start, d, bounces, axis=2) if bounces <= 1000 else None
        usual = math.hypot(*(float(e) - x for e, x in zip(exact, other, strict=True))) if other else None
        yield Reading(
            f"off by, {bounces} bounces", 0, far_from(nodes["point"], bounces, exact), U * bounces**2, 2.0, usual
        )


@case("E5", "a corner of three mirrors sends a ray back the way it came", seconds=0.05)
def corner() -> Iterator[Reading]:
    """The textbook's direction is right as well, but its line is not: each of the three starts is moved off its mirror
    by 1e-4, so the ray returns beside the right line, by as much.
    """
    random = np.random.default_rng(7)
    for what, count in (("along the axes", 1), ("turned at random", 60)):
        back, beside, usual = 0.0, 0.0, 0.0
        for _ in range(count):
            axes = np.eye(3) if count == 1 else np.linalg.qr(random.normal(size=(3, 3)))[0].T
            start, d = axes.T @ (0.7, 0.9, 1.2), axes.T @ (-0.5, -0.6, -0.7)
            stage = world(*(plane((0, 0, 0), axis.tolist(), MIRROR, f"mirror {i}") for i, axis in enumerate(axes)))
            nodes = path(stage, start.tolist(), d.tolist(), 3).nodes
            back = max(back, float(np.abs(nodes["direction"][3] + nodes["direction"][0]).max()))
            # The line that it leaves along is the one that it came along, reflected in the corner.
            d0 = nodes["direction"][0]
            beside = max(beside, float(np.linalg.norm(np.cross(nodes["origin"][3] + start, d0))))
            sides = [((0, 0, 0), axis.tolist()) for axis in axes]
            p, _ = textbook.mirrors(start.tolist(), d0.tolist(), sides, 3)
            usual = max(usual, float(np.linalg.norm(np.cross(np.array(p) + start, d0))))
        yield Reading(f"direction, {what}", 0, back, U, 0.0 if count == 1 else 36.0)
        yield Reading(f"place, {what}", 0, beside, U, 36.0, usual)


@case("E7", "to and fro through the centre of a mirrored ball")
def concentric() -> Iterator[Reading]:
    """A ray through the centre meets the ball along its normal and comes back. Moving the start along the normal does
    no harm, as it stays on the diameter: the simplest test hides this error. Rounding errors are left, at most one
    unit per bounce.
    """
    nodes = path(world(ball((0, 0, 0), 1.0, MIRROR)), (0, 0, 0), (0.3, -0.5, 0.81), 10_000).nodes
    d = nodes["direction"][0]
    off = np.linalg.norm(np.cross(nodes["point"], d), axis=1)
    other = np.array(textbook.inside_ball((0, 0, 0), d.tolist(), 1000))
    for bounces in (10, 1000, 10_000):
        usual = float(np.linalg.norm(np.cross(other, d))) if bounces == 1000 else None
        yield Reading(
            f"off the diameter, {bounces} bounces", 0, float(off[: bounces + 1].max()), U * bounces, 2.0, usual
        )


@case("E8", "between two mirrored balls: each bounce multiplies the distance from the axis")
def unstable() -> Iterator[Reading]:
    """A ray at 1e-6 beside the axis leaves it as 1, 3, 11, 41, 153, ... times that, a factor of 3.7 per bounce. Errors
    grow as fast: a start that is moved by 1e-4 along the normal has a relative error of 1e-4 after each bounce,
    which stays. Rounding alone leaves 15 digits.
    """
    centers = ((0.0, 0.0, 0.0), (3.0, 0.0, 0.0))
    stage = world(*(ball(center, 1.0, MIRROR, f"ball {i}") for i, center in enumerate(centers)))
    still = path(stage, (1.5, 0, 0), (1, 0, 0), 1000).nodes
    yield exactly("on the axis, 1000 bounces", 0, float(np.abs(still["point"][:1000, 1]).max()))
    start, d = (1.5, 1e-6, 0.0), (1.0, 0.0, 0.0)
    nodes = path(stage, start, d, 10).nodes
    exact = exact_optics.to_and_fro(start, d, centers, 11)
    usual = textbook.to_and_fro(start, d, centers, 11)
    for k in (1, 4, 7, 10):
        y, got = exact[k][1], float(nodes["point"][k, 1])
        yield Reading(f"height at bounce {k}", y, got, U * float(y) * (k + 1), 8.0, usual[k][1])


@case("E9", "the same off the coordinate axes: a tracer must say when no digit is left")
def chaos() -> Iterator[Reading]:
    """Every bounce multiplies any error by 3.73. Rounding alone, 1e-16, has grown to the size of the balls after 28
    bounces: no double precision can go on, and the textbook's formulas are no worse than ours. But a tracer without
    an error estimate draws the rest as if it were correct. Here the row's `error` shows that no digit is left.
    """
    centers, growth = ((0.0, 0.0, 0.0), (1.3, 2.1, 1.7)), 3.728458374
    stage = world(*(ball(center, 1.0, MIRROR, f"ball {i}") for i, center in enumerate(centers)))
    start, d = (0.65, 1.05, 0.85), (1.3, 2.1, 1.7)
    nodes = path(stage, start, d, 60).nodes
    exact = exact_optics.to_and_fro(start, nodes["direction"][0].tolist(), centers, 30)
    usual = textbook.to_and_fro(start, nodes["direction"][0].tolist(), centers, 30)
    for k in (5, 10, 15, 20):
        got = far_from(nodes["point"], k, exact[k])
        other = math.hypot(*(float(x) - y for x, y in zip(exact[k], usual[k], strict=True)))
        yield Reading(f"off by, bounce {k}", 0, got, 10.0 * U * growth**k, 1.0, other)
        yield Reading(f"error at most as estimated, bounce {k}", 0, got, float(nodes["error"][k]), 1.0)
    gone = int(np.argmax(~(nodes["error"] <= 1.0)))
    said = "yes" if 24 <= gone < 29 else f"at bounce {gone}"
    yield exactly("no digit left before bounce 29", "yes", said)
