"""Lessons: one folder each in `lessons/`, written without Python.

`lesson.md` begins with its data in TOML, between two lines `+++`. Below, Markdown says what there is to see:

    +++
    title = "Mirror balls"
    scene = "scene.toml"
    pixel = [400, 300]      # picked when the lesson is opened
    depth = 3
    [view]                  # of the 3D scene, optional: angles in degrees, distance in radii of the scene
    azimuth = 35
    elevation = 20
    distance = 2.5
    +++
    What to look at.
"""

from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from tracer import fields
from tracer.formats.source import MOST_TEXT, Fault, read_bytes, utf8
from tracer.formats.toml import parsed
from tracer.printable import shown_path
from viewer.base.files import Unusable, is_there
from viewer.base.orbit import AZIMUTH, DISTANCE, ELEVATION

MARK = "+++"


@dataclass(frozen=True)
class LessonView:
    """The first view of the 3D scene."""

    azimuth: float = field(default=AZIMUTH, metadata=fields.number())  # degrees from the side of the scene's camera
    elevation: float = field(default=ELEVATION, metadata=fields.number(above=-90, below=90))  # degrees
    distance: float = field(default=DISTANCE, metadata=fields.number(above=0))  # in radii of the scene
    target: tuple[float, float, float] | None = field(default=None, metadata=fields.point())  # None: its centre


@dataclass(frozen=True)
class Lesson:
    name: str
    title: str
    path: Path  # of lesson.md
    scene: Path
    text: str
    pixel: tuple[int, int] | None
    depth: int | None
    view: LessonView


def folder() -> Path:
    return Path(str(files("lessons")))


def names() -> list[str]:
    """All lessons in teaching order: those in the file ORDER first, then the others by name."""
    found = {path.parent.name for path in folder().glob("*/lesson.md")}
    order = (folder() / "ORDER").read_text("utf-8").split()
    return [name for name in order if name in found] + sorted(found - set(order))


def read(name: str) -> Lesson:
    """Read one lesson by name. Raises Unusable with all faults of its file."""
    path = folder() / name / "lesson.md"
    if not is_there(path):
        raise Unusable(f'no lesson "{name}"{fields.nearest(name, names())} (known: {", ".join(names())})')
    return read_file(path)


def read_file(path: Path) -> Lesson:
    """Read a lesson from any file. Raises Unusable with all its faults."""
    place = shown_path(path)
    try:
        text = _text(path)
        if text.count(f"{MARK}\n") < 2 or not text.startswith(MARK):
            raise Fault(f"a lesson begins with its data between two lines {MARK}")
        _, head, body = text.split(f"{MARK}\n", 2)
        data = parsed(head.encode("utf-8"))
    except FileNotFoundError:
        raise Unusable(f"{place}: file not found") from None
    except OSError as error:
        raise Unusable(f"{place}: cannot be read: {error.strerror}") from None
    except Fault as fault:
        raise Unusable(fault.within(place)) from None
    faults: list[str] = []
    angles = data.pop("view", {})
    if not isinstance(angles, dict):
        faults.append(fields.refusal("view", "a table", angles))
        angles = {}
    view = fields.read_fields(LessonView, angles, faults)
    values = fields.read_fields(_Head, data, faults)
    if faults:
        raise Unusable(*(f"{place}: {fault}" for fault in faults))
    head_values = _Head(**values)
    return Lesson(
        name=path.absolute().parent.name,
        title=head_values.title,
        path=path,
        scene=path.parent / head_values.scene,
        text=body.strip(),
        pixel=head_values.pixel,
        depth=head_values.depth,
        view=LessonView(**view),
    )


def _text(path: Path) -> str:
    """The text of the file, with lines that end with LF. A byte order mark is left out. Raises Fault and OSError."""
    data = utf8(read_bytes(path, MOST_TEXT))
    try:
        return data.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise Fault("a lesson is UTF-8 text, got something else", line) from None


def _pixel() -> Any:
    def read(value: Any) -> tuple[int, int]:
        whole = isinstance(value, list) and len(value) == 2 and all(type(item) is int for item in value)
        if not whole or min(value) < 0:
            raise fields.Refused("two whole numbers [x, y] >= 0")
        return (value[0], value[1])

    return fields.rule(read)


@dataclass(frozen=True)
class _Head:
    title: str = field(metadata=fields.text())
    scene: str = field(default="scene.toml", metadata=fields.text())
    pixel: tuple[int, int] | None = field(default=None, metadata=_pixel())
    depth: int | None = field(default=None, metadata=fields.whole(0, 1000))
