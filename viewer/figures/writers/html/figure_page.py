"""A page of figures: one file for a browser, in which the steps of a figure are shown one after the other.

Without its script, the page has all figures below each other, and the numbers of all rays. The script shows one figure
at a time, and the numbers of the ray that is pointed at.
"""

from collections.abc import Iterator, Sequence

from viewer.base.theme import THEMES, Color, Theme
from viewer.figures.marks import Figure
from viewer.figures.writers.html.formulas import Formulas
from viewer.figures.writers.html.frame import framed, text
from viewer.figures.writers.html.inline_svg import Drawings, inline_svg
from viewer.figures.writers.html.numbers import Numbers
from viewer.reopen.places import as_meta

HINT = (
    "Point at a ray or tap it to see its numbers. Keys: Tab goes to the figure, Up and Down go from ray to ray, Enter "
    "keeps a ray, Escape lets it go."
)


def write_html(figures: Sequence[Figure]) -> bytes:
    """The page of these figures, which are the steps of one."""
    title, parts = _titles([figure.title for figure in figures])
    formulas = Formulas()
    numbers = Numbers(formulas)
    drawings = Drawings()
    pages = [
        line
        for k, (figure, part) in enumerate(zip(figures, parts, strict=True), 1)
        for line in _page(figure, k, f"{k} of {len(figures)}{f': {part}' if part else ''}", numbers, drawings)
    ]
    articles = list(numbers.articles())
    body = [
        *formulas.definitions(),
        *drawings.definitions(),
        '<a class="skip" href="#numbers">Skip to the numbers</a>',
        f"<header><h1>{text(title)}</h1></header>",
        "<main>",
        '<div class="pages">',
        *pages,
        *(_position(len(figures)) if len(figures) > 1 else ()),
        "</div>",
        '<section id="numbers" class="numbers" aria-labelledby="numbers-title" tabindex="-1">',
        '<h2 id="numbers-title">Rays</h2>',
        f'<p class="hint" hidden>{HINT}</p>',
        *articles,
        "</section>",
        "</main>",
        f"<footer><p>Made by <code>{text(figures[0].command)}</code></p></footer>",
    ]
    carried = figures[0].embedded
    return framed(figures[-1].title, body, _theme(figures[0].paper), [as_meta(carried)] if carried else [])


def _page(figure: Figure, k: int, title: str, numbers: Numbers, drawings: Drawings) -> Iterator[str]:
    """The k-th figure, from 1: the fragment `#k` of the page's address leads to it."""
    place = f"page-{k}"
    named = {details.row: numbers.name(details) for details in figure.details}
    labelled = f'aria-labelledby="{place}-title" aria-describedby="{place}-description"'
    yield f'<section class="page" id="{k}" aria-labelledby="{place}-title" tabindex="-1">'
    yield f'<h2 id="{place}-title">{text(title)}</h2>'
    yield "<figure>"
    yield f'<div class="canvas{" wide" if figure.upright else ""}">'
    yield from inline_svg(figure, place, labelled, named, drawings=drawings)
    yield "</div>"
    for j, upright in enumerate(figure.upright):
        yield '<div class="canvas upright">'
        yield from inline_svg(upright, f"{place}-{j}", labelled, named, drawings=drawings)
        yield "</div>"
    yield f'<figcaption id="{place}-description">{text(figure.description)}</figcaption>'
    yield "</figure>"
    yield "</section>"


def _position(count: int) -> Iterator[str]:
    """The buttons that go through the pages. The script shows them."""
    yield '<nav class="position" aria-label="Pages" hidden>'
    yield '<button type="button" data-go="-1">Previous</button>'
    yield f'<p role="status" data-count="{count}"></p>'
    yield '<button type="button" data-go="1">Next</button>'
    yield "</nav>"


def _titles(titles: Sequence[str]) -> tuple[str, list[str]]:
    """The common beginning of the titles, up to a comma, and the rest of each."""
    parts = [title.split(", ") for title in titles]
    if all(part == parts[0] for part in parts):
        return titles[0], ["" for _ in titles]
    common = 0
    while all(part[: common + 1] == parts[0][: common + 1] and len(part) > common + 1 for part in parts):
        common += 1
    return ", ".join(parts[0][:common]), [", ".join(part[common:]) for part in parts]


def _theme(paper: Color) -> Theme:
    """The theme that a figure was made for: the one with its paper."""
    return next(theme for theme in THEMES.values() if theme.ground == paper)
