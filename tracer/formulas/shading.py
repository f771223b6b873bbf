"""Local illumination: the light that a surface point sends towards the eye by itself, before any ray is followed.

Whitted's model with Phong's highlight (CACM 23(6), 1980; slides "Ray Tracing" and "Reflection direction for Phong
model"): I = A ka C + sum over the lights of S L (kd C (N.L) + ks (R.V)^p). A is the ambient light, C the surface's
colour, L a light's colour, S the fraction of it that the shadow ray lets through.
"""

import math
from typing import Protocol

import numpy as np

from tracer.compile.jit import inlined
from tracer.compile.rows import Bool, Float, Float3
from tracer.formulas.vector import Vector, add, dot, multiply, negate, scale, subtract, vector


class Material(Protocol):
    """The numbers of a material that its local light depends on: ka, kd, ks, p, C."""

    ambient: Float
    diffuse: Float
    specular: Float
    shininess: Float
    color: Float3
    checker_color: Float3
    checker_size: Float  # 0: no checker


class Tiling(Protocol):
    """The axes of a surface's checker."""

    tiled: Bool  # the checker is one of squares along u and v
    u: Float3
    v: Float3


@inlined
def ambient(material: Material, color: Vector, world_ambient: Vector) -> Vector:
    """A ka C."""
    return scale(material.ambient, multiply(world_ambient, color))


@inlined
def phong(material: Material, color: Vector, light: Vector, n: Vector, to_light: Vector, v: Vector) -> Vector:
    """L (kd C (N.L) + ks (R.V)^p): the contribution of one unshadowed light. `to_light` is a unit vector with N.L > 0,
    `v` the ray.
    """
    n_l = dot(n, to_light)
    r = subtract(scale(2.0 * n_l, n), to_light)
    r_v = dot(r, negate(v))
    share = scale(material.diffuse * n_l, color)
    if material.specular > 0.0 and r_v > 0.0:
        highlight = material.specular * math.pow(r_v, material.shininess)
        share = add(share, (highlight, highlight, highlight))
    return multiply(light, share)


@inlined
def surface_color(material: Material, surface: Tiling, point: Vector) -> Vector:
    """C: the material's colour, or its checker's colour where the cell indices add up to an odd number.

    On planes, polygons and discs (`surface.tiled`) the cells are squares along the surface's own two axes, elsewhere
    cubes along the axes of the world.
    """
    size = material.checker_size
    if size > 0.0:
        if surface.tiled:
            cells = np.floor(dot(vector(surface.u), point) / size) + np.floor(dot(vector(surface.v), point) / size)
        else:
            cells = np.floor(point[0] / size) + np.floor(point[1] / size) + np.floor(point[2] / size)
        if cells - 2.0 * np.floor(0.5 * cells) != 0.0:
            return vector(material.checker_color)
    return vector(material.color)
