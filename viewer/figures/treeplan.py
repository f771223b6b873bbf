"""Where everything of a tree figure stands: worked out once, for the deepest tree, so that its steps never jump.

Each hit is a box; boxes are all of one size, so the same subtree looks the same wherever it stands. Reflected rays
leave at a box's left side, refracted ones at its right, stubs to the lights hang below it: nothing can cross them.
Where a slide is too small for the whole tree, the lightest branches are folded into one box that says what is in it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from tracer.nodes import SHADOW
from tracer.tree import RayTree
from viewer.figures.folds import Fold, folded
from viewer.figures.font import text_width
from viewer.figures.labels import end_label, factor_label, hit_label, ray_label
from viewer.figures.layout import Room, layout
from viewer.figures.marks import HEIGHT, WIDTH, Point, Rectangle

# In sizes of the text.
MARGIN = 0.6
PADDING = 0.5  # on either side of a name in its box
SWATCH = 1.5  # of a box, for the colour that is sent up
BOX = 1.55  # its height
FOLD = 2.7  # the height of a box for a folded branch, which has two lines
GAP = 0.7  # between two boxes, at least
SPREAD = 1.6  # how much farther apart they stand where there is room
SIGN = 0.95  # the width of a sign at a stub's end; its label follows
SLOT = 0.4  # between two stubs' labels
STUB = 1.1  # from a box to the sign at a stub's end
NOTE = 1.2  # from there to the middle of a leaf's note
EDGE_LABEL = 1.1  # from a box up to the middle of its ray's label
EYE = 0.75  # from the upper rim to the eye
FIRST = 4.8  # from the eye to the first hit
LINE = 1.3  # from line to line
CLEAR = 6.3  # from level to level, at least, where a leaf's note may hang beside what is on the next level
PITCH, TALLEST = 4.85, 8.0  # from level to level, at least and at most

NO_RAY = "no T"  # what total internal reflection leaves of the refracted ray
LONGEST = 14  # characters of a name; longer ones are cut


@dataclass(frozen=True)
class TreePlan:
    """Places in points. `rows` are drawn each for itself, `inside` says in which fold others are."""

    tree: RayTree  # the deepest
    size: float
    swatches: bool
    where: tuple[float, float]  # its left and right on the canvas
    rows: frozenset[int]
    folds: dict[int, Fold]  # by the row where they stand
    inside: dict[int, int]  # a folded row -> the row of its fold
    at: dict[int, Point]  # middles of boxes, and of the signs at stubs' ends
    bars: dict[int, Point]  # where total internal reflection stops the refracted ray: the end of its stub
    eye: Point
    box: tuple[float, float]

    @property
    def hang(self) -> float:
        """From a box's middle to the signs under it."""
        return 0.5 * self.box[1] + STUB * self.size

    @property
    def fold_height(self) -> float:
        return FOLD * self.size

    @property
    def corners(self) -> tuple[Rectangle, ...]:
        """What is free beside the eye, on its left and on its right, and below the tree."""
        x, y = self.at[0]
        margin, aside = MARGIN * self.size, 0.5 * self.box[0] + self.size
        left, right = self.where
        lowest = max(place[1] for place in self.at.values()) + 0.5 * self.fold_height + (STUB + NOTE) * self.size
        return (
            (left + margin, margin, x - aside, y),
            (x + aside, margin, right - margin, y),
            (left + margin, lowest, right - margin, HEIGHT - margin),
        )

    @property
    def top(self) -> float:
        """From a box's middle to the label of the ray that reaches it."""
        return 0.5 * self.box[1] + EDGE_LABEL * self.size


def name_in_box(tree: RayTree, i: int) -> str:
    name = hit_label(tree, i)
    return name if len(name) <= LONGEST else name[: LONGEST - 1].rstrip() + "…"


def plan_tree(
    trees: Sequence[RayTree],
    size: float,
    swatches: bool = False,
    fold: float = 0.0,
    where: tuple[float, float] = (0.0, WIDTH),
) -> TreePlan:
    """The plan for these steps of one tree, the deepest last, with text of that size in points.

    Branches that weigh less than `fold` are folded, and as many more as there is no room for. `where` are the left and
    right of its part of the canvas.
    """
    tree = trees[-1]
    weights, kinds = tree.nodes["weight"].max(axis=1), tree.nodes["kind"]
    fitting = int(_room_below(size) / (PITCH * size))  # levels below the first

    def followed(i: int) -> bool:
        return any(kinds[c] != SHADOW for c in tree.children[i])

    rays = [i for i in range(len(tree)) if kinds[i] != SHADOW and (weights[i] >= fold or i == 0)]
    rays = [i for i in rays if tree.nodes["depth"][i] < fitting + (not followed(i)) or i == 0]
    heaviest = sorted(rays, key=lambda i: (-weights[i], i))
    low, high = 0, len(heaviest)
    best = _try(trees, set(heaviest), size, swatches, where)
    if best is not None:
        low = high
    while low + 1 < high:  # the most rays that fit: `low` do, `high` do not
        middle = (low + high) // 2
        found = _try(trees, set(heaviest[:middle]), size, swatches, where)
        if found is None:
            high = middle
        else:
            low, best = middle, found
    if best is None:  # even the first hit alone is too large: it is drawn all the same
        return _try(trees, {0}, size, swatches, where, anyhow=True)  # type: ignore[return-value]
    # A branch of one ray takes no more room as itself than as a fold.
    single = {root for branch in best.folds.values() for root in branch.roots if not tree.children[root]}
    single = {i for i in single if weights[i] >= fold}
    return _try(trees, set(heaviest[:low]) | single, size, swatches, where) or best


def _first(size: float) -> float:
    """How far down the first hit stands."""
    return (MARGIN + EYE + FIRST) * size


def _room_below(size: float) -> float:
    """From the first hit to the last level's."""
    return HEIGHT - _first(size) - (0.5 * BOX + STUB + NOTE + 0.5 + MARGIN) * size


def _try(
    trees: Sequence[RayTree],
    kept: set[int],
    size: float,
    swatches: bool,
    where: tuple[float, float],
    anyhow: bool = False,
) -> TreePlan | None:
    """The plan with these rays and all others folded; None where it does not fit onto the canvas."""
    tree = trees[-1]
    rows, folds, inside = folded(tree, kept)
    column, slot = _widths(trees, rows, folds, inside, size, swatches)
    margin, gap, box = MARGIN * size, GAP * size, BOX * size
    unit = column + gap
    stub = slot / unit
    first, free = _first(size), _room_below(size)
    levels = max(int(tree.nodes["depth"][i]) for i in (*rows, *folds))
    crowded = CLEAR * size * levels > free
    room = Room(0.5, 0.5, stub, 0.5 * stub, sides=True, passes=0.9, crowded=crowded, bars=True)
    laid = layout(tree, rows | folds.keys(), room)
    left = min(place.x for place in laid.places.values()) - 0.5
    right = max(place.x for place in laid.places.values()) + 0.5
    rim = (where[0] + margin - 0.5 * gap, where[1] - margin + 0.5 * gap)
    widest = (rim[1] - rim[0]) / (right - left)
    if not anyhow and (unit > widest or PITCH * size * levels > free):
        return None
    spread = min(widest, SPREAD * unit) / unit if unit < widest else 1.0
    unit *= spread
    pitch = min(TALLEST * size, free / levels) if levels else 0.0
    # The eye in the middle, where the tree leaves room for that.
    middle = min(max(0.5 * (where[0] + where[1]), rim[0] - left * unit), rim[1] - right * unit)
    kinds, depth, parents = (tree.nodes[name] for name in ("kind", "depth", "parent"))
    hang = 0.5 * box + STUB * size

    at = {
        i: (middle + place.x * unit, first + pitch * float(depth[i]))
        for i, place in laid.places.items()
        if kinds[i] != SHADOW
    }

    def hanging(parent: int, x: float) -> Point:
        """A stub keeps its distance from its hit, however far apart hits are."""
        return (at[parent][0] + (x - laid.places[parent].x) * unit / spread, at[parent][1] + hang)

    at |= {i: hanging(int(parents[i]), place.x) for i, place in laid.places.items() if kinds[i] == SHADOW}
    bars = {i: hanging(i, place.x) for i, place in laid.bars.items()}
    eye = (at[0][0], margin + EYE * size)
    return TreePlan(tree, size, swatches, where, frozenset(rows), folds, inside, at, bars, eye, (column, box))


def _widths(
    trees: Sequence[RayTree],
    rows: set[int],
    folds: dict[int, Fold],
    inside: dict[int, int],
    size: float,
    swatches: bool,
) -> tuple[float, float]:
    """(of a box, of a stub's place), wide enough for all that stands in, over or under any of them at any step."""
    tree = trees[-1]
    kinds = tree.nodes["kind"]
    names, loose, stubs, shares = [""], [""], [""], [""]
    most = 0
    for i in rows:
        if kinds[i] == SHADOW:
            stubs.append(ray_label(tree, i))
            continue
        names.append(name_in_box(tree, i))
        loose.append(edge_label(tree, i))
        loose += [end_label(step, i) for step in trees if i < len(step)]
        thrown_back = any(tree.kind(c) == "tir" for c in tree.children[i])
        most = max(most, sum(kinds[c] == SHADOW for c in tree.children[i]) + thrown_back)
        stubs += [NO_RAY] * thrown_back
    for fold in folds.values():
        shares += fold.words(range(len(tree)), inside)
    around = 2 * PADDING * size
    widest = max(
        _widest(names, size) + around + SWATCH * size * swatches, _widest(shares, size) + around, _widest(loose, size)
    )
    slot = _widest(stubs, size) + (SIGN + SLOT) * size
    return max(widest, most * slot), slot


def _widest(labels: Sequence[str], size: float) -> float:
    return max(text_width(label, size) for label in labels)


def edge_label(tree: RayTree, i: int) -> str:
    """On the way to hit i: which ray, and what its parent multiplies it by."""
    return f"{ray_label(tree, i)} {factor_label(tree, i)}" if i else ray_label(tree, i)
