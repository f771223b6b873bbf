"""A pixel with very many samples: it can be cancelled between two of them, which changes no bit of the sums."""

import numpy as np
import pytest

import tracer
from tracer.formulas.sampler import make_samples
from tracer.image.passes import Stopped
from tracer.kernel.entry import ENOUGH, one_pixel, trace_list
from tracer.kernel.limits import make_limits
from tracer.kernel.workspace import Workspace

MANY = 2**31 - 1  # an hour of work


def parts(world: tracer.World, first: int, end: int, before: np.ndarray | None = None, **options):
    """The sums over these samples of a pixel, and the counts."""
    view = world.view((4, 4))
    limits = make_limits(world, records=False)
    workspace = Workspace(world.eye(view.eye))
    sampler = make_samples(2).sampler
    return trace_list(world.arrays, view, limits, sampler, one_pixel(1, 2, first, end), workspace, before, **options)


def test_sums_are_those_of_smaller_lists(worlds: dict[str, tracer.World]) -> None:
    world, count = worlds["glass-ball"], ENOUGH + 1000
    whole = parts(world, 0, count)
    assert whole is not None
    sums, rays = None, np.zeros_like(whole[1].rays)
    for first in range(0, count, 10_000):
        found = parts(world, first, min(first + 10_000, count), sums)
        assert found is not None
        sums, rays = found[0], rays + found[1].rays
    assert sums is not None and sums.tobytes() == whole[0].tobytes()
    assert rays.tolist() == whole[1].rays.tolist()


def test_a_pixel_is_cancelled_between_its_samples(worlds: dict[str, tracer.World]) -> None:
    assert parts(worlds["glass-ball"], 0, MANY, cancelled=lambda: True) is None


def test_an_image_is_cancelled_between_the_samples_of_a_pixel(worlds: dict[str, tracer.World]) -> None:
    asked = iter([False, False])  # then true
    with pytest.raises(Stopped):
        tracer.render(worlds["glass-ball"], (1, 1), samples=MANY, cancelled=lambda: next(asked, True))
