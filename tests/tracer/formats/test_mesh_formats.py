"""One geometry in all formats, files of another program, and files that are damaged at random."""

import base64
import json
import random
import struct
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest
import trimesh

import tracer
from tests.tracer.formats.test_meshes import CUBE_F, CUBE_V, glb, obj, ply, stl, write
from tracer.formats.meshes import load_mesh

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


def test_up_turns_a_mesh_whose_z_axis_points_upwards(tmp_path: Path) -> None:
    path = write(tmp_path / "tall.obj", "v 0 0 0\nv 1 0 0\nv 0 0 5\nf 1 2 3\n")
    lying, standing = (tracer.prepare(tracer.load(path, up=up)) for up in ("y", "z"))
    assert lying.bounds[0].tolist() == [[0, 0, 0], [1, 0, 5]]
    assert standing.bounds[0].tolist() == [[0, 0, 0], [1, 5, 0]]


def test_stl_statements_may_share_a_line(tmp_path: Path) -> None:
    text = str(trimesh.creation.box().export(file_type="stl_ascii"))
    named = text.replace("solid", "solid vertex 1 2 3", 1)
    for content in (text, " ".join(text.split()), named):
        found = load_mesh(write(tmp_path / "a.stl", content))
        assert [len(part.geometry.faces) for part in found.parts] == [12]


def test_attributes_of_binary_stl_are_noted(tmp_path: Path) -> None:
    solid = trimesh.creation.box()
    exported = solid.export(file_type="stl")
    assert isinstance(exported, bytes)
    data = bytearray(exported)
    data[84 + 48 : 84 + 50] = b"\x1f\x80"
    found = load_mesh(write(tmp_path / "a.stl", bytes(data)))
    assert found.notes == ["attributes of triangles, which may be colours, are not shown: 1"]


def test_nodes_outside_the_scene_are_noted(tmp_path: Path) -> None:
    path = write(tmp_path / "a.glb", glb(nodes=[{"mesh": 0}, {"mesh": 0}], scenes=[{"nodes": [1]}], scene=0))
    found = load_mesh(path)
    assert len(found.parts) == 1
    assert found.notes == ["nodes with a mesh that are not in the scene are not shown: 1"]


def test_data_uris_in_any_spelling(tmp_path: Path) -> None:
    """Base64 may be percent-encoded or use the alphabet for URLs, and the bytes may be percent-encoded themselves."""
    data = glb()
    length = struct.unpack_from("<I", data, 12)[0]
    document, buffer = json.loads(data[20 : 20 + length]), data[28 + length :]
    plain = base64.b64encode(buffer).decode()
    assert "+" in plain or "/" in plain
    for uri in (
        f"data:application/octet-stream;base64,{plain}",
        f"DATA:application/octet-stream;BASE64,{quote(plain, safe='')}",
        f"data:;base64,{plain.replace('+', '-').replace('/', '_')}",
        f"data:application/octet-stream,{quote(buffer)}",
    ):
        document["buffers"][0]["uri"] = uri
        (part,) = load_mesh(write(tmp_path / "a.gltf", json.dumps(document))).parts
        assert np.array_equal(
            part.geometry.vertices[part.geometry.faces], np.array(CUBE_V)[np.array(CUBE_F)] + [10, 0, 0]
        )
    document["buffers"][0]["uri"] = f"data:;base64,{plain[:8]}*{plain[9:]}"
    with pytest.raises(tracer.SceneError, match=r"buffers\[0\].uri must be base64"):
        tracer.load(write(tmp_path / "a.gltf", json.dumps(document)))


def test_a_light_without_intensity_is_no_reason_for_other_lights(tmp_path: Path) -> None:
    lights = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 0}]}}
    dark = {"extensions": {"KHR_lights_punctual": {"light": 0}}}
    path = write(tmp_path / "a.glb", glb(nodes=[{"mesh": 0, **dark}], extensions=lights))
    scene = tracer.load(path)
    assert scene.lights == ()
    assert scene.notes == ("a.glb: lights without intensity are left out: 1",)
    text = 'format = 1\n[[object]]\nshape = "mesh"\nfile = "a.glb"\n'
    assert tracer.load(write(tmp_path / "a.toml", text)).notes == ()


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


def test_numbers_that_a_ply_header_does_not_announce_are_not_passed_over(tmp_path: Path) -> None:
    lines = ply().splitlines()
    first = lines.index("end_header") + 1
    wide = [*lines[:first], *(f"{line} 1" for line in lines[first : first + 8]), *lines[first + 8 :]]
    with pytest.raises(tracer.SceneError, match="line 10: element vertex must have 3 numbers on its line, got 4"):
        tracer.load(write(tmp_path / "wide.ply", "\n".join(wide) + "\n"))
    with pytest.raises(
        tracer.SceneError, match="line 30: must end after the elements that its header announces, got more numbers"
    ):
        tracer.load(write(tmp_path / "more.ply", ply() + "3 0 1 2\n"))
