"""Whitted's algorithm on one page: the recursion of the lecture, in plain Python, for one ray.

    I = A ka C + sum over lights of S L (kd C (N.L) + ks (R.V)^p) + kr I_reflected + kt I_refracted

(T. Whitted, "An improved illumination model for shaded display", CACM 23(6), 1980.) Read this file first. Then read
`tracer.kernel.trace`: the kernel computes the same colours, but faster, more accurately, and with a record of every
ray. A test compares the two. This page does not handle overlapping solids, and its EPSILON fails in a tiny scene
(lesson `scale`) and in a huge one.

    world = tracer.prepare(tracer.load("scene.toml"))
    view = world.view()
    radiance(world, view.eye, pixel_direction(view, 320.5, 240.5), depth=3)    # the centre of pixel (320, 240)
"""

import math
from typing import NamedTuple

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


class Hit(NamedTuple):
    """The point where a ray meets a surface."""

    point: Vector
    n: Vector  # the normal, on the side that the ray comes from
    material: MaterialRow
    item: ObjectRow
    leaves: bool  # whether the ray comes from inside the object


def radiance(world: World, origin: Vector, v: Vector, depth: int, n1: float = 1.0) -> Vector:
    """The colour seen along a ray, linear RGB: local light, and the light of the reflected and the refracted ray.

    `v` is the ray's direction, a unit vector; `n1` the index of refraction of the medium that it runs in.
    """
    hit = first_hit(world, origin, v)
    if hit is None:
        return vector(world.arrays.background)
    color = local_light(world, hit, v)
    if depth == 0:
        return color
    kr, kt, t, n2 = scatter(world, hit, v, n1)
    if kr > 0.0:
        r = optics.reflect(v, hit.n)
        reflected = radiance(world, hit.point, r, depth - 1, n1)
        color = add(color, scale(kr, reflected))
    if kt > 0.0:
        refracted = radiance(world, hit.point, t, depth - 1, n2)
        color = add(color, scale(kt, refracted))
    return color


def first_hit(world: World, origin: Vector, v: Vector) -> Hit | None:
    """The first hit of a ray, or None."""
    surface, t = closest_hit(world, origin, v)
    if surface is None:
        return None
    point, outward, n = interaction(world.arrays, surface, ray_of(origin, v), t)
    item = world.arrays.objects[surface.object]
    leaves = dot(outward, v) > 0.0
    return Hit(point, scale(-1.0, n) if leaves else n, world.arrays.materials[item.material], item, leaves)


def scatter(world: World, hit: Hit, v: Vector, n1: float) -> tuple[float, float, Vector, float]:
    """(kr, kt, t, n2): the factors of the reflected and the refracted ray, which are Whitted's fixed weights or follow
    from Fresnel's equations; the refracted ray's direction, and the index of the medium that it runs in.
    """
    kr, kt = hit.material.reflect, hit.material.transmit
    uses_fresnel = world.scene.tracing.model == MODELS[FRESNEL]
    is_sheet = bool(hit.item.sheet)
    n2 = 1.0 if hit.leaves and not is_sheet else hit.material.ior
    if kt == 0.0:
        return kr, 0.0, v, n1
    if n1 == n2 and not is_sheet:
        return 0.0, kr + kt if uses_fresnel else kt, v, n2
    reflected, transmitted = optics.fresnel(-dot(v, hit.n), n1, n2)
    if transmitted == 0.0 and not is_sheet:  # total internal reflection
        return kr + kt, 0.0, v, n1
    if uses_fresnel:
        kr, kt = (kr + kt) * reflected, (kr + kt) * transmitted
    if is_sheet:
        return kr, kt, v, n1
    t = optics.refract(v, hit.n, n1, n2)
    assert t  # it is None on total internal reflection only
    return kr, kt, t, n2


def local_light(world: World, hit: Hit, v: Vector) -> Vector:
    """Ambient light, and the light of each lamp that is not in shadow."""
    color = shading.surface_color(hit.material, hit.item, hit.point)
    total = shading.ambient(hit.material, color, vector(world.arrays.ambient))
    for light in world.arrays.lights:
        to_light, distance = light_direction(light, hit.point)
        if dot(hit.n, to_light) > 0.0:
            unshadowed = shading.phong(hit.material, color, vector(light.color), hit.n, to_light, v)
            total = add(total, scale(transmittance(world, hit.point, to_light, distance), unshadowed))
    return total


def transmittance(world: World, point: Vector, to_light: Vector, distance: float) -> float:
    """The fraction S of a light that arrives: a shadow ray passes straight through transparent surfaces, and ends at
    opaque ones.
    """
    share, start = 1.0, 0.0
    while share > 0.0:
        before = start
        surface, start = closest_hit(world, point, to_light, before)
        if surface is None or start >= distance or start == before:  # the last: EPSILON is lost in a huge distance
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
