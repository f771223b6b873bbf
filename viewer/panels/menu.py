"""The menu bar."""

from pathlib import Path

from imgui_bundle import imgui

from tracer.printable import printable
from viewer.base.files import Unusable
from viewer.base.pictures import write_picture
from viewer.base.theme import THEMES
from viewer.figures.catalogue import FIGURES, FORMATS, PICTURES
from viewer.lessons import lesson as lessons
from viewer.panels import draw as d
from viewer.session.figure_export import free_path
from viewer.session.session import Session
from viewer.session.view_state import Request


def draw(session: Session) -> bool:
    """Draw the menu bar. Returns whether the panels are to be put back in place."""
    reset = False
    if imgui.begin_main_menu_bar():
        if imgui.begin_menu("File"):
            if imgui.menu_item_simple("Open ...", "Ctrl+O"):
                session.requests.append(Request.OPEN_DIALOG)
            if imgui.menu_item_simple("Reload", "F5", False, session.loader.opening is not None):
                session.loader.reload()
            imgui.separator()
            if imgui.menu_item_simple("Save the image as PNG", "", False, session.world is not None):
                save_image(session)
            imgui.separator()
            if imgui.menu_item_simple("Quit", "Ctrl+Q"):
                session.requests.append(Request.QUIT)
            imgui.end_menu()
        if imgui.begin_menu("Figure"):
            _figure_menu(session)
            imgui.end_menu()
        if imgui.begin_menu("Lessons"):
            for name in lessons.names():
                _lesson_item(session, name)
            imgui.end_menu()
        if imgui.begin_menu("View"):
            reset = _view_menu(session)
            imgui.end_menu()
        if imgui.begin_menu("Help"):
            if imgui.menu_item_simple("Keys and mouse", "H"):
                session.shows_help = True
            imgui.end_menu()
        _title(session)
        imgui.end_main_menu_bar()
    return reset


def open_lesson(session: Session, name: str) -> None:
    try:
        lesson = lessons.read(name)
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))
        return
    session.loader.open(lesson.scene, lesson)


def save_image(session: Session) -> None:
    """Write the image on show into the current folder, under a name that does not exist."""
    picture = session.image.picture
    if not picture or not session.path:
        return
    name = session.lesson.name if session.lesson else session.path.stem
    path = free_path(Path(f"{name}.png"))
    try:
        write_picture(path, picture.shown[..., :3])
        session.notice.say(f"wrote {path.resolve()}" + ("" if picture.finished else " (not finished yet)"))
    except Unusable as unusable:
        session.show_faults(list(unusable.faults))


def _figure_menu(session: Session) -> None:
    """The figure that Ctrl+S writes, as last chosen."""
    export = session.export
    if imgui.menu_item_simple("Export", "Ctrl+S", False, session.tree is not None):
        session.export_figure()
    if imgui.menu_item_simple("Copy", "Ctrl+C", False, session.tree is not None):
        session.export_figure(copied=True)
    if imgui.menu_item_simple("Copy its command line", "Ctrl+Shift+C", False, bool(export.command)):
        session.copy_command()
    imgui.separator()
    for kind in FIGURES:
        if imgui.menu_item_simple(kind.title, "", export.figure == kind.name):
            export.figure = kind.name
    imgui.separator()
    for name in PICTURES:
        if imgui.menu_item_simple(FORMATS[name].title, "", export.format == name):
            export.format = name
    imgui.separator()
    for name, label in {"": "The window's theme", **{name: f"{name.capitalize()} theme" for name in THEMES}}.items():
        if imgui.menu_item_simple(label, "", export.theme == name):
            export.theme = name


def _lesson_item(session: Session, name: str) -> None:
    try:
        title = printable(lessons.read(name).title)
    except Unusable:
        title = name
    on = session.lesson is not None and session.lesson.name == name
    if imgui.menu_item_simple(title, "", on):
        open_lesson(session, name)


def _view_menu(session: Session) -> bool:
    shown = session.shown
    for field, label, key in (
        ("camera", "Camera and its image", "C"),
        ("lights", "Lights", "L"),
        ("normals", "Normals", "N"),
        ("labels", "Names", "B"),
    ):
        if imgui.menu_item_simple(label, key, getattr(shown, field)):
            setattr(shown, field, not getattr(shown, field))
    imgui.separator()
    if imgui.menu_item_simple("Reset", "F"):
        session.home()
    if imgui.menu_item_simple("Through the scene's camera", "V"):
        session.through_camera()
    imgui.separator()
    if imgui.menu_item_simple("Light theme", "T", not session.appearance.theme.dark):
        session.appearance.toggle_theme()
    if imgui.menu_item_simple("Lecture size", "Tab", session.appearance.is_lecture_size):
        session.appearance.toggle_lecture_size()
    imgui.separator()
    return imgui.menu_item_simple("Reset the panels")


def _title(session: Session) -> None:
    """The notice, or the scene's title, at the right end of the bar."""
    if session.notice.text:
        content = session.notice.text
    elif session.world:
        content = session.world.scene.caption
    else:
        return
    width, _ = d.text_size(content, imgui.get_font_size())
    place = imgui.get_window_width() - width - 14 * d.unit()
    if place > imgui.get_cursor_pos_x():
        imgui.set_cursor_pos_x(place)
        imgui.text_colored(session.appearance.theme.muted, content)
