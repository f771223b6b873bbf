"""Random scenes of every shape, material and light, for tests that compare whole trees with the judge's."""

import math
from dataclasses import replace

import numpy as np

from tests.scenes import random_cone
from tracer.choices import MODELS
from tracer.formulas.vector import as_floats
from tracer.scene import Background, Camera, Image, Light, Material, Object, Scene, Tracing
from tracer.scene.scene import Checker
from tracer.shapes import Shape
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

SHAPES = ("sphere", "plane", "polygon", "triangle", "box", "cone", "closed cone", "disc", "mesh", "smooth mesh")


def random_shape(random: np.random.Generator, kind: str, size: float = 1.0) -> Shape:
    """A shape about `size` across, near the origin."""
    place = 1.0 * size * random.normal(size=3)
    a, b, c = size * random.normal(size=(3, 3))
    middle, way = as_floats(place), as_floats(random.normal(size=3))
    match kind:
        case "sphere":
            return Sphere(middle, size * float(random.uniform(0.3, 1.2)))
        case "plane":
            return Plane(middle, way)
        case "polygon":
            return Polygon(tuple(as_floats(place + arm) for arm in (0.0 * a, a, a + 0.7 * b, b)))
        case "triangle":
            return Triangle(tuple(as_floats(place + arm) for arm in (a, b, c)))
        case "box":
            half = size * random.uniform(0.2, 1.0, 3)
            return Box(as_floats(place - half), as_floats(place + half))
        case "cone" | "closed cone":
            one = random_cone(random, int(random.integers(5)))
            ends = (as_floats(size * np.array(one.base)), as_floats(size * np.array(one.apex)))
            radii = (size * one.base_radius, size * one.apex_radius)
            return Cone(ends[0], radii[0], ends[1], radii[1], kind == "closed cone")
        case "disc":
            return Disc(middle, way, size * float(random.uniform(0.3, 1.5)))
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * random.uniform(0.4, 1.0, (4, 1))
    normals = None
    if kind == "smooth mesh":
        normals = corners + 0.3 * random.normal(size=(4, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    geometry = Geometry(corners, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]), normals)
    return Mesh(geometry, "mesh", size, as_floats(random.uniform(-180, 180, 3)), middle)


def random_material(random: np.random.Generator, k: int, size: float = 1.0) -> Material:
    """In turn a matte surface, a checkered one, a mirror, clear glass, and glass with a highlight."""
    color, dark = as_floats(random.uniform(size=3)), as_floats(random.uniform(size=3))
    matte = {
        "color": color,
        "ambient": 0.2,
        "diffuse": 0.6,
        "specular": 0.3,
        "shininess": float(random.integers(1, 60)),
    }
    match k % 5:
        case 0:
            return Material(f"matte {k}", **matte)
        case 1:
            return Material(f"tiles {k}", checker=Checker(dark, size * float(random.uniform(0.2, 2.0))), **matte)
        case 2:
            return Material(f"mirror {k}", reflect=float(random.uniform(0.3, 0.95)), diffuse=0.05)
        case 3:
            return Material(f"glass {k}", transmit=float(random.uniform(0.3, 1.0)), ior=float(random.uniform(1.0, 2.5)))
    ior = float(random.uniform(0.6, 1.9))
    return Material(f"shiny {k}", transmit=0.8, reflect=0.1, ior=ior, specular=0.4, shininess=30.0, diffuse=0.05)


def far_placed(random: np.random.Generator, mesh: Mesh) -> Mesh:
    """The same mesh from a file with coordinates up to 1e9 off, which its placement moves back."""
    away = 10.0 ** random.uniform(2, 9) * random.normal(size=3)
    geometry = replace(mesh.geometry, vertices=mesh.geometry.vertices + away)
    back = Mesh(geometry, mesh.file, mesh.scale, mesh.rotate, (0.0, 0.0, 0.0)).vertices().mean(axis=0)
    return replace(mesh, geometry=geometry, translate=as_floats(np.array(mesh.translate) - back))


def stiff_scene(seed: int) -> Scene:
    """A random scene of any size, with a camera that is nearly turned along its `up` or nearly 180 degrees wide, and
    meshes whose placement cancels.
    """
    random = np.random.default_rng(seed)
    scene = random_scene(seed, size=2.0 ** float(random.integers(-60, 60)))
    objects = tuple(
        replace(item, shape=far_placed(random, item.shape)) if isinstance(item.shape, Mesh) else item
        for item in scene.objects
    )
    camera = scene.camera
    assert camera.position is not None and camera.look_at is not None
    gaze = np.subtract(camera.look_at, camera.position)
    up = gaze / np.linalg.norm(gaze) + 10.0 ** random.uniform(-9, 0) * random.normal(size=3)
    fov = 180.0 - 10.0 ** float(random.uniform(-6, 2)) if random.random() < 0.3 else camera.fov
    return replace(scene, objects=objects, camera=replace(camera, up=as_floats(up), fov=fov))


def random_scene(seed: int, kinds: tuple[str, ...] = SHAPES, size: float = 1.0) -> Scene:
    """Three to eight objects of these kinds, a camera that looks at them, a lamp and a distant light."""
    random = np.random.default_rng(seed)
    objects = []
    for k in range(int(random.integers(3, 9))):
        shape = random_shape(random, kinds[int(random.integers(len(kinds)))], size)
        material = random_material(random, int(random.integers(5)) + 5 * k, size)
        thin = material.transmit > 0.0 and bool(random.random() < 0.15)
        objects.append(Object(shape, material, f"{shape.name} {k}", int(random.integers(-1, 2)), thin))
    eye = size * (4.0 * unit_vector(random) + 0.5 * random.normal(size=3))
    lights = (
        Light("lamp", position=as_floats(size * 8.0 * unit_vector(random)), color=as_floats(random.uniform(size=3))),
        Light("sun", direction=as_floats(random.normal(size=3)), color=(0.4, 0.4, 0.4)),
    )
    up = as_floats(random.normal(size=3))
    camera = Camera(as_floats(eye), as_floats(0.3 * size * random.normal(size=3)), up, float(random.uniform(15, 70)))
    tracing = Tracing(4, "filter", MODELS[int(random.integers(len(MODELS)))])
    return Scene(tuple(objects), lights, camera, Image(32, 24), Background((0.2, 0.3, 0.5)), tracing)


def unit_vector(random: np.random.Generator) -> np.ndarray:
    way = random.normal(size=3)
    return way / math.hypot(*way)
