"""The selected ray: its result, and the lecture's formulas with its numbers."""

from imgui_bundle import imgui

from viewer.base.theme import STYLES
from viewer.explain.ray import explain_ray, headline
from viewer.explain.sections import Section
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Corner, Panel
from viewer.session.session import Session
from viewer.session.view_state import Request


def draw(session: Session, canvas: Canvas) -> None:
    tree = session.tree
    if not tree or not session.world:
        imgui.text_colored(session.appearance.theme.muted, "No pixel is picked.")
        return
    row = session.selected if session.selected is not None else 0
    if row >= len(tree):
        return
    if canvas.ray_changed((tree, row)):
        imgui.set_scroll_y(0.0)
    name, fate = headline(tree, row)
    kind = tree.kind(row)
    unit = d.unit()
    at = imgui.get_cursor_screen_pos()
    height = imgui.get_text_line_height()
    d.sample(
        imgui.get_window_draw_list(),
        (at.x, at.y + 0.5 * height),
        30 * unit,
        STYLES[kind],
        session.appearance.theme.ray(kind),
        unit,
    )
    imgui.dummy((36 * unit, height))
    imgui.same_line()
    imgui.text(name)
    if session.selected is None:
        imgui.same_line()
        imgui.text_colored(session.appearance.theme.muted, "(none selected)")
    imgui.push_text_wrap_pos(0.0)
    imgui.text_colored(session.appearance.theme.muted, fate[0].upper() + fate[1:] + ".")
    imgui.text_colored(session.appearance.theme.muted, session.verification.text(row))
    imgui.pop_text_wrap_pos()
    world = session.world
    for section in canvas.sections.get((tree, row), lambda: explain_ray(tree, world, row)):
        _section(session, section)


def _section(session: Session, section: Section) -> None:
    if not imgui.collapsing_header(section.title, imgui.TreeNodeFlags_.default_open):
        return
    if section.formula:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored(session.appearance.theme.accent, section.formula)
        imgui.pop_text_wrap_pos()
    flags = imgui.TableFlags_.sizing_stretch_prop | imgui.TableFlags_.pad_outer_x
    if imgui.begin_table(section.title, 2, flags):
        # Names wrap, values do not, except for a value that is a sentence.
        widest = max(imgui.calc_text_size(line.value).x for line in section.lines)
        if widest < 0.66 * imgui.get_content_region_avail().x:
            imgui.table_setup_column("", imgui.TableColumnFlags_.width_stretch)
            imgui.table_setup_column("", imgui.TableColumnFlags_.width_fixed, widest)
        for line in section.lines:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.push_text_wrap_pos(0.0)
            imgui.text_colored(session.appearance.theme.muted, line.name)
            imgui.pop_text_wrap_pos()
            imgui.table_next_column()
            imgui.push_text_wrap_pos(0.0)
            imgui.text(line.value)
            imgui.pop_text_wrap_pos()
        imgui.end_table()


PANEL = Panel("Selected ray", draw, Corner.BOTTOM_RIGHT, request=Request.SHOW_RAY)
