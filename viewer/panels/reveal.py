"""The controls of the steps: granularity and order, the position, and the animation."""

from collections.abc import Callable

from imgui_bundle import imgui

from viewer.figures.catalogue import ORDERS
from viewer.panels import draw as d
from viewer.session.actions import change_speed
from viewer.session.session import Session
from viewer.session.stepping.reveal import GRANULARITIES, ORDER_WORDS

GRANULARITY_WORDS = {
    name: f"one step per {name[:-1]}, then one per hit as the colour is summed up" for name in GRANULARITIES
}
ORDER_LABELS: dict[str, str] = dict(zip(ORDERS, ("Breadth-first", "Depth-first"), strict=True))
GAP, WIDE_GAP = 3.0, 14.0  # logical pixels, within a group of buttons and between groups


def draw_controls(session: Session) -> None:
    """A row of buttons; more than one row if the panel is narrow."""
    reveal = session.reveal
    row = _Row()
    for name in GRANULARITIES:
        if row.toggle(session, name.capitalize(), reveal.granularity == name, f"{GRANULARITY_WORDS[name]} (key G)"):
            reveal.set_granularity(name)
    row.gap()
    for name, label in ORDER_LABELS.items():
        on = reveal.order == name
        if row.toggle(session, label, on, f"{ORDER_WORDS[name]} (key O)"):
            reveal.set_order(name)
    row.gap()
    for label, hint, act in _buttons(session):
        if row.button(label, hint):
            act()
    row.text(session, position_text(session))
    row.gap()
    if row.button("−", "slower (key <)"):
        change_speed(session, -1)
    row.text(session, f"{reveal.speed:g}/s")
    if row.button("+", "faster (key >)"):
        change_speed(session, 1)
    if row.toggle(session, "Loop", reveal.loops, "play endlessly (key E)"):
        reveal.toggle_loop()
    if reveal.place and row.button("All", "show the whole tree (Esc)"):
        reveal.leave()


def draw_position(session: Session, room: float) -> None:
    """The controls beside the title of the tree, in its line: no step changes the height of the panel. In lecture mode,
    where a remote goes from step to step, only the position.
    """
    reveal = session.reveal
    if not session.appearance.is_lecture_size:
        for label, hint, act in _buttons(session):
            if imgui.small_button(label):
                act()
            d.hint(hint)
            imgui.same_line(0.0, GAP * d.unit())
    position = position_text(session)
    words = f"{position}  {ORDER_LABELS[reveal.order].lower()}"
    fits = imgui.calc_text_size(words).x <= room - imgui.get_cursor_pos_x()
    imgui.text_colored(session.appearance.theme.muted, words if fits else position)


def position_text(session: Session) -> str:
    """The number of the current step; the number of steps if the whole tree is on show."""
    steps, position = session.reveal.steps, session.reveal.position
    if not steps or position is None:
        return f"{len(steps or ())} steps"
    return f"{position + 1}/{len(steps)}"


def _buttons(session: Session) -> tuple[tuple[str, str, Callable[[], object]], ...]:
    """(label, hint, action) of the buttons that go through the steps."""
    reveal = session.reveal
    play = "Pause" if reveal.is_playing else "Play"
    return (
        ("|<", "first step (Home)", reveal.first),
        ("<", "the step before (Page Up)", lambda: reveal.go(-1)),
        (play, f"{play.lower()} (Space, F5)", reveal.toggle_play),
        (">", "next step (Page Down)", lambda: reveal.go(1)),
        (">|", "last step (End)", reveal.last),
    )


class _Row:
    """Items side by side; one that does not fit begins a new line."""

    def __init__(self) -> None:
        self.right = imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        self.begins, self.space = True, 0.0

    def gap(self) -> None:
        self.space = WIDE_GAP * d.unit()

    def button(self, label: str, hint: str) -> bool:
        self._place(label, 2.0 * imgui.get_style().frame_padding.x)
        pressed = imgui.button(label)
        d.hint(hint)
        return pressed

    def toggle(self, session: Session, label: str, on: bool, hint: str) -> bool:
        self._place(label, 2.0 * imgui.get_style().frame_padding.x)
        pressed = d.toggle(session.appearance.theme, label, on)
        d.hint(hint)
        return pressed

    def text(self, session: Session, content: str) -> None:
        self._place(content, 0.0)
        imgui.align_text_to_frame_padding()
        imgui.text_colored(session.appearance.theme.muted, content)

    def _place(self, label: str, padding: float) -> None:
        wide = imgui.calc_text_size(label).x + padding
        space, self.space = self.space or GAP * d.unit(), 0.0
        if not self.begins and imgui.get_item_rect_max().x + space + wide <= self.right:
            imgui.same_line(0.0, space)
        self.begins = False
