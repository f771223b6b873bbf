"""Work and precision: what an image costs at each setting of a method, and how far it is from the truth.

The protocol is that of SciML's work-precision diagrams: a curve a method, a marker a setting, both axes logarithmic,
lower left is better. Time is the least of several runs once everything is warm, for others only add to it; what is an
error is worked out when the clock has stopped. What fails is listed, not dropped.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from tracer.image.render import Image
from tracer.measure.check.case import U
from tracer.measure.precision.errors import Errors, errors

ENOUGH = 0.3  # seconds: a run so long is taken once
RUNS = 20  # else so many, or as many as there is time for

Maker = Callable[..., Callable[[], Image]]  # from how an image is made to what makes it


@dataclass(frozen=True)
class Setting:
    """One marker of a method: how the image is made."""

    label: str  # "depth 2"
    value: float  # what the method turns: a depth, a number of samples
    make: Callable[[], Image]


@dataclass(frozen=True)
class Method:
    """`slope` is what theory has of its error against `value`, as a power; None where it has nothing simple to say."""

    name: str
    settings: Sequence[Setting]
    slope: float | None = None


@dataclass(frozen=True)
class Reference:
    """The image that is taken for the truth: how it was made, and how far a second way of making it is from it."""

    pixels: np.ndarray
    how: str
    own: Errors


@dataclass(frozen=True)
class Point:
    """A setting as it was measured.

    `bound` is what the program itself says is missing at most, of any component, and what rounding may add. `tests` are
    of a ray against a surface.
    """

    label: str
    value: float
    seconds: float
    rays: int
    tests: int
    errors: Errors
    bound: float
    estimate: float  # RMSE as the program itself puts it; NaN: it does not


@dataclass(frozen=True)
class Curve:
    method: str
    points: tuple[Point, ...]
    slope: float | None  # theory's
    fitted: float | None  # measured: of RMSE against value, where the reference is still far better


@dataclass(frozen=True)
class Source:
    """One source of error by itself, or several together."""

    name: str
    title: str
    about: str
    reference: Reference
    curves: tuple[Curve, ...]
    failures: tuple[str, ...] = ()
    bounded: bool = False  # whether the program's own bound is one on this error
    exact: bool = False  # whether the reference is a closed form

    @property
    def size(self) -> tuple[int, int]:
        height, width, _ = self.reference.pixels.shape
        return (width, height)


def cuts(
    made: Maker, depths: Sequence[int], weights: Sequence[float], sums: Sequence[float], deep: int, **of_sums: Any
) -> Sequence[Method]:
    """The three ways to cut a tree. Where it is a weight that cuts, no depth does before `deep`."""
    return (
        Method("cut at a depth", [Setting(f"depth {d}", d, made(depth=d)) for d in depths]),
        Method("cut at a ray's weight", [Setting(f"weight {w:g}", w, made(depth=deep, min_weight=w)) for w in weights]),
        Method("cut at a sum of weights", [Setting(f"tolerance {t:g}", t, made(tolerance=t, **of_sums)) for t in sums]),
    )


def counted(total: int, progress: Callable[[float], None]) -> Callable[[], None]:
    """A step of so many, which tells `progress` the share done."""
    done = count(1)
    return lambda: progress(next(done) / total)


def all_measured(
    methods: Sequence[Method], reference: Reference, done: Callable[[], None]
) -> tuple[tuple[Curve, ...], tuple[str, ...]]:
    """Every method's curve, and what failed of them."""
    pairs = [measured(method, reference, done) for method in methods]
    return tuple(curve for curve, _ in pairs), tuple(line for _, lines in pairs for line in lines)


def measured(method: Method, reference: Reference, done: Callable[[], None]) -> tuple[Curve, list[str]]:
    """The method's curve, and what failed of it. `done` is told of every setting."""
    points, failures = [], []
    for setting in method.settings:
        try:
            image, least = repeated(setting.make)
            points.append(point_of(setting.label, setting.value, image, least, reference.pixels))
        except (ValueError, MemoryError) as error:
            failures.append(f"{method.name}, {setting.label}: {error}")
        done()
    for point in points:
        if not math.isfinite(point.errors.rmse):
            failures.append(f"{method.name}, {point.label}: its image has pixels that are no numbers")
    return Curve(
        method.name, tuple(points), method.slope, fitted(points, reference) if method.slope else None
    ), failures


def repeated(make: Callable[[], Image]) -> tuple[Image, float]:
    """An image, and the least seconds that it took."""
    make()  # warm
    least, spent, image = math.inf, 0.0, None
    for _ in range(RUNS):
        began = time.perf_counter()
        image = make()
        took = time.perf_counter() - began
        least, spent = min(least, took), spent + took
        if spent > ENOUGH:
            break
    assert image
    return image, least


def point_of(label: str, value: float, image: Image, least: float, reference: np.ndarray) -> Point:
    off = errors(image.pixels, reference)
    estimate = image.stats.error if image.stats else math.nan
    rays = sum(image.rays.values())
    bound = image.bound + rounding(image, rays)
    return Point(label, value, least, rays, image.tests, off, bound, estimate)


def rounding(image: Image, rays: int) -> float:
    """What rounding may add to a pixel at most, roughly: some units for every ray of its trees."""
    width, height = image.size
    return 4.0 * U * float(np.abs(image.pixels).max()) * rays / (width * height)


def fitted(points: Sequence[Point], reference: Reference) -> float | None:
    """The power of `value` that RMSE falls with; of points whose error the reference's own does not blur."""
    clear = [p for p in points if p.errors.rmse > 4.0 * reference.own.rmse and p.value > 1.0]
    if len(clear) < 3:
        return None
    return float(np.polyfit([math.log(p.value) for p in clear], [math.log(p.errors.rmse) for p in clear], 1)[0])
