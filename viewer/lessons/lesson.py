"""Lessons: one folder each in `lessons/`, written without Python.

`lesson.md` begins with its data in TOML, between two lines `+++`. Below, in Markdown, each heading is a step:

    +++
    title = "Critical angle"
    question = "Can light be locked into water?"
    +++
    ## Below the critical angle
    ```step
    pixel = [300, 320]
    ```
    The ray meets the surface at {theta1}. Will it leave the water at 50 degrees?
    ???
    No: beyond 48.75 degrees all of it is reflected.

docs/lessons.md lists the keys.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path

from tracer import fields
from tracer.formats.source import MOST_TEXT, Fault, read_bytes, utf8
from tracer.printable import shown_path
from viewer.base.files import Unusable, is_there
from viewer.lessons.language import translation_of, wanted
from viewer.lessons.reader import MARK, Source, read_head, read_steps, split
from viewer.lessons.step import Step
from viewer.lessons.translation import translated_steps

FIRST_LINE = 2  # of a lesson's data


@dataclass(frozen=True)
class Lesson:
    name: str
    title: str
    path: Path  # of lesson.md
    question: str
    minutes: int | None
    objectives: tuple[str, ...]
    steps: tuple[Step, ...]
    language: str = ""  # of a translation
    translation: Path | None = None  # the file of its texts

    @property
    def files(self) -> list[Path]:
        """The files of its text."""
        return [self.path, *([self.translation] if self.translation else [])]

    @property
    def first(self) -> Step:
        return self.steps[0]

    def step_at(self, number: int) -> Step:
        """The step of this number from 0; beyond the last one, the last."""
        return self.steps[min(max(number, 0), len(self.steps) - 1)]

    @property
    def scene(self) -> Path:
        """The scene of its first step."""
        return self.first.scene


def folder() -> Path:
    return Path(str(files("lessons")))


def names() -> list[str]:
    """All lessons: those of the course in their order, then the deeper ones by name."""
    found = {path.parent.name for path in folder().glob("*/lesson.md")}
    ordered = _order()
    return [*(name for name in ordered if name in found), *sorted(found.difference(ordered))]


def course() -> list[str]:
    """The lessons of the file ORDER, which make a course. The others are deeper ones."""
    ordered = _order()
    return [name for name in names() if name in ordered]


def neighbour(lesson: Lesson, by: int) -> str | None:
    """The name of the lesson after one of the program's (1), or before (-1), in the course or among the deeper ones;
    None if there is none.
    """
    if not _is_own(lesson):
        return None
    first = course()
    known = first if lesson.name in first else [name for name in names() if name not in first]
    k = known.index(lesson.name) + by
    return known[k] if 0 <= k < len(known) else None


def ends_course(lesson: Lesson) -> bool:
    """Whether this is the course's last lesson."""
    return _is_own(lesson) and lesson.name == course()[-1]


def _is_own(lesson: Lesson) -> bool:
    """Whether this is one of the program's lessons, and not another one of that name."""
    return lesson.path.absolute().parent == folder() / lesson.name


def _order() -> list[str]:
    return (folder() / "ORDER").read_text("utf-8").split()


def read(name: str) -> Lesson:
    """Read one lesson by name. Raises Unusable with all faults of its file."""
    return read_file(_path(name))


def _path(name: str) -> Path:
    """The file of a lesson of the program. Raises Unusable if there is none."""
    path = folder() / name / "lesson.md"
    if not is_there(path):
        raise Unusable(f'no lesson "{name}"{fields.nearest(name, names())} (known: {", ".join(names())})')
    return path


def read_title(name: str) -> str:
    """The title of a lesson, without reading its steps. Raises Unusable as `read`."""
    path = _path(name)
    found = translation_of(path, wanted())
    place, head, _ = _split_file(found[1] if found else path)
    source = Source(Path())
    data = read_head(source, head, FIRST_LINE)
    _check(source, place)
    return data.title


def read_file(path: Path, languages: Sequence[str] | None = None) -> Lesson:
    """Read one lesson from any file, in the first of these languages that it has; None: those that the environment asks
    for. Raises Unusable with all its faults, each with its line.
    """
    place, head, body = _split_file(path)
    source = Source(path.parent)
    data = read_head(source, head, FIRST_LINE)
    steps = read_steps(source, data.state, split(body, head.count("\n") + FIRST_LINE + 1))
    _check(source, place)
    lesson = Lesson(
        path.absolute().parent.name, data.title, path, data.question, data.minutes, data.objectives, tuple(steps)
    )
    found = translation_of(path, wanted() if languages is None else languages)
    return _translated(lesson, *found) if found else lesson


def _translated(lesson: Lesson, language: str, path: Path) -> Lesson:
    """The lesson with the texts of a translation. Raises Unusable with all faults of its file."""
    place, head, body = _split_file(path)
    source = Source(path.parent)
    data = read_head(source, head, FIRST_LINE, of_translation=True)
    steps = translated_steps(source, lesson.steps, body, head.count("\n") + FIRST_LINE + 1)
    _check(source, place)
    return replace(
        lesson, title=data.title, question=data.question or lesson.question,
        objectives=data.objectives or lesson.objectives, steps=tuple(steps), language=language, translation=path,
    )  # fmt: skip


def _check(source: Source, place: str) -> None:
    """Raise Unusable if there are faults."""
    if source.faults:
        raise Unusable(*(fault.within(place) for fault in source.faults))


def _split_file(path: Path) -> tuple[str, str, str]:
    """(the file's name for messages, the lesson's data, its text). Raises Unusable."""
    place = shown_path(path)
    try:
        text = _text(path)
        if text.count(f"{MARK}\n") < 2 or not text.startswith(MARK):
            raise Fault(f"a lesson begins with its data between two lines {MARK}")
        _, head, body = text.split(f"{MARK}\n", 2)
    except FileNotFoundError:
        raise Unusable(f"{place}: file not found") from None
    except OSError as error:
        raise Unusable(f"{place}: cannot be read: {error.strerror}") from None
    except Fault as fault:
        raise Unusable(fault.within(place)) from None
    return place, head, body


def _text(path: Path) -> str:
    """The text of the file, with lines that end with LF. A byte order mark is left out. Raises Fault and OSError."""
    data = utf8(read_bytes(path, MOST_TEXT))
    try:
        return data.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise Fault("a lesson is UTF-8 text, got something else", line) from None
