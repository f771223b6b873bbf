"""glTF 2.0 (`.glb`, `.gltf`): meshes placed by nodes, with materials, a camera and lights.

Format: Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), and the extensions in HANDLED.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from tracer.formats.gltf.accessors import Accessors
from tracer.formats.gltf.camera import camera_and_image, lights_of
from tracer.formats.gltf.document import Item, read_document
from tracer.formats.gltf.materials import Materials
from tracer.formats.gltf.nodes import INSTANCING, Placed, instance_count, instances, placed_nodes
from tracer.formats.mesh_part import CLAY, MOST_FACES, MeshFile, Part, make_part
from tracer.formats.notes import Notes
from tracer.formats.source import Fault

HANDLED = {
    "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior", "KHR_materials_emissive_strength",
    "KHR_materials_unlit", "KHR_lights_punctual", "KHR_mesh_quantization", INSTANCING,
}  # fmt: skip
TEXTURE_EXTENSIONS = ("KHR_texture_", "EXT_texture_")  # harmless, since textures are not shown

POINTS_AND_LINES, TRIANGLES, STRIP, FAN = (0, 1, 2, 3), 4, 5, 6  # modes of a primitive


def read_gltf(path: Path, progress: Callable[[float], None]) -> MeshFile:
    """Read a file. Raises Fault."""
    notes = Notes()
    document, binary = read_document(path, notes)
    if not document.item("asset").text("version", "2.0").startswith("2."):
        raise Fault(f"must be glTF 2, got version {document.item('asset').text('version')[:20]}")
    notes.count("other scenes of the file are not shown", max(0, len(document.entries("scenes")) - 1))
    check_extensions(document, notes)
    accessors = Accessors(document, path.parent, binary)
    materials = Materials(document, notes)
    meshes = document.items("meshes")
    nodes = list(placed_nodes(document, notes))
    with_mesh = [placed for placed in nodes if placed.node.has("mesh")]
    check_size(with_mesh, meshes, accessors)
    notes.count("animations are not played", len(document.entries("animations")))
    parts: list[Part | None] = []
    for k, placed in enumerate(with_mesh):
        progress(k / len(with_mesh))
        mesh = mesh_of(placed, meshes)
        name = placed.node.text("name") or mesh.text("name")
        if placed.node.has("skin"):
            notes.name("meshes with a skeleton are shown as they were modelled", name)
        for primitive in mesh.items("primitives"):
            parts += primitive_parts(primitive, name, placed, accessors, materials, notes)
    kept = [part for part in parts if part]
    scene_notes = Notes()
    camera, image = camera_and_image(document, nodes, scene_notes)
    lights = lights_of(document, nodes, kept, scene_notes)
    return MeshFile(
        kept, notes.lines(), tuple(accessors.files), camera, image, lights, scene_notes=tuple(scene_notes.lines())
    )


def check_extensions(document: Item, notes: Notes) -> None:
    """Refuse a file that requires an extension that is not supported. Others that it uses are noted."""
    required = document.entries("extensionsRequired")
    for name in [*required, *document.entries("extensionsUsed")]:
        if not isinstance(name, str):
            raise Fault(f"extensions must be named by texts, got {name!r:.40}")
        if name in HANDLED or name.startswith(TEXTURE_EXTENSIONS):
            continue
        if name in required:
            raise Fault(f"the file needs the extension {name}, which is not supported: export it without")
        notes.name("extensions that are ignored", name)


def mesh_of(placed: Placed, meshes: list[Item]) -> Item:
    number = placed.node.whole("mesh")
    if number >= len(meshes):
        raise Fault(f"{placed.node.place}.mesh must be from 0 to {len(meshes) - 1}, got {number}")
    return meshes[number]


def check_size(with_mesh: list[Placed], meshes: list[Item], accessors: Accessors) -> None:
    """Count the triangles of all instances before anything is built."""
    total = 0
    for placed in with_mesh:
        corners = 0
        for primitive in mesh_of(placed, meshes).items("primitives"):
            position = primitive.item("attributes").whole("POSITION", 0)
            number = primitive.whole("indices", position)
            if number < len(accessors.accessors):
                corners += accessors.accessors[number].whole("count", 0)
        total += instance_count(placed, accessors) * max(1, corners // 3)
        if total > MOST_FACES:
            raise Fault(f"must have at most {MOST_FACES} triangles with all instances, got more")


def primitive_parts(
    primitive: Item,
    name: str,
    placed: Placed,
    accessors: Accessors,
    materials: Materials,
    notes: Notes,
) -> list[Part | None]:
    """The triangles of a primitive, once for each instance of its node."""
    mode = primitive.whole("mode", TRIANGLES, most=FAN)
    attributes = primitive.item("attributes")
    if mode in POINTS_AND_LINES:
        notes.count("sets of points or lines are not shown")
        return []
    if not attributes.has("POSITION"):
        notes.count("primitives without positions are not shown")
        return []
    if any(key.startswith("COLOR_") for key in attributes.value):
        notes.count("vertex colours of primitives are not shown")
    if primitive.entries("targets"):
        notes.count("morph targets of primitives are not shown")
    points = accessors.array(attributes.whole("POSITION"), 3, f"{attributes.place}.POSITION").astype(np.float64)
    corners = np.arange(len(points))
    if primitive.has("indices"):
        corners = accessors.array(primitive.whole("indices"), 1, f"{primitive.place}.indices")[:, 0].astype(np.int64)
    faces = triangles_of(corners, mode)
    normals = None
    if attributes.has("NORMAL"):
        normals = accessors.array(attributes.whole("NORMAL"), 3, f"{attributes.place}.NORMAL").astype(np.float64)
        if len(normals) != len(points):
            raise Fault(f"{attributes.place} must have as many normals as positions, got {len(normals)}")
    material, thin = CLAY, False
    if primitive.has("material"):
        material, thin = materials.get(primitive.whole("material"), primitive.at("material"))
    found = []
    for matrix in instances(placed, accessors):
        linear = matrix[:3, :3]
        with np.errstate(over="ignore", invalid="ignore"):
            moved = points @ linear.T + matrix[:3, 3]
            # Normals are transformed by the inverse transpose, up to a factor.
            turned = None if normals is None else normals @ np.linalg.pinv(linear)
            mirrored = np.linalg.det(linear) < 0.0
        own = faces[:, ::-1] if mirrored else faces
        smooth = None if turned is None else (turned, own)
        try:
            found.append(make_part(name or material.name, moved, own, smooth, material, notes, thin))
        except Fault as fault:
            raise Fault(f"{primitive.place}: {fault}") from None
    return found


def triangles_of(corners: np.ndarray, mode: int) -> np.ndarray:
    """The triangles (n, 3) of a list, a strip or a fan of corners. A rest of one or two corners is left out."""
    if mode == TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    if len(corners) < 3:
        return np.zeros((0, 3), np.int64)
    k = np.arange(len(corners) - 2)
    if mode == FAN:
        return np.stack([corners[k + 1], corners[k + 2], np.broadcast_to(corners[0], len(k))], axis=1)
    odd = k % 2
    return np.stack([corners[k], corners[k + 1 + odd], corners[k + 2 - odd]], axis=1)
