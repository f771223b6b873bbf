"""Everything that is wrong with a lesson, each with its line: what can be said without a window."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import tracer
from tracer import fields
from tracer.formats.source import Fault
from tracer.formulas.sampler import sample_number
from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.printable import shown_path
from tracer.tree.raytree import RayTree
from viewer.base.files import Unusable
from viewer.base.theme import LIGHT
from viewer.explain.listing import listing
from viewer.explain.plain_formula import FormulaError
from viewer.figures.export_options import TEXT_SIZE
from viewer.figures.formula.typeset import typeset
from viewer.figures.marks import HEIGHT, WIDTH
from viewer.figures.steps import adding, by_ray
from viewer.lessons.expectation import conditions, failures
from viewer.lessons.image_place import pixel_fault, pixel_tree
from viewer.lessons.language import translations
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.step import DEPTH, RAYS, Part, Step
from viewer.lessons.text import (
    Block,
    Formula,
    InlineFormula,
    Items,
    Quote,
    Run,
    count_words,
    fences,
    inlines,
    names_of_values,
)
from viewer.lessons.values import ABSENT, NAMES, OF_TREE, split_name, value_text

MOST_AT_ONCE, MOST_WORDS = 40, 90  # words between two presses, and in a step


def check(path: Path) -> list[str]:
    """The faults of a lesson.md and of its translations, one line each, in the order of each file."""
    place = shown_path(path)
    try:
        lesson = read_file(path, ())
    except Unusable as unusable:
        return list(unusable.faults)
    faults = _sorted(_Check(lesson).faults(), place)
    is_sound = not faults  # otherwise a translation has the same faults
    for language, file in translations(path).items():
        try:
            translated = read_file(path, [language])
        except Unusable as unusable:
            faults += unusable.faults
        else:
            faults += _sorted(_Check(translated).faults(), shown_path(file)) if is_sound else []
    return faults


def _sorted(found: Iterator[Fault], place: str) -> list[str]:
    return [fault.within(place) for fault in sorted(found, key=lambda fault: fault.line or 0)]


class _Check:
    def __init__(self, lesson: Lesson) -> None:
        self.lesson = lesson
        self.worlds: list[tuple[tuple[Path, Mapping[str, Any]], World | None]] = []

    def faults(self) -> Iterator[Fault]:
        if not self.lesson.question:
            yield Fault('question is missing: a lesson begins with one, like question = "Why is it dark?"', 2)
        for step in self.lesson.steps:
            yield from self._words(step)
            yield from self._formulas(step)
            yield from self._sources(step)
            world, faults = self._world(step)
            yield from faults
            if world:
                yield from self._rays(step, world)
                yield from self._sweep(step)

    def _world(self, step: Step, share: float = 0.0) -> tuple[World | None, list[Fault]]:
        """The step's scene at this share of its sweep, and its faults if this step is the first that shows it."""
        changes = step.state.swept(share).set
        key = (step.scene, changes)
        for known, world in self.worlds:
            if known == key:
                return world, []
        world, faults = None, list[Fault]()
        try:
            world = tracer.prepare(tracer.load(step.scene, changes=changes))
        except tracer.SceneError as error:
            line = step.line_of(*["sweep"] * bool(step.state.sweep), *["set"] * bool(changes), "scene")
            faults = [Fault(fault, line) for fault in error.faults]
        self.worlds.append((key, world))
        return world, faults

    def _words(self, step: Step) -> Iterator[Fault]:
        counts = [count_words(part.blocks) for part in step.parts]
        for part, count in zip(step.parts, counts, strict=True):
            if count > MOST_AT_ONCE:
                line = part.blocks[0].line
                yield Fault(f"{count} words appear at once; at most {MOST_AT_ONCE} are allowed: hide some by ???", line)
        if sum(counts) > MOST_WORDS:
            yield Fault(f"{sum(counts)} words in a step; at most {MOST_WORDS} are allowed", step.line)

    def _formulas(self, step: Step) -> Iterator[Fault]:
        for line, source in _formulas_of(block for part in step.parts for block in part.blocks):
            try:
                typeset(source)
            except FormulaError as error:
                yield Fault(str(error), line)

    def _sources(self, step: Step) -> Iterator[Fault]:
        """Source text of functions that are not there."""
        for fence in (fence for part in step.parts for fence in fences(part.blocks) if fence.kind == "source"):
            try:
                listing(fence.argument)
            except ValueError as error:
                yield Fault(f"source: {error}", fence.line)
            if fence.content.strip():
                yield Fault("source: the block must be empty, its text is that of the function", fence.line + 1)

    def _rays(self, step: Step, world: World) -> Iterator[Fault]:
        """What is wrong about the pixel and its rays."""
        state, image = step.state, world.scene.image
        if state.pixel is None:
            yield from (Fault(f"{{{name}}}: the step has no pixel", line) for line, name in _values(step))
            return
        if fault := pixel_fault((image.width, image.height), state.pixel):
            yield Fault(fault, step.line_of("pixel"))
            return
        try:
            sample_number(image.samples, state.sample)
        except ValueError as error:
            yield Fault(str(error), step.line_of("sample"))
            return
        tree = pixel_tree(world, state)
        if state.hit and tree.find(state.hit) is None:
            yield Fault(f"hit must be a ray of this pixel ({_paths(tree)}), got {state.hit}", step.line_of("hit"))
            return
        for key, fault in failures(state.expect, tree, state.hit):
            yield Fault(f"expect: {fault}", step.line_of(key, "expect"))
        for key, fault in failures(state.goal, tree, state.hit):
            if "unknown name" in fault or "in quotes" in fault:  # a goal is reached elsewhere
                yield Fault(f"goal: {fault}", step.line_of(key, "goal"))
        if state.goal and all(condition.holds for condition in conditions(state.goal, tree, state.hit)):
            yield Fault("goal: it is reached at this pixel already", step.line_of("goal"))
        yield from self._text(step, tree, step.parts[:1] if state.sweep else step.parts)
        yield from self._live(step, tree, world)
        yield from _presses(step, world, tree)

    def _live(self, step: Step, tree: RayTree, world: World) -> Iterator[Fault]:
        """Live pieces that are not known, and those that this hit cannot serve."""
        row = (tree.find(step.state.hit) if step.state.hit else 0) or 0
        for fence in (fence for part in step.parts for fence in part.live):
            name, *words = fence.content.split() or [""]
            try:
                context = LiveContext(tree, row, world, LIGHT, TEXT_SIZE, (0.0, 0.0, WIDTH, HEIGHT))
                live_kind(name).marks(context, {}, words)
            except ValueError as error:
                yield Fault(f"live: {error}", fence.line + 1)

    def _text(self, step: Step, tree: RayTree, parts: Sequence[Part]) -> Iterator[Fault]:
        """Values and links of these parts that resolve to nothing."""
        for line, name in (value for part in parts for value in names_of_values(part.blocks)):
            path, quantity = split_name(name)
            found = value_text(tree, step.state.hit, name)
            if found is None:
                hint = fields.hint(quantity, (*NAMES, *OF_TREE))
                yield Fault(f'{{{name}}}: unknown value "{quantity}"{hint}', line)
            elif path and tree.find(path) is None:
                yield Fault(f"{{{name}}}: this pixel has no ray {path} ({_paths(tree)})", line)
            elif found == ABSENT:
                yield Fault(f"{{{name}}}: this hit has no such number", line)
        for part in parts:
            for line, item in inlines(part.blocks):
                if isinstance(item, Run) and item.ray is not None and tree.find(item.ray) is None:
                    yield Fault(f"link #{item.ray}: this pixel has no such ray ({_paths(tree)})", line)

    def _sweep(self, step: Step) -> Iterator[Fault]:
        """What is wrong at the end of a sweep: its beginning is the step's own state."""
        state, line = step.state.swept(1.0), step.line_of("sweep")
        if not state.sweep:
            return
        world, faults = self._world(step, 1.0)
        yield from (Fault(str(fault), line) for fault in faults)
        if not world or state.pixel is None:
            return
        image = world.scene.image
        if fault := pixel_fault((image.width, image.height), state.pixel):
            yield Fault(f"sweep: {fault}", line)
            return
        try:
            tree = pixel_tree(world, state)
        except ValueError:
            return  # the sample: it is said of the step
        for _, fault in failures(state.sweep.expect, tree, state.hit):
            yield Fault(f"sweep: expect: {fault}", line)
        yield from self._text(step, tree, step.parts[1:])  # they appear at its end


def _presses(step: Step, world: World, tree: RayTree) -> Iterator[Fault]:
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


def _values(step: Step) -> Iterator[tuple[int, str]]:
    for part in step.parts:
        yield from names_of_values(part.blocks)


def _paths(tree: RayTree) -> str:
    """The rays of a tree, for a message."""
    paths = [tree.path(i) for i in range(len(tree)) if tree.nodes["kind"][i] != SHADOW]
    return "it has " + ", ".join(paths[:12]) + (" ..." if len(paths) > 12 else "")


def _formulas_of(blocks: Iterator[Block]) -> Iterator[tuple[int, str]]:
    """(line, source) of all formulas."""
    for block in blocks:
        match block:
            case Formula():
                yield block.line, block.source
            case Items():
                yield from _formulas_of(inner for item in block.items for inner in item)
            case Quote():
                yield from _formulas_of(iter(block.blocks))
            case _:
                yield from ((line, item.source) for line, item in inlines([block]) if isinstance(item, InlineFormula))
