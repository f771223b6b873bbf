"""Rounding errors that the faces of meshes have besides those of other surfaces: of placed corners, and of interpolated
normals.
"""

import math

from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, cross, dot, length, subtract, vector
from tracer.kernel.arrays import Arrays
from tracer.shapes.triangle import interpolated_normal, length_scale

INTERPOLATION = 8.0  # rounding errors of an interpolated normal, in u


@inlined
def placement_error(world: Arrays, s: int) -> float:
    """Bound on the distance by which rounding has moved the corners of a placed mesh's face; 0 for other surfaces."""
    if s < 0 or not world.objects[world.surfaces[s].object].placed:
        return 0.0
    surface = world.surfaces[s]
    return U * max(length(vector(surface.a)), max(length(vector(surface.b)), length(vector(surface.c))))


@compiled
def mesh_normal_rounding(world: Arrays, s: int, p: Vector) -> float:
    """Bound on the own error of the normal at a point of a mesh's face, in radians; 0 for other surfaces.

    Corners that are moved by e tilt the face by up to 2 e over its smallest height. Interpolation weights change by as
    much, and add rounding of their own: relative to the interpolated normal, which is shorter than those at the
    corners.
    """
    surface = world.surfaces[s]
    moved = placement_error(world, s)
    if surface.smooth < 0 and moved == 0.0:
        return 0.0
    a, b, c = vector(surface.a), vector(surface.b), vector(surface.c)
    ab, bc, ca = subtract(b, a), subtract(c, b), subtract(a, c)
    longest = max(length(ab), max(length(bc), length(ca)))
    area = dot(cross(ab, subtract(c, a)), vector(surface.normal))
    tilt = 2.0 * moved * longest / area
    if surface.smooth < 0:
        return tilt
    f = length_scale(surface)
    mixed = length(interpolated_normal(world, surface, p))
    share = f * f * area / mixed if mixed > 0.0 else math.inf  # 1 where all three normals are equal
    return share * (3.0 * tilt + U * INTERPOLATION)
