"""Mesh files (OBJ with its materials, PLY, STL, GLB), read by trimesh and checked before and after.

A mesh file is untrusted input: a file of 400 bytes may declare a gigabyte of data, or a vertex may be NaN. Counts
are compared with the file's size before memory is allocated, and every failure becomes one line.
"""

import json
import logging
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tracer.formats import MESH_SUFFIXES
from tracer.scene import Material, Object, Scene, SceneError
from tracer.scene.defaults import default_lights, default_surroundings
from tracer.shapes.mesh import Geometry, Mesh

LARGEST_FILE = 2**30  # bytes
MOST_FACES = 4_000_000

# The material of a file without materials. Materials from a file get the same ambient coefficient, so that no side is
# black.
CLAY = Material(name="clay", color=(0.8, 0.78, 0.74), ambient=0.15, diffuse=0.8)
AMBIENT = 0.15

UNKNOWN_NORMALS = "this trimesh does not tell whether the file has vertex normals, so its faces are flat"


class MeshError(ValueError):
    """A mesh file that cannot be used. The text is one line: what was found and what is allowed."""


@dataclass(frozen=True)
class Part:
    """The triangles of one material."""

    name: str
    geometry: Geometry
    material: Material


def read_mesh_scene(path: Path, progress: Callable[[float], None]) -> Scene:
    """A scene that consists of this mesh, lit from above the camera. trimesh reads the whole file in one call, so
    `progress` is not called.
    """
    if not path.exists():
        raise FileNotFoundError(path)
    try:
        parts = load_parts(path)
    except MeshError as error:
        raise SceneError([f"{path}: {str(error).removeprefix(f'mesh {path.name} ')}"]) from None
    objects = tuple(Object(Mesh(part.geometry, path.name), part.material, part.name) for part in parts)
    lights = default_lights(objects)
    return Scene(objects, lights, title=path.stem, path=path, **default_surroundings())


def load_parts(path: Path) -> list[Part]:
    """The parts of a mesh file, one for each material."""
    if path.suffix.lower() not in MESH_SUFFIXES:
        raise MeshError(f"a mesh must be one of {', '.join(MESH_SUFFIXES)}, got {path.name}")
    if not path.is_file():
        raise MeshError(f"mesh file not found: {path}")
    size = path.stat().st_size
    if size == 0:
        raise MeshError(f"mesh {path.name} must have triangles, got an empty file")
    if size > LARGEST_FILE:
        raise MeshError(f"mesh {path.name} must have at most {LARGEST_FILE} bytes, got {size}")
    document = _check_glb(path) if path.suffix.lower() == ".glb" else {}
    promised = _check_ply(path) if path.suffix.lower() == ".ply" else 0
    meshes = _load(path)
    glass = {str(entry.get("name")): entry for entry in document.get("materials", []) if isinstance(entry, dict)}
    parts = [Part(name, _geometry(path, mesh, place), _material(mesh, glass)) for name, mesh, place in meshes]
    faces = sum(len(part.geometry.faces) for part in parts)
    if 0 < faces < promised:
        raise MeshError(f"mesh {path.name} must have {promised} faces as its header says, got {faces}")
    if not 0 < faces <= MOST_FACES:
        raise MeshError(f"mesh {path.name} must have from 1 to {MOST_FACES} triangles, got {faces}")
    return parts


def _load(path: Path) -> list[tuple[str, Any, np.ndarray]]:
    """(name, mesh, placement as a 4x4 matrix) of everything in the file that has faces."""
    import trimesh  # most scenes do not need it, and it is slow to import

    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # its warnings are replaced by our one-line error
    try:
        # Without processing: trimesh would drop NaN vertices, and merge the vertices of flat faces into smooth ones.
        scene = trimesh.load_scene(path, process=False)
        placed = [scene.graph[node] for node in scene.graph.nodes_geometry]
        found = [(str(name), scene.geometry[name], np.array(place, float)) for place, name in placed]
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        if isinstance(error, IndexError):
            reason = "an index is out of range, for example a face refers to a vertex that does not exist"
        raise MeshError(f"mesh {path.name} cannot be read as {path.suffix[1:].upper()}: {reason[:120]}") from None
    return [item for item in found if isinstance(item[1], trimesh.Trimesh) and len(item[1].faces)]


def _geometry(path: Path, mesh: Any, place: np.ndarray) -> Geometry:
    vertices = np.array(mesh.vertices, np.float64) @ place[:3, :3].T + place[:3, 3]
    faces = np.array(mesh.faces, np.int64)
    if not np.isfinite(place).all():
        raise MeshError(f"mesh {path.name}: the transformation matrix of a part must be finite")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshError(
            f"mesh {path.name}: vertex indices of faces must be from 0 to {len(vertices) - 1}, "
            f"got {faces.min()} to {faces.max()}"
        )
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        raise MeshError(f"mesh {path.name}: vertex {int(bad.argmax())} must be three finite numbers")
    normals = None
    try:
        # A private cache of trimesh, which holds the normals of the file. The public `vertex_normals` computes normals
        # if the file has none.
        has_normals = "vertex_normals" in mesh._cache.cache
    except AttributeError:
        return Geometry(vertices, faces, note=UNKNOWN_NORMALS)
    if has_normals:
        normals = np.array(mesh.vertex_normals, np.float64) @ np.linalg.pinv(place[:3, :3])
        size = np.sqrt((normals * normals).sum(axis=1, keepdims=True))
        usable = np.isfinite(size) & (size > 0.0)
        normals = np.where(usable, normals / np.where(usable, size, 1.0), 0.0)
    return Geometry(vertices, faces, normals)


def _material(mesh: Any, documents: dict[str, Any]) -> Material:
    """The material of a part, as the file describes it."""
    visual: Any = getattr(mesh.visual, "material", None)
    kind = type(visual).__name__
    if kind == "SimpleMaterial":
        return _from_obj(visual)
    if kind == "PBRMaterial":
        return _from_gltf(visual, documents.get(str(visual.name), {}))
    return CLAY


def _from_obj(visual: Any) -> Material:
    """The material of an MTL entry: Kd, Ks, Ns, d, Ni, and illum, which tells mirrors and glass from plain surfaces."""
    entry = visual.kwargs
    if "kd" not in entry:
        return CLAY
    illum = int(_number(entry, "illum", 2))
    shiny = min(1.0, float(np.mean(entry["ks"]))) if "ks" in entry else 0.0
    opacity = _number(entry, "d", 1.0 - _number(entry, "tr", 0.0))
    transmit = min(1.0, max(0.0, 1.0 - opacity))
    if transmit == 0.0 and illum in (6, 7) and "tf" in entry:
        transmit = min(1.0, float(np.mean([float(value) for value in entry["tf"]])))
    return Material(
        name=str(visual.name or "material"),
        color=_color(entry["kd"]),
        ambient=AMBIENT,
        diffuse=1.0 - transmit,
        specular=shiny,
        shininess=max(1.0, _number(entry, "ns", 1.0)),
        reflect=shiny * (1.0 - transmit) if illum in (3, 5, 6, 7, 8) else 0.0,
        transmit=transmit,
        ior=_index(_number(entry, "ni", 1.0)),
    )


def _from_gltf(visual: Any, document: dict[str, Any]) -> Material:
    """The material of a glTF 2.0 entry: metals are mirrors, KHR_materials_transmission and _ior make glass."""
    base = np.array(visual.baseColorFactor if visual.baseColorFactor is not None else (255, 255, 255, 255), float)
    base = base / 255.0 if base.max() > 1.0 else base
    metal = float(visual.metallicFactor) if visual.metallicFactor is not None else 0.0
    rough = float(visual.roughnessFactor) if visual.roughnessFactor is not None else 1.0
    extensions = document.get("extensions", {})
    transmit = float(extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0.0))
    if document.get("alphaMode") == "BLEND":
        transmit = max(transmit, 1.0 - float(base[3]))
    transmit = min(1.0, max(0.0, transmit))
    smoothness = min(1.0, max(0.0, 1.0 - rough))
    return Material(
        name=str(visual.name or "material"),
        color=_color(base[:3]),
        ambient=AMBIENT,
        diffuse=(1.0 - 0.7 * metal) * (1.0 - transmit),
        specular=0.5 * smoothness,
        shininess=1.0 + 200.0 * smoothness**2,
        reflect=0.7 * metal * smoothness,
        transmit=transmit,
        ior=_index(float(extensions.get("KHR_materials_ior", {}).get("ior", 1.5))),
    )


def _number(entry: dict[str, Any], key: str, default: float) -> float:
    value = entry.get(key, default)
    try:
        number = float(value[0] if isinstance(value, list) else value)
    except (TypeError, ValueError, IndexError):
        return default
    return number if math.isfinite(number) else default


def _color(values: Any) -> tuple[float, float, float]:
    r, g, b = (min(1.0, max(0.0, float(value))) if math.isfinite(float(value)) else 0.0 for value in list(values)[:3])
    return (r, g, b)


def _index(ior: float) -> float:
    return ior if math.isfinite(ior) and ior > 0.0 else 1.0


def _check_glb(path: Path) -> dict[str, Any]:
    """The JSON chunk of a GLB file. Checks its counts against the file's size (glTF 2.0, 4.4)."""
    size = path.stat().st_size
    with path.open("rb") as file:
        header = file.read(20)
        if len(header) < 20 or header[:4] != b"glTF" or header[16:20] != b"JSON":
            raise MeshError(f'mesh {path.name} cannot be read as GLB: it must begin with "glTF" and a JSON chunk')
        length = struct.unpack("<I", header[12:16])[0]
        text = file.read(min(length, size))
    try:
        document = json.loads(text)
        accessors = document.get("accessors", [])
        counts = [int(accessor.get("count", 0)) for accessor in accessors]
    except (ValueError, AttributeError, TypeError, RecursionError):
        raise MeshError(f"mesh {path.name} cannot be read as GLB: its JSON chunk is invalid") from None
    for k, count in enumerate(counts):
        # Every element takes at least a byte of the file, unless the accessor has no buffer view.
        if not 0 <= count <= size or ("bufferView" not in accessors[k] and count > MOST_FACES // 100):
            raise MeshError(
                f"mesh {path.name}: accessor {k} must have no more elements than the file holds, got {count}"
            )
    return document


def _check_ply(path: Path) -> int:
    """The number of faces in the header of a PLY file. Checks its counts against the file's size."""
    promised = 0
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(65536)
    for line in head.split(b"end_header")[0].splitlines():
        words = line.split()
        if len(words) != 3 or words[0] != b"element" or not words[2].isdigit():
            continue
        name, count = words[1].decode("ascii", "replace"), int(words[2])
        if count > size:
            raise MeshError(f"mesh {path.name}: it must have no more elements than bytes, got {count} of {name}")
        if name == "face":
            promised = count
    return promised
