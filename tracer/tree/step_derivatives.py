"""Derivatives of one step of a ray, from the hit that sent it out to its own hit: how it moves and turns when its
origin and its parent's direction do (ray differentials: Igehy, SIGGRAPH 99).
"""

import math
from typing import NamedTuple

from tracer.compile.intrinsics import reference
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Rows
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, add, dot, scale, subtract, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.nodes import BLOCKED, REFRACTION, SHADOW, NodeRow
from tracer.kernel.shadows import light_direction
from tracer.rays import make_ray
from tracer.shapes import interaction, normal_derivative
from tracer.tree.mesh_rounding import mesh_normal_rounding

NORMAL = 1.0  # bound on the rounding error of a normal, in u


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


@inlined
def make_step(world: Arrays, table: Rows[NodeRow], i: int) -> Step:
    """The step of row i."""
    row = table[i]
    direction = vector(row.direction)
    nowhere = (0.0, 0.0, 0.0)
    end_normal = nowhere
    if row.kind == SHADOW:
        if row.end == BLOCKED and row.t > 0.0:
            history = reference(row.history)
            ray = make_ray(vector(row.origin), direction, row.start, row.side, row.magnitude, history)
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


@compiled
def normal_error(world: Arrays, row: NodeRow, error: float) -> float:
    """Bound on the error of the normal at a hit whose point is off by `error`: by the Frobenius norm of its derivative,
    and by the normal's own.
    """
    surface, point = world.surfaces[row.surface], vector(row.point)
    square = 0.0
    for k in range(3):
        along = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
        change = normal_derivative(world, surface, point, along)
        square += dot(change, change)
    bend = math.sqrt(square) * error if square > 0.0 else 0.0  # of a plane 0, even if the error is infinite
    return bend + NORMAL * U + mesh_normal_rounding(world, row.surface, point)
