"""Presses of the key that change nothing."""

from collections.abc import Iterator

from tracer.formats.source import Fault
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.figures.steps import adding, by_ray
from viewer.lessons.image_place import pixel_tree
from viewer.lessons.step import DEPTH, RAYS, Step


def press_faults(step: Step, world: World, tree: RayTree) -> Iterator[Fault]:
    """Presses of the key that change nothing. `tree` is the step's."""
    state = step.state
    if state.sweep and state.sweep.start == state.sweep.end:
        yield Fault("sweep: it ends where it begins", step.line_of("sweep"))
    if state.reveal == RAYS and len(adding(by_ray(tree), set(state.show))) == 1:
        yield Fault("reveal: no ray of the kinds in `show` follows the first", step.line_of("reveal"))
    if state.reveal == DEPTH and not {"image", "scene"} & set(state.panels):
        sizes = [len(pixel_tree(world, state, depth)) for depth in range(tree.depth + 1)]
        same = (depth for depth in range(1, len(sizes)) if sizes[depth] == sizes[depth - 1])
        yield from (
            Fault(f"reveal: depth {d} adds no ray to the tree of this pixel", step.line_of("reveal")) for d in same
        )
    for part in step.parts[1:]:
        if not part.blocks:
            yield Fault("??? hides nothing: nothing follows it", step.line)
