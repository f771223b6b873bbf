"""Counts of surface tests, by hand: every ray is tested against every surface; a shadow ray stops at its first
occluder.
"""

import numpy as np

import tracer
from tests.scenes import MATTE, ball, plane, world_of
from tracer.compile.simd import WIDTH
from tracer.scene import Light, Object
from tracer.shapes.mesh import Geometry, Mesh

SIZE = (40, 30)


def test_without_lights_every_ray_is_tested_against_every_surface() -> None:
    balls = [ball((x, 0, 0), 0.6) for x in (-2, 0, 2)]
    image = tracer.render(world_of(*balls), SIZE)
    assert image.tests == 3 * image.rays["camera"] == 3 * SIZE[0] * SIZE[1]


def test_a_shadow_ray_ends_with_the_first_that_blocks_it() -> None:
    """The floor is lit from above the lid: its shadow rays meet the lid first or second, in the order of the file."""
    floor, lid = plane((0, -1, 0), (0, 1, 0)), plane((0, 4, 0), (0, 1, 0), name="lid")
    lamp = Light("lamp", position=(0, 5, 0))
    for objects, tests in (((floor,), 1), ((lid, floor), 1), ((floor, lid), 2)):
        image = tracer.render(world_of(*objects, lights=[lamp]), SIZE)
        assert image.rays["shadow"] > 0
        assert image.tests == len(objects) * image.rays["camera"] + tests * image.rays["shadow"]


def test_a_block_of_triangles_counts_as_eight() -> None:
    """A block of triangles counts as its eight lanes, then as one for each triangle that the SIMD test keeps: four
    here.
    """
    corners = [[(-90.0, -90.0, -k), (90.0, -90.0, -k), (0.0, 90.0, -k)] for k in range(4)]
    faces = np.arange(12).reshape(4, 3)
    mesh = Object(Mesh(Geometry(np.array(corners, float).reshape(-1, 3), faces, None)), MATTE, "faces")
    image = tracer.render(world_of(mesh), SIZE)
    assert image.tests == (WIDTH + 4) * image.rays["camera"]
