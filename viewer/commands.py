"""What the commands do: each takes the parsed arguments and returns the exit status."""

import contextlib
import json
import math
import sys
import time
from argparse import Namespace
from collections.abc import Iterator, Sequence
from pathlib import Path

import tracer
from tracer.formats import READERS
from tracer.jit import is_cached
from tracer.outline import light_missing, number
from tracer.render import fill_cache
from tracer.tile import trace_area
from viewer import lesson
from viewer.files import Unusable, check_writable, write_atomically
from viewer.lesson import Lesson


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
        world = tracer.prepare(tracer.load(path))
        put_notes(world)
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
    from viewer.picture import check_format, write_picture

    check_format(options.output)
    for path in filter(None, (options.output, options.stats)):
        check_writable(path)
    path, _ = find(options.scene)
    compiling = compile_once()
    with faults():
        began = time.perf_counter()
        scene = tracer.load(path)
        loaded = time.perf_counter()
        world = tracer.prepare(scene)
        put_notes(world)
        prepared = time.perf_counter()
        with Progress("rendering") as progress:
            image = tracer.render(
                world,
                options.size,
                options.samples,
                options.depth,
                options.threads,
                min_weight=options.min_weight,
                tolerance=options.tolerance,
                model=options.model,
                progress=progress,
            )
    write_picture(options.output, image.pixels)
    if options.tolerance is not None:
        most = number(image.residual["max"])
        print(f"a pixel's rays that were cut carry at most {most} of the weight{light_missing(image.bound)}")
    image.seconds["compile"] += compiling
    if options.stats:
        stats = {
            "seconds": {"load": loaded - began, "prepare": prepared - loaded, **image.seconds},
            "rays": image.rays,
            "threads": image.threads,
            "size": list(image.size),
            "samples": image.samples,
            "depth": image.depth,
            "tolerance": image.tolerance,
            "residual": image.residual,
            "bound": image.bound if math.isfinite(image.bound) else None,
            "left_out": image.left_out,
        }
        write_atomically(options.stats, (json.dumps(stats, indent=1) + "\n").encode("utf-8"))
    return 0


def plan(options: Namespace) -> int:
    from viewer import plantable

    path, found = find(options.scene)
    with faults():
        world = tracer.prepare(tracer.load(path))
        put_notes(world)
    if options.measure:
        compile_once()
        with Progress("measuring") as progress:
            made = plantable.measured(world, path, found, progress)
    else:
        made = plantable.listed(world, found)
    put(plantable.as_json(made) if options.json else plantable.as_text(made))
    return 0


def check(options: Namespace) -> int:
    from tracer.measure.case import Case, Result
    from tracer.measure.check import run_all
    from viewer import checktable

    cases = checktable.chosen(options.cases)
    compile_once()

    def watched(cases: Sequence[Case]) -> list[Result]:
        with Progress("checking") as progress:
            return run_all(cases, progress)

    return checktable.check(cases, options.explain, options.json, put, watched)


def view(options: Namespace) -> int:
    from viewer.show import show

    path, found = find(options.scene or lesson.names()[0])
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


def put_notes(world: tracer.World) -> None:
    for note in world.notes:
        print(f"note: {note}", file=sys.stderr)


def compile_once() -> float:
    """On the very first start on a machine compile all kernels, and say why nothing is to be seen; the seconds."""
    if is_cached(trace_area):
        return 0.0
    print("preparing the tracer: its formulas are compiled, only this once", file=sys.stderr, flush=True)
    began = time.perf_counter()
    fill_cache()
    return time.perf_counter() - began


def as_text(tree: tracer.RayTree, name: str, rays: int) -> str:
    match name:
        case "json":
            return tree.to_json()
        case "csv":
            from viewer.figures.csv import write_csv

            return write_csv(tree)
        case "dot":
            from viewer.figures.dot import write_dot

            return write_dot(tree)
        case _:
            return tree.to_text(rays or None)


def put(text: str) -> None:
    """To the terminal, in UTF-8 whatever the system's own encoding is."""
    sys.stdout.buffer.write(text.encode("utf-8"))
    sys.stdout.buffer.flush()


class Progress:
    """One line on a terminal, once something takes over a second: the share done and the time left."""

    def __init__(self, doing: str) -> None:
        self.doing = doing
        self.began = time.perf_counter()
        self.shown = 0.0

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *exception: object) -> None:
        if self.shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def __call__(self, share: float) -> None:
        now = time.perf_counter()
        passed = now - self.began
        if passed > 1.0 and now - self.shown > 0.2 and share > 0.0 and sys.stderr.isatty():
            self.shown = now
            left = passed * (1.0 - share) / share
            sys.stderr.write(f"\r\x1b[K{self.doing}: {100 * share:.0f} %, {left:.0f} s left")
            sys.stderr.flush()
