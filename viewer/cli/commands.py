"""What the commands do: each takes the parsed arguments and returns the exit status."""

import contextlib
import sys
import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from pathlib import Path

import tracer
from tracer.compile.jit import is_cached
from tracer.formats import READERS
from tracer.image.render import fill_cache
from tracer.kernel.entry import trace_area
from viewer.base.files import Unusable, check_writable, write_atomically
from viewer.base.progress import Progress
from viewer.lessons import lesson
from viewer.lessons.lesson import Lesson

COMPILING = "prepare the tracer: its formulas are compiled, only this once, in about twenty seconds"


def lessons(options: Namespace) -> int:
    for name in lesson.names():
        print(f"{name:14} {lesson.read(name).title}")
    return 0


def trace(options: Namespace) -> int:
    if options.output:
        check_writable(options.output)
    path, _ = find(options.scene)
    compile_once()
    with faults():
        world = prepared(path)
        ray = (options.ray[:3], options.ray[3:]) if options.ray else None
        tree = tracer.trace(
            world,
            options.pixel,
            ray,
            depth=options.depth,
            size=options.size,
            min_weight=options.min_weight,
            tolerance=options.tolerance,
            model=options.model,
        )
    text = as_text(tree, options.format, options.rays)
    if options.output:
        write_atomically(options.output, text.encode("utf-8"))
    else:
        put(text)
    return 0


def render(options: Namespace) -> int:
    from viewer.cli.render import render

    return render(options)


def export(options: Namespace) -> int:
    from viewer.cli.export import export

    return export(options)


def report(options: Namespace) -> int:
    from viewer.report.command import report

    return report(options)


def plan(options: Namespace) -> int:
    from viewer.cli import plan

    path, found = find(options.scene)
    with faults():
        world = prepared(path)
    if options.measure:
        compile_once()
        with Progress("measuring") as progress:
            made = plan.measured(world, path, found, progress)
    else:
        made = plan.listed(world, found)
    put(plan.as_json(made) if options.json else plan.as_text(made))
    return 0


def check(options: Namespace) -> int:
    from tracer.measure.check.case import Case, Result
    from tracer.measure.check.check import run_all
    from viewer.cli import check

    cases = check.chosen(options.cases)
    compile_once()

    def watched(cases: Sequence[Case]) -> list[Result]:
        with Progress("check") as progress:
            return run_all(cases, progress)

    return check.check(cases, options.explain, options.json, put, watched)


def view(options: Namespace) -> int:
    from viewer.cli.view import show

    path, found = find(options.scene or lesson.names()[0])
    if not path.exists():  # one that is there and cannot be read is shown as such, for it is perhaps being written
        raise Unusable(f"{path}: file not found")
    return show(path, found, options)


def find(name: str) -> tuple[Path, Lesson | None]:
    """The scene's file, and the lesson it belongs to if it was named."""
    path = Path(name)
    if (path / "lesson.md").is_file():
        found = lesson.read_file(path / "lesson.md")
        return found.scene, found
    if path.exists() or path.suffix.lower() in READERS:
        return path, None
    if name not in lesson.names() and (path.suffix or len(path.parts) > 1):
        raise Unusable(f"{name}: a scene must be one of {', '.join(READERS)} or a lesson's name")
    found = lesson.read(name)
    return found.scene, found


@contextlib.contextmanager
def faults() -> Iterator[None]:
    """What is wrong with a scene or an argument, as lines for people."""
    try:
        yield
    except tracer.SceneError as error:
        raise Unusable(*error.faults) from None
    except ValueError as error:
        raise Unusable(f"raytree: {error}") from None


def prepared(path: Path) -> tracer.World:
    """The scene in a file, ready to be traced, its notes said."""
    with Progress(f"load {path.name}") as progress:
        scene = tracer.load(path, progress)
        progress.say(f"prepare {path.name}")
        world = tracer.prepare(scene)
        for note in world.notes:
            progress.put(f"note: {note}")
    return world


def compile_once() -> float:
    """On the very first start on a machine compile all kernels, and say why nothing is to be seen; the seconds."""
    if is_cached(trace_area):
        return 0.0
    began = time.perf_counter()
    with Progress(COMPILING, at_once=True):
        fill_cache()
    return time.perf_counter() - began


def as_text(tree: tracer.RayTree, name: str, rays: int) -> str:
    if name == "text":
        return tree.to_text(rays or None)
    from viewer.figures.formats import FORMATS

    data = FORMATS[name].data
    assert data
    return data(tree)


def put(text: str) -> None:
    """To the terminal, in UTF-8 whatever the system's own encoding is."""
    sys.stdout.buffer.write(text.encode("utf-8"))
    sys.stdout.buffer.flush()
