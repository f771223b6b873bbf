"""The share of an image that is done, from which the time left follows."""

import itertools
from collections.abc import Callable

import pytest

import tracer
from tests.scenes import MATTE, ball, plane, world_of
from tracer.image.bounds import spread
from tracer.image.render import Goal
from tracer.image.tiles import Tile, make_tiles, scattered
from tracer.image.warmup import fill_cache, missing_kernels
from tracer.measure.check.check import CASES, run_all
from tracer.scene import Light

PARTS: dict[str, Callable[[float, float], bool]] = {  # of an image from 0,0 to 1,1
    "bottom half": lambda x, y: y > 0.5,
    "bottom fifth": lambda x, y: y > 0.8,
    "right third": lambda x, y: x > 2 / 3,
    "corner": lambda x, y: x + y < 1.0,
    "disc": lambda x, y: (x - 0.5) ** 2 + (y - 0.5) ** 2 < 0.06,
}


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("size", [(640, 480), (1920, 1080), (200, 1000)])
def test_tiles_that_are_done_first_are_a_sample_of_all(part: str, size: tuple[int, int]) -> None:
    """If all the work lies in one part of the image, the share of the tiles is the share of the work within a fifth,
    from a tenth of the image on.
    """
    tiles = make_tiles(*size, 16)
    order = scattered(tiles)
    assert sorted(order) == sorted(tiles)

    def is_inside(tile: Tile) -> bool:
        return PARTS[part]((tile.left + 8) / size[0], (tile.top + 8) / size[1])

    total = sum(map(is_inside, tiles))
    for count, done in enumerate(itertools.accumulate(map(is_inside, order)), 1):
        if count >= len(tiles) / 10:
            assert done / total == pytest.approx(count / len(tiles), rel=0.2)


@pytest.mark.parametrize("height", [45, 480, 1080])
def test_rows_of_bounds_that_are_done_first_are_a_sample_of_all(height: int) -> None:
    """Of any band of rows, as many are done as its share of the image says, but for three at most."""
    order = spread(height)
    assert sorted(order) == list(range(height))
    for low, high in ((0.0, 0.3), (0.5, 1.0), (0.4, 0.8)):
        inside = [low * height <= y < high * height for y in order]
        for count, done in enumerate(itertools.accumulate(inside), 1):
            assert abs(done - sum(inside) * count / height) <= 3.0


def test_share_of_a_check_is_that_of_its_expected_seconds() -> None:
    """A family of random problems counts more than a single problem."""
    cases = [one for one in CASES if one.id in ("B1", "D1", "D2")]
    told: list[float] = []
    run_all(cases, told.append)
    total = sum(one.seconds for one in cases)
    assert told == pytest.approx([sum(one.seconds for one in cases[: k + 1]) / total for k in range(3)])
    assert told[0] > 0.9


def test_the_kernels_that_a_check_needs_are_known_before_it_begins() -> None:
    """Those of images and of many rays by hand; after `fill_cache` none is missing."""
    fill_cache(batch=True)
    assert missing_kernels() == missing_kernels(batch=True) == 0


def test_share_of_an_adaptive_image_grows_within_a_round() -> None:
    """An error of 0.1 that shall become 0.05 needs 2^(4/3) times the samples."""
    goal = Goal(error=0.05)
    assert goal.share(float("nan")) == 0.0
    assert goal.share(0.1) == pytest.approx(2.0 ** (-4 / 3))
    assert goal.share(0.1, 2.0) == pytest.approx(2.0 ** (-1 / 3))
    assert goal.share(0.1, 9.0) == 1.0
    checker = world_of(ball(material=MATTE), plane((0, -1, 0), (0, 1, 0)), lights=[Light("lamp", position=(3, 4, 5))])
    shares: list[float] = []
    tracer.render(checker, (128, 96), until_error=0.004, threads=1, progress=shares.append)
    known = [share for share in shares if share > 0.0]
    assert len(set(known)) > 0.5 * len(known) > 5  # not only from round to round
