"""The sources of an image's error, one at a time: cut trees, sampled pixels, the kernel's formulas.

A tree that is cut at a depth, at a ray's weight, or at a sum of weights, is compared at pixel centres with a tree
that is followed to almost nothing. Samples are compared, at the scene's own depth, with an image of very many
samples of another sampler. Both together: each setting is finer in both.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from tracer.image.render import Image, processors, render
from tracer.image.tiles import speedup, tiles_of
from tracer.image.warmup import warm_up
from tracer.kernel.limits import make_limits
from tracer.kernel.world import World
from tracer.measure.precision.errors import errors
from tracer.measure.precision.experiment import THREADS, Study
from tracer.measure.precision.precision import Maker, Method, Reference, Setting, cuts
from tracer.measure.precision.textbook_kernel import KINDS, textbook_world
from tracer.measure.work import Size, affordable, probed
from tracer.progress import Progress, divided
from tracer.scene import Scene

REFERENCE_WORK = 4e7  # of a reference image whose size was not chosen
REFERENCE_DEPTH = 1000  # depth limit that no tree cut by weight reaches
REFERENCE_TOLERANCE = 1e-9  # tolerance of reference trees: the largest weight that is cut
REFERENCE_WEIGHT = 1e-4  # minimum weight of a ray in references with many samples per pixel
MOST_NODES = 20_000  # rays of a reference's tree, where weights hardly fall

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


def studies(world: World, size: Size, effort: Effort, smaller: bool = False) -> list[Study]:
    """A study of every source of error of this scene, on images of this size.

    `smaller`: images may be smaller if a reference would be too much work.
    """
    warm_up()
    kinds = [trees_cut, pixels_sampled, both_together] if _branches(world.scene) else [pixels_sampled]
    found = [kind(effort).at(world, size, smaller) for kind in kinds]
    return [*found, kernels(world, size)] if effort.kernels else found


@dataclass(frozen=True)
class SceneStudy:
    """A study of any scene: how its references and the images of its settings are made."""

    name: str
    title: str
    about: str
    true: How  # of the reference
    second: How  # of an image made in another way
    said: Callable[[Image], str]  # describes the two
    methods: Callable[[Maker], Sequence[Method]]  # from a function that makes images
    bounded: bool = False  # whether the program's own bound is one on this error

    def at(self, world: World, size: Size, smaller: bool) -> Study:
        """The study of one scene, at this size or a smaller one."""

        def probe(size: Size) -> Image:
            return render(world, size, **self.true)

        if smaller:
            size = affordable(probe, size, REFERENCE_WORK)

        def refer(progress: Progress) -> Reference:
            first, other = divided(progress, [1.0, 1.0])
            true = render(world, size, progress=first, **self.true)
            second = render(world, size, progress=other, **self.second)
            return Reference(true.pixels, self.said(true), errors(second.pixels, true.pixels))

        seconds = sum(_expected_seconds(world, size, how) for how in (self.true, self.second))
        methods = self.methods(_maker(world, size))
        return Study(self.name, self.title, self.about, methods, refer, seconds, self.bounded)


def _expected_seconds(world: World, size: Size, how: How) -> float:
    """The expected time of an image on all processors, from that of a small one on one of them.

    An idle machine divides it by the speedup, a busy one by hardly anything: the root is in between.
    """
    cut = {name: how[name] for name in ("depth", "min_weight", "tolerance", "max_nodes") if name in how}
    tiles = tiles_of(*size, make_limits(world, **cut, records=False).depth)
    probe = probed(lambda size: render(world, size, **how), size)
    return probe.seconds * size[0] * size[1] / probe.pixels / math.sqrt(speedup(tiles, processors()))


def _maker(world: World, size: Size) -> Maker:
    return lambda **how: partial(render, world, size, threads=THREADS, **how)


def kernels(world: World, size: Size) -> Study:
    """The textbook's formulas in double and in single precision, depth by depth, compared with our kernel's image."""
    depths = range(max(world.scene.tracing.depth, 3) + 1)
    ours = [render(world, size, depth=depth).pixels for depth in depths]
    makers = {kind: _maker(textbook_world(kind, world.scene), size) for kind in KINDS}

    def refer(_: Progress) -> Reference:
        how = (
            "our kernel at each depth, with stable formulas in double precision. The second way: the textbook's "
            "formulas"
        )
        return Reference(ours[-1], how, errors(makers["double"](depth=depths[-1])().pixels, ours[-1]))

    return Study(
        "kernels",
        "Kernels in single and double precision",
        "The effect of rounding on the whole image: the same trees by the textbook's formulas, with 53 and with 24 "
        "bits. Edges move by less than a pixel, so the error is mostly in a few samples at edges, and in close "
        "surfaces.",
        [
            Method(
                f"textbook, {kind} precision",
                [
                    Setting(f"depth {depth}", depth, made(depth=depth), true)
                    for depth, true in zip(depths, ours, strict=True)
                ],
            )
            for kind, made in makers.items()
        ],
        refer,
    )


def trees_cut(effort: Effort) -> SceneStudy:
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

    return SceneStudy(
        "trees",
        "Cut trees",
        "The light that an image lacks because rays were not followed. Pixels are traced at their centres.",
        {"tolerance": REFERENCE_TOLERANCE, "max_nodes": MOST_NODES},
        {"depth": REFERENCE_DEPTH, "min_weight": REFERENCE_TOLERANCE, "max_nodes": MOST_NODES},
        said,
        methods,
        bounded=True,
    )


def pixels_sampled(effort: Effort) -> SceneStudy:
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
    return SceneStudy(
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


def both_together(effort: Effort) -> SceneStudy:
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
    return SceneStudy(
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
