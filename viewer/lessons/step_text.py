"""A state as the text of a block `step`, which is read back as the same state."""

import json
import re
from collections.abc import Mapping
from dataclasses import fields as fields_of
from typing import Any

from viewer.lessons.step import INHERITED, LessonView, State

BARE = re.compile(r"[A-Za-z0-9_-]+")  # a key of TOML without quotes


def step_text(state: State) -> str:
    """The block with its fence. It has every field that is inherited, whatever the step before may have, but for those
    that are None; of the others it has `hit`.
    """
    named = {name: getattr(state, name) for name in (*INHERITED, "hit")}
    lines = [f"{name} = {_toml(value)}" for name, value in named.items() if value is not None]
    return "\n".join(["```step", *lines, "```", ""])


def _toml(value: Any) -> str:
    """A value in TOML, in one line."""
    match value:
        case bool():
            return str(value).lower()
        case str():
            return _quoted(value)
        case Mapping():
            entries = [f"{_key(key)} = {_toml(one)}" for key, one in value.items()]
            return f"{{ {', '.join(entries)} }}" if entries else "{}"
        case LessonView():
            found = {item.name: getattr(value, item.name) for item in fields_of(value)}
            return _toml({name: one for name, one in found.items() if one is not None})
        case list() | tuple():
            return f"[{', '.join(map(_toml, value))}]"
    return repr(value)


def _key(name: str) -> str:
    return name if BARE.fullmatch(name) else _quoted(name)


def _quoted(text: str) -> str:
    """A basic string of TOML: escapes as in JSON, and one more character that must be escaped."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", r"\u007f")
