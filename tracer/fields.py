"""Rules for the fields of a scene, each written once, beside the field: they read, check and explain its values.

A field of a scene's dataclass carries `metadata=number(above=0)` or the like. The rule turns what the author wrote
into what the tracer uses, or says what is allowed: `radius must be > 0, got -1`.
"""

import difflib
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from itertools import chain
from typing import Any

LARGEST = 1e150  # limit of a coordinate: its square must not overflow
LEAST = 1e-150  # limit of numbers that must be above 0: their squares must not underflow


class Refused(Exception):
    """A value that is not allowed. The text says what is."""


def rule(
    read: Callable[[Any], Any], allows_all: Callable[[list[Any]], bool] = lambda values: False
) -> Mapping[str, Callable[[Any], Any]]:
    """The metadata of a field that `read` converts and checks. `allows_all` checks many values at once: it may return
    False for allowed ones, which are then read one by one.
    """
    return {"read": read, "allows_all": allows_all}


def number(
    above: float | None = None, least: float | None = None, most: float | None = None, below: float | None = None
) -> Mapping[str, Callable[[Any], Any]]:
    """A finite number in a range."""
    limits = [(above, "> {:g}"), (least, ">= {:g}"), (most, "<= {:g}"), (below, "< {:g}")]
    allowed = " and ".join(text.format(limit) for limit, text in limits if limit is not None)

    def read(value: Any) -> float:
        if not _is_number(value):
            raise Refused(f"a number {allowed}".rstrip())
        if not abs(value) <= LARGEST:
            raise Refused(f"a number with an absolute value of at most {LARGEST:g}")
        outside = (
            (above is not None and not value > above)
            or (least is not None and not value >= least)
            or (most is not None and not value <= most)
            or (below is not None and not value < below)
        )
        if outside:
            raise Refused(allowed)
        if above == 0.0 and value < LEAST:
            raise Refused(f"at least {LEAST:g}")
        return float(value)

    def allows_all(values: list[Any]) -> bool:
        # The range has no gaps, so the smallest and the largest value decide.
        if not values or not set(map(type, values)) <= {float} or any(map(math.isnan, values)):
            return False
        try:
            read(min(values))
            read(max(values))
        except Refused:
            return False
        return True

    return rule(read, allows_all)


def whole(least: int, most: int) -> Mapping[str, Callable[[Any], Any]]:
    """An integer in a range."""

    def read(value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            raise Refused(f"a whole number from {least} to {most}")
        return value

    return rule(read, lambda values: set(map(type, values)) <= {int} and least <= min(values) <= max(values) <= most)


def flag() -> Mapping[str, Callable[[Any], Any]]:
    def read(value: Any) -> bool:
        if not isinstance(value, bool):
            raise Refused("true or false")
        return value

    return rule(read, lambda values: set(map(type, values)) <= {bool})


def text() -> Mapping[str, Callable[[Any], Any]]:
    def read(value: Any) -> str:
        if not isinstance(value, str) or not value.strip():
            raise Refused("a non-empty string")
        return value

    return rule(read, lambda values: set(map(type, values)) <= {str} and all(map(str.strip, values)))


def texts() -> Mapping[str, Callable[[Any], Any]]:
    """A list of non-empty strings."""

    def read(value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(item, str) and item.strip() for item in value):
            raise Refused("a list of non-empty strings")
        return tuple(value)

    return rule(read)


def choice(*allowed: str) -> Mapping[str, Callable[[Any], Any]]:
    def read(value: Any) -> str:
        if not isinstance(value, str) or value not in allowed:
            raise Refused(one_of(allowed) + nearest(value, allowed))
        return value

    return rule(read)


def point() -> Mapping[str, Callable[[Any], Any]]:
    """Three coordinates."""

    def allows_all(values: list[Any]) -> bool:
        if not values or not set(map(type, values)) <= {tuple} or not set(map(len, values)) <= {3}:
            return False
        numbers = list(chain.from_iterable(values))
        return (
            set(map(type, numbers)) <= {float}
            and all(map(math.isfinite, numbers))
            and max(map(abs, numbers)) <= LARGEST
        )

    return rule(lambda value: _three(value, "three numbers [x, y, z]"), allows_all)


def direction() -> Mapping[str, Callable[[Any], Any]]:
    """Three coordinates that are not all 0."""

    def read(value: Any) -> tuple[float, ...]:
        xyz = _three(value, "three numbers [x, y, z]")
        if not any(xyz):
            raise Refused("a direction other than [0, 0, 0]")
        return xyz

    return rule(read)


def color() -> Mapping[str, Callable[[Any], Any]]:
    """Linear RGB, each component >= 0."""

    def read(value: Any) -> tuple[float, ...]:
        rgb = _three(value, "three numbers [r, g, b]")
        if min(rgb) < 0.0:
            raise Refused("three numbers [r, g, b] >= 0")
        return rgb

    return rule(read)


def points(at_least: int = 0, exactly: int | None = None) -> Mapping[str, Callable[[Any], Any]]:
    """A list of points."""
    allowed = f"a list of {exactly if exactly else f'at least {at_least}'} points [x, y, z]"

    def read(value: Any) -> tuple[tuple[float, ...], ...]:
        if not isinstance(value, list | tuple):
            raise Refused(allowed)
        if len(value) != exactly if exactly else len(value) < at_least:
            raise Refused(allowed)
        return tuple(_three(item, allowed) for item in value)

    return rule(read)


def _three(value: Any, allowed: str) -> tuple[float, float, float]:
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise Refused(allowed)
    x, y, z = value
    if not (_is_number(x) and _is_number(y) and _is_number(z)):
        raise Refused(allowed)
    if not (abs(x) <= LARGEST and abs(y) <= LARGEST and abs(z) <= LARGEST):
        raise Refused(f"{allowed} with absolute values of at most {LARGEST:g}")
    return (float(x), float(y), float(z))


def _is_number(value: Any) -> bool:
    return type(value) is float or (isinstance(value, int | float) and not isinstance(value, bool))


def one_of(allowed: Iterable[str]) -> str:
    return "one of " + ", ".join(f'"{name}"' for name in allowed)


def nearest(name: Any, known: Iterable[str]) -> str:
    """A hint like ' (did you mean "radius"?)' if one of the known names is similar, else nothing."""
    close = difflib.get_close_matches(str(name), list(known), n=1)
    return f' (did you mean "{close[0]}"?)' if close else ""


def hint(name: Any, known: Iterable[str]) -> str:
    """The nearest of the known names, as `nearest`; if none is similar, all of them, like " (known: a, b)"."""
    known = tuple(known)
    return nearest(name, known) or f" (known: {', '.join(known) or 'none'})"


def shown(value: Any) -> str:
    """A value as the author wrote it, shortened if it is long."""
    match value:
        case bool():
            written = "true" if value else "false"
        case str():
            written = f'"{value}"'
        case float():
            written = f"{value:g}" if float(f"{value:g}") == value or not math.isfinite(value) else repr(value)
        case list() | tuple():
            written = "[" + ", ".join(shown(item) for item in value) + "]"
        case dict():
            written = "a table"
        case int() if abs(value) > 10**20:
            written = "a number of more than 20 digits"
        case _:
            written = str(value)
    return written if len(written) <= 60 else written[:57] + "..."


def refusal(name: str, allowed: Refused | str, value: Any) -> str:
    return f"{name} must be {allowed}, got {shown(value)}"


@cache
def ruled(kind: type) -> dict[str, Field[Any]]:
    """The fields of a dataclass that an author may write."""
    return {field.name: field for field in fields(kind) if "read" in field.metadata}


def read_fields(kind: type, table: Mapping[str, Any], faults: list[str], also: Iterable[str] = ()) -> dict[str, Any]:
    """The values for a dataclass from a table of a file. Adds a line to `faults` for each unknown, missing or bad key.

    `also` names keys that the caller reads itself.
    """
    rules = ruled(kind)
    known = [*rules, *also]
    values = {}
    for key, value in table.items():
        if key in rules:
            try:
                values[key] = rules[key].metadata["read"](value)
            except Refused as allowed:
                faults.append(refusal(key, allowed, value))
        elif key not in known:
            faults.append(f'unknown key "{key}"{hint(key, known)}')
    for name, field in rules.items():
        if name not in table and field.default is MISSING and field.default_factory is MISSING:
            faults.append(f"{name} is missing")
    return values


def _same(value: Any, default: Any) -> bool:
    return type(value) is type(default) and value == default


def allow_all(things: Sequence[Any]) -> bool:
    """Whether many dataclasses of one type have only allowed values. Much faster than one by one; it may return False
    where each is allowed.
    """
    for name, field in ruled(type(things[0])).items():
        values = [value for thing in things if (value := getattr(thing, name)) is not field.default]
        if values and not field.metadata["allows_all"](values):
            return False
    return True


def value_faults(thing: Any) -> list[str]:
    """The faults of a dataclass that was made in Python, by the same rules as for a file."""
    faults = []
    for name, field in ruled(type(thing)).items():
        value = getattr(thing, name)
        if _same(value, field.default) or is_dataclass(value):
            continue
        try:
            field.metadata["read"](value)
        except Refused as allowed:
            faults.append(refusal(name, allowed, value))
    return faults
