"""What of a scene is seen from a figure's eye, as outlines: who is where, and how the light falls on it.

The tracer itself is asked. An image of the scene with every material replaced holds in red the number of the part that
is seen, in green the cosine at which it is seen, and in blue which of the checkers' two colours it has; where a number
changes is an outline. Only camera rays and rays back to the eye are traced, for any shape that the tracer knows, and
what hides what is exact.
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

DARKER = (0.75, 0.45)  # cosines below which a surface is a shade darker


@dataclass(frozen=True)
class Part:
    """What is seen of one object: the spots of its faces, and where they are one and two shades darker."""

    number: int  # of the object
    faces: tuple[tuple[Area, ...], ...]
    checks: tuple[Area, ...]  # squares of the checkers' other colour
    mingled: tuple[Area, ...]  # where squares are too fine to be drawn
    shades: tuple[tuple[Area, ...], ...]
    spots: tuple[Point, ...]  # well within it, those farthest from its rim first


@dataclass(frozen=True)
class Scenery:
    opaque: tuple[Part, ...]
    glass: tuple[Part, ...]  # before all that is opaque; what is behind it is seen through it


def orbit_camera(orbit: Orbit, frame: Frame) -> Camera:
    """The 3D view's eye as a camera of the scene."""

    def outside(place: np.ndarray) -> tuple[float, float, float]:
        x, y, z = (frame.middle + frame.radius * place).tolist()
        return (x, y, z)

    _, up = orbit.axes
    return Camera(outside(orbit.eye), outside(orbit.target), tuple(up.tolist()), math.degrees(FOV))  # type: ignore[arg-type]


def solid_objects(world: World, camera: Camera) -> list[int]:
    """Numbers of the opaque objects that hide what is behind them: walls do so from their camera's side only."""
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
    """What is seen within this rectangle of the canvas."""
    objects = world.scene.objects
    clear = [k for k, item in enumerate(objects) if item.material.transmit > 0.0]
    solid = solid_objects(world, camera)
    opaque = _parts(objects, solid, camera, where, solid)
    if not clear:
        return Scenery(opaque, ())
    # What is opaque is to be named where no glass is before it, glass where nothing opaque is seen through it.
    together = _parts(objects, [*solid, *clear], camera, where, [*solid, *clear])
    free = {part.number: part.spots for part in together}
    opaque = tuple(replace(part, spots=free.get(part.number, part.spots)) for part in opaque)
    behind = [area for part in opaque for face in part.faces for area in face]
    glass = [
        replace(part, spots=tuple(sorted(part.spots, key=lambda spot: any(area.covers(spot) for area in behind))))
        for part in together
        if part.number in clear
    ]
    return Scenery(opaque, tuple(glass))


def _parts(
    objects: Sequence[Object], seen: Sequence[int], camera: Camera, where: Rectangle, wanted: Sequence[int]
) -> tuple[Part, ...]:
    """The wanted of these objects; all of `seen` hide one another."""
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
    for number, (_, face) in enumerate(faces):  # a flat face is of one shade
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
    """The material that says by its colours which part is seen. What is cut into faces has lost its checkers' axes."""
    checker = item.material.checker if shape is item.shape else None
    squares = Checker((red, 1.0, 0.0), checker.size) if checker else None
    return Material(color=(red, 1.0, 1.0), ambient=1.0, diffuse=1.0, checker=squares)


@dataclass(frozen=True)
class Face:
    """What of an object has an outline of its own."""

    shapes: tuple[Shape, ...]

    @property
    def is_flat(self) -> bool:
        return self.shapes[0].plane() is not None


def occluder_world(world: World, camera: Camera) -> World | None:
    """The scene of what can hide a ray from the figure's eye."""
    kept = tuple(world.scene.objects[k] for k in solid_objects(world, camera))
    return tracer.prepare(replace(world.scene, objects=kept, camera=camera)) if kept else None
