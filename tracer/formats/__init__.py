"""Files into scenes. A new format is a file beside this one and its line in READERS."""

from collections.abc import Callable
from pathlib import Path

from tracer.formats.meshes import SUFFIXES, read_mesh_scene
from tracer.formats.nff import SUFFIX, read_nff
from tracer.formats.toml import read_scene
from tracer.scene import Scene, SceneError

READERS: dict[str, Callable[[Path], Scene]] = {
    ".toml": read_scene,
    SUFFIX: read_nff,
    **dict.fromkeys(SUFFIXES, read_mesh_scene),
}


def load(path: str | Path) -> Scene:
    """The scene in a file, its format told by its name. SceneError: every fault, one line each."""
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise SceneError([f"{path}: a scene must be one of {', '.join(READERS)}, got {path.suffix or 'no suffix'}"])
    if path.is_dir():
        raise SceneError([f"{path}: a scene must be a file, got a folder"])
    try:
        return reader(path)
    except FileNotFoundError:
        raise SceneError([f"{path}: file not found"]) from None
    except OSError as error:
        raise SceneError([f"{path}: cannot be read: {error.strerror or error}"]) from None
