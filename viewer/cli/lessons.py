"""`raytree lessons`: the lessons, one per line; the check of a lesson; a new one."""

from pathlib import Path

from tracer.printable import printable, shown_path
from viewer.base.files import Unusable, has_folder, is_there
from viewer.base.streams import put
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
        put(f"{name:14} {printable(lesson.read(name).title)}{mark}\n")
    return 0


def _check(name: str) -> int:
    """Print all faults of a lesson, a line each. Returns 1 if there are any."""
    from viewer.lessons.check import check
    from viewer.window.lesson_room import room_faults

    path = _lesson_file(name)
    compile_once()
    faults = check(path) + room_faults(path)
    for fault in faults:
        put(f"{fault}\n")
    if not faults:
        put(f"{shown_path(path)}: nothing is wrong\n")
    return int(bool(faults))


def _lesson_file(name: str) -> Path:
    """The lesson.md of a folder, of a file, or of a lesson of the program. Raises Unusable if there is none."""
    path = Path(name)
    if has_folder(path):
        path = path / "lesson.md"
    elif not is_there(path):
        if path.suffix or len(path.parts) > 1:
            raise Unusable(f"{shown_path(path)}: file not found")
        return lesson.read(name).path
    if not is_there(path):
        raise Unusable(f"{shown_path(path)}: file not found")
    return path
