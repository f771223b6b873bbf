"""Live pieces on paper: a picture for each position of their handles."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from viewer.base.theme import LIGHT
from viewer.figures.marks import Handle, Mark, Text
from viewer.handout.document import SWEEP, Control, Picture, Room, Show, Shown, paper
from viewer.handout.sentences import of_marks
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.text import Fence

MOST = 100  # positions of a handle
LIVE_ROOM = Room((0.0, 0.0, 460.0, 590.0), 16.5, paper(LIGHT.name))  # of pieces in a page for a browser
NICE = (1.0, 2.0, 5.0)  # steps between positions, times a power of ten
NUMBER = re.compile(r"[0-9]")
DRAG = "drag to "  # begins the titles of handles


@dataclass(frozen=True)
class Along:
    """A position of the step's sweep, as a live piece shows it: `row` is that of the hit looked at."""

    shown: Shown
    row: int
    words: str


def live_show(fence: Fence, shown: Shown, row: int, title: str = "", sweep: Sequence[Along] = ()) -> Show | None:
    """The show of a live piece about the hit of this row; None if it cannot show it. Frame 0 is the piece at first.

    The first frames are the positions of the `sweep` with this title, if the piece changes there.
    """
    try:
        piece = _Piece(fence, shown, row)
        controls = [*piece.swept(title, sweep), *piece.handles()]
    except ValueError:
        return None
    name = piece.kind.title
    picture = Picture(piece.kind.name, name, piece.draw, lambda _, made: of_marks(name, made))
    return Show((picture,), len(piece.frames), 0, tuple(controls), tuple(frame.shown for frame in piece.frames))


@dataclass(frozen=True)
class _Frame:
    shown: Shown
    row: int
    parameters: tuple[tuple[str, float], ...] = ()


class _Piece:
    """A live piece and its frames. Methods raise ValueError where it has nothing to show."""

    def __init__(self, fence: Fence, shown: Shown, row: int) -> None:
        name, *self.words = fence.content.split() or [""]
        self.kind = live_kind(name)
        self.frames = [_Frame(shown, row)]
        self._drawn: dict[tuple, list[Mark]] = {}

    def draw(self, room: Room, asked: Sequence[int]) -> list[list[Mark]]:
        return [self._marks(room, self.frames[k]) for k in asked]

    def _marks(self, room: Room, frame: _Frame) -> list[Mark]:
        about = frame.shown
        key = (room.where, room.size, room.theme.name, id(about.tree), id(about.world), frame.row, frame.parameters)
        if key not in self._drawn:
            context = LiveContext(about.tree, frame.row, about.world, room.theme, room.size, room.where)
            self._drawn[key] = self.kind.marks(context, dict(frame.parameters), self.words)
        return self._drawn[key]

    def swept(self, title: str, sweep: Sequence[Along]) -> list[Control]:
        """Add the positions of a sweep; nothing if the piece is the same at all of them, or has nothing to show."""
        found = [_Frame(one.shown, one.row) for one in sweep]
        try:
            drawn = [self._marks(LIVE_ROOM, frame) for frame in found]
        except ValueError:
            return []
        if all(marks == drawn[0] for marks in drawn):
            return []
        self.frames = found
        return [Control(SWEEP, title, 0, tuple(one.words for one in sweep))]

    def handles(self) -> list[Control]:
        """Add the positions of each handle."""
        first, controls = self.frames[0], []
        for handle in (mark for mark in self._marks(LIVE_ROOM, first) if isinstance(mark, Handle)):
            values, begin = positions(handle), len(self.frames)
            title = handle.title.removeprefix(DRAG)
            title = title[:1].upper() + title[1:]
            own = [_Frame(first.shown, first.row, ((handle.name, value),)) for value in values]
            told = differences([self._marks(LIVE_ROOM, frame) for frame in own])
            said = tuple("; ".join(filter(None, both)) for both in zip(map(_said, values), told, strict=True))
            controls.append(Control(handle.name, title, begin, said, values.index(float(handle.value)), True))
            self.frames += own
        return controls


def differences(drawn: Sequence[Sequence[Mark]]) -> list[str]:
    """The first text with a number that each of these pictures has, and not all of them have."""
    texts = [[mark.content for mark in marks if isinstance(mark, Text)] for marks in drawn]
    common = set(texts[0]).intersection(*texts)
    return [next((words for words in found if words not in common and NUMBER.search(words)), "") for found in texts]


def positions(handle: Handle) -> list[float]:
    """Values of a handle: at most MOST round ones in its range, and the one that it has; the whole ones, if its range
    is of these.
    """
    low, high = handle.range
    if all(isinstance(number, int) for number in (low, high, handle.value)):
        return [float(k) for k in range(int(low), int(high) + 1)]
    ideal = (high - low) / MOST
    power = 10.0 ** math.floor(math.log10(ideal))
    step = next(step * power for step in (*NICE, 10.0) if step * power >= ideal)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    digits = max(0, -math.floor(math.log10(step)))
    round_ones = {min(high, max(low, round(k * step, digits))) for k in range(first, last + 1)}
    return sorted(round_ones | {handle.value})


def _said(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")
