"""Readers of scene files. A new format needs a file in this folder and a line in READERS.

Importing this package loads no reader.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracer.scene import Scene

Progress = Callable[[float], None]

MESH_SUFFIXES = (".obj", ".ply", ".stl", ".glb")

# The function of each suffix: (path, progress) -> Scene.
READERS = {
    ".toml": "tracer.formats.toml:read_scene",
    ".nff": "tracer.formats.nff:read_nff",
    **dict.fromkeys(MESH_SUFFIXES, "tracer.formats.meshes:read_mesh_scene"),
}


def load(path: str | Path, progress: Progress = lambda share: None) -> Scene:
    """Read the scene in a file. The suffix decides on the format.

    `progress` is called with the fraction that has been read, if the reader knows it. Raises SceneError with every
    fault.
    """
    from tracer.scene import SceneError

    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise SceneError([f"{path}: a scene must be one of {', '.join(READERS)}, got {path.suffix or 'no suffix'}"])
    if path.is_dir():
        raise SceneError([f"{path}: a scene must be a file, got a folder"])
    try:
        return resolve_name(reader)(path, progress)
    except FileNotFoundError:
        raise SceneError([f"{path}: file not found"]) from None
    except OSError as error:
        raise SceneError([f"{path}: cannot be read: {error.strerror or error}"]) from None
