"""The source text of a function of the tracer, by its name, as a lesson shows it beside the numbers that it computed.

Kernels call these very functions: Numba compiles their text, and from Python they run as they stand.
"""

import ast
import importlib
import inspect
import re
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import tracer
from tracer import fields

ROOT = Path(tracer.__file__).parents[1]
LONG = 72  # characters of a docstring that is left out
HANG, DEEPER = 4, 8  # characters by which the rest of a long line is indented, and that of a `def`
REMARK = re.compile(r"(?:^|  )#.*|^\s*\"\"\".*")  # a comment, or a docstring of one line
# Places to break a long line: before a comment, then (the best that is outermost) before an operator or after a comma.
OPERATORS = r" (?=(?:->|[-+*/<>=!]=?|and|or|if|else|for|in) )|(?<=,) "
WEAKEST = re.compile(r" (?:and|or) ")
CUTS = (r"  (?=#)", OPERATORS, r"(?<!:) ", r"(?=\.)")
SHORTEST = 0.4  # share of the width that a part of a broken line fills at least, for a good place


@dataclass(frozen=True)
class Listing:
    """A function's text, from the line that defines it."""

    name: str
    place: str  # its file and line
    lines: tuple[str, ...]


def listing(name: str) -> Listing:
    """The text of a function such as `tracer.optics.transmission`, without decorators, and without a long docstring.
    ValueError with the nearest names if there is none.
    """
    function = _function(name)
    text, start = inspect.getsourcelines(function)
    lines = textwrap.dedent("".join(text)).split("\n")[:-1]
    node = ast.parse("\n".join(lines)).body[0]
    assert isinstance(node, ast.FunctionDef)
    docstring = node.body[0]
    said = ast.get_docstring(node) or ""
    is_long = ("\n" in said or len(said) > LONG) and len(node.body) > 1
    hidden = range(docstring.lineno, (docstring.end_lineno or 0) + 1) if is_long else ()
    shown = tuple(line for k, line in enumerate(lines, 1) if k >= node.lineno and k not in hidden)
    file = Path(inspect.getsourcefile(function) or "").relative_to(ROOT)
    return Listing(name, f"{file.as_posix()}, line {start + node.lineno - 1}", shown)


def _function(name: str) -> FunctionType:
    """The function itself: of the tracer's package, or of one of its modules or classes."""
    first, *rest = name.split(".")
    if first != "tracer" or not rest:
        raise ValueError(f'a function of the tracer, like tracer.optics.transmission, is shown, got "{name}"')
    found: Any = tracer
    for k, word in enumerate(rest):
        inner = _inner(found)
        if word not in inner:
            at = ".".join((first, *rest[:k]))
            raise ValueError(f'{at} has no function "{word}"{fields.hint(word, inner)}, got "{name}"')
        found = inner[word] or importlib.import_module(f"{found.__name__}.{word}")
    function = getattr(found, "py_func", found)  # of what Numba compiles as an entry point
    if not isinstance(function, FunctionType):
        raise ValueError(f"{name} is no function{fields.hint('', _inner(found))}")
    return function


def _inner(owner: Any) -> dict[str, Any]:
    """The parts that may follow a name: functions and classes of the tracer, and modules (None: not imported yet)."""
    found: dict[str, Any] = {}
    if isinstance(owner, ModuleType) and hasattr(owner, "__path__"):
        paths = sorted(path.name.removesuffix(".py") for place in owner.__path__ for path in Path(place).iterdir())
        found = {name: None for name in paths if name.isidentifier() and _is_module(owner, name)}
    names = dir(owner) if isinstance(owner, (ModuleType, type)) else ()  # also those imported on first use
    for name in names:
        value = getattr(owner, name)
        plain = getattr(value, "py_func", value)
        is_ours = str(getattr(plain, "__module__", "")).partition(".")[0] == "tracer"
        if is_ours and isinstance(plain, (FunctionType, type)):
            found[name] = value
    return found


def _is_module(owner: ModuleType, name: str) -> bool:
    return not name.startswith("_") and find_spec(f"{owner.__name__}.{name}") is not None


def wrapped_code(line: str, most: int) -> list[str]:
    """A line of source text in parts of at most `most` characters, broken before an operator or after a comma, where
    the fewest brackets are open; else at a blank, or before a dot. The rest is indented further.
    """
    indent = len(line) - len(line.lstrip())
    hang = DEEPER if line.lstrip().startswith("def ") else HANG
    parts, left = [], line
    while len(left) > most:
        cut = _cut(left, most)
        parts.append(left[:cut].rstrip())
        left = " " * min(indent + hang, most // 2) + left[cut:].lstrip()
    return [*parts, left]


def _cut(line: str, most: int) -> int:
    """The place at which a line is broken: in the fewest brackets, `and` and `or` before others, and then the last."""
    inner = len(line) - len(line.lstrip())
    for least in (inner + SHORTEST * (most - inner), inner):
        for sign in CUTS:
            places = [found.start() for found in re.finditer(sign, line) if least < found.start() <= most]
            if places:
                return min(places, key=lambda place: (_open(line[:place]), not WEAKEST.match(line, place), -place))
    return most


def _open(begun: str) -> int:
    """The brackets that are open at the end of the beginning of a line."""
    return sum(begun.count(sign) for sign in "([{") - sum(begun.count(sign) for sign in ")]}")


def split_remark(lines: Sequence[str], most: int) -> Iterator[tuple[str, str]]:
    """(code, remark) for each line, wrapped to `most` characters."""
    for line in lines:
        found = REMARK.search(line)
        remark = "".join(found[0].split()) if found else ""
        ahead = len("".join(line.split())) - len(remark)  # characters of code that are yet to come
        for part in wrapped_code(line, most):
            at, ahead = _after(part, ahead)
            yield part[:at], part[at:]


def _after(part: str, count: int) -> tuple[int, int]:
    """(place behind so many characters that are no blanks, those that are left beyond the part)."""
    for at, sign in enumerate(part):
        if count == 0:
            return (at if part[:at].strip() else 0), 0
        count -= not sign.isspace()
    return len(part), count
