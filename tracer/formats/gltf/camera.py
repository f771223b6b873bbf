"""Camera and lights of a glTF document, for a file that is a scene of its own.

Lights of glTF fall off with the square of the distance, and the exposure of its camera is unknown. Ours have no
falloff. So colours are scaled: each light is as strong as it is in the middle of the scene, and a white matte face
there that faced all lights would get 1.
"""

import math

import numpy as np

from tracer.formats.gltf.document import Item
from tracer.formats.gltf.nodes import Placed
from tracer.formats.mesh_part import Part
from tracer.formats.notes import Notes
from tracer.formats.source import Fault
from tracer.formulas.vector import Vector, as_floats
from tracer.printable import printable
from tracer.scene import Camera, Image, Light
from tracer.scene.scene import middle_and_radius

HEIGHT = 480  # pixels of the image of a camera with an aspect ratio
MOST_ASPECT = 8.0


def camera_and_image(document: Item, nodes: list[Placed], notes: Notes) -> tuple[Camera | None, Image | None]:
    """The first perspective camera of the scene, and the image if the camera has an aspect ratio."""
    cameras = document.items("cameras")
    found: tuple[Camera | None, Image | None] = (None, None)
    for placed in nodes:
        if not placed.node.has("camera"):
            continue
        number = placed.node.whole("camera")
        if number >= len(cameras):
            raise Fault(f"{placed.node.place}.camera must be from 0 to {len(cameras) - 1}, got {number}")
        name = placed.node.text("name") or cameras[number].text("name") or f"camera {number}"
        if cameras[number].text("type", "perspective") != "perspective":
            notes.name("orthographic cameras are not taken over", name)
        elif found[0]:
            notes.name("only the first camera is taken over, without", name)
        else:
            found = perspective(cameras[number].item("perspective"), placed.matrix)
    return found


def perspective(lens: Item, matrix: np.ndarray) -> tuple[Camera | None, Image | None]:
    """A camera that looks along the -z axis of its node, with y up."""
    eye, towards, up = matrix[:3, 3], -matrix[:3, 2], matrix[:3, 1]
    if not towards.any() or not up.any():
        return None, None
    fov = math.degrees(lens.number("yfov", math.radians(40.0), 1e-3, math.pi - 1e-3))
    towards = towards / np.abs(towards).max()
    camera = Camera(as_floats(eye), as_floats(eye + towards * max(1.0, float(np.abs(eye).max()))), as_floats(up), fov)
    aspect = lens.number("aspectRatio", 0.0, 0.0)
    if not 1.0 / MOST_ASPECT < aspect < MOST_ASPECT:
        return camera, None
    return camera, Image(max(1, round(HEIGHT * aspect)), HEIGHT)


def lights_of(document: Item, nodes: list[Placed], parts: list[Part], notes: Notes) -> tuple[Light, ...] | None:
    """The lights of the scene (KHR_lights_punctual); None if it has none."""
    known = document.item("extensions").item("KHR_lights_punctual").items("lights")
    bounds = [np.stack([part.geometry.vertices.min(axis=0), part.geometry.vertices.max(axis=0)]) for part in parts]
    middle = middle_and_radius(np.array(bounds))[0] if bounds else np.zeros(3)
    lights, seen, spots = [], 0, 0
    for placed in nodes:
        own = placed.node.item("extensions").item("KHR_lights_punctual")
        if not own.has("light"):
            continue
        number = own.whole("light")
        if number >= len(known):
            raise Fault(f"{own.place}.light must be from 0 to {len(known) - 1}, got {number}")
        light = known[number]
        seen += 1
        color = [
            light.number("intensity", 1.0, 0.0) * value for value in light.numbers("color", [1.0, 1.0, 1.0], least=0.0)
        ]
        name = placed.node.text("name") or light.text("name") or f"light {number}"
        place = placed.matrix[:3, 3]
        spots += light.text("type") == "spot"
        if light.text("type") == "directional":
            direction = as_floats(-placed.matrix[:3, 2])
            if any(direction) and max(color) > 0.0:
                lights.append(Light(printable(name), None, direction, rgb(color)))
            continue
        distance = math.dist(place, middle) or 1.0
        if max(color) > 0.0:
            lights.append(Light(printable(name), as_floats(place), None, rgb([value / distance**2 for value in color])))
    if seen == 0:
        return None
    notes.count("spots are shown without their cones", spots)
    notes.count("lights without intensity are left out", seen - len(lights))
    total = max((sum(light.color[k] for light in lights) for k in range(3)), default=1.0)
    notes.count("lights are scaled to 1 in the middle of the scene, and do not fall off with distance", len(lights))
    return tuple(Light(x.name, x.position, x.direction, rgb([value / total for value in x.color])) for x in lights)


def rgb(values: list[float]) -> Vector:
    return (max(0.0, values[0]), max(0.0, values[1]), max(0.0, values[2]))
