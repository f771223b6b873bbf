"""The data that a figure carries so that it can be reopened: the view's state and the scene's files, as a ZIP archive.

The archive has a table, `view.json`, and the content of each file under its number. Nothing in it is trusted: sizes,
names and values are checked before anything is written.
"""

import hashlib
import io
import json
import lzma
import os
import zipfile
import zlib
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

from tracer.printable import printable
from viewer.base.values import Unreadable
from viewer.reopen.scene_files import SceneFile, SceneFiles
from viewer.reopen.view_state import ViewState, from_texts, texts

FORMAT = "raytree-view/1"
TABLE = "view.json"
MOST_CARRIED = 2**20  # compressed bytes of a scene's files in a figure
MOST_PACKED = 4 * 2**20  # bytes of an archive that is read
MOST_UNPACKED = 64 * 2**20  # bytes of everything in it
MOST_FILES = 4096
OLDEST = (1980, 1, 1, 0, 0, 0)  # the earliest time that a ZIP archive can store
UNIX = 3  # the system that ZIP archives name as their maker, on all systems: the same figure is the same file
HEAVY = 9  # zlib's level
SHA256_LENGTH = 64
NOT_IN_NAMES = "\0\\:" if os.name == "nt" else "\0"  # on Windows, a folder or a drive ends at the last two


class Damaged(ValueError):
    """Data that cannot be used. The text says what was found."""


@dataclass(frozen=True)
class Embedded:
    """A view, and the scene that it shows."""

    version: str  # of the program that wrote it
    state: ViewState
    files: SceneFiles  # their folder is relative if they belong to the program
    is_lesson_of_program: bool = False


def pack(embedded: Embedded) -> tuple[bytes, list[str]]:
    """The archive, and a note for each file that is too large for it. The smallest files are carried first."""
    scene = embedded.files
    packed: dict[str, bytes] = {}
    room, notes = MOST_CARRIED, []
    for file in sorted(scene.files, key=lambda file: (len(file.content or b""), file.name)):
        if file.content is None or len(packed) == MOST_FILES:
            continue
        size = len(zlib.compress(file.content, HEAVY))
        if size <= room:
            packed[file.name] = file.content
            room -= size
    for file in scene.files:
        if file.sha256 and file.name not in packed:
            notes.append(
                f"{printable(file.name)} is not carried in the figure, only its checksum (at most"
                f" {MOST_CARRIED / 2**20:g} MiB of a scene are, compressed, and no file with an absolute path):"
                " the figure can be reopened while that file stays as it is"
            )
    table = {
        "format": FORMAT,
        "raytree": embedded.version,
        "view": texts(embedded.state),
        "folder": str(scene.folder) if not embedded.is_lesson_of_program else scene.folder.as_posix(),
        "is_lesson_of_program": embedded.is_lesson_of_program,
        "scene": scene.main,
        "lesson": scene.lesson,
        "files": [
            {"name": file.name, "sha256": file.sha256, "carried": file.name in packed}
            for file in scene.files[:MOST_FILES]
        ],
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        _add(archive, TABLE, json.dumps(table, separators=(",", ":")).encode("ascii"))
        for k, file in enumerate(scene.files[:MOST_FILES]):
            if file.name in packed:
                _add(archive, str(k), packed[file.name])
    return buffer.getvalue(), notes


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    entry = zipfile.ZipInfo(name, OLDEST)
    entry.create_system = UNIX
    archive.writestr(entry, content, zipfile.ZIP_DEFLATED, HEAVY)


def unpack(data: bytes) -> Embedded:
    """The view in an archive. Files that it does not carry have no content. Raises Damaged."""
    if len(data) > MOST_PACKED:
        raise Damaged(f"its view must have at most {MOST_PACKED} bytes, got {len(data)}")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
            if unpacked > MOST_UNPACKED or len(archive.infolist()) > MOST_FILES + 1:
                raise Damaged(f"its view must have at most {MOST_UNPACKED} bytes unpacked, got {unpacked}")
            return _embedded(json.loads(archive.read(TABLE)), archive)
    except Damaged:
        raise
    except Unreadable as unreadable:
        raise Damaged(f"its view: {unreadable}") from None
    except (
        ValueError, KeyError, TypeError, AttributeError, IndexError, RecursionError, NotImplementedError, RuntimeError,
        OSError, EOFError, OverflowError, zipfile.BadZipFile, zlib.error, lzma.LZMAError,
    ):  # fmt: skip
        raise Damaged("its view is damaged") from None


def _embedded(table: dict[str, Any], archive: zipfile.ZipFile) -> Embedded:
    if table["format"] != FORMAT:
        raise Damaged(f"its view must have the format {FORMAT}, got {printable(str(table['format']))[:60]}")
    files = []
    if len(table["files"]) > MOST_FILES:
        raise Damaged(f"its scene must have at most {MOST_FILES} files, got {len(table['files'])}")
    for k, entry in enumerate(table["files"]):
        file = SceneFile(_safe(entry["name"]), str(entry["sha256"]))
        if entry["carried"]:
            file = replace(file, content=archive.read(str(k)))
            if hashlib.sha256(file.content or b"").hexdigest() != file.sha256:
                raise Damaged(f"its view is damaged: the checksum of {printable(file.name)} is another")
        elif len(file.sha256) not in (0, SHA256_LENGTH):
            raise Damaged("its view is damaged")
        files.append(file)
    names = [file.name for file in files]
    if len(set(names)) != len(names) or table["scene"] not in names:
        raise Damaged("its view is damaged: its files must have different names, and one must be the scene")
    if table["lesson"] and table["lesson"] not in names:
        raise Damaged("its view is damaged: it has no lesson")
    own = table["is_lesson_of_program"] is True
    folder = Path(str(table["folder"]))
    if own and table["folder"] != ".":
        _safe(table["folder"])
    scene = SceneFiles(folder, table["scene"], str(table["lesson"]), tuple(files))
    return Embedded(str(table["raytree"]), from_texts(table["view"]), scene, own)


def _safe(name: Any) -> str:
    """The name of a file in a folder. Raises Damaged for one that leads out of it."""
    path = PurePosixPath(name)
    if (
        not isinstance(name, str)
        or path.is_absolute()
        or ".." in path.parts
        or not path.parts
        or path.as_posix() != name
        or any(c in name for c in NOT_IN_NAMES)
    ):
        raise Damaged(f"its view has a file with a name that is not allowed: {printable(str(name))[:60]}")
    return name
