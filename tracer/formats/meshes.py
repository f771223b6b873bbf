"""Mesh files (OBJ, glTF, PLY, STL): as scenes of their own, and as objects of a scene file.

A mesh file is untrusted input: every failure becomes one line.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import numpy as np

from tracer.formats import MESH_READERS, OTHER_MESHES
from tracer.formats.mesh_part import MOST_FACES, MeshFile, Part
from tracer.formats.source import Fault
from tracer.formulas.rotation import rotation_matrix
from tracer.formulas.vector import Vector, as_floats
from tracer.printable import shown_path
from tracer.scene import Camera, Light, Object, Scene, SceneError
from tracer.scene.defaults import default_lights, default_surroundings
from tracer.shapes.mesh import Body, Mesh

UP = {"y": (0.0, 0.0, 0.0), "z": (-90.0, 0.0, 0.0)}  # rotation that makes this axis point upwards


def read_mesh_scene(path: Path, progress: Callable[[float], None], up: str = "y") -> Scene:
    """The scene that consists of this mesh file, with its camera and lights. If it has no lights, the scene is lit
    from above the camera. `up` is the axis of the file that points upwards.
    """
    try:
        found = load_mesh(path, progress)
    except Fault as fault:
        files = (path, fault.file) if fault.file else (path,)
        raise SceneError([fault.within(shown_path(path))], files) from None
    objects = tuple(part_objects(found.parts, path.name, rotate=UP[up]))
    turn = rotation_matrix(UP[up])
    own: dict[str, Any] = default_surroundings()
    if found.camera:
        own["camera"] = _turned_camera(found.camera, turn)
    if found.image:
        own["image"] = found.image
    lights = default_lights(objects)
    if found.lights is not None:
        lights = tuple(_turned_light(light, turn) for light in found.lights)
    notes = tuple(f"{shown_path(path.name)}: {note}" for note in [*found.notes, *found.scene_notes])
    files, title = (path, *found.files), shown_path(path.stem)
    return Scene(objects, lights, title=title, path=path, notes=notes, files=files, **own)


def part_objects(parts: list[Part], file: str, **placement: Any) -> list[Object]:
    """The objects of a mesh file in one place."""
    body = Body()
    meshes = [Mesh(part.geometry, file, body=body, **placement) for part in parts]
    return [Object(mesh, part.material, part.name, thin=part.thin) for mesh, part in zip(meshes, parts, strict=True)]


def load_mesh(path: Path, progress: Callable[[float], None] = lambda share: None) -> MeshFile:
    """Read a mesh file. Raises Fault."""
    suffix = path.suffix.lower()
    if suffix in OTHER_MESHES:
        raise Fault(f"{suffix} files are not read: export it as GLB")
    if suffix not in MESH_READERS:
        raise Fault(f"a mesh must be one of {', '.join(MESH_READERS)}, got {shown_path(path.name)}")
    try:
        found = resolve_name(MESH_READERS[suffix])(path, progress)
    except FileNotFoundError:
        raise Fault("file not found") from None
    except OSError as error:
        raise Fault(f"cannot be read: {error.strerror or error}") from None
    faces = sum(len(part.geometry.faces) for part in found.parts)
    if not 0 < faces <= MOST_FACES:
        raise Fault(f"must have from 1 to {MOST_FACES} triangles with an area, got {faces}")
    return found


def _turned_camera(camera: Camera, turn: np.ndarray) -> Camera:
    assert camera.position and camera.look_at
    eye, middle, up = (_turned(vector, turn) for vector in (camera.position, camera.look_at, camera.up))
    return replace(camera, position=eye, look_at=middle, up=up)


def _turned_light(light: Light, turn: np.ndarray) -> Light:
    position = light.position and _turned(light.position, turn)
    return replace(light, position=position, direction=light.direction and _turned(light.direction, turn))


def _turned(vector: Vector, turn: np.ndarray) -> Vector:
    return as_floats(turn @ np.array(vector))
