"""The choice of a sample of the picked pixel, beside the pixel's coordinates."""

from imgui_bundle import imgui

from viewer.panels import draw as d
from viewer.session.actions import step_sample
from viewer.session.session import Session

GAP = 4.0  # logical pixels


def draw_control(session: Session) -> None:
    """The number of the chosen sample between two buttons; nothing if the pixel's centre is the only sample."""
    tree = session.tree
    if not tree or tree.sample is None:
        return
    gap = GAP * d.unit()
    if imgui.button("<##sample"):
        step_sample(session, -1)
    d.hint("the sample before (Shift+S)")
    imgui.same_line(0.0, gap)
    # As wide as for the last sample: nothing moves from sample to sample.
    left, widest = imgui.get_cursor_pos_x(), imgui.calc_text_size(f"sample {tree.samples - 1} of {tree.samples}").x
    imgui.text(tree.sample_text)
    d.hint(f"the rays on show are those of this sample; they are numbered from 0 to {tree.samples - 1}")
    imgui.same_line(left + widest, gap)
    if imgui.button(">##sample"):
        step_sample(session, 1)
    d.hint("the next sample (S)")
    imgui.same_line(0.0, 10.0 * d.unit())
