"""Readers of what stands behind an option: each takes the text and gives the value, or says what is allowed."""

import argparse
import contextlib
import re
from collections.abc import Sequence


def pair(separator: str):
    """Reader of two whole numbers, as in 320,240 or 640x480."""

    def read(text: str) -> tuple[int, int]:
        parts = text.lower().split(separator)
        if len(parts) != 2 or not all(re.fullmatch(r"\s*-?\d+\s*", part) for part in parts):
            raise argparse.ArgumentTypeError(f'two whole numbers like 320{separator}240, got "{text}"')
        first, second = int(parts[0]), int(parts[1])
        if separator == "x" and not (1 <= first <= 16384 and 1 <= second <= 16384):
            raise argparse.ArgumentTypeError(f'a size from 1x1 to 16384x16384, got "{text}"')
        return first, second

    return read


def six(text: str) -> tuple[float, ...]:
    """A ray's origin and direction."""
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != 6:
        raise argparse.ArgumentTypeError(f'six numbers ox,oy,oz,dx,dy,dz, got "{text}"')
    return numbers


def ray_name(text: str) -> str:
    """4 or T4, as figures name rays."""
    if re.fullmatch(r"L\d+", text, re.IGNORECASE):
        raise argparse.ArgumentTypeError(f"a ray that meets a surface; {text} goes to a light: name the one before it")
    if not re.fullmatch(r"(?:R|T|TIR)?\d+|E", text, re.IGNORECASE):
        raise argparse.ArgumentTypeError(f'a ray as in the tree like 4, T4 or E, got "{text}"')
    return text


def at_least(least: int):
    def read(text: str) -> int:
        if not re.fullmatch(r"-?\d+", text) or int(text) < least:
            raise argparse.ArgumentTypeError(f'a whole number >= {least}, got "{text}"')
        return int(text)

    return read


def view_from(text: str) -> tuple[float, ...]:
    """From where the scene is seen: degrees about and above it, radii of the scene, and what is looked at."""
    numbers: list[float] = []
    with contextlib.suppress(ValueError):
        numbers += [float(part) for part in text.split(",")]
    finite = all(abs(number) < float("inf") for number in numbers)
    if finite and len(numbers) in (3, 6) and -90.0 <= numbers[1] <= 90.0 and numbers[2] > 0.0:
        return tuple(numbers)
    asked = "degrees about and above (-90 to 90) and a distance > 0 like 38,22,2.6, or these and a target X,Y,Z"
    raise argparse.ArgumentTypeError(f'{asked}, got "{text}"')


def depths(text: str) -> range:
    """3 or 0..3, both ends included."""
    found = re.fullmatch(r"(\d+)(?:\.\.(\d+))?", text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (1, 0)
    if first > last:
        raise argparse.ArgumentTypeError(f'a depth like 3, or several like 0..3, got "{text}"')
    return range(first, last + 1)


def listed(names: Sequence[str]):
    """Reader of some of these names, with commas between."""

    def read(text: str) -> list[str]:
        chosen = list(dict.fromkeys(part.strip() for part in text.split(",")))
        for name in chosen:
            if name not in names:
                raise argparse.ArgumentTypeError(f'any of {",".join(names)}, got "{name}"')
        return chosen

    return read


def pixels(text: str) -> int:
    if not re.fullmatch(r"\d+", text) or not 16 <= int(text) <= 16384:
        raise argparse.ArgumentTypeError(f'pixels from 16 to 16384, got "{text}"')
    return int(text)


def text_size(text: str) -> float:
    size = _number(text)
    if not 8.0 <= size <= 48.0:
        raise argparse.ArgumentTypeError(f'points from 8 to 48, got "{text}"')
    return size


def share(text: str) -> float:
    number = weight(text)
    if number > 1.0:
        raise argparse.ArgumentTypeError(f'a number from 0 to 1, got "{text}"')
    return number


def weight(text: str) -> float:
    number = _number(text)
    if not 0.0 <= number < float("inf"):
        raise argparse.ArgumentTypeError(f'a number >= 0, got "{text}"')
    return number


def above_zero(text: str) -> float:
    number = _number(text)
    if not 0.0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f'a number > 0, got "{text}"')
    return number


def _number(text: str) -> float:
    """NaN, which is within no limits, for what is none."""
    try:
        return float(text)
    except ValueError:
        return float("nan")
