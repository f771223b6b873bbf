"""Images in closed form: the errors that a report measures equal those of theory."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import DARK, MATTE, OPEN, disc, world_of
from tests.tracer.measure.test_precision import ACROSS, DISTANCE, EXACT, FOV, HEIGHT, RISE, edge_image, measured
from tracer.image.render import render
from tracer.measure.check.case import U
from tracer.measure.precision.errors import errors
from tracer.measure.precision.experiment import Experiment
from tracer.measure.precision.precision import Curve, Method, Reference, Setting, Source
from tracer.measure.precision.stiff import BOUNCES, KEPT, MIRRORED, PROBLEMS, Problem, study_of
from tracer.scene import Camera, Light, Object
from tracer.shapes.polygon import Polygon

CAMERA = Camera((0.0, 0.0, DISTANCE), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), FOV)
WALL = Object(Polygon(((-99.0, -99.0, 0.0), (99.0, -99.0, 0.0), (99.0, 99.0, 0.0), (-99.0, 99.0, 0.0))), MATTE, "wall")
SIDE = 2.0 * DISTANCE * math.tan(math.radians(0.5 * FOV))  # of the image, where its objects stand


def curves(world: tracer.World, across: int, true: np.ndarray, sampler: str, counts: tuple[int, ...]) -> Curve:
    settings = [
        Setting(f"{n}", n, lambda n=n: render(world, (across, across), samples=n, sampler=sampler)) for n in counts
    ]
    found = measured(Method(sampler, settings, -0.5), Reference(true, "closed form", EXACT))
    assert found.failures == ()
    return found.curves[0]


def test_a_disc_of_known_area_in_every_pixel() -> None:
    """A random sample hits with the probability A of the disc's area: the mean square error is A (1 - A) / N."""
    across, radius = 20, 0.35  # of a pixel
    pixel = SIDE / across
    places = [(-0.5 * SIDE + (k + 0.5) * pixel) for k in range(across)]
    world = world_of(
        *(disc((x, y, 0.0), (0, 0, 1), radius * pixel, OPEN) for x in places for y in places), camera=CAMERA
    )
    area = math.pi * radius**2
    curve = curves(world, across, np.full((across, across, 3), area), "random", (1, 4, 16, 64, 256))
    for point in curve.points:
        # 400 pixels: the estimate of a variance has a relative spread of sqrt(2 / 400), its root half of that.
        assert point.errors.rmse == pytest.approx(math.sqrt(area * (1.0 - area) / point.value), rel=3.0 * 0.5 * 0.0707)
    assert curve.fitted == pytest.approx(-0.5, abs=0.05)


def shadow_edge() -> tracer.World:
    """A wall seen at right angles, half in the shadow of a half plane near the lamp: the edge of `edge_image` again."""
    lamp = (0.0, 0.0, 20.0)
    share = 0.25  # of the way from the wall to the lamp, where the half plane stands
    corners = [(-90.0, HEIGHT - 90.0 * RISE), (90.0, HEIGHT + 90.0 * RISE), (90.0, 200.0), (-90.0, 200.0)]
    shade = Polygon(tuple(((1.0 - share) * x, (1.0 - share) * y, share * 20.0) for x, y in corners))
    return world_of(WALL, Object(shade, DARK, "shade"), lights=[Light("lamp", lamp)], camera=CAMERA)


@pytest.mark.parametrize(("sampler", "slope"), (("random", -0.5), ("jittered", -0.75)))
def test_the_edge_of_a_shadow(sampler: str, slope: float) -> None:
    """Lit samples have the cosine of the lamp instead of 1: the error of the edge times the light there."""
    world = shadow_edge()
    lit = render(world, (ACROSS, ACROSS), samples=1024).pixels
    share = edge_image()
    bright = lit[share == 1.0]
    assert (lit[share == 0.0] == 0.0).all()
    assert 0.9 < bright.min() < bright.max() <= 1.0
    edges = (share > 0.0) & (share < 1.0)
    curve = curves(world, ACROSS, lit, sampler, (4, 16, 64))
    assert curve.fitted == pytest.approx(slope, abs=0.07)
    if sampler == "random":
        expected = math.sqrt(float(np.mean(np.where(edges, share * (1.0 - share), 0.0))))
        for point in curve.points:
            # About 100 pixels are on the edge; the light there is 0.93 to 1 of that in the middle.
            assert point.errors.rmse == pytest.approx(expected / math.sqrt(point.value), rel=0.07 + 3.0 * 0.0707)


def test_a_smooth_pixel() -> None:
    """A wall under a lamp: for an integrand that is smooth in a pixel, jittered sampling converges as N^-1."""
    world = world_of(WALL, lights=[Light("lamp", (0.6, 0.4, 0.9))], camera=CAMERA)
    size, counts = (16, 16), (16, 64, 256, 1024)
    true = render(world, size, samples=65536).pixels
    settings = [Setting(f"{n}", n, lambda n=n: render(world, size, samples=n, sampler="jittered")) for n in counts]
    (curve,) = measured(Method("jittered", settings, -1.0), Reference(true, "very many", EXACT)).curves
    assert curve.fitted == pytest.approx(-1.0, abs=0.05)


def solved(problem: Problem) -> Source:
    return Experiment(study_of(problem)).measure(lambda share: None)


@pytest.fixture(scope="module")
def found() -> dict[str, Source]:
    return {problem.name: solved(problem) for problem in PROBLEMS}


def at(source: Source, method: int) -> dict[float, float]:
    """The largest error, for each value of the method's parameter."""
    return {point.value: point.errors.largest for point in source.curves[method].points}


def test_no_bound_is_below_an_error(found: dict[str, Source]) -> None:
    for problem in PROBLEMS:
        source = found[problem.name]
        points = [point for curve in source.curves for point in curve.points]
        assert len(points) == len(problem.depths) + len(problem.weights) + len(problem.tolerances)
        assert source.failures == ()
        for point in points:
            assert point.errors.largest <= point.bound < math.inf, (problem.name, point.label)


def test_the_shell_s_depth_cut_is_the_rest_of_its_series(found: dict[str, Source]) -> None:
    exact = 1.0 / (1.0 - KEPT)
    for depth, error in at(found["shell"], 0).items():
        # The remainder of a sum of `depth` numbers, each rounded once.
        assert error == pytest.approx(exact * KEPT ** (depth + 1), abs=(depth + 8) * U * exact)
    for point in found["shell"].curves[0].points:
        assert point.bound == pytest.approx(point.errors.largest, rel=1e-12, abs=2000 * U * exact)


def test_the_drop_lacks_a_power_of_its_reflectance(found: dict[str, Source]) -> None:
    """The ray at 4/5 of the radius: R = 49/1250. Depth d > 0 misses the light still inside, (1 - R) R^(d - 1)."""
    r = 49.0 / 1250.0
    errors_at = at(found["drop"], 0)
    assert errors_at.pop(0) == 1.0
    for depth, error in errors_at.items():
        assert error == pytest.approx((1.0 - r) * r ** (depth - 1), rel=1e-12, abs=16 * U)


def test_the_corridor_s_light_comes_at_its_last_bounce_or_not_at_all(found: dict[str, Source]) -> None:
    whole = MIRRORED**BOUNCES
    for depth, error in at(found["corridor"], 0).items():
        assert error == (
            pytest.approx(whole, rel=2 * BOUNCES * U) if depth < BOUNCES else pytest.approx(0.0, abs=BOUNCES * U)
        )
    for weight, error in at(found["corridor"], 1).items():
        assert (error > 0.5) == (weight > whole)


def test_the_slab_s_sum_and_the_pile_s_come_within_what_was_asked(found: dict[str, Source]) -> None:
    for name, bright in (("slab", 1.0), ("pile", 1.0)):
        for tolerance, error in at(found[name], 2).items():
            assert error <= tolerance * bright
    assert max(at(found["slab"], 1).values()) == pytest.approx(found["slab"].reference.pixels[0, 0, 0], rel=1e-9)


def test_measures_of_a_cut_are_of_the_closed_form() -> None:
    """A source's table of errors holds the errors of its images."""
    problem: Problem = PROBLEMS[-1]
    source = solved(problem)
    point = source.curves[0].points[0]
    pixels = source.reference.pixels - point.errors.largest
    assert point.errors.rmse == pytest.approx(errors(pixels, source.reference.pixels).rmse, rel=1e-12)
