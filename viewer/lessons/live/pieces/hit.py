"""The hit in its plane of incidence, as in the figure of a hit; its handle `turn` is the angle of incidence."""

from viewer.explain.turned import turned
from viewer.figures.figure.hit import hit_marks
from viewer.figures.marks import Mark
from viewer.figures.steps import Step
from viewer.lessons.live.piece import LiveContext, Parameters


def hit(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The marks of the hit looked at, or of the same place met at the angle `turn`, in degrees."""
    tree, world, name = context.hit("hit")
    row, angle = context.row, parameters.get("turn")
    if angle is not None:
        found = turned(world, tree, row, angle)
        if found is None:
            raise ValueError(f"hit: another surface is in the way of a ray that meets {name} at {angle:g} degrees")
        tree, row = found, 0
    step = Step(tree, frozenset((row, *tree.children[row])), frozenset())
    return hit_marks(step, row, context.size, context.theme, world, context.where, angle is not None)
