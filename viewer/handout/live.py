"""Live pieces on paper: a picture for each position of their handles."""

import math
import re
from collections.abc import Sequence

from viewer.base.theme import LIGHT
from viewer.figures.marks import Handle, Mark, Rectangle, Text
from viewer.handout.document import Control, Picture, Room, Show, Shown, paper
from viewer.handout.sentences import of_marks
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.text import Fence

MOST, TOGETHER = 100, 300  # positions of a handle, and of those of all pieces of a lesson
LIVE_ROOM = Room((0.0, 0.0, 460.0, 590.0), 16.5, paper(LIGHT.name))  # of pieces in a page for a browser
NICE = (1.0, 2.0, 5.0)  # steps between positions, times a power of ten
NUMBER = re.compile(r"[0-9]")
DRAG = "drag to "  # begins the titles of handles


def live_show(fence: Fence, shown: Shown, hit: str | None, swept: Sequence[Shown] = (), pieces: int = 1) -> Show | None:
    """The show of a live piece about this hit; None if it cannot show it. Frame 0 is the piece at first. The last ones
    are those at the positions of a sweep, if it is to follow that. The lesson has so many `pieces`.
    """
    name, *words = fence.content.split() or [""]
    drawn: dict[tuple[Rectangle, float, str, tuple, int], list[Mark]] = {}

    def marks(room: Room, parameters: dict[str, float], about: Shown = shown) -> list[Mark]:
        key = (room.where, room.size, room.theme.name, tuple(parameters.items()), id(about))
        if key not in drawn:
            row = (about.tree.find(hit) if about.tree and hit else 0) or 0
            context = LiveContext(about.tree, row, about.world, room.theme, room.size, room.where)
            drawn[key] = kind.marks(context, parameters, words)
        return drawn[key]

    parameters: list[dict[str, float]] = [{}]
    controls = []
    try:
        kind = live_kind(name)
        for handle in (mark for mark in marks(LIVE_ROOM, {}) if isinstance(mark, Handle)):
            values = positions(handle, min(MOST, TOGETHER // pieces))
            title = handle.title.removeprefix(DRAG)
            title = title[:1].upper() + title[1:]
            own = [{handle.name: value} for value in values]
            told = differences([marks(LIVE_ROOM, one) for one in own])
            said = tuple("; ".join(filter(None, both)) for both in zip(map(_said, values), told, strict=True))
            start = values.index(float(handle.value))
            along = tuple(_nearest(values, marks(LIVE_ROOM, {}, at), handle) for at in swept)
            controls.append(Control(handle.name, title, len(parameters), said, start, True, along))
            parameters += own
    except ValueError:
        return None

    follows = len(parameters)
    frames = [*((one, shown) for one in parameters), *(({}, at) for at in swept)]

    def draw(room: Room, asked: Sequence[int]) -> list[list[Mark]]:
        found = []
        for k in asked:
            try:
                found.append(marks(room, *frames[k]))
            except ValueError:  # there is no such hit on the way of the sweep
                found.append([])
        return found

    picture = Picture(name, kind.title, draw, lambda _, made: of_marks(kind.title, made))
    about = tuple(one for _, one in frames)
    return Show((picture,), len(frames), 0, tuple(controls), about, follows=follows if swept else None)


def _nearest(values: Sequence[float], marks: Sequence[Mark], handle: Handle) -> int:
    """The position nearest to that of this handle among other marks, where it may not be."""
    there = [mark.value for mark in marks if isinstance(mark, Handle) and mark.name == handle.name]
    return min(range(len(values)), key=lambda k: abs(values[k] - (there[0] if there else handle.value)))


def differences(drawn: Sequence[Sequence[Mark]]) -> list[str]:
    """The first text with a number that each of these pictures has, and not all of them have."""
    texts = [[mark.content for mark in marks if isinstance(mark, Text)] for marks in drawn]
    common = set(texts[0]).intersection(*texts)
    return [next((words for words in found if words not in common and NUMBER.search(words)), "") for found in texts]


def positions(handle: Handle, most: int = MOST) -> list[float]:
    """Values of a handle: at most so many round ones in its range, and the one that it has; the whole ones, if its
    range is of these.
    """
    low, high = handle.range
    if all(isinstance(number, int) for number in (low, high, handle.value)):
        return [float(k) for k in range(int(low), int(high) + 1)]
    ideal = (high - low) / most
    power = 10.0 ** math.floor(math.log10(ideal))
    step = next(step * power for step in (*NICE, 10.0) if step * power >= ideal)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    digits = max(0, -math.floor(math.log10(step)))
    round_ones = {min(high, max(low, round(k * step, digits))) for k in range(first, last + 1)}
    return sorted(round_ones | {handle.value})


def _said(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")
