"""A translation of a lesson: `lesson.de.md` has the texts of its head and steps. All else is that of lesson.md."""

from collections.abc import Sequence
from dataclasses import replace

from viewer.lessons.reader import Source, read_steps, split
from viewer.lessons.step import Part, State, Step
from viewer.lessons.text import fences

SAME = ("live", "source")  # blocks that are no text


def translated_steps(source: Source, originals: Sequence[Step], body: str, first_line: int) -> list[Step]:
    """The steps with the texts of a translation, whose text begins on this line."""
    read = read_steps(source, State(), split(body, first_line))
    if len(read) != len(originals):
        last = read[min(len(read), len(originals)) - 1].line if read else first_line
        source.fault(f"a translation must have the {len(originals)} steps of lesson.md, got {len(read)}", last)
    return [_translated(source, original, step) for original, step in zip(originals, read, strict=False)]


def _translated(source: Source, original: Step, step: Step) -> Step:
    if step.lines:
        source.fault("a translation has no block step: the steps are those of lesson.md", step.line)
    if len(step.parts) != len(original.parts):
        parts = f"{len(original.parts)} parts between ???"
        source.fault(f"the step must have {parts}, as in lesson.md, got {len(step.parts)}", step.line)
    for part, other in zip(original.parts, step.parts, strict=False):
        if _blocks(part) != _blocks(other):
            known = ", ".join(f"{info} {content}".strip() for info, content in _blocks(part)) or "none"
            line = next((fence.line for fence in fences(other.blocks) if fence.kind in SAME), step.line)
            source.fault(f"the blocks {' and '.join(SAME)} must be those of lesson.md ({known})", line)
    said = step.notes or original.notes
    return replace(original, title=step.title, line=step.line, parts=step.parts, notes=said)


def _blocks(part: Part) -> list[tuple[str, str]]:
    """(words after the fence, content) of the blocks that are no text."""
    return [(fence.info, fence.content.strip()) for fence in fences(part.blocks) if fence.kind in SAME]
