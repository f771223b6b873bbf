"""Closed meshes are watertight: 10^5 rays at corners and 10^5 at edges of each from inside, and grazing rays."""

import numpy as np
import pytest

import tracer
from tests.scenes import world_of
from tests.tracer.shapes.test_shapes import OPEN, uv_sphere
from tracer.formulas.sampler import PIXEL_CENTER
from tracer.kernel.entry import one_pixel, ray_view, trace_list
from tracer.kernel.limits import make_limits
from tracer.kernel.workspace import Workspace
from tracer.scene import Material, Object
from tracer.shapes.mesh import Geometry, Mesh

pytestmark = pytest.mark.early

RAYS = 100_000  # at the corners, and as many at the edges, of each mesh


def misses(world: tracer.World, origins: np.ndarray, targets: np.ndarray) -> int:
    """The number of rays that miss a luminous mesh and see black: each ray is the one pixel of an image."""
    workspace, pixel = Workspace(world.eye((0.0, 0.0, 0.0))), one_pixel(0, 0)
    limits = make_limits(world, 0, records=False)
    ways = targets - origins
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    missed = 0
    for origin, way in zip(origins.tolist(), ways.tolist(), strict=True):
        view = ray_view(tuple(origin), tuple(way))
        traced = trace_list(world.arrays, view, limits, PIXEL_CENTER.sampler, pixel, workspace)
        assert traced
        missed += traced[0][0, 0] != 1.0
    return missed


def perturbed(seed: int) -> Mesh:
    """A lumpy ball: corners moved in and out at random, far from round, still closed."""
    ball = uv_sphere(16, 32, radius=1.0)
    random = np.random.default_rng(seed)
    vertices = ball.geometry.vertices * (1.0 + 5.0 * random.random((len(ball.geometry.vertices), 1)))
    return Mesh(Geometry(vertices, ball.geometry.faces), "made")


def far_away() -> Mesh:
    """Far from the origin, where single precision has one or two digits left. Source: Embree's test."""
    return uv_sphere(25, 50, (148376, 1234, -223423))


MESHES = {"round": lambda: uv_sphere(16, 32), "lumpy": lambda: perturbed(2), "far away": far_away}


@pytest.mark.parametrize(
    "name", [*(pytest.param(name, marks=pytest.mark.slow) for name in ("round", "lumpy")), "far away"]
)
def test_no_ray_at_a_corner_or_an_edge_gets_out(name: str) -> None:
    mesh = MESHES[name]()
    assert mesh.is_closed()
    world = world_of(Object(mesh, OPEN, "mesh"))
    corners = mesh.placed()
    random = np.random.default_rng(7)
    middle = corners.mean(axis=(0, 1))
    origins = middle + random.uniform(-0.3, 0.3, (2 * RAYS, 3))
    face = corners[random.integers(len(corners), size=2 * RAYS)]
    along = random.random((2 * RAYS, 1))
    along[:RAYS] = 0.0
    targets = face[:, 0] + along * (face[:, 1] - face[:, 0])
    assert misses(world, origins, targets) == 0


def test_outline_of_glass_is_grazed_and_nothing_gets_into_it() -> None:
    """A glass wedge, its top along the axes, its side tilted: rays over the edge that is its outline for the eye.

    They enter one face and leave the other by a chord shorter than rounding. Whichever is found first, they pass.
    """
    profile = ((-1.0, 1.0), (1.0, 1.0), (0.3, -1.0), (-1.0, -1.0))
    vertices = np.array([(x, y, z) for y in (-2.0, 2.0) for x, z in profile]) + 0.1
    quads = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
    faces = np.array([half for a, b, c, d in quads for half in ((a, b, c), (a, c, d))])
    mesh = Mesh(Geometry(vertices, faces), "wedge")
    assert mesh.is_closed()
    world = world_of(Object(mesh, Material("glass", transmit=1.0, ior=1.0 + 2.0**-20), "wedge"))
    random = np.random.default_rng(1)
    for _ in range(300):
        target = np.array([1.0, random.uniform(-1.9, 1.9), 1.0]) + 0.1
        away = np.array([-random.uniform(0.5, 5.0), random.normal(), 10.0 ** random.uniform(-6, 0)])
        away *= random.choice([1.0, 30.0])
        tree = tracer.trace(world, ray=(tuple(target + away), tuple(-away)), depth=8)
        assert tree.nodes["n1"][-1] == 1.0


def test_the_count_sees_a_hole() -> None:
    """The count is not zero when one face is missing and rays aim at its middle."""
    mesh = uv_sphere(16, 32)
    open_mesh = Mesh(Geometry(mesh.geometry.vertices, mesh.geometry.faces[1:]), "made")
    target = mesh.placed()[0].mean(axis=0)
    world = world_of(Object(open_mesh, OPEN, "mesh"))
    origins = np.random.default_rng(1).uniform(-0.3, 0.3, (50, 3))
    assert misses(world, origins, np.broadcast_to(target, (50, 3))) == 50
