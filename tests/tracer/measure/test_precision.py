"""Error against work: measures follow their definitions, slopes follow theory, bounds hold, faults are listed."""

import itertools
import math
import time

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, OPEN, ball, world_of
from tracer.image.render import render
from tracer.measure.precision import experiment, sources
from tracer.measure.precision.errors import Errors, encoded, errors, flip
from tracer.measure.precision.experiment import Experiment, Study
from tracer.measure.precision.precision import Method, Reference, Setting, Source
from tracer.measure.precision.sources import Effort, left_out, studies
from tracer.scene import Camera, Object
from tracer.shapes.polygon import Polygon

TINY = Effort((0, 1, 2, 3), (1e-1, 1e-2), (1e-1, 1e-2, 1e-3), (1, 4, 16), 64, (0.03, 0.01))
SIZE = (16, 12)
EXACT = Errors(0.0, 0.0, 0.0, 0.0)


def measured(method: Method, reference: Reference) -> Source:
    return Experiment(Study("", "", "", [method], lambda progress: reference)).measure(lambda share: None)


def test_measures_by_hand() -> None:
    reference = np.full((1, 2, 3), 0.5)
    pixels = reference.copy()
    pixels[0, 0] = (0.5, 0.8, 0.5)
    off = errors(pixels, reference)
    assert off.rmse == pytest.approx(math.sqrt(0.09 / 6), rel=1e-14)
    assert off.mrse == pytest.approx(0.09 / 0.51**2 / 6, rel=1e-14)
    assert off.largest == pytest.approx(0.3, rel=1e-14)
    assert errors(reference, reference) == EXACT


def test_flip_of_what_could_not_differ_more() -> None:
    """In flat images only colours count: green against blue is the end of FLIP's scale."""
    green, blue = np.zeros((64, 64, 3)), np.zeros((64, 64, 3))
    green[..., 1], blue[..., 2] = 1.0, 1.0
    assert flip(green, blue) == pytest.approx(1.0, abs=0.01)
    assert 0.0 < flip(0.98 * green, green) < flip(0.9 * green, green) < 1.0


TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)  # of linear sRGB (IEC 61966-2-1)


def hunt_lab(linear: np.ndarray) -> np.ndarray:
    """CIE L*a*b* under D65, with a* and b* reduced in the dark (Hunt), as in the FLIP paper."""
    ratio = TO_XYZ @ linear / (TO_XYZ @ np.ones(3))
    x, y, z = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio * (29 / 6) ** 2 / 3 + 4 / 29)
    light = 116.0 * y - 16.0
    return np.array([light, 0.01 * light * 500.0 * (x - y), 0.01 * light * 200.0 * (y - z)])


def flat_flip(a: np.ndarray, b: np.ndarray) -> float:
    """FLIP of two flat images of linear colours, by the paper: no filter changes them, and they have no features."""

    def apart(p: np.ndarray, q: np.ndarray) -> float:
        off = np.abs(hunt_lab(p) - hunt_lab(q))
        return (off[0] + math.hypot(off[1], off[2])) ** 0.7

    most = apart(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    share, knee = apart(a, b) / most, 0.4
    return 0.95 * share / knee if share < knee else 0.95 + 0.05 * (share - knee) / (1.0 - knee)


@pytest.mark.parametrize("colors", [((0.2, 0.2, 0.2), (0.25, 0.2, 0.2)), ((0.9, 0.5, 0.1), (0.1, 0.5, 0.9)),
                                    ((0.01, 0.02, 0.0), (0.03, 0.02, 0.01)), ((1, 1, 1), (0.5, 0.5, 0.5))])  # fmt: skip
def test_flip_of_flat_images_is_the_paper_s(colors: tuple) -> None:
    """The library computes in single precision: its cubes and cube roots leave about 1e-5."""
    a, b = (np.array(color, float) for color in colors)
    images = [encoded(np.broadcast_to(color, (96, 96, 3))) for color in (a, b)]
    assert flip(images[1], images[0]) == pytest.approx(flat_flip(a, b), rel=1e-3)


def test_encoding_is_srgb() -> None:
    light = np.array([0.0, 0.0031308, 0.214041140482, 1.0, 2.0, -1.0])
    assert encoded(light) == pytest.approx([0.0, 0.0404499, 0.5, 1.0, 1.0, 0.0], abs=1e-6)


# --- slopes -----------------------------------------------------------------------------------------------------------

ACROSS, DISTANCE, FOV = 96, 5.0, 40.0
RISE, HEIGHT = 0.37, 0.11  # of the edge: everything below y = RISE x + HEIGHT emits light


def edge_scene() -> tracer.World:
    """A white half plane before a black background, seen at right angles."""
    corners = (
        (-40.0, HEIGHT - 40.0 * RISE, 0.0),
        (-40.0, -99.0, 0.0),
        (40.0, -99.0, 0.0),
        (40.0, HEIGHT + 40.0 * RISE, 0.0),
    )
    camera = Camera((0.0, 0.0, DISTANCE), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), FOV)
    return world_of(Object(Polygon(corners), OPEN, "half"), camera=camera)


def covered(x0: float, x1: float, y0: float, y1: float) -> float:
    """The part of a rectangle below the edge: the mean of min(max(y - y0, 0), y1 - y0) along it, exactly."""
    breaks = [x0, x1, *((y - HEIGHT) / RISE for y in (y0, y1))]
    xs = sorted(x for x in breaks if x0 <= x <= x1)
    heights = [min(max(RISE * x + HEIGHT - y0, 0.0), y1 - y0) for x in xs]
    area = sum(0.5 * (a + b) * (v - u) for u, v, a, b in zip(xs, xs[1:], heights, heights[1:], strict=False))
    return area / ((x1 - x0) * (y1 - y0))


def edge_image() -> np.ndarray:
    """The image of `edge_scene` in closed form."""
    half = DISTANCE * math.tan(math.radians(0.5 * FOV))
    side = 2.0 * half / ACROSS
    image = np.zeros((ACROSS, ACROSS, 3))
    for j in range(ACROSS):
        for i in range(ACROSS):
            left, top = -half + i * side, half - j * side
            image[j, i] = covered(left, left + side, top - side, top)
    return image


@pytest.mark.parametrize(("sampler", "wanted"), (("random", -0.5), ("jittered", -0.75)))
def test_an_edge_in_closed_form_is_approached_as_theory_says(sampler: str, wanted: float) -> None:
    world, reference = edge_scene(), Reference(edge_image(), "closed form", EXACT)
    settings = [
        Setting(f"{n}", n, lambda n=n: render(world, (ACROSS, ACROSS), n, sampler=sampler)) for n in (4, 16, 64, 256)
    ]
    found = measured(Method(sampler, settings, wanted), reference)
    (curve,) = found.curves
    assert found.failures == ()
    assert curve.fitted == pytest.approx(wanted, abs=0.05)


# --- reports ----------------------------------------------------------------------------------------------------------


def test_no_bound_is_below_the_error(worlds: dict[str, tracer.World]) -> None:
    """If the program states an upper bound of the missing light, no pixel misses more, beyond the reference's own
    error.
    """
    (study, *_) = studies(worlds["plates"], SIZE, TINY)
    trees = Experiment(study).measure(lambda share: None)
    assert trees.name == "trees"
    points = [point for curve in trees.curves for point in curve.points]
    assert len(points) == len(TINY.depths) + len(TINY.weights) + len(TINY.tolerances)
    for point in points:
        assert point.errors.largest <= point.bound + trees.reference.own.largest, point.label
    asked = [p for curve in trees.curves for p in curve.points if p.label.startswith("tolerance")]
    assert [p.errors.rmse for p in asked] == sorted((p.errors.rmse for p in asked), reverse=True)


def test_a_scene_that_branches_nowhere_has_no_trees_to_cut() -> None:
    world = world_of(ball(material=MATTE))
    steps: list[float] = []
    (study,) = studies(world, SIZE, TINY)
    pixels = Experiment(study).measure(steps.append)
    assert pixels.name == "pixels"
    assert any("no surface reflects or transmits" in line for line in left_out(world.scene, TINY))
    assert steps == sorted(steps)
    assert steps[-1] == 1.0


def test_what_fails_is_listed_not_dropped() -> None:
    world = world_of(ball(material=MATTE))
    reference = Reference(np.zeros((12, 16, 3)), "nothing", EXACT)
    settings = [
        Setting("5 samples", 5, lambda: render(world, SIZE, 5, sampler="jittered")),
        Setting("4 samples", 4, lambda: render(world, SIZE, 4, sampler="jittered")),
    ]
    found = measured(Method("jittered", settings), reference)
    (curve,) = found.curves
    assert [point.label for point in curve.points] == ["4 samples"]
    assert found.failures == ("jittered, 5 samples: jittered samples must be a square number like 4, got 5",)


# --- runs -------------------------------------------------------------------------------------------------------------


def test_all_settings_run_in_turn_and_as_often_as_their_work_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every setting runs once for its work; then in rounds, from the first to the last, however long it takes."""
    monkeypatch.setattr(experiment, "FEWEST", 5)
    monkeypatch.setattr(experiment, "MOST", 20)
    world = world_of(ball(material=MATTE))
    ran: list[str] = []

    def setting(label: str, samples: int) -> Setting:
        def make() -> tracer.Image:
            ran.append(label)
            return render(world, (64, 48), samples, threads=1)

        return Setting(label, samples, make)

    methods = [Method("few", [setting("a", 1), setting("b", 4)]), Method("many", [setting("c", 256)])]
    reference = Reference(np.zeros((48, 64, 3)), "nothing", EXACT)
    tried = Experiment(Study("", "", "", methods, lambda progress: reference))
    assert ran == ["a", "b", "c"]
    found = tried.measure(lambda share: None)
    runs = {point.label: point.times.runs for curve in found.curves for point in curve.points}
    assert (runs["a"], runs["c"]) == (20, 5)
    assert {label: ran.count(label) - 1 for label in ran} == runs
    turns = "".join(ran[3:])
    assert turns.replace("c", "") == "ab" * 20
    gaps = [len(part) for part in turns.split("c")]
    assert max(gaps[1:]) - min(gaps[1:-1]) <= 2
    assert gaps[0] <= max(gaps[1:])


def test_size_follows_from_counts_and_not_from_a_clock(
    worlds: dict[str, tracer.World], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A clock on which everything takes a day changes no size, no work and no number of runs."""
    monkeypatch.setattr(experiment, "MOST", 20)
    monkeypatch.setattr(sources, "REFERENCE_WORK", 1e6)

    def found() -> list[tuple]:
        given = [Experiment(study) for study in studies(worlds["plates"], (400, 300), TINY, smaller=True)]
        return [
            (one.study.name, [(trial.setting.label, trial.work, trial.runs) for trial in one.trials]) for one in given
        ]

    fast = found()
    day = itertools.count(0.0, 86400.0)
    for name in ("perf_counter", "process_time"):
        monkeypatch.setattr(time, name, lambda: next(day))
    assert found() == fast
