"""The number of surfaces from which a BVH pays: the choice of `bvh.FLAT`.

A few shapes of one kind above a floor, side by side or overlapping, as an image of one thread: with a BVH and
without.
"""

import numpy as np

import tracer
from benchmarks.results.figure import Figure, compared, in_turn
from benchmarks.results.task import Options, Task
from tracer.accel.bvh import MAX_UNBOXED
from tracer.formulas.vector import as_floats
from tracer.scene import Camera, Light, Material, Object, Scene
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.plane import Plane
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle

SIZE = (200, 150)
RADII = {"beside one another": 0.15, "through each other": 0.5}
KINDS = ("sphere", "triangle", "box", "cone")
MATERIAL = Material("paint", color=(0.8, 0.5, 0.3), ambient=0.1, diffuse=0.6, specular=0.3, shininess=20.0, reflect=0.3)


def flat(options: Options) -> list[Task]:
    def measure(kind: str) -> list[Figure]:
        found = []
        for where, radius in RADII.items():
            for count in (MAX_UNBOXED, MAX_UNBOXED + 1, 2 * MAX_UNBOXED):
                scene = some(kind, count, radius)
                worlds = [tracer.prepare(scene, hierarchy) for hierarchy in (True, False)]
                boxes, none = in_turn(options.runs, *(lambda world=world: seconds(world) for world in worlds))
                what = f"{count} of {kind}, {where}, in boxes"
                found.append(compared("flat", what, "s", boxes, "one by one", none, faster=True))
        return found

    return [Task(kind, 1.0 * options.runs, lambda kind=kind: measure(kind)) for kind in KINDS]


def seconds(world: tracer.World) -> float:
    return tracer.render(world, SIZE, threads=1, depth=3).seconds["trace"]


def some(kind: str, count: int, radius: float) -> Scene:
    random = np.random.default_rng(2)
    shapes = [shape(kind, random.uniform(-1.0, 1.0, 3), radius, random) for _ in range(count)]
    floor = Plane((0.0, -1.2, 0.0), (0.0, 1.0, 0.0))
    camera = Camera(position=(0.0, 0.5, 4.0), look_at=(0.0, 0.0, 0.0), fov=45.0)
    objects = tuple(Object(item, MATERIAL) for item in (floor, *shapes))
    return Scene(objects, (Light("lamp", position=(2.0, 4.0, 3.0)),), camera)


def shape(kind: str, center: np.ndarray, radius: float, random: np.random.Generator) -> Sphere | Triangle | Box | Cone:
    low, high = as_floats(center - radius), as_floats(center + radius)
    match kind:
        case "sphere":
            return Sphere(as_floats(center), radius)
        case "box":
            return Box(low, high)
        case "cone":
            return Cone(low, 0.5 * radius, high, 0.25 * radius)
    a, b, c = (as_floats(corner) for corner in center + random.normal(size=(3, 3)) * radius)
    return Triangle((a, b, c))
