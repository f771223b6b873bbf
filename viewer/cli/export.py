"""`raytree export`: a pixel's ray tree as figures and as data, page by page, into a file or a folder."""

from dataclasses import replace

from tracer.printable import shown_path
from viewer.base.files import Unusable, collect
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, find, prepared
from viewer.cli.terminal import compile_once
from viewer.figures.export import check_options, make
from viewer.figures.export_options import ExportOptions
from viewer.figures.targets import target_of


def export(options: ExportOptions) -> int:
    (path, lesson), target, _ = collect(
        lambda: find(options.scene), lambda: target_of(options), lambda: check_options(options)
    )
    if lesson:
        own = range(lesson.depth, lesson.depth + 1) if lesson.depth is not None else None
        pixel = options.pixel or (None if options.ray else lesson.pixel)
        options = replace(options, pixel=pixel, depth=options.depth or own)
    if not options.pixel and not options.ray:
        raise Unusable("raytree export: give a pixel (--pixel X,Y) or a ray (--ray ox,oy,oz,dx,dy,dz)")
    compile_once()
    with faults():
        world = prepared(path, options.up)
        with Progress("export") as progress:
            name, view = (lesson.name, lesson.view) if lesson else (path.stem, None)
            made = make(options, world, name, target, view, progress)
            made.write()
            for note in made.notes:
                progress.put(f"note: {note}")
    for file, _ in made.files:
        put(f"{shown_path(file)}\n")
    return 0
