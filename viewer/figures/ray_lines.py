"""The lines that show a ray tree, in the 3D view and for finding the line under the mouse."""

import math
from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

from tracer.kernel.nodes import BLOCKED, KINDS, SHADOW
from tracer.tree.raytree import RayTree
from tracer.tree.text import heaviest_rows
from viewer.base.orbit import Frame
from viewer.base.theme import ESCAPE
from viewer.figures.lights import ray_dash

MOST_DRAWN = 20_000  # rays in the window: the heaviest, if a tree has more
MOST_IN_FIGURE = 2_000  # the same in a figure of the scene


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


def drawn_rows(tree: RayTree, selected: int | None = None) -> list[int]:
    """The rows that the window draws: the heaviest, and the selected ray with its nearest ancestors."""
    rows = heaviest_rows(tree, MOST_DRAWN)
    above = ancestors(tree, selected) if selected is not None else set()
    return sorted(rows.union(sorted(above)[-MOST_DRAWN:]))


def ray_lines(tree: RayTree, rows: Sequence[int], frame: Frame, kinds: Set[str]) -> list[RayLine]:
    """The lines of these rows, if they are of these kinds. A shadow ray that its own surface blocks has no length, and
    no line.
    """
    nodes = tree.nodes
    starts = dict(zip(rows, frame.inside(nodes["origin"][rows]), strict=True))
    points = dict(zip(rows, frame.inside(nodes["point"][rows]), strict=True))
    found = []
    for i in rows:
        code = nodes["kind"][i]
        kind = KINDS[code]
        if kind not in kinds or (code == SHADOW and nodes["t"][i] == 0.0):
            continue
        start, end = starts[i], points[i]
        escapes = bool(np.isnan(end).any())
        if escapes:
            end = _escape(start, nodes["direction"][i])
        blocked = code == SHADOW and nodes["end"][i] == BLOCKED and not tree.faces_away(i)
        found.append(RayLine(i, kind, start, end, ray_dash(tree, i), escapes, bool(blocked)))
    return found


def _escape(start: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """The end of the line of a ray that hits nothing: beyond the sphere around the scene, if the ray crosses it."""
    b = float(start @ direction)
    root = b * b - (float(start @ start) - 1.0)
    leaving = -b + math.sqrt(root) if root > 0.0 else 0.0
    return start + (max(leaving, 0.0) * 0.35 + ESCAPE) * direction


def ancestors(tree: RayTree, row: int) -> set[int]:
    """A ray and all rays above it."""
    found = set()
    while row >= 0:
        found.add(row)
        row = int(tree.nodes["parent"][row])
    return found


def relatives(tree: RayTree, row: int, rows: Sequence[int]) -> set[int]:
    """A ray with its ancestors, and its descendants among the drawn `rows`: they stay bright while it is selected."""
    below = {row}
    for i, parent in zip(rows, tree.nodes["parent"][rows].tolist(), strict=True):
        if parent in below:
            below.add(i)
    return ancestors(tree, row) | below


def nearest_row(
    lines: list[RayLine], places: np.ndarray, depths: np.ndarray, mouse: tuple[float, float], reach: float
) -> int | None:
    """The row of the line nearest to the mouse, at most `reach` away; None if there is none.

    `places` (n, 2, 2) are the lines' ends on the screen, `depths` (n, 2) their distances from the camera.
    """
    best = None
    for line, (a, b), (za, zb) in zip(lines, places, depths, strict=True):
        if za <= 0.0 or zb <= 0.0:
            continue
        along = b - a
        size = float(along @ along)
        t = min(1.0, max(0.0, float((np.array(mouse) - a) @ along) / size)) if size > 0.0 else 0.0
        away = float(np.hypot(*(a + t * along - mouse)))
        if away <= reach:
            # Within three pixels, both lines count as hit, and the one in front is chosen.
            key = (round(away / 3.0), za + t * (zb - za))
            if best is None or key < best[0]:
                best = (key, line.row)
    return None if best is None else best[1]
