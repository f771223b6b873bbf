"""The lesson's text. A scene that belongs to no lesson has no such panel."""

from imgui_bundle import imgui

from tracer.printable import printable
from viewer.gl.canvas import Canvas
from viewer.panels.panel import Panel
from viewer.session.session import Session
from viewer.session.view_state import Request


def draw(session: Session, canvas: Canvas) -> None:
    assert session.lesson  # otherwise there is no such panel
    for block in session.lesson.text.split("\n\n"):
        content = _plain(block)
        imgui.push_text_wrap_pos(0.0)
        if block.startswith("#"):
            imgui.text_colored(session.appearance.theme.accent, content.lstrip("# "))
        elif block.startswith("- "):
            for item in block.split("\n- "):
                imgui.bullet()
                imgui.same_line()
                imgui.text(_plain(item.removeprefix("- ")))  # it wraps, unlike bullet_text
        else:
            imgui.text(content)
        imgui.pop_text_wrap_pos()
        imgui.spacing()


def _plain(markdown: str) -> str:
    """A paragraph on one line, without the marks of code."""
    return printable(" ".join(markdown.split())).replace("`", "")


PANEL = Panel("Lesson", draw, request=Request.SHOW_LESSON, exists=lambda session: session.lesson is not None)
