"""The share of an image that is done, from which the time left follows."""

import itertools
from collections.abc import Callable

import pytest

import tracer
from tests.scenes import MATTE, ball, plane, world_of
from tracer.image.render import Goal
from tracer.image.tiles import Tile, make_tiles, scattered
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
