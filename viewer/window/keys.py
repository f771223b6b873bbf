"""Keys. Letters and digits go by the character they write, so that they are where they stand on any keyboard."""

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.session.session import Session
from viewer.session.view_state import Request

HELP = (
    ("click, drag", "on the image: show the rays of a pixel"),
    ("arrow keys", "move the picked pixel (with Shift by 10)"),
    ("wheel, right-drag", "on the image: enlarge, move"),
    ("0 1 2 3 ... 9", "recursion depth"),
    ("+  -", "one deeper, one less"),
    ("click", "on a ray, in 3D or in the tree: select it"),
    ("Page Down, Page Up", "select the next ray, the one before"),
    ("drag", "in the scene: turn; with Shift or the right button: move"),
    ("wheel", "in the scene, on the tree: nearer and farther"),
    ("F", "the 3D view as it was at first"),
    ("V", "look through the scene's camera"),
    ("C  L  N  B", "camera, lights, normals, names: show or hide"),
    ("M", "Whitted's model or Fresnel's"),
    ("R", "refine the image, pause"),
    ("T", "light or dark theme"),
    ("Tab", "lecture size: everything larger"),
    ("Esc", "select nothing, pick nothing"),
    ("F5", "read the scene's file again (it is, when it is saved)"),
    ("Ctrl+S", "export what is on show as a figure (menu Figure: which, and how)"),
    ("Ctrl+C", "copy that figure: a picture to paste onto a slide; with Shift its command line"),
    ("Ctrl+O, Ctrl+Q", "open a scene; quit"),
    ("H or ?", "this help"),
)


def handle(session: Session) -> None:
    """Act on what was typed since the last frame, unless it goes into a text field."""
    io = imgui.get_io()
    key = imgui.Key
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
        if imgui.is_key_pressed(key.escape, False):
            internal.close_popup_to_level(0, True)
        return
    if io.want_text_input:
        return
    if io.key_ctrl or io.key_super or _just_let_go(key.left_ctrl, key.right_ctrl, key.left_super, key.right_super):
        if imgui.is_key_pressed(key.q, False):
            session.requests.append(Request.QUIT)
        if imgui.is_key_pressed(key.o, False):
            session.requests.append(Request.OPEN_DIALOG)
        if imgui.is_key_pressed(key.s, False):
            session.export_figure()
        if imgui.is_key_pressed(key.c, False):
            if io.key_shift or _just_let_go(key.left_shift, key.right_shift):
                session.copy_command()
            else:
                session.export_figure(copied=True)
        return
    _typed(session)
    step = 10 if io.key_shift else 1
    for arrow, dx, dy in (
        (key.left_arrow, -1, 0),
        (key.right_arrow, 1, 0),
        (key.up_arrow, 0, -1),
        (key.down_arrow, 0, 1),
    ):
        if imgui.is_key_pressed(arrow):
            session.nudge(step * dx, step * dy)
    if imgui.is_key_pressed(key.page_down):
        session.step(1)
    if imgui.is_key_pressed(key.page_up):
        session.step(-1)
    if imgui.is_key_pressed(key.tab, False):
        session.toggle_lecture_size()
    if imgui.is_key_pressed(key.escape, False):
        if session.shows_help:
            session.shows_help = False
        elif session.faults:
            session.faults = []
        else:
            session.clear()
    if imgui.is_key_pressed(key.f5, False):
        session.loader.reload()


def _just_let_go(*keys: imgui.Key) -> bool:
    """Of a chord typed fast the modifier may come up in the very frame in which the letter goes down."""
    return any(imgui.is_key_released(key) for key in keys)


def _typed(session: Session) -> None:
    shown = session.shown
    characters = imgui.get_io().input_queue_characters
    for k in range(characters.size()):
        typed = chr(characters[k]).lower()
        match typed:
            case _ if typed.isdecimal() and typed.isascii():
                session.set_depth(int(typed))
            case "+" | "=":
                session.set_depth(session.depth + 1)
            case "-":
                session.set_depth(session.depth - 1)
            case "f":
                session.home()
            case "v":
                session.through_camera()
            case "c":
                shown.camera = not shown.camera
            case "l":
                shown.lights = not shown.lights
            case "n":
                shown.normals = not shown.normals
            case "b":
                shown.labels = not shown.labels
            case "m":
                session.toggle_model()
            case "r":
                session.toggle_refinement()
            case "t":
                session.toggle_theme()
            case "h" | "?":
                session.shows_help = not session.shows_help
