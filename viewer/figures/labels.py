"""Names and numbers in figures, the same in all of them.

A ray has a letter and a number, like R3: R for reflected, T for transmitted, and E for the ray from the eye. A ray to a
light has an L, as in Whitted's figure (CACM 23(6), 1980), and the light's name.
"""

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES
from viewer.base.wording import format_number
from viewer.explain.fate import ray_fate

LONGEST = 13  # characters of the label of a shadow ray

# Texts under a leaf, short enough for a slide.
CUTS = {"depth": "cut: depth", "weight": "cut: weight", "tolerance": "cut: tolerance", "nodes": "cut: limit"}
ENDS = {"surface": "opaque", "background": "", "invalid": "no direction", **CUTS}


def ray_label(tree: RayTree, i: int) -> str:
    """The label of ray i; of a shadow ray only its light, since the ray that it starts from is seen."""
    if tree.nodes["kind"][i] != SHADOW:
        return tree.label(i)
    label = tree.light_label(i)
    return label if len(label) <= LONGEST else f"{label[: LONGEST - 2].rstrip()}…)"


def factor_label(tree: RayTree, i: int) -> str:
    """The factor of a ray: the largest component if they differ."""
    return f"× {format_number(float(tree.nodes['factor'][i].max()), 3)}"


def hit_label(tree: RayTree, i: int) -> str:
    return tree.object_name(i) or "background"


def end_label(tree: RayTree, i: int) -> str:
    return ENDS.get(tree.end(i) or "", "")


def ray_title(tree: RayTree, i: int) -> str:
    """A sentence about a ray, shown when the mouse points at it."""
    row = tree.nodes[i]
    what, fate = f"{tree.label(i)}: {STYLES[tree.kind(i)].label}", ray_fate(tree, i)
    if row["kind"] == SHADOW:
        return f"{what} to {tree.light_name(i)}, {fate}"
    return f"{what}, {fate}, weight {format_number(float(row['weight'].max()), 3)}"


def hit_row(tree: RayTree, asked: str | None) -> int:
    """The row of a hit that was asked for by its ray's path (TR) or label (R3); without a request, the first.
    ValueError with a message for the user.
    """
    hits = [i for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW and tree.object_name(i)]
    if not hits:
        raise ValueError("--figure hit: the ray meets no surface")
    if asked is None:
        return 0
    for i in hits:
        if asked.upper() in (tree.path(i), tree.label(i)):
            return i
    known = ", ".join(f"{tree.path(i)} ({tree.label(i)})" if i else tree.path(i) for i in hits[:12])
    more = " ..." if len(hits) > 12 else ""
    raise ValueError(f"--node {asked} must be the path or the label of a ray that meets a surface: {known}{more}")
