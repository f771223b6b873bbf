"""Kinds of values of command line options: each is read from text, and shown as text that reads back to it."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tracer.formats import READERS

MAX_PIXELS = 16384  # across an image
STEEPEST_INCIDENCE = 89.0  # degrees: beyond, a ray grazes the surface
LEAST_SHARE = 0.15  # of a panel in the window
PAPER_LEAST, PAPER_MOST = 200, 4000  # points: the sides of a figure's page
SMALLEST_ZOOM, LARGEST_ZOOM = 0.01, 1000.0  # of a picture in its panel
NEAREST, FARTHEST = 1e-9, 1e9  # distance of the 3D view, in radii of the scene
FAR = 1e6  # limit of the coordinates of a picture's middle
LANGUAGE_CODE = re.compile(r"[a-z]{2,3}(_[A-Z]{2})?")  # perhaps with a country
AT_HELP = "of a lesson: its step, from 1; 3.2 is two presses of a key after the beginning of step 3"
SWEPT_HELP = "of a lesson's step with a sweep: how far it has gone, 0 to 1"
UP_HELP = "axis of a mesh file that points upwards, y by default"
DEPTH_HELP = "recursion depth, the scene's own by default"
LANGUAGE_HELP = "the translation of the lesson into this language, by default that of the system"
PIXEL_HELP = "counted from the image's top left; a lesson's own by default"
RAY_HELP = "origin and direction of a ray"
SAMPLE_HELP = "of a pixel with N samples, this one, 0 to N - 1; the first by default"
MODEL_HELP = "the scene's own by default"
MAX_RAYS_HELP = (
    "limit of rays of the image, 10^10 for each sample of a pixel by default; every tree gets an equal share"
)
SCENE_HELP = f"a {', '.join(list(READERS)[:-1])} or {list(READERS)[-1]} file, or a lesson's name"
FIGURE_TOO = f"{SCENE_HELP}; or a figure that raytree wrote"


class Unreadable(ValueError):
    """A text that is not such a value. The message says what is allowed and what was found."""


@dataclass(frozen=True)
class Value:
    """A kind of value."""

    read: Callable[[str], Any]  # raises Unreadable
    show: Callable[[Any], str] = str
    metavar: str = ""


def _numbers(text: str) -> tuple[float, ...]:
    """Numbers separated by commas; () if one of them is not a number."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        return ()


def _number(text: str, allowed: str, is_allowed: Callable[[float], bool]) -> float:
    numbers = _numbers(text)
    if len(numbers) != 1 or not is_allowed(numbers[0]):
        raise Unreadable(f'{allowed}, got "{text}"')
    return numbers[0]


def _two(text: str, separator: str) -> tuple[int, int]:
    parts = text.lower().split(separator)
    if len(parts) != 2 or not all(re.fullmatch(r"\s*-?\d+\s*", part) for part in parts):
        raise Unreadable(f'two whole numbers like 320{separator}240, got "{text}"')
    return int(parts[0]), int(parts[1])


def _size(text: str) -> tuple[int, int]:
    width, height = _two(text, "x")
    if not (1 <= width <= MAX_PIXELS and 1 <= height <= MAX_PIXELS):
        raise Unreadable(f'a size from 1x1 to {MAX_PIXELS}x{MAX_PIXELS}, got "{text}"')
    return width, height


def _moment(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"([1-9]\d{0,5})(?:\.(\d{1,5}))?", text.strip())
    if not found:
        raise Unreadable(f'a step from 1, like 3, or with the presses after its beginning, like 3.2, got "{text}"')
    return int(found[1]), int(found[2] or 0)


def _show_moment(moment: tuple[int, int]) -> str:
    step, press = moment
    return f"{step}.{press}" if press else str(step)


def _paper(text: str) -> tuple[int, int]:
    width, height = _size(text)
    if not (PAPER_LEAST <= width <= PAPER_MOST and PAPER_LEAST <= height <= PAPER_MOST):
        allowed = f"{PAPER_LEAST}x{PAPER_LEAST} to {PAPER_MOST}x{PAPER_MOST}"
        raise Unreadable(f'a page from {allowed} points, got "{text}"')
    return (width, height)


def _ray(text: str) -> tuple[float, ...]:
    numbers = _numbers(text)
    if len(numbers) != 6:
        raise Unreadable(f'six numbers ox,oy,oz,dx,dy,dz, got "{text}"')
    return numbers


def _ray_name(text: str) -> str:
    if re.match(r"L|.*\.L\(", text, re.IGNORECASE):
        raise Unreadable(f"a ray that meets a surface; {text} goes to a light: name the ray that it starts from")
    if not re.fullmatch(r"E|(?:R|T|TIR)\d+|[RTI]+", text, re.IGNORECASE):
        raise Unreadable(f'the path or the label of a ray, like TR, R3 or E, got "{text}"')
    return text


def _ray_path(text: str) -> str:
    if not re.fullmatch(r"(E|([RTI](\[\d+\])?)+)(\.L\([^()\[\]{}]+\)(\[\d+\])?)?", text):
        raise Unreadable(f'the path of a ray, like E, TR or TR.L(key), got "{text}"')
    return text


def _pan_zoom(text: str) -> tuple[float, ...]:
    numbers = _numbers(text)
    if len(numbers) != 3 or not SMALLEST_ZOOM <= numbers[0] <= LARGEST_ZOOM or not max(map(abs, numbers[1:])) <= FAR:
        allowed = f"a zoom from {SMALLEST_ZOOM:g} to {LARGEST_ZOOM:g} and a point X,Y, like 2,0.5,0.5"
        raise Unreadable(f'{allowed}, got "{text}"')
    return numbers


def _shares(text: str) -> tuple[float, ...]:
    numbers = _numbers(text)
    if len(numbers) != 3 or not all(LEAST_SHARE <= number <= 1.0 - LEAST_SHARE for number in numbers):
        allowed = f"three shares from {LEAST_SHARE:g} to {1.0 - LEAST_SHARE:g}, like 0.6,0.5,0.5"
        raise Unreadable(f'{allowed}, got "{text}"')
    return numbers


def _orbit(text: str) -> tuple[float, ...]:
    numbers = _numbers(text)
    finite = all(map(math.isfinite, numbers))
    if finite and len(numbers) in (3, 6) and -90.0 <= numbers[1] <= 90.0 and NEAREST <= numbers[2] <= FARTHEST:
        return numbers
    asked = (
        f"azimuth and elevation (-90 to 90) in degrees and a distance ({NEAREST:g} to {FARTHEST:g}), like 38,22,2.6,"
        " or these and a target X,Y,Z"
    )
    raise Unreadable(f'{asked}, got "{text}"')


def _depths(text: str) -> range:
    found = re.fullmatch(r"(\d+)(?:\.\.(\d+))?", text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (1, 0)
    if first > last:
        raise Unreadable(f'a depth like 3, or several like 0..3, got "{text}"')
    return range(first, last + 1)


def _show_depths(depths: range) -> str:
    first, last = depths[0], depths[-1]
    return str(first) if first == last else f"{first}..{last}"


def _show_numbers(numbers: Sequence[float]) -> str:
    return ",".join(map(repr, numbers))


def _language(text: str) -> str:
    if not LANGUAGE_CODE.fullmatch(text):
        raise Unreadable(f'the code of a language, like de or pt_BR, got "{text}"')
    return text


TEXT = Value(str)
FILE = Value(Path, metavar="FILE")
MOMENT = Value(_moment, _show_moment, "STEP")
PIXEL = Value(lambda text: _two(text, ","), lambda pixel: f"{pixel[0]},{pixel[1]}", "X,Y")
LANGUAGE = Value(_language, metavar="CODE")
SIZE = Value(_size, lambda size: f"{size[0]}x{size[1]}", "WxH")
PAPER = Value(_paper, lambda size: f"{size[0]}x{size[1]}", "WxH")  # of a figure
RAY = Value(_ray, _show_numbers, "ox,oy,oz,dx,dy,dz")  # origin and direction
RAY_NAME = Value(_ray_name, metavar="PATH")
RAY_PATH = Value(_ray_path, metavar="PATH")
SHARES = Value(_shares, _show_numbers, "C,L,R")  # of columns and rows
PAN_ZOOM = Value(_pan_zoom, _show_numbers, "Z,X,Y")
ORBIT = Value(_orbit, _show_numbers, "A,E,D[,X,Y,Z]")  # azimuth, elevation, distance, target
DEPTHS = Value(_depths, _show_depths, "D|A..B")


def whole(least: int, most: int | None = None, metavar: str = "N", allowed: str = "") -> Value:
    """An integer in a range, described by `allowed`."""
    allowed = allowed or (f"a whole number >= {least}" if most is None else f"a whole number from {least} to {most}")

    def read(text: str) -> int:
        if not re.fullmatch(r"-?\d+", text) or int(text) < least or (most is not None and int(text) > most):
            raise Unreadable(f'{allowed}, got "{text}"')
        return int(text)

    return Value(read, metavar=metavar)


def number(allowed: str, is_allowed: Callable[[float], bool], metavar: str) -> Value:
    """A number for which `is_allowed` is true, described by `allowed`."""
    return Value(lambda text: _number(text, allowed, is_allowed), repr, metavar)


WEIGHT = number("a number >= 0", lambda x: 0.0 <= x < math.inf, "W")
LIGHT = number("a number >= 0", lambda x: 0.0 <= x < math.inf, "E")
POSITIVE = number("a number > 0", lambda x: 0.0 < x < math.inf, "E")
SHARE = number("a number from 0 to 1", lambda x: 0.0 <= x <= 1.0, "W")
PIXELS = whole(16, MAX_PIXELS, "PX", f"pixels from 16 to {MAX_PIXELS}")
INCIDENCE = number(f"degrees from 0 to {STEEPEST_INCIDENCE:g}", lambda x: 0.0 <= x <= STEEPEST_INCIDENCE, "DEG")
POINTS = number("points from 8 to 48", lambda x: 8.0 <= x <= 48.0, "PT")


def one_of(names: Sequence[str]) -> Value:
    """One of these names."""

    def read(text: str) -> str:
        if text not in names:
            raise Unreadable(f'one of {", ".join(names)}, got "{text}"')
        return text

    return Value(read, metavar="|".join(names))


def some_of(names: Sequence[str], metavar: str = "A,B") -> Value:
    """Some of these names, separated by commas, as a tuple without repetitions."""

    def read(text: str) -> tuple[str, ...]:
        chosen = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
        for name in chosen:
            if name not in names:
                raise Unreadable(f'any of {",".join(names)}, got "{name}"')
        return chosen

    return Value(read, ",".join, metavar)


def none_or_some_of(names: Sequence[str], metavar: str) -> Value:
    """Some of these names, separated by commas, or `none`, as a tuple in the order of `names`."""

    def read(text: str) -> tuple[str, ...]:
        chosen = [part.strip() for part in text.split(",")] if text != "none" else []
        for name in chosen:
            if name not in names:
                raise Unreadable(f'any of {",".join(names)}, or none, got "{name}"')
        return tuple(name for name in names if name in chosen)

    return Value(read, lambda chosen: ",".join(chosen) or "none", metavar)
