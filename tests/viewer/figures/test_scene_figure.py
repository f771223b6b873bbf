"""The scene's figure: rays end where the camera projects their points, outlines are true, hidden parts are faint."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import MATTE, box, world_of
from tests.viewer.figures.geometry import overlap
from tracer.formulas.camera import View, make_view
from tracer.formulas.shading import surface_color
from tracer.kernel.nodes import SHADOW
from tracer.scene import Camera, Checker, Light, Material, Object
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere
from viewer.base.orbit import Frame, Orbit, initial_orbit
from viewer.base.theme import Arrow
from viewer.cli import main
from viewer.figures.marks import HEIGHT, WIDTH, Figure, Line, Shape, Text, clip_shares
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth, by_ray
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.visible.interface import RADIUS, RADIUS_2, SMALLEST
from viewer.figures.visible.outlines import FINE, is_too_fine, label_spots
from viewer.figures.visible.rings import sharpen_corners, simplify, straighten
from viewer.figures.visible.scenery import orbit_camera, visible_parts
from viewer.lessons import lesson

CANVAS = (0.0, 0.0, WIDTH, HEIGHT)


def seen_by(camera: Camera) -> View:
    """The tracer's own camera: another projection than the 3D view's matrix."""
    assert camera.position
    assert camera.look_at
    return make_view(camera.position, camera.look_at, camera.up, camera.fov, (int(WIDTH), int(HEIGHT)))


def landing(view: View, point: np.ndarray) -> tuple[float, float]:
    """The pixel whose camera ray goes through the point."""
    gaze = np.asarray(point) - view.eye
    depth = float(gaze @ view.forward)
    right, up = np.array(view.right), np.array(view.up)
    u = float(gaze @ right) / depth / float(right @ right)
    v = float(gaze @ up) / depth / float(up @ up)
    return (0.5 * (view.width + u * view.height), 0.5 * (view.height - v * view.height))


def within(point: tuple[float, float], rim: float = 0.0) -> bool:
    return rim < point[0] < WIDTH - rim and rim < point[1] < HEIGHT - rim


def subject(world: tracer.World, name: str, depths: range = range(4)) -> Subject:
    found = lesson.read(name)
    trees = [tracer.trace(world, found.first.state.pixel, depth=d) for d in depths]
    return Subject(by_depth(trees), world, initial_orbit(world, Frame.of(world), found.first.state.view))


@pytest.fixture(scope="module", params=EACH_LESSON)
def grown(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> tuple[Subject, list[Figure]]:
    """Each lesson's scene with the rays of depth 0 to 3."""
    what = subject(worlds[request.param], request.param)
    return what, pages("scene", what, FigureStyle())


def test_rays_land_where_the_camera_projects_their_points(grown: tuple[Subject, list[Figure]]) -> None:
    what, (*_, figure) = grown
    assert what.world
    assert what.orbit
    view = seen_by(orbit_camera(what.orbit, Frame.of(what.world)))
    tree, near = what.steps[-1].tree, 1e-3 * Frame.of(what.world).radius
    checked = 0
    for i in range(len(tree)):
        row = tree.nodes[i]
        if row["t"] == 0.0:
            continue
        ends = [m for m in figure.marks if isinstance(m, Line) and m.name == f"ray-{i}"]
        for point, first in ((row["origin"], True), (row["point"], False)):
            if np.isnan(point).any() or (np.asarray(point) - view.eye) @ view.forward <= near:
                continue
            wanted = landing(view, point)
            if not within(wanted):
                continue
            places = [line.start if first else line.end for line in ends]
            assert min(math.dist(wanted, place) for place in places) < 1e-6 * WIDTH, i
            checked += 1
    assert checked >= 2


def test_a_balls_outline_is_its_silhouette() -> None:
    """Seen from a pinhole, all tangents to a ball make the same angle with the ray through its centre."""
    middle, radius = np.array([0.4, -0.2, 0.3]), 0.7
    world = world_of(Object(Sphere((0.4, -0.2, 0.3), radius), MATTE, "ball"))
    orbit = Orbit(0.7, 0.4, 4.0)
    camera = orbit_camera(orbit, Frame.of(world))
    view = seen_by(camera)
    (part,) = visible_parts(world, camera, CANVAS).opaque
    ((area,),) = part.faces
    away = middle - view.eye
    widest = math.asin(radius / np.linalg.norm(away))
    for x, y in area.outline:
        d = np.array(view.forward) + (2 * x - WIDTH) / HEIGHT * np.array(view.right)
        d += (HEIGHT - 2 * y) / HEIGHT * np.array(view.up)
        angle = math.acos(float(d @ away) / np.linalg.norm(d) / np.linalg.norm(away))
        point = HEIGHT / 2 / np.linalg.norm(view.up)  # points a radian in the middle of the picture, more at its rim
        assert abs(angle - widest) * point < 0.6
    assert not area.holes


def test_what_is_hidden_is_faint() -> None:
    """A shadow ray passes behind a box: it is faint between the two edges, as far as the box is wide."""
    wall = box((-0.5, -1.0, 1.0), (0.5, 1.0, 1.2))
    floor = Object(Sphere((3.0, 0.0, 0.0), 0.5), Material("m", diffuse=1.0), "ball")
    lamp = Light("lamp", position=(-3.0, 0.0, 0.0))
    world = world_of(wall, floor, lights=[lamp])
    tree = tracer.trace(world, ray=((0.0, 3.0, 0.0), (2.6, -2.8, 0.0)), depth=0)
    (i,) = (k for k in range(len(tree)) if tree.nodes["kind"][k] == SHADOW)
    orbit = Orbit(0.0, 0.0, 2.6)
    frame = Frame.of(world)
    orbit.north, orbit.up = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    (figure,) = pages("scene", Subject(by_depth([tree]), world, orbit), FigureStyle())
    view = seen_by(orbit_camera(orbit, frame))
    lines = [m for m in figure.marks if isinstance(m, Line) and m.name == f"ray-{i}"]
    faint = [line for line in lines if line.stroke.color[3] < 1.0]
    assert len(faint) == 1
    # The width of the box as the eye sees it.
    across = [landing(view, np.array([x, 0.0, z]))[0] for x in (-0.5, 0.5) for z in (1.0, 1.2)]
    edges = [min(across), max(across)]
    assert sorted(p[0] for p in (faint[0].start, faint[0].end)) == pytest.approx(edges, abs=0.2)


def test_labels_avoid_each_other_and_stay_inside(grown: tuple[Subject, list[Figure]]) -> None:
    for figure in grown[1]:
        check_labels(figure)


def check_labels(figure: Figure) -> None:
    texts = [mark for mark in figure.marks if isinstance(mark, Text)]
    for a, b in itertools.combinations(texts, 2):
        assert not overlap(a.box(), b.box()), (a, b)
    for text in texts:
        left, top, right, bottom = text.box()
        assert left >= 0.0 and top >= 0.0 and right <= WIDTH and bottom <= HEIGHT
        assert text.size >= 18.0
    for mark in figure.marks:
        for x, y in mark.corners if isinstance(mark, Shape) else ():
            assert -3.0 <= x <= WIDTH + 3.0 and -1.0 <= y <= HEIGHT + 1.0


def test_things_stay_while_rays_come(grown: tuple[Subject, list[Figure]]) -> None:
    _, figures = grown
    things = [[m for m in figure.marks if m.name.startswith("object-") and "label" not in m.name] for figure in figures]
    assert all(step == things[-1] for step in things)
    names = [{m for m in figure.marks if isinstance(m, Text)} for figure in figures]
    assert all(before <= after for before, after in itertools.pairwise(names))
    lines = [{m for m in figure.marks if isinstance(m, Line) and m.name.startswith("ray-")} for figure in figures]
    for before, after in itertools.pairwise(lines):
        assert {(m.name, m.start, m.end) for m in before} <= {(m.name, m.start, m.end) for m in after}


def test_both_panels_call_rays_the_same(worlds: dict[str, tracer.World]) -> None:
    (figure,) = pages("both", subject(worlds["glass-ball"], "glass-ball", range(3, 4)), FigureStyle())
    check_labels(figure)
    left, right = set(), set()
    for mark in figure.marks:
        if isinstance(mark, Text) and mark.name.startswith("ray-"):
            (left if mark.at[0] < 0.45 * WIDTH else right).add(mark.content.split()[0])
    assert len(left) >= 6
    assert left <= right


def test_simpler_outlines_stay_where_they_were() -> None:
    turn = np.linspace(0.0, 2.0 * math.pi, 721)[:-1]
    ring = np.stack([100.0 * np.cos(turn), 100.0 * np.sin(turn)], axis=1)
    fewer = simplify(ring)
    assert len(fewer) < 80
    middles = 0.5 * (fewer + np.roll(fewer, -1, axis=0))
    assert np.hypot(*middles.T).min() > 100.0 - 0.2 - 1e-9


def test_names_stand_well_within_what_they_name() -> None:
    """A name stands at the place that is farthest from the rim. Parts smaller than the grid of places have no name."""
    mask = np.zeros((200, 400), bool)
    mask[16:184, 16:184] = True
    spots = label_spots(mask, (100.0, 50.0, 300.0, 150.0))
    x, y = spots[0]
    assert math.dist((x, y), (150.0, 100.0)) < 6.0
    assert all(108.0 <= x <= 192.0 and 58.0 <= y <= 142.0 for x, y in spots)
    speck = np.zeros((200, 400), bool)
    speck[3:6, 3:6] = True
    assert label_spots(speck, (0.0, 0.0, 200.0, 100.0)) == ()


def test_checkers_are_where_the_floor_has_them(worlds: dict[str, tracer.World]) -> None:
    """The middle of each square, traced back to the floor, has the other colour there."""
    checks = Material("floor", diffuse=1.0, checker=Checker((0.2, 0.2, 0.2), 1.0))
    floor = Object(Polygon(((-4.0, 0.0, -4.0), (-4.0, 0.0, 4.0), (4.0, 0.0, 4.0), (4.0, 0.0, -4.0))), checks, "floor")
    world = world_of(floor)
    camera = orbit_camera(Orbit(0.5, 0.9, 3.0), Frame.of(world))
    view = seen_by(camera)
    (part,) = visible_parts(world, camera, CANVAS).opaque
    assert len(part.checks) >= 8
    material, this = world.arrays.materials[0], world.arrays.objects[0]
    for area in part.checks:
        if area.holes or len(area.outline) > 8:
            continue  # squares that touch at their corners
        x, y = np.mean(area.outline, axis=0)
        d = np.array(view.forward) + (2 * x - WIDTH) / HEIGHT * np.array(view.right)
        d += (HEIGHT - 2 * y) / HEIGHT * np.array(view.up)
        point = np.array(view.eye) - view.eye[1] / d[1] * d
        assert surface_color(material, this, tuple(point.tolist())) == (0.2, 0.2, 0.2)


@pytest.mark.parametrize(("points", "fine"), ((1, True), (2, True), (5, False), (12, False)))
def test_squares_too_fine_to_be_drawn_are_told(points: int, fine: bool) -> None:
    rows, columns = np.indices((240, 240)) // (FINE * points)
    everywhere = np.ones((240, 240), bool)
    for squares in ((rows + columns) % 2 == 0, rows % 2 == 0, columns % 2 == 0):
        assert (is_too_fine(squares, everywhere) == fine).all()


def test_a_ray_has_its_name_upon_it_or_beside_it(grown: tuple[Subject, list[Figure]]) -> None:
    """If a name stands on a ray's line, no other ray is nearer to it than its own."""
    for figure in grown[1]:
        lines = [m for m in figure.marks if isinstance(m, Line) and m.name.startswith("ray-")]
        for text in (m for m in figure.marks if isinstance(m, Text) and m.name.startswith("ray-")):
            own = [line for line in lines if f"{line.name}-label" == text.name]
            left, top, right, bottom = text.box()
            reach = 2.4 * text.size
            wide = (left - reach, top - reach, right + reach, bottom + reach)
            assert any(clip_shares((line.start, line.end), wide) for line in own), text


def test_rays_that_leave_the_picture_say_to_which_light(grown: tuple[Subject, list[Figure]]) -> None:
    what, (*_, figure) = grown
    tree = what.steps[-1].tree
    words = {m.content for m in figure.marks if isinstance(m, Text)}
    for i in np.flatnonzero(tree.nodes["kind"] == SHADOW):
        name = tree.light_name(int(i))
        lines = [m for m in figure.marks if isinstance(m, Line) and m.name == f"ray-{i}" and not m.arrow.value]
        ends = [line.end for line in lines if line.stroke.dash != (0.0, 0.0)]
        if any(min(x, WIDTH - x, y, HEIGHT - y) < 0.4 for x, y in ends):
            assert {f"to {name}", name} & words


def test_glass_is_named_where_nothing_opaque_is_behind_it() -> None:
    """One half of a pane stands before a wall: its name stands on the other half."""
    pane = box((-2.0, -1.0, 0.0), (2.0, 1.0, 0.1), Material("glass", transmit=1.0, ior=1.5), name="pane")
    wall = box((-2.0, -1.0, -1.0), (0.0, 1.0, -0.9), name="wall")
    world = world_of(pane, wall)
    orbit = Orbit(0.0, 0.0, 2.6)
    orbit.north, orbit.up = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    seen = visible_parts(world, orbit_camera(orbit, Frame.of(world)), CANVAS)
    (glass,) = seen.glass
    assert glass.spots[0][0] > 0.5 * WIDTH
    (wall_seen,) = seen.opaque
    ((area,), *_) = wall_seen.faces
    x, y = np.mean(area.outline, axis=0).tolist()
    assert area.covers((x, y))
    assert not area.covers((x + WIDTH, y))


def test_edges_are_straight_and_corners_sharp() -> None:
    """Seen along no axis, all corners of a box are where the camera projects them."""
    world = world_of(box((-1.0, -0.5, -0.7), (1.0, 0.5, 0.7)))
    camera = orbit_camera(Orbit(0.6, 0.45, 3.2), Frame.of(world))
    view = seen_by(camera)
    (part,) = visible_parts(world, camera, CANVAS).opaque
    assert len(part.faces) == 3
    corners = itertools.product((-1.0, 1.0), (-0.5, 0.5), (-0.7, 0.7))
    landings = [landing(view, np.array(corner)) for corner in corners]
    for ((area,),) in zip(part.faces, strict=True):
        assert len(area.outline) == 4
        for x, y in area.outline:
            # Two edges, each off by a quarter of a point, the width of a ray, meet at no less than 45 degrees.
            assert min(math.dist((x, y), place) for place in landings) < 0.7


def test_round_outlines_stay_round() -> None:
    turn = np.linspace(0.0, 2.0 * math.pi, 400)[:-1]
    for radius in (3.0, 20.0, 200.0):
        ring = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
        done = sharpen_corners(straighten(simplify(ring)), ring)
        assert set(map(tuple, done)) == set(map(tuple, simplify(ring)))
        across = np.hypot(*done.T)
        assert np.abs(across - radius).max() < 1e-9


def test_all_of_each_glass_object_is_drawn() -> None:
    """Also a ball inside a ball, and a mirror in it: each outline is that of the object alone."""
    glass, clear = Material("glass", transmit=0.9, ior=1.5), Material("water", transmit=0.9, ior=1.33)
    alone = [
        Object(Sphere((0.0, 0.0, 0.0), 1.0), glass, "ball"),
        Object(Sphere((0.1, 0.1, 0.0), 0.5), clear, "bubble", priority=1),
        box((-3.0, -1.2, -1.2), (1.2, 1.2, 1.2), clear, name="tank"),
        Object(Sphere((-2.0, 0.0, 0.0), 0.4), glass, "bead", priority=1),
    ]
    mirror = Object(Sphere((-2.0, 0.0, 0.0), 0.2), Material("mirror", reflect=0.9), "mirror")
    world = world_of(*alone, mirror)
    camera = orbit_camera(Orbit(0.6, 0.3, 3.2), Frame.of(world))
    seen = visible_parts(world, camera, CANVAS)
    assert [part.number for part in seen.opaque] == [4]
    assert [part.number for part in seen.glass] == [0, 1, 2, 3]
    for part in seen.glass:
        only = visible_parts(world_of(alone[part.number]), camera, CANVAS)
        assert [[area.outline for area in face] for face in part.faces] == [
            [area.outline for area in face] for face in only.glass[0].faces
        ]


@pytest.mark.parametrize("lights", (4, 5, 64))
def test_rays_to_many_lights_are_left_out_and_the_figure_says_so(lights: int) -> None:
    glass = Object(Sphere((0.0, 0.0, 0.0), 1.0), Material("glass", transmit=0.9, reflect=0.1, ior=1.5), "ball")
    lamps = [Light(f"lamp {k}", position=(2.0 * math.sin(k), 2.0, 2.0 * math.cos(k))) for k in range(lights)]
    world = world_of(glass, lights=lamps)
    tree = tracer.trace(world, ray=((0.0, 0.2, 4.0), (0.0, 0.0, -1.0)), depth=2)
    for name in ("scene", "both"):
        (figure,) = pages(
            name, Subject(by_depth([tree]), world, initial_orbit(world, Frame.of(world), None)), FigureStyle()
        )
        shadows = {f"ray-{i}" for i in np.flatnonzero(tree.nodes["kind"] == SHADOW)}
        words = {m.content for m in figure.marks if isinstance(m, Text)}
        assert bool(shadows & {m.name for m in figure.marks}) == (lights == 4)
        said = {f"L: rays to {lights} lights are left out", f"{lights} lights: rays left out"}
        assert bool(said & words) == (lights > 4)
    first, second = pages(
        "scene", Subject(by_ray(tree)[:2], world, initial_orbit(world, Frame.of(world), None)), FigureStyle()
    )
    added = {f"ray-{i}" for i in by_ray(tree)[1].current}
    assert added <= {m.name for m in second.marks}  # the rays that a step adds are drawn
    assert not added & {m.name for m in first.marks}


def test_a_sign_near_the_border_is_moved_inwards(tmp_path: Path) -> None:
    """In this figure, the eye of the scene is nearer to the border than half a sign. The tree has the other eye."""
    assert main.main(["export", "mirror-balls", "--figure", "both", "-o", str(tmp_path / "a.svg")]) == 0
    assert (tmp_path / "a.svg").read_text("utf-8").count("<title>the eye</title>") == 2


@pytest.mark.parametrize(("name", "path"), [("glass-ball", "T"), ("glass-ball", "E"), ("underwater", "E")])
def test_the_selected_hit_has_its_normal_and_angles(worlds: dict[str, tracer.World], name: str, path: str) -> None:
    """The normal starts at the hit and points along it, and both arcs run from the normal to their rays."""
    what = subject(worlds[name], name, range(3, 4))
    assert what.world and what.orbit
    (figure,) = pages("scene", what, FigureStyle(text_size=9.0))
    tree = what.steps[-1].tree
    row = tree.find(path)
    assert row is not None and not any(mark.name.startswith("interface") for mark in figure.marks)
    (figure,) = pages("scene", what, FigureStyle(text_size=9.0, selected=row))
    view, node = seen_by(orbit_camera(what.orbit, Frame.of(what.world))), tree.nodes[row]
    lines = [mark for mark in figure.marks if isinstance(mark, Line) and mark.name == "interface"]
    (normal,) = (line for line in lines if line.arrow is Arrow.FILLED)
    assert math.dist(normal.start, landing(view, node["point"])) < 1e-6
    ends = [end for line in lines for end in (line.start, line.end)]
    radii = {node["theta1"]: RADIUS, node["theta2"]: RADIUS_2}
    arcs = [(angle, share) for angle, share in radii.items() if np.isfinite(angle) and angle > SMALLEST]
    assert arcs
    length = _length_of(view, node, normal.end)
    for angle, share in arcs:
        outgoing = share == RADIUS_2
        middle = node["normal"] * (-1.0 if outgoing else 1.0)
        along = node["direction"] + np.cos(node["theta1"]) * node["normal"]
        along = along / np.linalg.norm(along) * (1.0 if outgoing else -1.0)
        ray = np.cos(angle) * middle + np.sin(angle) * along
        for towards in (middle, ray):
            place = landing(view, node["point"] + share * length * towards)
            assert min(math.dist(place, end) for end in ends) < 1e-4 * WIDTH
    dimmed = {mark.name: mark.stroke.color[3] for mark in figure.marks if isinstance(mark, Line)}
    assert dimmed[f"ray-{row}"] == 1.0
    texts = [mark.content for mark in figure.marks if isinstance(mark, Text) and mark.name.startswith("interface")]
    assert "n" in texts


def _length_of(view: View, node: np.void, tip: tuple[float, float]) -> float:
    """The length in the scene of a normal that ends here in the picture."""
    low, high = 0.0, 1e3 * float(node["t"])
    away = math.dist(tip, landing(view, node["point"]))
    for _ in range(200):
        middle = 0.5 * (low + high)
        there = landing(view, node["point"] + middle * node["normal"])
        low, high = (middle, high) if math.dist(there, landing(view, node["point"])) < away else (low, middle)
    return low
