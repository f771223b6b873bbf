"""Generated scenes: the stated number of objects, at places known in closed form, and the same for POV-Ray."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import tracer
from benchmarks.scenes import SCENES
from benchmarks.scenes.lattice import lattice
from benchmarks.scenes.mountain import RADIUS, mountain
from benchmarks.scenes.patches import RADIUS as CIRCLE, TUBE, patches
from benchmarks.scenes.rings import JOINTS, WIRE, rings
from benchmarks.scenes.sphereflake import NINE, frame_along, sphereflake
from benchmarks.scenes.stone import SMALL, coherent_rays, scattered_rays, stone, stone_world
from tests import povray
from tracer.scene import Scene
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Mesh
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere

DIGITS = 1e-11  # twelve digits are written
SIZE = (96, 96)
SAME = 1.5 / 65535  # half a step of POV-Ray's 16 bits, and as much for its single-precision colours
EDGES = 1 / 500  # share of pixels at an edge within rounding; in such small images a few are many


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], Scene]:
    def load(text: str) -> Scene:
        path = tmp_path / "made.nff"
        path.write_text(text)
        return tracer.load(path)

    return load


def shapes(scene: Scene, kind: type) -> list:
    return [item.shape for item in scene.objects if isinstance(item.shape, kind)]


def test_sphereflake_balls_touch_the_ball_they_grow_on_and_no_sibling(read) -> None:
    scene = read(sphereflake(3))
    balls = shapes(scene, Sphere)
    assert len(scene.objects) == 1 + len(balls) == 1 + (9**4 - 1) // 8
    parents: list[Sphere] = []
    for parent, ball in pairwise(balls):  # in depth-first order: a ball, then all that grows on it
        if ball.radius < 0.9 * parent.radius:
            parents.append(parent)
        while parents[-1].radius < 2.9 * ball.radius:
            parents.pop()
        apart = np.linalg.norm(np.subtract(ball.center, parents[-1].center))
        assert apart == pytest.approx(ball.radius + parents[-1].radius, abs=4 * DIGITS)
    apart = np.linalg.norm(NINE[:, None] - NINE, axis=2)[~np.eye(9, dtype=bool)]
    assert 4 / 3 * apart.min() > 2 / 3  # of the parent's radius: the centres are farther apart than two radii


def test_frames_are_square() -> None:
    for axis in NINE:
        frame = frame_along(axis)
        assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-15)
        assert frame[2] == pytest.approx(axis)
        assert np.linalg.det(frame) == pytest.approx(1.0)


def test_mountain_is_one_closed_sheet_below_four_balls_that_do_not_meet(read) -> None:
    scene = read(mountain(16))
    (mesh,) = shapes(scene, Mesh)
    corners = mesh.placed()
    assert len(corners) == 2 * 16**2
    ups = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (ups[:, 2] == pytest.approx((2 / 16) ** 2)) and np.ptp(corners[..., 2]) > 0.3
    assert np.abs(corners[..., :2]).max() == 1.0
    assert 0.5 * ups[:, 2].sum() == pytest.approx(4.0)  # the whole square, nothing twice
    centers = np.array([ball.center for ball in shapes(scene, Sphere)])
    assert all(ball.radius == RADIUS for ball in shapes(scene, Sphere))
    apart = np.linalg.norm(centers[:, None] - centers, axis=2)[~np.eye(4, dtype=bool)]
    assert apart == pytest.approx(apart[0]) and apart[0] > 2 * RADIUS
    assert np.linalg.norm(corners.reshape(-1, 1, 3) - centers, axis=2).min() > RADIUS


def test_mountain_is_the_same_every_time() -> None:
    assert mountain(8) == mountain(8) != mountain(8, seed=2)


def test_rings_are_closed_and_hold_their_neighbours(read) -> None:
    scene = read(rings(3))
    rods = shapes(scene, Cone)
    assert len(rods) == len(shapes(scene, Sphere)) == 9 * JOINTS
    assert len(scene.objects) == 18 * JOINTS + 1
    for k in range(0, len(rods), JOINTS):
        ring = rods[k : k + JOINTS]
        assert [rod.apex for rod in ring] == [*(rod.base for rod in ring[1:]), ring[0].base]
        places = np.array([rod.base for rod in ring])
        assert np.linalg.norm(places - places.mean(axis=0), axis=1) == pytest.approx(1.0, rel=DIGITS)
    shares = np.linspace(0.0, 1.0, 9)[:, None]
    along = np.array([(1.0 - shares) * rod.base + shares * rod.apex for rod in rods]).reshape(9, -1, 3)
    for k, one in enumerate(along):  # rings are linked and do not intersect
        others = np.delete(along, k, axis=0)
        assert np.linalg.norm(one[:, None] - others.reshape(-1, 3), axis=2).min() > 2.5 * WIRE
        assert np.linalg.norm(one.mean(axis=0) - others.mean(axis=1), axis=1).min() < 2.0


def test_lattice_joins_every_ball_to_its_neighbours(read) -> None:
    scene = read(lattice(4))
    balls, rods = shapes(scene, Sphere), shapes(scene, Cone)
    assert (len(balls), len(rods)) == (4**3, 3 * 4**2 * 3)
    places = {ball.center for ball in balls}
    assert len(places) == len(balls) and len(set(rods)) == len(rods)
    for rod in rods:
        assert {rod.base, rod.apex} <= places
        assert np.linalg.norm(np.subtract(rod.apex, rod.base)) == 1.0


def test_patches_lie_on_two_tori_with_the_true_normals(read) -> None:
    scene = read(patches(12, 8))
    assert len(shapes(scene, Polygon)) == 36
    for mesh, center, axis in zip(shapes(scene, Mesh), ((-0.75, 0, 0), (0.75, 0, 0)), (2, 1), strict=True):
        corners, normals = mesh.placed().reshape(-1, 3), mesh.smooth().reshape(-1, 3)
        assert len(corners) == 3 * 2 * 12 * 8
        away = corners - center
        flat = away.copy()
        flat[:, axis] = 0.0
        from_circle = away - CIRCLE * flat / np.linalg.norm(flat, axis=1)[:, None]
        assert from_circle == pytest.approx(TUBE * normals, abs=4 * DIGITS)
        faces = mesh.placed()
        turned = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
        assert (np.einsum("ij,ikj->ik", turned, mesh.smooth()) > 0.0).all()  # counter-clockwise seen from outside


def test_stone_is_closed_and_its_rays_are_of_length_one() -> None:
    mesh = Mesh(stone(SMALL))
    assert len(mesh.geometry.faces) == 5120
    assert mesh.is_closed() and mesh.contains(np.zeros(3))
    assert np.array_equal(mesh.geometry.vertices, mesh.geometry.vertices.astype(np.float32))
    for origins, directions in (coherent_rays(32), scattered_rays(1000)):
        assert origins.dtype == directions.dtype == np.float32
        assert np.linalg.norm(directions, axis=1) == pytest.approx(1.0, rel=1e-6)


def test_search_of_many_rays_meets_what_a_tree_of_one_meets(monkeypatch: pytest.MonkeyPatch) -> None:
    from benchmarks import closest

    monkeypatch.setattr(closest, "search_all", closest.search_all.py_func)  # without waiting for the compiler
    world = stone_world(2)
    origins, directions = (part.astype(float) for part in scattered_rays(200))
    met = closest.Searcher(world).hits((origins, directions))
    for origin, direction, surface in zip(origins, directions, met, strict=True):
        tree = tracer.trace(world, ray=(tuple(origin), tuple(direction)), depth=0)
        assert (surface >= 0) == (tree.object_name(0) is not None)


SMALLER: dict[str, Callable[[], str]] = {
    "sphereflake": lambda: sphereflake(2),
    "mountain": lambda: mountain(16),
    "rings": lambda: rings(3),
    "lattice": lambda: lattice(3),
}


@pytest.mark.parametrize("name", SMALLER)
def test_povray_is_told_the_same_scene(name: str, read, tmp_path: Path) -> None:
    assert povray.available(), "this test needs POV-Ray: the Debian package povray"
    scene = read(SMALLER[name]())
    theirs, _, counts = povray.render(povray.write_scene(scene, 3, SIZE), SIZE, tmp_path)
    ours = tracer.render(tracer.prepare(scene), SIZE, depth=3, model="whitted")
    differs = np.abs(np.clip(ours.pixels, 0.0, 1.0) - theirs).max(axis=2) > SAME
    assert differs.mean() <= EDGES
    assert counts["tir"] == ours.rays["tir"] == 0


def test_povray_is_told_smooth_patches(read, tmp_path: Path) -> None:
    """Camera rays only: at a mirror's rim, programs differ in what they take for the inside."""
    scene = read(patches(24, 16))
    theirs, _, _ = povray.render(povray.write_scene(scene, 0, SIZE), SIZE, tmp_path)
    ours = np.clip(tracer.render(tracer.prepare(scene), SIZE, depth=0, model="whitted").pixels, 0.0, 1.0)
    assert (np.abs(ours - theirs).max(axis=2) > SAME).mean() < 0.02


def test_a_texture_is_written_once(read) -> None:
    source = povray.write_scene(read(lattice(3)), 3, SIZE)
    assert source.count("#declare") == source.count("pigment") == 2


def test_every_kind_is_listed() -> None:
    assert list(SCENES) == ["sphereflake", "mountain", "rings", "lattice", "patches"]
