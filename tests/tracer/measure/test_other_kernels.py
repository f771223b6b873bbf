"""The textbook's formulas in the kernel, in double and in single precision."""

import pytest

import tracer
from tracer.image.render import render
from tracer.measure.precision.errors import errors
from tracer.measure.precision.textbook_kernel import textbook_world, to_double, to_single

SIZE = (80, 60)
SINGLE = 2.0**-24


def test_numbers_of_both_precisions() -> None:
    third = 1.0 / 3.0
    assert to_double(third) == third
    assert 0.0 < abs(float(to_single(third)) - third) <= SINGLE * third


@pytest.mark.slow  # compiles two kernels
@pytest.mark.parametrize("kind", ["double", "single"])
def test_ordinary_scenes_and_one_with_a_gap_of_1e_9(kind: str, worlds: dict[str, tracer.World]) -> None:
    """In single precision a direction moves an edge by 1e-7 of the distance: one pixel in thousands. A gap of 1e-9 is
    lost.
    """
    for name, ordinary in (("two-lights", True), ("plates", True), ("panes", False)):
        world = worlds[name]
        textbook = textbook_world(kind, world.scene)
        for depth in (0, 2):
            off = errors(render(textbook, SIZE, depth=depth).pixels, render(world, SIZE, depth=depth).pixels)
            if kind == "double":
                assert off.rmse < 1e-9
            elif ordinary:
                assert off.rmse < 1e-2
                assert off.rmse > 1e-13 or depth == 0  # a flat image stays flat
            elif depth:
                assert off.rmse > 0.05
