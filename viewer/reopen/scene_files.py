"""The files that a scene was read from: their content, to be carried in a figure, and their checksums."""

import hashlib
import os
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from tracer.formats.source import Fault, check_regular
from tracer.scene import Scene

MOST_KEPT = 16 * 2**20  # bytes of all files of a scene that are kept in memory


@dataclass(frozen=True)
class SceneFile:
    """One file. `name` is its path from the scene's folder, with slashes."""

    name: str
    sha256: str  # empty: there was no such file, for example a material library
    content: bytes | None = None  # None: too large to keep, or it cannot stand elsewhere


@dataclass(frozen=True)
class SceneFiles:
    """All files of a scene. `folder` is the lowest that has them all; names are relative to it."""

    folder: Path
    main: str  # of the scene itself
    lesson: str = ""  # of the lesson's text, if the scene belongs to one
    files: tuple[SceneFile, ...] = ()

    def are_in(self, folder: Path) -> bool:
        """Whether the same files, with the same content, are in this folder."""
        return all(checksum(folder / file.name) == file.sha256 for file in self.files)


def scene_files(scene: Scene, lesson: Path | None = None, home: Path | None = None) -> SceneFiles | None:
    """The files of a scene, read again, with its lesson's text; None if it has none, or they have no common folder.
    `home` is the folder that they were copied from, if they are copies.
    """
    if scene.path is None:
        return None
    paths = {_absolute(path): path for path in (*scene.files, *([lesson] if lesson else []))}
    try:
        folder = Path(os.path.commonpath([path.parent for path in paths]))
    except ValueError:  # on several drives
        return None
    fixed = _absolute_meshes(scene.path)
    names = {path: path.relative_to(folder).as_posix() for path in paths}
    room, found = MOST_KEPT, []
    for path in paths:
        content = None if path in fixed else _content(path, room)
        room -= len(content or b"")
        digest = checksum(path) if content is None else hashlib.sha256(content).hexdigest()
        found.append(SceneFile(names[path], digest, content))
    return SceneFiles(
        home or folder, names[_absolute(scene.path)], names[_absolute(lesson)] if lesson else "", tuple(found)
    )


def checksum(path: Path) -> str:
    """The SHA-256 of a file's content; empty if there is no file that can be read."""
    try:
        check_regular(path)
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, Fault):
        return ""


def _content(path: Path, most: int) -> bytes | None:
    """The bytes of a file; None if there are more than `most`, or it cannot be read."""
    try:
        check_regular(path, most)
        return path.read_bytes()
    except (OSError, Fault):
        return None


def _absolute(path: Path) -> Path:
    """An absolute path without `..`. Links are not followed."""
    return Path(os.path.normpath(path.absolute()))


def _absolute_meshes(scene: Path) -> set[Path]:
    """The mesh files that a scene names by an absolute path: a copy of the scene would not find copies of them."""
    if scene.suffix.lower() != ".toml":
        return set()
    try:
        objects = tomllib.loads(scene.read_text("utf-8", "replace")).get("object", [])
    except (OSError, ValueError, RecursionError):
        return set()
    return {_absolute(Path(name)) for name in _file_names(objects) if Path(name).is_absolute()}


def _file_names(objects: Iterable[object]) -> list[str]:
    return [str(item["file"]) for item in objects if isinstance(item, dict) and "file" in item]
