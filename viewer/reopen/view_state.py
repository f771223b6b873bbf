"""The state of a view: the fields that bring a window back.

The options of `raytree view`, the data in a figure and the state that is kept from one start to the next are all made
from the fields of `ViewState`, and read by them. In JSON, each value is the text of the command line's option.
"""

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from tracer.choices import MODELS
from tracer.formats import UP_AXES
from viewer.base.options import flag, option, spelling, words
from viewer.base.theme import DARK, LIGHT, STYLES
from viewer.base.values import (
    AT_HELP,
    DEPTH_HELP,
    INCIDENCE,
    MODEL_HELP,
    MOMENT,
    ORBIT,
    PAN_ZOOM,
    PIXEL,
    RAY_PATH,
    SAMPLE_HELP,
    SHARE,
    SHARES,
    SWEPT_HELP,
    UP_HELP,
    Unreadable,
    Value,
    none_or_some_of,
    one_of,
    some_of,
    whole,
)

KINDS = tuple(STYLES)  # of rays
SWITCHES = ("camera", "lights", "normals", "labels")  # what else is drawn, or hidden
GRANULARITIES = ("levels", "rays")
ORDERS = ("breadth", "recursion")
THEMES = (DARK.name, LIGHT.name)  # of the window
TYPE_SIZES = ("normal", "lecture")
INSETS = LEFT, RIGHT, NO_INSET = ("left", "right", "none")  # where the image lies over the scene
PANEL_NAMES = ("scene", "image", "tree", "ray", "hit", "lesson", "error", "recursion")


@dataclass(frozen=True, kw_only=True)
class ViewState:
    """The choices in a window. None: the scene's or the lesson's own, or those that the window has already."""

    at: tuple[int, int] | None = option(MOMENT, AT_HELP)
    swept: float | None = option(SHARE, SWEPT_HELP)
    pixel: tuple[int, int] | None = option(PIXEL, "pick this pixel, counted from the top left")
    sample: int | None = option(whole(0, metavar="K"), SAMPLE_HELP)
    depth: int | None = option(whole(0, metavar="D"), DEPTH_HELP)
    model: str | None = option(one_of(MODELS), MODEL_HELP)
    up: str = option(one_of(UP_AXES), UP_HELP, UP_AXES[0])
    select: str | None = option(RAY_PATH, "select the ray with this path: E, TR, TR.L(key)")
    step: str | None = option(
        one_of(GRANULARITIES), f"reveal the tree by level or by ray; {GRANULARITIES[0]} by default"
    )
    order: str | None = option(
        one_of(ORDERS), "by ray: breadth-first as the kernel does it, or depth-first as a recursion does"
    )
    page: int | None = option(whole(0), "show the tree at this step, from 0; all of it by default")
    turn: float | None = option(INCIDENCE, "show the selected hit as it would be at this angle of incidence")
    camera: tuple[float, ...] | None = option(
        ORBIT, "the 3D view, as --view of export: azimuth and elevation in degrees, distance in radii, target"
    )
    filter: tuple[str, ...] | None = option(
        none_or_some_of(KINDS, "KINDS"), f"show these kinds of rays only: {','.join(KINDS)}; or none"
    )
    hide: tuple[str, ...] | None = option(
        none_or_some_of(SWITCHES, "PARTS"), f"leave these out of the 3D view: {','.join(SWITCHES)}; or none"
    )
    theme: str | None = option(one_of(THEMES), f"{THEMES[0]} by default")
    type_size: str | None = option(one_of(TYPE_SIZES), "lecture: everything larger, for the back row")
    panels: tuple[str, ...] | None = option(
        some_of(PANEL_NAMES, "PANELS"), f"show these panels; a single one has all of the room: {','.join(PANEL_NAMES)}"
    )
    beside: tuple[str, ...] | None = option(
        some_of(PANEL_NAMES, "PANELS"), "show the text of the lesson, and beside it these panels, at most three"
    )
    inset: str | None = option(
        one_of(INSETS),
        f"the lower corner of the scene with the image, in lecture type; {LEFT} by default",
    )
    borders: tuple[float, float, float] | None = option(
        SHARES, "shares of the left column, and of the upper panel in the left and in the right column"
    )
    image_zoom: tuple[float, float, float] | None = option(
        PAN_ZOOM, "zoom of the image, and the point in the middle, as shares of width and height"
    )
    tree_zoom: tuple[float, float, float] | None = option(PAN_ZOOM, "zoom of the ray tree, and how far it is moved")


UNCHANGED = ViewState()


def texts(state: ViewState) -> dict[str, str]:
    """The fields that have a value, as texts: the content of a JSON object."""
    found = {}
    for item in fields(state):
        value, kind = getattr(state, item.name), spelling(item).value
        if kind and value != item.default:
            found[item.name] = kind.show(value)
    return found


def from_texts(found: Any) -> ViewState:
    """The state of these texts. Names that are not known are left out: a later version may have written them.

    Raises Unreadable, with the field's name, if a text is not such a value.
    """
    if not isinstance(found, Mapping):
        raise Unreadable("a view must be a table of texts")
    values = {}
    for item in fields(ViewState):
        kind = spelling(item).value
        if kind and item.name in found:
            text = found[item.name]
            if not isinstance(text, str):
                raise Unreadable(f"{item.name} must be a text")
            try:
                values[item.name] = kind.read(text)
            except ValueError as error:
                raise Unreadable(f"{item.name} must be {error}") from None
    return ViewState(**values)


def differing(state: ViewState, base: ViewState) -> ViewState:
    """The fields that differ from those of `base`; the others have their defaults."""
    same = {f.name: f.default for f in fields(state) if getattr(state, f.name) == getattr(base, f.name)}
    return replace(state, **same)


def merged(base: ViewState, over: ViewState) -> ViewState:
    """The state `base`, with the fields of `over` that have a value."""
    given = {f.name: getattr(over, f.name) for f in fields(ViewState) if getattr(over, f.name) != f.default}
    return replace(base, **given)


def _read_words(text: str) -> ViewState:
    """Options of `raytree view` in one text: `--pixel 3,4 --theme dark`."""
    allowed = "options of raytree view, like '--theme dark --depth 2'"
    names = {flag(item.name): item.name for item in fields(ViewState)}
    try:
        parts = [part for word in shlex.split(text) for part in _at_equals(word)]
    except ValueError as error:
        raise Unreadable(f"{allowed}: {error}") from None
    found = dict(zip(parts[::2], parts[1::2], strict=False))
    if len(parts) % 2 or not set(found) <= set(names):
        raise Unreadable(f'{allowed} (known: {" ".join(names)}), got "{text}"')
    return from_texts({names[name]: value for name, value in found.items()})


def _at_equals(word: str) -> list[str]:
    """`--camera=-3,2,1` as option and value."""
    return word.split("=", 1) if word.startswith("--") else [word]


VIEW_WORDS = Value(_read_words, lambda state: shlex.join(words(state)), "OPTIONS")
