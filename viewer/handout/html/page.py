"""A lesson as one file for a browser.

Each step is a section with its text and its show. What `???` hides is in a `details`, which a press opens. Without its
script, the page has all text, and each show in the frame that shows everything.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

from viewer.base.theme import DARK, LIGHT, Theme
from viewer.figures.writers.html.formulas import Formulas
from viewer.figures.writers.html.frame import framed, shipped, text
from viewer.figures.writers.html.inline_svg import Drawings
from viewer.figures.writers.html.numbers import Numbers
from viewer.handout.document import Handout, Page, PagePart, Shown, paper
from viewer.handout.html.blocks import BlockWriter, RayLink
from viewer.handout.html.colors import ColorPairs
from viewer.handout.html.shows import ShowWriter
from viewer.lessons.language import ORIGINAL, web_tag
from viewer.lessons.text import Fence, Run, inlines

FOLDER = Path(__file__).parent
HINT = (
    "Point at a ray or tap it to see its numbers. Keys: Tab goes to a figure, Up and Down go from ray to ray, Enter "
    "keeps a ray, Escape lets it go."
)
ANSWER = "Show the answer"
NEXT = "Show what follows"  # after text that asks nothing


def write_page(handout: Handout, command: str, theme: str = LIGHT.name, head: Sequence[str] = ()) -> bytes:
    """The page of a lesson. With the light theme, it is dark where the reader's system asks for that."""
    themes = [paper(name) for name in ((LIGHT.name, DARK.name) if theme == LIGHT.name else (theme,))]
    return _Writer(handout, command, themes).page(head)


def own_language(language: str) -> str:
    """The attribute of what the program itself says, in a page of this language."""
    return "" if language == ORIGINAL else f' lang="{ORIGINAL}"'


class _Writer:
    def __init__(self, handout: Handout, command: str, themes: Sequence[Theme]) -> None:
        self.handout, self.command, self.themes = handout, command, themes
        self.language = web_tag(handout.lesson.language)
        self.ours = own_language(self.language)
        self.formulas = Formulas()
        self.numbers = Numbers(self.formulas)
        self.drawings = Drawings()
        self.colors = ColorPairs(themes)
        self.shows = ShowWriter(themes, self.numbers, self.drawings, self.colors, self.ours)

    def page(self, head: Sequence[str]) -> bytes:
        lesson = self.handout.lesson
        steps = [line for page in self.handout.pages for line in self._step(page)]
        articles = list(self.numbers.articles())
        body = [
            *self.formulas.definitions(),
            *self.drawings.definitions(),
            f'<a class="skip" href="#numbers"{self.ours}>Skip to the numbers</a>',
            *self._cover(),
            '<main class="handout">',
            '<div class="steps">',
            *steps,
            "</div>",
            f'<section id="numbers" class="numbers" aria-labelledby="numbers-title" tabindex="-1"{self.ours}>',
            '<h2 id="numbers-title">Rays</h2>',
            f'<p class="hint" hidden>{HINT}</p>',
            *articles,
            "</section>",
            "</main>",
            f"<footer{self.ours}><p>Made by <code>{text(self.command)}</code></p></footer>",
        ]
        style = f"{self.colors.style()}{shipped(FOLDER / 'handout.css')}"
        schemes = "light dark" if len(self.themes) > 1 else ""
        script = shipped(FOLDER / "handout.js")
        return framed(lesson.title, body, self.themes[0], head, style, script, schemes, self.language)

    def _cover(self) -> Iterator[str]:
        lesson = self.handout.lesson
        yield '<header class="cover">'
        yield f"<h1>{text(lesson.title)}</h1>"
        if lesson.question:
            yield f'<p class="question"><strong>{text(lesson.question)}</strong></p>'
        if lesson.objectives:
            yield f"<p{self.ours}>After this lesson you can:</p>"
            yield "<ul>"
            yield from (f"<li>{text(one)}</li>" for one in lesson.objectives)
            yield "</ul>"
        yield '<nav class="contents" aria-label="Steps">'
        yield "<ol>"
        yield from (f'<li><a href="#{page.number}">{text(page.title)}</a></li>' for page in self.handout.pages)
        yield "</ol>"
        yield "</nav>"
        yield "</header>"

    def _step(self, page: Page) -> Iterator[str]:
        place = f"step-{page.number}"
        count = f"{page.number}/{len(self.handout.pages)}"
        yield f'<section class="step" id="{page.number}" aria-labelledby="{place}-title">'
        yield f'<h2 id="{place}-title"><span class="place">{count}</span>{text(page.title)}</h2>'
        first, *others = page.parts
        yield from self.shows.lines(page.show, f"{place}-show", list(self._part(page, first, place)))
        before = first
        for k, part in enumerate(others):
            yield '<details class="answer">'
            yield f"<summary{self.ours}>{ANSWER if _asks(before) else NEXT}</summary>"
            yield '<div class="words">'
            yield from self._part(page, part, f"{place}-part-{k + 2}")
            yield "</div>"
            yield "</details>"
            before = part
        yield "</section>"

    def _part(self, page: Page, part: PagePart, place: str) -> Iterator[str]:
        def fence(fence: Fence) -> list[str]:
            if fence.kind != "live":
                return []
            show = part.live.get(fence.line)
            if not show:
                return [f"<p{self.ours}>This ray has no such figure.</p>"]
            return list(self.shows.lines(show, f"{place}-live-{fence.line}", kind="live"))

        writer = BlockWriter(self.formulas, lambda path: self._ray(page, part.shown, path), fence)
        yield from writer.lines(part.blocks)

    def _ray(self, page: Page, shown: Shown, path: str) -> RayLink | None:
        tree = shown.tree
        row = tree.find(path) if tree else None
        if tree is None or row is None:
            return None
        return RayLink(f"{self.shows.tree_name(shown)}{row}", tree.kind(row), f"step-{page.number}-show")


def _asks(part: PagePart) -> bool:
    """Whether a part of the text asks something."""
    return any(isinstance(item, Run) and "?" in item.text for _, item in inlines(part.blocks))
