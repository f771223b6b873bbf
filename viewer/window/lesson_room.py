"""Whether the text of a lesson has room beside its panels, measured with the window's own fonts."""

from pathlib import Path

from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.lessons.language import translations
from viewer.lessons.lesson import read_file
from viewer.lessons.moments import Moment
from viewer.session.lecture.ahead import LAST
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import NoWindow, Offscreen

SIZE = (1280, 720)  # of a projector's window, in lecture mode


def room_faults(path: Path) -> list[str]:
    """The steps whose text needs scrolling in lecture type, one line each. None of a lesson that cannot be read."""
    try:
        versions = [read_file(path, languages) for languages in ((), *([code] for code in translations(path)))]
    except Unusable:
        return []
    try:
        app = App(Offscreen(SIZE), Session())
    except NoWindow as reason:
        return [f"{shown_path(path)}: the room of its text is not measured: {reason}"]
    session, faults = app.session, []
    session.appearance.toggle_lecture_size()
    try:
        for lesson, number, step in ((one, k, step) for one in versions for k, step in enumerate(one.steps)):
            session.player.show(lesson, Moment(number, LAST))
            app.settle()
            lines = session.player.lines_too_many
            if lines > 0:
                what = f"its text needs scrolling in lecture type at {SIZE[0]}x{SIZE[1]}: {lines} lines too many"
                faults.append(f"{shown_path(lesson.files[-1])}: line {step.line}: {what}")
    finally:
        app.close()
    return faults
