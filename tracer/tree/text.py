"""The ray tree as text, a line per ray, for terminals and for comparison line by line."""

import math
from collections.abc import Sequence

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.digits import degrees_text, number_text, rgb_text, weight_text
from tracer.tree.table import TreeTable
from tracer.tree.verified.enclosures import VerifiedTree
from tracer.tree.verified.text import verified_text

HEADINGS = ("ray", "meets", "distance", "index", "angle", "weight", "radiance (r g b)", "why it ends")

END_REASONS = {
    None: "",
    "surface": "opaque: nothing to follow",
    "background": "leaves the scene",
    "depth": "cut: depth limit",
    "weight": "cut: too little weight",
    "tolerance": "cut: within the tolerance",
    "nodes": "cut: node limit",
    "invalid": "no direction to follow",
    "lit": "reaches the light",
    "filtered": "reaches the light through glass (unbent)",
    "blocked": "blocked",
}

FACES_AWAY = "adds nothing: the surface faces away"

IDLE = {  # of shadow rays whose light adds nothing
    "lit": "reaches the light, but adds nothing",
    "filtered": "through glass (unbent), but adds nothing",
}

MAX_INDENT = 60  # levels that are indented; a deeper tree shows its levels as numbers


def tree_text(tree: TreeTable, most: int | None = None, verified: VerifiedTree | None = None) -> str:
    """The tree with each ray's children below it, after some lines about all of it. If there are more than `most` rays,
    only the heaviest are listed.
    """
    rows: list[tuple[str, ...]] = [HEADINGS]
    shown = heaviest_rows(tree, len(tree) if most is None else most)
    head = _head(tree) + ([] if verified is None else verified_text(verified, tree.label))
    if len(shown) < len(tree):
        head.append(f"the heaviest {len(shown)} of {len(tree)} rays are shown")
    stems = _stems(tree, shown)
    doubts = tree.doubtful(shown)
    if verified is not None:
        sure = [i for i in doubts if verified.rows[i].is_sure]
        doubts = {i: doubt for i, doubt in doubts.items() if i not in sure}
        if sure:
            head.append(
                f"{len(sure)} of the rays were closer to going otherwise than rounding can tell, and are certified"
            )
    if doubts:
        head.append(f"{len(doubts)} of the rays could have gone otherwise: rounding may have decided")
    for i in tree.preorder():
        if i in shown:
            rows.append(_row(tree, i, stems[i], doubts.get(i, "")))
    return "\n".join([*head, "", *columns(rows)]) + "\n"


def heaviest_rows(tree: TreeTable, most: int, rows: set[int] | None = None) -> set[int]:
    """The heaviest of these rays, or of all, with their shadow rays: at most `most` rows, but at least one ray.

    The parent of a row that is kept is kept, too, since no ray is heavier than its parent.
    """
    among = np.arange(len(tree)) if rows is None else np.array(sorted(rows))
    if len(among) <= most:
        return set(among.tolist())
    is_shadow = tree.nodes["kind"][among] == SHADOW
    rays, shadows = among[~is_shadow], among[is_shadow]
    parents = tree.nodes["parent"][shadows]
    order = rays[np.argsort(-tree.nodes["weight"][rays].max(axis=1), kind="stable")]
    taken = np.cumsum(1 + np.bincount(parents, minlength=len(tree))[order])
    kept = order[: max(1, int(np.searchsorted(taken, most, side="right")))]
    return set(kept.tolist()) | set(shadows[np.isin(parents, kept)].tolist())


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table, each column as wide as its widest cell."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _head(tree: TreeTable) -> list[str]:
    where = f"{tree.place} of {tree.size[0]}x{tree.size[1]}" if tree.pixel else tree.place
    where += f", {tree.sample_text}" if tree.sample_text else ""
    rays = "1 ray" if len(tree) == 1 else f"{len(tree)} rays"
    head = [f"{tree.scene.caption}: {where}, depth {tree.depth}, {tree.model}, {rays}"]
    head.append(f"colour {rgb_text(tree.radiance, tree.radiance_error)} (linear r g b); {cut_summary(tree)}")
    lost = [i for i in range(len(tree)) if tree.object_name(i) and tree.nodes["error"][i] > 0.0 and tree.digits(i) == 0]
    if lost:
        first = f"from {tree.label(lost[0])} on, rounding has left no correct digit of the hit points"
        head.append(f"{first}: the rays below may be wrong")
    return head


def cut_summary(tree: TreeTable) -> str:
    """The weight of the rays that were cut, and a bound on the light that is missing for them."""
    if tree.residual == 0.0:
        return "no ray was cut"
    carry = f"rays that were cut carry {number_text(tree.residual)} of the weight"
    if tree.is_limited:
        carry = f"stopped at the limit of {tree.max_nodes:,} rays: {carry}"
    elif tree.tolerance is not None and tree.residual > tree.tolerance:
        carry = f"stopped by depth or weight, before the tolerance was reached: {carry}"
    most = tree.missing
    channel = max(range(3), key=lambda k: most[k])
    grey = len(set(most)) == 1 and len(set(tree.radiance.tolist())) == 1
    where = "" if grey else f" in {CHANNELS[channel]}"
    lacks = missing_light(most[channel], tree.radiance_bound.reason, float(tree.radiance[channel]), where)
    return f"{carry}{lacks}{within(tree.bound, tree.missing_allowed)}"


CHANNELS = ("red", "green", "blue")


def missing_light(bound: float, reason: str, radiance: float | None = None, where: str = "") -> str:
    """The end of a sentence about rays that were cut: the bound on the missing light, relative to the pixel's, in the
    channel that may lack most, which `where` names. `reason` is the material that has no bound.
    """
    if math.isinf(bound):
        return f', and no upper bound is known for the missing light, because of the material "{reason}"'
    if radiance is not None and bound > radiance:
        return f": at most {number_text(bound)} is missing{where}, where this pixel has {number_text(radiance)}"
    of = "the light" if radiance is None else f"this pixel's {number_text(radiance)}{where}"
    return f": at most {number_text(bound)} of {of} is missing"


def within(bound: float, allowed: float | None) -> str:
    """The end of a sentence about missing light of which no more than `allowed` was asked for, if so."""
    if allowed is None:
        return ""
    return f", {'within' if bound <= allowed else 'more than'} the {number_text(allowed)} that was asked for"


def _stems(tree: TreeTable, shown: set[int]) -> dict[int, str]:
    """The prefix of each line: the branches that lead to it, or its level in a very deep tree."""
    levels = tree.nodes["depth"]
    if levels.max() > MAX_INDENT:
        return {i: f"level {levels[i]}: " for i in shown}
    stems = {0: ""}
    trunks = {0: ""}
    for i in tree.preorder():
        below = [child for child in tree.children[i] if child in shown]
        for child in below:
            last = child == below[-1]
            stems[child] = trunks[i] + ("└─ " if last else "├─ ")
            trunks[child] = trunks[i] + ("   " if last else "│  ")
    return stems


def _row(tree: TreeTable, i: int, stem: str, doubt: str) -> tuple[str, ...]:
    row = tree.nodes[i]
    kind = tree.kind(i)
    met = tree.object_name(i) or ""
    shadow = row["kind"] == SHADOW
    name = f"{tree.light_label(i)} shadow" if shadow else f"{tree.label(i)} {kind}"
    return (
        f"{stem}{name}",
        met or ("background" if tree.end(i) == "background" else ""),
        number_text(row["t"], row["error"]),
        "" if shadow else _pair(number_text(row["n1"]), number_text(row["n2"])),
        "" if shadow else _pair(degrees_text(row["theta1"], row["turn"]), degrees_text(row["theta2"], row["turn"])),
        weight_text(row["weight"], row["weight_error"]),
        rgb_text(row["radiance"], row["radiance_error"]),
        "; ".join(part for part in (end_reason(tree, i), doubt and f"not certain: {doubt}") if part),
    )


def end_reason(tree: TreeTable, i: int) -> str:
    """The reason why no ray follows ray i; for a shadow ray, whether it reaches its light."""
    if tree.end(i) == "tolerance" and tree.missing_allowed is not None:
        return "cut: within the light that may be missing"
    if tree.faces_away(i):
        return FACES_AWAY
    end = tree.end(i)
    return IDLE[end] if end in IDLE and tree.adds_nothing(i) else END_REASONS[end]


def _pair(first: str, second: str) -> str:
    return f"{first} → {second}" if first and second else first
