"""Everything that is wrong with a lesson, each with its line: what can be said without a window."""

from collections.abc import Iterator
from pathlib import Path

from tracer.formats.source import Fault
from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.lessons.check.rays import StepRays
from viewer.lessons.check.text import text_faults
from viewer.lessons.language import translations
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.scenes import SceneFaults, StepScenes


def check(path: Path, language: str | None = None) -> list[str]:
    """The faults of a lesson.md and of its translations, or of that into one language, one line each, in the order of
    each file.
    """
    place = shown_path(path)
    try:
        lesson = read_file(path, ())
    except Unusable as unusable:
        return list(unusable.faults)
    faults = _sorted(_faults(lesson), place)
    is_sound = not faults  # otherwise a translation has the same faults
    for code, file in translations(path, language).items():
        try:
            translated = read_file(path, [code])
        except Unusable as unusable:
            faults += unusable.faults
        else:
            faults += _sorted(_faults(translated), shown_path(file)) if is_sound else []
    return faults


def _sorted(found: Iterator[Fault], place: str) -> list[str]:
    return [fault.within(place) for fault in sorted(found, key=lambda fault: fault.line or 0)]


def _faults(lesson: Lesson) -> Iterator[Fault]:
    if not lesson.question:
        yield Fault('question is missing: a lesson begins with one, like question = "Why is it dark?"', 2)
    scenes, told = StepScenes(), set[str]()  # a fault of a scene is that of the first step that has it
    for step in lesson.steps:
        yield from text_faults(step)
        worlds = []
        for share in (0.0, 1.0) if step.state.sweep else (0.0,):
            try:
                worlds.append(scenes.world(step, share))
            except SceneFaults as error:
                yield from (fault for fault in error.faults if str(fault) not in told)
                told |= set(map(str, error.faults))
                worlds.append(None)
        if worlds[0]:
            yield from StepRays(step, worlds[0]).faults(worlds[-1])
