"""`raytree report`: measure scenes, and write the page, its plots and its figures into a folder."""

import importlib.util
import platform
import shlex
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

from tracer.compile.jit import versions
from tracer.image.render import processors
from tracer.kernel.world import World
from tracer.measure.precision.precision import counted
from tracer.measure.precision.sources import FULL, QUICK, left_out, sources
from tracer.measure.precision.stiff import PROBLEMS, solved, steps
from viewer.base.files import Unusable, check_folder, every, write_atomically
from viewer.base.progress import Progress
from viewer.cli.commands import compile_once, faults, find, prepared, put
from viewer.lessons import lesson as lessons
from viewer.report.chapter import Chapter
from viewer.report.data import as_csv, as_json
from viewer.report.page import as_html
from viewer.report.plots import FORMATS, plot

ACROSS, QUICK_ACROSS = 240, 100  # pixels, of an image whose size nobody has chosen
PLOTS = (("seconds", "rmse"), ("rays", "rmse"), ("tests", "rmse"), ("seconds", "largest"), ("seconds", "flip"))
EXACT_PLOTS = (("seconds", "largest"), ("rays", "largest"), ("tests", "largest"))  # where all pixels are one ray


def report(options: Namespace) -> int:
    check(options)
    names = lessons.names() if options.all else [options.scene]
    *places, folder, _ = every(
        *(lambda name=name: find(name) for name in names), lambda: target(options.output), has_libraries
    )
    compile_once()
    parts: list[tuple[str, Callable[[Callable[[float], None]], Chapter]]] = [
        (name, lambda share, place=place: of_scene(place, options, share))
        for name, place in zip(names, places, strict=True)
    ]
    if options.all:
        parts.append(("stiff trees", stiff))
    chapters = []
    with faults(), Progress("report") as progress:
        for k, (name, measure) in enumerate(parts):
            if len(parts) > 1:
                progress.doing = f"report {name} ({k + 1} of {len(parts)})"
            chapters.append(measure(lambda share, k=k: progress((k + share) / len(parts))))
    title = "all lessons, and stiff trees" if options.all else chapters[0].title
    folder.mkdir(exist_ok=True)
    files = [path for chapter in chapters for path in draw(chapter, folder, named=options.all)]
    about = machine()
    pages = {
        "report.html": as_html(title, command(options), chapters, about),
        "report.csv": as_csv(chapters),
        "report.json": as_json(chapters, about),
    }
    for name, content in pages.items():
        write_atomically(folder / name, content)
    put(f"{len(files)} plots as SVG and PDF, report.csv, report.json and\n{folder / 'report.html'}\n")
    return 0


def check(options: Namespace) -> None:
    """A scene or all of them."""
    if options.all == bool(options.scene):
        raise Unusable("raytree report: a SCENE, or --all for every lesson and the stiff trees" + (
            f", not both: got {options.scene}" if options.scene else ""
        ))  # fmt: skip


def of_scene(place: tuple[Path, lessons.Lesson | None], options: Namespace, share: Callable[[float], None]) -> Chapter:
    path, lesson = place
    world = prepared(path)
    size = options.size or own_size(world, QUICK_ACROSS if options.quick else ACROSS)
    effort = QUICK if options.quick else FULL
    found = sources(world, size, effort, share, smaller=options.size is None)
    name = lesson.name if lesson else path.stem
    return Chapter(name, world.scene.title or name, found, left_out(world.scene, effort))


def stiff(share: Callable[[float], None]) -> Chapter:
    step = counted(sum(map(steps, PROBLEMS)), share)
    return Chapter("stiff", "Stiff trees, with exact answers", [solved(problem, step) for problem in PROBLEMS])


def draw(chapter: Chapter, folder: Path, named: bool) -> list[Path]:
    """Write its plots, and keep them for the page; their files. `named`: with the chapter's name."""
    written: list[Path] = []
    for source in chapter.sources:
        for work, measure in EXACT_PLOTS if source.exact else PLOTS:
            made = plot(source, work, measure)
            chapter.plots.setdefault(source.name, []).append(made["svg"])
            for kind in FORMATS:
                name = f"{source.name}-{measure}-{work}.{kind}"
                written.append(folder / (f"{chapter.name}-{name}" if named else name))
                write_atomically(written[-1], made[kind])
    return written


def target(output: str) -> Path:
    path = Path(output)
    check_folder(path)
    return path


def has_libraries() -> None:
    if importlib.util.find_spec("matplotlib") is None:
        raise Unusable("raytree report: plots need the extra raytree[report]: pip install 'raytree[report]'")


def own_size(world: World, across: int) -> tuple[int, int]:
    """The scene's own shape, smaller."""
    image = world.scene.image
    share = min(1.0, across / image.width)
    return max(1, round(share * image.width)), max(1, round(share * image.height))


def machine() -> dict[str, str]:
    return {"threads": str(processors()), "system": platform.platform(), **versions()}


def command(options: Namespace) -> str:
    words = ["raytree", "report", options.scene or "--all"]
    if options.size:
        words += ["--size", f"{options.size[0]}x{options.size[1]}"]
    if options.quick:
        words.append("--quick")
    return shlex.join(words)
