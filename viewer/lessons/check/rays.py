"""Faults of a step that its rays show: a pixel outside the image, an expectation that fails, a value of a ray that is
not there. A step with a sweep is looked at with the rays at both of its ends.
"""

from collections.abc import Iterator, Sequence

from tracer import fields
from tracer.formats.source import Fault
from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.theme import LIGHT
from viewer.figures.export_options import TEXT_SIZE
from viewer.figures.marks import HEIGHT, WIDTH
from viewer.lessons.check.goals import Possible
from viewer.lessons.check.presses import press_faults
from viewer.lessons.expectation import conditions, failures
from viewer.lessons.image_place import pixel_fault, pixel_tree
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.step import Part, State, Step
from viewer.lessons.text import Run, inlines, names_of_values
from viewer.lessons.values import ABSENT, NAMES, OF_TREE, split_name, value_text

AT_END = "at the end of the sweep "


class StepRays:
    """The rays of a step in its scene. `world` is that of its beginning."""

    def __init__(self, step: Step, world: World) -> None:
        self.step, self.world = step, world

    def faults(self, end: World | None) -> Iterator[Fault]:
        """All of them. `end` is the scene at the end of the step's sweep, None if it cannot be prepared; the same as
        at its beginning without a sweep.
        """
        step, state = self.step, self.step.state
        scene, tracing = self.world.scene, self.world.scene.tracing
        depth, model = tracing.depth if state.depth is None else state.depth, state.model or tracing.model
        for name, fault in Possible(scene, depth, model).faults(state.goal):
            yield Fault(f"goal: {fault}", step.line_of(name, "goal"))
        if state.pixel is None:
            yield from self._without_pixel()
            return
        tree, faults = self._tree(state, self.world)
        yield from faults
        if tree is None:
            return
        if state.hit and tree.find(state.hit) is None:
            yield Fault(f"hit must be a ray of this pixel ({_paths(tree)}), got {state.hit}", step.line_of("hit"))
            return
        for name, fault in failures(state.expect, tree, state.hit):
            yield Fault(f"expect: {fault}", step.line_of(name, "expect"))
        if state.goal and all(condition.holds for condition in conditions(state.goal, tree, state.hit)):
            yield Fault("goal: it is reached at this pixel already", step.line_of("goal"))
        first, later = (step.parts[:1], step.parts[1:]) if state.sweep else (step.parts, ())
        found = [*self._values(first, tree), *self._links(first, tree), *self._live(first, tree, self.world)]
        yield from found
        yield from press_faults(step, self.world, tree)
        if state.sweep and end:
            yield from self._at_end(end, first, later, {fault.line for fault in found})

    def _without_pixel(self) -> Iterator[Fault]:
        """What needs the rays of a pixel."""
        step, state = self.step, self.step.state
        for key in ("hit", "expect"):
            if getattr(state, key):
                yield Fault(f"{key}: the step has no pixel", step.line_of(key))
        if state.sweep and state.sweep.expect:
            yield Fault("sweep: expect: the step has no pixel", step.line_of("sweep"))
        for part in step.parts:
            yield from (
                Fault(f"{{{name}}}: the step has no pixel", line) for line, name in names_of_values(part.blocks)
            )
            yield from (Fault(f"link #{ray}: the step has no pixel", line) for line, ray in _rays_of_links(part))
        yield from self._live(step.parts, None, self.world)

    def _tree(self, state: State, world: World, before: str = "") -> tuple[RayTree | None, list[Fault]]:
        """The tree of a state, and the faults if it has none."""
        assert state.pixel
        image = world.scene.image
        if fault := pixel_fault((image.width, image.height), state.pixel):
            return None, [Fault(f"{before}{fault}", self.step.line_of(*["sweep"] * bool(before), "pixel"))]
        try:
            return pixel_tree(world, state), []
        except ValueError as error:
            return None, [Fault(str(error), self.step.line_of("sample"))]

    def _at_end(
        self, world: World, first: Sequence[Part], later: Sequence[Part], told: set[int | None]
    ) -> Iterator[Fault]:
        """Faults at the end of the sweep, but for those of lines that are `told` already. Only a link in the first part
        may be about a ray that is gone then: that may be what the sweep shows.
        """
        state = self.step.state.swept(1.0)
        assert state.sweep
        tree, faults = self._tree(state, world, "sweep: ")
        yield from faults
        if tree is None:
            return
        for _, fault in failures(state.sweep.expect, tree, state.hit):
            yield Fault(f"sweep: expect: {fault}", self.step.line_of("sweep"))
        both = [*self._values(first, tree, AT_END), *self._live(first, tree, world, AT_END)]
        yield from (fault for fault in both if fault.line not in told)
        yield from self._values(later, tree, AT_END)
        yield from self._links(later, tree, AT_END)
        yield from self._live(later, tree, world, AT_END)

    def _values(self, parts: Sequence[Part], tree: RayTree, when: str = "") -> Iterator[Fault]:
        """Values that resolve to nothing."""
        for line, name in (found for part in parts for found in names_of_values(part.blocks)):
            path, quantity = split_name(name)
            found = value_text(tree, self.step.state.hit, name)
            if found is None:
                hint = fields.hint(quantity, (*NAMES, *OF_TREE))
                yield Fault(f'{{{name}}}: unknown value "{quantity}"{hint}', line)
            elif path and tree.find(path) is None:
                yield Fault(f"{{{name}}}: {when}this pixel has no ray {path} ({_paths(tree)})", line)
            elif found == ABSENT:
                yield Fault(f"{{{name}}}: {when}this hit has no such number", line)

    def _links(self, parts: Sequence[Part], tree: RayTree, when: str = "") -> Iterator[Fault]:
        """Links to rays that are not there."""
        for line, ray in (found for part in parts for found in _rays_of_links(part)):
            if tree.find(ray) is None:
                yield Fault(f"link #{ray}: {when}this pixel has no such ray ({_paths(tree)})", line)

    def _live(self, parts: Sequence[Part], tree: RayTree | None, world: World, when: str = "") -> Iterator[Fault]:
        """Live pieces that are not known, and those that this hit cannot serve."""
        row = (tree.find(self.step.state.hit) if tree and self.step.state.hit else 0) or 0
        for fence in (fence for part in parts for fence in part.live):
            name, *words = fence.content.split() or [""]
            try:
                context = LiveContext(tree, row, world, LIGHT, TEXT_SIZE, (0.0, 0.0, WIDTH, HEIGHT))
                live_kind(name).marks(context, {}, words)
            except ValueError as error:
                yield Fault(f"live: {when}{error}", fence.line + 1)


def _rays_of_links(part: Part) -> Iterator[tuple[int, str]]:
    """(line, path of the ray) of each link to a ray."""
    for line, item in inlines(part.blocks):
        if isinstance(item, Run) and item.ray is not None:
            yield line, item.ray


def _paths(tree: RayTree) -> str:
    """The rays of a tree, for a message."""
    paths = [tree.path(i) for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW]
    return "it has " + ", ".join(paths[:12]) + (" ..." if len(paths) > 12 else "")
