"""The visible objects of a scene as outlines, with their shading.

The tracer renders an image in which each material is replaced: red is the number of the face, green the cosine at
which it is seen, blue which of the checker's two colours it has. Outlines are where the number changes. Only camera
rays and shadow rays back to the camera are traced, so any shape works, and hidden surfaces are exact.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

import tracer
from tracer.kernel.world import World
from tracer.scene import Background, Camera, Checker, Image, Light, Material, Object, Scene, Tracing
from tracer.shapes.shape import Shape
from viewer.base.orbit import FOV, Frame, Orbit
from viewer.figures.marks import Point, Rectangle
from viewer.figures.visible.layers import layers
from viewer.figures.visible.outlines import (
    FINE,
    SMALL,
    Area,
    is_too_fine,
    label_spots,
    outline_areas,
    pixels_of_numbers,
    window_of,
)

DARKER = (0.75, 0.45)  # cosines below which a surface is one and two shades darker


@dataclass(frozen=True)
class Part:
    """The visible part of one object: the areas of its faces, and of its shades."""

    number: int  # of the object
    faces: tuple[tuple[Area, ...], ...]
    checks: tuple[Area, ...]  # squares of the checker's other colour
    mingled: tuple[Area, ...]  # where the squares are too fine to be drawn
    shades: tuple[tuple[Area, ...], ...]
    spots: tuple[Point, ...]  # for its name: well inside, those farthest from its border first


@dataclass(frozen=True)
class Scenery:
    opaque: tuple[Part, ...]
    glass: tuple[Part, ...]  # drawn over all that is opaque, which is seen through it


def orbit_camera(orbit: Orbit, frame: Frame) -> Camera:
    """The camera of the 3D view as a camera of the scene."""

    def outside(place: np.ndarray) -> tuple[float, float, float]:
        x, y, z = (frame.middle + frame.radius * place).tolist()
        return (x, y, z)

    _, up = orbit.axes
    return Camera(outside(orbit.eye), outside(orbit.target), tuple(up.tolist()), math.degrees(FOV))  # type: ignore[arg-type]


def solid_objects(world: World, camera: Camera) -> list[int]:
    """The opaque objects that hide what is behind them. A wall hides objects only if it is seen from the side of the
    scene's camera.
    """
    eye, own = np.array(camera.position), np.array(world.view().eye)
    found = []
    for k, item in enumerate(world.scene.objects):
        if item.material.transmit > 0.0:
            continue
        if (plane := item.shape.plane()) is not None:
            point, n = np.array(plane[0]), np.array(plane[1])
            from_behind = np.sign((eye - point) @ n) * np.sign((own - point) @ n) < 0.0
        else:
            from_behind = item.shape.contains(own) and not item.shape.contains(eye)
        if not from_behind:
            found.append(k)
    return found


def visible_parts(world: World, camera: Camera, where: Rectangle) -> Scenery:
    """The visible parts inside this rectangle of the canvas."""
    objects = world.scene.objects
    clear = [k for k, item in enumerate(objects) if item.material.transmit > 0.0]
    solid = solid_objects(world, camera)
    opaque = _parts(objects, solid, camera, where, solid)
    if not clear:
        return Scenery(opaque, ())
    # One sees through glass: all of a glass object is drawn that nothing opaque hides, also inside other glass.
    glass = [
        part
        for layer in layers(objects, clear, camera)
        for part in _parts(objects, [*solid, *layer], camera, where, layer)
    ]
    glass.sort(key=lambda part: part.number)
    # A name stands where the fewest other objects are in front or behind: glass over opaque objects or other glass.
    parts = (*opaque, *glass)
    named = [replace(part, spots=_free_first(part, [other for other in parts if other is not part])) for part in parts]
    return Scenery(tuple(named[: len(opaque)]), tuple(named[len(opaque) :]))


def _free_first(part: Part, others: Sequence[Part]) -> tuple[Point, ...]:
    """The spots of a part, those first over which the fewest other parts lie."""
    boxes = [(other, _frame(other)) for other in others]

    def covered(spot: Point) -> int:
        near = [other for other, box in boxes if box[0] <= spot[0] <= box[2] and box[1] <= spot[1] <= box[3]]
        return sum(any(area.covers(spot) for face in other.faces for area in face) for other in near)

    return tuple(sorted(part.spots, key=covered))


def _frame(part: Part) -> Rectangle:
    """The rectangle around a part."""
    across, down = zip(*(point for face in part.faces for area in face for point in area.outline), strict=True)
    return (min(across), min(down), max(across), max(down))


def _parts(
    objects: Sequence[Object], seen: Sequence[int], camera: Camera, where: Rectangle, wanted: Sequence[int]
) -> tuple[Part, ...]:
    """The parts of the wanted objects, as far as `seen` objects do not hide them."""
    faces = [(k, face) for k in seen for face in map(Face, objects[k].shape.faces())]
    if not faces:
        return ()
    paint = [
        Object(shape, _numbered((number + 1) / len(faces), objects[k], shape))
        for number, (k, face) in enumerate(faces)
        for shape in face.shapes
    ]
    left, top, right, bottom = where
    size = (round(right - left), round(bottom - top))
    scene = Scene(
        tuple(paint),
        (Light("eye", position=camera.position, color=(0.0, 1.0, 0.0)),),
        camera,
        Image(FINE * size[0], FINE * size[1]),
        Background((0.0, 0.0, 0.0)),
        Tracing(depth=0, ambient=(1.0, 0.0, 1.0)),
    )
    pixels = tracer.render(tracer.prepare(scene)).pixels
    numbers = np.rint(pixels[..., 0] * len(faces)).astype(np.int32) - 1
    places = pixels_of_numbers(numbers, len(faces))
    cosine = pixels[..., 1].copy()
    for number, (_, face) in enumerate(faces):  # a flat face has one shade
        here = places[number]
        if face.is_flat and len(here):
            cosine.flat[here] = cosine.flat[here].mean()
    own: dict[int, list[int]] = {}
    for number, (k, _) in enumerate(faces):
        own.setdefault(k, []).append(number)
    found = []
    for k in wanted:
        here = np.concatenate([places[number] for number in own[k]])
        if len(here) < SMALL * FINE**2:
            continue
        window, there = window_of(here, numbers.shape, where)
        ours = numbers[window]
        spots = [outline_areas(ours == number, there) for number in own[k]]
        if any(spots):
            mine = np.isin(ours, own[k])
            shades = tuple(outline_areas(mine & (cosine[window] < below), there) for below in DARKER)
            other = mine & (pixels[(*window, 2)] < 0.5)
            fine = mine & is_too_fine(other, mine) if other.any() else other
            checks, mingled = outline_areas(other & ~fine, there), outline_areas(fine, there)
            seen_faces = tuple(spot for spot in spots if spot)
            found.append(Part(k, seen_faces, checks, mingled, shades, label_spots(mine, there)))
    return tuple(found)


def _numbered(red: float, item: Object, shape: object) -> Material:
    """The material whose colours say which face is seen. A face that stands for a part of an object has no checker."""
    checker = item.material.checker if shape is item.shape else None
    squares = Checker((red, 1.0, 0.0), checker.size) if checker else None
    return Material(color=(red, 1.0, 1.0), ambient=1.0, diffuse=1.0, checker=squares)


@dataclass(frozen=True)
class Face:
    """A part of an object that has an outline of its own."""

    shapes: tuple[Shape, ...]

    @property
    def is_flat(self) -> bool:
        return self.shapes[0].plane() is not None


def occluder_world(world: World, camera: Camera) -> World | None:
    """The scene of the objects that can hide a ray."""
    kept = tuple(world.scene.objects[k] for k in solid_objects(world, camera))
    return tracer.prepare(replace(world.scene, objects=kept, camera=camera)) if kept else None
