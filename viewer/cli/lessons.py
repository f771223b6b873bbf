"""`raytree lessons`: the lessons, one per line."""

from tracer.printable import printable
from viewer.base.streams import put
from viewer.cli.options import LessonsOptions
from viewer.lessons import lesson


def lessons(options: LessonsOptions) -> int:
    for name in lesson.names():
        put(f"{name:14} {printable(lesson.read(name).title)}\n")
    return 0
