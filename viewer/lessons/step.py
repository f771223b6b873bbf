"""A step of a lesson: the state of the viewer that it asks for, its text in parts, and what must hold.

A step is written as a heading with a block `step` below it. Most fields are inherited from the step before, when the
lesson is read, so that a step is an absolute state: it is the same from whichever side it is reached.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields as fields_of, replace
from pathlib import Path
from typing import Any, Self

from tracer import fields
from tracer.choices import MODELS
from viewer.base.orbit import AZIMUTH, DISTANCE, ELEVATION
from viewer.base.values import RAY_PATH, Unreadable
from viewer.lessons.sweep import Sweep, read_sweep, with_changes
from viewer.lessons.text import Block, Fence, fences
from viewer.reopen.view_state import INSETS, KINDS, LEFT, PANEL_NAMES

MOST_PANELS = 3
DEPTH, RAYS, COLOUR = REVEALS = ("depth", "rays", "colour")
NOT_INHERITED = ("reveal", "sweep", "hit", "expect", "goal")
KEY = re.compile(r"([A-Za-z_][\w-]*)[\"']?\s*[=\]]")  # of TOML, or the end of one


@dataclass(frozen=True)
class LessonView:
    """A view of the 3D scene."""

    azimuth: float = field(default=AZIMUTH, metadata=fields.number())  # degrees from the side of the scene's camera
    elevation: float = field(default=ELEVATION, metadata=fields.number(above=-90, below=90))  # degrees
    distance: float = field(default=DISTANCE, metadata=fields.number(above=0))  # in radii of the scene
    target: tuple[float, float, float] | None = field(default=None, metadata=fields.point())  # None: its centre
    inset: str = field(default=LEFT, metadata=fields.choice(*INSETS))  # the lower corner with the image


def _names(allowed: tuple[str, ...], most: int) -> Mapping[str, Any]:
    """A list of some of these names, each at most once."""
    said = f"a list of {'' if most >= len(allowed) else f'at most {most} '}of {', '.join(allowed)}"

    def read(value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise fields.Refused(said)
        unknown = next((item for item in value if item not in allowed), None)
        if unknown is not None:
            raise fields.Refused(said + fields.nearest(unknown, allowed))
        if len(set(value)) < len(value) or len(value) > most:
            raise fields.Refused(said)
        return tuple(value)

    return fields.rule(read)


def _pixel() -> Mapping[str, Any]:
    def read(value: Any) -> tuple[int, int]:
        whole = isinstance(value, list) and len(value) == 2 and all(type(item) is int for item in value)
        if not whole or min(value) < 0:
            raise fields.Refused("two whole numbers [x, y] >= 0")
        return (value[0], value[1])

    return fields.rule(read)


def _path() -> Mapping[str, Any]:
    def read(value: Any) -> str:
        try:
            return RAY_PATH.read(value if isinstance(value, str) else "")
        except Unreadable:
            raise fields.Refused("the path of a ray, like E, TR or TR.L(key)") from None

    return fields.rule(read)


def _table() -> Mapping[str, Any]:
    def read(value: Any) -> Mapping[str, Any]:
        if not isinstance(value, dict):
            raise fields.Refused("a table")
        return value

    return fields.rule(read)


@dataclass(frozen=True)
class State:
    """The fields of a block `step`."""

    scene: str = field(default="scene.toml", metadata=fields.text())
    set: Mapping[str, Any] = field(default_factory=dict, metadata=_table())  # values of the scene that are replaced
    pixel: tuple[int, int] | None = field(default=None, metadata=_pixel())
    sample: int | None = field(default=None, metadata=fields.whole(0, 2**31 - 1))
    depth: int | None = field(default=None, metadata=fields.whole(0, 1000))
    model: str | None = field(default=None, metadata=fields.choice(*MODELS))
    show: tuple[str, ...] = field(default=KINDS, metadata=_names(KINDS, len(KINDS)))  # kinds of rays
    view: LessonView = LessonView()
    panels: tuple[str, ...] = field(default=("scene", "tree"), metadata=_names(PANEL_NAMES, MOST_PANELS))
    hit: str | None = field(default=None, metadata=_path())  # the ray whose hit is looked at
    reveal: str | None = field(default=None, metadata=fields.choice(*REVEALS))
    sweep: Sweep | None = field(default=None, metadata=fields.rule(read_sweep))
    expect: Mapping[str, Any] = field(default_factory=dict, metadata=_table())
    goal: Mapping[str, Any] = field(default_factory=dict, metadata=_table())

    def swept(self, share: float) -> Self:
        """The same with pixel and scene as they are at this share of its sweep."""
        if not self.sweep:
            return self
        pixel = self.sweep.pixel(share) if self.sweep.is_pixel else self.pixel
        return replace(self, pixel=pixel, set=with_changes(self.set, self.sweep.changes(share)))


STATE_KEYS = tuple(item.name for item in fields_of(State))
INHERITED = tuple(name for name in STATE_KEYS if name not in NOT_INHERITED)


@dataclass(frozen=True)
class Part:
    """The text up to the next `???`: what appears at one press of a key."""

    blocks: tuple[Block, ...]

    @property
    def live(self) -> tuple[Fence, ...]:
        """The live pieces that appear with it."""
        return tuple(fence for fence in fences(self.blocks) if fence.kind == "live")


@dataclass(frozen=True)
class Step:
    """One step. `line` is that of its heading."""

    title: str
    line: int
    state: State
    parts: tuple[Part, ...]
    notes: str = ""  # for the speaker
    folder: Path = Path()  # of the lesson
    lines: Mapping[str, int] = field(default_factory=dict)  # of the keys in its block `step`

    def line_of(self, *keys: str) -> int:
        """The line of the first of these keys that its block has; otherwise that of its heading."""
        return next((self.lines[key] for key in keys if key in self.lines), self.line)

    @property
    def scene(self) -> Path:
        return self.folder / self.state.scene


def lines_of(text: str, first_line: int) -> dict[str, int]:
    """The line of each key of a TOML text that begins on this line, also inside tables: the first one of its name."""
    found: dict[str, int] = {}
    for k, line in enumerate(text.split("\n")):
        for key in KEY.findall(line):
            found.setdefault(key, first_line + k)
    return found
