"""What a step expects of the rays of its pixel, compared with the tree: `expect`, and `goal` for a live task.

    expect = { theta1 = "47.26", children = ["R", "T"], TR.end = "background" }

A number is a text: it is right if it is within half a unit of its last digit.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from typing import Any

from tracer import fields
from tracer.kernel.nodes import SHADOW
from tracer.tree.names import LETTERS
from tracer.tree.raytree import RayTree
from viewer.lessons.values import QUANTITIES, row_named

CHILDREN, END, OBJECT = "children", "end", "object"
SYMBOLS = {"theta1": "θ₁", "theta2": "θ₂", "critical": "θc", "n1": "n₁", "n2": "n₂", "eta": "n₁/n₂"}
ANGLES = ("theta1", "theta2", "critical")
SENT_ON = {
    (): "no ray goes on",
    ("R",): "a reflected ray goes on, and no other",
    ("T",): "a refracted ray goes on, and no other",
    ("I",): "total internal reflection",
    ("R", "T"): "a reflected and a refracted ray go on",
}
NAMES = (*QUANTITIES, CHILDREN, END, OBJECT)


def failures(expected: Mapping[str, Any], tree: RayTree, hit: str | None) -> list[tuple[str, str]]:
    """(key, fault) for all that does not hold. `hit` is the path that names without a path are about."""
    found = []
    for path, name, value in _entries(expected):
        key = f"{path}.{name}" if path else name
        fault = _fault(key, path, name, value, tree, hit)
        if fault:
            found.append((name, fault))
    return found


@dataclass(frozen=True)
class Condition:
    """One of several that a goal consists of."""

    words: str
    holds: bool
    now: str = ""  # the number that is there instead; empty if there is none, or if the condition is not about a number


def conditions(goal: Mapping[str, Any], tree: RayTree | None, hit: str | None) -> list[Condition]:
    """The conditions of a goal in words, and whether they hold for a tree; `hit` as in `failures`."""
    found = []
    for path, name, value in _entries(goal):
        words = _words(path, name, value)
        holds = tree is not None and not _fault(name, path, name, value, tree, hit)
        found.append(Condition(words, holds, "" if holds or tree is None else _now(path, name, value, tree, hit)))
    return found


def _now(path: str, name: str, value: Any, tree: RayTree, hit: str | None) -> str:
    """The number of this name in the tree, with a digit more than the one that is asked for."""
    row = row_named(tree, path or None, hit)
    number = QUANTITIES[name].value(tree, row) if row is not None and name in QUANTITIES else math.nan
    if math.isnan(number):
        return ""
    digits = len(str(value).partition(".")[2]) + 1
    return f"{number:.{digits}f}".replace("-", "−") + ("°" if name in ANGLES else "")


def _words(path: str, name: str, value: Any) -> str:
    """What is to hold, in words."""
    before = f"{path}: " if path else ""
    match name:
        case "children" if isinstance(value, list):
            kinds = tuple(map(str, value))
            return before + SENT_ON.get(kinds, f"the rays {', '.join(kinds)} go on")
        case "end":
            return f"{path or 'the ray'} ends: {value}"
        case "object":
            return f"{path or 'the ray'} meets {value}"
    return f"{before}{SYMBOLS.get(name, name)} = {value}{'°' if name in ANGLES else ''}"


def _entries(expected: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, str, Any]]:
    """(path, name, value). Tables are paths, also written as `TR.theta1`."""
    for key, value in expected.items():
        if isinstance(value, Mapping):
            yield from _entries(value, key)
        else:
            before, dot, name = key.rpartition(".")
            yield (before if dot else path), name, value


def _fault(key: str, path: str, name: str, value: Any, tree: RayTree, hit: str | None) -> str:
    """What is wrong; empty if nothing is."""
    if name not in NAMES:
        return f'unknown name "{name}"{fields.hint(name, NAMES)}'
    row = row_named(tree, path or None, hit)
    if row is None:
        known = ", ".join(tree.path(i) for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW)
        return f"{key}: the tree has no ray {path or hit} (it has {known})"
    match name:
        case "children":
            return _same(key, value, [LETTERS[tree.kind(i)] for i in tree.children[row] if tree.kind(i) != "shadow"])
        case "end":
            return _same(key, value, tree.end(row) or "")
        case "object":
            return _same(key, value, tree.object_name(row) or "")
    return _number_fault(key, value, QUANTITIES[name].value(tree, row))


def _same(key: str, expected: Any, found: Any) -> str:
    return "" if expected == found else f"{key} must be {fields.shown(expected)}, got {fields.shown(found)}"


def _number_fault(key: str, expected: Any, found: float) -> str:
    try:
        number = Decimal(expected) if isinstance(expected, str) else None
    except InvalidOperation:
        number = None
    if number is None or not number.is_finite():
        return f'{key} must be a number in quotes, like "47.26", got {fields.shown(expected)}'
    exponent = number.as_tuple().exponent
    assert isinstance(exponent, int)
    if math.isnan(found):
        return f"{key} must be {expected}, but this hit has none"
    if abs(Decimal(found) - number) <= Decimal((0, (5,), exponent - 1)):
        return ""
    return f"{key} must be {expected}, got {found:.{max(0, -exponent) + 2}f}"
