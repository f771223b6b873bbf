"""Sizes in a tree figure. All boxes have one size, in which each text fits."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from tracer.choices import SYMBOLS
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, factor_label, hit_label, ray_label
from viewer.figures.layout.folds import Fold
from viewer.figures.layout.light_line import NO_LINE, SIGN, WORDS, widest_line
from viewer.figures.lights import MOST_LIGHTS, shadow_rays
from viewer.figures.marks import WIDTH

# All in text sizes.
SMALLEST = 8.0  # points: the smallest text size
MARGIN = 0.6
PADDING = 0.5  # on either side of a name in its box
SWATCH = 1.5  # width of the radiance's colour in a box
BOX = 1.55  # height of a box
FOLD = 2.7  # height of a fold's box, which has two lines
SLOT = 0.4  # between the labels of two stubs
STUB = 1.1  # from a box to the sign at a stub's end
NOTE = 1.2  # from there to the middle of a leaf's note
BARE_NOTE = 0.8  # from a box without stubs to the middle of its note
LINE = 1.3  # from line to line
EDGE_LABEL = 1.1  # from a box up to the middle of its ray's label
ABOVE, BELOW = 0.42, 0.61  # from the middle of a line of text to its ascenders and descenders

NO_RAY = "no T"  # the refracted ray on total internal reflection
LONG, SHORT = 24, 14  # characters of a name, with and without enough room; longer names are cut


@dataclass(frozen=True)
class TreeStyle:
    """The style of a plan. Branches whose weight is below `fold` are always folded."""

    size: float  # of the text, in points
    swatches: bool = False  # each box has the colour of its radiance
    fold: float = 0.0
    where: tuple[float, float] = (0.0, WIDTH)  # left and right of its part of the canvas
    eye: str = "top"  # or left
    lights: int = MOST_LIGHTS  # shadow rays that are drawn at a hit; if it has more, a line stands for them
    line: int = WORDS  # the form of that line
    longest: int = LONG  # characters of a name
    named: bool = (
        True  # whether the ends of shadow rays have their lights' names; they stand in the order of the legend
    )


@dataclass(frozen=True)
class Sizes:
    """In points: width of a column and of a box, distance of stubs, the extent above and below a box's middle, and the
    widths of the lines that stand for the shadow rays of hits.
    """

    column: float
    box: float
    slot: float
    up: float
    down: float
    lines: dict[int, float]

    @staticmethod
    def of(
        trees: Sequence[RayTree],
        rows: Collection[int],
        folds: dict[int, Fold],
        inside: dict[int, int],
        style: TreeStyle,
    ) -> "Sizes":
        """The sizes for everything in, above and below any box, at any step. `trees` has the deepest last."""
        tree, size = trees[-1], style.size
        kinds = tree.nodes["kind"]
        names, loose, stubs, shares = [""], [""], [""], [""]
        hung = {fold.under for fold in folds.values()}
        lines: dict[int, float] = {}
        most, hangs, down = 0, [0.0], 0.5 * (FOLD if len(hung - {None}) < len(folds) else BOX)
        for i in rows:
            if kinds[i] == SHADOW:
                stubs.append(stub_label(tree, i, style))
                continue
            names.append(name_in_box(tree, i, style.longest))
            loose.append(edge_label(tree, i))
            notes = [end_label(step, i) for step in trees if i < len(step)]
            loose += notes
            tir = any(tree.kind(c) == "tir" for c in tree.children[i])
            shadows = shadow_rays(tree, i)
            if len(shadows) > style.lights and style.line != NO_LINE:
                lines[i] = widest_line(tree, shadows, style.line, size)
                hangs.append(lines[i] + tir * bar_width(size))
            stubs += [NO_RAY] * tir
            drawn = (len(shadows) if len(shadows) <= style.lights else 0) + tir
            most = max(most, drawn)
            hanging = drawn > 0 or i in lines
            below = 2 if i in hung else 1 if any(notes) else 0
            reach = (STUB if hanging else 0.0) + ((NOTE if hanging else BARE_NOTE) + LINE * (below - 1)) * (below > 0)
            down = max(down, 0.5 * BOX + reach + (BELOW if reach else 0.0))
        for fold in folds.values():
            shares += fold.words(range(len(tree)), inside)
        around = 2 * PADDING * size
        widest = max(
            _widest(names, size) + around + SWATCH * size * style.swatches,
            _widest(shares, size) + around,
            _widest(loose, size),
        )
        slot = _widest(stubs, size) + (SIGN + SLOT) * size
        up = 0.5 * BOX + EDGE_LABEL + ABOVE
        return Sizes(max(widest, most * slot, *hangs), BOX * size, slot, up * size, down * size, lines)


def bar_width(size: float) -> float:
    """The width of the bar of total internal reflection beside a line, with the gap between them."""
    return (SIGN + SLOT) * size + text_width(NO_RAY, size)


def _widest(labels: Iterable[str], size: float) -> float:
    return max(text_width(label, size) for label in labels)


def stub_label(tree: RayTree, i: int, style: TreeStyle) -> str:
    """The label at the end of a shadow ray."""
    return ray_label(tree, i) if style.named else SYMBOLS["shadow"]


def name_in_box(tree: RayTree, i: int, longest: int) -> str:
    return shortened(hit_label(tree, i), longest)


def shortened(name: str, longest: int = LONG) -> str:
    """The name, cut if it has more characters than that."""
    return name if len(name) <= longest else name[: longest - 1].rstrip() + "…"


def edge_label(tree: RayTree, i: int) -> str:
    """The label of the ray to hit i: its kind and its factor."""
    return f"{ray_label(tree, i)} {factor_label(tree, i)}" if i else ray_label(tree, i)
