"""No length is built in: a scene times a power of two has the same trees, bit for bit."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer.formulas.vector import Vector, scale
from tracer.scene import Material, Scene, Shape
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

LENGTHS = ("origin", "point", "t", "error")


@pytest.mark.parametrize("k", [-200, -20, 1, 37, 200])
def test_shipped_scene_of_any_size_has_the_same_trees(world: tracer.World, k: int) -> None:
    s = 2.0**k
    other = tracer.prepare(scaled(world.scene, s))
    width, height = world.scene.image.width, world.scene.image.height
    for x in range(7, width, 97):
        for y in range(5, height, 89):
            expected, found = tracer.trace(world, (x, y)).nodes, tracer.trace(other, (x, y)).nodes
            assert len(found) == len(expected)
            for field in expected.dtype.names or ():
                factor = s if field in LENGTHS else 1
                np.testing.assert_array_equal(found[field], expected[field] * factor, err_msg=f"{field} at {x},{y}")


def scaled(scene: Scene, s: float) -> Scene:
    """The scene with every length multiplied by s."""
    camera = scene.camera
    return replace(
        scene,
        camera=replace(camera, position=place(camera.position, s), look_at=place(camera.look_at, s)),
        lights=tuple(replace(light, position=place(light.position, s)) for light in scene.lights),
        objects=tuple(
            replace(item, shape=shape(item.shape, s), material=material(item.material, s)) for item in scene.objects
        ),
    )


def place(point: Vector | None, s: float) -> Vector | None:
    return None if point is None else scale(s, point)


def material(one: Material, s: float) -> Material:
    return replace(one, checker=replace(one.checker, size=one.checker.size * s)) if one.checker else one


def shape(one: Shape, s: float) -> Shape:
    match one:
        case Sphere():
            return replace(one, center=scale(s, one.center), radius=s * one.radius)
        case Plane():
            return replace(one, point=scale(s, one.point))
        case Box():
            return replace(one, min=scale(s, one.min), max=scale(s, one.max))
        case Polygon():
            return replace(one, vertices=tuple(scale(s, vertex) for vertex in one.vertices))
        case Triangle():
            return replace(one, vertices=tuple(scale(s, vertex) for vertex in one.vertices))
        case Cone():
            ends = {"base": scale(s, one.base), "apex": scale(s, one.apex)}
            return replace(one, base_radius=s * one.base_radius, apex_radius=s * one.apex_radius, **ends)
        case Disc():
            return replace(one, center=scale(s, one.center), radius=s * one.radius)
        case Mesh():
            return replace(one, scale=s * one.scale, translate=scale(s, one.translate))
        case _:
            raise TypeError(type(one).__name__)
