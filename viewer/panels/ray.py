"""The selected ray: its result, and the lecture's formulas with its numbers."""

from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES
from viewer.explain.interfaces import HEADINGS, Interface, interfaces
from viewer.explain.ray import explain_ray, headline
from viewer.explain.sections import Section
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.panel import Panel
from viewer.session.layout import Corner
from viewer.session.session import Session
from viewer.session.view_state import Request


def draw(session: Session, canvas: Canvas) -> None:
    tree, world, theme = session.tree, session.world, session.appearance.theme
    if not tree or not world:
        imgui.text_colored(theme.muted, "No pixel is picked.")
        return
    row = session.selected or 0
    if canvas.ray_changed((world, tree.path(row))):  # not at another pixel, so that one number can be watched
        imgui.set_scroll_y(0.0)
    _head(session, tree, row)
    _interfaces(session, canvas.interfaces.get((tree, row), lambda: interfaces(tree, row)))
    for k, part in enumerate(canvas.explanation.get((tree, row), lambda: explain_ray(tree, world, row))):
        imgui.push_id(k)
        imgui.separator_text(part.title)
        for section in part.sections:
            _section(session, section)
        imgui.pop_id()
    imgui.separator()
    imgui.push_text_wrap_pos(0.0)
    imgui.text_colored(theme.muted, session.verification.text(row))
    imgui.pop_text_wrap_pos()


def _head(session: Session, tree: RayTree, row: int) -> None:
    """The ray's name beside its style, and what becomes of it."""
    name, fate = headline(tree, row)
    theme, kind, unit = session.appearance.theme, tree.kind(row), d.unit()
    at, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    middle = (at.x, at.y + 0.5 * height)
    d.sample(imgui.get_window_draw_list(), middle, 30 * unit, STYLES[kind], theme.ray(kind), unit)
    imgui.dummy((36 * unit, height))
    imgui.same_line()
    imgui.text(name)
    if session.selected is None:
        imgui.same_line()
        imgui.text_colored(theme.muted, "(none selected)")
    imgui.push_text_wrap_pos(0.0)
    imgui.text_colored(theme.muted, fate[0].upper() + fate[1:] + ".")
    imgui.pop_text_wrap_pos()


def _interfaces(session: Session, rows: list[Interface]) -> None:
    """The table of angles at both ends. It stands at the top, so that it is seen without scrolling."""
    if not rows or not imgui.begin_table("interfaces", len(HEADINGS), imgui.TableFlags_.sizing_stretch_same):
        return
    for cells in (HEADINGS, *rows):
        imgui.table_next_row()
        for k, cell in enumerate(cells):
            imgui.table_next_column()
            muted = cells is HEADINGS or k == 0
            imgui.text_colored(session.appearance.theme.muted if muted else session.appearance.theme.text, cell)
    imgui.end_table()


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
            name = f"{line.name}  ({line.ray})" if line.ray else line.name
            imgui.text_colored(session.appearance.theme.muted, name)
            imgui.pop_text_wrap_pos()
            imgui.table_next_column()
            imgui.push_text_wrap_pos(0.0)
            imgui.text(line.value)
            imgui.pop_text_wrap_pos()
        imgui.end_table()


PANEL = Panel("Selected ray", draw, Corner.BOTTOM_RIGHT, request=Request.SHOW_RAY)
