"""Families of `raytree check`: the exact answers hold, the draws are many and repeatable, and wrong answers fail."""

import math
from collections.abc import Callable, Iterator
from decimal import Decimal, localcontext
from itertools import islice

import pytest
from mpmath import mp, mpf

from tracer.formulas.vector import scale, subtract
from tracer.measure.check import exact_shapes
from tracer.measure.check.case import DIGITS, Case, Reading, U, compare, run, worst_of
from tracer.measure.check.check import CASES
from tracer.measure.check.distribution import quantiles
from tracer.measure.check.draws import Draws, plus
from tracer.measure.check.exact_shapes import DECIDING, Tube
from tracer.measure.check.families import boxes, cones, faces, placed_meshes, refraction, rooms, spheres
from tracer.measure.check.families.judged import Decision, Hit, distances, wrong_of
from tracer.measure.check.scenes import world

HITS: dict[str, Callable[[Draws], Iterator[Hit]]] = {
    "spheres": lambda chance: spheres.hits(chance, 100),
    "cylinders": lambda chance: cones.hits(chance, 100, cylinder=True),
    "cones": lambda chance: cones.hits(chance, 100, cylinder=False),
    "faces": lambda chance: faces.nearly_edge_on(chance, 100),
}
DECISIONS: dict[str, Callable[[Draws], Iterator[Decision]]] = {
    "spheres": spheres.silhouettes,
    "cylinders": lambda chance: cones.silhouettes(chance, cylinder=True),
    "cones": lambda chance: cones.silhouettes(chance, cylinder=False),
    "discs": faces.rims,
    "total reflection": lambda chance: refraction.critical(chance, 500),
}


@pytest.mark.parametrize("name", HITS)
def test_distances_that_are_off_by_four_roundings_fail(name: str) -> None:
    with localcontext(DIGITS):
        hits = list(HITS[name](Draws(1)))
        good, told = distances(name, hits)
        assert (good.ok, told.ok) == (True, True)
        assert good.error > 0.5  # a double cannot hold the distance, so the worst of 100 must be off by half a unit
        off = hits[50]._replace(t=hits[50].t * (1.0 + 4.0 * 2.0**-53))
        bad, _ = distances(name, [*hits[:50], off, *hits[51:]])
        assert not bad.ok
        _, untrue = distances(name, [hit._replace(told=0.0) for hit in hits])
        assert not untrue.ok
        as_the_textbook, _ = distances(name, [hit._replace(t=hit.usual) for hit in hits])
        assert not as_the_textbook.ok


@pytest.mark.parametrize("name", DECISIONS)
def test_decisions_of_the_textbook_fail_and_both_answers_occur_near_the_edge(name: str) -> None:
    with localcontext(DECIDING):
        decisions = list(DECISIONS[name](Draws(2)))
    assert wrong_of(name, decisions).ok
    assert not wrong_of(name, [one._replace(ours=one.usual) for one in decisions]).ok
    near = [one for one in decisions if abs(one.margin) < 2.0**-30]
    assert min(sum(one.exact for one in near), sum(not one.exact for one in near)) > 40
    assert min(abs(one.margin) for one in near) < 2.0**-44


def test_rays_leave_a_room_without_its_last_wall() -> None:
    room = next(rooms.turned(Draws(3), 1, 40))
    walls = room.scenes[1].scene.objects
    closed, opened = rooms.escapes(
        iter([room._replace(scenes=[world(*walls), world(*walls[:-1])])]), ["closed", "open"]
    )
    assert closed.ok
    assert isinstance(opened.got, int)
    assert 20 < opened.got <= 40


def test_wrong_decisions_at_the_edges_of_a_box_have_a_large_margin() -> None:
    with localcontext(DIGITS):
        found = list(boxes.crossings(Draws(5)))
    assert max(one.wrongly(math.isfinite(one.t)) for one in found) <= 4.0
    assert max(one.wrongly(True) for one in found) > 1e9
    assert max(one.wrongly(False) for one in found) > 1e9
    assert sum(abs(one.margin) < 1.0 for one in found) > 10  # at edges, where only rounding decides


def test_box_is_entered_and_left() -> None:
    corners = ((0.0, 0.0, 0.0), (1.0, 2.0, 4.0))
    assert exact_shapes.box((-1, -1, -1), (1, 1, 1), *corners) == (1, 2)
    assert exact_shapes.box((-1, 1, 2), (2, 1, -1), *corners) == (Decimal("0.5"), 1)
    near, far = exact_shapes.box((-1, 0.5, 3), (1, 4, 1), *corners)
    assert near > far


def test_same_seed_same_draws_and_sizes_over_many_decades() -> None:
    with localcontext(DIGITS):
        one, other = (list(islice(spheres.hits(Draws(12), 200), 200)) for _ in range(2))
    assert one == other
    sizes = sorted(math.log10(hit.exact) for hit in one)
    assert sizes[0] < -9.0 < 9.0 < sizes[-1]


def test_hits_of_a_cone_lie_on_it() -> None:
    """Put into the equation of the cone in the form without the axis's length, in mpmath."""
    chance, count = Draws(4), 0
    with mp.workdps(120), localcontext(DECIDING):
        for _ in range(60):
            shape, _ = cones.tube(chance, chance.random(), chance.size(-2, 2))
            eye = plus(shape.base, chance.place(shape.base_radius * 3.0))
            way = subtract(plus(scale(0.3, shape.base), scale(0.7, shape.apex)), eye)
            for t in exact_shapes.tube(eye, way, shape):
                count += 1
                p = [mpf(str(Decimal(o) + t * Decimal(d))) for o, d in zip(eye, way, strict=True)]
                arm = [x - mpf(b) for x, b in zip(p, shape.base, strict=True)]
                axis = [mpf(a) - mpf(b) for a, b in zip(shape.apex, shape.base, strict=True)]
                share = mp.fdot(arm, axis) / mp.fdot(axis, axis)
                across = mp.norm([x - share * a for x, a in zip(arm, axis, strict=True)])
                radius = (1 - share) * mpf(shape.base_radius) + share * mpf(shape.apex_radius)
                assert 0 <= share <= 1
                assert abs(across - radius) < mpf(10) ** -60 * radius
    assert count > 50


@pytest.mark.parametrize(
    ("point", "expected"),
    [((0.25, 0.25, 0), 0), ((0.25, 0.25, -3), 3), ((-3, 0, 4), 5), ((1, 1, 0), Decimal("0.5").sqrt()), ((4, 0, 4), 5)],
)
def test_distance_to_a_face(point: tuple[float, float, float], expected: Decimal) -> None:
    found = exact_shapes.distance_to_face(point, ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    assert abs(found - expected) < Decimal("1e-26")


def test_tube_is_hit_between_its_ends() -> None:
    cone = Tube((0, 0, 0), 2.0, (0, 0, 4), 0.0)
    assert exact_shapes.tube((-5, 0, 2), (1, 0, 0), cone) == [4, 6]
    assert exact_shapes.tube((0, 0, 2), (1, 0, 0), cone) == [1]
    assert exact_shapes.tube((-5, 0, 5), (1, 0, 0), cone) == []
    assert exact_shapes.tube((-5, 2.5, 1), (1, 0, 0), cone) == []


def test_sines_of_placements_are_right() -> None:
    with mp.workdps(60), localcontext(DIGITS):
        for degrees in (-170.3, -1e-3, 0.0, 33.3, 90.0, 179.9):
            for found, exact in zip(
                placed_meshes.sine_and_cosine(degrees),
                (mp.sin(mpf(degrees) / 180 * mp.pi), mp.cos(mpf(degrees) / 180 * mp.pi)),
                strict=True,
            ):
                assert abs(mpf(str(found)) - exact) < mpf(10) ** -45


def test_worst_of_keeps_the_draws_and_compares_the_worst() -> None:
    def draw(ours: float, theirs: float) -> Reading:
        return Reading("", 1, 1.0 + 2.0 * ours * U, textbook=1.0 + 2.0 * theirs * U)

    family = worst_of("x", [draw(1.0, 1.0), draw(2.0, 1.0), draw(0.0, 3.0), draw(1.0, 0.0)])
    assert (family.setting, family.error, family.textbook_error) == ("x, worst of 4", 4.0, 2.0)
    assert (family.textbooks_worst.error, family.textbooks_worst.textbook_error) == (0.0, 6.0)
    assert family.comparison == "worse"
    assert [one.comparison for one in family.draws] == ["as good", "better", "worse", "better"]
    assert compare(None, 1.0) is None


def test_quantiles_are_errors_that_so_many_do_not_exceed() -> None:
    assert quantiles(float(k) for k in range(1, 201)) == {"median": 100.0, "90 %": 180.0, "99 %": 198.0, "worst": 200.0}
    assert quantiles(float(k) for k in range(1, 11)) == {"median": 5.0, "90 %": 9.0, "99 %": 10.0, "worst": 10.0}
    assert quantiles([7.0]) == {"median": 7.0, "90 %": 7.0, "99 %": 7.0, "worst": 7.0}


@pytest.mark.parametrize("case", [case for case in CASES if case.id in ("A3", "D13", "B13")], ids=lambda case: case.id)
def test_errors_of_the_textbook_have_the_unit_of_ours(case: Case) -> None:
    readings = [one for reading in run(case).readings for one in (reading, *reading.draws)]
    with mp.workdps(60):
        for one in readings:
            for answer, error in ((one.got, one.error), (one.textbook, one.textbook_error)):
                assert isinstance(answer, float)
                if math.isfinite(answer):
                    distance = abs(mpf(answer) - mpf(str(exact_shapes.decimal(one.exact))))
                    assert error == pytest.approx(float(distance / one.unit), rel=1e-9)
