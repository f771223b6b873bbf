"""How many digits a tree's numbers have: the rounding errors of every hit point, carried along the rays to first order.

A ray that starts aside by dp and turned by dd meets the next surface aside by dp + t dd, slid along the ray into the
surface; there the normal has turned, too, and with it the ray sent on (ray differentials: Igehy, SIGGRAPH 99). Every
rounding adds a little of its own. What comes together is kept as a matrix C over the six numbers (dp, dd): the sum of
e e' over all errors e, each as it stands at this hit. A hit maps C to J C J', a rounding adds its own e e'. Since
(e1 + ... + en)^2 <= n (e1^2 + ... + en^2) (Cauchy), no sum of n such errors is longer than the root of n tr C, whatever
their signs. So errors that can add up do, and those that a hollow mirror brings together again do not grow: a chaotic
bounce between balls and a million bounces in a light guide are both told as they are.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tracer.compile.bundle import Bundle
from tracer.compile.jit import compiled, inlined, kernel
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, add, dot, scale, subtract, vector
from tracer.kernel.node_rows import rounding_scale
from tracer.kernel.nodes import BLOCKED, REFRACTION, SHADOW
from tracer.kernel.shadows import light_direction
from tracer.rays import make_ray
from tracer.shapes import interaction, normal_derivative

# Roundings of one step, in u: of a hit, in units of the way it was computed from; of a ray's direction, and of what the
# surface that sends it on is told of the one that comes.
IN_PLACE, BEFORE, AFTER = 2.0, 1.0, 2.0


class PropagationSpace(NamedTuple):
    """What `estimate_errors` writes besides the table."""

    matrices: np.ndarray  # (slots, 6, 6): C at hits whose rays are still to come
    slots: np.ndarray  # by row: which of them is its own
    waiting: np.ndarray  # by row: rays still to come
    free: np.ndarray  # stack of slots that are no longer needed
    work: np.ndarray  # (6, 6)


class Step(NamedTuple):
    """A ray from the hit it starts at to the one it ends at, as small changes see it; the eye is no such hit."""

    kind: int
    d: Vector  # direction before the start's surface
    n: Vector  # the normal there, on the side of d
    eta: float  # n1/n2 there
    c1: float
    c2: float
    onward: Vector  # the ray's own direction
    t: float
    facing: Vector  # the normal it ends on
    start: int  # surface it starts on, -1 for the eye
    side: float
    point: Vector  # where it starts
    shadow_way: float  # to a light: how far


def propagate_errors(world: Bundle, table: np.ndarray, count: int) -> None:
    """Fill in `error` and `turn` of a tree's rows."""
    rows = table[:count]
    waiting = np.bincount(rows["parent"][1:], minlength=count).astype(np.int64)
    # How many hits are waited for at most: rays come after their parent, so a count along the rows will do.
    opened = np.cumsum(waiting > 0)
    last = np.zeros(count, np.int64)
    np.maximum.at(last, rows["parent"][1:], np.arange(1, count))
    closed = np.cumsum(np.bincount(last[waiting > 0], minlength=count))
    slots = int((opened - closed).max(initial=0)) + 2
    room = PropagationSpace(
        np.zeros((slots, 6, 6)),
        np.full(count, -1, np.int64),
        waiting,
        np.arange(slots, dtype=np.int64),
        np.zeros((6, 6)),
    )
    first = rows[0]
    size = float(first["reach"]) + (float(first["t"]) if np.isfinite(first["t"]) else 0.0)
    unit_length = math.ldexp(1.0, math.frexp(size)[1]) if 0.0 < size < math.inf else 1.0
    propagate_rows(world, table, count, unit_length, room)


@kernel
def propagate_rows(world: Bundle, table: Any, count: int, length: float, room: PropagationSpace) -> None:
    """`errors_of`, with lengths in units of `length`, a power of two near the scene's size: so no square vanishes."""
    free = len(room.free)
    for i in range(count):
        row = table[i]
        free -= 1
        slot = room.free[free]
        here = room.matrices[slot]
        propagate_row(world, table, i, length, room, here)
        ahead = here[0, 0] + here[1, 1] + here[2, 2]
        turned = here[3, 3] + here[4, 4] + here[5, 5]
        steps = row.depth + 1.0
        row.error = math.sqrt(steps * ahead) * length if 0.0 <= ahead < math.inf else math.inf
        row.turn = math.sqrt(steps * turned) if 0.0 <= turned < math.inf else math.inf
        if not row.t < math.inf:
            row.error = math.nan
        room.slots[i] = slot
        parent = row.parent
        if parent >= 0:
            room.waiting[parent] -= 1
            if room.waiting[parent] == 0:
                room.free[free] = room.slots[parent]
                free += 1
        if room.waiting[i] == 0:
            room.free[free] = slot
            free += 1


@compiled
def propagate_row(world: Any, table: Any, i: int, length: float, room: PropagationSpace, here: Any) -> None:
    """Into `here` the matrix of row i's hit, from the one at its parent's."""
    row, c = table[i], room.work
    parent = row.parent
    for a in range(6):
        for b in range(6):
            c[a, b] = room.matrices[room.slots[parent], a, b] if parent >= 0 else 0.0
    step = make_step(world, table, i)
    if parent >= 0:
        add_rounding(c, 0.0, BEFORE * U)
        apply_jacobian(world, step, length, c, True)
    add_rounding(c, 0.0, AFTER * U)
    apply_jacobian(world, step, length, c, False)
    speed = abs(dot(step.facing, step.onward))
    if row.t < math.inf:
        # Where the ray grazes, a little beside it is much along the surface.
        add_rounding(c, IN_PLACE * U * rounding_scale(row) / length / (speed if speed > 0.0 else 1.0), 0.0)
    for a in range(6):
        for b in range(6):
            here[a, b] = c[a, b]


@compiled
def apply_jacobian(world: Any, step: Step, length: float, c: Any, at_start: bool) -> None:
    """C to J C J': J C, turned over, once more. J is what the surface at the start does, or the way from there."""
    for _ in range(2):
        for b in range(6):
            dp, dd = column(c, b, 0), column(c, b, 3)
            if at_start:
                dd = outgoing_turn(world, step, length, dp, dd)
            else:
                dp = transferred(step, length, dp, dd)
            for a in range(3):
                c[a, b] = dp[a]
                c[a + 3, b] = dd[a]
        for a in range(6):
            for b in range(a):
                c[a, b], c[b, a] = c[b, a], c[a, b]


@inlined
def column(matrix: Any, b: int, first: int) -> Vector:
    return (matrix[first, b], matrix[first + 1, b], matrix[first + 2, b])


@inlined
def add_rounding(c: Any, place: float, direction: float) -> None:
    """Errors of a point and of a direction, no larger than given, that point anywhere."""
    for k in range(3):
        c[k, k] += place * place
        c[k + 3, k + 3] += direction * direction


@inlined
def make_step(world: Any, table: Any, i: int) -> Step:
    row = table[i]
    onward = vector(row.direction)
    nowhere = (0.0, 0.0, 0.0)
    facing = nowhere
    if row.kind == SHADOW:
        if row.end == BLOCKED and row.t > 0.0:
            ray = make_ray(vector(row.origin), onward, row.start, row.side, row.reach)
            _, facing, _ = interaction(world, world.surfaces[row.surface], ray, row.t)
    elif row.surface >= 0:
        facing = vector(row.face)
    t = row.t if row.t < math.inf else 0.0
    parent = table[max(row.parent, 0)]
    d, n = vector(parent.direction), vector(parent.normal)
    eta = parent.n1 / parent.n2 if row.kind == REFRACTION else 1.0
    way = math.inf
    if row.kind == SHADOW:
        _, way = light_direction(world.lights[row.light], vector(row.origin))
    c2 = math.sqrt(max(parent.radicand, 0.0)) if row.kind == REFRACTION else 1.0
    return Step(
        row.kind,
        d,
        n,
        eta,
        -dot(n, d),
        c2,
        onward,
        t,
        facing,
        parent.surface,
        parent.hit_side,
        vector(parent.point),
        way,
    )


@inlined
def outgoing_turn(world: Any, step: Step, length: float, dp: Vector, dd: Vector) -> Vector:
    """How a ray turns whose start moves by dp, in units of `length`, where the ray that led there turns by dd."""
    if step.kind == SHADOW:
        if step.shadow_way == 0.0:
            return (0.0, 0.0, 0.0)  # the light is where the ray starts: it has no direction
        return scale(-length / step.shadow_way, subtract(dp, scale(dot(dp, step.onward), step.onward)))
    dn = scale(step.side, normal_derivative(world, world.surfaces[step.start], step.point, scale(length, dp)))
    return scattered_turn(step, dn, dd)


@inlined
def transferred(step: Step, length: float, dp: Vector, dd: Vector) -> Vector:
    """How the end of a ray moves whose start moves by dp and which turns by dd: along itself into the surface there."""
    moved = add(dp, scale(step.t / length, dd))
    speed = dot(step.facing, step.onward)
    if speed == 0.0:
        return moved
    return subtract(moved, scale(dot(step.facing, moved) / speed, step.onward))


@inlined
def scattered_turn(step: Step, dn: Vector, dd: Vector) -> Vector:
    """How the ray that a surface sends on turns, with the normal turned by dn and the ray that comes by dd."""
    n = step.n
    dc1 = -(dot(dn, step.d) + dot(n, dd))
    if step.kind != REFRACTION:
        # r = d + 2 c1 n
        return add(dd, add(scale(2.0 * dc1, n), scale(2.0 * step.c1, dn)))
    if step.c2 == 0.0 or step.eta == 1.0:
        return dd
    # t = eta d + (eta c1 - c2) n, c2^2 = 1 - eta^2 (1 - c1^2)
    dc2 = step.eta * step.eta * step.c1 * dc1 / step.c2
    bend = step.eta * step.c1 - step.c2
    return add(scale(step.eta, dd), add(scale(step.eta * dc1 - dc2, n), scale(bend, dn)))
