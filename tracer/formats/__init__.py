"""Files into scenes. A new format is a file beside this one and its line in READERS."""

from collections.abc import Callable
from pathlib import Path

from tracer.formats.meshes import SUFFIXES, read_mesh_scene
from tracer.formats.nff import SUFFIX, read_nff
from tracer.formats.toml import read_scene
from tracer.scene import Scene, SceneError

Progress = Callable[[float], None]

# Each is told the file and whom to tell the share of it that has been read.
READERS: dict[str, Callable[[Path, Progress], Scene]] = {
    ".toml": read_scene,
    SUFFIX: read_nff,
    **dict.fromkeys(SUFFIXES, read_mesh_scene),
}


def load(path: str | Path, progress: Progress = lambda share: None) -> Scene:
    """The scene in a file, its format told by its name. SceneError: every fault, one line each.

    `progress` gets the share that has been read, where the format lets it be known.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise SceneError([f"{path}: a scene must be one of {', '.join(READERS)}, got {path.suffix or 'no suffix'}"])
    if path.is_dir():
        raise SceneError([f"{path}: a scene must be a file, got a folder"])
    try:
        return reader(path, progress)
    except FileNotFoundError:
        raise SceneError([f"{path}: file not found"]) from None
    except OSError as error:
        raise SceneError([f"{path}: cannot be read: {error.strerror or error}"]) from None
