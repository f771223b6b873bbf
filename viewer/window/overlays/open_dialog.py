"""The dialog that opens a scene: folders and scenes to choose from, and a field for a path."""

from pathlib import Path

from imgui_bundle import imgui

from tracer.formats import MESH_READERS, READERS, UP_AXES
from tracer.printable import shown_path
from viewer.lessons import lesson as lessons
from viewer.panels import draw as d
from viewer.reopen.places import is_figure
from viewer.reopen.view_state import ViewState
from viewer.session.actions import open_lesson
from viewer.session.session import Session

TITLE = "Open a scene"


def open_dialog() -> None:
    """Show the dialog from the next frame on."""
    imgui.open_popup(TITLE)


def draw(session: Session) -> None:
    unit, dialog = d.unit(), session.dialog
    imgui.set_next_window_size((620 * unit, 460 * unit), imgui.Cond_.appearing)
    imgui.push_style_color(
        imgui.Col_.popup_bg, session.appearance.theme.panel
    )  # lighter fields and buttons stand out from it
    opened, _ = imgui.begin_popup_modal(TITLE, True, imgui.WindowFlags_.no_saved_settings)
    imgui.pop_style_color()
    if not opened:
        return
    if dialog.folder is None:
        dialog.folder = session.path.resolve().parent if session.path and not session.lesson else Path.cwd()
    imgui.set_next_item_width(-1)
    if imgui.is_window_appearing():
        dialog.not_found = ""
        imgui.set_keyboard_focus_here()
    elif not imgui.is_any_item_active():
        imgui.set_keyboard_focus_here()  # a typed path stays, to be corrected
    shown = shown_path(dialog.not_found or dialog.folder)
    entered, written = imgui.input_text("##path", shown, imgui.InputTextFlags_.enter_returns_true)
    if entered and written.strip() in lessons.names():
        imgui.close_current_popup()
        open_lesson(session, written.strip())
    elif entered:
        _go(session, dialog.folder / Path(written.strip()).expanduser())
    if dialog.not_found:
        imgui.text_colored(session.appearance.theme.fault, "not found")
    if imgui.begin_child("files", (0, -imgui.get_frame_height_with_spacing())):
        if imgui.selectable("..", False)[0]:
            _go(session, dialog.folder.parent)
        for path in _entries(dialog.folder):
            if imgui.selectable(shown_path(f"{path.name}/" if path.is_dir() else path.name), False)[0]:
                _go(session, path)
    imgui.end_child()
    _, dialog.z_up = imgui.checkbox("z axis up (mesh files)", dialog.z_up)
    imgui.same_line()
    if imgui.button("Cancel") or imgui.is_key_pressed(imgui.Key.escape):
        imgui.close_current_popup()
    imgui.end_popup()


def _go(session: Session, path: Path) -> None:
    dialog = session.dialog
    dialog.not_found = "" if path.exists() else str(path)
    if path.is_dir():
        dialog.folder = path
    elif path.exists():
        imgui.close_current_popup()
        is_mesh = path.suffix.lower() in MESH_READERS
        session.loader.open(path, state=ViewState(up=UP_AXES[is_mesh and dialog.z_up]))


def _entries(folder: Path) -> list[Path]:
    """The folders, then the scenes and figures. Hidden files are left out."""
    try:
        found = [path for path in folder.iterdir() if not path.name.startswith(".")]
    except OSError:
        return []
    folders = sorted(path for path in found if path.is_dir())
    scenes = (path for path in found if path.suffix.lower() in READERS or is_figure(path))
    return folders + sorted(path for path in scenes if not path.is_dir())
