"""`raytree export`: a pixel's ray tree as figures and as data, page by page, into a file or a folder."""

import math
import shlex
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import tracer
from tracer.kernel.world import World
from viewer.base.files import Unusable, every, write_atomically
from viewer.base.orbit import STEEPEST, Frame, Orbit, home
from viewer.base.progress import Progress
from viewer.base.theme import THEMES
from viewer.cli.commands import compile_once, faults, find, prepared
from viewer.figures.figure.hit import node_of
from viewer.figures.figure.pages import TEXT_SIZE, TREES, Subject, Wishes, pages, wanted
from viewer.figures.formats import FORMATS
from viewer.figures.layout.tree_plan import fitting_size
from viewer.figures.marks import Figure, Text
from viewer.figures.steps import Stage, by_colour, by_depth, by_ray, without_lights
from viewer.figures.targets import Target, check_pages, chosen, grouped, mark_of, stem_of
from viewer.figures.writers.png import PIXELS
from viewer.lessons.lesson import Lesson, LessonView

FARTHER = 1.8  # times a lesson's distance, at most, from which the eye is to be seen as well


# What is said of a figure, and the figures that it says something of.
APPLIES = {
    "node": ("hit",),
    "view": ("scene", "both"),
    "swatches": ("tree", "both"),
    "fold": ("tree", "both"),
    "eye": ("tree", "both"),
}


@dataclass(frozen=True)
class Made:
    """Files with what goes into them, and what is to be said of them."""

    files: list[tuple[Path, bytes]]
    notes: list[str]

    def write(self) -> None:
        for file, content in self.files:
            file.parent.mkdir(exist_ok=True)
            write_atomically(file, content)


def export(options: Namespace) -> int:
    (path, lesson), (target, formats), _ = every(
        lambda: find(options.scene), lambda: chosen(options), lambda: check_options(options)
    )
    options.pixel = options.pixel or (lesson.pixel if lesson and not options.ray else None)
    if not options.pixel and not options.ray:
        raise Unusable("raytree export: which pixel? --pixel X,Y, or --ray ox,oy,oz,dx,dy,dz")
    compile_once()
    with faults():
        world = prepared(path)
        with Progress("export") as progress:
            made = make(options, world, lesson, target, formats, progress)
            made.write()
            for note in made.notes:
                progress.put(f"note: {note}")
    for file, _ in made.files:
        print(file)
    return 0


def check_options(options: Namespace) -> None:
    """Unusable where an option says nothing of what is asked for."""
    found = []
    if options.step != "depth" and options.depth and len(options.depth) > 1:
        found.append(f"raytree export: --step {options.step} goes through one tree: give one depth")
    if options.step != "depth" and options.figure == "hit":
        found.append(f"raytree export: a hit has no steps: --step {options.step} is for tree, scene and both")
    for name, figures in APPLIES.items():
        if getattr(options, name) and options.figure not in figures:
            found.append(f"raytree export: --{name} is for --figure {' and '.join(figures)}, got {options.figure}")
    if found:
        raise Unusable(*found)


def make(
    options: Namespace,
    world: World,
    lesson: Lesson | None,
    target: Target,
    formats: list[str],
    progress: Callable[[float], None] = lambda share: None,
) -> Made:
    """What these options ask for, of a scene that is there already."""
    own = lesson.depth if lesson and lesson.depth is not None else world.scene.tracing.depth
    depths = options.depth or range(own, own + 1)
    stages = steps(world, options, depths)
    check_pages(target, formats, stages)
    subject = Subject(stages, world, view_of(options.view, world, lesson))
    wishes = wishes_of(options, stages)
    stem = stem_of(options, lesson)
    drawn = pages(options.figure, subject, wishes) if any(FORMATS[name].write for name in formats) else []
    notes = notes_on(drawn, options.figure, subject, wishes)
    files: list[tuple[Path, bytes]] = []
    for name in formats:
        kind = FORMATS[name]
        figures = [replace(page, command=command(options, name)) for page in drawn]
        notes += letters_missing(drawn, name)
        for k, group in enumerate(grouped(kind, stages, options.step)):
            progress(len(files) / (len(formats) * len(stages)))
            if kind.write:
                mark = mark_of(group, stages, options.step, depths)
                content = kind.write(figures if kind.many_pages else figures[k : k + 1], options.width or PIXELS)
                files.append((target.file(f"{stem}_{options.figure}_{mark}", kind.suffix), content))
            else:
                assert kind.data
                tree = group[-1].tree
                files.append((target.file(f"{stem}_d{tree.depth}", kind.suffix), kind.data(tree).encode("utf-8")))
    return Made(files, notes)


def wishes_of(options: Namespace, stages: Sequence[Stage]) -> Wishes:
    return Wishes(
        THEMES[options.theme],
        options.text_size,
        swatches=options.swatches or options.step == "colour",  # else nothing would flow
        fold=options.fold,
        ground=options.ground,
        node=node_of(stages[-1].tree, options.node) if options.figure == "hit" else 0,
        eye=options.eye or "top",
        lights=not options.no_lights,
    )


def notes_on(drawn: Sequence[Figure], figure: str, subject: Subject, wishes: Wishes) -> list[str]:
    """Branches for which there was no room."""
    if wishes.fold or not any(mark.name.startswith("fold-") for page in drawn for mark in page.marks):
        return []
    size = fitting_size([stage.tree for stage in subject.stages], wanted(wishes, TREES[figure]))
    helps = f", --text-size {size:g} all of them" if size else ""
    return [f"{figure}: branches are folded for want of room; a smaller --depth leaves some out{helps}"]


def letters_missing(drawn: Sequence[Figure], format_name: str) -> list[str]:
    """Letters that a format cannot show, each once."""
    words = "".join(mark.content for page in drawn for mark in page.marks if isinstance(mark, Text))
    missing = "".join(letter for letter in dict.fromkeys(words) if not FORMATS[format_name].has(letter))
    return [f'{format_name} has no letter for "{missing}": svg and pptx leave it to the reader'] if missing else []


def view_of(numbers: tuple[float, ...] | None, world: World, lesson: Lesson | None) -> Orbit:
    """From where the scene is seen: azimuth, elevation, distance and target as asked.

    Else as the viewer begins, and as much farther away as it takes to see the eye that the rays come from, if not much.
    """
    frame = Frame.of(world)
    if numbers is None:
        orbit = home(world, frame, lesson.view if lesson else None)
        nearest = orbit.distance
        orbit.take_in(frame.inside(world.view().eye)[None])
        if orbit.distance > FARTHER * nearest:  # too far off: what the figure is about would be small
            orbit.distance = nearest
        return orbit
    azimuth, elevation, distance, *target = numbers
    steep = math.degrees(STEEPEST)
    return home(world, frame, LessonView(azimuth, min(steep, max(-steep, elevation)), distance, tuple(target) or None))  # type: ignore[arg-type]


def steps(world: World, options: Namespace, depths: range) -> list[Stage]:
    """The pages, of trees that are whole."""
    ray = (options.ray[:3], options.ray[3:]) if options.ray else None
    how = {"size": options.size, "min_weight": options.min_weight, "model": options.model}
    trees = [tracer.trace(world, options.pixel, ray, depth=depth, **how) for depth in depths]
    if options.step == "rays":
        stages = by_ray(trees[-1])
    elif options.step == "colour":
        stages = by_colour(trees[-1])
    else:
        stages = by_depth(trees)
    return without_lights(stages) if options.no_lights else stages


def command(options: Namespace, format_name: str) -> str:
    """What makes the same figure again, but for where it is written."""
    words = ["raytree", "export", options.scene]
    if options.pixel:
        words += ["--pixel", f"{options.pixel[0]},{options.pixel[1]}"]
    else:
        words += ["--ray", ",".join(repr(x) for x in options.ray)]
    words += ["--figure", options.figure]
    if options.node:
        words += ["--node", options.node]
    if options.depth:
        first, last = options.depth[0], options.depth[-1]
        words += ["--depth", str(first) if first == last else f"{first}..{last}"]
    if options.view:
        words += ["--view", ",".join(repr(x) for x in options.view)]
    if options.step != "depth":
        words += ["--step", options.step]
    if options.model:
        words += ["--model", options.model]
    if options.min_weight:
        words += ["--min-weight", repr(options.min_weight)]
    if options.size:
        words += ["--size", f"{options.size[0]}x{options.size[1]}"]
    words += ["--theme", options.theme]
    if options.swatches:
        words.append("--swatches")
    if options.eye:
        words += ["--eye", options.eye]
    if options.no_lights:
        words.append("--no-lights")
    if options.ground:
        words.append("--ground")
    if options.fold:
        words += ["--fold", repr(options.fold)]
    if options.text_size != TEXT_SIZE:
        words += ["--text-size", repr(options.text_size)]
    words += ["--format", format_name]
    if format_name == "png" and options.width:
        words += ["--width", str(options.width)]
    return shlex.join(words)
