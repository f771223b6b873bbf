"""Folded branches of a tree: one label gives their number of rays and their weight."""

from dataclasses import dataclass

from viewer.base.wording import format_number
from viewer.figures.layout.planned_rays import PlannedRays


@dataclass(frozen=True)
class Fold:
    """One branch of a hit, or both. Its box stands where the first hit of the heavier branch would.

    Below the last level there is no room for a box: there the text hangs `under` the hit.
    """

    row: int
    roots: tuple[int, ...]
    count: int  # of its rays
    weight: float  # of its first rays, together
    under: int | None = None

    def words(self, count: int, one_line: bool = False) -> tuple[str, ...]:
        """The number of rays and their share of the weight, of a fold with so many rays."""
        words = (f"+{count} ray{'s' if count > 1 else ''}", f"{percent(self.weight)} %")
        return (", ".join(words),) if one_line else words


def percent(share: float) -> str:
    """A percentage with two significant digits."""
    return f"{100.0 * share:.0f}" if share >= 0.0995 else format_number(100.0 * share, 2)


def fold_branches(rays: PlannedRays, kept: set[int], last: int, lights: int) -> tuple[set[int], dict[int, Fold]]:
    """(rows drawn as themselves, folds by the row in whose place they stand). The branches of a hit that are not kept
    make one fold.

    There are no boxes below the level `last`. A hit's shadow rays are drawn if there are no more than `lights`.
    """
    weights, shadow_rays, sent, allowed = rays.weights, rays.shadow_rays, rays.rays, rays.rows
    rows = kept.copy()
    for i in kept:
        to_lights = shadow_rays.get(i, ())
        if len(to_lights) <= lights:
            rows.update(to_lights)
    folds: dict[int, Fold] = {}
    for i in sorted(kept):
        roots = [c for c in sent.get(i, ()) if c not in kept and c in allowed]
        if roots:
            row = max(roots, key=lambda c: (weights[c], -c)) if len(roots) > 1 else roots[0]
            count = sum(rays.branch_sizes[c] for c in roots)
            under = i if rays.depths[i] >= last else None
            folds[row] = Fold(row, tuple(roots), count, float(sum(weights[c] for c in roots)), under)
    return rows, folds
