"""`raytree lessons`: the lessons, one per line; the check of a lesson; a new one."""

from pathlib import Path

from tracer.printable import printable, shown_path
from viewer.base.files import Unusable
from viewer.base.streams import put
from viewer.cli.loading import lesson_file
from viewer.cli.options import LessonsOptions
from viewer.cli.terminal import compile_once
from viewer.lessons import lesson
from viewer.lessons.language import check_language, wanted


def lessons(options: LessonsOptions) -> int:
    if options.new and options.language:
        raise Unusable("raytree lessons: --language is for the list and for --check")
    if options.new:
        from viewer.lessons.skeleton import write_skeleton

        for path in write_skeleton(Path(options.new)):
            put(f"{shown_path(path)}\n")
        return 0
    if options.check is not None:
        return _check(options.check, options.language)
    course, languages = lesson.course(), wanted(options.language)
    for name in lesson.names():
        mark = "" if name in course else "  (deeper)"
        put(f"{name:14} {printable(lesson.read_title(name, languages))}{mark}\n")
    return 0


def _check(name: str, language: str | None) -> int:
    """Print all faults of a lesson, a line each. Returns 1 if there are any."""
    from viewer.lessons.check import check
    from viewer.window.lesson_room import room_faults

    path = lesson_file(Path(name)) or lesson.file_of(name)
    check_language(path, language)
    compile_once()
    faults = check(path, language) + room_faults(path, language)
    for fault in faults:
        put(f"{fault}\n")
    if not faults:
        put(f"{shown_path(path)}: nothing is wrong\n")
    return int(bool(faults))
