"""Propagation of rounding errors along the rays of a tree, to first order: how many digits its numbers have.

A ray that is shifted by dp and turned by dd meets the next surface shifted by dp + t dd, then slid along itself into
the surface. There the normal differs, and with it the rays sent on (ray differentials: Igehy, SIGGRAPH 99). Each
rounding adds an error of its own.

The errors at a hit are summed in a matrix C over the six numbers (dp, dd): C is the sum of e e' over all errors e,
each propagated to this hit. A hit maps C to J C J', a rounding adds its own e e'. By Cauchy's inequality (e1 + ... +
en)^2 <= n (e1^2 + ... + en^2), so whatever the signs of the n errors, their sum is no longer than sqrt(n tr C).
Errors that can add up do so, and errors that a concave mirror brings together again do not grow. So both a chaotic
bounce between balls and a million bounces in a light guide are estimated correctly.
"""

import math
from typing import NamedTuple

import numpy as np

from tracer.compile.jit import compiled, inlined, kernel
from tracer.compile.rows import Numbers, Rows
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, add, dot, scale, subtract, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.node_rows import rounding_scale
from tracer.kernel.nodes import BLOCKED, REFRACTION, SHADOW, NodeRow
from tracer.kernel.shadows import light_direction
from tracer.rays import make_ray
from tracer.shapes import interaction, normal_derivative
from tracer.shapes.planar import HIT

# Rounding errors of one step, in u: of the incoming direction as the surface takes it, and of the outgoing direction.
INCOMING, OUTGOING = 1.0, 2.0


class PropagationSpace(NamedTuple):
    """The memory that `propagate_rows` writes, besides the table."""

    matrices: np.ndarray  # (slots, 6, 6): C at the hits whose children are still to come
    slots: np.ndarray  # the slot of each row
    waiting: np.ndarray  # for each row, the number of its children still to come
    free: np.ndarray  # stack of unused slots
    work: np.ndarray  # (6, 6)


class Step(NamedTuple):
    """One ray, from the hit that sent it out to its own hit, with all that its Jacobians need."""

    kind: int
    d: Vector  # direction of the parent ray
    n: Vector  # normal at the parent's hit, on the side of d
    eta: float  # n1/n2 there
    c1: float  # cosines of incidence and refraction there
    c2: float
    direction: Vector  # of this ray
    t: float
    end_normal: Vector  # normal at this ray's hit
    start: int  # id of the surface that the ray leaves, -1 for the eye
    side: float
    point: Vector  # the ray's origin
    light_distance: float  # of a shadow ray


def propagate_errors(world: Arrays, table: Rows[NodeRow], count: int) -> None:
    """Fill in `error` and `turn` of the first `count` rows of a node table, which may have several trees."""
    parent = table["parent"].view(np.ndarray)[:count]
    below = np.flatnonzero(parent >= 0)
    parent = parent[below]
    waiting = np.bincount(parent, minlength=count).astype(np.int64)
    # Rays come after their parent, so counting along the rows gives the largest number of slots in use.
    opened = np.cumsum(waiting > 0)
    last = np.zeros(count, np.int64)
    np.maximum.at(last, parent, below)
    closed = np.cumsum(np.bincount(last[waiting > 0], minlength=count))
    slots = int((opened - closed).max(initial=0)) + 2
    space = PropagationSpace(
        np.zeros((slots, 6, 6)),
        np.full(count, -1, np.int64),
        waiting,
        np.arange(slots, dtype=np.int64),
        np.zeros((6, 6)),
    )
    first = table[0]
    size = first.magnitude + (first.t if math.isfinite(first.t) else 0.0)
    unit_length = math.ldexp(1.0, math.frexp(size)[1]) if 0.0 < size < math.inf else 1.0
    propagate_rows(world, table, count, unit_length, space)


@kernel
def propagate_rows(world: Arrays, table: Rows[NodeRow], count: int, length: float, space: PropagationSpace) -> None:
    """`propagate_errors`, with lengths in units of `length`, a power of two near the scene's size: no square
    underflows.
    """
    free = len(space.free)
    for i in range(count):
        row = table[i]
        free -= 1
        slot = space.free[free]
        here = space.matrices[slot]
        propagate_row(world, table, i, length, space, here)
        shift = here[0, 0] + here[1, 1] + here[2, 2]
        turn = here[3, 3] + here[4, 4] + here[5, 5]
        steps = row.depth + 1.0
        row.error = math.sqrt(steps * shift) * length if 0.0 <= shift < math.inf else math.inf
        row.turn = math.sqrt(steps * turn) if 0.0 <= turn < math.inf else math.inf
        if not row.t < math.inf:
            row.error = math.nan
        space.slots[i] = slot
        parent = row.parent
        if parent >= 0:
            space.waiting[parent] -= 1
            if space.waiting[parent] == 0:
                space.free[free] = space.slots[parent]
                free += 1
        if space.waiting[i] == 0:
            space.free[free] = slot
            free += 1


@compiled
def propagate_row(
    world: Arrays, table: Rows[NodeRow], i: int, length: float, space: PropagationSpace, here: Numbers
) -> None:
    """Compute in `here` the matrix C at row i's hit, from the one at its parent's."""
    row, c = table[i], space.work
    parent = row.parent
    for a in range(6):
        for b in range(6):
            c[a, b] = space.matrices[space.slots[parent], a, b] if parent >= 0 else 0.0
    step = make_step(world, table, i)
    if parent >= 0:
        add_rounding(c, 0.0, INCOMING * U)
        apply_jacobian(world, step, length, c, True)
    add_rounding(c, 0.0, OUTGOING * U)
    apply_jacobian(world, step, length, c, False)
    n_dot_d = abs(dot(step.end_normal, step.direction))
    if row.t < math.inf:
        # At grazing incidence, a small shift of the ray is a large one along the surface.
        own = HIT * U * rounding_scale(row) / length
        if step.end_normal != (0.0, 0.0, 0.0):  # not the end of a shadow ray at its light
            own = own / n_dot_d if n_dot_d > 0.0 else math.inf
        add_rounding(c, own, 0.0)
    for a in range(6):
        for b in range(6):
            here[a, b] = c[a, b]


@compiled
def apply_jacobian(world: Arrays, step: Step, length: float, c: Numbers, at_start: bool) -> None:
    """Replace C by J C J' = J (J C)'. J is that of the scattering (`at_start`), or of the transfer to the next hit."""
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
def column(matrix: Numbers, b: int, first: int) -> Vector:
    """Three numbers of column b, from row `first` on."""
    return (matrix[first, b], matrix[first + 1, b], matrix[first + 2, b])


@inlined
def add_rounding(c: Numbers, point: float, direction: float) -> None:
    """Add errors of a point and of a direction with these sizes, in any direction."""
    for k in range(3):
        c[k, k] += point * point
        c[k + 3, k + 3] += direction * direction


@inlined
def make_step(world: Arrays, table: Rows[NodeRow], i: int) -> Step:
    """The step of row i."""
    row = table[i]
    direction = vector(row.direction)
    nowhere = (0.0, 0.0, 0.0)
    end_normal = nowhere
    if row.kind == SHADOW:
        if row.end == BLOCKED and row.t > 0.0:
            approach, earlier = vector(row.approach), vector(row.before)
            ray = make_ray(vector(row.origin), direction, row.start, row.side, row.magnitude, approach, earlier)
            _, end_normal, _ = interaction(world, world.surfaces[row.surface], ray, row.t)
    elif row.surface >= 0:
        end_normal = vector(row.face_normal)
    t = row.t if row.t < math.inf else 0.0
    parent = table[max(row.parent, 0)]
    d, n = vector(parent.direction), vector(parent.normal)
    eta = parent.n1 / parent.n2 if row.kind == REFRACTION else 1.0
    light_distance = math.inf
    if row.kind == SHADOW:
        _, light_distance = light_direction(world.lights[row.light], vector(row.origin))
    c2 = math.sqrt(max(parent.radicand, 0.0)) if row.kind == REFRACTION else 1.0
    return Step(
        row.kind,
        d,
        n,
        eta,
        -dot(n, d),
        c2,
        direction,
        t,
        end_normal,
        parent.surface,
        parent.hit_side,
        vector(parent.point),
        light_distance,
    )


@inlined
def outgoing_turn(world: Arrays, step: Step, length: float, dp: Vector, dd: Vector) -> Vector:
    """The turn of a ray whose origin is shifted by dp (in units of `length`), and whose parent ray is turned by dd."""
    if step.kind == SHADOW:
        if step.light_distance == 0.0:
            return (0.0, 0.0, 0.0)  # the light is at the ray's origin: it has no direction
        return scale(-length / step.light_distance, subtract(dp, scale(dot(dp, step.direction), step.direction)))
    dn = scale(step.side, normal_derivative(world, world.surfaces[step.start], step.point, scale(length, dp)))
    return scattered_turn(step, dn, dd)


@inlined
def transferred(step: Step, length: float, dp: Vector, dd: Vector) -> Vector:
    """The shift of a hit point if its ray is shifted by dp and turned by dd: it slides along the ray to the surface."""
    shifted = add(dp, scale(step.t / length, dd))
    n_dot_d = dot(step.end_normal, step.direction)
    if n_dot_d == 0.0:
        return shifted
    return subtract(shifted, scale(dot(step.end_normal, shifted) / n_dot_d, step.direction))


@inlined
def scattered_turn(step: Step, dn: Vector, dd: Vector) -> Vector:
    """The turn of a reflected or refracted ray, where the normal is turned by dn and the incoming ray by dd."""
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
