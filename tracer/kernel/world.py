"""From a scene to flat arrays: what kernels read, with everything left out that this scene does not need.

A shape becomes one row of `surfaces`, a mesh one row a face, in the file's order: a surface's number decides ties.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracer.accel.bvh import MAX_UNBOXED, build
from tracer.compile.bundle import Bundle
from tracer.formulas.camera import View, scene_view
from tracer.formulas.vector import Vector, as_floats, cross, rescale, unit
from tracer.kernel.arrays import LIGHT, MATERIAL, OBJECT, SURFACE, Arrays
from tracer.kernel.left_out import Need, hidden_solids, is_open, needs, open_notes
from tracer.scene import Material, Object, Scene, SceneError, Shape
from tracer.scene.scene import middle_and_radius
from tracer.shapes import CODES
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.planar import PLANE_ERROR
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere

MOST_PLACES = 64  # that are kept in mind

ENDLESS = np.array([[[-np.inf] * 3, [np.inf] * 3]])  # the bounds of what has none


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class World:
    scene: Scene
    arrays: Bundle  # of Arrays
    bounds: np.ndarray  # (n, 2, 3): boxes about every bounded surface
    extent: tuple[Vector, float]  # their middle and the radius about it, for a camera that is left open
    needs: tuple[Need, ...]
    solids: tuple[int, ...]  # objects that bound a medium, by rank
    surrounding: dict[Vector, list[int]] = field(default_factory=dict)  # what `around` has found: the eye stays

    @property
    def left_out(self) -> list[str]:
        """What this scene does without."""
        return [need.name for need in self.needs if not need.needed]

    @property
    def notes(self) -> list[str]:
        """What an author will hardly have meant, though it is no fault."""
        objects, closed = self.scene.objects, self.arrays.objects["closed"]
        solids = [objects[k] for k in self.solids]
        return hidden_solids(solids) + open_notes([objects[k] for k in self.solids if not closed[k]])

    def __repr__(self) -> str:
        scene = self.scene
        name = scene.title or scene.path or "a scene"
        return f"<World of {name}: {len(scene.objects)} objects, {len(scene.lights)} lights>"

    def view(self, size: tuple[int, int] | None = None) -> View:
        """The scene's camera for an image of this size, the scene's own by default."""
        return scene_view(self.scene, self.extent, size)

    def around(self, point: Vector) -> list[int]:
        """Ranks of the transparent solids a point lies in."""
        if point not in self.surrounding:
            if len(self.surrounding) >= MOST_PLACES:
                self.surrounding.clear()
            p, shapes = np.array(point), [self.scene.objects[k].shape for k in self.solids]
            self.surrounding[point] = [rank for rank, shape in enumerate(shapes) if shape.contains(p)]
        return self.surrounding[point]


def prepare(scene: Scene, hierarchy: bool | None = None) -> World:
    """Flatten a scene. SceneError for values that are not allowed, all of them at once.

    The hierarchy of boxes is made where it pays, or as said: the image has the same bits.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"a Scene is prepared, as tracer.load gives it, got {type(scene).__name__}")
    faults = scene.faults()
    if faults:
        raise SceneError(faults)
    materials: dict[Material, int] = {}
    for item in scene.objects:
        materials.setdefault(item.material, len(materials))
    solids = _ranked(scene)
    ranks = {k: rank for rank, k in enumerate(solids)}
    surfaces, corners, smooth, bounds = _surfaces(scene)
    finite = np.asarray(np.isfinite(bounds).all(axis=(1, 2)))
    boxed = finite & (np.count_nonzero(finite) > MAX_UNBOXED if hierarchy is None else hierarchy)
    nodes, blocks, unit = build(_padded(bounds), _triangles(surfaces), boxed)
    arrays = Arrays(
        surfaces=surfaces,
        corners=corners,
        smooth=smooth,
        objects=np.array(
            [_object(item, materials[item.material], ranks.get(k, -1)) for k, item in enumerate(scene.objects)],
            OBJECT,
        ),
        materials=np.array([_material(material) for material in materials], MATERIAL),
        lights=_lights(scene),
        indices=np.array([scene.objects[k].material.ior for k in solids], np.float64),
        background=np.array(scene.background.color, np.float64),
        ambient=np.array(scene.tracing.ambient, np.float64),
        unboxed=np.flatnonzero(~boxed).astype(np.int32),
        nodes=nodes,
        blocks=blocks,
        inverse_unit=np.array([1.0 / unit]),
    )
    found = needs(scene, len(surfaces), len(nodes), len(blocks))
    return World(scene, Bundle(arrays), bounds[finite], _extent(scene, bounds[finite]), found, tuple(solids))


def _extent(scene: Scene, bounds: np.ndarray) -> tuple[Vector, float]:
    """(middle, radius) of the boxes where the camera is placed by them."""
    if len(bounds) == 0 or (scene.camera.position and scene.camera.look_at):
        return ((0.0, 0.0, 0.0), 1.0)
    middle, radius = middle_and_radius(bounds)
    return (as_floats(middle), radius)


def _ranked(scene: Scene) -> list[int]:
    """The objects that bound a medium, highest priority first, in the file's order among equals."""
    solids = [k for k, item in enumerate(scene.objects) if item.material.transmit > 0.0 and not item.thin]
    return sorted(solids, key=lambda k: -scene.objects[k].priority)


def _surfaces(scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    blocks, corners, smooth = [], [np.zeros((0, 3))], [np.zeros((0, 3, 3))]
    bounds: list[np.ndarray] = []
    corner_count = smooth_count = count = 0
    first_such: dict[Shape, int] = {}
    for k, item in enumerate(scene.objects):
        shape = item.shape
        boxes = shape.bounds()
        rows = np.zeros(1 if boxes is None else len(boxes), SURFACE)
        rows["object"], rows["first"], rows["smooth"] = k, -1, -1
        rows["coincident"] = count + np.arange(len(rows))
        if isinstance(shape, Sphere | Cone):  # flat faces find each other by their planes
            rows["coincident"] = first_such.setdefault(shape, count)
        count += len(rows)
        rows["form"] = CODES["triangle" if isinstance(shape, Mesh) else _name(shape)]
        shape.pack(rows)
        if isinstance(shape, Polygon):
            rows["first"] = corner_count
            corners.append(shape.corners())
            corner_count += len(corners[-1])
        if isinstance(shape, Mesh) and (normals := shape.smooth()) is not None:
            rows["smooth"] = smooth_count + np.arange(len(normals))
            smooth.append(normals)
            smooth_count += len(normals)
        blocks.append(rows)
        bounds.append(ENDLESS if boxes is None else boxes)
    return np.concatenate(blocks), np.concatenate(corners), np.concatenate(smooth), np.concatenate(bounds)


def _triangles(surfaces: np.ndarray) -> np.ndarray:
    """The corners (n, 3, 3) of triangles, nan for other surfaces."""
    corners = np.stack([surfaces["a"], surfaces["b"], surfaces["c"]], axis=1)
    corners[surfaces["form"] != CODES["triangle"]] = np.nan
    return corners


def _padded(boxes: np.ndarray) -> np.ndarray:
    """Boxes with room for a ray that starts on the surface inside, but for rounding beside it."""
    pad = 4.0 * PLANE_ERROR * np.abs(boxes).sum(axis=2).max(axis=1, initial=0.0)
    return np.stack([boxes[:, 0] - pad[:, None], boxes[:, 1] + pad[:, None]], axis=1)


def _name(shape: Any) -> str:
    return type(shape).__name__.lower()


def _object(item: Object, material: int, rank: int) -> tuple[Any, ...]:
    shape = item.shape
    normal = _flat_normal(shape)
    u, v = _axes(normal) if normal else ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    return (material, rank, rank >= 0 and not is_open(shape), normal is not None, u, v)


def _flat_normal(shape: Any) -> Vector | None:
    """The normal of a shape whose checker is flat."""
    if isinstance(shape, Plane | Disc):
        return unit(rescale(shape.normal))
    if isinstance(shape, Polygon):
        row = np.zeros(1, SURFACE)
        shape.pack(row)
        return unit(row["normal"][0])
    return None


def _axes(n: Vector) -> tuple[Vector, Vector]:
    """Two axes in the plane with normal n, as near as can be to the world axes that n is not nearest to."""
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    along = max(range(3), key=lambda k: abs(n[k]))
    first, second = (axes[k] for k in range(3) if k != along)
    v = cross(n, first)
    if sum(a * b for a, b in zip(v, second, strict=True)) < 0.0:
        v = (-v[0], -v[1], -v[2])
    v = unit(v)
    u = cross(n, v)
    if sum(a * b for a, b in zip(u, first, strict=True)) < 0.0:
        u = (-u[0], -u[1], -u[2])
    return u, v


def _material(material: Material) -> tuple[Any, ...]:
    checker = material.checker
    return (
        material.color,
        checker.color if checker else (0.0, 0.0, 0.0),
        checker.size if checker else 0.0,
        material.ambient,
        material.diffuse,
        material.specular,
        material.shininess,
        material.reflect,
        material.transmit,
        material.ior,
    )


def _lights(scene: Scene) -> np.ndarray:
    rows = np.zeros(len(scene.lights), LIGHT)
    for row, light in zip(rows, scene.lights, strict=True):
        row["color"] = light.color
        row["distant"] = light.direction is not None
        if light.direction is not None:
            x, y, z = unit(rescale(light.direction))
            row["towards"] = (-x, -y, -z)
        elif light.position is not None:
            row["position"] = light.position
    return rows
