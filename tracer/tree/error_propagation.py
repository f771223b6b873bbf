"""Propagation of rounding errors along the rays of a tree, to first order: how many digits its numbers have.

A ray that is shifted by dp and turned by dd meets the next surface shifted by dp + t dd, then slid along itself into
the surface. There the normal differs, and with it the rays sent on (ray differentials: Igehy, SIGGRAPH 99). Each
rounding adds an error of its own.

Lemma. Let e1 ... en be the rounding errors on the way to a hit, each no longer than its bound b_j in u below, and J_j
the derivative of the hit's (point, direction) by e_j. To first order the hit is off by J_1 e1 + ... + J_n en. Let C be
the sum of b_j^2 J_j J_j', and lambda its largest eigenvalue. Then the hit is off by at most sqrt(n lambda): along a
unit vector w the sum is at most that of b_j |J_j' w|, and the square of a sum of n numbers is at most n times the sum
of their squares, here w'C w. `error` and `turn` are this bound for the point and for the direction.

Assumptions: all decisions were right (`tracer.tree.margins`), and the errors are so small that the derivatives are
constant over them. A grazing hit whose error is not small compared with its distance to the silhouette breaks the
second.

C is a 6 x 6 matrix over (dp, dd), and is propagated itself: a hit maps C to J C J', a rounding adds its own. Errors
that can add up do so, and errors that a concave mirror brings together again do not grow. So both a chaotic bounce
between balls and a million bounces in a light guide are estimated correctly.
"""

import math
from typing import NamedTuple

import numpy as np

from tracer.compile.jit import compiled, inlined, kernel
from tracer.compile.rows import Numbers, Rows
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, dot, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.node_rows import rounding_scale
from tracer.kernel.nodes import SHADOW, NodeRow, PublicRow
from tracer.shapes.planar import HIT
from tracer.tree.mesh_rounding import mesh_normal_rounding, placement_error
from tracer.tree.step_derivatives import Step, make_step, normal_error, outgoing_turn, scattered_turn, transferred

# Bounds on the rounding errors of one step, in u: of the incoming direction as the surface takes it, and of the
# outgoing direction, with that of the normal it was computed from.
INCOMING, OUTGOING = 1.0, 2.0


class PropagationSpace(NamedTuple):
    """The memory that `propagate_rows` writes, besides the table."""

    matrices: np.ndarray  # (slots, 6, 6): C at the hits whose children are still to come
    slots: np.ndarray  # the slot of each row
    waiting: np.ndarray  # for each row, the number of its children still to come
    free: np.ndarray  # stack of unused slots
    work: np.ndarray  # (6, 6)
    errors: np.ndarray  # for each row, the number n of rounding errors on the way to its hit
    bends: np.ndarray  # for each row, the error of the normal at its hit, in radians


def propagate_errors(
    world: Arrays, table: Rows[NodeRow], told: Rows[PublicRow], count: int, first_turn: float
) -> np.ndarray:
    """Fill in `error` and `turn` of the first `count` rows of a node table, which may have several trees.

    The camera rays are off by `first_turn`, besides their rounding. Returns the errors of the normals (count,).
    """
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
        np.zeros(count),
        np.zeros(count),
    )
    first = table[0]
    size = first.magnitude + (first.t if math.isfinite(first.t) else 0.0)
    unit_length = math.ldexp(1.0, math.frexp(size)[1]) if 0.0 < size < math.inf else 1.0
    propagate_rows(world, table, told, count, unit_length, first_turn, space)
    return space.bends


@kernel
def propagate_rows(
    world: Arrays,
    table: Rows[NodeRow],
    told: Rows[PublicRow],
    count: int,
    length: float,
    first_turn: float,
    space: PropagationSpace,
) -> None:
    """`propagate_errors`, with lengths in units of `length`, a power of two near the scene's size: no square
    underflows.
    """
    free = len(space.free)
    for i in range(count):
        row = table[i]
        free -= 1
        slot = space.free[free]
        here = space.matrices[slot]
        propagate_row(world, table, i, length, first_turn, space, here)
        shift, turn = largest_eigenvalue(here, 0), largest_eigenvalue(here, 3)
        errors, out = space.errors[i], told[i]
        out.error = math.sqrt(errors * shift) * length if 0.0 <= shift < math.inf else math.inf
        out.turn = math.sqrt(errors * turn) if 0.0 <= turn < math.inf else math.inf
        if not row.t < math.inf:
            out.error = math.nan
        elif row.kind != SHADOW:
            space.bends[i] = normal_error(world, row, out.error)
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
def largest_eigenvalue(c: Numbers, first: int) -> float:
    """The largest eigenvalue of the 3 x 3 block of a symmetric matrix that begins at (first, first).

    By the cosine of a third of an angle (O. K. Smith, CACM 4(4), 1961). At most the trace, and at least a third of it.
    """
    x, y, z = c[first, first], c[first + 1, first + 1], c[first + 2, first + 2]
    xy, yz, zx = c[first, first + 1], c[first + 1, first + 2], c[first + 2, first]
    mean = (x + y + z) / 3.0
    x, y, z = x - mean, y - mean, z - mean
    spread = math.sqrt((x * x + y * y + z * z + 2.0 * (xy * xy + yz * yz + zx * zx)) / 6.0)
    if not 0.0 < spread < math.inf:
        return mean
    x, y, z, xy, yz, zx = x / spread, y / spread, z / spread, xy / spread, yz / spread, zx / spread
    half = 0.5 * (x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx))
    return mean + 2.0 * spread * math.cos(math.acos(min(max(half, -1.0), 1.0)) / 3.0)


@compiled
def propagate_row(
    world: Arrays,
    table: Rows[NodeRow],
    i: int,
    length: float,
    first_turn: float,
    space: PropagationSpace,
    here: Numbers,
) -> None:
    """Compute in `here` the matrix C at row i's hit, from the one at its parent's."""
    row, c = table[i], space.work
    parent = row.parent
    for a in range(6):
        for b in range(6):
            c[a, b] = space.matrices[space.slots[parent], a, b] if parent >= 0 else 0.0
    step = make_step(world, table, i)
    errors = 2.0
    if parent >= 0:
        errors += space.errors[parent] + 1.0
        add_rounding(c, 0.0, INCOMING * U)
        apply_jacobian(world, step, length, c, True)
        own_bend = mesh_normal_rounding(world, table[parent].surface, vector(table[parent].point))
        if own_bend > 0.0 and step.kind != SHADOW:
            errors += 1.0
            add_bend(c, step, own_bend)
    elif first_turn > 0.0:
        errors += 1.0
        add_rounding(c, 0.0, first_turn)
    add_rounding(c, 0.0, OUTGOING * U)
    apply_jacobian(world, step, length, c, False)
    n_dot_d = abs(dot(step.end_normal, step.direction))
    if row.t < math.inf:
        # At grazing incidence, a small shift of the ray is a large one along the surface.
        own = (HIT * U * rounding_scale(row) + placement_error(world, row.surface)) / length
        if step.end_normal != (0.0, 0.0, 0.0):  # not the end of a shadow ray at its light
            own = own / n_dot_d if n_dot_d > 0.0 else math.inf
        add_rounding(c, own, 0.0)
    space.errors[i] = errors
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
def add_bend(c: Numbers, step: Step, bend: float) -> None:
    """Add the turn of the ray sent out that an error of the normal makes, in any direction."""
    for k in range(3):
        dn = (bend if k == 0 else 0.0, bend if k == 1 else 0.0, bend if k == 2 else 0.0)
        turn = scattered_turn(step, dn, (0.0, 0.0, 0.0))
        for a in range(3):
            for b in range(3):
                c[a + 3, b + 3] += turn[a] * turn[b]
