"""`raytree trace`: the ray tree behind one pixel, as text or as data."""

import tracer
from tracer.formulas.sampler import sample_number
from viewer.base.files import Unusable, check_writable, write_atomically
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import extra, faults, found_scene, prepared
from viewer.cli.options import TraceOptions, limits_of
from viewer.cli.place import ray_of, with_place
from viewer.cli.terminal import compile_once
from viewer.figures.catalogue import FORMATS


def trace(options: TraceOptions) -> int:
    if options.output:
        check_writable(options.output)
    if options.verify and options.format not in ("text", "json"):
        raise Unusable(f"raytree trace: --verify is written as text or json, not as {options.format}")
    if options.sample is not None and options.ray:
        raise Unusable("raytree trace: --sample is for a pixel: a ray has no samples")
    with found_scene(options.scene, options.at, options.swept) as scene, faults():
        options = with_place(options, scene, "trace")
        compile_once()
        world = prepared(scene.path, options.up, changes=scene.changes)
        ray = (options.ray[:3], options.ray[3:]) if options.ray else None if options.pixel else ray_of(world, scene)
        sample = None if ray else sample_number(world.scene.image.samples, options.sample)
        tree = tracer.trace(world, options.pixel, ray, sample=sample, **limits_of(options))
    most = options.rays or None
    if options.verify:
        with extra("trace"), Progress("verify") as progress:
            verified = tracer.verify(world, tree, progress)
        text = tree.to_json(verified) if options.format == "json" else tree.to_text(most, verified)
    else:
        text = tree.to_text(most) if options.format == "text" else FORMATS[options.format].text(tree)
    if options.output:
        write_atomically(options.output, text.encode("utf-8"))
    else:
        put(text)
    return 0
