"""An independent program on the shipped scenes: POV-Ray, told of the same surfaces, lights and weights.

Both take a pixel's centre, Whitted's model, depth 3. POV-Ray writes 16 bits a colour, so the same light differs by at
most half a step of 1/65535, and by as much again where its single-precision colours were rounded. At most one pixel
in 5000 may differ by more: beside an edge that passes within rounding of its centre, and where a ray meets the next
surface nearer than POV-Ray can see (its shadow rays leave out the first 0.001, a constant of its source; ours leave
out nothing).
"""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests import povray
from tests.conftest import LESSONS
from viewer import lesson

SIZE = (320, 240)
STEP = 1 / 65535
SAME = 1.5 * STEP
EDGE_SHARE = 1 / 5000
BLIND = 1e-3  # what POV-Ray leaves out at the start of a shadow ray


@pytest.mark.parametrize("name", LESSONS)
def test_image_agrees_with_povray(name: str, tmp_path: Path) -> None:
    assert povray.available(), "this test needs POV-Ray: the Debian package povray"
    scene = tracer.load(lesson.read(name).scene)
    scene = dataclasses.replace(scene, tracing=dataclasses.replace(scene.tracing, model="whitted", depth=3))
    theirs, _, _ = povray.render(povray.write_scene(scene, 3, SIZE), SIZE, tmp_path)
    world = tracer.prepare(scene)
    ours = np.clip(tracer.render(world, SIZE).pixels, 0.0, 1.0)
    differs = np.abs(ours - theirs).max(axis=2) > SAME
    assert differs.mean() <= EDGE_SHARE
    for y, x in np.argwhere(differs):
        around = ours[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2]
        on_edge = np.ptp(around, axis=(0, 1)).max() > 500 * STEP
        nearest = np.nanmin(tracer.trace(world, (int(x), int(y)), size=SIZE).nodes["t"])
        assert on_edge or nearest < BLIND, (x, y)
