"""Whitted's algorithm on one page: the recursion of the lecture, in plain Python, for one ray.

    I = A ka C + sum over lights of S L (kd C (N.L) + ks (R.V)^p) + kr I_reflected + kt I_refracted

(T. Whitted, "An improved illumination model for shaded display", CACM 23(6), 1980.) Read this file first. Then read
`tracer.kernel.trace`: the kernel computes the same colours, but faster, more accurately, and with a record of every
ray. A test compares the two. This page does not handle overlapping solids, and its EPSILON fails in a tiny scene
(lesson `scale`).

    world = tracer.prepare(tracer.load("scene.toml"))
    view = world.view()
    radiance(world, view.eye, pixel_direction(view, 320.5, 240.5), depth=3)    # the centre of pixel (320, 240)
"""

import math

import numpy as np

from tracer.choices import BLOCK, FRESNEL, MODELS, SHADOWS
from tracer.formulas import optics, shading
from tracer.formulas.vector import Vector, add, dot, scale, vector
from tracer.kernel.arrays import MaterialRow, ObjectRow
from tracer.kernel.shadows import light_direction
from tracer.kernel.world import World
from tracer.rays import Ray, make_ray
from tracer.shapes import interaction, intersect
from tracer.shapes.surface_row import SurfaceRow

EPSILON = 1e-4  # the textbook's smallest distance, which keeps a ray from hitting the surface that it leaves


def radiance(world: World, origin: Vector, direction: Vector, depth: int, n1: float = 1.0) -> Vector:
    """The colour seen along a ray, linear RGB: local light, and the light from the reflected and the refracted ray.

    `direction` is a unit vector; `n1` the index of refraction of the medium that the ray runs in.
    """
    surface, t = closest_hit(world, origin, direction)
    if surface is None:
        return vector(world.arrays.background)
    point, outward, shading_normal = interaction(world.arrays, surface, ray_of(origin, direction), t)
    leaves = dot(outward, direction) > 0.0
    n = scale(-1.0, shading_normal) if leaves else shading_normal
    item = world.arrays.objects[surface.object]
    material = world.arrays.materials[item.material]
    color = local_light(world, item, material, point, n, direction)
    if depth == 0:
        return color
    is_sheet = bool(item.sheet)
    n2 = material.ior if is_sheet or not leaves else 1.0
    reflected, refracted = shares(world, material, direction, n, n1, n2, is_sheet)
    if reflected > 0.0:
        mirror = optics.reflect(direction, n)
        color = add(color, scale(reflected, radiance(world, point, mirror, depth - 1, n1)))
    if refracted > 0.0:
        through = direction if is_sheet or n1 == n2 else optics.refract(direction, n, n1, n2)
        assert through  # there is no refracted share on total internal reflection
        color = add(color, scale(refracted, radiance(world, point, through, depth - 1, n1 if is_sheet else n2)))
    return color


def shares(
    world: World, material: MaterialRow, v: Vector, n: Vector, n1: float, n2: float, is_sheet: bool
) -> tuple[float, float]:
    """The factors of the reflected and of the refracted ray: Whitted's fixed weights, or Fresnel's equations."""
    kr, kt = material.reflect, material.transmit
    uses_fresnel = world.scene.tracing.model == MODELS[FRESNEL]
    if kt == 0.0:
        return kr, 0.0
    if n1 == n2 and not is_sheet:
        return 0.0, kr + kt if uses_fresnel else kt
    reflected, transmitted = optics.fresnel(-dot(v, n), n1, n2)
    if transmitted == 0.0 and not is_sheet:  # total internal reflection
        return kr + kt, 0.0
    if uses_fresnel:
        return (kr + kt) * reflected, (kr + kt) * transmitted
    return kr, kt


def local_light(world: World, item: ObjectRow, material: MaterialRow, point: Vector, n: Vector, v: Vector) -> Vector:
    """Ambient light, and the light of each lamp that is not in shadow."""
    color = shading.surface_color(material, item, point)
    total = shading.ambient(material, color, vector(world.arrays.ambient))
    for light in world.arrays.lights:
        to_light, distance = light_direction(light, point)
        if dot(n, to_light) > 0.0:
            unshadowed = shading.phong(material, color, vector(light.color), n, to_light, v)
            total = add(total, scale(transmittance(world, point, to_light, distance), unshadowed))
    return total


def transmittance(world: World, point: Vector, to_light: Vector, distance: float) -> float:
    """The fraction S of a light that arrives: a shadow ray passes straight through transparent surfaces, and ends at
    opaque ones.
    """
    share, start = 1.0, 0.0
    while share > 0.0:
        surface, start = closest_hit(world, point, to_light, start)
        if surface is None or start >= distance:
            return share
        glass = world.arrays.materials[world.arrays.objects[surface.object].material].transmit
        share *= 0.0 if world.scene.tracing.shadows == SHADOWS[BLOCK] else glass
    return 0.0


def closest_hit(world: World, origin: Vector, direction: Vector, start: float = 0.0) -> tuple[SurfaceRow | None, float]:
    """The nearest surface along a ray beyond `start`, and its distance. Every surface is tested."""
    ray, nearest, found = ray_of(origin, direction), math.inf, None
    for surface in world.arrays.surfaces:
        t = intersect(world.arrays, surface, ray, start + EPSILON, math.inf, True)
        if t < nearest:
            nearest, found = t, surface
    return found, nearest


def ray_of(origin: Vector, direction: Vector) -> Ray:
    """The ray as intersection tests take it. numpy's numbers have 1/0 = inf, Python's raise an error."""
    x, y, z = (np.float64(part) for part in direction)
    with np.errstate(divide="ignore"):
        return make_ray(origin, (x, y, z), -1, 0.0, 0.0)
