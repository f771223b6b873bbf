"""`raytree lessons`: the lessons, one per line."""

from viewer.cli.options import LessonsOptions
from viewer.cli.terminal import put
from viewer.lessons import lesson


def lessons(options: LessonsOptions) -> int:
    for name in lesson.names():
        put(f"{name:14} {lesson.read(name).title}\n")
    return 0
