"""The lines that show a ray tree, in the 3D view and for finding the line under the mouse.

They are computed as arrays with one row per line, since a tree of hundreds of rays is drawn anew at each pick.
"""

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass

import numpy as np

from tracer.kernel.nodes import BLOCKED, FILTERED, KINDS, SHADOW
from tracer.tree.raytree import RayTree
from tracer.tree.text import heaviest_rows
from viewer.base.orbit import Frame
from viewer.base.theme import BLOCKED_DASH, ESCAPE, FILTERED_DASH, NOTHING_DASH, STYLES

MOST_DRAWN = 20_000  # rays in the window: the heaviest, if a tree has more
MOST_IN_FIGURE = 2_000  # the same in a figure of the scene
SAME_PLACE = 3.0  # pixels: lines at distances from the mouse that differ by less are all under it


@dataclass(frozen=True)
class RayLine:
    """One row of the tree as a line. Its ends are in the frame."""

    row: int
    kind: str
    start: np.ndarray
    end: np.ndarray
    dash: tuple[float, float]
    escapes: bool  # it leaves the scene, and is drawn for a short length only
    blocked: bool  # by something between a surface that faces the light, and the light


@dataclass(frozen=True, eq=False)
class RayLines(Sequence[RayLine]):
    """Lines as arrays of the same length, with the fields of `RayLine`. Kinds are numbers, as in the node table."""

    rows: np.ndarray
    kinds: np.ndarray
    starts: np.ndarray  # (n, 3)
    ends: np.ndarray  # (n, 3)
    dashes: np.ndarray  # (n, 2)
    escapes: np.ndarray
    blocked: np.ndarray

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, k: int) -> RayLine:  # type: ignore[override]  # a slice is not needed
        on, off = self.dashes[k].tolist()
        kind = KINDS[self.kinds[k]]
        ends = (self.starts[k], self.ends[k])
        return RayLine(int(self.rows[k]), kind, *ends, (on, off), bool(self.escapes[k]), bool(self.blocked[k]))

    def __iter__(self) -> Iterator[RayLine]:
        return map(self.__getitem__, range(len(self)))

    def find(self, row: int | None) -> int | None:
        """The index of the line of this row; None if it has none."""
        found = [] if row is None else np.flatnonzero(self.rows == row).tolist()
        return found[0] if found else None


def drawn_rows(tree: RayTree, selected: int | None = None) -> list[int]:
    """The rows that the window draws: the heaviest, and the selected ray with its nearest ancestors."""
    rows = heaviest_rows(tree, MOST_DRAWN)
    above = ancestors(tree, selected) if selected is not None else set()
    return sorted(rows.union(sorted(above)[-MOST_DRAWN:]))


def ray_lines(tree: RayTree, rows: Sequence[int], frame: Frame, kinds: Set[str]) -> RayLines:
    """The lines of these rows, if they are of these kinds. A shadow ray that its own surface blocks has no length, and
    no line.
    """
    nodes = tree.nodes
    among = np.asarray(rows, np.int64)
    wanted = np.array([kind in kinds for kind in KINDS])
    among = among[wanted[nodes["kind"][among]] & ((nodes["kind"][among] != SHADOW) | (nodes["t"][among] != 0.0))]
    codes, ended = nodes["kind"][among], nodes["end"][among]
    starts, ends = frame.inside(nodes["origin"][among]), frame.inside(nodes["point"][among])
    escapes = np.asarray(np.isnan(ends).any(axis=1))
    ends[escapes] = _escapes(starts[escapes], nodes["direction"][among[escapes]])
    is_shadow = codes == SHADOW
    blocked = is_shadow & (ended == BLOCKED)
    blocked &= ~tree.facing_away[among]
    dashes = np.array([STYLES[kind].dash for kind in KINDS], float)[codes]
    dashes[is_shadow & (ended == FILTERED)] = FILTERED_DASH
    dashes[tree.adding_nothing[among]] = NOTHING_DASH
    dashes[blocked] = BLOCKED_DASH
    return RayLines(among, codes, starts, ends, dashes, escapes, blocked)


NO_LINES = RayLines(
    np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 2)),
    np.zeros(0, bool), np.zeros(0, bool),
)  # fmt: skip


def _escapes(starts: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The ends of the lines of rays that hit nothing: beyond the sphere around the scene, if the ray crosses it."""
    b = (starts * directions).sum(axis=1)
    root = b * b - ((starts * starts).sum(axis=1) - 1.0)
    leaving = np.maximum(np.where(root > 0.0, -b + np.sqrt(np.maximum(root, 0.0)), 0.0), 0.0)
    return starts + (leaving * 0.35 + ESCAPE)[:, None] * directions


def ancestors(tree: RayTree, row: int) -> set[int]:
    """A ray and all rays above it."""
    found = set()
    while row >= 0:
        found.add(row)
        row = int(tree.nodes["parent"][row])
    return found


def relatives(tree: RayTree, row: int, rows: Sequence[int]) -> set[int]:
    """A ray with its ancestors, and its descendants among the drawn `rows`: they stay bright while it is selected."""
    return ancestors(tree, row) | branch(tree, row, rows)


def branch(tree: RayTree, row: int, rows: Sequence[int]) -> set[int]:
    """A ray, and its descendants among `rows`, which are in order."""
    found = {row}
    for i, parent in zip(rows, tree.nodes["parent"][rows].tolist(), strict=True):
        if parent in found:
            found.add(i)
    return found


def nearest_row(
    lines: RayLines, places: np.ndarray, depths: np.ndarray, mouse: tuple[float, float], reach: float
) -> int | None:
    """The row of the line nearest to the mouse, at most `reach` away; None if there is none. Of several lines under the
    mouse, the one in front is chosen.

    `places` (n, 2, 2) are the lines' ends on the screen, `depths` (n, 2) their distances from the camera.
    """
    seen = np.flatnonzero((depths > 0.0).all(axis=1))
    starts, along = places[seen, 0], places[seen, 1] - places[seen, 0]
    size = (along * along).sum(axis=1)
    share = np.clip(((np.array(mouse) - starts) * along).sum(axis=1) / np.where(size > 0.0, size, 1.0), 0.0, 1.0)
    away = np.hypot(*(starts + share[:, None] * along - mouse).T)
    depth = depths[seen, 0] + share * (depths[seen, 1] - depths[seen, 0])
    order = np.lexsort((depth, np.round(away / SAME_PLACE)))
    order = order[away[order] <= reach]
    return int(lines.rows[seen[order[0]]]) if len(order) else None
