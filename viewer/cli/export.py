"""`raytree export`: a pixel's ray tree as figures and as data, page by page, or a lesson, into a file or a folder."""

import contextlib
from dataclasses import replace

from tracer.printable import shown_path
from viewer.base.files import Unusable, collect
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, found_scene, prepared
from viewer.cli.place import ray_of, with_place
from viewer.cli.terminal import compile_once
from viewer.figures.export import Made, check_options, make
from viewer.figures.export_options import ExportOptions
from viewer.figures.targets import Target, target_of
from viewer.handout.files import check_lesson_options, lesson_target, make_lesson
from viewer.handout.reading import read_handout
from viewer.reopen.scene_files import scene_files
from viewer.session.restore.command import embedded
from viewer.session.restore.figure_scene import FigureScene

READING = 0.3  # the share of the time that an export of a lesson takes to trace it


def export(options: ExportOptions) -> int:
    with contextlib.ExitStack() as stack:
        scene, target, _ = collect(
            lambda: stack.enter_context(found_scene(options.scene, options.at, options.swept, options.language)),
            lambda: target_of(options),
            lambda: check_lesson_options(options) if options.lesson else check_options(options),
        )
        if options.lesson:
            made = make_lesson_files(options, scene, target)
            return _list(made)
        made = make_files(with_place(options, scene, "export"), scene, target)
    return _list(made)


def _list(made: Made) -> int:
    """Print the names of the files."""
    for file, _ in made.files:
        put(f"{shown_path(file)}\n")
    return 0


def make_lesson_files(options: ExportOptions, scene: FigureScene, target: Target) -> Made:
    """Make the files of a lesson, and write them."""
    if scene.lesson is None:
        raise Unusable(f"{shown_path(options.scene)}: --lesson is for a lesson; this is a scene")
    target = lesson_target(options, target)
    compile_once()
    with faults(), Progress("export") as progress:
        handout = read_handout(scene.lesson, lambda share: progress(READING * share))
        made = make_lesson(options, handout, target, lambda share: progress(READING + (1.0 - READING) * share))
        made.write()
        for note in made.notes:
            progress.put(f"note: {note}")
    return made


def make_files(options: ExportOptions, scene: FigureScene, target: Target) -> Made:
    """Make the files of a scene's figures, and write them."""
    compile_once()
    with faults():
        world = prepared(scene.path, options.up, changes=scene.changes)
        if not (options.pixel or options.ray) and (ray := ray_of(world, scene)):
            origin, direction = ray
            options = replace(options, ray=(*origin, *direction))
        with Progress("export") as progress:
            lesson = scene.lesson
            name, view = (lesson.name, scene.step.state.view) if lesson and scene.step else (scene.path.stem, None)
            files = scene_files(world.scene, lesson.path if lesson else None, scene.home if scene.copy_of else None)
            size = (world.scene.image.width, world.scene.image.height)
            carried = embedded(files, options.state(size)) if files else None
            made = make(options, world, name, target, view, progress, carried)
            made.write()
            for note in [scene.note] * bool(scene.note) + made.notes:
                progress.put(f"note: {note}")
    return made
