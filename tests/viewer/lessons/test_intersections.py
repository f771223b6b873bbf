"""The tests of a ray against a sphere, a polygon and a triangle, and their pieces: against closed forms, hit or not."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, ball, world_of
from tests.viewer.figures.test_inside import check_inside, check_texts
from tests.viewer.lessons.test_live import COMB, RAY, SHINY, SIZES, context, row_of, words, world
from tracer.formulas.double_double import U
from tracer.scene import Object
from tracer.shapes.mesh import Mesh
from tracer.shapes.sphere import Sphere
from tracer.shapes.triangle import Triangle
from viewer.explain.intersection import barycentric, flattened, hit_face, hit_roots, sphere_roots, sphere_section
from viewer.figures.marks import Disc, Mark
from viewer.lessons import lesson
from viewer.lessons.live.catalogue import live_kind
from viewer.lessons.values import value_text


def test_the_quadratic_of_a_sphere() -> None:
    unit = Sphere((0.0, 0.0, 0.0), 1.0)
    found = sphere_roots((0.0, 0.0, 5.0), (0.0, 0.0, -1.0), unit)
    assert (found.a, found.b, found.c, found.discriminant, found.roots) == (1.0, -10.0, 24.0, 4.0, (4.0, 6.0))
    larger = sphere_roots((1.0, 0.0, 5.0), (0.0, 0.0, -1.0), Sphere((1.0, 0.0, 0.0), 2.0))
    assert (larger.c, larger.discriminant, larger.roots) == (21.0, 16.0, (3.0, 7.0))
    tangent = sphere_roots((1.0, 0.0, 5.0), (0.0, 0.0, -1.0), unit)
    assert tangent.discriminant == 0.0 and tangent.roots == (5.0, 5.0)
    inside = sphere_roots((0.0, 0.0, 0.5), (0.0, 0.0, -1.0), unit)
    assert inside.roots == (-0.5, 1.5)


def test_the_roots_of_a_sphere_agree_with_the_tree() -> None:
    """From outside the hit is the smaller root, from the sphere itself the larger one."""
    tree = tracer.trace(world(), ray=RAY, depth=3)
    for path, chosen in (("E", 0), ("T", 1), ("TR", 1)):
        row = row_of(tree, path)
        found, told, t = hit_roots(tree, row), sphere_section(tree, row), float(tree.nodes["t"][row])
        assert found is not None and told is not None
        assert found.nearest(t) == chosen
        assert found.roots[chosen] == pytest.approx(t, rel=64 * U, abs=4 * float(tree.nodes["error"][row]))
        assert [line.value for line in told.lines if line.name in ("t₁", "t₂")][chosen] == f"{t:.5g}"


def aside(offset: float, start: float = 5.0) -> tuple[str, list[Mark]]:
    """The caption of the piece for a ray beside the centre of a ball of radius 1, and its marks."""
    seen = world_of(ball((offset, 0, 0)), ball((9, 0, 0), name="far"))
    tree = tracer.trace(seen, ray=((0.0, 0.0, start), (0.0, 0.0, -1.0)))
    for size in SIZES:
        place = context(seen, tree, 0, size)
        marks = live_kind("sphere").marks(place, {}, ("ball",))
        check_inside(marks, place.where)
        check_texts(marks)
    return words(marks), marks


def test_a_sphere_that_is_grazed_missed_left_behind_or_covered() -> None:
    for offset, start, said, roots in (
        (0.6, 5.0, "the smaller root above 0", 2),
        (1.0, 5.0, "both roots are one: the ray grazes the sphere", 2),
        (1.5, 5.0, "no root, the ray misses", 0),
        (0.6, 0.5, "from inside: t₁ < 0", 2),
        (0.6, -3.0, "both roots are below 0: behind the ray", 2),
        (0.6, -30.0, "both roots are below 0: behind the ray", 2),
    ):
        told, marks = aside(offset, start)
        assert said in told, offset
        assert sum(mark.name.startswith("root-") and isinstance(mark, Disc) for mark in marks) == roots
    assert "t₁ = t₂ = 5" in aside(1.0)[0] and " 1.5 " in aside(1.5)[0]
    seen = world_of(ball((0.6, 0, 0)), ball((0, 0, 3), name="first"), ball((1, 0, -4), name="grazed"))
    tree = tracer.trace(seen, ray=((0.0, 0.0, 5.0), (0.0, 0.0, -1.0)))
    behind = words(live_kind("sphere").marks(context(seen, tree), {}, ("ball",)))
    assert "another hit is nearer" in behind and "t₁ = 4.2" in behind
    grazed = words(live_kind("sphere").marks(context(seen, tree), {}, ("grazed",)))
    assert "another hit is nearer" in grazed and "t₁ = t₂ = 9" in grazed
    assert "t₁ = 1" in words(live_kind("sphere").marks(context(seen, tree), {}, ("first",)))


def test_the_plane_of_a_face_that_is_missed() -> None:
    """Between two teeth of the comb; beyond a side of a triangle; and planes that are not met."""
    corners = ((-6.0, 1.0, 0.0), (0.0, -5.0, 0.0), (0.0, 3.0, 0.0))
    seen = world_of(Object(COMB, SHINY, "comb"), Object(Triangle(corners), MATTE, "left"))

    def told(piece: str, point: tuple[float, float, float], direction: tuple[float, float, float], name: str) -> str:
        tree = tracer.trace(seen, ray=(point, direction))
        place = context(seen, tree, size=SIZES[0])
        marks = live_kind(piece).marks(place, {}, (name,))
        check_inside(marks, place.where)
        check_texts(marks)
        return words(marks)

    assert "2 is even: outside" in told("inside", (0.5, 0.5, 5.0), (0.0, 0.0, -1.0), "comb")
    assert "1 is odd: inside" in told("inside", (1.5, 0.5, 5.0), (0.0, 0.0, -1.0), "comb")
    assert "α = −0.250, β = 0.500, γ = 0.750" in told("inside", (1.5, -0.5, 5.0), (0.0, 0.0, -1.0), "left")
    assert "α = −1.000, β = 1.000, γ = 1.000" in told("inside", (6.0, -3.0, 5.0), (0.0, 0.0, -1.0), "left")
    assert "α = 0.000, β = 0.500, γ = 0.500" in told("inside", (0.0, -1.0, 5.0), (0.0, 0.0, -1.0), "left")
    for direction in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
        with pytest.raises(ValueError, match="inside: E does not meet the plane of comb"):
            told("inside", (0.5, 0.5, 5.0), direction, "comb")


def test_barycentric_coordinates() -> None:
    random = np.random.default_rng(1)
    for _ in range(50):
        corners, shares = random.normal(size=(3, 3)), random.dirichlet(np.ones(3))
        found = barycentric(corners, shares @ corners)
        assert sum(found) == pytest.approx(1.0, abs=4 * U)
        assert found == pytest.approx(shares, abs=1e-9)
    mesh = Mesh.example()
    seen = world_of(Object(mesh, MATTE, "tetrahedron"))
    tree = tracer.trace(seen, ray=((0.1, 0.2, 5.0), (0.0, 0.0, -1.0)))
    face = hit_face(tree, 0)
    assert face is not None and any((face == other).all() for other in mesh.placed())
    assert min(barycentric(face, tree.nodes["point"][0])) > 0.0
    assert np.cross(face[1] - face[0], face[2] - face[0]) @ tree.nodes["normal"][0] > 0.0


def test_crossings_are_odd_inside_a_polygon_only() -> None:
    """Against the winding number, from the angles at which the sides are seen, for random star-shaped outlines."""
    random = np.random.default_rng(2)
    for _ in range(200):
        count = int(random.integers(3, 12))
        turns = np.sort(random.uniform(0.0, 2.0 * math.pi, count))
        outline = random.uniform(0.3, 1.0, count)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        point = random.uniform(-1.0, 1.0, 2)
        arms = (outline - point) @ np.array([1.0, 1.0j])
        winding = round(float(np.angle(np.roll(arms, -1) / arms).sum()) / (2.0 * math.pi))
        flat = flattened(np.column_stack([outline, np.zeros(count)]), np.array([*point, 0.0]))
        assert len(flat.crossings()) % 2 == abs(winding) % 2


def test_lessons_name_the_numbers_of_faces() -> None:
    def told(name: str, pixel: tuple[int, int], *quantities: str) -> list[str | None]:
        tree = tracer.trace(tracer.prepare(tracer.load(lesson.read(name).scene)), pixel, depth=0)
        return [value_text(tree, None, quantity) for quantity in quantities]

    assert told("ray-triangle", (280, 316), "alpha", "beta", "gamma") == ["0.500", "0.300", "0.200"]
    assert told("ray-polygon", (280, 460), "crossings", "alpha") == ["3", "–"]
    assert told("ray-sphere", (400, 300), "crossings") == ["–"]
