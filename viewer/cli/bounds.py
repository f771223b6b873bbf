"""`raytree render --bounds`: guaranteed bounds of each pixel, into a file."""

import math
from concurrent.futures.process import BrokenProcessPool
from typing import Any

import numpy as np

from tracer.image.bounds import Bounds, render_bounds
from tracer.image.render import processors
from tracer.kernel.world import World
from tracer.progress import Progress
from tracer.scene import Scene
from tracer.scene.radiance_bound import radiance_bound
from tracer.tree.digits import number_text
from viewer.base.files import Unusable
from viewer.base.progress import Progress as ProgressLine
from viewer.cli.loading import extra
from viewer.cli.options import RenderOptions, limits_of

WIDE = 1e-9  # wider pixels are counted: they hang on an open decision, or rays were cut
SMALL = 500  # pixels of an image for which starting processes takes longer than its bounds


def check_bounds(options: RenderOptions) -> None:
    """Unusable if bounds do not go with the other options."""
    others = {
        "--until-error": options.until_error,
        "--until-seconds": options.until_seconds,
        "--dask": options.dask,
    }
    given = [name for name, value in others.items() if value is not None]
    if options.bounds and given:
        raise Unusable(f"raytree render: --bounds do not go with {' and '.join(given)}")


def bounds_of(world: World, options: RenderOptions, share: Progress) -> Bounds:
    """The bounds of an image. Unusable if the library for them is not installed."""
    view = world.view(options.size)
    processes = 1 if view.width * view.height <= SMALL else options.threads or processors()
    try:
        with extra("render"):
            return render_bounds(
                world,
                samples=options.samples,
                sampler=options.sampler,
                processes=processes,
                progress=share,
                **limits_of(options),
            )
    except BrokenProcessPool:
        raise Unusable("raytree render: a process that works on the bounds was ended from outside") from None


def put_summary(progress: ProgressLine, name: str, scene: Scene, bounds: Bounds) -> None:
    """Print how close the bounds are, and what they do not contain."""
    width = (bounds.high - bounds.low).max(axis=2)
    reason = radiance_bound(scene).reason
    endless = int(np.count_nonzero(np.isinf(width)))
    shown = number_text(float(np.median(width)))
    wide = width[np.isfinite(width) & (width > WIDE)]
    parts = [
        f"{bounds.certified:,} of {bounds.decisions:,} decisions certified",
        f"the median pixel is known to {shown}" if math.isfinite(np.median(width)) else "",
        f'{endless:,} of {width.size:,} pixels have no upper end, because of the material "{reason}"'
        if endless
        else "",
        f"{wide.size:,} have bounds more than {WIDE:g} apart, the worst {number_text(float(wide.max()))}"
        if wide.size
        else "",
    ]
    progress.put_result(name + "bounds: " + "; ".join(part for part in parts if part))
    if not math.isnan(bounds.sampling_error):
        error = f"{bounds.sampling_error:.2g} (RMSE, linear light)"
        progress.put_result(f"{name}estimated sampling error {error}, which the bounds do not contain")


def bounds_stats(bounds: Bounds) -> dict[str, Any]:
    """The part of `--stats` about bounds."""
    height, width, _ = bounds.low.shape
    error = bounds.sampling_error
    return {
        "size": [width, height],
        "samples": bounds.samples,
        "max_nodes": bounds.max_nodes,
        "decisions": bounds.decisions,
        "certified": bounds.certified,
        "estimated_sampling_error": None if math.isnan(error) else error,
    }
