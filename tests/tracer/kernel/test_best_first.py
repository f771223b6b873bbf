"""Best-first trees to a tolerance: exact results, a bound that holds at every stop, and weights that add up."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import tracer
from tests.scenes import ball, box, ends, plane, world_of
from tracer.compile.rows import as_rows
from tracer.kernel.best_first import heap_pop, heap_push
from tracer.kernel.workspace import OPEN, OpenRow
from tracer.scene import Camera, Checker, Light, Material, Object
from tracer.scene.radiance_bound import radiance_bound
from tracer.shapes.plane import Plane

U = 2.0**-53
CLEAR = Material("clear", transmit=1.0, ior=1.5)
WHITE = (1.0, 1.0, 1.0)


def plates(count: int, n: float = 1.5, background: tuple = WHITE) -> tracer.World:
    """A pile of clear plates above a black floor, under a white sky: reflected light is white, transmitted light is
    lost.
    """
    glass = Material("clear", transmit=1.0, ior=n)
    pile = [box((-1e3, 2.0 * k, -1e3), (1e3, 2.0 * k + 1.0, 1e3), glass, f"plate {k}") for k in range(count)]
    floor = plane((0, -1, 0), (0, 1, 0), Material("black"), "floor")
    return world_of(*pile, floor, background=background, model="fresnel")


def down(world: tracer.World, **limits) -> tracer.RayTree:
    return tracer.trace(world, ray=((0.1, 1e3, 0.2), (0, -1, 0)), **limits)


def reflectance(faces: int, n: float = 1.5) -> float:
    r = ((n - 1) / (n + 1)) ** 2
    return faces * r / (1 + (faces - 1) * r)


def test_slab_to_1e_12_takes_twenty_rays() -> None:
    """Each interface sends out two rays. What stays inside is multiplied by 1/25 at each."""
    tree = down(plates(1), tolerance=1e-12)
    assert len(tree) == 20
    assert tree.residual == pytest.approx(0.96 * 0.04**9, rel=64 * U, abs=0.0)
    assert tree.radiance[0] == pytest.approx(1 / 13, rel=8 * U, abs=tree.residual)


@pytest.mark.parametrize("count", [1, 2, 3, 5, 10])
@pytest.mark.parametrize("n", [1.5, 4 / 3, 2.4])
def test_pile_of_plates_is_bounded_at_every_stop(count: int, n: float) -> None:
    """N faces reflect N R / (1 + (N - 1) R). The bound holds wherever tracing stops, and never increases."""
    world, exact = plates(count, n), reflectance(2 * count, n)
    last = math.inf
    for max_nodes in (1, 2, 3, 10, 100, 1000, 5000):
        tree = down(world, tolerance=0.0, max_nodes=max_nodes)
        assert len(tree) <= max_nodes
        assert exact - tree.radiance[0] <= tree.bound + 8 * U
        assert tree.radiance[0] <= exact + 8 * U
        assert tree.bound == tree.residual <= last * (1 + 8 * U)  # R + T is 1 up to rounding
        last = tree.residual


def test_three_plates_are_certified_within_1_5e_4_in_a_thousand_rays() -> None:
    tree = down(plates(3), tolerance=0.0, max_nodes=1000)
    assert len(tree) == 1000
    assert tree.bound <= 1.5e-4
    assert abs(tree.radiance[0] - 0.2) <= tree.bound


@pytest.mark.parametrize("tolerance", [0.5, 1e-2, 1e-4, 1e-6])
def test_residual_comes_down_to_what_was_asked_for(tolerance: float) -> None:
    tree = down(plates(3), tolerance=tolerance)
    assert 0.0 < tree.residual <= tolerance
    assert abs(tree.radiance[0] - 0.2) <= tree.residual
    assert "tolerance" in ends(tree)
    assert down(plates(3), tolerance=0.01 * tolerance).residual < tree.residual


def test_tracing_stops_at_the_very_tolerance() -> None:
    """Given the residual of any stop as tolerance, tracing stops exactly there: the running sum does not drift.

    A row that sends out two rays adds the weights that are cut of both: one rounding of the residual.
    """
    world = plates(3, 1.37)
    for count in range(1, 600, 7):
        residual = down(world, tolerance=0.0, max_nodes=count).residual
        tree = down(world, tolerance=residual * (1.0 + 4 * U))
        assert len(tree) <= count
        assert tree.residual <= residual * (1.0 + 8 * U)
        assert down(world, tolerance=residual * (1.0 - 4 * U)).residual < residual
    shell = world_of(ball((0, 0, 0), 1.0, Material("half", reflect=0.5)))
    assert tracer.trace(shell, ray=((0, 0, 0), (1, 2, 3)), tolerance=2.0**-9).residual == 2.0**-9


@pytest.mark.parametrize("degrees, exact", [(60.0, 0.16376753728983167613), (89.0, 0.949681857200440876336)])
def test_slab_aslant(degrees: float, exact: float) -> None:
    a = math.radians(degrees)
    world = plates(1)
    tree = tracer.trace(world, ray=((0, 2, 0), (math.sin(a), -math.cos(a), 0)), tolerance=1e-14)
    # One rounding unit of the angle changes the reflected share by 1/cos units.
    assert tree.radiance[0] == pytest.approx(exact, rel=32 * U / math.cos(a), abs=2e-14)


def test_rows_come_heaviest_first_with_their_shadows_behind_them() -> None:
    world = plates(2)
    lit = tracer.prepare(replace(world.scene, lights=(Light("lamp", position=(0.0, 50.0, 0.0)),)))
    tree = down(lit, tolerance=1e-3)
    kind, parent, weight = tree.nodes["kind"], tree.nodes["parent"], tree.nodes["weight"][:, 0]
    rays = np.flatnonzero(kind != 4)
    for i, k in enumerate(rays):
        shadows = np.arange(k + 1, rays[i + 1] if i + 1 < len(rays) else len(tree))
        assert (kind[shadows] == 4).all() and (parent[shadows] == k).all()
    # A ray never has more weight than one that was in the queue when it was taken.
    for a, b in itertools.pairwise(rays):
        assert weight[b] <= weight[a] or parent[b] == a
    assert (tree.nodes["id"] == np.arange(len(tree))).all()


def test_heap_gives_the_heaviest_and_of_equals_the_first() -> None:
    random = np.random.default_rng(2)
    for size in range(1, 40):
        heap = as_rows(np.zeros(size, OPEN), OpenRow)
        weights = random.integers(1, 9, size) / 8.0
        for k, weight in enumerate(weights.tolist()):
            heap_push(heap, k, weight, k, 100 + k, k % 3 == 0)
        for left, k in enumerate(np.lexsort((np.arange(size), -weights))):
            assert np.asarray(heap)[0].item() == (weights[k], k, 100 + k, k % 3 == 0)
            heap_pop(heap, size - 1 - left)


def test_depth_counts_only_if_it_is_given() -> None:
    world = plates(1)
    free, held = down(world, tolerance=1e-12), down(world, tolerance=1e-12, depth=3)
    assert free.depth == free.nodes["depth"].max() > 3 == held.depth
    assert "depth" in ends(held)
    assert held.residual > 1e-12
    assert abs(held.radiance[0] - 1 / 13) <= held.bound


def test_image_to_a_tolerance_is_made_of_the_same_trees() -> None:
    camera = Camera(position=(0.0, 30.0, 4.0), look_at=(0.0, 0.0, 0.0), fov=20.0)
    lamps = (Light("lamp", position=(0.0, 9.0, 0.0)),)
    world = tracer.prepare(replace(plates(3).scene, lights=lamps, camera=camera))
    size = (24, 18)
    image = tracer.render(world, size, tolerance=1e-3, threads=2)
    for x, y in itertools.product(range(0, 24, 5), range(0, 18, 4)):
        tree = tracer.trace(world, (x, y), size=size, tolerance=1e-3)
        assert tree.radiance.tolist() == image.pixels[y, x].tolist()
        assert tree.residual <= image.residual["max"] <= 1e-3
    assert image.bound == image.residual["max"]
    assert image.depth is None


def test_where_light_adds_up_without_end_nothing_is_claimed() -> None:
    """No bound is claimed where light can add up without limit: between perfect mirrors face to face, with a lamp."""
    lamp = Light("lamp", position=(0.5, 0.5, 0.0))
    for reflect, ambient, expected in ((1.0, 0.1, math.inf), (0.5, 0.1, 0.2), (1.0, 0.0, 0.0), (0.99, 0.0, 0.0)):
        mirror = Material("mirror", ambient=ambient, reflect=reflect)
        world = world_of(plane((0, 0, 0), (1, 0, 0), mirror), plane((1, 0, 0), (-1, 0, 0), mirror), lights=[lamp])
        tree = tracer.trace(world, ray=((0.5, 0, 0), (1, 0.1, 0)), depth=4)
        assert tree.residual == reflect**5
        assert tree.bound == pytest.approx(tree.residual * expected, rel=8 * U, abs=0.0)
    assert tracer.trace(world, ray=((0.5, 0, 0), (1, 0.1, 0)), depth=4).to_dict()["bound"] == 0.0


@pytest.mark.parametrize(("sky", "expected"), [(0.0, 0.0), (0.5, math.inf)])
def test_surface_that_sends_on_more_than_it_gets_has_a_bound_only_in_the_dark(sky: float, expected: float) -> None:
    wrong = ball((0, 0, 0), 1.0, Material("wrong", reflect=0.7, transmit=0.7, ior=1.5))
    tree = tracer.trace(world_of(wrong, background=(sky, 0.0, 0.0)), ray=((0.1, 0.2, 5), (0, 0, -1)), depth=3)
    assert tree.residual > 0.0
    assert tree.bound == expected


def test_the_most_a_ray_can_bring_counts_every_light_and_the_brighter_square() -> None:
    """The bound on radiance counts every light, and the brighter square of a checker.

    Green: ambient 1/4 of 1/2; from lights of 2 and 1 an eighth, and a highlight of a quarter; half is passed on.
    """
    tiles = Material(
        "tiles", (0.0, 0.5, 0.0), 0.25, 0.125, 0.25, reflect=0.25, transmit=0.25, checker=Checker((0.0, 1.0, 0.0), 1.0)
    )
    lights = [Light("two", position=(0.0, 9.0, 0.0), color=(0.0, 2.0, 0.0)), Light("one", direction=(0.0, -1.0, 0.0))]
    for sky, most in ((2.0, (0.125 + 3.0 * (0.125 + 0.25)) / 0.5), (3.0, 3.0)):
        world = world_of(ball(material=tiles), lights=lights, ambient=(0.0, 0.5, 0.0), background=(0.0, 0.0, sky))
        assert radiance_bound(world.scene).largest == most


def test_furnace_lacks_exactly_what_the_bound_says() -> None:
    shell = world_of(ball((0, 0, 0), 1.0, Material("shell", ambient=1.0, reflect=0.5)))
    for depth in (0, 1, 5, 30):
        tree = tracer.trace(shell, ray=((0.1, 0.2, -0.3), (1, 2, 3)), depth=depth)
        assert 2.0 - tree.radiance[0] == tree.bound == 2.0**-depth


def random_world(seed: int) -> tracer.World:
    random = np.random.default_rng(seed)
    objects = []
    for _ in range(random.integers(1, 6)):
        kr, kt = random.dirichlet((1, 1, 0.5))[:2] * random.choice([1.0, 0.8])
        kt = kt if random.random() < 0.7 else 0.0
        glass = Material(
            "m",
            ambient=0.1,
            diffuse=0.4,
            specular=0.2,
            shininess=9.0,
            reflect=kr,
            transmit=kt,
            ior=random.uniform(1, 2),
        )
        middle = random.uniform(-1, 1, 3)
        shape = ball(tuple(middle), random.uniform(0.3, 1.2), glass)
        if random.random() < 0.4:
            shape = box(tuple(middle - 0.7), tuple(middle + random.uniform(0.1, 0.9, 3)), glass)
        objects.append(shape)
    objects.append(
        Object(Plane((0.0, -2.0, 0.0), (0.0, 1.0, 0.0)), Material("floor", diffuse=0.8, reflect=0.3), "floor")
    )
    lamp = Light("lamp", position=(3.0, 4.0, 2.0), color=(0.9, 0.8, 0.7))
    model = random.choice(["whitted", "fresnel"])
    return world_of(*objects, lights=[lamp], background=(0.2, 0.3, 0.4), model=str(model))


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 10**9), st.sampled_from([0, 1, 3, 6]), st.sampled_from([None, 0.3, 1e-2]), st.booleans())
def test_ledger_balances_and_the_bound_holds(seed: int, depth: int, tolerance: float | None, thin_out: bool) -> None:
    """Leaves + cut + absorbed = 1 up to the rounding of the longest path. No tree misses more light than its bound."""
    world = random_world(seed)
    random = np.random.default_rng(seed)
    ray = (tuple(random.uniform(-4, 4, 3)), tuple(random.normal(size=3)))
    min_weight = 0.02 if thin_out else 0.0
    limits = {"min_weight": min_weight, "max_nodes": 20000}
    tree = tracer.trace(world, ray=ray, depth=None if tolerance else depth, tolerance=tolerance, **limits)
    # A factor and a weight are rounded a few times each; R + T = 1 up to 8 u / c for a cosine c that is not tiny here.
    deepest = int(tree.nodes["depth"].max()) + 1
    assert abs(sum(tree.ledger) - 1.0) <= 64 * U * deepest
    deeper = tracer.trace(world, ray=ray, tolerance=1e-4, max_nodes=20000)
    assert (np.abs(deeper.radiance - tree.radiance) <= tree.bound + deeper.bound).all()


def test_absurd_limits_are_refused() -> None:
    world = plates(1)
    for limits in (
        {"tolerance": -1.0},
        {"tolerance": math.nan},
        {"max_nodes": 0},
        {"min_weight": math.nan},
        {"depth": -1},
    ):
        with pytest.raises(ValueError, match="must be"):
            down(world, **limits)


def test_clear_glass_takes_no_bound_from_the_matte_walls_around_it() -> None:
    """The bound is that of the brightest material alone: of the wall with what it returns, not with what glass does."""
    wall = Material("wall", ambient=0.5, reflect=0.5)
    clear = Material("clear", transmit=1.0, ior=1.5)
    world = world_of(ball(material=clear), plane((0, -2, 0), (0, 1, 0), wall), background=(0.25, 0.0, 0.0))
    assert radiance_bound(world.scene) == ((1.0, 1.0, 1.0), "")
    shiny = Material("shiny", specular=0.1, transmit=1.0, ior=1.5)
    lamp = Light("lamp", position=(0.0, 9.0, 0.0), color=(1.0, 0.0, 0.0))
    other = world_of(ball(material=shiny), plane((0, -2, 0), (0, 1, 0), wall), lights=[lamp])
    assert radiance_bound(other.scene) == ((math.inf, 1.0, 1.0), "shiny")
    tree = tracer.trace(other, ray=((0.1, 0.2, 5), (0, 0, -1)), depth=1)
    assert tree.missing[0] == math.inf > tree.missing[1]
    assert (
        tree.to_text()
        .splitlines()[1]
        .endswith('no upper bound is known for the missing light, because of the material "shiny"')
    )
