"""The menu, the window of faults, the help, and the dialog that opens another scene."""

from pathlib import Path

from imgui_bundle import imgui

from tracer.formats import READERS
from viewer.base.files import Unusable
from viewer.base.theme import THEMES
from viewer.lessons import lesson as lessons
from viewer.panels import draw as d
from viewer.session.figure_export import FIGURES, FORMATS
from viewer.session.session import Session
from viewer.window import keys

OPEN = "Open a scene"


def draw(session: Session) -> bool:
    """The menu bar; whether the window's layout is to be put back."""
    reset = False
    wants_open = False
    if imgui.begin_main_menu_bar():
        if imgui.begin_menu("File"):
            wants_open = imgui.menu_item_simple("Open ...", "Ctrl+O")
            if imgui.menu_item_simple("Read again", "F5", False, session.attempt is not None):
                session.reload()
            imgui.separator()
            if imgui.menu_item_simple("Save the image as PNG", "", False, session.world is not None):
                save_image(session)
            imgui.separator()
            if imgui.menu_item_simple("Quit", "Ctrl+Q"):
                session.wants_quit = True
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
    if wants_open or session.wants_open:
        session.wants_open = False
        imgui.open_popup(OPEN)
    _open_dialog(session)
    _faults(session)
    _help(session)
    return reset


def open_lesson(session: Session, name: str) -> None:
    try:
        lesson = lessons.read(name)
    except Unusable as unusable:
        session.faults = list(unusable.faults)
        return
    session.open(lesson.scene, lesson)


def open_file(session: Session, path: Path) -> None:
    """A scene's file, from the dialog or dropped on the window."""
    session.open(path)


def save_image(session: Session) -> None:
    """The image on show, beside where the program was started, under a name that is not taken."""
    from viewer.base.pictures import write_picture

    picture = session.image.picture
    if not picture or not session.path:
        return
    name = session.lesson.name if session.lesson else session.path.stem
    path = next(path for k in range(1, 10**6) if not (path := Path(f"{name}-{k}.png")).exists())
    try:
        write_picture(path, picture.shown[..., :3])
        session.notice.say(f"wrote {path.resolve()}" + ("" if picture.finished else " (not finished yet)"))
    except Unusable as unusable:
        session.faults = list(unusable.faults)


def _figure_menu(session: Session) -> None:
    """What Ctrl+S writes, as last chosen."""
    home = session.takehome
    if imgui.menu_item_simple("Export", "Ctrl+S", False, session.tree is not None):
        home.make(session)
    if imgui.menu_item_simple("Copy", "Ctrl+C", False, session.tree is not None):
        home.make(session, copied=True)
    if imgui.menu_item_simple("Copy its command line", "Ctrl+Shift+C", False, bool(home.command)):
        home.copy_command(session)
    imgui.separator()
    for name, label in FIGURES.items():
        if imgui.menu_item_simple(label, "", home.figure == name):
            home.figure = name
    imgui.separator()
    for name, label in FORMATS.items():
        if imgui.menu_item_simple(label, "", home.format == name):
            home.format = name
    imgui.separator()
    for name, label in {"": "The window's theme", **{name: f"{name.capitalize()} theme" for name in THEMES}}.items():
        if imgui.menu_item_simple(label, "", home.theme == name):
            home.theme = name


def _lesson_item(session: Session, name: str) -> None:
    try:
        title = lessons.read(name).title
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
    if imgui.menu_item_simple("As it was at first", "F"):
        session.home()
    if imgui.menu_item_simple("Through the scene's camera", "V"):
        session.through_camera()
    imgui.separator()
    if imgui.menu_item_simple("Light theme", "T", not session.theme.dark):
        session.toggle_theme()
    if imgui.menu_item_simple("Lecture size", "Tab", session.is_lecture_size):
        session.toggle_lecture_size()
    imgui.separator()
    return imgui.menu_item_simple("Panels back in place")


def _title(session: Session) -> None:
    """The scene's title at the right end of the menu, or the last notice."""
    if session.notice.text:
        content = session.notice.text
    elif session.world:
        content = session.world.scene.title or (session.path.name if session.path else "")
    else:
        return
    width, _ = d.text_size(content, imgui.get_font_size())
    place = imgui.get_window_width() - width - 14 * d.unit()
    if place > imgui.get_cursor_pos_x():
        imgui.set_cursor_pos_x(place)
        imgui.text_colored(session.theme.muted, content)


def _faults(session: Session) -> None:
    """What is wrong with the file, in the words of the command line; the last good scene stays on show."""
    if not session.faults:
        return
    unit = d.unit()
    room = imgui.get_main_viewport()
    width = min(860 * unit, 0.9 * room.work_size.x)
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size_constraints((width, 0), (width, 0.8 * room.work_size.y))
    imgui.push_style_color(imgui.Col_.window_bg, session.theme.raised)
    imgui.push_style_color(imgui.Col_.border, session.theme.fault)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 1.5 * unit)
    flags = imgui.WindowFlags_
    opened, stays = imgui.begin(
        "This cannot be shown",
        True,
        flags.no_docking | flags.no_collapse | flags.no_saved_settings | flags.no_move | flags.always_auto_resize,
    )
    if opened:
        count = len(session.faults)
        said = "1 fault" if count == 1 else f"{count} faults"
        kept = "; the last good scene stays" if session.world else ""
        is_there = session.attempt is not None and session.attempt[0].is_file()
        again = " Save the file and it is read again." if is_there else ""
        imgui.push_text_wrap_pos(width - 20 * unit)
        imgui.text_colored(session.theme.fault, f"{said}{kept}.{again}")
        imgui.pop_text_wrap_pos()
        imgui.separator()
        imgui.push_text_wrap_pos(width - 20 * unit)
        for fault in session.faults:
            imgui.text(_short_path(fault) if is_there else fault)
        imgui.pop_text_wrap_pos()
    imgui.end()
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    if not stays:
        session.faults = []


def _short_path(fault: str) -> str:
    """The file's name is enough in the window, where it is known which file it is."""
    path, colon, rest = fault.partition(": ")
    return f"{Path(path).name}{colon}{rest}"


def _open_dialog(session: Session) -> None:
    """Folders and scenes to choose from, or a path to be typed."""
    unit = d.unit()
    imgui.set_next_window_size((620 * unit, 460 * unit), imgui.Cond_.appearing)
    imgui.push_style_color(imgui.Col_.popup_bg, session.theme.panel)  # its fields and buttons stand out from it
    opened, _ = imgui.begin_popup_modal(OPEN, True, imgui.WindowFlags_.no_saved_settings)
    imgui.pop_style_color()
    if not opened:
        return
    if session.folder is None:
        session.folder = session.path.resolve().parent if session.path and not session.lesson else Path.cwd()
    imgui.set_next_item_width(-1)
    if imgui.is_window_appearing():
        session.not_found = ""
        imgui.set_keyboard_focus_here()
    elif session.not_found and not imgui.is_any_item_active():
        imgui.set_keyboard_focus_here()  # what was typed stays, to be mended
    shown = session.not_found or str(session.folder)
    entered, written = imgui.input_text("##path", shown, imgui.InputTextFlags_.enter_returns_true)
    if entered:
        _go(session, session.folder / Path(written.strip()).expanduser())
    if session.not_found:
        imgui.text_colored(session.theme.fault, "not found")
    if imgui.begin_child("files", (0, -imgui.get_frame_height_with_spacing())):
        if imgui.selectable("..", False)[0]:
            _go(session, session.folder.parent)
        for path in _entries(session.folder):
            if imgui.selectable(f"{path.name}/" if path.is_dir() else path.name, False)[0]:
                _go(session, path)
    imgui.end_child()
    if imgui.button("Cancel") or imgui.is_key_pressed(imgui.Key.escape):
        imgui.close_current_popup()
    imgui.end_popup()


def _go(session: Session, path: Path) -> None:
    session.not_found = "" if path.exists() else str(path)
    if path.is_dir():
        session.folder = path
    elif path.exists():
        imgui.close_current_popup()
        open_file(session, path)


def _entries(folder: Path) -> list[Path]:
    """Folders, then scenes; nothing hidden."""
    try:
        found = [path for path in folder.iterdir() if not path.name.startswith(".")]
    except OSError:
        return []
    folders = sorted(path for path in found if path.is_dir())
    return folders + sorted(path for path in found if path.suffix.lower() in READERS and not path.is_dir())


def _help(session: Session) -> None:
    if not session.shows_help:
        return
    room = imgui.get_main_viewport()
    middle = (room.work_pos.x + 0.5 * room.work_size.x, room.work_pos.y + 0.5 * room.work_size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.appearing, (0.5, 0.5))
    flags = imgui.WindowFlags_
    imgui.push_style_color(imgui.Col_.window_bg, session.theme.raised)
    opened, stays = imgui.begin(
        "Keys and mouse",
        True,
        flags.no_docking | flags.always_auto_resize | flags.no_collapse | flags.no_saved_settings,
    )
    if opened and imgui.begin_table("keys", 2, imgui.TableFlags_.sizing_fixed_fit):
        for key, meaning in keys.HELP:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_colored(session.theme.accent, key)
            imgui.table_next_column()
            imgui.text(meaning)
        imgui.end_table()
    imgui.end()
    imgui.pop_style_color()
    session.shows_help = bool(stays)
