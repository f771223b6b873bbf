"""`raytree report`: measures scenes, and writes the page, its plots and its data into a folder."""

import importlib.util
import platform
import shlex
from collections.abc import Callable
from pathlib import Path

from tracer.compile.kernel_cache import versions
from tracer.extras import missing_extra
from tracer.image.render import processors
from tracer.printable import shown_path
from viewer.base.files import Unusable, check_folder, collect, write_atomically
from viewer.base.options import words
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import ReportOptions
from viewer.cli.terminal import compile_once
from viewer.lessons import lesson as lessons
from viewer.report.chapter import Chapter, draw, scene_chapter, stiff_chapter
from viewer.report.data import as_csv, as_json
from viewer.report.page import as_html


def report(options: ReportOptions) -> int:
    check_scene(options)
    names = lessons.names() if options.all else [options.scene or ""]
    *places, folder, _ = collect(
        *(lambda name=name: find(name) for name in names), lambda: target(options.output), check_libraries
    )
    compile_once()
    parts: list[tuple[str, Callable[[Callable[[float], None]], Chapter]]] = [
        (name, lambda share, place=place: of_scene(place, options, share))
        for name, place in zip(names, places, strict=True)
    ]
    if options.all:
        parts.append(("stiff trees", stiff_chapter))
    chapters = []
    with faults(), Progress("report") as progress:
        for k, (name, measure) in enumerate(parts):
            if len(parts) > 1:
                progress.doing = f"report {name} ({k + 1} of {len(parts)})"
            chapters.append(measure(lambda share, k=k: progress((k + share) / len(parts))))
    title = "all lessons, and stiff trees" if options.all else chapters[0].title
    folder.mkdir(exist_ok=True)
    files = [path for chapter in chapters for path in draw(chapter, folder, named=options.all)]
    machine = {"threads": str(processors()), "system": platform.platform(), **versions()}
    command = shlex.join(["raytree", "report", *words(options, leave_out=("output",))])
    pages = {
        "report.html": as_html(title, command, chapters, machine),
        "report.csv": as_csv(chapters),
        "report.json": as_json(chapters, machine),
    }
    for name, content in pages.items():
        write_atomically(folder / name, content)
    put(f"{len(files)} plots as SVG and PDF, report.csv, report.json and\n{shown_path(folder / 'report.html')}\n")
    return 0


def of_scene(
    place: tuple[Path, lessons.Lesson | None], options: ReportOptions, share: Callable[[float], None]
) -> Chapter:
    """Load a scene, and measure it."""
    path, lesson = place
    return scene_chapter(prepared(path), lesson.name if lesson else path.stem, options.size, options.quick, share)


def check_scene(options: ReportOptions) -> None:
    """Unusable unless there is a scene or --all, but not both."""
    if options.all == bool(options.scene):
        given = f", not both: got {options.scene}" if options.scene else ""
        raise Unusable(f"raytree report: a SCENE, or --all for every lesson and the stiff trees{given}")


def target(output: str) -> Path:
    path = Path(output)
    check_folder(path)
    return path


def check_libraries() -> None:
    if importlib.util.find_spec("matplotlib") is None:
        raise Unusable(f"raytree report: {missing_extra('plots need', 'report')}")
