"""The content of a lesson, the same for every format: steps with their text in parts, and shows of pictures.

A show is a number of pictures that change together, like the scene and its ray tree. Each of its frames is one state of
them: a stage of the step's reveal, a position of its sweep, or of the handle of a live piece. A frame is absolute:
nothing is added to the one before.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.theme import LIGHT, THEMES, Theme, rgb
from viewer.figures.marks import Mark, Rectangle
from viewer.lessons.lesson import Lesson
from viewer.lessons.step import Step
from viewer.lessons.text import Block

WHITE = rgb("#FFFFFF")


def paper(name: str) -> Theme:
    """The theme of this name for a handout. The light one is on white: there, text in the colours of rays has the
    contrast that WCAG 2.1 AA asks for, 4.5.
    """
    theme = THEMES[name]
    return replace(theme, ground=WHITE) if theme is LIGHT else theme


@dataclass(frozen=True)
class Room:
    """The place of a picture on a page, in points, and its style."""

    where: Rectangle
    size: float  # of text, in points
    theme: Theme
    least: float = math.inf  # of the text of a tree, which becomes smaller before branches are folded


@dataclass(frozen=True)
class Picture:
    """A picture of a show. `draw` makes the marks of these frames; ValueError if they have no room."""

    kind: str  # scene, tree, hit, ray; or the name of a live piece
    title: str
    draw: Callable[[Room, Sequence[int]], list[list[Mark]]]
    says: Callable[[int, Sequence[Mark]], str]  # the alternative text of a frame with these marks


@dataclass(frozen=True)
class Photo:
    """The rendered image, with a ring around the pixel: `ring` are shares of its width and height."""

    pixels: np.ndarray  # linear RGB (height, width, 3)
    ring: tuple[float, float] | None
    title: str
    description: str


@dataclass(frozen=True)
class Control:
    """What moves through frames of a show: from `first`, one for each of its positions."""

    name: str  # of the handle, or of the kind of stages
    title: str
    first: int
    positions: tuple[str, ...]  # what is said of each
    start: int = 0  # the position to begin with
    moves_handle: bool = False  # whether its frames have a handle that can be dragged


@dataclass(frozen=True)
class Shown:
    """The tree that a frame or a text is about, and its scene."""

    tree: RayTree | None
    world: World


@dataclass(frozen=True)
class Show:
    """Pictures with common frames. `shown` says what each frame is about."""

    pictures: tuple[Picture, ...]
    frames: int
    start: int  # the frame that is shown at first
    controls: tuple[Control, ...] = ()
    shown: tuple[Shown, ...] = ()
    photos: tuple[Photo, ...] = ()  # one for all frames, or one for each

    @property
    def last(self) -> int:
        """The frame that shows everything, where nothing can be asked for: the last stage."""
        stages = self.controls[0] if self.controls and not self.controls[0].moves_handle else None
        return stages.first + len(stages.positions) - 1 if stages and stages.name in REVEALED else self.start

    @property
    def swept(self) -> int:
        """The frame at the end of the step's sweep, in a show that follows it; else the one that is shown at first."""
        follows = bool(self.controls) and self.controls[0].name == SWEEP
        return len(self.controls[0].positions) - 1 if follows else self.start


SWEEP = "sweep"  # the name of the control of a sweep
REVEALED = ("depth", "rays", "colour")  # names of controls whose last position shows everything


@dataclass(frozen=True)
class PagePart:
    """The text that appears at one press, with numbers in place of `{names}`, and its live pieces by their lines."""

    blocks: tuple[Block, ...]
    shown: Shown  # what the text is about: after a sweep, its end
    live: dict[int, Show] = field(default_factory=dict)


@dataclass(frozen=True)
class Page:
    """A step of the lesson."""

    number: int  # from 1
    step: Step
    show: Show
    parts: tuple[PagePart, ...]

    @property
    def title(self) -> str:
        return self.step.title

    @property
    def stages(self) -> tuple[int, ...]:
        """The frames that presses show: those of the step's reveal, or both ends of its sweep."""
        state, last = self.step.state, self.show.frames - 1
        if state.sweep and last:
            return (0, last)
        return tuple(range(last + 1)) if state.reveal else (0,)


@dataclass(frozen=True)
class Handout:
    """A lesson with its pages."""

    lesson: Lesson
    pages: tuple[Page, ...]
