"""The arrows of Phong's formula and of reflection are those of the scene, seen from the side; and bars of light."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import ball, world_of
from tests.viewer.lessons.test_live import LAMPS, SHINY, SIZES, context, words
from tracer.scene import Light, Object
from tracer.shapes.polygon import Polygon
from viewer.base.theme import DARK
from viewer.figures.marks import Box, Handle, Line, Mark
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.live.plot import Stacked, stacked_bars

FLOOR = Object(Polygon(((-9.0, 0.0, -9.0), (-9.0, 0.0, 9.0), (9.0, 0.0, 9.0), (9.0, 0.0, -9.0))), SHINY, "floor")


def arrow(marks: list[Mark], name: str) -> np.ndarray:
    """An arrow of a picture, y upwards."""
    (line,) = (mark for mark in marks if isinstance(mark, Line) and mark.name == name)
    return np.subtract(line.end, line.start) * (1.0, -1.0)


@pytest.mark.parametrize("turn", range(0, 360, 24))
def test_phongs_arrows_have_the_sides_of_the_scene(turn: int) -> None:
    """All in the plane of x and y: each arrow is that of the scene, wherever the normal points, by one scale."""
    angle = math.radians(turn)
    normal = np.array([math.cos(angle), math.sin(angle), 0.0])
    aside = np.array([-normal[1], normal[0], 0.0])
    lamp = Light("lamp", position=tuple(normal + 3.0 * normal - 2.0 * aside))
    seen = world_of(ball((0, 0, 0), 1.0, SHINY), lights=[lamp])
    start = 3.0 * normal + 1.5 * aside
    tree = tracer.trace(seen, ray=(tuple(start), tuple(normal - start)), depth=0)
    marks = live_kind("phong").marks(context(seen, tree), {})
    scale = float(np.linalg.norm(arrow(marks, "vector-N")))
    to_light, v = tree.nodes["direction"][1], -tree.nodes["direction"][0]
    mirrored = 2.0 * (normal @ to_light) * normal - to_light
    for name, of in (("N", normal), ("V", v), ("L", to_light), ("R", 0.8 * mirrored)):
        assert arrow(marks, f"vector-{name}") == pytest.approx(scale * of[:2], abs=1e-9 * scale)


def test_in_a_level_plane_of_incidence_the_normal_points_up_and_the_ray_comes_from_the_left() -> None:
    seen = world_of(ball((0, 0, 0), 1.0, SHINY), lights=LAMPS)
    tree = tracer.trace(seen, ray=((3.0, 0.0, 1.0), (-2.0, 0.0, -1.0)), depth=0)
    marks = live_kind("phong").marks(context(seen, tree), {})
    assert arrow(marks, "vector-N")[0] == pytest.approx(0.0, abs=1e-9) and arrow(marks, "vector-N")[1] > 0.0
    assert arrow(marks, "vector-V")[0] < 0.0 and "L rotated into this plane" in words(marks)


def test_bars_of_light_have_one_scale() -> None:
    """1 is all of the width, so that bars of several hits compare; only more than 1 is shown by another scale."""
    lengths = []
    for light in (0.3, 0.6, 1.5):
        part = Stacked("part", np.array([light, 0.0, 0.0]), (1.0, 1.0, 1.0, 1.0), "")
        boxes = [mark for mark in stacked_bars([part], (0.0, 0.0, 300.0, 60.0), 14.0, DARK) if isinstance(mark, Box)]
        (room, *_), (bar,) = ([b for b in boxes if (b.name == "bars") is wanted] for wanted in (True, False))
        lengths.append(bar.size[0] / room.size[0])
    assert lengths == pytest.approx([0.3, 0.6, 1.0])


@pytest.mark.parametrize("times", (0, 1, 2))
def test_the_reflected_direction_is_v_from_which_its_part_along_n_is_taken_away_twice(times: int) -> None:
    seen = world_of(FLOOR, lights=LAMPS)
    tree = tracer.trace(seen, ray=((-3.0, 4.0, 0.0), (3.0, -4.0, 0.0)), depth=1)
    marks = live_kind("reflect").marks(context(seen, tree, size=SIZES[1]), {"times": float(times)})
    scale = np.linalg.norm(arrow(marks, "vector-v"))
    assert arrow(marks, "vector-v") == pytest.approx(scale * np.array([0.6, -0.8]))
    left = scale * np.array([0.6, -0.8 + 0.8 * times])
    assert arrow(marks, "vector-r") == pytest.approx(left)
    parts = [arrow(marks, f"part-{k}") for k in range(times)]
    assert arrow(marks, "vector-v") + sum(parts, np.zeros(2)) == pytest.approx(left)
    said = ("v = (0.6, −0.8, 0)", "v − (n·v) n = (0.6, 0, 0)", "v − 2 (n·v) n = (0.6, 0.8, 0)")[times]
    assert said in words(marks)
    (handle,) = (mark for mark in marks if isinstance(mark, Handle))
    (line,) = (mark for mark in marks if isinstance(mark, Line) and mark.name == "vector-r")
    assert handle.range == (0, 2) and handle.at == pytest.approx(line.end)


def test_phongs_reflection_is_twice_the_part_of_l_along_n_from_which_l_is_taken_away() -> None:
    seen = world_of(
        FLOOR, lights=[Light("lamp", position=(-4.0, 3.0, 0.0)), Light("behind", position=(-6.0, 8.0, 0.0))]
    )
    tree = tracer.trace(seen, ray=((-3.0, 4.0, 0.0), (3.0, -4.0, 0.0)), depth=1)
    marks = live_kind("reflect").marks(context(seen, tree, size=SIZES[1]), {}, ("lamp",))
    scale = np.linalg.norm(arrow(marks, "vector-v"))
    assert arrow(marks, "vector-l") == pytest.approx(scale * np.array([-0.8, 0.6]))
    twice = arrow(marks, "part-0") + arrow(marks, "part-1")
    assert twice == pytest.approx(scale * np.array([0.0, 1.2]), abs=1e-9)
    assert arrow(marks, "vector-R") == pytest.approx(twice + arrow(marks, "vector-l-off"))
    assert arrow(marks, "vector-R") == pytest.approx(scale * np.array([0.8, 0.6]))
    behind = live_kind("reflect").marks(context(seen, tree, size=SIZES[1]), {}, ("behind",))
    assert arrow(behind, "vector-R") == pytest.approx(arrow(behind, "vector-r"))  # l = -v: the two formulas are one
