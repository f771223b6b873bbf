"""Transparent solids of mesh files: shells, cavities, and what is turned, noted or refused."""

import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.tracer.formats.test_meshes import CUBE_F, CUBE_V, obj, write
from tracer.shapes.mesh import Mesh

U = 2.0**-53
GLASS = '\n[[material]]\nname = "m"\ntransmit = 0.8\nreflect = 0.2\nior = 1.5\n'


Faces = list[tuple[np.ndarray, ...]]


def cube(low: float, high: float, flipped: bool = False) -> Faces:
    """The faces of a cube from `low` to `high` on all axes, as corner triples."""
    points = low + (high - low) * np.array(CUBE_V, float)
    return [tuple(points[k] for k in (face[::-1] if flipped else face)) for face in CUBE_F]


def moved(faces: Faces, x: float) -> Faces:
    """The faces, moved along the x axis."""
    return [tuple(corner + np.array([x, 0.0, 0.0]) for corner in face) for face in faces]


def write_obj(path: Path, *groups: tuple[str, Faces]) -> Path:
    """An OBJ file with one group for each (name, faces). All corners are written anew for each face."""
    lines = []
    for name, faces in groups:
        lines.append(f"g {name}")
        for face in faces:
            lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in (corner.tolist() for corner in face)]
            lines.append("f -3 -2 -1")
    return write(path, "\n".join(lines) + "\n")


def glass_world(path: Path) -> tracer.World:
    scene = f'format = 1{GLASS}[[object]]\nshape = "mesh"\nfile = "{path.name}"\nmaterial = "m"\n'
    return tracer.prepare(tracer.load(write(path.with_suffix(".toml"), scene)))


def indices(world: tracer.World, size: float = 1.0) -> list[tuple[float, float]]:
    """The indices before and behind each hit of a ray that goes straight through the middle, and is only refracted."""
    tree = tracer.trace(world, ray=((0.5 * size, 0.4 * size, 9.0 * size), (0.0, 0.0, -1.0)), depth=8)
    row, found = 0, []
    while math.isfinite(tree.nodes["n2"][row]):
        found.append((float(tree.nodes["n1"][row]), float(tree.nodes["n2"][row])))
        on = [child for child in tree.children[row] if tree.kind(child) == "refraction"]
        row = int(on[0])
    return found


def test_a_solid_does_not_depend_on_the_names_of_its_faces(tmp_path: Path) -> None:
    faces = cube(0.0, 1.0)
    world = glass_world(write_obj(tmp_path / "named.obj", ("one", faces[:5]), ("two", faces[5:])))
    assert len(world.scene.objects) == 2
    assert len(world.solids) == 1
    assert world.solids[0].closed
    assert world.notes == []
    assert indices(world) == [(1.0, 1.5), (1.5, 1.0)]


def test_an_inverted_shell_inside_another_is_its_cavity_across_names(tmp_path: Path) -> None:
    groups = ("outer", cube(-1.0, 2.0)), ("inner", cube(0.0, 1.0, flipped=True))
    world = glass_world(write_obj(tmp_path / "hollow.obj", *groups))
    assert len(world.solids) == 1
    assert world.notes == []
    assert indices(world) == [(1.0, 1.5), (1.5, 1.0), (1.0, 1.5), (1.5, 1.0)]


def test_an_inverted_shell_inside_no_other_is_turned(tmp_path: Path) -> None:
    world = glass_world(write_obj(tmp_path / "inverted.obj", ("it", cube(0.0, 1.0, flipped=True))))
    assert indices(world) == [(1.0, 1.5), (1.5, 1.0)]
    assert world.notes == ['"it": wound inside out in the file, and turned']
    shape = world.scene.objects[0].shape
    assert isinstance(shape, Mesh)
    a, b, c = np.moveaxis(shape.placed(), 1, 0)
    assert (a * np.cross(b, c)).sum() / 6.0 == pytest.approx(1.0, abs=8 * U)


def test_faces_without_area_do_not_open_a_solid(tmp_path: Path) -> None:
    """A corner in the middle of an edge of one face: a triangle without area closes the mesh."""
    faces = cube(0.0, 1.0)
    a, b, c = faces[0]
    middle = 0.5 * (a + b)
    split = [(a, middle, c), (middle, b, c), *faces[1:], (a, b, middle)]
    world = glass_world(write_obj(tmp_path / "sliver.obj", ("it", split)))
    assert world.solids[0].closed
    assert world.notes == ["sliver.obj: faces without area are left out: 1"]


def test_two_cubes_that_share_an_edge_are_two_solids(tmp_path: Path) -> None:
    other = [tuple(corner + np.array([1.0, 1.0, 0.0]) for corner in face) for face in cube(0.0, 1.0)]
    world = glass_world(write_obj(tmp_path / "edge.obj", ("one", cube(0.0, 1.0)), ("two", other)))
    assert [solid.closed for solid in world.solids] == [True, True]


def test_a_solid_has_one_index_of_refraction(tmp_path: Path) -> None:
    write(tmp_path / "two.mtl", "newmtl a\nd 0.1\nNi 1.5\nnewmtl b\nd 0.1\nNi 1.33\n")
    text = obj("mtllib two.mtl\nusemtl a").splitlines()
    path = write(tmp_path / "two.obj", "\n".join([*text[:-3], "usemtl b", *text[-3:]]) + "\n")
    with pytest.raises(tracer.SceneError, match=r'object\[0\] "a" and object\[1\] "b" bound one solid'):
        tracer.prepare(tracer.load(path))


MATERIALS = "newmtl glass\nd 0\nNi 1.5\nnewmtl water\nd 0\nNi 1.33\nnewmtl wall\nKd 1\n"


def write_filled(path: Path, *groups: tuple[str, Faces]) -> Path:
    """An OBJ file with one group for each (material, faces)."""
    write(path.with_suffix(".mtl"), MATERIALS)
    write_obj(path, *groups)
    text = path.read_text()
    for name, _ in groups:
        text = text.replace(f"g {name}\n", f"o {name} part\nusemtl {name}\n")
    return write(path, f"mtllib {path.with_suffix('.mtl').name}\n{text}")


def test_water_that_overlaps_the_wall_of_its_glass_leaves_the_wall_hollow(tmp_path: Path) -> None:
    """The usual way to model a filled glass: the cavity belongs to the glass, though it lies inside the water, too."""
    groups = ("glass", cube(-1.0, 2.0) + cube(-0.5, 1.5, flipped=True)), ("water", cube(-0.75, 1.75))
    world = tracer.prepare(tracer.load(write_filled(tmp_path / "filled.obj", *groups)))
    assert indices(world) == [(1.0, 1.5), (1.5, 1.33), (1.33, 1.5), (1.5, 1.0)]


def test_two_solids_may_touch_at_a_whole_face(tmp_path: Path) -> None:
    above = [tuple(corner + np.array([0.0, 0.0, 1.0]) for corner in face) for face in cube(0.0, 1.0)]
    path = write_filled(tmp_path / "touch.obj", ("glass", cube(0.0, 1.0)), ("water", above))
    assert indices(tracer.prepare(tracer.load(path))) == [(1.0, 1.33), (1.33, 1.5), (1.5, 1.0)]


def test_inverted_glass_in_an_opaque_room_is_turned(tmp_path: Path) -> None:
    path = write_filled(tmp_path / "room.obj", ("wall", cube(-10.0, 10.0)), ("glass", cube(0.0, 1.0, flipped=True)))
    world = tracer.prepare(tracer.load(path))
    assert indices(world)[:2] == [(1.0, 1.5), (1.5, 1.0)]
    assert any("wound inside out" in note for note in world.notes)


def test_glass_with_every_face_for_both_sides_is_glass(tmp_path: Path) -> None:
    both = [face for pair in zip(cube(0.0, 1.0), cube(0.0, 1.0, flipped=True), strict=True) for face in pair]
    world = glass_world(write_obj(tmp_path / "double.obj", ("it", both)))
    assert indices(world) == [(1.0, 1.5), (1.5, 1.0)]
    assert world.solids[0].closed


CAVITIES = [
    (cube(0.0, 1.0, flipped=True), cube(0.5, 1.5, flipped=True), "cavities of a solid must not overlap"),
    (cube(0.0, 1.0, flipped=True), cube(0.25, 0.75, flipped=True), "cavities of a solid must not overlap"),
    # They share planes, so that no edge of one goes through a face of the other.
    (cube(0.0, 1.0, flipped=True), moved(cube(0.0, 1.0, flipped=True), 0.5), "cavities of a solid must not overlap"),
    (moved(cube(0.0, 1.0, flipped=True), 1.5), [], None),  # wound inside out and partly outside: turned
    (cube(0.0, 1.0, flipped=True), moved(cube(0.0, 1.0, flipped=True), 1.0), None),  # they touch
    (cube(0.0, 1.0, flipped=True), cube(0.25, 0.75), None),  # a solid in the cavity
]


@pytest.mark.parametrize(("first", "second", "said"), CAVITIES)
def test_cavities_of_a_solid_do_not_overlap(first: Faces, second: Faces, said: str | None, tmp_path: Path) -> None:
    path = write_obj(tmp_path / "two.obj", ("it", cube(-1.0, 2.0)), ("first", first), ("second", second))
    if said is None:
        assert all(solid.closed for solid in glass_world(path).solids)
        return
    with pytest.raises(tracer.SceneError, match=f'two.obj: object.1. "first" and object.2. "second": the {said}'):
        glass_world(path)


def test_a_cavity_does_not_reach_out_of_a_hollow_of_its_solid(tmp_path: Path) -> None:
    """A solid like an L: the cavity lies in its box, but reaches out of its inner corner."""
    points = [(-1, -1), (2, -1), (2, 0.4), (0.4, 0.4), (0.4, 2), (-1, 2)]
    low, high = ([np.array([x, y, z], float) for x, y in points] for z in (-1.0, 2.0))
    caps = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    sides = [((a, low), (b, low), (b, high), (a, high)) for a, b in zip(range(6), [1, 2, 3, 4, 5, 0], strict=True)]
    faces = [tuple(high[k] for k in cap) for cap in caps] + [tuple(low[k] for k in cap[::-1]) for cap in caps]
    for side in sides:
        a, b, c, d = (where[k] for k, where in side)
        faces += [(a, b, c), (a, c, d)]
    path = write_obj(tmp_path / "l.obj", ("it", faces), ("hole", cube(0.0, 1.0, flipped=True)))
    with pytest.raises(tracer.SceneError, match=r'"hole" and object\[0\] "it": a cavity must lie inside its solid'):
        glass_world(path)
    inside = write_obj(tmp_path / "inside.obj", ("it", faces), ("hole", cube(-0.5, 0.3, flipped=True)))
    assert glass_world(inside).notes == []


def test_one_face_of_the_other_winding_is_named_as_the_cause(tmp_path: Path) -> None:
    a, b, c = cube(0.0, 1.0)[0]
    world = glass_world(write_obj(tmp_path / "it.obj", ("it", [(a, c, b), *cube(0.0, 1.0)[1:]])))
    assert [note.partition(":")[0] for note in world.notes] == [
        '"it" is open, since some faces are wound against their neighbours'
    ]
    holed = glass_world(write_obj(tmp_path / "it.obj", ("it", cube(0.0, 1.0)[1:])))
    assert [note.partition(":")[0] for note in holed.notes] == ['"it" is open']


@pytest.mark.parametrize("power", [-400, -340, 340, 480])
def test_solids_do_not_depend_on_the_unit_of_length(power: int, tmp_path: Path) -> None:
    size = 2.0**power
    groups = ("outer", cube(-size, 2.0 * size)), ("inner", cube(0.0, size, flipped=True))
    world = glass_world(write_obj(tmp_path / "hollow.obj", *groups))
    assert world.notes == []
    assert indices(world, size) == [(1.0, 1.5), (1.5, 1.0), (1.0, 1.5), (1.5, 1.0)]
