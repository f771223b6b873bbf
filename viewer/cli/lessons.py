"""`raytree lessons`: the lessons, one per line; the check of a lesson; a new one."""

from pathlib import Path

from tracer.printable import printable, shown_path
from viewer.base.streams import put
from viewer.cli.loading import lesson_file
from viewer.cli.options import LessonsOptions
from viewer.cli.terminal import compile_once
from viewer.lessons import lesson


def lessons(options: LessonsOptions) -> int:
    if options.new:
        from viewer.lessons.skeleton import write_skeleton

        for path in write_skeleton(Path(options.new)):
            put(f"{shown_path(path)}\n")
        return 0
    if options.check is not None:
        return _check(options.check)
    course = lesson.course()
    for name in lesson.names():
        mark = "" if name in course else "  (deeper)"
        put(f"{name:14} {printable(lesson.read_title(name))}{mark}\n")
    return 0


def _check(name: str) -> int:
    """Print all faults of a lesson, a line each. Returns 1 if there are any."""
    from viewer.lessons.check import check
    from viewer.window.lesson_room import room_faults

    path = lesson_file(Path(name)) or lesson.read(name).path
    compile_once()
    faults = check(path) + room_faults(path)
    for fault in faults:
        put(f"{fault}\n")
    if not faults:
        put(f"{shown_path(path)}: nothing is wrong\n")
    return int(bool(faults))
