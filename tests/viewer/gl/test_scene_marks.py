"""Signs and names over the 3D view, and what is shown at the selected hit."""

import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON, LESSONS
from tests.viewer.driver import Driver, viewer, viewer_of
from viewer.base.orbit import Frame, Orbit, project
from viewer.base.theme import DARK
from viewer.figures.marks import Disc, Shape, Text, overlap
from viewer.figures.steps import by_ray, of_kinds, whole
from viewer.figures.visible.interface import CONE, RADIUS, RADIUS_2, Hit, cone_rim, hit_of, interface_names
from viewer.gl.interface import interface_lines
from viewer.gl.ray_pieces import clear_first
from viewer.gl.scene_marks import NAMED, SUN, SceneMarks, longest_runs
from viewer.lessons import lesson

VIEWS = ((0.3, 0.2, 2.0), (2.6, 0.9, 4.0), (-1.9, -0.3, 1.2), (4.0, 0.1, 0.4))  # azimuth, elevation, distance


def marks_of(driver: Driver) -> SceneMarks:
    _, _, width, height = driver.canvas.stage_place
    made = SceneMarks(driver.session, driver.canvas, (width, height), driver.canvas.stage.depths())
    made.marks()
    return made


def turn(orbit: Orbit, view: tuple[float, float, float]) -> None:
    orbit.azimuth, orbit.elevation, orbit.distance = view
    orbit.target = np.zeros(3)


def look(orbit: Orbit) -> np.ndarray:
    return -orbit.outward


@pytest.mark.parametrize("name", EACH_LESSON)
def test_no_label_lies_over_another_or_outside(name: str) -> None:
    """At every lesson's own view and others, for every selected ray."""
    with viewer((900, 600)) as driver:
        driver.open(name)
        session, seen = driver.session, set()
        assert session.tree
        home = session.orbit
        for view in (None, *VIEWS):
            if view:
                turn(home, view)
            for row in (None, *range(0, len(session.tree), 3)):
                session.select(row)
                driver.frames(1)
                made = marks_of(driver)
                texts = [mark for mark in made.texts if isinstance(mark, Text)]
                boxes = [text.box() for text in texts]
                for k, box in enumerate(boxes):
                    assert not any(overlap(box, other) for other in boxes[k + 1 :])
                    assert box[0] >= 0 and box[1] >= 0 and box[2] <= made.size[0] and box[3] <= made.size[1]
                seen |= {text.content for text in texts}
        assert "E" in seen and "n" in seen and "eye" in seen


def test_labels_of_rays_come_before_names_of_lights_and_of_the_eye() -> None:
    with viewer((900, 600)) as driver:
        driver.open("glass-ball")
        names = {"sun", "lamp", "eye"}
        for view in VIEWS:
            turn(driver.session.orbit, view)
            driver.frames(1)
            order = [mark.content for mark in marks_of(driver).texts if isinstance(mark, Text)]
            ranks = [content in names for content in order]
            assert ranks == sorted(ranks)


def test_a_label_stands_at_the_visible_part_of_its_ray() -> None:
    """As near to a point of the ray that is in the view, and not behind an opaque thing, as its box allows."""
    with viewer((900, 600)) as driver:
        for name in ("mirror-balls", "two-lights"):
            driver.open(name)
            made = marks_of(driver)
            checked = 0
            for text in made.texts:
                if not isinstance(text, Text) or not text.name.startswith("ray-"):
                    continue
                row = int(text.name.removeprefix("ray-").removesuffix("-label"))
                line = next(line for line in driver.canvas.lines if line.row == row)
                shares = np.linspace(0.0, 1.0, 101)[:, None]
                places, seen = made.seen(line.start + shares * (line.end - line.start))
                left, top, right, bottom = text.box()
                away = np.hypot(
                    np.maximum(np.maximum(left - places[:, 0], places[:, 0] - right), 0.0),
                    np.maximum(np.maximum(top - places[:, 1], places[:, 1] - bottom), 0.0),
                )
                assert away[seen].min() < 12.0
                checked += 1
            assert checked >= 2


def test_an_arrow_points_to_each_light_outside_the_view() -> None:
    """Of all ways to turn the camera a little, the arrow's brings the light nearest to the line of sight, also if the
    light is behind the camera. A light in the view has no arrow.
    """
    with viewer((900, 600)) as driver:
        arrows = behind = suns = 0
        for name in ("glass-ball", "two-lights", "mirror-balls"):
            driver.open(name)
            session = driver.session
            assert session.world
            session.shown.camera = False
            for view in (*VIEWS, *((turned, 0.9, 0.3) for turned in range(6))):
                turn(session.orbit, view)
                driver.frames(1)
                made = marks_of(driver)
                eye, forward = made.orbit.eye, look(session.orbit)
                right, up = session.orbit.axes
                for j, light in enumerate(session.world.scene.lights):
                    assert light.position
                    point = session.frame.inside(light.position)
                    found = [mark for mark in made.signs if mark.name == f"light-{j}"]
                    places, depths = project(point[None], made.matrix, made.size)
                    half = 0.5 * SUN  # the whole sign must be in the view
                    inside = (places[0] >= half).all() and (places[0] <= np.subtract(made.size, half)).all()
                    in_view = depths[0] > 0 and inside
                    arrow = [mark for mark in found if isinstance(mark, Shape)]
                    assert bool(arrow) != in_view
                    suns += any(isinstance(mark, Disc) for mark in found)
                    if in_view:
                        continue
                    tip, _, back, _ = (np.array(corner) for corner in arrow[0].corners)
                    step = (tip - back) / np.linalg.norm(tip - back)
                    to_light = (point - eye) / np.linalg.norm(point - eye)
                    turns = np.linspace(0.0, 2.0 * math.pi, 90)
                    steps = np.vstack([step, np.stack([np.cos(turns), np.sin(turns)], axis=1)])
                    turned = forward + 1e-4 * (steps[:, :1] * right - steps[:, 1:] * up)
                    near = turned @ to_light / np.linalg.norm(turned, axis=1)
                    assert near[0] >= near[1:].max() - 1e-9
                    assert near[0] > forward @ to_light
                    arrows, behind = arrows + 1, behind + int(depths[0] <= 0.0)
        assert arrows > 8 and behind > 2 and suns > 3


def test_a_light_straight_behind_the_camera_has_no_arrow() -> None:
    orbit = Orbit(distance=2.0)
    assert orbit.direction_to(orbit.eye + 3.0 * orbit.outward) is None
    assert orbit.direction_to(orbit.eye - 3.0 * orbit.outward) is None
    dx, dy = orbit.direction_to(orbit.eye + 3.0 * orbit.outward + 0.1 * orbit.axes[0]) or (0.0, 0.0)
    assert (dx, dy) == pytest.approx((1.0, 0.0), abs=1e-9)


def hits(worlds: dict[str, tracer.World], name: str) -> list[tuple[tracer.RayTree, int, Hit]]:
    x, y = lesson.read(name).first.state.pixel or (0, 0)
    tree = tracer.trace(worlds[name], (x, y), depth=4)
    found = [(i, hit_of(tree, i, Frame.of(worlds[name]))) for i in range(len(tree))]
    return [(tree, i, hit) for i, hit in found if hit]


@pytest.mark.parametrize("name", EACH_LESSON)
def test_arcs_lie_between_the_normal_and_the_rays(name: str, worlds: dict[str, tracer.World]) -> None:
    for tree, i, hit in hits(worlds, name):
        node = tree.nodes[i]
        assert hit.towards(-hit.theta1) == pytest.approx(-node["direction"], abs=1e-7)
        assert (hit.critical is not None) == (hit.n2 is not None and hit.n1 > hit.n2)
        below = [c for c in tree.children[i] if tree.kind(c) == "refraction"]
        for child in below:
            assert hit.theta2 is not None
            assert hit.towards(math.pi - hit.theta2) == pytest.approx(tree.nodes["direction"][child], abs=1e-7)
        texts = [name.content for name in interface_names(hit, 0.1)]
        assert texts[0] == "n"
        assert ("n₂" in " ".join(texts)) == (hit.n2 is not None)
        # The corners of the arcs, at their distances from the foot, within their angles.
        lines = interface_lines(hit, 1.0, DARK)
        for ends in (lines["from"], lines["to"]):
            away = ends - hit.foot.astype(np.float32)
            far = np.linalg.norm(away, axis=1)
            angle = np.degrees(np.arccos(np.clip(away @ hit.normal / np.maximum(far, 1e-9), -1.0, 1.0)))
            first = np.isclose(far, RADIUS, atol=1e-5) & (away @ hit.normal > 0.0)
            second = np.isclose(far, RADIUS_2, atol=1e-5) & (away @ hit.normal < 0.0)
            assert (angle[first] <= math.degrees(hit.theta1) + 0.01).all()
            if hit.theta2 is not None:
                assert (180.0 - angle[second] <= math.degrees(hit.theta2) + 0.01).all()


def test_an_angle_is_drawn_with_its_ray(worlds: dict[str, tracer.World]) -> None:
    """theta2 with the refracted ray, the critical angle where totally reflected rays are shown."""
    tree = tracer.trace(worlds["glass-ball"], (248, 180), depth=3)
    row, frame = tree.find("T") or 0, Frame.of(worlds["glass-ball"])
    steps = by_ray(tree)
    refracted = tree.find("TT")
    for step in steps:
        hit = hit_of(tree, row, frame, step)
        assert hit and hit.critical
        assert (hit.theta2 is not None) == (refracted in step.rows)
    some = of_kinds(whole(tree), {"camera", "refraction"})
    hit = hit_of(tree, row, frame, some)
    assert hit and hit.theta2 is not None and hit.critical is None


def test_names_at_a_hit_stand_first_where_they_cover_no_ray() -> None:
    pieces = [((0.0, 0.0), (100.0, 100.0))]
    on, beside, across = ((50.0, 50.0), "middle"), ((150.0, 50.0), "middle"), ((90.0, 100.0), "middle")
    assert clear_first([on, across, beside], "n", pieces) == [beside, on, across]
    assert clear_first([on, across], "n", []) == [on, across]


def test_critical_cone_has_the_critical_angle_and_opens_to_the_incoming_ray(worlds: dict[str, tracer.World]) -> None:
    """sin(theta_c) = n2 / n1; a ray inside the cone is refracted, one outside is reflected totally."""
    cones = total = 0
    for name in LESSONS:
        for tree, i, hit in hits(worlds, name):
            if hit.critical is None:
                continue
            assert hit.n2
            side = (cone_rim(hit, 1.0) - hit.foot) / CONE
            assert np.linalg.norm(side, axis=1) == pytest.approx(1.0)
            cosine = side @ hit.normal
            assert np.sqrt(1.0 - cosine**2) == pytest.approx(hit.n2 / hit.n1, rel=1e-9)
            incoming = -tree.nodes["direction"][i]
            assert (cosine > 0.0).all() and incoming @ hit.normal > 0.0
            inside = incoming @ hit.normal > cosine[0]
            is_total = tree.nodes["radicand"][i] <= 0.0
            assert inside != is_total
            cones, total = cones + 1, total + int(is_total)
    assert cones > 5 and total >= 1


def test_the_ray_under_the_mouse_is_highlighted_in_both_views() -> None:
    with viewer((1100, 700)) as driver:
        driver.open("glass-ball")
        session = driver.session
        assert session.tree
        session.shown.kinds -= {"shadow"}
        driver.frames(3)
        plain = driver.canvas.stage.target.pixels().copy()
        rows = [i for i in range(1, len(session.tree)) if session.tree.kind(i) != "shadow"]
        aimed = [(row, place) for row in rows if (place := driver.lone_place(row))]
        assert aimed
        for row, place in aimed:
            driver.move(*place)
            driver.frames()
            assert session.hovered == row
            lit = driver.canvas.stage.target.pixels().copy()
            assert (lit != plain).any()
            driver.move(*driver.canvas.nodes[row])
            driver.frames()
            assert session.hovered == row
            assert (driver.canvas.stage.target.pixels() == lit).all()
        driver.move(*driver.pixel_at(5, 5))
        driver.frames()
        assert session.hovered is None
        assert (driver.canvas.stage.target.pixels() == plain).all()


def test_longest_runs() -> None:
    for size in (1, 5, 24):
        seen = np.random.default_rng(size).random((200, size)) < 0.6
        first, last = longest_runs(seen)
        for row, begin, end in zip(seen.tolist(), first.tolist(), last.tolist(), strict=True):
            runs = [len(run) for run in "".join("x" if one else " " for one in row).split()]
            assert begin <= end
            assert (end - begin + 1 if any(row) else 0) == max(runs, default=0)
            assert not any(row) or all(row[begin : end + 1])


@pytest.mark.parametrize("count", [NAMED, NAMED + 1])
def test_of_many_lights_only_that_of_the_selected_ray_is_named(tmp_path: Path, count: int) -> None:
    lights = "".join(f'[[light]]\nname = "spot {k}"\nposition = [{k - 4}, 4, 1]\n' for k in range(count))
    ball = '[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n'
    scene = f"format = 1\n[camera]\nposition = [0, 1, 8]\nlook_at = [0, 0, 0]\n{lights}{ball}"

    def names(driver: Driver) -> set[str]:
        texts = [mark.content for mark in marks_of(driver).texts if isinstance(mark, Text)]
        return {content for content in texts if content.startswith("spot")}

    with viewer_of(tmp_path / "own.toml", scene) as driver:
        driver.session.pick(*(side // 2 for side in driver.session.size))
        driver.session.orbit.distance = 6.0
        driver.frames(3)
        assert bool(names(driver)) == (count <= NAMED)
        tree = driver.session.tree
        assert tree
        driver.session.select(next(i for i in range(len(tree)) if tree.light_name(i) == "spot 4"))
        driver.frames(3)
        assert "spot 4" in names(driver) and (len(names(driver)) == 1) == (count > NAMED)
