"""Reads the text of a lesson: its data, and its steps with their states and parts. Collects all faults."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields as fields_of, replace
from pathlib import Path
from typing import Any

from tracer import fields
from tracer.formats.source import Fault
from tracer.formats.toml import parsed
from viewer.lessons.markdown import FORMULA, blocks_of
from viewer.lessons.step import INHERITED, STATE_KEYS, LessonView, Part, State, Step, lines_of
from viewer.lessons.text import Block, Fence

MARK = "+++"  # before and after the data
HIDDEN = "???"  # hides the text below it until the next press
FENCE = re.compile(r" {0,3}(`{3,}|~{3,})\s*(.*)")
HEADING = re.compile(r" {0,3}#{1,2}\s+(.*?)\s*#*\s*")
FENCES = ("step", "notes", "live", "source", "code")  # fenced blocks with a meaning


@dataclass
class Source:
    """What is read, and the faults found so far."""

    folder: Path
    faults: list[Fault] = field(default_factory=list)

    def fault(self, text: str, line: int) -> None:
        self.faults.append(Fault(text, line))


@dataclass(frozen=True)
class Head:
    """The data of a lesson."""

    title: str = field(metadata=fields.text())
    question: str = field(default="", metadata=fields.text())
    minutes: int | None = field(default=None, metadata=fields.whole(1, 600))
    objectives: tuple[str, ...] = field(default=(), metadata=fields.texts())
    state: State = field(default_factory=State)  # before the first step


@dataclass(frozen=True)
class Section:
    """A heading with the lines below it, in pieces between lines `???`: (first line, text)."""

    title: str | None  # None: before the first heading
    line: int
    pieces: tuple[tuple[int, str], ...]


TEXTS = ("title", "question", "objectives")  # the data that a translation has


def read_head(source: Source, text: str, first_line: int, of_translation: bool = False) -> Head:
    """The data between the marks, of a translation the texts. The fields of a state are those before the first step."""
    data = _toml(source, text, first_line)
    own = {item.name for item in fields_of(Head)} - {"state"}
    lines = lines_of(text, first_line)
    for key in [key for key in data if of_translation and key not in TEXTS]:
        said = f"a translation has {', '.join(TEXTS)}; all else is that of lesson.md"
        source.fault(f'unknown key "{key}": {said}', lines.get(key, first_line))
        del data[key]
    of_steps = {key: value for key, value in data.items() if key not in own}
    state = _state(source, State(), of_steps, text, first_line, INHERITED, sorted(own))
    found: list[str] = []
    values = fields.read_fields(Head, {key: data[key] for key in own if key in data}, found)
    for fault in found:
        source.fault(fault, lines.get(fault.split()[0], first_line))
    return Head(**{"title": "", **values}, state=state)


def split(body: str, first_line: int) -> list[Section]:
    """The sections of a text that begins on this line. Headings and `???` inside fences do not count."""
    sections: list[Section] = []
    title, line, pieces, begun = None, first_line, list[tuple[int, str]](), first_line
    lines: list[str] = []
    fence = ""

    def end_piece(following: int) -> None:
        nonlocal lines, begun
        pieces.append((begun, "\n".join(lines)))
        lines, begun = [], following

    for number, content in enumerate(body.split("\n"), first_line):
        found = FENCE.fullmatch(content)
        if fence:
            if found and found[1].startswith(fence) and not found[2]:
                fence = ""
        elif found:
            fence = found[1]
        elif heading := HEADING.fullmatch(content):
            end_piece(number + 1)
            sections.append(Section(title, line, tuple(pieces)))
            title, line, pieces = heading[1], number, []
            continue
        elif content.strip() == HIDDEN:
            end_piece(number + 1)
            continue
        lines.append(content)
    end_piece(0)
    return [*sections, Section(title, line, tuple(pieces))]


def read_steps(source: Source, before: State, sections: Sequence[Section]) -> list[Step]:
    """The steps, each with its whole state."""
    steps = []
    for section in sections:
        pieces = [blocks_of(text, line) for line, text in section.pieces]
        if section.title is None:
            if any(pieces):
                source.fault("text before the first step: write a heading like ## What is seen above it", section.line)
            continue
        step = _step(source, before, section, pieces)
        before = step.state.swept(1.0)  # the next step goes on from where a sweep ended
        steps.append(step)
    if not steps:
        source.fault("a lesson has at least one step: a heading like ## What is seen", sections[0].line)
    return steps


def _step(source: Source, before: State, section: Section, pieces: list[tuple[Block, ...]]) -> Step:
    base = replace(State(), **{name: getattr(before, name) for name in INHERITED})
    state, lines, notes, seen = base, dict[str, int](), list[str](), False
    for k, block in ((k, block) for k, blocks in enumerate(pieces) for block in blocks):
        if not isinstance(block, Fence):
            seen = True
            continue
        if block.kind == "notes":
            notes.append(block.content.strip())
        elif block.kind == "step":
            if seen or k or lines:
                source.fault("the block step stands right below the heading, once", block.line)
            begin = block.line + 1
            lines = lines_of(block.content, begin)
            state = _state(source, base, _toml(source, block.content, begin), block.content, begin)
        elif block.kind not in FENCES and (near := fields.nearest(block.kind, FENCES)):
            source.fault(f'unknown block "{block.kind}"{near}', block.line)
        elif block.kind == "code" and (near := fields.nearest(block.argument, [FORMULA])):
            source.fault(f'unknown block "{block.info}"{near}', block.line)
        seen = seen or block.kind not in ("step", "notes")
    state = _with_sweep(source, state, lines)
    parts = [
        Part(tuple(block for block in blocks if not _is_data(block)))
        for blocks in pieces
    ]  # fmt: skip
    title, said = section.title or "", "\n\n".join(notes)
    return Step(title, section.line, state, tuple(parts), said, source.folder, lines)


def _with_sweep(source: Source, state: State, lines: Mapping[str, int]) -> State:
    """The state at the beginning of its sweep."""
    if not state.sweep:
        return state
    if state.reveal:
        source.fault("a step has a reveal or a sweep, not both", lines["sweep"])
    begun = state.swept(0.0)
    if "pixel" in lines and state.pixel != begun.pixel:
        source.fault("pixel is that with which the sweep begins: leave it out", lines["pixel"])
    return begun


def _is_data(block: Block) -> bool:
    return isinstance(block, Fence) and block.kind in ("step", "notes")


def _toml(source: Source, text: str, first_line: int) -> dict[str, Any]:
    try:
        return parsed(text.encode("utf-8"))
    except Fault as fault:
        source.fault(str(fault), first_line + (fault.line or 1) - 1)
        return {}


def _state(
    source: Source,
    base: State,
    data: Mapping[str, Any],
    text: str,
    first_line: int,
    allowed: Sequence[str] = STATE_KEYS,
    also: Sequence[str] = (),
) -> State:
    """The state `base` with the fields of a table. `also` are keys that are read elsewhere."""
    found: list[tuple[str, str]] = []
    for key, value in data.items():
        faults: list[str] = []
        if key == "view":
            view = _view(value, faults)
            base = replace(base, view=view)
        elif key in allowed:
            values = fields.read_fields(State, {key: value}, faults)
            base = replace(base, **values)
        else:
            faults.append(f'unknown key "{key}"{fields.hint(key, (*also, *allowed))}')
        found += [(key, fault) for fault in faults]
    lines = lines_of(text, first_line)
    for key, fault in found:
        source.fault(fault, lines.get(key, first_line))
    return base


def _view(table: Any, faults: list[str]) -> LessonView:
    if not isinstance(table, dict):
        faults.append(fields.refusal("view", "a table", table))
        return LessonView()
    inner: list[str] = []
    values = fields.read_fields(LessonView, table, inner)
    faults += [f"view: {fault}" for fault in inner]
    return LessonView(**values)
