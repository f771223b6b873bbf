"""The sources of an image's error, one at a time: cut trees, sampled pixels, the kernel's formulas.

A tree that is cut at a depth, at a ray's weight, or at a sum of weights, is compared at pixel centres with a tree
that is followed to almost nothing. Samples are compared, at the scene's own depth, with an image of very many
samples of another sampler. Both together: each setting is finer in both.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from tracer.image.render import Image, render
from tracer.kernel.world import World
from tracer.measure.precision.errors import NOTHING, errors
from tracer.measure.precision.precision import (
    Curve,
    Maker,
    Method,
    Reference,
    Setting,
    Source,
    all_measured,
    counted,
    cuts,
    point_of,
)
from tracer.measure.precision.textbook_kernel import KINDS, images
from tracer.scene import Scene

PATIENCE = 6.0  # seconds that a reference image may take
PROBE = 12  # pixels across, of the image that is timed first
REFERENCE_DEPTH = 1000  # depth limit that no tree cut by weight reaches
REFERENCE_TOLERANCE = 1e-9  # tolerance of reference trees: the largest weight that is cut
REFERENCE_WEIGHT = 1e-4  # minimum weight of a ray in references with many samples per pixel
MOST_NODES = 20_000  # rays of a reference's tree, where weights hardly fall

Size = tuple[int, int]
Progress = Callable[[float], None]
How = Mapping[str, Any]  # options of `render`


@dataclass(frozen=True)
class Effort:
    """The range of settings."""

    depths: Sequence[int]
    weights: Sequence[float]
    tolerances: Sequence[float]
    samples: Sequence[int]
    true_samples: int  # of the reference; a square
    errors: Sequence[float]  # goals of adaptive sampling
    kernels: bool = False  # whether other kernels are compiled, which takes a minute the first time


FULL = Effort(tuple(range(9)), tuple(10.0**-k for k in range(1, 7)), tuple(10.0**-k for k in range(1, 7)),
              (1, 4, 16, 64, 256), 4096, (0.03, 0.01, 0.003, 0.001, 0.0005), True)  # fmt: skip
QUICK = Effort(
    tuple(range(6)), (1e-1, 1e-2, 1e-3, 1e-4), (1e-1, 1e-2, 1e-3, 1e-4), (1, 4, 16, 64), 576, (0.03, 0.01, 0.003)
)


def left_out(scene: Scene, effort: Effort) -> list[str]:
    """Sources of error that this scene does not have, and those that the tracer does not have, with reasons."""
    found = ["soft lights, glossy mirrors, lens: every light is a point, every mirror is smooth, the eye is a pinhole"]
    found.append("wavelengths: every index is one number")
    if not effort.kernels:
        found.append("kernels in other precision: they take a minute to compile; a report without --quick has them")
    if not _branches(scene):
        found.append("cut trees: no surface reflects or transmits, so every tree is one ray")
    return found


def _branches(scene: Scene) -> bool:
    return any(item.material.reflect > 0.0 or item.material.transmit > 0.0 for item in scene.objects)


def affordable(world: World, size: Size, how: How) -> Size:
    """This size, or a smaller one of the same proportions with which a reference takes no longer than PATIENCE."""
    probe = (min(size[0], PROBE), max(1, min(size[0], PROBE) * size[1] // size[0]))
    began = time.perf_counter()
    render(world, probe, **how)
    each = (time.perf_counter() - began) / (probe[0] * probe[1])
    share = min(1.0, math.sqrt(PATIENCE / (each * size[0] * size[1])))
    return max(1, round(share * size[0])), max(1, round(share * size[1]))


@dataclass(frozen=True)
class Study:
    """The measurement of a source of error: its reference, and the settings of each method."""

    name: str
    title: str
    about: str
    true: How  # of the reference
    second: How  # of an image made in another way
    said: Callable[[Image], str]  # describes the two
    methods: Callable[[Maker], Sequence[Method]]  # from a function that makes images
    bounded: bool = False  # whether the program's own bound is one on this error

    def run(self, world: World, size: Size, step: Callable[[], None]) -> Source:
        """Measure the source. Calls `step` for every reference and every setting."""
        true = render(world, size, **self.true)
        step()
        second = render(world, size, **self.second)
        step()
        reference = Reference(true.pixels, self.said(true), errors(second.pixels, true.pixels))
        curves, failures = all_measured(self.methods(_maker(world, size)), reference, step)
        return Source(self.name, self.title, self.about, reference, curves, failures, self.bounded)

    def steps(self, world: World) -> int:
        return 2 + sum(len(method.settings) for method in self.methods(_maker(world, (1, 1))))


def _maker(world: World, size: Size) -> Maker:
    return lambda **how: partial(render, world, size, **how)


def sources(
    world: World, size: Size, effort: Effort, progress: Progress = lambda share: None, smaller: bool = False
) -> list[Source]:
    """Measure every source of error of this scene on images of this size. `progress` is called with the share.

    `smaller`: images may be smaller if a reference would take too long.
    """
    kinds = [trees_cut, pixels_sampled, both_together] if _branches(world.scene) else [pixels_sampled]
    studies = [kind(effort) for kind in kinds]
    total = sum(study.steps(world) for study in studies) + (len(KINDS) if effort.kernels else 0)
    step = counted(total, progress)
    found = [study.run(world, affordable(world, size, study.true) if smaller else size, step) for study in studies]
    return [*found, kernels(world, size, step)] if effort.kernels else found


def kernels(world: World, size: Size, step: Callable[[], None]) -> Source:
    """The textbook's formulas in double and in single precision, depth by depth, compared with our kernel's image."""
    depths = range(max(world.scene.tracing.depth, 3) + 1)
    ours = [render(world, size, depth=depth).pixels for depth in depths]
    curves, own = [], NOTHING
    for kind in KINDS:
        name = f"textbook, {kind} precision"
        found = images(kind, world.scene, size, depths)
        step()
        points = [
            point_of(f"depth {depth}", depth, image, least, true)
            for depth, (image, least), true in zip(depths, found, ours, strict=True)
        ]
        curves.append(Curve(name, tuple(points), None, None))
        own = points[-1].errors if kind == "double" else own
    how = "our kernel at each depth, with stable formulas in double precision. The second way: the textbook's formulas"
    return Source(
        "kernels",
        "Kernels in single and double precision",
        "The effect of rounding on the whole image: the same trees by the textbook's formulas, with 53 and with 24 "
        "bits. Edges move by less than a pixel, so the error is mostly in a few samples at edges, and in close "
        "surfaces.",
        Reference(ours[-1], how, own),
        tuple(curves),
        (),
    )


def trees_cut(effort: Effort) -> Study:
    def said(true: Image) -> str:
        missing = (
            f"at most {true.bound:.1e}"
            if math.isfinite(true.bound)
            else "not bounded, because the radiance may grow without limit"
        )
        return (
            f"best-first trees, until the weights of the rest sum up to {REFERENCE_TOLERANCE:g} or they have "
            f"{MOST_NODES} rays: the missing light is {missing}. The second way is level by level, up to "
            f"{REFERENCE_DEPTH} levels"
        )

    def methods(made: Maker) -> Sequence[Method]:
        return cuts(made, effort.depths, effort.weights, effort.tolerances, REFERENCE_DEPTH, max_nodes=MOST_NODES)

    return Study(
        "trees",
        "Cut trees",
        "The light that an image lacks because rays were not followed. Pixels are traced at their centres.",
        {"tolerance": REFERENCE_TOLERANCE, "max_nodes": MOST_NODES},
        {"depth": REFERENCE_DEPTH, "min_weight": REFERENCE_TOLERANCE, "max_nodes": MOST_NODES},
        said,
        methods,
        bounded=True,
    )


def pixels_sampled(effort: Effort) -> Study:
    kinds = (("at random", "random", -0.5), ("jittered", "jittered", -0.75), ("evenly (Sobol)", "sobol", -0.75))

    def methods(made: Maker) -> Sequence[Method]:
        found = [
            Method(label, [Setting(_many(n), n, made(samples=n, sampler=sampler)) for n in effort.samples], slope)
            for label, sampler, slope in kinds
        ]
        settings = [Setting(f"error {e:g}", e, made(until_error=e)) for e in effort.errors]
        return [*found, Method("adaptive", settings)]

    how = f"{effort.true_samples} Sobol samples per pixel. The second way has as many jittered ones"
    true = {"samples": effort.true_samples}
    return Study(
        "pixels",
        "Sampled pixels",
        "The error of the mean of a pixel's samples. At edges, theory has N^-1/2 for random samples and N^-3/4 for "
        "jittered ones; smooth pixels converge faster. Adaptive: until the estimated error of the "
        "image is at most the requested one. Trees have the scene's own depth.",
        true,
        {**true, "sampler": "jittered"},
        lambda _: how,
        methods,
    )


def both_together(effort: Effort) -> Study:
    def methods(made: Maker) -> Sequence[Method]:
        settings = [
            Setting(f"depth {d}, {_many(n)}", n, made(samples=n, depth=d))
            for d, n in zip((1, 2, 3, 4, 6), effort.samples, strict=False)
        ]
        both = [
            Setting(f"error {e:g}", e, made(until_error=e, tolerance=0.1 * e, max_nodes=MOST_NODES))
            for e in effort.errors
        ]
        return [Method("depth and samples", settings), Method("adaptive samples, best-first trees", both)]

    how = (
        f"{effort.true_samples} Sobol samples per pixel, and every ray with a weight of at least {REFERENCE_WEIGHT:g}. "
        "The second way has as many jittered samples"
    )
    true = {
        "samples": effort.true_samples,
        "depth": REFERENCE_DEPTH,
        "min_weight": REFERENCE_WEIGHT,
        "max_nodes": MOST_NODES,
    }
    return Study(
        "together",
        "Both together",
        "The error of an image whose trees are cut and whose pixels are sampled: with a larger depth and more samples "
        "from marker to marker; or by adaptive sampling of trees that are cut at a tenth of the requested error.",
        true,
        {**true, "sampler": "jittered"},
        lambda _: how,
        methods,
    )


def _many(samples: int) -> str:
    return f"{samples} sample{'s' if samples > 1 else ''}"
