"""The list of live pieces. A new one needs a function in its own file and a line here.

Functions are named as "module:function" and imported when they are first used, as in `viewer/figures/catalogue.py`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pkgutil import resolve_name
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tracer.kernel.world import World
    from viewer.figures.marks import Mark
    from viewer.lessons.live.piece import LiveContext, Parameters


@dataclass(frozen=True)
class Argument:
    """A word after the name of a piece, that sets a parameter. `read` raises ValueError with what is allowed."""

    name: str  # of the parameter
    read: Callable[[str, World | None], float]


@dataclass(frozen=True)
class LiveKind:
    """A live piece. Its function takes (LiveContext, Parameters) and returns marks."""

    name: str  # in a lesson's block
    title: str
    function: str
    arguments: tuple[Argument, ...] = ()  # optional words after the name
    click: str = ""  # the function that says what a click on a mark sets, from the mark's name

    def given(self, words: Sequence[str], world: World | None = None) -> dict[str, float]:
        """The parameters that these words set. ValueError for a word that is not allowed, and for too many."""
        if len(words) > len(self.arguments):
            allowed = " ".join(argument.name for argument in self.arguments) or "no words"
            raise ValueError(f'{self.name}: {allowed} may follow, got "{" ".join(words)}"')
        found = {}
        for word, argument in zip(words, self.arguments, strict=False):
            try:
                found[argument.name] = argument.read(word, world)
            except ValueError as error:
                raise ValueError(f'{self.name}: {argument.name} must be {error}, got "{word}"') from None
        return found

    def marks(self, context: LiveContext, parameters: Parameters, words: Sequence[str] = ()) -> list[Mark]:
        """The marks of the piece. Parameters go before words. ValueError with a line for the reader."""
        return resolve_name(self.function)(context, {**self.given(words, context.world), **parameters})

    def clicked(self, name: str) -> Mapping[str, float]:
        """The parameters that a click on a mark of this name sets; none for most marks."""
        return resolve_name(self.click)(name) if self.click else {}


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return math.nan


def _index(word: str, _: World | None) -> float:
    from tracer.formulas.media import INDICES

    number = INDICES.get(word, _number(word))
    if not 0.0 < number < math.inf:
        raise ValueError(f"a number above 0 or one of {', '.join(INDICES)}")
    return number


def _speed(word: str, _: World | None) -> float:
    number = _number(word)
    if not 0.0 < number < math.inf:
        raise ValueError("a speed above 0")
    return number


def _place(word: str, _: World | None) -> float:
    number = _number(word)
    if not math.isfinite(number):
        raise ValueError("a number of metres along the shore")
    return number


def _asked(word: str, _: World | None) -> float:
    if word != "ask":
        raise ValueError('the word "ask", which leaves the answer out')
    return 1.0


def _count(word: str, _: World | None) -> float:
    if not word.isdecimal():
        raise ValueError("a whole number")
    return float(word)


def _light(word: str, world: World | None) -> float:
    names = [world.scene.light_name(j) for j in range(len(world.scene.lights))] if world else []
    if word not in names:
        raise ValueError(f"a light of the scene, {', '.join(names)}" if names else "a light, and the scene has none")
    return float(names.index(word))


def _object(word: str, world: World | None) -> float:
    names = [world.scene.object_name(k) for k in range(len(world.scene.objects))] if world else []
    if word not in names:
        raise ValueError(f"an object of the scene, {', '.join(names)}" if names else "an object of a scene")
    return float(names.index(word))


def _stage(word: str, _: World | None) -> float:
    if word not in ("1", "2", "3", "4"):
        raise ValueError("a whole number from 1 to 4")
    return float(word)


INDICES = (Argument("n1", _index), Argument("n2", _index))
OBJECTS = (Argument("object", _object),)
SPEEDS = (Argument("v1", _speed), Argument("v2", _speed), Argument("x", _place), Argument("ask", _asked))

LIVE = (
    LiveKind("snell", "Snell's law", "viewer.lessons.live.pieces.snell:snell", INDICES),
    LiveKind("lifeguard", "The lifeguard", "viewer.lessons.live.pieces.lifeguard:lifeguard", SPEEDS),
    LiveKind(
        "transmission", "The transmission direction", "viewer.lessons.live.pieces.transmission:transmission",
        (Argument("stage", _stage), *INDICES),
    ),
    LiveKind("fresnel", "Fresnel's equations", "viewer.lessons.live.pieces.fresnel:fresnel", INDICES),
    LiveKind(
        "media", "Media and the speed of light", "viewer.lessons.live.pieces.media:media", INDICES,
        "viewer.lessons.live.pieces.media:clicked",
    ),
    LiveKind("sphere", "Ray and sphere", "viewer.lessons.live.pieces.sphere:sphere", OBJECTS),
    LiveKind("inside", "Inside a polygon or a triangle", "viewer.lessons.live.pieces.inside:inside_piece", OBJECTS),
    LiveKind("phong", "Phong's terms", "viewer.lessons.live.pieces.phong:phong", (Argument("light", _light),)),
    LiveKind("reflect", "Reflection", "viewer.lessons.live.pieces.reflect:reflect", (Argument("light", _light),)),
    LiveKind("sum", "The sum of a hit", "viewer.lessons.live.pieces.sum:sum_piece"),
    LiveKind(
        "samples", "Samples of a pixel", "viewer.lessons.live.pieces.samples:samples", (Argument("count", _count),),
        "viewer.lessons.live.pieces.samples:clicked",
    ),
    LiveKind(
        "difference", "What a depth adds", "viewer.lessons.live.pieces.difference:difference", (Argument("d", _count),)
    ),
    LiveKind("hit", "The hit", "viewer.lessons.live.pieces.hit:hit"),
)  # fmt: skip
LIVE_NAMES = tuple(kind.name for kind in LIVE)


def live_kind(name: str) -> LiveKind:
    """The piece of this name. ValueError with the names that there are."""
    for kind in LIVE:
        if kind.name == name:
            return kind
    raise ValueError(f'a live piece is one of {", ".join(LIVE_NAMES)}, got "{name}"')
