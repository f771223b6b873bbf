"""The menu bar."""

from collections.abc import Callable

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.base.theme import THEMES
from viewer.figures.catalogue import FIGURES, FORMATS, ORDERS, PICTURES
from viewer.panels import PANELS
from viewer.session.actions import go, look_through_camera
from viewer.session.figure_export import SHOWN
from viewer.session.saving import copy_command, copy_step, export_figure, save_image, save_scene
from viewer.session.session import Session
from viewer.session.stepping.reveal import GRANULARITIES, ORDER_WORDS
from viewer.session.view_state import Pointer, Request
from viewer.window import lesson_menu
from viewer.window.bindings import PANEL_KEYS


def draw(session: Session) -> None:
    if session.appearance.is_lecture_size and not _is_called():
        return
    if imgui.begin_main_menu_bar():
        for title, draw_menu in MENUS.items():
            if imgui.begin_menu(title):
                draw_menu(session)
                imgui.end_menu()
        imgui.end_main_menu_bar()


EDGE = 3.0  # pixels at the top of the window, where the mouse calls the menu in lecture mode


def _is_called() -> bool:
    """Whether the mouse is at the top of the window, or a menu is open. Otherwise there is no menu in lecture mode."""
    room, mouse = imgui.get_main_viewport(), imgui.get_mouse_pos()
    bar = internal.find_window_by_name("##MainMenuBar")
    is_on_show = bar is not None and bar.was_active  # in the frame before
    reach = imgui.get_frame_height() if is_on_show else EDGE
    at_top = imgui.is_mouse_pos_valid() and 0.0 <= mouse.y - room.pos.y < reach
    return at_top or imgui.is_popup_open("", imgui.PopupFlags_.any_popup_id | imgui.PopupFlags_.any_popup_level)


def _file_menu(session: Session) -> None:
    if imgui.menu_item_simple("Open ...", "Ctrl+O"):
        session.requests.append(Request.OPEN_DIALOG)
    if imgui.menu_item_simple("Reload", "Ctrl+R", False, session.loader.opening is not None):
        session.loader.reload()
    imgui.separator()
    if imgui.menu_item_simple("Save the image as PNG", "", False, session.world is not None):
        save_image(session)
    is_copy = session.opening is not None and session.opening.figure is not None
    if imgui.menu_item_simple("Save the figure's scene", "", False, is_copy):
        save_scene(session)
    if imgui.menu_item_simple("Copy the command line of this view", "Ctrl+L", False, session.world is not None):
        session.requests.append(Request.COPY_VIEW)
    if imgui.menu_item_simple("Copy this view as a step of a lesson", "Ctrl+Shift+L", False, session.world is not None):
        copy_step(session)
    imgui.separator()
    if imgui.menu_item_simple("Quit", "Ctrl+Q"):
        session.requests.append(Request.QUIT)


def _figure_menu(session: Session) -> None:
    """The figure that Ctrl+S writes, as last chosen."""
    export = session.export
    if imgui.menu_item_simple("Export", "Ctrl+S", False, session.tree is not None):
        export_figure(session)
    if imgui.menu_item_simple("Copy", "Ctrl+C", False, session.tree is not None):
        export_figure(session, copied=True)
    if imgui.menu_item_simple("Copy its command line", "Ctrl+Shift+C", False, bool(export.command)):
        copy_command(session)
    imgui.separator()
    if imgui.menu_item_simple("The panel under the mouse", "", export.figure == SHOWN):
        export.figure = SHOWN
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


def _view_menu(session: Session) -> None:
    shown = session.shown
    for field, label, key in (
        ("camera", "Camera and its image", "C"),
        ("lights", "Lights", "L"),
        ("normals", "Normals", "N"),
        ("labels", "Names", "A"),
    ):
        if imgui.menu_item_simple(label, key, getattr(shown, field)):
            setattr(shown, field, not getattr(shown, field))
    imgui.separator()
    if imgui.menu_item_simple("Back", "Alt+Left"):
        go(session, -1)
    if imgui.menu_item_simple("Forward", "Alt+Right"):
        go(session, 1)
    if imgui.menu_item_simple("Fit", "F"):
        session.home()
    if imgui.menu_item_simple("Through the scene's camera", "V"):
        look_through_camera(session)
    imgui.separator()
    if imgui.begin_menu("All of the room"):
        for key, panel in zip(PANEL_KEYS, PANELS, strict=False):
            if imgui.menu_item_simple(panel.title, str(key.name).upper(), session.layout.maximised == panel.name):
                session.layout.maximise(panel.name)
        imgui.end_menu()
    if imgui.begin_menu("Steps of the tree"):
        _steps_menu(session)
        imgui.end_menu()
    imgui.separator()
    if imgui.menu_item_simple("Light theme", "T", not session.appearance.theme.dark):
        session.appearance.toggle_theme()
    if imgui.menu_item_simple("Lecture size", "Tab", session.appearance.is_lecture_size):
        session.appearance.toggle_lecture_size()
    if imgui.menu_item_simple("Full screen", "F11"):
        session.requests.append(Request.FULL_SCREEN)
    if imgui.menu_item_simple("Speaker's window", "W"):
        session.requests.append(Request.SPEAKER)
    if imgui.menu_item_simple("Black screen", "B"):
        session.is_blank = True
    if imgui.menu_item_simple("Pointer, spotlight", "X", session.pointer is not Pointer.NONE):
        session.pointer = session.pointer.next()
    imgui.separator()
    if imgui.menu_item_simple("Reset the panels"):
        session.layout.reset()
        session.guard.open_all()


def _steps_menu(session: Session) -> None:
    reveal = session.reveal
    for label, key, act in (
        ("Next", "Page Down", lambda: reveal.go(1)),
        ("Back", "Page Up", lambda: reveal.go(-1)),
        ("Play, pause", "F5", reveal.toggle_play),
        ("Loop", "E", reveal.toggle_loop),
        ("Whole tree", "Esc", reveal.leave),
    ):
        if imgui.menu_item_simple(label, key, label == "Loop" and reveal.loops):
            act()
    imgui.separator()
    for name in GRANULARITIES:
        if imgui.menu_item_simple(f"By {name}", "G", reveal.granularity == name):
            reveal.set_granularity(name)
    for name in ORDERS:
        if imgui.menu_item_simple(ORDER_WORDS[name], "O", reveal.order == name):
            reveal.set_order(name)


def _help_menu(session: Session) -> None:
    if imgui.menu_item_simple("Keys and mouse", "H"):
        session.shows_help = True


MENUS: dict[str, Callable[[Session], None]] = {
    "File": _file_menu,
    "Figure": _figure_menu,
    "Lessons": lesson_menu.draw,
    "View": _view_menu,
    "Help": _help_menu,
}
