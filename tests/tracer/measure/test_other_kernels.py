"""The kernel with other formulas, in processes of their own: what single precision is worth, what double is."""

import pytest

import tracer
from tracer.compile.jit import cache_folder
from tracer.image.render import render
from tracer.measure.precision.errors import errors
from tracer.measure.precision.otherkernel import images
from tracer.measure.precision.plain import double_of, single_of

SIZE = (80, 60)
SINGLE = 2.0**-24


def test_numbers_of_both_precisions() -> None:
    third = 1.0 / 3.0
    assert double_of(third) == third
    assert 0.0 < abs(float(single_of(third)) - third) <= SINGLE * third


def kept() -> dict[str, float]:
    """This program's own machine code that formulas of the textbook's would change, and when it was written."""
    found = [path for entry in ("tile", "digits") for path in cache_folder().glob(f"*/{entry}.*")]
    return {path.name: path.stat().st_mtime for path in found}


@pytest.mark.slow  # two kernels are compiled
@pytest.mark.parametrize("kind", ["double", "single"])
def test_ordinary_scenes_and_one_with_a_gap_of_1e_9(kind: str, worlds: dict[str, tracer.World]) -> None:
    """Directions of 24 bits move an edge by 1e-7 of the way, so one pixel in thousands; the gap is then not there."""
    ours = kept()
    for name, ordinary in (("two-lights", True), ("plates", True), ("panes", False)):
        world = worlds[name]
        depths = (0, 2)
        for depth, (image, seconds) in zip(depths, images(kind, world.scene, SIZE, depths), strict=True):
            assert seconds > 0.0
            off = errors(image.pixels, render(world, SIZE, depth=depth).pixels)
            if kind == "double":
                assert off.rmse < 1e-9
            elif ordinary:
                assert off.rmse < 1e-2
                assert off.rmse > 1e-13 or depth == 0  # a flat image stays one
            elif depth:
                assert off.rmse > 0.05
    assert kept() == ours  # nothing of theirs is among ours
    assert len(list((cache_folder() / kind).rglob("*.nbi"))) == 2


@pytest.mark.slow
def test_what_a_process_says_when_it_fails(worlds: dict[str, tracer.World]) -> None:
    with pytest.raises(RuntimeError, match="triple"):
        images("triple", worlds["plates"].scene, SIZE, (0,))
