"""Sizes in a tree figure. All boxes have one size, in which each text fits."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from tracer.choices import SYMBOLS
from tracer.tree.raytree import RayTree
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, factor_label, hit_label, ray_label
from viewer.figures.layout.folds import Fold
from viewer.figures.layout.light_line import NO_LINE, SIGN, WORDS, signs_width, widest_line
from viewer.figures.layout.planned_rays import PlannedRays
from viewer.figures.lights import MOST_LIGHTS, shadow_rays
from viewer.figures.marks import CANVAS, Rectangle

# All in text sizes.
SMALLEST = 8.0  # points: the smallest text size
MARGIN = 0.6
PADDING = 0.5  # on either side of a name in its box
SWATCH = 1.5  # width of the radiance's colour in a box
BOX = 1.55  # height of a box
FOLD = 2.7  # height of a fold's box, which has two lines
SLOT = 0.4  # between the labels of two stubs
CUT = 1.0  # width of the sign of a hit without its rays, in a compact box
INNER = 0.4  # in a compact box: between name and signs
STUB = 1.1  # from a box to the sign at a stub's end
NOTE = 1.2  # from there to the middle of a leaf's note
BARE_NOTE = 0.8  # from a box without stubs to the middle of its note
LINE = 1.3  # from line to line
EDGE_LABEL = 1.1  # from a box up to the middle of its ray's label
ABOVE, BELOW = 0.42, 0.61  # from the middle of a line of text to its ascenders and descenders

NO_RAY = "no T"  # the refracted ray on total internal reflection
OUTLINE = "outline"
LONG, SHORT = 24, 14  # characters of a name, with and without enough room; longer names are cut


@dataclass(frozen=True)
class TreeStyle:
    """The style of a plan. Branches whose weight is below `fold` are always folded."""

    size: float  # of the text, in points
    swatches: bool = False  # each box has the colour of its radiance
    fold: float = 0.0
    where: Rectangle = CANVAS  # its part of the canvas
    aside: float = 0.0  # width at the left that is kept free, with the eye at the top
    eye: str = "top"  # or left, or OUTLINE: a compact tree with a line for each hit
    lights: int = MOST_LIGHTS  # shadow rays that are drawn at a hit; if it has more, a line stands for them
    line: int = WORDS  # the form of that line
    longest: int = LONG  # characters of a name
    named: bool = True  # whether shadow rays have their lights' names; they stand in the order of the legend
    compact: bool = False  # lower: signs of shadow rays and of cut rays stand in the boxes

    @property
    def of_hits(self) -> tuple[object, ...]:
        """All of it that the size of a hit depends on."""
        return (self.size, self.swatches, self.lights, self.line, self.longest, self.named, self.compact)


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
    label: float  # of a ray, the widest

    @staticmethod
    def of(measured: "HitSizes", rows: Collection[int], folds: dict[int, Fold]) -> "Sizes":
        """The sizes for everything in, above and below any box, at any step."""
        style, size, is_shadow = measured.style, measured.style.size, measured.rays.is_shadow
        hung = {fold.under for fold in folds.values()}
        hits = {i: measured[i] for i in rows if not is_shadow[i]}
        down = [0.5 * (FOLD if len(hung - {None}) < len(folds) else BOX) * size]
        down += [hit.down[i in hung] for i, hit in hits.items()]
        shares = [words for fold in folds.values() for words in fold.words(fold.count, style.eye == OUTLINE)]
        around = 2 * PADDING * size
        widest = max(
            max(hit.name for hit in hits.values()) + around + max(hit.signs for hit in hits.values()),
            _widest(shares, size) + around,
            0.0 if style.eye == OUTLINE else max(max(hit.label, hit.note) for hit in hits.values()),
        )
        slot = max(hit.stub for hit in hits.values()) + (SIGN + SLOT) * size
        most, hangs = max(hit.stubs for hit in hits.values()), max(hit.hangs for hit in hits.values())
        lines = {i: hit.line for i, hit in hits.items() if hit.line}
        up = (0.5 * BOX + EDGE_LABEL + ABOVE) * size
        label = max(hit.label for hit in hits.values())
        return Sizes(max(widest, most * slot, hangs), BOX * size, slot, up, max(down), lines, label)


@dataclass(frozen=True)
class HitSize:
    """In points: what one hit needs."""

    name: float  # in its box
    signs: float  # beside the name
    label: float  # of its ray
    note: float  # below it
    stubs: int  # that hang below it
    stub: float  # the widest label of a stub
    line: float  # that stands for its shadow rays; 0: none
    hangs: float  # that line with the bar of total internal reflection
    down: tuple[float, float]  # the extent below its middle, without and with a fold


class RaySizes:
    """The sizes of the hits of planned rays, each computed once for all styles in which it is the same."""

    def __init__(self, rays: PlannedRays) -> None:
        self.rays = rays
        self._known: dict[tuple[object, ...], dict[int, HitSize]] = {}

    def in_style(self, style: TreeStyle) -> "HitSizes":
        return HitSizes(self.rays, style, self._known.setdefault(style.of_hits, {}))


class HitSizes:
    """The sizes of the hits of planned rays in one style."""

    def __init__(self, rays: PlannedRays, style: TreeStyle, known: dict[int, HitSize]) -> None:
        self.rays = rays
        self.tree = rays.tree
        self.style = style
        self._known = known

    def __getitem__(self, i: int) -> HitSize:
        if i not in self._known:
            self._known[i] = self._compact(i) if self.style.compact else self._with_stubs(i)
        return self._known[i]

    def _compact(self, i: int) -> HitSize:
        tree, style, size = self.tree, self.style, self.style.size
        name = text_width(name_in_box(tree, i, style.longest), size)
        signs = signs_width(tree, i, style.lights > 0, size) + (SWATCH * style.swatches + INNER + CUT) * size
        label = text_width(edge_label(tree, i), size)
        down = 0.5 * BOX * size
        return HitSize(name, signs, label, 0.0, 0, 0.0, 0.0, 0.0, (down, down + (BARE_NOTE + LINE + BELOW) * size))

    def _with_stubs(self, i: int) -> HitSize:
        tree, style, size = self.tree, self.style, self.style.size
        name = text_width(name_in_box(tree, i, style.longest), size)
        notes = [end_label(step, i) for step in self.rays.trees if i < len(step)]
        label, note = text_width(edge_label(tree, i), size), _widest(notes, size)
        tir = any(tree.kind(c) == "tir" for c in tree.children[i])
        shadows = shadow_rays(tree, i)
        line = 0.0
        if len(shadows) > style.lights and style.line != NO_LINE:
            line = widest_line(tree, shadows, style.line, size)
        drawn = shadows if len(shadows) <= style.lights else []
        stub = _widest([*(stub_label(tree, c, style) for c in drawn), *[NO_RAY] * tir], size)
        hanging = tir or bool(drawn) or line > 0.0

        def down(lines: int) -> float:
            """The extent with so many lines of text below."""
            reach = (STUB if hanging else 0.0) + ((NOTE if hanging else BARE_NOTE) + LINE * (lines - 1)) * (lines > 0)
            return (0.5 * BOX + reach + (BELOW if reach else 0.0)) * size

        hangs = line + tir * bar_width(size) if line else 0.0
        extents = (down(1 if any(notes) else 0), down(2))
        return HitSize(name, SWATCH * size * style.swatches, label, note, len(drawn) + tir, stub, line, hangs, extents)


def bar_width(size: float) -> float:
    """The width of the bar of total internal reflection beside a line, with the gap between them."""
    return (SIGN + SLOT) * size + text_width(NO_RAY, size)


def _widest(labels: Iterable[str], size: float) -> float:
    return max((text_width(label, size) for label in labels), default=0.0)


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
