"""What is said of pictures for readers who cannot see them."""

from collections.abc import Sequence

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_angle, format_color, format_number
from viewer.explain.fate import ray_fate
from viewer.explain.scattering import direction_error
from viewer.figures.labels import ray_title
from viewer.figures.marks import Formula, Mark, Text
from viewer.figures.pages import description
from viewer.figures.steps import Step

MOST_ADDED = 3  # rays that a stage adds and that are described one by one
SCALES = ("axis", "grid", "bars")  # marks of plots whose texts say nothing alone


def of_tree(step: Step) -> str:
    """All rays of a step: how many of which kind, and the colour."""
    tree, shown = step.tree, len(step.rows)
    if shown == len(tree):
        return description(tree)
    return f"{shown} of {len(tree)} rays are shown. {of_stage(step)}"


def of_stage(step: Step) -> str:
    """What a step adds: rays, or the sum at a hit."""
    tree, hit = step.tree, step.sum
    if hit is not None:
        row = tree.nodes[hit]
        return f"{tree.label(hit)}: the sum at its hit is {format_color(row['radiance'], row['radiance_error'])}"
    added = sorted(step.current)
    if not added:
        return "all rays"
    words = "; ".join(ray_title(tree, i) for i in added[:MOST_ADDED])
    more = len(added) - MOST_ADDED
    return f"{words}; and {more} more" if more > 0 else words


def of_hit(tree: RayTree, row: int) -> str:
    """One hit: the surface, the media, the angles, and the rays that it sends out."""
    node, label = tree.nodes[row], tree.label(row)
    if not tree.object_name(row):
        return f"{label} {ray_fate(tree, row)}."
    turn = direction_error(tree, row)
    found = f"{label} meets {tree.object_name(row)} at {format_angle(float(node['theta1']), turn)} from the normal"
    n2 = float(node["n2"])
    if n2 == n2:  # it is transparent
        found += f", from a medium of index {format_number(float(node['n1']))} to one of {format_number(n2)}"
    sent = []
    for child in tree.children[row]:
        below = tree.nodes[child]
        if below["kind"] == SHADOW:
            continue
        share = f"factor {format_number(float(below['factor'].max()), 3)}"
        if tree.kind(child) == "refraction":
            sent.append(f"{tree.label(child)} is refracted at {format_angle(float(node['theta2']), turn)}, {share}")
        else:
            how = "is reflected totally" if tree.kind(child) == "tir" else "is reflected"
            sent.append(f"{tree.label(child)} {how}, {share}")
    return ". ".join([found, *sent]) + "."


def angles(tree: RayTree, row: int) -> str:
    """The angles at a hit, to follow something else; nothing where a ray meets nothing."""
    node, turn = tree.nodes[row], direction_error(tree, row)
    named = (("θ₁", float(node["theta1"])), ("θ₂", float(node["theta2"])))
    return "".join(f"; {name} = {format_angle(x, turn)}" for name, x in named if x == x)


def of_marks(title: str, marks: Sequence[Mark]) -> str:
    """A picture made of marks: the texts in it, without the numbers on the axes."""
    words = []
    for mark in marks:
        if isinstance(mark, Text) and mark.name not in SCALES:
            words.append(mark.content)
        elif isinstance(mark, Formula):
            words.append(mark.plain)
    return f"{title}: {'; '.join(dict.fromkeys(word for word in words if word))}."
