"""`raytree render`: the image of a scene into a file, or of several scenes into a folder; here or on a cluster."""

import contextlib
import math
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tracer
from tracer.image.progressive import MAX_SAMPLES, RoundStats
from tracer.image.render import Image
from tracer.kernel.limits import MAX_NODES
from tracer.printable import json_text
from tracer.tree.digits import number_text
from tracer.tree.text import missing_light, within
from viewer.base.files import Unusable, check_writable, has_folder, is_there, write_atomically
from viewer.base.pictures import SUFFIXES, check_bounds_format, check_format, write_bounds, write_picture
from viewer.base.progress import Progress
from viewer.cli.bounds import bounds_of, bounds_stats, check_bounds, put_summary
from viewer.cli.loading import faults, find
from viewer.cli.options import RenderOptions, limits_of
from viewer.cli.terminal import compile_once


@dataclass(frozen=True)
class RenderJob:
    """One image to render."""

    name: str
    scene: Path
    target: Path


def render(options: RenderOptions) -> int:
    jobs = jobs_of(options)
    many = len(jobs) > 1
    stats: list[dict[str, Any]] = []
    compiling = 0.0 if options.dask else compile_once()
    with Progress("render") as progress, executor_of(options.dask, progress) as (executor, connecting):
        for k, job in enumerate(jobs):
            try:
                figures = render_one(job, options, executor, progress, f" ({k + 1} of {len(jobs)})" if many else "")
            except Unusable as fault:
                if not many:
                    raise
                for line in fault.faults:
                    progress.put(line)  # and go on with the other scenes
                continue
            if not stats:
                figures["seconds"]["compile"] += compiling + connecting
            stats.append(figures)
    if options.stats:
        document = {"images": stats} if many else stats[0]
        write_atomically(options.stats, (json_text(document, indent=1) + "\n").encode("utf-8"))
    return 0 if len(stats) == len(jobs) else 2


@contextlib.contextmanager
def executor_of(address: str | None, progress: Progress) -> Iterator[tuple[Executor | None, float]]:
    """Connect to the cluster at an address. Yields it, and the seconds that took; None without an address."""
    if address is None:
        yield None, 0.0
        return
    from tracer.image.cluster import ClusterError, connect

    began = time.perf_counter()
    try:
        with connect(address, progress.say, lambda line: progress.put(f"note: {line}")) as cluster:
            progress.say("render")
            yield cluster, time.perf_counter() - began
    except ClusterError as error:
        raise Unusable(*error.faults) from None


def render_one(
    job: RenderJob, options: RenderOptions, executor: Executor | None, progress: Progress, number: str
) -> dict[str, Any]:
    """Load, prepare, trace and write one image. Returns its part of `--stats`.

    `number` says which of several images it is; empty for a single one.
    """
    name, only = (f"{job.name}: ", "of this image") if number else ("", "")
    with faults():
        began = time.perf_counter()
        progress.say(f"load {job.name}{number}", only)
        scene = tracer.load(job.scene, progress, options.up)
        loaded = time.perf_counter()
        progress.say(f"prepare {job.name}{number}", only)
        world = tracer.prepare(scene)
        for note in world.notes:
            progress.put(f"note: {note}")
        prepared = time.perf_counter()
        if options.bounds:
            progress.say(f"bounds of {job.name}{number}", only)
            bounds = bounds_of(world, options, progress)
            job.target.parent.mkdir(exist_ok=True)
            write_bounds(job.target, bounds.low, bounds.high)
            put_summary(progress, name, scene, bounds)
            seconds = {"load": loaded - began, "prepare": prepared - loaded, "compile": 0.0, "trace": bounds.seconds}
            return {"scene": str(job.scene), "image": str(job.target), "seconds": seconds, **bounds_stats(bounds)}
        progress.say(f"render {job.name}{number}", only)
        image = tracer.render(
            world,
            samples=options.samples,
            threads=options.threads,
            sampler=options.sampler,
            until_error=options.until_error,
            until_seconds=options.until_seconds,
            executor=executor,
            progress=progress,
            **limits_of(options),
        )
    progress.say(f"write {job.target.name}{number}", only)
    job.target.parent.mkdir(exist_ok=True)
    write_picture(job.target, image.pixels)
    if image.stats:
        progress.put_result(name + summary(image, image.stats, options))
    if image.limited:
        progress.put_result(name + limit_reached(image))
    if image.tolerance is not None or image.limited or (image.stats and image.residual["max"] > 0.0):
        most = number_text(image.residual["max"])
        lacks = missing_light(image.bound, image.unbounded) + within(image.bound, image.missing_allowed)
        missing = f"a pixel's rays that were cut carry at most {most} of the weight{lacks}"
        progress.put_result(name + missing)
    return {
        "scene": str(job.scene),
        "image": str(job.target),
        "seconds": {"load": loaded - began, "prepare": prepared - loaded, **image.seconds},
        "rays": image.rays,
        "tests": image.tests,
        "threads": image.threads,
        "size": list(image.size),
        "samples": image.stats.samples if image.stats else image.samples,
        "depth": image.depth,
        "tolerance": finite(image.tolerance),
        "missing": image.missing_allowed,
        "max_rays": image.max_rays,
        "max_nodes": image.max_nodes,
        "limited": image.limited,
        "residual": image.residual,
        "bound": finite(image.bound),
        "left_out": image.left_out,
        **(convergence(image, image.stats) if image.stats else {}),
    }


def finite(value: float | None) -> float | None:
    """A number for JSON, which has no infinity."""
    return value if value is not None and math.isfinite(value) else None


def limit_reached(image: Image) -> str:
    """A line about the trees that the limit of rays ended."""
    of = f"{image.limited:,} of {image.trees:,} {'pixels' if image.trees == image.size[0] * image.size[1] else 'trees'}"
    if image.max_nodes == MAX_NODES:
        more = "no tree may have more"
    else:
        more = f"a --max-rays above {image.max_rays:,} lets them grow"
    return f"the limit of rays ended {of}, each at {image.max_nodes:,} rays, shadow rays included; {more}"


def summary(image: Image, stats: RoundStats, options: RenderOptions) -> str:
    """A summary line of an image that converged."""
    mean = f"{stats.samples:,.0f}" if stats.samples >= 100 else f"{stats.samples:.3g}"
    spread = f"{mean} samples a pixel" + (f", {stats.least} to {stats.most}" if stats.most > stats.least else "")
    if stats.error == 0.0:
        end = "no pixel changes any more"
    elif image.ended == "error":
        end = f"{options.until_error:g} was asked for"
    elif image.ended == "seconds":
        end = "the time limit was reached"
    else:
        end = f"another doubling would exceed the maximum of {options.samples or MAX_SAMPLES} samples per pixel"
    reach = f"{stats.error:.2g} (RMSE, linear light) after {stats.seconds:.2f} s and {stats.rays:,} rays"
    return f"estimated sampling error {reach}: {spread}; {end}"


def convergence(image: Image, stats: RoundStats) -> dict[str, Any]:
    """The part of `--stats` about an image that converged."""
    return {"error": stats.error, "samples_least": stats.least, "samples_most": stats.most, "ended": image.ended}


def jobs_of(options: RenderOptions) -> list[RenderJob]:
    """The images to render. Unusable, with all faults, if a scene or a target cannot be used."""
    into = Path(options.output)
    slash = options.output.endswith(("/", "\\"))
    folder = len(options.scenes) > 1 or has_folder(into) or slash
    unusable: list[str] = []
    jobs = []
    for scene in options.scenes:
        try:
            path, lesson = find(scene)
        except Unusable as fault:
            unusable += fault.faults
            continue
        name = lesson.name if lesson else path.stem
        jobs.append(RenderJob(name, path, into / f"{name}.{options.format or 'png'}" if folder else into))
    for name, count in Counter(job.name for job in jobs).items():
        if count > 1:
            unusable.append(f"raytree render: {count} scenes would be written to the same file: {name}")
    if folder and not has_folder(into) and (is_there(into) or (into.suffix.lower() in SUFFIXES and not slash)):
        unusable.append(f"raytree render: the images of several scenes need a folder, got {into}")
    if options.format and not folder:
        unusable.append(f"raytree render: --format is for images in a folder; {into} has a suffix")
    if unusable:
        raise Unusable(*unusable)
    check_bounds(options)
    if options.bounds:
        for job in jobs:
            check_bounds_format(job.target)
    elif not folder:
        check_format(into)
    targets = [into] if folder and not has_folder(into) else [job.target for job in jobs]
    for path in filter(None, (*targets, options.stats)):
        check_writable(path)
    return jobs
