"""The recorded tree is the computation of the pixel: equal to the last bit, on every shipped scene."""

import itertools
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import tracer
from tests.scenes import ball, box, world_of
from tracer.accel.bvh import build_nodes
from tracer.choices import MODELS
from tracer.formulas.sampler import PIXEL_CENTER
from tracer.formulas.vector import dot, vector
from tracer.image.film import Film
from tracer.image.passes import trace_passes
from tracer.image.task import Task, Work
from tracer.image.tiles import COARSE_TO_FINE, make_passes
from tracer.kernel.entry import trace_pixels
from tracer.kernel.limits import make_limits
from tracer.kernel.nodes import BACKGROUND, SHADOW
from tracer.scene import Image, Material
from tracer.tree.raytree import RayTree

DEPTHS = (0, 1, 2, 3)


def grid(size: tuple[int, int]) -> list[tuple[int, int]]:
    """208 pixels over the whole image, its corners included."""
    xs = np.linspace(0, size[0] - 1, 16).astype(int)
    ys = np.linspace(0, size[1] - 1, 13).astype(int)
    return [(int(x), int(y)) for y in ys for x in xs]


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    """Equal bit for bit, including NaN and the sign of zero."""
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


@pytest.mark.parametrize("model", MODELS)
def test_tree_is_the_pixel(world: tracer.World, model: str) -> None:
    size = (world.scene.image.width, world.scene.image.height)
    images = [tracer.render(world, depth=depth, model=model).pixels for depth in DEPTHS]
    for x, y in grid(size):
        trees = [tracer.trace(world, (x, y), depth=depth, model=model) for depth in DEPTHS]
        for image, tree in zip(images, trees, strict=True):
            assert same_bits(tree.radiance, image[y, x]), (x, y, tree.depth)
            check_sums(tree)
        for shallow, deep in itertools.pairwise(trees):
            check_prefix(shallow, deep)


def test_tree_is_the_pixel_where_rays_are_passed_on_whole() -> None:
    """Perfect mirrors and clear glass take no row in an image and add no light to it, and their counts and cuts are the
    same.
    """
    clear, mirror = Material("clear", transmit=1.0, ior=1.5), Material("mirror", reflect=1.0)
    half, both = Material("half", reflect=0.5), Material("both", reflect=1.0, transmit=0.125, ior=1.25)
    lit = Material("lit", ambient=0.5, color=(0.0, 0.5, 1.0), reflect=1.0)
    chance = np.random.default_rng(4)
    for _ in range(8):
        materials = chance.permutation(np.array([clear, clear, mirror, half, both, lit], object))
        balls = [ball(chance.uniform(-1.5, 1.5, 3).tolist(), chance.uniform(0.4, 1.2), one) for one in materials]
        world = world_of(*balls, background=(0.25, 0.5, 1.0), image=Image(8, 6))
        for least in (0.0, 0.2):
            image = tracer.render(world, depth=5, min_weight=least)
            trees = [tracer.trace(world, (x, y), depth=5, min_weight=least) for y in range(6) for x in range(8)]
            assert same_bits(np.array([tree.radiance for tree in trees]), image.pixels.reshape(-1, 3))
            assert image.residual["max"] == max(tree.residual for tree in trees)
            rays = {kind: sum(tree.kind(i) == kind for tree in trees for i in range(len(tree))) for kind in image.rays}
            assert rays == image.rays


def check_sums(tree: tracer.RayTree) -> None:
    """A node's radiance is its local term plus factor times radiance of its rays, in row order, to the last bit."""
    nodes = tree.nodes
    for i in range(len(tree)):
        total = nodes["local"][i].copy()
        for child in tree.children[i]:
            assert child > i
            if nodes["kind"][child] != SHADOW:
                total = total + nodes["factor"][child] * nodes["radiance"][child]
        assert same_bits(total, nodes["radiance"][i].copy())


def check_prefix(shallow: tracer.RayTree, deep: tracer.RayTree) -> None:
    """The rows of depth d are the first rows of depth d+1, equal except for `end`, `radiance` and its error."""
    rows = len(shallow)
    assert rows <= len(deep)
    for field in shallow.nodes.dtype.names or ():
        if field not in ("end", "radiance", "radiance_error"):
            assert same_bits(shallow.nodes[field], deep.nodes[field][:rows]), field
    assert (deep.nodes["depth"][rows:] == deep.depth).all()


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_change_no_bit(world: tracer.World, threads: int) -> None:
    reference = tracer.render(world, (320, 240), threads=1)
    image = tracer.render(world, (320, 240), threads=threads)
    assert same_bits(image.pixels, reference.pixels)
    assert image.rays == reference.rays
    assert image.residual == reference.residual


@pytest.mark.parametrize("size", [(333, 207), (61, 45)])  # no multiple of a tile's side, and less than one tile
@pytest.mark.parametrize("steps", [(1,), COARSE_TO_FINE])
def test_order_of_tiles_changes_no_bit(world: tracer.World, steps: tuple[int, ...], size: tuple[int, int]) -> None:
    reference = tracer.render(world, size, threads=1).pixels
    task = Task.of(world, world.view(size), make_limits(world, records=False), PIXEL_CENTER.sampler)
    film = Film(*size)
    order = random.Random(7)
    passes = [[Work(tile) for tile in tiles] for tiles in make_passes(*size, steps)]
    for works in passes:
        order.shuffle(works)
    with ThreadPoolExecutor(3) as executor:
        trace_passes(task, passes, executor, 3, lambda traced, share: film.add(traced), film.pixels)
    assert same_bits(film.pixels, reference)


def test_several_samples_are_the_mean_of_single_ones(world: tracer.World) -> None:
    size, count = (40, 30), 5
    image = tracer.render(world, size, samples=count).pixels
    for x, y in ((0, 0), (17, 12), (39, 29), (20, 3)):
        total = np.zeros(3)
        for k in range(count):
            total = total + tracer.trace(world, (x, y), size=size, sample=k).radiance
        assert same_bits(total / count, image[y, x])


def test_image_traces_the_rays_of_its_trees(world: tracer.World) -> None:
    """An image traces all rays of its trees, except shadow rays that cannot add light."""
    image = tracer.render(world, (64, 48), depth=3)
    rays = dict.fromkeys(image.rays, 0)
    for y in range(48):
        for x in range(64):
            tree = tracer.trace(world, (x, y), size=(64, 48), depth=3)
            for i in range(len(tree)):
                if tree.kind(i) != "shadow" or may_add_light(tree, i):
                    rays[tree.kind(i)] += 1
    assert rays == image.rays


def may_add_light(tree: RayTree, i: int) -> bool:
    """True if shadow row i goes to a light in front of a surface whose material light can change."""
    at = tree.nodes[tree.nodes["parent"][i]]
    material = tree.scene.objects[at["object"]].material
    n_l = dot(vector(at["normal"]), vector(tree.nodes["direction"][i]))
    return n_l > 0.0 and (material.diffuse > 0.0 or material.specular > 0.0)


def test_one_compiled_kernel_serves_every_scene(worlds: dict[str, tracer.World]) -> None:
    """No recompilation when another scene is opened: one without glass, with glass, with much of it."""
    glass = Material("glass", transmit=1.0, ior=1.5)
    many = world_of(*(ball((3.0 * k, 0, 0), 1, glass, f"ball {k}") for k in range(80)))
    for world in (*worlds.values(), many, world_of(ball())):
        tracer.trace(world, (3, 3))
        tracer.render(world, (8, 6), samples=2)
    assert len(trace_pixels.signatures) == 1
    assert len(build_nodes.signatures) == 1


def test_formulas_run_as_plain_python() -> None:
    """The kernel's functions run as plain Python, with the same bits."""
    program = (
        "import sys, numpy as np, tracer; from viewer.lessons import lesson; np.seterr(all='ignore')\n"
        "for name in lesson.names():\n"
        "    world = tracer.prepare(tracer.load(lesson.read(name).scene))\n"
        "    for pixel in ((400, 300), (300, 200), (500, 420), (120, 380), (478, 262)):\n"
        "        for model in ('whitted', 'fresnel'):\n"
        "            print(tracer.trace(world, pixel, model=model).to_json())\n"
    )
    said = []
    for disabled in ("0", "1"):
        environment = {**os.environ, "NUMBA_DISABLE_JIT": disabled}
        run = subprocess.run([sys.executable, "-c", program], capture_output=True, env=environment, check=True)
        said.append(run.stdout)
    assert said[0] == said[1]
    assert len(said[0]) > 10_000


def test_background_rows_are_leaves_with_its_colour(world: tracer.World) -> None:
    for x, y in grid((world.scene.image.width, world.scene.image.height))[::7]:
        tree = tracer.trace(world, (x, y))
        for i in np.flatnonzero(tree.nodes["end"] == BACKGROUND):
            assert tree.children[i] == []
            assert tuple(tree.nodes["radiance"][i]) == world.scene.background.color
            assert np.isnan(tree.nodes["t"][i])


def test_a_table_too_short_grows() -> None:
    """A tree that is larger than a thread's first table is traced, in images and in clicks."""
    glass = Material("glass", reflect=0.2, transmit=0.8, ior=1.5)
    plates = [box((-9, -9, z), (9, 9, z + 0.5), glass) for z in (0.0, 1.0, 2.0)]
    world = world_of(*plates, background=(0.2, 0.4, 0.8), image=Image(8, 6))
    deep = tracer.trace(world, (3, 2), depth=12)
    assert len(deep) > 4 * 256
    image = tracer.render(world, depth=12)
    assert same_bits(deep.radiance, image.pixels[2, 3])
    check_sums(deep)
