"""Several states of a figure as one SVG: what they have in common is there once.

An element that is not in all frames has `data-f`, the frames that it is in, like `0-3,7`. Those that are not in the
frame shown at first have the class `off`, so a browser without scripts shows that frame. The script shows another one
by changing the classes.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from html import escape

from viewer.base.theme import rgb_bytes
from viewer.figures.marks import Figure, Handle, Mark
from viewer.figures.writers.html.inline_svg import Drawings, Groups, opening, row_of_mark
from viewer.figures.writers.svg import elements, title_element
from viewer.handout.html.colors import ColorPairs, Partners

DRAWN = 20  # of so many frames, one is drawn in the other theme in any case
HANDLE = (10.0, 3.0)  # radius of a handle and width of its line, in points


class Frames:
    """A sequence of elements, each with the frames that it is in."""

    def __init__(self) -> None:
        self.elements: list[str] = []
        self.frames: list[list[int]] = []

    def add(self, k: int, shown: Sequence[str]) -> None:
        """Add frame k with these elements, in this order. Frames are added in turn."""
        matcher = SequenceMatcher(None, self.elements, shown, autojunk=False)
        merged: list[tuple[str, list[int]]] = []
        for what, a0, a1, b0, b1 in matcher.get_opcodes():
            old = zip(self.elements[a0:a1], self.frames[a0:a1], strict=True)
            if what == "equal":
                merged += [(element, [*frames, k]) for element, frames in old]
            else:
                merged += [*old, *((element, [k]) for element in shown[b0:b1])]
        self.elements = [element for element, _ in merged]
        self.frames = [frames for _, frames in merged]

    def lines(self, count: int, start: int) -> Iterator[str]:
        """The elements of `count` frames, of which `start` is shown at first. Neighbours with the same frames share a
        group.
        """
        waiting: list[str] = []
        for k, (element, frames) in enumerate(zip(self.elements, self.frames, strict=True)):
            waiting.append(element)
            if k + 1 < len(self.frames) and self.frames[k + 1] == frames:
                continue
            if len(frames) == count:
                yield from waiting
            else:
                yield f"<g{frames_attribute(frames, start)}>"
                yield from waiting
                yield "</g>"
            waiting = []


def frames_attribute(frames: Sequence[int], start: int) -> str:
    """The attributes of an element that is in these frames, in ascending order, of which `start` is shown at first."""
    ranges: list[list[int]] = []
    for frame in frames:
        if ranges and ranges[-1][1] == frame - 1:
            ranges[-1][1] = frame
        else:
            ranges.append([frame, frame])
    said = ",".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges)
    return f' data-f="{said}"' + ("" if start in frames else ' class="off"')


def frames_svg(
    figures: Sequence[Figure],
    other: Callable[[Sequence[int]], list[Figure]] | None,
    start: int,
    labelled: str,
    numbers: Sequence[Mapping[int, str]],
    trees: Sequence[str],
    drawings: Drawings,
    colors: ColorPairs,
) -> list[str]:
    """The lines of the SVG. `figures` are the frames in the first theme, and `other` makes some of them in the other
    theme, if there is one. `numbers` and `trees` are those of `inline_svg` for each frame.
    """
    units = [list(_units(figure, numbers[k], trees[k])) for k, figure in enumerate(figures)]

    def drawn(frames: Sequence[int]) -> list[list[str]]:
        made = other(frames) if other else []
        return [list(_units(one, numbers[k], trees[k])) for k, one in zip(frames, made, strict=True)]

    if other:
        units = _in_both(units, drawn, colors)
    found = Frames()
    for k, shown in enumerate(units):
        found.add(k, [drawings.shared(element) for element in shown])
    return [*opening(figures[0], labelled), *found.lines(len(figures), start), "</svg>"]


def _in_both(
    units: list[list[str]], drawn: Callable[[Sequence[int]], list[list[str]]], colors: ColorPairs
) -> list[list[str]]:
    """The frames with colours of both themes. Some are drawn in the other theme as well; these show which colours
    belong together. Frames with a colour of which that is not certain are drawn, too.
    """
    partners, made = Partners(), dict[int, list[str]]()
    last = len(units) - 1
    sample = sorted({*range(0, last, DRAWN), last})
    for k, shown in zip(sample, drawn(sample), strict=True):
        made[k] = shown
        partners.learn(units[k], shown)
    unsure = [k for k in range(last + 1) if k not in made and not partners.know(units[k])]
    made |= dict(zip(unsure, drawn(unsure), strict=True))
    return [
        [colors.paired([first, second]) for first, second in zip(shown, made[k], strict=True)]
        if len(made.get(k, ())) == len(shown)
        else [colors.paired([first, partners.of(first)]) for first in shown]
        for k, shown in enumerate(units)
    ]


def _units(figure: Figure, numbers: Mapping[int, str], tree: str) -> Iterator[str]:
    """The parts of a figure that frames may have in common: the group of a ray, and each other mark."""
    group = Groups(figure, numbers, tree)
    for name, title, marks in figure.groups():
        if any(isinstance(mark, Handle) for mark in marks):
            yield from (_handle(mark, figure) for mark in marks if isinstance(mark, Handle))
        elif row_of_mark(name) is not None:
            yield group(name, title, [element for mark in marks for element in elements(mark)])
        else:
            yield from (_titled(mark) for mark in marks)


def _titled(mark: Mark) -> str:
    content = "\n".join(elements(mark))
    return f"<g>{title_element(mark.title)}\n{content}\n</g>" if mark.title else content


def _handle(mark: Handle, figure: Figure) -> str:
    """A disc that the script lets drag."""
    (x, y), (radius, width) = mark.at, HANDLE
    ink, ground = ("#{:02X}{:02X}{:02X}".format(*rgb_bytes(color)) for color in (mark.color, figure.paper))
    disc = f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{ground}" stroke="{ink}" stroke-width="{width:g}"/>'
    return f'<g class="handle" data-handle="{escape(mark.name)}">{title_element(mark.title)}\n{disc}\n</g>'


def captions(said: Sequence[str], start: int, line: Callable[[str], str]) -> Iterator[str]:
    """Paragraphs with what is said of each frame; equal ones are there once."""
    found: dict[str, list[int]] = {}
    for k, words in enumerate(said):
        found.setdefault(words, []).append(k)
    for words, frames in found.items():
        own = "" if len(frames) == len(said) else frames_attribute(frames, start)
        yield f"<p{own}>{line(words)}</p>"
