"""Rounding errors of factors, weights and colours, to first order, from those of points, directions and normals.

A factor is off by what the angle of incidence is off; a weight by its factors. The share of a light is off by the
errors of N.L and R.V. A radiance sums up what is off in its terms. All are bounds on the absolute error, of colours on
that of the largest component. A power and Fresnel's equations are taken at the ends of their argument's range: near
R.V = 0 and near the critical angle their derivatives say little.
"""

import math

import numpy as np

from tracer.choices import WHITTED
from tracer.compile.jit import compiled, kernel
from tracer.compile.rows import Numbers, Rows
from tracer.formulas.double_double import U
from tracer.formulas.optics import shares
from tracer.formulas.shading import surface_color
from tracer.formulas.vector import cross, dot, length, max_component, negate, scale, subtract, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.nodes import FILTERED, SHADOW, NodeRow, PublicRow

TERM = 6.0  # rounding errors of a product or sum of some factors, in u


@kernel
def propagate_light_errors(
    world: Arrays, table: Rows[NodeRow], told: Rows[PublicRow], count: int, model: int, bends: np.ndarray
) -> None:
    """Fill in `factor_error`, `weight_error` and `radiance_error` of the first `count` rows.

    `bends` are the errors of the normals at the hits; `turn` of all rows is known.
    """
    for i in range(count):
        row, out = table[i], told[i]
        factor, weight = max_component(vector(row.factor)), max_component(vector(row.weight))
        parent = row.parent
        out.factor_error, out.weight_error, out.radiance_error = 0.0, 0.0, 0.0
        if parent >= 0:
            out.factor_error = factor_error(world, table, told, i, model, bends)
            above = max_component(vector(table[parent].weight))
            out.weight_error = told[parent].weight_error * factor + above * out.factor_error + U * weight
        if row.kind == SHADOW:
            out.radiance_error = share_error(world, table, told, i, bends)
            told[parent].radiance_error += out.radiance_error
        else:
            out.radiance_error = TERM * U * max_component(vector(row.local))
    for i in range(count - 1, 0, -1):
        row, out = table[i], told[i]
        if row.kind != SHADOW and row.parent >= 0:
            factor, brought = max_component(vector(row.factor)), max_component(vector(row.radiance))
            from_here = factor * out.radiance_error + (out.factor_error + TERM * U * factor) * brought
            told[row.parent].radiance_error += from_here


@compiled
def factor_error(
    world: Arrays, table: Rows[NodeRow], told: Rows[PublicRow], i: int, model: int, bends: Numbers
) -> float:
    """Bound on the error of row i's factor: 0 where it is a number of the scene."""
    row = table[i]
    factor = row.factor[0]
    if row.kind == SHADOW:
        return U * len(world.surfaces) * factor if row.end == FILTERED and factor < 1.0 else 0.0
    above = table[row.parent]
    this = world.objects[above.object]
    material = world.materials[this.material]
    if material.transmit == 0.0 or (model == WHITTED and material.reflect * material.transmit == 0.0):
        return 0.0
    n1, n2 = above.n1, material.ior if this.sheet else above.n2
    if model == WHITTED or n1 == n2:
        return U * factor
    d, n = vector(above.direction), vector(above.normal)
    c1, s1 = -dot(d, n), length(cross(d, n))
    wrong = bends[row.parent] + told[row.parent].turn
    change = 0.0
    here, _ = shares(c1, s1, n1, n2)
    for side in (-1.0, 1.0):
        angle = min(max(math.atan2(s1, c1) + side * wrong, 0.0), 0.5 * math.pi)
        beside, _ = shares(math.cos(angle), math.sin(angle), n1, n2)
        change = max(change, abs(beside - here))
    return (material.reflect + material.transmit) * min(change + wrong * wrong, 1.0) + TERM * U * factor


@compiled
def share_error(world: Arrays, table: Rows[NodeRow], told: Rows[PublicRow], i: int, bends: Numbers) -> float:
    """Bound on the error of a light's share, that of shadow row i."""
    row = table[i]
    if max_component(vector(row.local)) == 0.0:
        return 0.0
    parent = row.parent
    above = table[parent]
    this = world.objects[above.object]
    material, light = world.materials[this.material], world.lights[row.light]
    n, to_light, v = vector(above.normal), vector(row.direction), vector(above.direction)
    n_l = dot(n, to_light)
    r_v = dot(subtract(scale(2.0 * n_l, n), to_light), negate(v))
    color = max_component(surface_color(material, this, vector(above.point)))
    off = material.diffuse * color * min(bends[parent] + told[i].turn, 1.0)  # N.L, where it counts, is from 0 to 1
    if material.specular > 0.0:
        wrong = told[i].turn + 2.0 * bends[parent] + told[parent].turn + TERM * U
        high, low = min(r_v + wrong, 1.0), min(max(r_v - wrong, 0.0), 1.0)
        spread = max(high, 0.0) ** material.shininess - low**material.shininess
        off += material.specular * spread
    visible = row.factor[0]
    largest = max_component(vector(row.local))
    return max_component(vector(light.color)) * visible * off + (TERM * U + told[i].factor_error) * largest
