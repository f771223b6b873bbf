"""The scenes of the cases, and their rays."""

from collections.abc import Sequence

import numpy as np

from tracer.formulas.vector import Vector, as_floats
from tracer.kernel.world import World, prepare
from tracer.scene import Background, Camera, Light, Material, Object, Scene, Tracing
from tracer.shapes.box import Box
from tracer.shapes.plane import Plane
from tracer.shapes.sphere import Sphere
from tracer.tree.batch import RayTrees, trace_rays
from tracer.tree.raytree import RayTree
from tracer.tree.trace import trace

MATTE = Material("matte", diffuse=1.0)
DARK = Material("dark")
MIRROR = Material("mirror", reflect=1.0)


def glass(n: float, name: str = "glass") -> Material:
    """Clear glass, which reflects what Fresnel's equations say."""
    return Material(name, transmit=1.0, ior=n)


def ball(center: Sequence[float], radius: float, material: Material, name: str = "ball", priority: int = 0) -> Object:
    return Object(Sphere(as_floats(center), float(radius)), material, name, priority)


def plane(point: Sequence[float], normal: Sequence[float], material: Material, name: str = "plane") -> Object:
    return Object(Plane(as_floats(point), as_floats(normal)), material, name)


def box(
    low: Sequence[float], high: Sequence[float], material: Material, name: str = "box", priority: int = 0
) -> Object:
    return Object(Box(as_floats(low), as_floats(high)), material, name, priority)


def world(
    *objects: Object, lights: Sequence[Light] = (), background: Vector = (0.0, 0.0, 0.0), model: str = "whitted"
) -> World:
    scene = Scene(
        tuple(objects), tuple(lights), Camera(), background=Background(background), tracing=Tracing(model=model)
    )
    return prepare(scene)


def path(world: World, origin: Sequence[float], direction: Sequence[float], depth: int | None = 0, **limits) -> RayTree:
    """The tree of a ray given by hand."""
    return trace(world, ray=(origin, direction), depth=depth, **limits)


def paths(world: World, origins: Sequence[Sequence[float]], directions: Sequence[Vector], depth: int = 0) -> RayTrees:
    """The trees of many rays given by hand."""
    return trace_rays(world, np.array(origins), np.array(directions), depth=depth)
