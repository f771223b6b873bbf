"""Work-precision diagrams: the cost and the error of an image at each setting of a method.

The protocol is SciML's: one curve per method, one marker per setting, logarithmic axes; lower left is better.
`experiment.py` measures them. What fails is listed, not dropped.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tracer.image.render import Image
from tracer.measure.check.case import U
from tracer.measure.precision.errors import Errors, errors
from tracer.measure.timing import Times

Maker = Callable[..., Callable[[], Image]]  # from the options of `render` to a function that renders


@dataclass(frozen=True)
class Setting:
    """One marker of a method."""

    label: str  # for example "depth 2"
    value: float  # what the method varies: a depth, or a number of samples
    make: Callable[[], Image]
    reference: np.ndarray | None = None  # the pixels that it is compared with; None: those of all the settings


@dataclass(frozen=True)
class Method:
    """A way to make images. `slope` is theory's exponent of the error as a power of `value`; None if there is none."""

    name: str
    settings: Sequence[Setting]
    slope: float | None = None


@dataclass(frozen=True)
class Reference:
    """The reference image: how it was made, and its distance from an image that was made in another way."""

    pixels: np.ndarray
    how: str
    own: Errors


@dataclass(frozen=True)
class Point:
    """A measured setting.

    `bound` is the program's own bound on the missing light of a component, plus rounding. `tests` counts ray-surface
    intersection tests.
    """

    label: str
    value: float
    times: Times
    rays: int
    tests: int
    errors: Errors
    bound: float
    estimate: float  # the program's own estimate of the RMSE; NaN: it has none


@dataclass(frozen=True)
class Curve:
    method: str
    points: tuple[Point, ...]
    slope: float | None  # of theory
    fitted: float | None  # measured: of RMSE against value, over the markers with an error well above the reference's


@dataclass(frozen=True)
class Source:
    """One source of error, or several together."""

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
    """The three ways to cut a tree. Weights are tried with the depth `deep`, which cuts nothing."""
    return (
        Method("cut at a depth", [Setting(f"depth {d}", d, made(depth=d)) for d in depths]),
        Method("cut at a ray's weight", [Setting(f"weight {w:g}", w, made(depth=deep, min_weight=w)) for w in weights]),
        Method("cut at a sum of weights", [Setting(f"tolerance {t:g}", t, made(tolerance=t, **of_sums)) for t in sums]),
    )


def point_of(setting: Setting, image: Image, times: Times, reference: Reference) -> Point:
    """A marker: the image of a setting, and how long it took."""
    off = errors(image.pixels, reference.pixels if setting.reference is None else setting.reference)
    estimate = image.stats.error if image.stats else math.nan
    rays = sum(image.rays.values())
    bound = image.bound + rounding(image, rays)
    return Point(setting.label, setting.value, times, rays, image.tests, off, bound, estimate)


def rounding(image: Image, rays: int) -> float:
    """A rough bound on the rounding errors of a pixel: some units for every ray of its trees."""
    width, height = image.size
    return 4.0 * U * float(np.abs(image.pixels).max()) * rays / (width * height)


def fitted(points: Sequence[Point], reference: Reference) -> float | None:
    """The fitted exponent of RMSE against `value`, over the points with an error well above the reference's."""
    clear = [p for p in points if p.errors.rmse > 4.0 * reference.own.rmse and p.value > 1.0]
    if len(clear) < 3:
        return None
    return float(np.polyfit([math.log(p.value) for p in clear], [math.log(p.errors.rmse) for p in clear], 1)[0])
