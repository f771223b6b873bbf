"""One geometry in all formats, files of another program, solids of shells, and files that are damaged at random."""

import json
import math
import random
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import tracer
from tests.tracer.formats.test_meshes import CUBE_F, CUBE_V, glb, obj, ply, stl, write
from tracer.formats.meshes import load_mesh
from tracer.shapes.mesh import Mesh

U = 2.0**-53
GLASS = '\n[[material]]\nname = "m"\ntransmit = 0.8\nreflect = 0.2\nior = 1.5\n'


def gltf() -> str:
    """The cube as JSON with its buffer in a file of its own, "cube.bin"."""
    data = glb()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    document["buffers"][0]["uri"] = "cube.bin"
    document["nodes"][0]["translation"] = [0, 0, 0]
    return json.dumps(document)


def test_one_geometry_in_all_formats_has_one_image(tmp_path: Path) -> None:
    """All corners are small whole numbers, so the image is the same bit for bit in float32 formats, too."""
    binary = np.array(CUBE_V, np.float32).tobytes() + np.array(CUBE_F, np.uint16).tobytes()
    write(tmp_path / "cube.bin", binary)
    files = {"cube.obj": obj(), "cube.ply": ply(), "cube.stl": stl(), "cube.gltf": gltf()}
    files["cube.glb"] = glb(nodes=[{"mesh": 0}])
    text = f"solid cube\n{facets()}endsolid cube\n"
    files["text.stl"] = text
    images = []
    for name, content in files.items():
        write(tmp_path / name, content)
        light = "[[light]]\nposition = [5, 9, 7]\n"
        scene = f'format = 1{GLASS}{light}[[object]]\nshape = "mesh"\nfile = "{name}"\nmaterial = "m"\n'
        path = write(tmp_path / f"{name}.toml", scene)
        world = tracer.prepare(tracer.load(path))
        assert world.notes == []
        images.append(tracer.render(world, (48, 36), depth=3).pixels)
    for image in images[1:]:
        np.testing.assert_array_equal(image, images[0])


def facets() -> str:
    lines = []
    for face in CUBE_F:
        corners = "".join(f"vertex {x} {y} {z}\n" for x, y, z in (CUBE_V[k] for k in face))
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    return "".join(lines)


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "glb"])
def test_files_of_another_program_are_read_as_it_reads_them(suffix: str, tmp_path: Path) -> None:
    """trimesh writes and reads the file; we agree on the number of faces, bounds and area."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=2.0)
    ring = trimesh.creation.torus(3.0, 0.5)
    ring.apply_translation([0.0, 0.0, 4.0])
    path = tmp_path / f"two.{suffix}"
    if suffix == "glb":
        trimesh.Scene({"ball": ball, "ring": ring}).export(path)
    else:
        trimesh.util.concatenate([ball, ring]).export(path)
    theirs: Any = trimesh.load(path, force="mesh", process=False)
    parts = load_mesh(path).parts
    corners = np.concatenate([part.geometry.vertices[part.geometry.faces] for part in parts])
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert len(corners) == len(theirs.faces)
    np.testing.assert_array_equal([corners.min(axis=(0, 1)), corners.max(axis=(0, 1))], theirs.bounds)
    area = float(np.sqrt((across * across).sum(axis=1)).sum() / 2.0)
    assert area == pytest.approx(theirs.area, rel=len(corners) * 4 * U, abs=0.0)
    if suffix == "glb":
        assert sorted(part.name for part in parts) == ["ball", "ring"]


def cube(low: float, high: float, flipped: bool = False) -> list[tuple[np.ndarray, ...]]:
    """The faces of a cube from `low` to `high` on all axes, as corner triples."""
    points = low + (high - low) * np.array(CUBE_V, float)
    return [tuple(points[k] for k in (face[::-1] if flipped else face)) for face in CUBE_F]


def write_obj(path: Path, *groups: tuple[str, list[tuple[np.ndarray, ...]]]) -> Path:
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


def indices(world: tracer.World) -> list[tuple[float, float]]:
    """The indices before and behind each hit of a ray that goes straight through the middle, and is only refracted."""
    tree = tracer.trace(world, ray=((0.5, 0.4, 9.0), (0.0, 0.0, -1.0)), depth=8)
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


def test_up_turns_a_mesh_whose_z_axis_points_upwards(tmp_path: Path) -> None:
    path = write(tmp_path / "tall.obj", "v 0 0 0\nv 1 0 0\nv 0 0 5\nf 1 2 3\n")
    lying, standing = (tracer.prepare(tracer.load(path, up=up)) for up in ("y", "z"))
    assert lying.bounds[0].tolist() == [[0, 0, 0], [1, 0, 5]]
    assert standing.bounds[0].tolist() == [[0, 0, 0], [1, 5, 0]]


def mutated(data: bytes, dice: random.Random) -> bytes:
    """The bytes with a few random changes."""
    result = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 4))):
        if not result:
            break
        k = dice.randrange(len(result))
        match dice.randrange(4):
            case 0:
                result[k] = dice.randrange(256)
            case 1:
                del result[k : k + dice.randrange(1, 20)]
            case 2:
                result[k:k] = dice.choice((b"-1", b"nan", b"1e999", b"[", b"{", b'"', b"\\", b"#", b"\0", b"\n", b"//"))
            case _:
                j = dice.randrange(len(result))
                result[k:k] = result[j : j + dice.randrange(1, 40)]
    return bytes(result)


@pytest.mark.parametrize("name", ["a.obj", "a.ply", "a.stl", "a.glb", "a.gltf", "a.nff", "a.toml"])
def test_damaged_files_are_scenes_or_one_line_for_each_fault(name: str, tmp_path: Path) -> None:
    seeds = {
        "a.obj": obj("mtllib a.mtl\nusemtl a\no b\ng c d").encode(), "a.ply": ply().encode(), "a.stl": stl(),
        "a.glb": glb(), "a.gltf": gltf().encode(), "a.nff": b"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\n"
        b"resolution 9 9\nf 1 1 1 .5 .5 9 .5 1.5\ns 0 0 0 1\ns 0 0 0 -.5\np 4 0 0 0 1 0 0 1 1 0 0 1 0\n",
        "a.toml": b'format = 1\n[[material]]\nname = "m"\nior = 1.5\n[[object]]\nshape = "box"\nmaterial = "m"\n'
        b"min = [0, 0, 0]\nmax = [1, 1, 1]\n",
    }  # fmt: skip
    write(tmp_path / "a.mtl", "newmtl a\nKd 0.5 0.2 0.1\nNi 1.5\nd 0.5\nillum 7\n")
    dice = random.Random(name)
    loaded = 0
    for _ in range(150):
        path = write(tmp_path / name, mutated(seeds[name], dice))
        try:
            tracer.prepare(tracer.load(path))
            loaded += 1
        except tracer.SceneError as error:
            assert error.faults
            assert all("\n" not in fault and fault.encode() for fault in error.faults)
    assert loaded < 150


MATERIALS = "newmtl glass\nd 0\nNi 1.5\nnewmtl water\nd 0\nNi 1.33\nnewmtl wall\nKd 1\n"


def write_filled(path: Path, *groups: tuple[str, list[tuple[np.ndarray, ...]]]) -> Path:
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


def test_numbers_that_a_ply_header_does_not_announce_are_not_passed_over(tmp_path: Path) -> None:
    lines = ply().splitlines()
    first = lines.index("end_header") + 1
    wide = [*lines[:first], *(f"{line} 1" for line in lines[first : first + 8]), *lines[first + 8 :]]
    with pytest.raises(tracer.SceneError, match=r"after its header, as it says, got 80|must be whole numbers"):
        tracer.load(write(tmp_path / "wide.ply", "\n".join(wide) + "\n"))
    with pytest.raises(tracer.SceneError, match="must have 72 numbers after its header, as it says, got 76"):
        tracer.load(write(tmp_path / "more.ply", ply() + "3 0 1 2\n"))


def test_glass_with_every_face_for_both_sides_is_glass(tmp_path: Path) -> None:
    both = [face for pair in zip(cube(0.0, 1.0), cube(0.0, 1.0, flipped=True), strict=True) for face in pair]
    world = glass_world(write_obj(tmp_path / "double.obj", ("it", both)))
    assert indices(world) == [(1.0, 1.5), (1.5, 1.0)]
    assert world.solids[0].closed
