"""Makes the pages of a lesson: traces its steps, and finds the frames of their pictures."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import tracer
from tracer.formats.source import Fault
from tracer.kernel.world import World
from tracer.printable import shown_path
from tracer.tree.raytree import RayTree
from viewer.base.files import Unusable
from viewer.base.orbit import Frame as SceneFrame, initial_orbit
from viewer.base.wording import format_number
from viewer.explain.listing import listing
from viewer.figures import steps as ray_steps
from viewer.handout.document import Control, Handout, Page, PagePart, Photo, Show, Shown
from viewer.handout.live import live_show
from viewer.handout.pictures import KINDS, Frame, Frames, Scenery, picture
from viewer.handout.sentences import angles, of_stage
from viewer.handout.sweeps import Position, positions
from viewer.lessons.expectation import conditions
from viewer.lessons.image_place import pixel_fault, pixel_tree
from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import stages_of
from viewer.lessons.scenes import SceneFaults, StepScenes
from viewer.lessons.step import COLOUR, DEPTH, RAYS, State, Step
from viewer.lessons.text import Block, Fence, Items, Paragraph, Run, filled
from viewer.lessons.values import ABSENT, value_text

STAGES = {DEPTH: "Depth", RAYS: "Ray by ray", COLOUR: "Sum by sum"}  # titles of controls
SWEEP = "sweep"


def read_handout(lesson: Lesson, progress: Callable[[float], None] = lambda share: None) -> Handout:
    """The pages of a lesson. Unusable if a step asks for what its scene does not have."""
    reader = _Reader()
    pages = []
    for k, step in enumerate(lesson.steps):
        pages.append(reader.page(k + 1, step, lesson))
        progress((k + 1) / len(lesson.steps))
    return Handout(lesson, tuple(pages))


class _Reader:
    """Scenes, views of them and images are made once for all steps that show them."""

    def __init__(self) -> None:
        self._scenes = StepScenes()
        self._sceneries: list[tuple[World, Any, Scenery]] = []
        self._images: dict[tuple[int, int, str], tuple[World, np.ndarray]] = {}
        self._seen: tuple | None = None  # the image and the pixel of the step before

    def page(self, number: int, step: Step, lesson: Lesson) -> Page:
        state, swept = step.state.swept(0.0), list[Position]()
        world = self._world(lesson, step)
        trees = self._trees(step, state, world, lesson)
        if trees and state.sweep:
            swept = positions(step, state.sweep, lambda share: self._world(lesson, step, share))
        parts = []
        pieces = sum(len(part.live) for one in lesson.steps for part in one.parts)
        for k, part in enumerate(step.parts):
            shown = Shown(trees[-1] if trees else None, world)
            if swept and k:
                shown = Shown(swept[-1].tree, swept[-1].world)
            along = [Shown(at.tree, at.world) for at in swept] if k == 0 else []
            shows = {fence.line: live_show(fence, shown, state.hit, along, pieces) for fence in part.live}
            live = {line: show for line, show in shows.items() if show}
            blocks = [*_with_listings(part.blocks), *(() if k else _task(step))]
            parts.append(PagePart(filled(blocks, _values(shown.tree, state.hit)), shown, live))
        show = self._show(step, world, trees, swept) if trees else self._image_only(step, world)
        return Page(number, step, show, tuple(parts))

    def _image_only(self, step: Step, world: World) -> Show:
        """The show of a step without a pixel."""
        return Show((), 1, 0, photos=self._photos(step, world, (), ()))

    def _world(self, lesson: Lesson, step: Step, share: float = 0.0) -> World:
        """The step's scene at this share of its sweep. Unusable if it has faults."""
        try:
            return self._scenes.world(step, share)
        except SceneFaults as error:
            raise _unusable(lesson, error.faults) from None

    def _scenery(self, step: Step, world: World) -> Scenery:
        for known, view, scenery in self._sceneries:
            if known is world and view == step.state.view:
                return scenery
        scenery = Scenery(world, initial_orbit(world, SceneFrame.of(world), step.state.view))
        self._sceneries.append((world, step.state.view, scenery))
        return scenery

    def _trees(self, step: Step, state: State, world: World, lesson: Lesson) -> list[RayTree]:
        """The trees of a step's pixel: of each depth, if the step reveals these; the deepest is the last."""
        image = world.scene.image
        if state.pixel is None:
            return []
        if fault := pixel_fault((image.width, image.height), state.pixel):
            raise _unusable(lesson, [Fault(fault, step.line_of("pixel"))])
        depth = world.scene.tracing.depth if state.depth is None else state.depth
        depths = range(depth + 1) if state.reveal == DEPTH else (depth,)
        return [pixel_tree(world, state, d) for d in depths]

    def _show(self, step: Step, world: World, trees: Sequence[RayTree], swept: Sequence[Position]) -> Show:
        """The pictures of the step's panels, with the stages of its reveal or the positions of its sweep."""
        state, scenery = step.state, self._scenery(step, world)
        controls: tuple[Control, ...] = ()
        if swept and state.sweep:
            frames = []
            for k, at in enumerate(swept):
                place = scenery if at.world is world else Scenery(at.world, scenery.orbit)
                frames.append(Frame(_shown(ray_steps.whole(at.tree), state), place, k, _row(at.tree, state.hit)))
            said = tuple(f"{at.words}{angles(f.step.tree, f.hit)}" for at, f in zip(swept, frames, strict=True))
            controls = (Control(SWEEP, "Place in the image" if state.sweep.is_pixel else state.sweep.of, 0, said),)
        else:
            stages = [_shown(stage, state) for stage in _stages(step, trees)]
            frames = [Frame(stage, scenery, 0, _row(trees[-1], state.hit)) for stage in stages]
            if state.reveal and len(stages) > 1:
                said = tuple(_name(stage, state.reveal) for stage in stages)
                controls = (Control(state.reveal, STAGES[state.reveal], 0, said),)
        drawn = Frames(tuple(frames), state.hit is not None and not state.reveal, state.reveal in (RAYS, COLOUR))
        names = [name for name in state.panels if name in KINDS]
        if not names and "image" not in state.panels:
            names = ["scene"]
        pictures = tuple(picture(name, drawn) for name in names)
        photos = self._photos(step, world, trees, swept)
        if len(photos) > 1 and len(photos) != len(frames):
            photos = photos[-1:]
        shown = tuple(Shown(frame.step.tree, frame.scenery.world) for frame in frames)
        return Show(pictures, len(frames), 0, controls, shown, photos)

    def _photos(
        self, step: Step, world: World, trees: Sequence[RayTree], swept: Sequence[Position]
    ) -> tuple[Photo, ...]:
        """The rendered image, if the step asks for it, or it is not that of the step before: one for all frames, or one
        for each depth and each position of a sweep.
        """
        state, tracing = step.state.swept(0.0), world.scene.tracing
        model = state.model or tracing.model
        depths = [tree.depth for tree in trees] or [tracing.depth if state.depth is None else state.depth]
        now = (id(world), state.pixel, depths, model)
        is_new, self._seen = now != self._seen, now
        if not (is_new or swept or "image" in state.panels):
            return ()
        if swept:
            return tuple(self._photo(at.world, depths[-1], model, at.place) for at in swept)
        return tuple(self._photo(world, depth, model, state.pixel) for depth in depths)

    def _photo(self, world: World, depth: int, model: str, pixel: tuple[float, float] | None) -> Photo:
        key = (id(world), depth, model)
        if key not in self._images:
            self._images[key] = (world, tracer.render(world, depth=depth, model=model).pixels)
        pixels = self._images[key][1]
        height, width = pixels.shape[:2]
        if pixel is None:
            return Photo(pixels, None, "The image", f"{world.scene.caption}, rendered at depth {depth}.")
        ring = ((pixel[0] + 0.5) / width, (pixel[1] + 0.5) / height)
        place = ", ".join(format_number(x) for x in pixel)
        said = f"{world.scene.caption}, rendered at depth {depth}, with a ring around pixel {place}."
        return Photo(pixels, ring, "The image, with a ring around the pixel", said)


def _stages(step: Step, trees: Sequence[RayTree]) -> Sequence[ray_steps.Step]:
    """The stages of a step's reveal, the fullest last; without one, the whole tree."""
    state, tree = step.state, trees[-1]
    if state.reveal == DEPTH:
        return ray_steps.by_depth(trees)
    if state.reveal is None:
        return [ray_steps.whole(tree)]
    steps = ray_steps.by_ray(tree, lights="shadow" in state.show)
    first, *others = [steps[k] for k in stages_of(steps, state.reveal, state.show)]
    return [replace(first, current=frozenset()) if state.reveal == COLOUR else first, *others]


def _with_listings(blocks: Sequence[Block]) -> Iterator[Block]:
    """The blocks with the text of functions in blocks `source`, and the places of these."""
    for block in blocks:
        if not isinstance(block, Fence) or block.kind != "source":
            yield block
            continue
        try:
            found = listing(block.argument)
        except ValueError as error:
            yield Paragraph(block.line, (Run(str(error)),))
            continue
        yield Fence(block.line, "code", "\n".join(found.lines))
        yield Paragraph(block.line, (Run(f"{found.name}: {found.place}", italic=True),))


def _task(step: Step) -> Iterator[Block]:
    """What the step asks for: it can be done in the viewer."""
    asked = [condition.words for condition in conditions(step.state.goal, None, step.state.hit)]
    if asked:
        yield Paragraph(step.line, (Run("To reach in the viewer:", bold=True),))
        yield Items(step.line, tuple((Paragraph(step.line, (Run(words),)),) for words in asked))


def _shown(stage: ray_steps.Step, state: State) -> ray_steps.Step:
    """A stage with the kinds of rays that the step shows."""
    if not state.show:
        return replace(stage, rows=frozenset(), current=frozenset())
    return ray_steps.of_kinds(stage, {*state.show, "camera"})


def _row(tree: RayTree | None, hit: str | None) -> int:
    """The row of the hit that a step is about."""
    return (tree.find(hit) if tree and hit else None) or 0


def _unusable(lesson: Lesson, faults: Sequence[Fault]) -> Unusable:
    return Unusable(*(fault.within(shown_path(lesson.path)) for fault in faults))


def _name(stage: ray_steps.Step, reveal: str) -> str:
    """What is said of a stage."""
    return f"depth {stage.tree.depth}" if reveal == DEPTH else of_stage(stage)


def _values(tree: RayTree | None, hit: str | None) -> Callable[[str], str]:
    return lambda name: value_text(tree, hit, name) or ABSENT
