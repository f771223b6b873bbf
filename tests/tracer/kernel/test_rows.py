"""Rows that an image leaves out of its table: rays with factor 1, shadow rays. Colour, counts and ends equal the
tree's.
"""

import numpy as np
import pytest

import tracer
from tests.scenes import MIRROR, ball, kinds, plane, world_of
from tests.tracer.kernel.test_best_first import WHITE, plates
from tracer.formulas.sampler import PIXEL_CENTER
from tracer.formulas.vector import unit
from tracer.kernel.entry import one_pixel, ray_view, trace_list
from tracer.kernel.limits import make_limits
from tracer.kernel.workspace import Workspace
from tracer.scene import Camera, Light, Material


def test_ray_that_passes_on_all_it_gets_keeps_what_was_cut_beside_it() -> None:
    """A perfect mirror that also transmits a little: too little to follow, and counted as cut, in a tree and in an
    image.
    """
    pane = Material("pane", reflect=1.0, transmit=2.0**-10, ior=1.5)
    world = world_of(plane((0, 0, 0), (0, 0, 1), pane), background=WHITE)
    limits = {"depth": 2, "min_weight": 0.5}
    tree = tracer.trace(world, (32, 24), **limits)
    assert tree.residual == 2.0**-10
    image = tracer.render(world, **limits)
    assert image.residual == {"max": 2.0**-10, "mean": 2.0**-10}


def test_dark_surface_that_passes_on_a_part_takes_its_part_in_an_image_too() -> None:
    world = world_of(plane((0, 0, 0), (0, 0, 1), Material("half", reflect=0.5)), background=(0.5, 0.75, 1.0))
    assert (tracer.render(world).pixels == (0.25, 0.375, 0.5)).all()
    # a surface that is black but for one colour of emission counts too
    for color in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)):
        shining = Material("shining", color, ambient=0.5, reflect=1.0)
        assert (tracer.render(world_of(plane((0, 0, 0), (0, 0, 1), shining))).pixels == np.multiply(0.5, color)).all()


def test_mirrors_face_to_face_take_no_room_but_where_they_are_recorded() -> None:
    """100 000 reflections between two mirrors, as an image and as a tree: equal, and the image's table stays short."""
    end = ball((0.5, 100.0, 0), 1.0, Material("end", ambient=1.0, color=(0.3, 0.5, 0.7)), "end")
    walls = (plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((1, 0, 0), (-1, 0, 0), MIRROR, "right"))
    world = world_of(*walls, end, lights=[Light("lamp", position=(0.5, 0.0, 5.0))])
    ray = ((0.5, 0.0, 0.0), (1.0, 2.0**-10, 0.0))
    tree = tracer.trace(world, ray=ray, depth=200_000, max_nodes=10**7)
    assert tree.radiance.tolist() == [0.3, 0.5, 0.7]
    assert tree.depth == 200_000
    assert 90_000 < (tree.nodes["kind"] == 1).sum() < 110_000
    workspace = Workspace(world.eye(ray[0]))
    limits = make_limits(world, depth=200_000, max_nodes=10**7, records=False)
    view = ray_view(ray[0], unit(ray[1]))
    traced = trace_list(world.arrays, view, limits, PIXEL_CENTER.sampler, one_pixel(0, 0), workspace)
    assert traced is not None
    sums, counts = traced
    assert len(workspace.arrays.table) == 256
    assert sums[0, :3].tolist() == tree.radiance.tolist()
    assert kinds(tree).count("reflection") == counts.rays[1]
    assert counts.rays[0] == 1


@pytest.mark.parametrize("max_nodes", [1, 7, 20, 60, 10**6])
def test_an_image_ends_where_the_tree_of_its_pixel_ends(max_nodes: int) -> None:
    """At the limit of rays, too: shadow rays that only a tree traces count in both."""
    glass = Material("glass", transmit=0.9, reflect=0.1, diffuse=0.2, ior=1.5)
    lamps = [Light("near", position=(1.0, 4.0, 4.0)), Light("behind", position=(0.0, -5.0, -3.0))]
    world = world_of(
        ball((0, 0, -3), 1, glass), ball((0.6, 0.4, -5), 1, glass), lights=lamps, background=(0.2, 0.3, 0.4)
    )
    limits = {"tolerance": 1e-3, "max_nodes": max_nodes}
    image = tracer.render(world, (8, 6), threads=1, **limits)
    for x, y in np.ndindex(8, 6):
        tree = tracer.trace(world, (x, y), size=(8, 6), **limits)
        assert image.pixels[y, x].tolist() == tree.radiance.tolist()


def test_rays_are_counted_once_where_the_table_has_to_grow() -> None:
    """A mirror's row is reused by the next one. Then the tree outgrows the table, and the pixel is traced again."""
    mirror = plane((0, 100, 0), (0, -1, 0), MIRROR, "mirror")
    upwards = Camera(position=(0.0, 50.0, 0.0), look_at=(0.0, 100.0, 1.0))
    world = world_of(mirror, *plates(3).scene.objects, camera=upwards)
    limits = {"depth": 14, "model": "fresnel"}
    image = tracer.render(world, (1, 1), threads=1, **limits)
    tree = tracer.trace(world, (0, 0), size=(1, 1), **limits)
    assert len(tree) > 4 * 256
    assert image.rays == {kind: kinds(tree).count(kind) for kind in image.rays}
