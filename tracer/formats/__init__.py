"""Readers of scene files. A new format needs a file in this folder and a line in READERS.

Importing this package loads no reader.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from tracer.progress import Progress, ignore

if TYPE_CHECKING:
    from tracer.scene import Scene

# The function of each suffix of a mesh file: (path, progress) -> MeshFile.
MESH_READERS = {
    ".obj": "tracer.formats.obj:read_obj",
    ".ply": "tracer.formats.ply:read_ply",
    ".stl": "tracer.formats.stl:read_stl",
    ".glb": "tracer.formats.gltf.reader:read_gltf",
    ".gltf": "tracer.formats.gltf.reader:read_gltf",
}
CHANGEABLE = ".toml"  # suffix of the scenes whose values can be replaced
UP_AXES = ("y", "z")  # of a mesh file that may point upwards

OTHER_MESHES = (".dae", ".3mf", ".usd", ".usda", ".usdc", ".usdz", ".fbx", ".blend", ".3ds", ".x3d", ".wrl")

# The function of each suffix: (path, progress) -> Scene.
READERS = {
    ".toml": "tracer.formats.toml:read_scene",
    ".nff": "tracer.formats.nff:read_nff",
    **dict.fromkeys(MESH_READERS, "tracer.formats.meshes:read_mesh_scene"),
}


def load(
    path: str | Path,
    progress: Progress = ignore,
    up: str = UP_AXES[0],
    changes: Mapping[str, Any] | None = None,
) -> Scene:
    """Read the scene in a file. The suffix decides on the format.

    `progress` is called with the fraction that has been read, if the reader knows it. `up` is the axis of a mesh file
    that points upwards, one of UP_AXES. `changes` are values that replace those of a .toml file, in nested tables as
    `{"material": {"glass": {"ior": 1.5}}}`. Raises SceneError with every fault.
    """
    from tracer.formats.source import Fault, check_regular
    from tracer.printable import shown_path
    from tracer.scene import SceneError
    from tracer.scene.garbage import no_garbage_collection

    path = Path(path)
    suffix = path.suffix.lower()
    reader = READERS.get(suffix)
    if suffix in OTHER_MESHES:
        raise SceneError([f"{shown_path(path)}: {suffix} files are not read: export it as GLB"])
    if reader is None:
        got = shown_path(path.suffix) or "no suffix"
        raise SceneError([f"{shown_path(path)}: a scene must be one of {', '.join(READERS)}, got {got}"])
    options: dict[str, Any] = {} if up == UP_AXES[0] else {"up": up}
    if options and suffix not in MESH_READERS:
        raise SceneError([f"{shown_path(path)}: only a mesh file has an axis that points upwards (up)"])
    if changes:
        if suffix != CHANGEABLE:
            raise SceneError([f"{shown_path(path)}: only a {CHANGEABLE} scene can be changed (set)"])
        options["changes"] = changes
    try:
        check_regular(path)
        with no_garbage_collection():
            return resolve_name(reader)(path, progress, **options)
    except Fault as fault:
        raise SceneError([fault.within(shown_path(path))]) from None
    except FileNotFoundError:
        raise SceneError([f"{shown_path(path)}: file not found"]) from None
    except OSError as error:
        raise SceneError([f"{shown_path(path)}: cannot be read: {error.strerror or error}"]) from None
