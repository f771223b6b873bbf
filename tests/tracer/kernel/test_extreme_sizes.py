"""Nothing ends in a crash: smooth meshes of any size, placements that are too large, and numbers at their limits."""

import numpy as np
import pytest

import tracer
from tests.scenes import ball, world_of
from tests.tracer.formats.test_meshes import obj, write
from tests.tracer.shapes.test_shapes import uv_sphere
from tracer.scene import Light, Material, Object
from tracer.shapes.mesh import Geometry, Mesh
from viewer.explain.ray import explain_ray

MIRROR = Material("mirror", diffuse=0.5, reflect=0.5)
GLASS = Material("glass", reflect=0.1, transmit=0.9, ior=1.5)


def smooth_ball(size: float, material: Material) -> tracer.World:
    geometry = uv_sphere(8, 16).geometry
    normals = geometry.vertices / np.linalg.norm(geometry.vertices, axis=1, keepdims=True)
    item = Object(Mesh(Geometry(size * geometry.vertices, geometry.faces, normals), "ball"), material, "ball")
    light = Light("lamp", position=(3.0 * size, 4.0 * size, 5.0 * size))
    return world_of(item, lights=[light], model="fresnel")


def numbers(tree: tracer.RayTree, size: float) -> list[bytes]:
    nodes = tree.nodes
    return [
        *(nodes[name].tobytes() for name in ("direction", "normal", "radiance", "weight", "turn", "end")),
        *((nodes[name] / size).tobytes() for name in ("point", "t", "error")),
    ]


@pytest.mark.parametrize("material", [MIRROR, GLASS])
def test_a_smooth_mesh_times_a_power_of_two_has_the_same_tree(material: Material) -> None:
    trees = {}
    for power in (0, -490, -480, -300, 300, 480, 490):
        size = 2.0**power
        ray = ((0.1 * size, 0.2 * size, 5.0 * size), (0.01, 0.02, -1.0))
        trees[power] = numbers(tracer.trace(smooth_ball(size, material), ray=ray, depth=4), size)
        assert trees[power] == trees[0]


@pytest.mark.parametrize("size", [1e-85, 1e-100, 1e-150])
def test_a_tiny_smooth_mirror_reflects(size: float) -> None:
    tree = tracer.trace(smooth_ball(size, MIRROR), ray=((0.1 * size, 0.2 * size, 5.0 * size), (0, 0, -1)), depth=2)
    assert np.isfinite(tree.nodes["direction"]).all()
    assert tree.object_name(0) == "ball"


def test_a_placement_beyond_the_largest_number_is_refused_by_file_and_vertex(tmp_path) -> None:
    write(tmp_path / "a.obj", obj().replace("v 1 ", "v 1e100 "))
    text = 'format = 1\n[[object]]\nshape = "mesh"\nfile = "a.obj"\nscale = 1e100\n'
    with pytest.raises(
        tracer.SceneError, match=r"a.toml: object\[0\]: a.obj: vertex \d+ must be placed within 1e\+150"
    ):
        tracer.prepare(tracer.load(write(tmp_path / "a.toml", text)))


@pytest.mark.parametrize("ior", [1e-150, 1e150])
def test_nothing_shown_overflows(ior: float) -> None:
    world = world_of(ball(material=Material("odd", reflect=0.1, transmit=0.9, ior=ior)), model="fresnel")
    tree = tracer.trace(world, ray=((0.1, 0.2, 5), (0, 0, -1)), depth=4)
    assert tree.to_text() and tree.to_json()
    for i in range(len(tree)):
        assert explain_ray(tree, world, i)
