"""`raytree trace`: the ray tree behind one pixel, as text or as data."""

import tracer
from tracer.tree.verified.balls import MissingExtra
from tracer.tree.verified.enclosures import VerifiedTree
from viewer.base.files import Unusable, check_writable, write_atomically
from viewer.base.progress import Progress
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import TraceOptions
from viewer.cli.terminal import compile_once, put
from viewer.figures.catalogue import FORMATS


def trace(options: TraceOptions) -> int:
    if options.output:
        check_writable(options.output)
    if options.verify and options.format not in ("text", "json"):
        raise Unusable(f"raytree trace: --verify is written as text or json, not as {options.format}")
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
    most = options.rays or None
    if options.verify:
        verified = verified_tree(world, tree)
        text = tree.to_json(verified) if options.format == "json" else tree.to_text(most, verified)
    else:
        text = tree.to_text(most) if options.format == "text" else FORMATS[options.format].text(tree)
    if options.output:
        write_atomically(options.output, text.encode("utf-8"))
    else:
        put(text)
    return 0


def verified_tree(world: tracer.World, tree: tracer.RayTree) -> VerifiedTree:
    """The enclosures of a tree. Unusable if the library for them is not installed."""
    try:
        with Progress("verify") as progress:
            return tracer.verify(world, tree, progress)
    except MissingExtra as error:
        raise Unusable(f"raytree trace: {error}") from None
