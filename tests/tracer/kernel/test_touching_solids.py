"""Closed means closed: rays through edges and corners, where boxes and meshes with grid coordinates touch."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import MIRROR, ball, box, cube_mesh, ends, kinds, plane, polygon, world_of
from tracer.formulas.vector import as_floats
from tracer.scene import Material, Object
from tracer.shapes.box import Box

ROOMS = [((-1, -1, -1), (1, 1, 1)), ((-3, -0.7, -0.1), (2.3, 1.9, 5.7)), ((-1e3, -1e-3, -2), (1e3, 1e-3, 7))]


@pytest.mark.parametrize(("low", "high"), ROOMS)
@pytest.mark.parametrize("free", [1, 0])
def test_no_ray_leaves_a_room_of_mirrors_through_an_edge_or_a_corner(
    low: tuple[float, ...], high: tuple[float, ...], free: int
) -> None:
    """200 rays at edges (one coordinate is free) or at corners, from the middle and from elsewhere, 20 mirrors deep."""
    world = world_of(box(low, high, MIRROR))
    random = np.random.default_rng(1)
    bottom, top = np.array(low, float), np.array(high, float)
    for k in range(200):
        target = np.where(random.random(3) < 0.5, bottom, top)
        if free:
            axis = random.integers(3)
            target[axis] = random.uniform(bottom[axis], top[axis])
        eye = 0.5 * (bottom + top) + (top - bottom) * random.uniform(-0.3, 0.3, 3) * (k % 2)
        tree = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=20)
        assert "background" not in ends(tree)


@pytest.mark.parametrize("shape", ["boxes", "meshes", "both"])
def test_medium_of_every_ray_is_that_of_the_solids_it_runs_in(shape: str) -> None:
    """Two to four glass blocks with whole coordinates, touching or overlapping: rays at their edges and corners, and
    six hits deep. The medium at three points of each ray follows from the blocks alone.
    """
    random = np.random.default_rng(3)
    asked = 0
    for scene in range(60):
        blocks = []
        for k in range(int(random.integers(2, 5))):
            low = random.integers(-3, 3, 3)
            blocks.append((low, low + random.integers(1, 4, 3), (1.33, 1.5, 1.7, 1.2)[k], int(random.integers(2))))
        objects = []
        for k, (low, high, n, priority) in enumerate(blocks):
            is_box = shape == "boxes" or (shape == "both" and k % 2)
            form = Box(as_floats(low), as_floats(high)) if is_box else cube_mesh(low, high)
            objects.append(Object(form, Material(f"glass {k}", transmit=1.0, ior=n), f"block {k}", priority=priority))
        world = world_of(*objects, model=("whitted", "fresnel")[scene % 2])
        ranked = sorted(blocks, key=lambda block: -block[3])
        for k in range(8):
            eye = random.integers(-8, 9, 3).astype(float)
            eye[random.integers(3)] = random.choice((-8.0, 8.0))
            low, high, _, _ = blocks[random.integers(len(blocks))]
            target = np.where(random.random(3) < 0.5, low, high).astype(float)
            if k % 2:
                target[random.integers(3)] = random.integers(-3, 4)
            if (target == eye).all():
                continue
            tree = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=6)
            for row in tree.nodes:
                length = min(float(row["t"]), 50.0) if math.isfinite(row["t"]) else 50.0
                for share in (0.123, 0.5, 0.877):
                    point = row["origin"] + share * length * row["direction"]
                    if length < 1e-9 or any((np.abs(point - end) < 1e-9).any() for b in blocks for end in b[:2]):
                        continue
                    inside = [n for low, high, n, _ in ranked if ((point > low) & (point < high)).all()]
                    assert row["n1"] == (inside[0] if inside else 1.0), tree.to_text()
                    asked += 1
    assert asked > 4000


def test_mirror_does_not_reflect_into_a_block_that_stands_on_it() -> None:
    """Rays exactly at the line where the block's side meets the mirror: the next hit is the block, there."""
    block = box((0, 0, -1), (1, 1, 1), Material("block", color=(1.0, 0.0, 0.0), ambient=1.0), "block")
    random = np.random.default_rng(2)
    for mirror in (
        plane((0, 0, 0), (0, 1, 0), MIRROR, "mirror"),
        polygon(((-9, 0, -9), (-9, 0, 9), (9, 0, 9), (9, 0, -9)), MIRROR, "mirror"),
    ):
        world = world_of(mirror, block)
        for _ in range(100):
            target = np.array([0.0, 0.0, random.uniform(-0.9, 0.9)])
            eye = np.array([-random.uniform(0.1, 3), random.uniform(0.1, 3), random.normal()])
            tree = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=1)
            last = tree.object_name(len(tree) - 1)
            assert last == "block"
            assert abs(tree.nodes["point"][-1][0]) < 1e-14


def test_wall_and_mirror_that_meet_in_a_corner_reflect_each_once() -> None:
    """A mirror across a room of mirrors: rays at the line where it meets a wall come back."""
    world = world_of(
        polygon(((-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)), MIRROR, "across"),
        box((-1, -1, -1), (1, 1, 1), MIRROR),
    )
    random = np.random.default_rng(5)
    for _ in range(100):
        target = np.array([1.0, 0.0, random.uniform(-0.9, 0.9)])
        eye = np.array([random.uniform(-0.9, 0.9), random.choice((-1, 1)) * random.uniform(0.1, 0.9), target[2]])
        tree = tracer.trace(world, ray=(tuple(eye), tuple(target - eye)), depth=2)
        assert kinds(tree) == ["camera", "reflection", "reflection"]
        assert tree.nodes["t"][1] <= 1e-14
        assert np.abs(tree.nodes["direction"][2] + tree.nodes["direction"][0]).max() < 1e-14


def test_ball_on_a_block_reflects_away_from_it() -> None:
    world = world_of(ball((0, 1, 0), 1.0, MIRROR, "ball"), box((-2, -1, -2), (2, 0, 2), MIRROR, "block"))
    tree = tracer.trace(world, ray=((0, 0.5, 0), (0, -1, 0)), depth=3)
    assert tree.object_name(0) == "ball"  # the eye is inside: the block is behind the ball's lowest point
    assert "block" not in {tree.object_name(k) for k in range(len(tree))}
