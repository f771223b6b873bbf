"""A figure as a fragment of HTML: an inline SVG whose rays the script can find, and screen readers can name.

Every group of marks has `data-mark`, the name of its marks, which is the same in all figures and formats. Groups that
belong to a ray have `data-ray`: what has the same value, in any figure of the page, is one ray. The group that stands
for the ray in its figure also has a name (`aria-label`), and `data-numbers`, the id of the article about it.

The script makes these groups focusable. Without it, the figure is one image with a name and a description.
"""

from collections.abc import Iterator, Mapping
from html import escape

from viewer.figures.marks import Figure
from viewer.figures.picking import PICKED, ray_of
from viewer.figures.writers.svg import FONT, groups, title_element

SHORT = 200  # characters of elements that are not worth sharing
KEPT = ("<text", "aria-label", "data-ray", "data-handle")  # parts of elements that are not shared
BELONGING = (*PICKED, "angle-ray", "sum", "bar", "lights")  # marks that light up with their ray


class Drawings:
    """Elements that the figures of one page share, such as the objects of a scene: each is in the page once."""

    def __init__(self) -> None:
        self._names: dict[str, str] = {}  # ids, by the elements

    def shared(self, content: str) -> str:
        """An element in place of these, if that is shorter. Texts stay where they are, to be found and read, and so do
        the groups of rays.
        """
        if len(content) < SHORT or any(kept in content for kept in KEPT):
            return content
        return f'<use href="#{self._names.setdefault(content, f"drawing-{len(self._names)}")}"/>'

    def definitions(self) -> Iterator[str]:
        if self._names:
            yield '<svg class="definitions" aria-hidden="true"><defs>'
            for content, name in self._names.items():
                yield f'<g id="{name}">\n{content}\n</g>'
            yield "</defs></svg>"


class Groups:
    """Makes the groups of one figure, for `groups`.

    `place` begins the ids of groups; without it, they have none. The other arguments are those of `inline_svg`.
    """

    def __init__(
        self,
        figure: Figure,
        numbers: Mapping[int, str],
        tree: str = "",
        drawings: Drawings | None = None,
        place: str = "",
    ) -> None:
        self.figure, self.numbers, self.tree, self.drawings, self.place = figure, numbers, tree, drawings, place
        self._names = _names(figure)
        self._known: set[str] = set()

    def __call__(self, name: str, title: str, content: list[str]) -> str:
        """The group of marks with this name and title, from their elements."""
        row = row_of_mark(name)
        own = f' data-mark="{escape(name)}"'
        if self.place and name not in self._known:  # an id occurs once in a page
            own = f' id="{self.place}-{escape(name)}"{own}'
        self._known.add(name)
        inner = "\n".join(content)
        if row is None:
            return f"<g{own}>{title_element(title)}\n{self.drawings.shared(inner) if self.drawings else inner}\n</g>"
        own += f' data-ray="{self.tree}{row}"'
        if name == self._names.get(row):
            said = f' data-numbers="{self.numbers[row]}"' if row in self.numbers else ""
            own += f' aria-label="{escape(_label(self.figure, row))}"{said}'
            del self._names[row]
        return f"<g{own}>\n{inner}\n</g>"


def row_of_mark(name: str) -> int | None:
    """The row of the ray that a mark lights up with; None for other marks."""
    return ray_of(name.removesuffix("-label"), BELONGING)


def inline_svg(
    figure: Figure,
    place: str,
    labelled: str,
    numbers: Mapping[int, str],
    tree: str = "",
    drawings: Drawings | None = None,
) -> list[str]:
    """The lines of the SVG.

    `place` is an id that no other figure of the page has; ids in the figure begin with it. `labelled` has the
    attributes that say which elements of the page name and describe it. `numbers` are the ids of the articles about
    the rays, by row. `tree` tells rays of different trees in one page apart.
    `drawings` takes what several figures of the page may share; without it, the fragment stands by itself.
    """
    group = Groups(figure, numbers, tree, drawings, place)
    return [*opening(figure, labelled), *groups(figure, group), "</svg>"]


def opening(figure: Figure, labelled: str) -> list[str]:
    """The first line of the SVG of a figure."""
    return [f'<svg role="img" {labelled} viewBox="0 0 {figure.width:g} {figure.height:g}" {FONT}>']


def _names(figure: Figure) -> dict[int, str]:
    """The name of the marks that stand for each ray: its line, or the box of its hit where it has no line."""
    found: dict[int, str] = {}
    for kind in reversed(PICKED):
        found |= {row: mark.name for mark in figure.marks if (row := ray_of(mark.name, (kind,))) is not None}
    return found


def _label(figure: Figure, row: int) -> str:
    """The description of a ray: the title of its marks."""
    titled = (mark.title for mark in figure.marks if mark.title and ray_of(mark.name) == row)
    return next(titled, "") or next((one.name for one in figure.details if one.row == row), "")
