"""Runs the actions of keys (`viewer.window.bindings`).

Letters and digits go by the character that they write, so that they are where they are printed on any keyboard. If the
keyboard's layout writes no character that is bound, like Russian letters, they go by their place on a US keyboard.
"""

from collections.abc import Mapping

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.session.session import Session
from viewer.window.bindings import BINDINGS, TYPED, Act, just_released

K = imgui.Key
CTRL = (K.left_ctrl, K.right_ctrl, K.left_super, K.right_super)
ALT = (K.left_alt, K.right_alt)
LEAVING = (
    K.page_down,
    K.page_up,
    K.up_arrow,
    K.down_arrow,
    K.tab,
    K.f5,
    K.f11,
)  # keys that a field for numbers has no use for
EDITING = (K.a, K.c, K.v, K.x, K.z, K.y)  # with Ctrl, they edit the text in a field
US_KEYS = {getattr(K, letter): letter for letter in "abcdefghijklmnopqrstuvwxyz"} | {
    **{getattr(K, f"_{digit}"): str(digit) for digit in range(10)},
    K.minus: "-", K.equal: "=", K.period: ".", K.slash: "/",
}  # fmt: skip


def handle(session: Session) -> None:
    """Run the actions of the keys pressed since the last frame, unless a text field has the focus."""
    io = imgui.get_io()
    _own_tab()
    if session.is_blank:
        session.is_blank = not _is_anything_pressed()
        return
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
        if imgui.is_key_pressed(K.escape, False):
            internal.close_popup_to_level(0, True)
        return
    if io.want_text_input:
        if not _leaves_field(io):
            return
        internal.clear_active_id()
    if io.key_ctrl or io.key_super or just_released(CTRL):
        acted = _press([binding.ctrl for binding in BINDINGS], session, repeat=False)
        if acted or io.key_ctrl or io.key_super:
            return
    if io.key_alt or just_released(ALT):
        acted = _press([binding.alt for binding in BINDINGS], session, repeat=False)
        if acted or io.key_alt:
            return
    for character in _typed(io):
        TYPED[character](session)
    _press([binding.repeated for binding in BINDINGS], session, repeat=True)
    _press([binding.pressed for binding in BINDINGS], session, repeat=False)


def _leaves_field(io: imgui.IO) -> bool:
    """Whether a key was pressed that the field for a pixel's coordinate has no use for: it acts as everywhere."""
    if io.key_ctrl or io.key_super:
        bound = {key for binding in BINDINGS for key in binding.ctrl}
        return any(imgui.is_key_pressed(key, False) for key in bound.difference(EDITING))
    letters = any(not chr(character).isdigit() for character in io.input_queue_characters)
    return letters or io.key_alt or any(imgui.is_key_pressed(key, True) for key in LEAVING)


def _own_tab() -> None:
    """Take the Tab key from imgui, which would move the keyboard into a text field."""
    internal.set_key_owner(K.tab, imgui.get_id("keys"))


def _is_anything_pressed() -> bool:
    """Whether a key or a button of the mouse went down."""
    return any(imgui.is_key_pressed(K(key), False) for key in range(K.named_key_begin, K.named_key_end))


def _typed(io: imgui.IO) -> list[str]:
    """The bound characters that were typed since the last frame, or those of the US layout in their places."""
    written = [chr(character).lower() for character in io.input_queue_characters]
    bound = [character for character in written if character in TYPED]
    if bound or not written:
        return bound
    # With Shift, only letters: a sign above a digit is not that digit.
    allowed = [key for key, us in US_KEYS.items() if us.isalpha() or not io.key_shift]
    keys = [key for key in allowed if US_KEYS[key] in TYPED]
    pressed = [key for key in keys if imgui.is_key_pressed(key, True)]
    # Typed fast, a character may come one frame later than its key.
    return [US_KEYS[key] for key in pressed or [key for key in keys if imgui.is_key_down(key)]]


def _press(groups: list[Mapping[imgui.Key, Act]], session: Session, repeat: bool) -> bool:
    """Run the actions of the keys that are pressed. Returns whether there were any."""
    acted = False
    for group in groups:
        for key, act in group.items():
            if imgui.is_key_pressed(key, repeat):
                act(session)
                acted = True
    return acted
