"""The BVH against testing every surface."""

import math
from fractions import Fraction

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings, strategies as st

import tracer
from tests.scenes import MATTE, ball, world_of
from tracer.accel.bvh import MAX_UNBOXED, build
from tracer.accel.rows import BLOCK_CHILD, CHILD_KINDS, NODE_CHILD
from tracer.accel.sah import MAX_LEVELS
from tracer.accel.traversal import hit_boxes, make_box_ray
from tracer.compile.simd import WIDTH
from tracer.formulas.vector import as_floats, vector
from tracer.kernel.nodes import BACKGROUND
from tracer.rays import make_ray
from tracer.scene import Light, Material, Object
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.polygon import Polygon

spread = st.floats(-10, 10)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(spread, spread, spread, st.floats(0.01, 3)), min_size=MAX_UNBOXED + 1, max_size=60),
    st.lists(st.tuples(spread, spread, spread, spread, spread, spread), min_size=5, max_size=5),
)
def test_hierarchy_finds_what_trying_all_surfaces_finds(balls: list, rays: list) -> None:
    """The node table is equal with and without the BVH, bit for bit."""
    objects = [ball((x, y, z), r, MATTE, f"ball {k}") for k, (x, y, z, r) in enumerate(balls)]
    world = world_of(*objects)
    assert len(world.arrays.nodes) > 0
    for ox, oy, oz, dx, dy, dz in rays:
        if max(abs(dx), abs(dy), abs(dz)) < 1e-6:
            continue
        tree = tracer.trace(world, ray=((ox, oy, oz), (dx, dy, dz)), depth=0)
        best = min((t, k) for k in range(len(balls)) for t in [_alone(objects[k], (ox, oy, oz), (dx, dy, dz))])
        if math.isinf(best[0]):
            assert tree.nodes["end"][0] == BACKGROUND
        else:
            assert (tree.nodes["t"][0], tree.object_name(0)) == (best[0], f"ball {best[1]}")


@pytest.mark.parametrize("power", [0, -300, 200])
@pytest.mark.parametrize("away", [0.0, 1e3, 1e7])
def test_blocks_of_triangles_drop_none_that_is_met(power: int, away: float) -> None:
    """Trees are equal with and without the SIMD test of triangle blocks, bit for bit.

    Rays are aimed at corners, at edges and between them, and go on from there. The meshes are tiny, huge, and far
    from the origin, where coordinates have lost digits.
    """
    random = np.random.default_rng(power + 1000)
    unit = 2.0**power
    glass, mirror = Material("glass", transmit=0.6, reflect=0.3, ior=1.5), Material("mirror", reflect=0.5, diffuse=0.5)
    objects, corners = [], []
    for k in range(4):
        ball = trimesh.creation.icosphere(subdivisions=1 + k % 2)
        vertices = ball.vertices * random.uniform(0.3, 1.0, 3) + random.uniform(-1.0, 1.0, 3) + away
        geometry = Geometry(np.array(vertices * unit), np.array(ball.faces), None)
        objects.append(Object(Mesh(geometry), glass if k % 2 else mirror, f"stone {k}"))
        corners.append(geometry.vertices[geometry.faces])
    lamp = Light("lamp", position=as_floats(unit * (np.array([3.0, 5.0, 4.0]) + away)))
    with_blocks = world_of(*objects, lights=[lamp])
    assert len(with_blocks.arrays.blocks) > 20
    without = tracer.prepare(with_blocks.scene, hierarchy=False)
    assert len(without.arrays.blocks) == 0
    faces = np.concatenate(corners)
    for k in range(300):
        a, b, c = faces[random.integers(len(faces))]
        shares = [(1.0, 0.0, 0.0), (0.5, 0.5, 0.0), random.dirichlet((1, 1, 1))][k % 3]
        target = shares[0] * a + shares[1] * b + shares[2] * c
        eye = unit * (random.normal(size=3) * 4.0 + away)
        ray = (tuple(map(float, eye)), tuple(map(float, target - eye)))
        trees = [tracer.trace(world, ray=ray, depth=3) for world in (with_blocks, without)]
        assert trees[0].nodes.tobytes() == trees[1].nodes.tobytes(), ray


def test_hierarchy_holds_every_surface_once_inside_its_boxes() -> None:
    random = np.random.default_rng(8)
    corners = random.uniform(-5, 5, (3000, 1, 3)) + random.exponential(0.3, (3000, 3, 3))
    corners[:200] = corners[0]  # many at one place
    bounds = np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)
    corners[1000:2000] = np.nan  # not triangles
    tree = build(bounds, corners)
    for scaled in (2.0**-900, 2.0**800):
        same = build(bounds * scaled, corners * scaled)
        assert same.nodes.tobytes() == tree.nodes.tobytes()
        assert same.unit == tree.unit * scaled
    seen = []
    waiting = [(0, 0, np.full(3, -np.inf), np.full(3, np.inf))]
    deepest = 0
    while waiting:
        k, depth, low, high = waiting.pop()
        deepest = max(deepest, depth)
        planes, children = tree.nodes[k]["planes"], tree.nodes[k]["child"]
        for lane in np.flatnonzero(planes[0] <= planes[1]):
            box_low, box_high = planes[0::2, lane], planes[1::2, lane]
            assert (box_low >= low).all()
            assert (box_high <= high).all()
            kind, number = children[lane] % CHILD_KINDS, children[lane] // CHILD_KINDS
            if kind == NODE_CHILD:
                waiting.append((number, depth + 1, box_low, box_high))
                continue
            inside = [number]
            if kind == BLOCK_CHILD:
                block = tree.blocks[number]
                inside = block["surface"][: int(block["lanes"]).bit_length()]
                placed = block["anchor"] + block["corners"].reshape(3, 3, WIDTH).transpose(2, 0, 1)[: len(inside)]
                assert np.abs(placed - corners[inside] / tree.unit).max() <= block["rounding"]
            seen += list(inside)
            assert (bounds[inside, 0] > box_low * tree.unit).all()  # by at least one float32 step
            assert (bounds[inside, 1] < box_high * tree.unit).all()
    assert sorted(seen) == list(range(3000))
    assert deepest < MAX_LEVELS


def test_of_surfaces_at_one_distance_the_files_first_is_met() -> None:
    """Of several surfaces at one distance the first in the file is hit. Twelve coplanar sheets, ordered otherwise in
    the BVH.
    """
    turn = np.linspace(0.0, 6.0, 12)
    square = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    sheets = [
        Object(Polygon(tuple((x + math.cos(a), y + math.sin(a), 0.0) for x, y in square)), MATTE, f"sheet {k}")
        for k, a in enumerate(turn)
    ]
    for order in ([(k * step + first) % 12 for k in range(12)] for step in (1, 5, 7, 11) for first in range(0, 12, 2)):
        world = world_of(*(sheets[k] for k in order))
        assert len(world.arrays.nodes) > 0
        tree = tracer.trace(world, ray=((0.05, 0.02, 3), (0, 0, -1)), depth=0)
        assert tree.object_name(0) == f"sheet {order[0]}"


def test_no_box_is_missed_that_a_ray_meets() -> None:
    """A box that a ray hits exactly is never missed, whatever rounding does: at its edges, flat boxes, and from its
    border on.
    """
    random = np.random.default_rng(3)
    met = 0
    for k in range(1500):
        low, size, away = random.normal(size=(3, 3))
        high = low + np.abs(size) * (np.arange(3) != k % 4)
        target = np.where(random.random(3) < 0.5, low, high)
        target[k % 3] += random.random() * (high - low)[k % 3]
        target = np.minimum(target, high)
        origin, direction = target + 30.0 * away, -away / np.linalg.norm(away)
        near, far = Fraction(0), Fraction(10**9)
        for axis in range(3):
            o, d = Fraction(origin[axis]), Fraction(direction[axis])
            ways = sorted((Fraction(plane[axis]) - o) / d for plane in (low, high))
            near, far = max(near, ways[0]), min(far, ways[1])
        bounds = np.stack([low, high])[None]
        (node,), unit = build(bounds).nodes, build(bounds).unit
        way = vector(direction.tolist())
        inside = hit_boxes(
            node["planes"], make_box_ray(make_ray(vector(target.tolist()), way, -1, 0.0, 1.0), 1 / unit), math.inf
        )
        assert (inside[0], inside[1][0]) == (1, 0.0)
        if near <= far:
            met += 1
            ray = make_ray(vector(origin.tolist()), way, -1, 0.0, 1.0)
            assert hit_boxes(node["planes"], make_box_ray(ray, 1 / unit), math.inf)[0] == 1
            assert hit_boxes(node["planes"], make_box_ray(ray, 1 / unit), float(near) / unit)[0] == 1
    assert 300 < met < 1200


def _alone(item: Object, origin: tuple, direction: tuple) -> float:
    t = float(tracer.trace(world_of(item), ray=(origin, direction), depth=0).nodes["t"][0])
    return math.inf if math.isnan(t) else t
