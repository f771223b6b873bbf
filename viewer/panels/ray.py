"""The selected ray: how it came to be and what it meets, with the lecture's formulas and its numbers; what is certain
about it; then everything.
"""

from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from viewer.explain.formulas import Lecture
from viewer.explain.interfaces import Interface, interfaces
from viewer.explain.ray import certainty, explain_ray, ray_facts
from viewer.explain.sections import Part
from viewer.gl.canvas import Canvas
from viewer.panels import draw as d
from viewer.panels.card import SMALL, Card
from viewer.panels.panel import Panel
from viewer.session.session import Session
from viewer.session.view_state import Request

TWO_COLUMNS = 26.0  # the least width for two columns, in font sizes
BETWEEN = 1.6  # two columns
LABEL = 1.35  # size of the ray's label


def draw(session: Session, canvas: Canvas) -> None:
    tree, world, theme = session.tree, session.world, session.appearance.theme
    if not tree or not world:
        imgui.text_colored(theme.muted, "No pixel is picked.")
        return
    row = session.selected or 0
    if canvas.ray_changed((world, tree.path(row))):  # not at another pixel, so that one number can be watched
        imgui.set_scroll_y(0.0)
    corner, width = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    card = Card(theme, corner.x, corner.y, width)
    _head(session, card, tree, row)
    _ends(card, canvas.interfaces.get((tree, row), lambda: interfaces(tree, row)))
    canvas.ray_ends = (card.x, corner.y, card.x + width, card.y)
    for words in (*canvas.certainty.get((tree, row), lambda: certainty(tree, row)), session.verification.text(row)):
        if words:
            card.text(words, theme.muted, SMALL)
    card.skip(0.5)
    _details(card, canvas.explanation.get((tree, row), lambda: explain_ray(tree, world, row)))
    imgui.dummy((card.right - corner.x, card.y - corner.y))  # the panel scrolls if that is more than it has


def _head(session: Session, card: Card, tree: RayTree, row: int) -> None:
    """The ray's label in its colour, its kind, its weight and its medium."""
    theme, label = session.appearance.theme, tree.label(row)
    top = card.y
    with d.bold():
        pixels = round(LABEL * card.em)
        card.pad.add_text(
            imgui.get_font(), pixels, (round(card.x), round(top)), d.u32(theme.ray(tree.kind(row))), label
        )
        wide = imgui.calc_text_size(label).x * pixels / card.em
    facts = ray_facts(tree, row) + ("" if session.selected is not None else ", none is selected")
    beside = Card(theme, card.x + wide + 0.6 * card.em, top + (LABEL - 1.0) * 0.8 * card.em, card.width)
    beside.width = card.width - (beside.x - card.x)
    beside.text(facts)
    card.y = max(top + LABEL * card.em, beside.y)
    card.skip(0.3)


def _ends(card: Card, ends: list[Interface]) -> None:
    """The surfaces at the ray's start and end, side by side if there is room."""
    columns = _columns(card, len(ends))
    for column, end in zip(columns, ends, strict=False):
        column.text(end.title, card.theme.muted, bold=True)
        if end.formula:
            column.formula(end.formula)
        if end.formula == Lecture.REFLECTION:
            column.pairs(((Lecture.COSINE, end.dot), (Lecture.THETA_1, end.theta1)))
            if end.is_clear:
                column.pairs(((Lecture.INDEX_1, end.n1), (Lecture.INDEX_2, end.n2)))
                column.pairs(((Lecture.THETA_C, end.critical), (Lecture.RADICAND, end.radicand)))
        elif not end.is_clear:
            column.pairs(((Lecture.INDEX_1, end.n1), (Lecture.THETA_1, end.theta1)))
        else:
            column.pairs(((Lecture.INDEX_1, end.n1), (Lecture.INDEX_2, end.n2)))
            column.pairs(((Lecture.THETA_1, end.theta1), (Lecture.THETA_2, end.theta2)))
            column.pairs(((Lecture.THETA_C, end.critical), (Lecture.RADICAND, end.radicand)))
        column.skip(0.4)
        card.y, card.right = max(card.y, column.y), max(card.right, column.right)


def _columns(card: Card, count: int) -> list[Card]:
    """The places of up to two columns; below each other they share one, which then goes on."""
    if count < 2 or card.width < TWO_COLUMNS * card.em:
        return [card] * count
    gap = BETWEEN * card.em
    wide = 0.5 * (card.width - gap)
    return [Card(card.theme, card.x + k * (wide + gap), card.y, wide) for k in range(2)]


def _details(card: Card, parts: list[Part]) -> None:
    """All sections: of the ray's start and of its end side by side if there is room."""
    columns = _columns(card, len(parts))
    for part, column in zip(parts, [*columns, *columns], strict=False):
        column.text(part.title, bold=True)
        for section in part.sections:
            column.section(section)
        card.y, card.right = max(card.y, column.y), max(card.right, column.right)


PANEL = Panel("Selected ray", draw, short="Ray", request=Request.SHOW_RAY)
