"""Where an image's error comes from, one source by itself at a time: trees that are cut, pixels that are sampled.

A tree cut at a depth, at the weight of a ray, or when what is left weighs too little in sum, is judged at the pixels'
centres against trees followed to almost nothing. Samples are judged at the scene's own depth, against an image of very
many of another sampler. Together: both, each setting finer in both.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from tracer.measure.errors import errors
from tracer.measure.precision import Method, Reference, Setting, Source, measured
from tracer.render import Image, render
from tracer.scene import Scene
from tracer.world import World

PATIENCE = 6.0  # seconds that an image taken for true may take
PROBE = 12  # pixels across, of the image that tells how long others take
DEEP = 1000  # levels: where it is a weight that cuts, no depth does
TRUE = 1e-9  # of the weight, that the trees taken for true lack at most
MOST_NODES = 20_000  # rays of them, where weights hardly fall

Size = tuple[int, int]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Effort:
    """How far settings go."""

    depths: Sequence[int]
    weights: Sequence[float]
    tolerances: Sequence[float]
    samples: Sequence[int]
    true_samples: int  # a square


FULL = Effort(tuple(range(9)), tuple(10.0**-k for k in range(1, 7)), tuple(10.0**-k for k in range(1, 7)),
              (1, 4, 16, 64, 256), 4096)  # fmt: skip
QUICK = Effort(tuple(range(6)), (1e-1, 1e-2, 1e-3, 1e-4), (1e-1, 1e-2, 1e-3, 1e-4), (1, 4, 16, 64), 576)


def left_out(scene: Scene) -> list[str]:
    """Sources of error that this scene has not, and those that the tracer has not, with the reason."""
    found = ["soft lights, glossy mirrors, lens: every light is a point, every mirror is smooth, the eye is a pinhole"]
    found.append("wavelengths: every index is one number")
    if not _branches(scene):
        found.append("trees that are cut: no surface reflects or transmits, every tree is its camera ray")
    return found


def _branches(scene: Scene) -> bool:
    return any(item.material.reflect > 0.0 or item.material.transmit > 0.0 for item in scene.objects)


def affordable(world: World, size: Size, **how: Any) -> Size:
    """This size, or a smaller one of that shape, so that such an image takes no longer than PATIENCE."""
    probe = (min(size[0], PROBE), max(1, min(size[0], PROBE) * size[1] // size[0]))
    began = time.perf_counter()
    render(world, probe, **how)
    each = (time.perf_counter() - began) / (probe[0] * probe[1])
    share = min(1.0, math.sqrt(PATIENCE / (each * size[0] * size[1])))
    return max(1, round(share * size[0])), max(1, round(share * size[1]))


def sources(
    world: World, size: Size, effort: Effort, progress: Progress = lambda share: None, smaller: bool = False
) -> list[Source]:
    """Every source of error that this scene has, measured on images of that size; `progress` gets the share done.

    `smaller`: where what is taken for true would take too long, images are smaller.
    """
    makers = [_trees, _pixels, _together] if _branches(world.scene) else [_pixels]
    total = sum(_settings(effort, maker) for maker in makers)
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        progress(done / total)

    found = []
    for maker in makers:
        how = _true(maker, effort)
        found.append(maker(world, affordable(world, size, **how) if smaller else size, effort, step))
    return found


def _true(maker: object, effort: Effort) -> dict[str, Any]:
    """How the image is made that a source's are judged against."""
    if maker is _trees:
        return {"tolerance": TRUE, "max_nodes": MOST_NODES}
    return {"samples": effort.true_samples} | ({"depth": max(effort.depths)} if maker is _together else {})


def _settings(effort: Effort, maker: object) -> int:
    """How many markers, and the two images of a reference."""
    trees = len(effort.depths) + len(effort.weights) + len(effort.tolerances)
    return 2 + {_trees: trees, _pixels: 3 * len(effort.samples), _together: len(effort.samples)}[maker]  # type: ignore[index]


def _measure(
    name: str, title: str, about: str, methods: Sequence[Method], reference: Reference, step: Callable[[], None]
) -> Source:
    """Where pixels are sampled a bound on what trees lack says nothing of the error."""
    pairs = [measured(method, reference, step) for method in methods]
    failures = tuple(line for _, lines in pairs for line in lines)
    return Source(name, title, about, reference, tuple(curve for curve, _ in pairs), failures, bounded=name == "trees")


# --- trees that are cut -----------------------------------------------------------------------------------------------


def _trees(world: World, size: Size, effort: Effort, step: Callable[[], None]) -> Source:
    true = render(world, size, tolerance=TRUE, max_nodes=MOST_NODES)
    step()
    deep = render(world, size, depth=DEEP, min_weight=TRUE, max_nodes=MOST_NODES)
    step()
    how = (
        f"trees followed, the heaviest ray first, until what is left weighs {TRUE:g} in sum or they have {MOST_NODES} "
        f"rays: what is missing is {_bounded(true.bound)}. The second way is level by level, up to {DEEP} levels"
    )
    reference = Reference(true.pixels, how, errors(deep.pixels, true.pixels))
    methods = (
        Method("cut at a depth", [Setting(f"depth {d}", d, _made(world, size, depth=d)) for d in effort.depths]),
        Method(
            "cut at a ray's weight",
            [Setting(f"weight {w:g}", w, _made(world, size, depth=DEEP, min_weight=w)) for w in effort.weights],
        ),
        Method(
            "cut at a sum of weights",
            [
                Setting(f"tolerance {t:g}", t, _made(world, size, tolerance=t, max_nodes=MOST_NODES))
                for t in effort.tolerances
            ],
        ),
    )
    about = "What the image lacks where rays are not followed on. Pixels are traced at their centres."
    return _measure("trees", "Trees that are cut", about, methods, reference, step)


def _many(samples: int) -> str:
    return f"{samples} sample{'s' if samples > 1 else ''}"


def _bounded(bound: float) -> str:
    return f"at most {bound:.1e}" if math.isfinite(bound) else "bounded by nothing, for light may add up without end"


def _made(world: World, size: Size, samples: int = 1, **how) -> Callable[[], Image]:
    return lambda: render(world, size, samples, **how)


# --- pixels that are sampled ------------------------------------------------------------------------------------------


def _sampled(world: World, size: Size, effort: Effort, step: Callable[[], None], **how) -> Iterator[Image]:
    """An image of very many samples, and as many by another sampler."""
    for sampler in ("sobol", "jittered"):
        yield render(world, size, effort.true_samples, sampler=sampler, **how)
        step()


def _pixels(world: World, size: Size, effort: Effort, step: Callable[[], None]) -> Source:
    even, jittered = _sampled(world, size, effort, step)
    how = f"{effort.true_samples} samples a pixel that fill it evenly (Sobol's). The second way is as many, jittered"
    reference = Reference(even.pixels, how, errors(jittered.pixels, even.pixels))
    kinds = (("at random", "random", -0.5), ("jittered", "jittered", -0.75), ("evenly (Sobol)", "sobol", -0.75))
    methods = []
    for label, sampler, slope in kinds:
        settings = [Setting(_many(n), n, _made(world, size, n, sampler=sampler)) for n in effort.samples]
        methods.append(Method(label, settings, slope))
    about = (
        "What the mean of a pixel's samples is off. Where a pixel has an edge in it, theory has N^-1/2 for samples at "
        "random and N^-3/4 for jittered ones; smooth pixels do better than that. The scene's own depth."
    )
    return _measure("pixels", "Pixels that are sampled", about, methods, reference, step)


# --- both together ----------------------------------------------------------------------------------------------------


def _together(world: World, size: Size, effort: Effort, step: Callable[[], None]) -> Source:
    deep = max(effort.depths)
    even, jittered = _sampled(world, size, effort, step, depth=deep)
    how = f"{effort.true_samples} samples a pixel (Sobol's) at depth {deep}. The second way is as many, jittered"
    reference = Reference(even.pixels, how, errors(jittered.pixels, even.pixels))
    settings = [
        Setting(f"depth {d}, {_many(n)}", n, _made(world, size, n, depth=d))
        for d, n in zip((1, 2, 3, 4, 6), effort.samples, strict=False)
    ]
    about = "What an image is off that is cut and sampled: finer in both from marker to marker."
    return _measure("together", "Both together", about, [Method("depth and samples", settings)], reference, step)
