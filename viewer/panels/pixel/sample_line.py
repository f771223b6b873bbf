"""The line above the image where a pixel has several samples: the chosen one, with its colour."""

from imgui_bundle import imgui

from viewer.panels import draw as d
from viewer.panels.pixel.colors import draw_shades, tree_shade
from viewer.session.actions import step_sample
from viewer.session.session import Session

MARGIN = 12.0  # logical pixels at the left and at the right, as in the line of titles
GAP = 4.0  # between the buttons


def has_line(session: Session) -> bool:
    """Whether the scene has more than one sample a pixel."""
    return session.world is not None and session.world.scene.image.samples > 1


def line_height() -> float:
    """The height of the line with the space below it, in pixels."""
    return imgui.get_frame_height() + GAP * d.unit()


def draw_line(session: Session, corner: imgui.ImVec2, width: float) -> None:
    """The buttons, the number of the chosen sample, and its colour. `corner` is the left top of the line."""
    tree, unit = session.tree, d.unit()
    if not tree or tree.sample is None:
        return
    imgui.set_cursor_screen_pos((corner.x + MARGIN * unit, corner.y))
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (6.0 * unit, 1.0 * unit))
    if imgui.button("<##sample"):
        step_sample(session, -1)
    d.hint("the sample before (Shift+S)")
    imgui.same_line(0.0, GAP * unit)
    if imgui.button(">##sample"):
        step_sample(session, 1)
    d.hint("the next sample (S)")
    imgui.same_line(0.0, 2.0 * GAP * unit)
    # As wide as for the last sample: nothing moves from sample to sample.
    left, widest = imgui.get_cursor_pos_x(), imgui.calc_text_size(f"sample {tree.samples - 1} of {tree.samples}").x
    imgui.text(tree.sample_text)
    d.hint(f"the rays on show are those of this sample; samples are numbered from 0 to {tree.samples - 1}")
    imgui.same_line(left + widest, 2.0 * GAP * unit)
    draw_shades([tree_shade(tree)], corner.x + width - MARGIN * unit - imgui.get_cursor_screen_pos().x)
    imgui.pop_style_var()
