"""Names and numbers in figures, the same in all of them.

A ray has a letter and a number, like R3: R for reflected, T for transmitted, and E for the ray from the eye. A ray to a
light has an L, as in Whitted's figure (CACM 23(6), 1980), and the light's name.
"""

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import STYLES
from viewer.base.wording import format_number

LONGEST = 13  # characters of the label of a shadow ray

# Texts under a leaf, short enough for a slide.
ENDS = {
    "surface": "opaque",
    "background": "",
    "depth": "cut: depth",
    "weight": "cut: weight",
    "tolerance": "cut: tolerance",
    "nodes": "cut: limit",
    "invalid": "no direction",
}


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
    style = STYLES[tree.kind(i)]
    if row["kind"] == SHADOW:
        fate = {"lit": "reaches it", "filtered": "reaches it through glass"}.get(
            tree.end(i) or "", f"is blocked by {tree.object_name(i)}"
        )
        return f"{tree.label(i)}: {style.label} to {tree.light_name(i)}, {fate}"
    weight = format_number(float(row["weight"].max()), 3)
    return f"{ray_label(tree, i)}: {style.label}, meets {hit_label(tree, i)}, weight {weight}"
