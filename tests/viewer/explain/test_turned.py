"""A hit met at another angle: the same place and media, the angle asked for, Snell's law, and total internal reflection
beyond the critical angle.
"""

import math

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import box, plane, world_of
from tracer.kernel.nodes import SHADOW
from tracer.scene import Light
from viewer.base.values import STEEPEST_INCIDENCE as STEEPEST
from viewer.explain.turned import turned

ANGLES = (0.0, 12.5, 41.0, 41.3, 60.0, STEEPEST)
EPS = np.finfo(float).eps


def check(world: tracer.World, tree: tracer.RayTree, row: int, angle: float) -> bool:
    """Check a turned hit. Returns whether there is one."""
    found = turned(world, tree, row, angle)
    if found is None:
        return False
    hit, met = tree.nodes[row], found.nodes[0]
    theta = math.radians(angle)
    # The errors of the direction and of the normal at the new hit, which a curved surface turns with the place.
    turn = 64.0 * EPS + 4.0 * float(met["error"] + hit["error"]) / float(met["t"] or 1.0)
    assert found.object_name(0) == tree.object_name(row)
    assert (met["n1"], met["n2"]) == (hit["n1"], hit["n2"]) or np.isnan(hit["n2"])
    assert abs(float(met["theta1"]) - theta) <= turn
    if not np.isnan(hit["n2"]):
        sine = float(hit["n1"] / hit["n2"]) * math.sin(theta)
        kinds = {found.kind(c) for c in found.children[0] if found.nodes["kind"][c] != SHADOW}
        assert ("tir" in kinds) == (sine >= 1.0)
        if sine < 1.0:
            assert math.sin(float(met["theta2"])) == pytest.approx(sine, abs=4.0 * turn)
    # It stays in the plane of incidence, and turns away from where the ray went on.
    if hit["theta1"] > 1e-3:
        across = np.cross(hit["direction"], hit["normal"])
        assert abs(float(met["direction"] @ across)) <= turn
        assert (
            angle == 0.0 or float(met["direction"] @ (hit["direction"] + hit["normal"] * np.cos(hit["theta1"]))) > 0.0
        )
    return True


@pytest.mark.parametrize("name", EACH_LESSON)
def test_hits_of_the_lessons(worlds: dict[str, tracer.World], name: str) -> None:
    world = worlds[name]
    width, height = world.scene.image.width, world.scene.image.height
    found = asked = 0
    for pixel in ((width // 2, height // 2), (width // 3, height // 2), (2 * width // 3, 2 * height // 3)):
        tree = tracer.trace(world, pixel, depth=3)
        for row in range(len(tree)):
            if tree.nodes["kind"][row] != SHADOW and tree.object_name(row):
                asked += len(ANGLES)
                found += sum(check(world, tree, row, angle) for angle in ANGLES)
    assert found == asked


def test_there_is_no_such_ray_where_another_surface_is_too_near() -> None:
    """The ray comes from 10^7 above a floor, so the turned one starts 10 beside its hit, behind a wall."""
    wall = box((-3, 4, 0), (3, 5, 5), name="wall")
    world = world_of(plane((0, 0, 0), (0, 0, 1)), wall, lights=[Light("lamp", position=(5, 5, 5))])
    tree = tracer.trace(world, ray=((0.0, 1e-4, 1e7), (0.0, -1e-11, -1.0)), depth=1)
    assert turned(world, tree, 0, 30.0) is not None
    assert turned(world, tree, 0, STEEPEST) is None
