"""`raytree report`: measures scenes, and writes the page, its plots and its data into a folder."""

import importlib.util
import shlex
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tracer.extras import missing_extra
from tracer.measure.conditions import Moment
from tracer.measure.precision.textbook_kernel import warm_up
from tracer.printable import shown_path
from tracer.progress import divided
from viewer.base.files import Unusable, check_folder, collect, write_atomically
from viewer.base.options import words
from viewer.base.progress import Progress
from viewer.base.streams import put, put_note
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import ReportOptions
from viewer.cli.terminal import compile_once
from viewer.lessons import lesson as lessons
from viewer.report.chapter import Chapter, scene_chapter, stiff_chapter
from viewer.report.conditions import Conditions, busy_note
from viewer.report.data import as_csv, as_json
from viewer.report.page import as_html


def report(options: ReportOptions) -> int:
    began = Moment()
    check_scene(options)
    names = lessons.names() if options.all else [options.scene or ""]
    *places, folder, _ = collect(
        *(lambda name=name: find(name) for name in names), lambda: target(options.output), check_libraries
    )
    compile_once()
    with faults():
        parts: list[tuple[str, Callable[[], Chapter]]] = [
            (
                name,
                partial(
                    scene_chapter, prepared(path), lesson.name if lesson else path.stem, options.size, options.quick
                ),
            )
            for name, (path, lesson) in zip(names, places, strict=True)
        ]
    if options.all:
        parts.append(("stiff trees", stiff_chapter))
    with faults(), Progress("report") as progress:
        if not options.quick:
            progress.say("load the kernels with the textbook's formulas (compiled at the first report, forty seconds)")
            warm_up()
        chapters = []
        for k, (name, make) in enumerate(parts):
            progress.say(f"report: run every setting of {name} once" + numbered(k, len(parts)))
            chapters.append(make())
        progress.say("report")
        expected = [chapter.seconds for chapter in chapters] + [chapter.drawing for chapter in chapters]
        shares = divided(progress, expected)
        for k, chapter in enumerate(chapters):
            progress.doing = f"report {parts[k][0]}" + numbered(k, len(parts))
            chapter.measure(shares[k])
        progress.doing = "report: draw the plots"
        folder.mkdir(exist_ok=True)
        drawn = zip(chapters, shares[len(chapters) :], strict=True)
        count = sum(chapter.draw(folder, options.all, share) for chapter, share in drawn)
    title = "all lessons, and stiff trees" if options.all else chapters[0].title
    command = shlex.join(["raytree", "report", *words(options, leave_out=("output",))])
    conditions = Conditions(command, began, Moment())
    pages = {
        "report.html": as_html(title, chapters, conditions),
        "report.csv": as_csv(chapters),
        "report.json": as_json(chapters, conditions),
    }
    for name, content in pages.items():
        write_atomically(folder / name, content)
    if note := busy_note(chapters):
        put_note(note)
    put(f"{count} plots as SVG and PDF, report.csv, report.json and\n{shown_path(folder / 'report.html')}\n")
    return 0


def numbered(k: int, count: int) -> str:
    return f" ({k + 1} of {count})" if count > 1 else ""


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
