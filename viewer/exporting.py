"""`raytree export`: a pixel's ray tree as figures and as data, page by page, into a file or a folder."""

import math
import shlex
from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import tracer
from tracer.world import World
from viewer.commands import compile_once, faults, find, prepared
from viewer.figures.figure import TEXT_SIZE, Subject, Wishes, pages
from viewer.figures.formats import FORMATS, Format, format_of
from viewer.figures.png import PIXELS
from viewer.figures.stage import Stage, by_colour, by_depth, by_ray
from viewer.files import Unusable, check_writable, write_atomically
from viewer.lesson import Lesson, LessonView
from viewer.orbit import STEEPEST, Frame, Orbit, home
from viewer.progress import Progress
from viewer.theme import THEMES

Depths = range
FARTHER = 1.8  # times a lesson's distance, at most, from which the eye is to be seen as well


@dataclass(frozen=True)
class Target:
    """Where the files go: into a folder under names of ours, or one file."""

    path: Path
    folder: bool

    def file(self, stem: str, suffix: str) -> Path:
        return self.path / f"{stem}{suffix}" if self.folder else self.path


def export(options: Namespace) -> int:
    path, lesson = find(options.scene)
    options.pixel = options.pixel or (lesson.pixel if lesson and not options.ray else None)
    if not options.pixel and not options.ray:
        raise Unusable("raytree export: which pixel? --pixel X,Y, or --ray ox,oy,oz,dx,dy,dz")
    target, formats = chosen(options)
    if options.step != "depth" and options.depth and len(options.depth) > 1:
        raise Unusable(f"raytree export: --step {options.step} goes through one tree: give one depth")
    if options.step != "depth" and options.figure == "hit":
        raise Unusable(f"raytree export: a hit has no steps: --step {options.step} is for tree, scene and both")
    compile_once()
    with faults():
        world = prepared(path)
        with Progress("export") as progress:
            written = make(options, world, lesson, target, formats, progress)
    for file in written:
        print(file)
    return 0


def make(
    options: Namespace,
    world: World,
    lesson: Lesson | None,
    target: Target,
    formats: list[str],
    progress: Callable[[float], None] = lambda share: None,
) -> list[Path]:
    """What these options ask for, of a scene that is there already; the files that are written."""
    own = lesson.depth if lesson and lesson.depth is not None else world.scene.tracing.depth
    depths = options.depth or range(own, own + 1)
    stages = steps(world, options, depths)
    check_pages(target, formats, stages)
    subject = Subject(stages, world, view_of(options.view, world, lesson))
    theme = THEMES[options.theme]
    swatches = options.swatches or options.step == "colour"  # else nothing would flow
    wishes = Wishes(theme, options.text_size, swatches, options.fold, options.ground, options.node, options.eye)
    stem = stem_of(options, lesson)
    files: list[tuple[Path, bytes]] = []
    for name in formats:
        kind = FORMATS[name]
        figures = pages(options.figure, subject, wishes, command(options, name)) if kind.write else []
        for k, group in enumerate(grouped(kind, stages, options.step)):
            progress(len(files) / (len(formats) * len(stages)))
            if kind.write:
                mark = mark_of(group, stages, options.step, depths)
                content = kind.write(figures if kind.many_pages else figures[k : k + 1], options.width)
                files.append((target.file(f"{stem}_{options.figure}_{mark}", kind.suffix), content))
            else:
                assert kind.data
                tree = group[-1].tree
                files.append((target.file(f"{stem}_d{tree.depth}", kind.suffix), kind.data(tree).encode("utf-8")))
    if target.folder:
        target.path.mkdir(exist_ok=True)
    for file, content in files:
        write_atomically(file, content)
    return [file for file, _ in files]


def view_of(numbers: tuple[float, ...] | None, world: World, lesson: Lesson | None) -> Orbit:
    """From where the scene is seen: azimuth, elevation, distance and target as asked.

    Else as the viewer begins, and as much farther away as it takes to see the eye that the rays come from.
    """
    frame = Frame.of(world)
    if numbers is None:
        orbit = home(world, frame, lesson.view if lesson else None)
        nearest = orbit.distance
        orbit.take_in(frame.inside(world.view().eye)[None])
        orbit.distance = min(orbit.distance, FARTHER * nearest)
        return orbit
    azimuth, elevation, distance, *target = numbers
    steep = math.degrees(STEEPEST)
    return home(world, frame, LessonView(azimuth, min(steep, max(-steep, elevation)), distance, tuple(target) or None))  # type: ignore[arg-type]


def steps(world: World, options: Namespace, depths: Depths) -> list[Stage]:
    """The pages, of trees that are whole."""
    ray = (options.ray[:3], options.ray[3:]) if options.ray else None
    how = {"size": options.size, "min_weight": options.min_weight, "model": options.model}
    trees = [tracer.trace(world, options.pixel, ray, depth=depth, **how) for depth in depths]
    if options.step == "rays":
        return by_ray(trees[-1])
    if options.step == "colour":
        return by_colour(trees[-1])
    return by_depth(trees)


def chosen(options: Namespace) -> tuple[Target, list[str]]:
    """Where to and as what; Unusable where the two do not agree."""
    path = Path(options.output)
    folder = path.is_dir() or options.output.endswith(("/", "\\"))
    formats = options.format
    if not folder:
        own = format_of(path.suffix)
        if own is None and not path.suffix and formats:
            raise Unusable(f'raytree export: a folder\'s name ends with "/": -o {path}/')
        if own is None:
            raise Unusable(f"{path}: must end with one of {', '.join(kind.suffix for kind in FORMATS.values())}")
        if formats and formats != [own]:
            raise Unusable(f"{path}: is {own}, but --format asks for {','.join(formats)}: name a folder, or one format")
        formats = [own]
        check_writable(path)
    elif path.exists() and not path.is_dir():
        raise Unusable(f"{path}: must be a folder, got a file")
    elif not path.exists():
        check_writable(path)
    return Target(path, folder), formats or ["svg"]


def check_pages(target: Target, formats: list[str], stages: list[Stage]) -> None:
    if not target.folder and len(stages) > 1 and not FORMATS[formats[0]].many_pages:
        raise Unusable(f"{target.path}: {len(stages)} pages need a folder, or one of PDF and PPTX")


def grouped(kind: Format, stages: list[Stage], step: str) -> list[list[Stage]]:
    """The pages of each file: all in one where the format has pages; data is of a whole tree."""
    if kind.many_pages:
        return [stages]
    return [stages[-1:]] if kind.data and step != "depth" else [[stage] for stage in stages]


def mark_of(group: list[Stage], stages: list[Stage], step: str, depths: Depths) -> str:
    """What tells a file from the others: d2, d0-3, d3_r05, d3_rays."""
    if step == "depth":
        return group[0].name if len(group) == 1 else f"d{depths[0]}-{depths[-1]}"
    return f"d{depths[-1]}_{group[0].name if len(group) == 1 and len(stages) > 1 else step}"


def stem_of(options: Namespace, lesson: Lesson | None) -> str:
    scene = lesson.name if lesson else Path(options.scene).stem
    return f"{scene}_{options.pixel[0]}_{options.pixel[1]}" if options.pixel else f"{scene}_ray"


def command(options: Namespace, format_name: str) -> str:
    """What makes the same figure again, but for where it is written."""
    words = ["raytree", "export", options.scene]
    if options.pixel:
        words += ["--pixel", f"{options.pixel[0]},{options.pixel[1]}"]
    else:
        words += ["--ray", ",".join(repr(x) for x in options.ray)]
    words += ["--figure", options.figure]
    if options.node:
        words += ["--node", str(options.node)]
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
    if options.eye != "top":
        words += ["--eye", options.eye]
    if options.ground:
        words.append("--ground")
    if options.fold:
        words += ["--fold", repr(options.fold)]
    if options.text_size != TEXT_SIZE:
        words += ["--text-size", repr(options.text_size)]
    words += ["--format", format_name]
    if format_name == "png" and options.width != PIXELS:
        words += ["--width", str(options.width)]
    return shlex.join(words)
