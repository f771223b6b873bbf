"""`raytree trace`: the ray tree behind one pixel, as text or as data."""

import tracer
from viewer.base.files import check_writable, write_atomically
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import TraceOptions
from viewer.cli.terminal import compile_once, put
from viewer.figures.catalogue import FORMATS


def trace(options: TraceOptions) -> int:
    if options.output:
        check_writable(options.output)
    path, _ = find(options.scene)
    compile_once()
    with faults():
        world = prepared(path, options.up)
        ray = (options.ray[:3], options.ray[3:]) if options.ray else None
        tree = tracer.trace(
            world,
            options.pixel,
            ray,
            depth=options.depth,
            size=options.size,
            min_weight=options.min_weight,
            tolerance=options.tolerance,
            missing=options.missing,
            max_rays=options.max_rays,
            model=options.model,
        )
    text = tree.to_text(options.rays or None) if options.format == "text" else FORMATS[options.format].text(tree)
    if options.output:
        write_atomically(options.output, text.encode("utf-8"))
    else:
        put(text)
    return 0
