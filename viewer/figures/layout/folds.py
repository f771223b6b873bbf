"""Folded branches of a tree: one label gives their number of rays and their weight."""

from collections.abc import Collection
from dataclasses import dataclass

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_number
from viewer.figures.lights import shadow_rays


@dataclass(frozen=True)
class Fold:
    """One branch of a hit, or both. Its box stands where the first hit of the heavier branch would.

    Below the last level there is no room for a box: there the text hangs `under` the hit.
    """

    row: int
    roots: tuple[int, ...]
    weight: float  # of its first rays, together
    under: int | None = None

    def words(self, count: int, one_line: bool = False) -> tuple[str, ...]:
        """The number of rays and their share of the weight, of a fold with so many rays."""
        words = (f"+{count} ray{'s' if count > 1 else ''}", f"{percent(self.weight)} %")
        return (", ".join(words),) if one_line else words


def percent(share: float) -> str:
    """A percentage with two significant digits."""
    return f"{100.0 * share:.0f}" if share >= 0.0995 else format_number(100.0 * share, 2)


def fold_branches(
    tree: RayTree, allowed: Collection[int], kept: set[int], last: int, lights: int
) -> tuple[set[int], dict[int, Fold], dict[int, int]]:
    """(rows drawn as themselves, folds, fold of each folded row). Of the allowed rows, the branches of a hit that are
    not kept make one fold.

    There are no boxes below the level `last`. A hit's shadow rays are drawn if there are no more than `lights`.
    """
    nodes = tree.nodes
    weights = nodes["weight"].max(axis=1)
    shadows = [shadow_rays(tree, i) for i in kept]
    rows = kept | {c for rays in shadows if len(rays) <= lights for c in rays}
    folds: dict[int, Fold] = {}
    inside: dict[int, int] = {}
    for i in sorted(kept):
        roots = tuple(c for c in tree.children[i] if c in allowed and c not in kept and nodes["kind"][c] != SHADOW)
        if roots:
            row = max(roots, key=lambda c: (weights[c], -c))
            under = i if nodes["depth"][i] >= last else None
            folds[row] = Fold(row, roots, float(sum(weights[c] for c in roots)), under)
            inside |= dict.fromkeys(roots, row)
    parents = nodes["parent"].tolist()
    for i in range(len(tree)) if inside else ():  # parents come before their children
        if parents[i] in inside and i in allowed and i not in inside:
            inside[i] = inside[parents[i]]
    return rows, folds, inside
