"""`raytree report`: measure one scene, and write the page, its plots and its figures into a folder."""

import importlib.util
import platform
import shlex
from argparse import Namespace
from pathlib import Path

from tracer.jit import versions
from tracer.measure.sources import FULL, QUICK, left_out, sources
from tracer.render import processors
from tracer.world import World
from viewer.commands import compile_once, faults, find, prepared, put
from viewer.files import Unusable, check_folder, every, write_atomically
from viewer.progress import Progress
from viewer.report.data import as_csv, as_json
from viewer.report.page import as_html
from viewer.report.plots import FORMATS, plot

ACROSS, QUICK_ACROSS = 240, 100  # pixels, of an image whose size nobody has chosen
PLOTS = (("seconds", "rmse"), ("rays", "rmse"), ("tests", "rmse"), ("seconds", "largest"), ("seconds", "flip"))


def report(options: Namespace) -> int:
    (path, lesson), folder, _ = every(lambda: find(options.scene), lambda: target(options.output), has_libraries)
    compile_once()
    with faults():
        world = prepared(path)
        effort = QUICK if options.quick else FULL
        with Progress("report") as progress:
            size = options.size or own_size(world, QUICK_ACROSS if options.quick else ACROSS)
            found = sources(world, size, effort, progress, smaller=options.size is None)
    missing = left_out(world.scene)
    about = machine()
    title = world.scene.title or (lesson.name if lesson else path.name)
    folder.mkdir(exist_ok=True)
    drawn: dict[str, list[bytes]] = {}
    written: list[Path] = []
    for source in found:
        for work, measure in PLOTS:
            made = plot(source, work, measure)
            drawn.setdefault(source.name, []).append(made["svg"])
            for kind in FORMATS:
                written.append(folder / f"{source.name}-{measure}-{work}.{kind}")
                write_atomically(written[-1], made[kind])
    pages = {
        "report.html": as_html(title, command(options), found, drawn, missing, about),
        "report.csv": as_csv(found),
        "report.json": as_json(title, found, missing, about),
    }
    for name, content in pages.items():
        write_atomically(folder / name, content)
    put("".join(f"{file}\n" for file in [*(folder / name for name in pages), *written]))
    return 0


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
    words = ["raytree", "report", options.scene]
    if options.size:
        words += ["--size", f"{options.size[0]}x{options.size[1]}"]
    if options.quick:
        words.append("--quick")
    return shlex.join(words)
