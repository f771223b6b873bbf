"""Every shape against results of geometry."""

import math

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, OPEN, ball, box, kinds, polygon, world_of
from tracer.kernel.nodes import BACKGROUND
from tracer.rays import make_ray
from tracer.scene import Material, Object
from tracer.shapes import sphere
from tracer.shapes.mesh import Geometry, Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle

LETTER_U = tuple((float(x), float(y), 0.0) for x, y in ((0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)))


def hits(world: tracer.World, origin: tuple, direction: tuple) -> bool:
    return bool(tracer.trace(world, ray=(origin, direction), depth=0).nodes["end"][0] != BACKGROUND)


def test_concave_polygon_is_open_where_it_is_cut_out() -> None:
    """A U: its two arms and its bar are hit, the gap between them is not."""
    world = world_of(Object(Polygon(LETTER_U), OPEN, "U"))
    for x, y, inside in (
        (0.5, 2, True),
        (3.5, 2, True),
        (2, 0.5, True),
        (2, 2, False),
        (2, 1.01, False),
        (5, 1, False),
    ):
        assert hits(world, (x, y, 5), (0, 0, -1)) == inside
        assert hits(world, (x + 1, y - 2, -3), (-1 / 3, 2 / 3, 1)) == inside


def test_polygon_normal_is_on_the_side_from_which_its_corners_run_counter_clockwise() -> None:
    for corners, sign in ((LETTER_U, 1.0), (LETTER_U[::-1], -1.0)):
        world = world_of(Object(Polygon(corners), Material("glass", transmit=1.0, ior=1.5), "face"))
        tree = tracer.trace(world, ray=((0.5, 0.5, 5), (0, 0, -1)), depth=1)
        # The solid lies behind the normal: a ray from the front enters it.
        assert (tree.nodes["n1"][0], tree.nodes["n2"][0]) == ((1.0, 1.5) if sign > 0 else (1.5, 1.0))


def test_polygons_that_share_edges_leave_no_gap() -> None:
    """A tilted grid of quadrangles: rays at corners and along edges all hit one of them."""
    turn = np.array([[0.8, 0.0, 0.6], [0.36, 0.8, -0.48], [-0.48, 0.6, 0.64]])
    objects = []
    for i in range(6):
        for j in range(6):
            corners = [(i, j, 0), (i + 1, j, 0), (i + 1, j + 1, 0), (i, j + 1, 0)]
            turned = (np.array(corners, float) / 3.0 - 1.0) @ turn.T
            objects.append(polygon(turned, OPEN))
    world = world_of(*objects)
    random = np.random.default_rng(5)
    for _ in range(400):
        i, j = random.integers(1, 6, 2)
        along = random.random() if random.random() < 0.5 else 0.0
        target = (np.array([i + along * (i < 5), j, 0.0]) / 3.0 - 1.0) @ turn.T
        origin = target + (random.normal(size=3) + np.array([0, 0, 3])) @ turn.T
        assert hits(world, tuple(origin), tuple(target - origin))


def uv_sphere(lines: int, segments: int, center: tuple = (0, 0, 0), radius: float = 2.0) -> Mesh:
    """A closed mesh with many-cornered poles."""
    theta = np.linspace(0, math.pi, lines + 1)[1:-1]
    phi = np.linspace(0, 2 * math.pi, segments, endpoint=False)
    rings = [[(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)) for p in phi] for t in theta]
    vertices = [(0, 0, 1), *(corner for ring in rings for corner in ring), (0, 0, -1)]
    faces = []
    for k in range(segments):
        n = (k + 1) % segments
        faces.append((0, 1 + k, 1 + n))
        for line in range(lines - 2):
            a, b = 1 + line * segments, 1 + (line + 1) * segments
            faces += [(a + k, b + k, b + n), (a + k, b + n, a + n)]
        last = 1 + (lines - 2) * segments
        faces.append((last + k, len(vertices) - 1, last + n))
    return Mesh(Geometry(radius * np.array(vertices, float) + np.array(center), np.array(faces)), "made")


@pytest.mark.parametrize("center", [(0, 0, 0), (148376, 1234, -223423)])
def test_closed_mesh_has_no_leak(center: tuple) -> None:
    """From inside a ball of triangles, rays at corners, at edges and anywhere all hit it. Source: Embree's own test."""
    mesh = uv_sphere(16, 32, center)
    assert mesh.is_closed()
    world = world_of(Object(mesh, OPEN, "mesh"))
    corners = mesh.placed()
    random = np.random.default_rng(3)
    for k in range(1500):
        origin = np.array(center) + random.uniform(-0.5, 0.5, 3)
        face = corners[random.integers(len(corners))]
        along = random.random()
        target = face[0] if k % 3 == 0 else face[0] + along * (face[1] - face[0]) if k % 3 == 1 else face.mean(axis=0)
        assert hits(world, tuple(origin), tuple(target - origin))


def test_glass_mesh_is_entered_and_left_at_its_edges_too() -> None:
    """Rays through edges and corners of a glass mesh: inside and outside alternate."""
    mesh = uv_sphere(8, 12, radius=1.0)
    world = world_of(Object(mesh, Material("glass", transmit=1.0, ior=1.3), "mesh"), background=(1, 1, 1))
    random = np.random.default_rng(11)
    corners = mesh.placed()
    for k in range(600):
        face = corners[random.integers(len(corners))]
        target = face[0] if k % 2 else 0.5 * (face[0] + face[1])
        origin = target + random.normal(size=3) * 3.0
        tree = tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=60)
        for i in range(len(tree)):
            row = tree.nodes[i]
            assert row["n1"] in (1.0, 1.3)
            if row["end"] == BACKGROUND:
                assert row["n1"] == 1.0, (k, kinds(tree))
    assert tree.nodes["n1"][0] == 1.0


@pytest.mark.parametrize("first", [0, 2])
@pytest.mark.parametrize("pieces", [1, 2])
def test_corner_of_a_room_keeps_rays_in(pieces: int, first: int) -> None:
    """Mirrors at right angles, each one polygon or two triangles: rays into their edges and corner come back.

    The plane of a face is given by its first corner: here, or a thousand kilometres away.
    """
    mirror = Material("mirror", reflect=1.0)
    s = 1e6
    walls = [
        ((0, 0, 0), (s, 0, 0), (s, s, 0), (0, s, 0)),
        ((0, 0, 0), (0, s, 0), (0, s, s), (0, 0, s)),
        ((0, 0, 0), (0, 0, s), (s, 0, s), (s, 0, 0)),
    ]
    random = np.random.default_rng(2)
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    for turn in (np.eye(3), axes):
        turned = [np.roll(np.array(wall, float) @ turn.T, -first, axis=0).tolist() for wall in walls]
        objects = [polygon(wall, mirror) for wall in turned]
        if pieces == 2:
            halves = [half for a, b, c, d in turned for half in ((a, b, c), (a, c, d))]
            objects = [Object(Triangle(tuple(map(tuple, half))), mirror) for half in halves]
        world = world_of(*objects, background=(1, 1, 1))
        for k in range(300):
            target = np.array([0.0, 0.0, 0.0])
            target[k % 3] = (
                0.0 if k % 2 else 10.0 ** random.uniform(-1, 5)
            )  # the corner itself, or any point of an edge
            origin = random.uniform(1, 4, 3)
            d = target - origin
            tree = tracer.trace(world, ray=(tuple(turn @ origin), tuple(turn @ d)), depth=10)
            out = turn.T @ tree.nodes["direction"][-1]
            assert tree.nodes["end"][-1] == BACKGROUND
            # It leaves into the room: no component points behind the walls.
            assert (out >= -1e-12).all(), (k, out, tree.nodes["point"])


def test_convex_edge_does_not_stop_a_ray_that_leaves_it() -> None:
    """A ray reflected at the ridge of a roof goes up, and does not hit the other face first."""
    mirror = Material("mirror", reflect=1.0)
    faces = [((-1, 0, -5), (-1, 0, 5), (0, 1, 5), (0, 1, -5)), ((0, 1, -5), (0, 1, 5), (1, 0, 5), (1, 0, -5))]
    world = world_of(*(polygon(face, mirror) for face in faces))
    random = np.random.default_rng(4)
    for _ in range(500):
        target = np.array([0.0, 1.0, random.uniform(-4, 4)])
        origin = target + np.array([random.uniform(-3, 3), random.uniform(3.1, 6), random.uniform(-3, 3)])
        tree = tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=5)
        assert kinds(tree) == ["camera", "reflection"]
        assert tree.nodes["end"][1] == BACKGROUND


@pytest.mark.parametrize("size", [1e-60, 1e-6, 1.0, 1e8])
def test_triangles_of_any_size_are_hit(size: float) -> None:
    corners = ((0.0, 0.0, 0.0), (size, 0.0, 0.0), (0.0, size, 0.0))
    world = world_of(Object(Triangle(corners), OPEN))
    tree = tracer.trace(world, ray=((size / 4, size / 4, 1), (0, 0, -1)), depth=0)
    assert tree.nodes["t"][0] == 1.0


def test_needle_triangle_is_hit() -> None:
    world = world_of(Object(Triangle(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.5, 1e-12, 0.0))), OPEN))
    assert hits(world, (0.5, 1e-12 / 3, 1), (0, 0, -1))


def test_ray_in_the_plane_of_a_face_misses_it() -> None:
    world = world_of(Object(Polygon(LETTER_U), OPEN))
    assert not hits(world, (-3, 0.5, 0), (1, 0, 0))


def test_box_is_hit_along_its_faces_and_axes() -> None:
    """Directions with zeros, of either sign: 0 times infinity must not lose the hit."""
    world = world_of(box((0, -1, -1), (1, 1, 1), OPEN))
    for direction in ((0.0, 0.0, 1.0), (-0.0, 0.0, 1.0), (0.0, -0.0, 1.0)):
        for x in (0.0, 0.5, 1.0):
            tree = tracer.trace(world, ray=((x, 0, -5), direction), depth=0)
            assert tree.nodes["t"][0] == 4.0


def test_cube_of_triangles_is_met_once_a_side_along_its_diagonals() -> None:
    vertices = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    cube = Mesh(Geometry(vertices, np.array(faces)), "cube")
    assert cube.is_closed()
    assert cube.contains(np.array([0.5, 0.2, -0.9]))
    assert not cube.contains(np.array([1.5, 0.2, -0.9]))
    world = world_of(Object(cube, Material("clear", transmit=1.0, ior=1.5), "cube"))
    for k in range(-15, 16):
        tree = tracer.trace(world, ray=((k / 16, k / 16, -3), (0, 0, 1)), depth=5)
        assert kinds(tree) == ["camera", "refraction", "refraction"]
        assert tree.nodes["t"][:2].tolist() == [2.0, 2.0]
        assert (tree.nodes["n1"][0], tree.nodes["n1"][1]) == (1.0, 1.5)


def test_vertex_normals_serve_the_shading_and_the_face_the_side() -> None:
    vertices = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], float)
    normals = np.array([[-1, 1, 0], [-1, 1, 0], [1, 1, 0], [1, 1, 0]], float) / math.sqrt(2)
    sheet = Mesh(Geometry(vertices, np.array([[0, 1, 2], [0, 2, 3]]), normals), "sheet")
    world = world_of(Object(sheet, Material("mirror", reflect=1.0), "sheet"))
    middle = tracer.trace(world, ray=((0, 1, 0), (0, -1, 0)), depth=1)
    assert middle.nodes["normal"][0] == pytest.approx([0, 1, 0], abs=1e-15)
    aside = tracer.trace(world, ray=((0.5, 1, 0), (0, -1, 0)), depth=1)
    expected = np.array([0.5, 1.0, 0.0]) / math.hypot(0.5, 1.0)
    assert aside.nodes["normal"][0] == pytest.approx(expected, abs=1e-15)
    assert aside.nodes["direction"][1] == pytest.approx([0.8, 0.6, 0.0], abs=1e-15)


def test_interpolated_normal_never_sends_a_reflected_ray_through_the_face() -> None:
    vertices = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], float)
    normals = np.tile(np.array([0.9, math.sqrt(1 - 0.81), 0.0]), (4, 1))
    sheet = Mesh(Geometry(vertices, np.array([[0, 1, 2], [0, 2, 3]]), normals), "sheet")
    world = world_of(Object(sheet, Material("mirror", reflect=1.0), "sheet"))
    for angle in np.linspace(0.02, math.pi - 0.02, 50):
        d = (math.cos(angle), -math.sin(angle), 0.0)
        tree = tracer.trace(world, ray=((-d[0], -d[1], 0.0), d), depth=1)
        assert tree.nodes["direction"][1][1] > 0.0


def test_hit_lies_in_the_plane_however_far_the_ray_has_come() -> None:
    """The rounding of t, here of 2^40, moves a hit along the ray only. Its distance from the plane has the hit's own
    rounding.
    """
    n = np.array([2.0, 3.0, 6.0]) / 7.0
    slope = Object(Plane((0.25, 0.5, 1.0), (2.0, 3.0, 6.0)), MATTE, "slope")
    for k in range(20):
        towards = np.array([0.3 + 0.01 * k, 0.2, 1.0])
        towards /= np.linalg.norm(towards)
        start = 2.0**40 * towards + (0.1, 0.2, 0.3)
        tree = tracer.trace(world_of(slope), ray=(tuple(start), tuple(-towards)), depth=0)
        p = tree.nodes["point"][0]
        # Three products, their sums, and the rounding of the normal and of the point itself.
        assert abs(n @ (p - (0.25, 0.5, 1.0))) <= 12 * 2.0**-53 * (np.abs(p).sum() + 1.75)


@pytest.mark.parametrize("inward", [1e-17, 2.0**-53, 1e-14])
def test_ray_that_leaves_a_ball_outwards_does_not_meet_it_again(inward: float) -> None:
    """A grazing ray that leaves outwards does not hit the ball again, even if rounding turns its direction inwards."""
    world = world_of(ball()).arrays
    surface = world.surfaces[0]
    out = make_ray((1.0, 0.0, 0.0), (-inward, 1.0, -0.5 * inward), 0, 1.0, 1.0)
    assert sphere.next_hit(world, surface, out) == math.inf
    within = make_ray((1.0, 0.0, 0.0), (-inward, 1.0, -0.5 * inward), 0, -1.0, 1.0)
    assert sphere.next_hit(world, surface, within) == 2.0 * inward
    # A ray that goes inwards leaves the ball, at distance 0 if its direction is turned outwards.
    turned = make_ray((1.0, 0.0, 0.0), (inward, 1.0, 0.5 * inward), 0, -1.0, 1.0)
    assert sphere.next_hit(world, surface, turned) == 5e-324


def test_box_on_a_plane_meets_a_ray_where_the_plane_does() -> None:
    """Coinciding faces of different shapes are one interface, without speckles from rounding."""
    glass = Material("glass", transmit=1.0, ior=1.5)
    floor = Object(Plane((0.0, -0.6, 0.0), (0.0, 1.0, 0.0)), MATTE, "floor")
    world = world_of(floor, box((-2, -0.6, -2), (2, 1, 2), glass, "block"))
    random = np.random.default_rng(8)
    for _ in range(300):
        target = random.uniform(-1.5, 1.5, 3) * np.array([1, 0, 1]) - np.array([0.0, 0.6, 0.0])
        origin = tuple(random.uniform(-1, 1, 3) + np.array([0.0, 4.0, 0.0]))
        tree = tracer.trace(world, ray=(tuple(origin), tuple(target - origin)), depth=1)
        assert tree.object_name(0) == "block"
        assert tree.object_name(len(tree) - 1 if tree.kind(len(tree) - 1) == "refraction" else 1) == "floor"
