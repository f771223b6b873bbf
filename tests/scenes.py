"""Small scenes whose results are known in advance."""

import dataclasses
import json
from collections.abc import Iterable, Sequence

import numpy as np

import tracer
from tracer.formulas.vector import VectorLike, as_floats
from tracer.scene import Background, Camera, Image, Light, Material, Object, Scene, Tracing
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

Shape = Sphere | Plane | Polygon | Triangle | Box | Cone | Disc

GLASS = Material("glass", transmit=1.0, ior=1.5)
MIRROR = Material("mirror", reflect=1.0)
MATTE = Material("matte", diffuse=1.0)
DARK = Material("dark")
OPEN = Material("open", ambient=1.0)
CLEAR = Material("clear", transmit=1.0, ior=1.0)


def ball(
    center: Sequence[float] = (0, 0, 0),
    radius: float = 1.0,
    material: Material = MATTE,
    name: str = "ball",
    **more: object,
) -> Object:
    x, y, z = (float(value) for value in center)
    return Object(Sphere((x, y, z), radius), material, name, **more)  # type: ignore[arg-type]


def plane(point: Sequence[float], normal: Sequence[float], material: Material = MATTE, name: str = "plane") -> Object:
    return Object(Plane(as_floats(point), as_floats(normal)), material, name)


def box(
    low: Sequence[float], high: Sequence[float], material: Material = MATTE, name: str = "box", **more: object
) -> Object:
    return Object(Box(as_floats(low), as_floats(high)), material, name, **more)  # type: ignore[arg-type]


def cone(
    base: VectorLike,
    base_radius: float,
    apex: VectorLike,
    apex_radius: float,
    material: Material = MATTE,
    name: str = "cone",
) -> Object:
    return Object(Cone(as_floats(base), float(base_radius), as_floats(apex), float(apex_radius)), material, name)


def random_cone(random: np.random.Generator, k: int) -> Cone:
    """A random cone; in turn a cylinder, a cone with a tip, one upside down, and frusta of any slope."""
    base = random.normal(size=3)
    apex = base + random.normal(size=3) * 10.0 ** random.uniform(-2, 1)
    r, s = 10.0 ** random.uniform(-1.5, 0.5, 2)
    radii = [(r, r), (r, 0.0), (0.0, r), (r, s), (s, r)][k % 5]
    return Cone(tuple(base.tolist()), float(radii[0]), tuple(apex.tolist()), float(radii[1]))


def disc(
    center: VectorLike, normal: VectorLike, radius: float, material: Material = MATTE, name: str = "disc"
) -> Object:
    return Object(Disc(as_floats(center), as_floats(normal), float(radius)), material, name)


def world_of(*objects: Object, lights: Sequence[Light] = (), **options: object) -> tracer.World:
    """Prepare a scene. Options: background, ambient, model, shadows, depth, camera, image."""
    tracing = Tracing()
    for name in ("ambient", "model", "shadows", "depth"):
        if name in options:
            tracing = dataclasses.replace(tracing, **{name: options.pop(name)})
    background = Background(options.pop("background", (0.0, 0.0, 0.0)))  # type: ignore[arg-type]
    camera = options.pop("camera", Camera(position=(0.0, 0.0, 10.0), look_at=(0.0, 0.0, 0.0)))
    image = options.pop("image", Image(64, 48))
    assert not options, options
    return tracer.prepare(
        Scene(tuple(objects), tuple(lights), camera, image, background, tracing)  # type: ignore[arg-type]
    )


def kinds(tree: tracer.RayTree) -> list[str]:
    return [tree.kind(i) for i in range(len(tree))]


def ends(tree: tracer.RayTree) -> list[str | None]:
    return [tree.end(i) for i in range(len(tree))]


def polygon(corners: Iterable[Iterable[float]], material: Material = MATTE, name: str = "face") -> Object:
    return Object(Polygon(tuple(as_floats(list(corner)) for corner in corners)), material, name)


def sheet(height: float, material: Material) -> Object:
    """A thin horizontal square sheet about the y axis."""
    corners = ((-9.0, height, -9.0), (-9.0, height, 9.0), (9.0, height, 9.0), (9.0, height, -9.0))
    return Object(Polygon(corners), material, "sheet", thin=True)


def cube_mesh(low: np.ndarray, high: np.ndarray) -> Mesh:
    """The mesh of a box, two triangles a side."""
    places = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
    ]
    return Mesh(Geometry(np.array(places, float), np.array([*faces, (1, 5, 7), (1, 7, 3)])), "cube")


NAMED = """
format = 1
title = NAME
[image]
width = 40
height = 30
[[light]]
name = NAME
position = [4, 6, 5]
color = [1, 1, 1]
[[material]]
name = NAME
diffuse = 0.5
reflect = 0.6
transmit = 0.6
ior = 1.5
checker = { color = [0.2, 0.2, 0.2] }
[[object]]
name = NAME
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = NAME
"""


def named_scene(name: str) -> str:
    """The text of a scene file in which the title, the light, the material and the object have this name."""
    return NAMED.replace("NAME", json.dumps(name))
