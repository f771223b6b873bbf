"""Command options as frozen dataclasses. Each field says how it is spelled, read, shown and explained.

    @dataclass(frozen=True, kw_only=True)
    class PlanOptions:
        scene: str = argument("SCENE", TEXT, "a file, or a lesson's name")
        measure: bool = switch("render with and without each capability")

`add_arguments` adds a dataclass's options to an argparse parser. `options_of` makes the dataclass from what was parsed.
`words` gives the command line that parses to the same dataclass.
"""

import argparse
import re
import shlex
from collections.abc import Callable, Iterable, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from typing import Any, TypeVar

from tracer.printable import printable
from viewer.base.values import Unreadable, Value

T = TypeVar("T")

SPELLING = "spelling"  # key of a field's metadata


@dataclass(frozen=True)
class Spelling:
    """The form of a field on a command line."""

    help: str
    value: Value | None = None  # None: a switch
    metavar: str = ""
    is_positional: bool = False
    nargs: str = ""  # of a positional: "" is one, "?" one or none, "+" one or more, "*" any number
    short: str = ""  # a one-letter option like -o
    group: str = ""  # at most one option of a group may be given
    is_required: bool = False  # this option, or one of its group


def option(
    value: Value,
    help: str,
    default: Any = None,
    *,
    metavar: str = "",
    short: str = "",
    group: str = "",
    required: bool = False,
) -> Any:
    """An option with a value, like `--depth D`. It is named like the field."""
    spelling = Spelling(help, value, metavar or value.metavar, short=short, group=group, is_required=required)
    if required and not group:
        return field(metadata={SPELLING: spelling})
    return field(default=default, metadata={SPELLING: spelling})


def switch(help: str) -> Any:
    """An option without a value, like `--json`."""
    return field(default=False, metadata={SPELLING: Spelling(help)})


def argument(metavar: str, value: Value, help: str, nargs: str = "") -> Any:
    """A value without an option's name: one; one or None with "?"; a tuple with "+" and "*"."""
    metadata = {SPELLING: Spelling(help, value, metavar, is_positional=True, nargs=nargs)}
    if nargs in ("", "+"):
        return field(metadata=metadata)
    return field(default=None if nargs == "?" else (), metadata=metadata)


def flag(name: str) -> str:
    """The option of a field: `min_weight` is --min-weight."""
    return "--" + name.replace("_", "-")


def spelling(item: Field[Any]) -> Spelling:
    """The Spelling of a field."""
    return item.metadata[SPELLING]


def add_arguments(parser: argparse.ArgumentParser, kind: type) -> None:
    """Add the options of a dataclass to a parser."""
    groups: dict[str, Any] = {}
    for item in fields(kind):
        how = spelling(item)
        place: Any = parser
        if how.group:
            if how.group not in groups:
                groups[how.group] = parser.add_mutually_exclusive_group(required=how.is_required)
            place = groups[how.group]
        names = [item.name] if how.is_positional else [*filter(None, [how.short]), flag(item.name)]
        if how.value is None:
            place.add_argument(*names, action="store_true", help=how.help)
            continue
        settings: dict[str, Any] = {"type": parser_of(how.value), "metavar": how.metavar, "help": how.help}
        if how.nargs:
            settings["nargs"] = how.nargs
        if not how.is_positional:
            settings["default"] = None if item.default is MISSING else item.default
            settings["required"] = how.is_required and not how.group
        place.add_argument(*names, **settings)


def parser_of(value: Value) -> Callable[[str], Any]:
    """The reader of a value, with errors as argparse reports them."""

    def parse(text: str) -> Any:
        try:
            return value.read(text)
        except Unreadable as unreadable:
            raise argparse.ArgumentTypeError(str(unreadable)) from None

    return parse


def options_of(kind: type[T], parsed: argparse.Namespace) -> T:
    """The dataclass of what was parsed."""
    found = {item.name: getattr(parsed, item.name) for item in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in found.items()})


def words(options: Any, leave_out: Sequence[str] = ()) -> list[str]:
    """The command line that parses to these options, without the fields in `leave_out`. Positionals come first."""
    found: list[str] = []
    for item in sorted(fields(options), key=lambda item: not spelling(item).is_positional):
        how, value = spelling(item), getattr(options, item.name)
        if item.name in leave_out or value == item.default:
            continue
        if how.value is None:
            found.append(flag(item.name))
        elif how.is_positional:
            found += [how.value.show(part) for part in (value if how.nargs in ("+", "*") else [value])]
        else:
            name, text = flag(item.name), how.value.show(value)
            found += [f"{name}={text}"] if text.startswith("-") else [name, text]  # no option of its own
    return found


def valued_flags(kinds: Iterable[type]) -> set[str]:
    """All options that take a value."""
    return {flag(item.name) for kind in kinds for item in fields(kind) if spelling(item).value}


def joined(arguments: Sequence[str], valued: Iterable[str]) -> list[str]:
    """Join an option to a value that begins with a minus sign: `--ray=-1,0,0`. argparse would take it for an option."""
    found: list[str] = []
    for argument in arguments:
        if found and found[-1] in valued and re.match(r"-[\d.]", argument):
            found[-1] += f"={argument}"
        else:
            found.append(argument)
    return found


def shell_line(words: Iterable[str]) -> str:
    """The words as a line for a shell (bash, zsh), without control characters: a word that has some is written as
    $'...' with escapes, which the shell reads back to the same word.
    """
    return " ".join(shlex.quote(word) if printable(word) == word else _escaped(word) for word in words)


def _escaped(word: str) -> str:
    def escape(c: str) -> str:
        code = ord(c)
        if c in "'\\":
            return f"\\{c}"
        if printable(c) == c:
            return c
        if code < 0x80 or 0xDC80 <= code <= 0xDCFF:  # ASCII, or a byte of a file's name that is not UTF-8
            return f"\\x{code & 0xFF:02x}"
        return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"

    return "$'" + "".join(map(escape, word)) + "'"
