"""The tree of rays as text: a line a ray, so that it can be read in a terminal and compared line by line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tracer.kernel.nodes import NODES, SHADOW

if TYPE_CHECKING:
    from tracer.tree.raytree import RayTree

HEADINGS = ("ray", "meets", "distance", "index", "angle", "weight", "sends up (r g b)", "why it ends")

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


def tree_text(tree: RayTree, most: int | None = None) -> str:
    """The tree, children below their parent, with a head of two lines; of more than `most` rays the heaviest."""
    rows: list[tuple[str, ...]] = [HEADINGS]
    shown = set(range(len(tree)))
    head = _head(tree)
    if most is not None and len(tree) > most:
        shown = heaviest_rows(tree, most, shown)
        head.append(f"the heaviest {len(shown)} of {len(tree)} rays are shown")
    stems = _stems(tree, shown)
    for i in tree.walk():
        if i in shown:
            rows.append(_row(tree, i, stems[i]))
    return "\n".join([*head, "", *columns(rows)]) + "\n"


def heaviest_rows(tree: RayTree, most: int, rows: set[int]) -> set[int]:
    """At most about `most` of these rows: the heaviest rays with their shadow rays. A child is never heavier than its
    parent, so every row that is kept keeps its parent."""
    if len(rows) <= most:
        return rows
    weights = tree.nodes["weight"].max(axis=1)
    rays = sorted((i for i in rows if tree.nodes["kind"][i] != SHADOW), key=lambda i: (-weights[i], i))
    kept: set[int] = set()
    for i in rays:
        shadows = {child for child in tree.children[i] if child in rows and tree.nodes["kind"][child] == SHADOW}
        if kept and len(kept) + 1 + len(shadows) > most:
            break
        kept |= {i} | shadows
    return kept


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """A table's lines, each column as wide as its widest cell."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _head(tree: RayTree) -> list[str]:
    where = f"pixel {tree.pixel[0]},{tree.pixel[1]} of {tree.size[0]}x{tree.size[1]}" if tree.pixel else "a ray"
    title = tree.scene.title or (tree.scene.path.name if tree.scene.path else "scene")
    rays = "1 ray" if len(tree) == 1 else f"{len(tree)} rays"
    head = [f"{title}: {where}, depth {tree.depth}, {tree.model}, {rays}"]
    head.append(f"colour {rgb_text(tree.radiance)} (linear r g b); {cut_summary(tree)}")
    lost = [i for i in range(len(tree)) if tree.object_name(i) and tree.nodes["error"][i] > 0.0 and tree.digits(i) == 0]
    if lost:
        head.append(f"from ray {lost[0]} on rounding has left no digit of where rays go: what follows may be otherwise")
    return head


def cut_summary(tree: RayTree) -> str:
    """What the rays that were cut weigh, and how much light they can have brought at most."""
    if tree.residual == 0.0:
        return "no ray was cut"
    carry = f"rays that were cut carry {number_text(tree.residual)} of the weight"
    if (tree.nodes["end"] == NODES).any():
        carry = f"stopped at the limit of rays: {carry}"
    elif tree.tolerance is not None and tree.residual > tree.tolerance:
        carry = f"stopped by depth or weight, before the tolerance was reached: {carry}"
    return f"{carry}{missing_light(tree.bound)}"


def missing_light(bound: float) -> str:
    """The end of a sentence about rays that were cut."""
    if math.isinf(bound):
        return ", and nothing bounds the light they miss"
    return f": at most {number_text(bound)} of light is missing"


MAX_INDENT = 60  # levels that are indented: a tree of a million would be no wider than long


def _stems(tree: RayTree, shown: set[int]) -> dict[int, str]:
    """The lines that lead to each row, as a file tree has them; in a very deep tree its level instead."""
    levels = tree.nodes["depth"]
    if levels.max() > MAX_INDENT:
        return {i: f"level {levels[i]}: " for i in shown}
    stems = {0: ""}
    trunks = {0: ""}
    for i in tree.walk():
        below = [child for child in tree.children[i] if child in shown]
        for child in below:
            last = child == below[-1]
            stems[child] = trunks[i] + ("└─ " if last else "├─ ")
            trunks[child] = trunks[i] + ("   " if last else "│  ")
    return stems


def _row(tree: RayTree, i: int, stem: str) -> tuple[str, ...]:
    row = tree.nodes[i]
    kind = tree.kind(i)
    met = tree.object_name(i) or ""
    shadow = row["kind"] == SHADOW
    if shadow:
        kind = f"shadow to {tree.light_name(i)}"
    return (
        f"{stem}{i} {kind}",
        met or ("background" if tree.end(i) == "background" else ""),
        number_text(row["t"], row["error"]),
        "" if shadow else _pair(number_text(row["n1"]), number_text(row["n2"])),
        "" if shadow else _pair(degrees_text(row["theta1"], row["turn"]), degrees_text(row["theta2"], row["turn"])),
        rgb_text(row["weight"], same=True),
        rgb_text(row["radiance"]),
        end_reason(tree, i),
    )


def end_reason(tree: RayTree, i: int) -> str:
    """Why nothing follows ray i, or what becomes of a shadow ray."""
    return "adds nothing: the surface faces away" if tree.faces_away(i) else END_REASONS[tree.end(i)]


def _pair(first: str, second: str) -> str:
    return f"{first} → {second}" if first and second else first


def number_text(x: float, error: float = 0.0) -> str:
    """Five digits, or as many as the error has left: "?" for none; nothing for what is absent."""
    if math.isnan(x):
        return ""
    digits = 5 if x == 0.0 else min(5, significant_digits(abs(x), error))
    return f"{x:.{digits}g}" if digits > 0 else "?"


def degrees_text(radians: float, error: float = 0.0) -> str:
    """Two decimals, or as many as the error has left: "?" where none of its digits is."""
    if math.isnan(radians):
        return ""
    decimals = min(2, degree_decimals(error))
    return f"{math.degrees(radians):.{decimals}f}°" if decimals >= 0 else "?"


def significant_digits(size: float, error: float) -> int:
    """How many digits of a number of this size an error of that size leaves, of the 17 that a float may have."""
    if not error > 0.0:
        return 17
    return max(0, math.floor(math.log10(size / error))) if error < size else 0


def degree_decimals(turn: float) -> int:
    """How many decimals of an angle in degrees an error in radians leaves; -1 where not even the degrees are sure."""
    wrong = math.degrees(turn)
    return significant_digits(1.0, wrong) if wrong < 1.0 else -1


def rgb_text(rgb: Sequence[float] | np.ndarray, same: bool = False) -> str:
    """Three numbers, or with `same` one where all are equal."""
    if same and rgb[0] == rgb[1] == rgb[2]:
        return f"{rgb[0]:.4g}"
    return " ".join(f"{x:.4f}" for x in rgb)
