"""Edges and corners: rays exactly through them, and rays that start there."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tests.scenes import DARK, MIRROR, OPEN, ball, box, cone, ends, plane, polygon, world_of
from tests.tracer.shapes.test_shapes import LETTER_U, hits
from tracer.scene import Material, Object
from tracer.shapes.polygon import Polygon

GLASS, WATER = Material("glass", transmit=0.9, reflect=0.1, ior=1.5), Material("water", transmit=1.0, ior=1.33)

DIAMOND = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))


def test_ray_level_with_corners_of_a_polygon_is_inside_or_not() -> None:
    """Two edges meet at the height of the ray: its line crosses the outline there once, twice or not at all."""
    for corners, inside, outside in (
        (DIAMOND, (-0.75, 0.25, 0.5), (-2.0, 1.5)),
        (LETTER_U, (0.5, 3.5), (-1.0, 5.0)),
    ):
        y = corners[0][1] if corners is DIAMOND else 1.0
        for outline in (corners, corners[::-1]):
            for turned in (outline, tuple((-b, a, c) for a, b, c in outline)):
                world = world_of(Object(Polygon(turned), OPEN, "face"))
                for x in inside + outside:
                    place = (x, y) if turned is outline else (-y, x)
                    assert hits(world, (*place, 5), (0, 0, -1)) == (x in inside), (turned, place)


def test_box_has_its_edges_and_corners() -> None:
    """A ray that touches a box in one point enters and leaves there, and hits."""
    world = world_of(box((-1, -1, -1), (1, 1, 1), OPEN))
    for point, direction in (
        ((1, 1, 0.25), (1, -1, 0)),
        ((-1, 1, 0.5), (-1, -1, 0)),
        ((0.25, 1, -1), (0, 1, 1)),
        ((1, 1, 1), (2, -1, -1)),
        ((-1, 1, 1), (-1, -2, 1)),
    ):
        assert hits(world, tuple(np.subtract(point, 2.0 * np.array(direction))), direction)


def test_reflected_beyond_the_edge_of_a_cube_it_is_gone() -> None:
    """A ray reflected by the top near its edge leaves over the side: it crosses the plane of the side, but not the
    side.
    """
    top, side = ((-2, 0, -5), (-2, 0, 5), (0, 0, 5), (0, 0, -5)), ((0, 0, -5), (0, 0, 5), (0, -2, 5), (0, -2, -5))
    random = np.random.default_rng(6)
    reflected = 0
    for k in range(16):
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        place = random.normal(size=3)
        objects = []
        for name, face in (("top", top), ("side", side)):
            corners = np.array(face, float) @ turn.T + place
            pieces = [np.delete(corners, 1, axis=0), np.delete(corners, 3, axis=0)] if k % 2 else [corners]
            objects += [polygon(piece, MIRROR, name) for piece in pieces]
        world = world_of(*objects)
        for _ in range(25):
            target = np.array([0.0, 0.0, random.uniform(-4, 4)])
            away = np.array([-random.uniform(0.1, 3), random.uniform(0.1, 3), random.normal()])
            ray = (tuple(turn @ (target + away) + place), tuple(turn @ -away))
            tree = tracer.trace(world, ray=ray, depth=3)
            if tree.object_name(0) == "top":
                reflected += 1
                assert ends(tree) == [None, "background"]
    assert reflected > 130


@pytest.mark.parametrize("height", [0.0, 0.5, -0.3])
def test_reflected_by_a_ball_where_a_plane_cuts_it(height: float) -> None:
    """The hit lies some rounding errors above or below the plane, on whichever side. The reflected ray hits the plane
    there if it goes on to the other side, and is gone if it turns back to the side from which it came.
    """
    world = world_of(ball((0, height, 0), 1.0, MIRROR), plane((0, 0, 0), (0, 1, 0), DARK))
    random = np.random.default_rng(4)
    met = missed = 0
    for _ in range(200):
        angle, r = random.uniform(0, 6), np.sqrt(1.0 - height * height)
        above = random.choice([-1, 1])
        target = np.array([r * np.cos(angle), above * random.uniform(0, 8) * 2.0**-53, r * np.sin(angle)])
        origin = target * 3.0 + random.normal(size=3) * 0.5 + (0.0, above * random.uniform(0.5, 2), 0.0)
        tree = tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=1)
        if tree.object_name(0) != "ball":
            continue
        row = tree.nodes[1]
        goes_on = row["direction"][1] * tree.nodes["direction"][0][1] > 0.0
        met, missed = met + goes_on, missed + (not goes_on)
        if goes_on:
            assert tree.object_name(1) == "plane"
            assert row["t"] == max(-row["origin"][1] / row["direction"][1], 0.0)
        else:
            assert tree.end(1) == "background"
    assert met > 20 and (missed > 20 or height == 0.0)  # at its equator a ball turns no ray back


@pytest.mark.parametrize("model", ["whitted", "fresnel"])
@pytest.mark.parametrize("shape", ["ball", "cone", "cylinder"])
def test_what_stands_in_one_place_twice_is_there_once(shape: str, model: str) -> None:
    """A surface that stands twice at one place acts as one: trees are equal bit for bit from any side."""
    item = {
        "ball": ball((0.3, 0.1, 0.2), 1.1, GLASS),
        "cone": cone((0.1, -1, 0.2), 1.2, (0.3, 1.1, 0.1), 0.4, GLASS),
        "cylinder": cone((0.1, -1, 0.2), 0.9, (0.3, 1.1, 0.1), 0.9, GLASS),
    }[shape]
    again, water = replace(item, name="again"), replace(item, material=WATER, name="water", priority=-1)
    worlds = [world_of(*some, background=(1, 1, 1), model=model) for some in ([item], [item, again], [item, water])]
    random = np.random.default_rng(8)
    for k in range(300):
        eye = random.normal(size=3)
        eye *= (0.2 if k % 4 == 0 and shape == "ball" else 5.0) / np.linalg.norm(eye)
        ray = (eye.tolist(), (random.uniform(-0.8, 0.8, 3) - eye).tolist())
        single, *doubles = (tracer.trace(world, ray=ray, depth=5).nodes.tobytes() for world in worlds)
        assert doubles == [single, single]
