"""What becomes of a ray, in a few words: the same in the window and in figures."""

from tracer.kernel.nodes import BLOCKED, SHADOW
from tracer.tree.raytree import RayTree
from tracer.tree.text import FACES_AWAY


def ray_fate(tree: RayTree, i: int) -> str:
    """What ray i meets, and whether it adds nothing. Of a shadow ray: whether its light adds something, and what is in
    its way.
    """
    met, nothing = tree.object_name(i), _adds_nothing(tree, i)
    if tree.nodes["kind"][i] != SHADOW:
        found = f"meets {met}" if met else "meets nothing"
        return f"{found}, {nothing}" if nothing else found
    if nothing:
        return nothing
    return {"blocked": f"blocked by {met}", "filtered": f"dimmed by {met}, straight through"}.get(
        tree.end(i) or "", "nothing in its way"
    )


def _adds_nothing(tree: RayTree, i: int) -> str:
    """The reason why ray i adds no light; empty if it adds some, or if its light is blocked."""
    row = tree.nodes[i]
    if tree.faces_away(i):
        return f"{FACES_AWAY} from the light"
    if not tree.adds_nothing(i) or row["end"] == BLOCKED:
        return ""
    if not row["factor"].any():
        return "adds nothing: its factor is 0"
    if not row["weight"].any():
        return "adds nothing: its weight is 0"
    return "adds nothing: its share of the light is 0"
