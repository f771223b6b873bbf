"""Mesh files: the scenes that good files give, and one line for every fault."""

import json
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.scenes import world_of
from tracer.scene import Light, Material, Object
from tracer.shapes.mesh import Geometry, Mesh

CUBE_V = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
CUBE_F = [
    face
    for a, b, c, d in [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    for face in ((a, b, c), (a, c, d))
]


def obj(extra: str = "", faces: list = CUBE_F) -> str:
    lines = [f"v {x} {y} {z}" for x, y, z in CUBE_V] + [extra] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def write(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def ply(vertices: int = 8) -> str:
    head = f"ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
    body = "".join(f"{x} {y} {z}\n" for x, y, z in CUBE_V) + "".join(f"3 {a} {b} {c}\n" for a, b, c in CUBE_F)
    return head + body


def stl() -> bytes:
    body = b""
    for a, b, c in CUBE_F:
        body += struct.pack("<12fH", 0, 0, 0, *CUBE_V[a], *CUBE_V[b], *CUBE_V[c], 0)
    return b"made".ljust(80) + struct.pack("<I", len(CUBE_F)) + body


def glb(material: dict | None = None, **changes: object) -> bytes:
    vertices = np.array(CUBE_V, np.float32).tobytes()
    faces = np.array(CUBE_F, np.uint16).tobytes()
    document: dict = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [10, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [material or {"name": "plain"}],
        "buffers": [{"byteLength": len(vertices) + len(faces)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(vertices)},
            {"buffer": 0, "byteOffset": len(vertices), "byteLength": len(faces)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
    }
    document.update(changes)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = vertices + faces
    parts = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(parts)) + parts


@pytest.mark.parametrize(
    ("name", "content", "shift"),
    [("cube.obj", obj(), 0), ("cube.ply", ply(), 0), ("cube.stl", stl(), 0), ("cube.glb", glb(), 10)],
)
def test_cube_in_every_format(tmp_path: Path, name: str, content: str | bytes, shift: float) -> None:
    scene = tracer.load(write(tmp_path / name, content))
    world = tracer.prepare(scene)
    shape = scene.objects[0].shape
    assert isinstance(shape, Mesh)
    assert shape.is_closed()
    assert shape.contains(np.array([shift + 0.5, 0.5, 0.25]))
    tree = tracer.trace(world, ray=((shift + 0.25, 0.5, 5), (0, 0, -1)), depth=0)
    assert tree.nodes["t"][0] == 4.0
    assert tree.nodes["normal"][0].tolist() == [0.0, 0.0, 1.0]
    # A mesh file has no camera: the default one shows the whole mesh, lit.
    image = tracer.render(world, (64, 48))
    assert image.rays["shadow"] > 300


def test_obj_materials(tmp_path: Path) -> None:
    """Two materials become two objects: glass by dissolve and index, a mirror by its illumination model."""
    write(
        tmp_path / "two.mtl",
        "newmtl glass\nKd 0.2 0.4 0.6\nKs 0.5 0.5 0.5\nNs 90\nNi 1.5\nd 0.1\nillum 7\n"
        "newmtl chrome\nKd 0.8 0.1 0.1\nKs 0.7 0.7 0.7\nNs 50\nillum 3\n",
    )
    lines = obj("mtllib two.mtl\nusemtl glass").splitlines()
    text = "\n".join([*lines[:-4], "usemtl chrome", *lines[-4:]]) + "\n"
    scene = tracer.load(write(tmp_path / "two.obj", text))
    materials = {item.name: item.material for item in scene.objects}
    assert set(materials) == {"glass", "chrome"}
    glass, chrome = materials["glass"], materials["chrome"]
    assert glass.transmit == pytest.approx(0.9, rel=2.0**-52, abs=0.0)
    assert (glass.ior, glass.shininess, glass.specular) == (1.5, 90.0, 0.5)
    assert glass.color == (0.2, 0.4, 0.6)
    assert (chrome.reflect, chrome.transmit) == (pytest.approx(0.7, rel=2.0**-52, abs=0.0), 0.0)


def test_material_of_the_scene_file_comes_before_that_of_the_mesh(tmp_path: Path) -> None:
    write(tmp_path / "two.mtl", "newmtl red\nKd 1 0 0\n")
    write(tmp_path / "two.obj", obj("mtllib two.mtl\nusemtl red"))
    text = 'format = 1\n[[material]]\nname = "blue"\ncolor = [0, 0, 1]\n'
    text += '[[object]]\nname = "cube"\nshape = "mesh"\nfile = "two.obj"\n'
    own = tracer.load(write(tmp_path / "own.toml", text))
    given = tracer.load(write(tmp_path / "given.toml", text + 'material = "blue"\n'))
    assert own.objects[0].material.color == (1.0, 0.0, 0.0)
    assert given.objects[0].material.color == (0.0, 0.0, 1.0)
    assert own.objects[0].name == "cube"


def test_glb_glass_survives(tmp_path: Path) -> None:
    """Transmission and index stand in extensions that the mesh library does not read."""
    material = {
        "name": "window",
        "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 1.0], "metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.95}, "KHR_materials_ior": {"ior": 1.7}},
    }
    scene = tracer.load(write(tmp_path / "window.glb", glb(material)))
    found = scene.objects[0].material
    assert (found.transmit, found.ior) == (0.95, 1.7)
    assert found.color == pytest.approx((0.9, 0.8, 0.7), abs=0.003)


def test_placement_scales_then_turns_then_moves() -> None:
    point = Geometry(np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]), np.array([[0, 1, 2]]))
    mesh = Mesh(point, "made", scale=2.0, rotate=(90.0, 0.0, 90.0), translate=(10.0, 0.0, 0.0))
    # x stays in the first rotation and becomes y in the second; y becomes z and stays; z becomes -y and then x.
    expected = [[10.0, 2.0, 0.0], [10.0, 0.0, 2.0], [12.0, 0.0, 0.0]]
    assert mesh.placed()[0].tolist() == expected


def test_vertex_normals_are_kept(tmp_path: Path) -> None:
    normals = "vn 0 0 1\nvn 0.6 0 0.8\nvn 0 0.6 0.8\n"
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + normals + "f 1//1 2//2 3//3\n"
    smooth = tracer.load(write(tmp_path / "smooth.obj", text)).objects[0].shape
    flat = tracer.load(write(tmp_path / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).objects[0].shape
    assert isinstance(smooth, Mesh)
    assert isinstance(flat, Mesh)
    assert flat.geometry.normals is None
    found = smooth.smooth()
    assert found is not None
    assert found[0] == pytest.approx(np.array([[0, 0, 1], [0.6, 0, 0.8], [0, 0.6, 0.8]]), rel=2.0**-52, abs=0.0)


def test_no_light_comes_through_a_face_that_its_vertex_normals_turn_towards_it() -> None:
    """Normal (0.8, 0.6, 0) on a horizontal face: a light far right and low is before the normal and behind the face."""
    tilted = np.tile([0.8, 0.6, 0.0], (3, 1))
    corners = np.array([[-3.0, 0, 3], [3, 0, 3], [0, 0, -3]])
    mesh = Mesh(Geometry(corners, np.array([[0, 1, 2]]), tilted), "leaf")
    low = Light("low", position=(10.0, -1.0, 0.0))
    world = world_of(Object(mesh, Material("m", diffuse=1.0), "leaf"), lights=[low])
    tree = tracer.trace(world, ray=((0.8, 0.6, 0), (-0.8, -0.6, 0)), depth=0)
    assert tree.nodes["normal"][0] == pytest.approx([0.8, 0.6, 0.0], rel=4 * 2.0**-53, abs=0.0)
    assert tree.nodes["normal"][0] @ tree.nodes["direction"][1] > 0.5
    assert (tree.end(1), tree.nodes["t"][1], tree.object_name(1)) == ("blocked", 0.0, "leaf")
    assert not tree.radiance.any()


def test_vertex_normals_that_point_backwards_are_left_alone() -> None:
    """The geometry decides where the front of a face is: it is lit from there, with the geometric normal."""
    corners = np.array([[-3.0, 0, 3], [3, 0, 3], [0, 0, -3]])
    mesh = Mesh(Geometry(corners, np.array([[0, 1, 2]]), np.tile([0.6, -0.8, 0.0], (3, 1))), "leaf")
    lamp = Light("lamp", position=(0.0, 5.0, 0.0))
    world = world_of(Object(mesh, Material("m", diffuse=1.0), "leaf"), lights=[lamp])
    tree = tracer.trace(world, ray=((0, 4, 0), (0, -1, 0)), depth=0)
    assert tree.nodes["normal"][0].tolist() == [0.0, 1.0, 0.0]
    assert tree.radiance.tolist() == [1.0, 1.0, 1.0]


def test_a_hundred_thousand_triangles_are_no_trouble() -> None:
    n = 230
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    z = 0.1 * np.sin(7 * x) * np.cos(5 * y)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])
    assert len(faces) > 100_000
    world = world_of(Object(Mesh(Geometry(vertices, faces), "hills"), Material("m", ambient=1.0), "hills"))
    image = tracer.render(world, (160, 120))
    rows, columns = np.nonzero(image.pixels[:, :, 0])
    inside = np.s_[rows.min() + 2 : rows.max() - 1, columns.min() + 2 : columns.max() - 1]
    assert image.pixels[inside].size > 3 * 700
    assert (image.pixels[inside] > 0.0).all()  # a full square, without a leak
    tree = tracer.trace(world, ray=((0.1, 0.2, 3), (0, 0, -1)), depth=0)
    expected = 3 - 0.1 * np.sin(0.7) * np.cos(1.0)
    assert tree.nodes["t"][0] == pytest.approx(expected, abs=1e-3)  # of the facets, not of the ball


LOOP = (
    "solid a\nfacet normal 0 0 1 outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop endfacet\nendsolid a\n"
)
BOMB = [
    {"componentType": 5126, "count": 30_000_000, "type": "VEC3"},
    {"componentType": 5125, "count": 3, "type": "SCALAR"},
]


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("empty.obj", "", "must have faces (f), got none"),
        ("noise.obj", bytes(range(256)) * 4, "must have faces (f), got none"),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "faces"),
        (
            "nan.obj",
            "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            'line 1: v must have finite numbers of at most 1e+150, got "nan"',
        ),
        ("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4: a face refers to vertex 9, but the file has 3"),
        ("noise.stl", bytes(range(256)) * 4, "triangles, as its header says, got 18"),
        ("cut.ply", ply()[:-20], "line 27: element face must have 4 numbers on its line, got 2"),
        (
            "bomb.ply",
            ply(10**9),
            "line 3: element vertex must have no more elements than the file has bytes",
        ),
        ("index.ply", ply().replace("\n3 0", "\n3 9", 1), "must have vertices from 0 to 7, got 9"),
        ("more.ply", ply().replace("\n3 0", "\n3 0 5", 1), "element face must have 4 numbers on its line, got 5"),
        ("vertex.stl", LOOP.replace("1 1 0", "1 1"), 'line 5: a vertex must have three numbers, got "1 1"'),
        (
            "loop.stl",
            LOOP.replace("vertex 1 1 0", ""),
            "line 2: a loop must have three vertices and an endloop, got 2 vertices",
        ),
        ("normal.obj", "vn 0 1\n", "line 1: vn must have 3 numbers, got 2"),
        ("noise.glb", b"glTF" + bytes(40), "must be glTF 2, got version 0"),
        ("cut.glb", glb()[:200], "bytes, as its header says, got 200"),
        ("bomb.glb", glb(accessors=BOMB), "accessors[0].count must be from 0 to 12000000, got 30000000"),
        ("cyclic.glb", glb(nodes=[{"mesh": 0, "children": [0]}]), "node 0 must have one parent, got a second"),
        ("view.glb", glb(bufferViews=[]), "accessors[0].bufferView must be from 0 to -1, got 0"),
    ],
)
def test_bad_mesh_is_one_line(tmp_path: Path, name: str, content: str | bytes, said: str) -> None:
    path = write(tmp_path / name, content)
    tracemalloc.start()
    try:
        scene = tracer.load(path)
        assert not said, "it should have been refused"
        assert scene.objects
    except tracer.SceneError as error:
        (line,) = error.faults
        assert line.startswith(str(path))
        assert "\n" not in line
        assert said in line
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    assert peak < 50_000_000, "a small file must not ask for much memory"
