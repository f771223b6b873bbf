"""Haines' Neutral File Format: every entity, every fault with its line, and the same image as the scene in TOML."""

import math
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.scenes import kinds
from tracer.shapes.cone import Cone
from tracer.shapes.mesh import Mesh
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere

VIEW = """v
from 1 2 8   # where the eye is
at 0 0.5 0
up 0 1 0
angle 40
hither 0.01
resolution 40 30
"""
EVERYTHING = f"""# a comment, then an empty line

b 0.1 0.2 0.3
{VIEW}l 4 6 5
l -4 6 5 0.5 0.25 0.125
f 1 0.5 0.25 0.7 0.2 30 0 0
s 0 1 0 1
p 4
-5 0 -5
-5 0 5
5 0 5
5 0 -5
f 1 1 1 0 0.1 0 0.9 1.5
s 2 1 0 -0.5
c 3 0 0 0.5 3 2 0 0.25
f 0.5 0.5 0.5 1 0 0 0 0
pp 3
0 0 1 0 0 1
1 0 1 1 0 1
0 1 1 0 1 2
pp 4
0 0 2 0 0 1  1 0 2 0 0 1  1 1 2 0 0 1  0 1 2 0 0 1
p 3  0 0 3  1 0 3  0 1 3
"""


def load(tmp_path: Path, text: str) -> tracer.Scene:
    path = tmp_path / "scene.nff"
    path.write_text(text)
    return tracer.load(path)


def faults(tmp_path: Path, text: str) -> list[str]:
    with pytest.raises(tracer.SceneError) as caught:
        load(tmp_path, text)
    return [fault.removeprefix(f"{tmp_path}/") for fault in caught.value.faults]


def test_every_entity_is_read(tmp_path: Path) -> None:
    scene = load(tmp_path, EVERYTHING)
    assert scene.title == "scene"
    assert scene.background.color == (0.1, 0.2, 0.3)
    assert (scene.image.width, scene.image.height) == (40, 30)
    assert (scene.camera.position, scene.camera.look_at, scene.camera.up) == ((1, 2, 8), (0, 0.5, 0), (0, 1, 0))
    dim = 1 / math.sqrt(2)
    assert [light.position for light in scene.lights] == [(4, 6, 5), (-4, 6, 5)]
    assert [light.color for light in scene.lights] == [(dim, dim, dim), (0.5, 0.25, 0.125)]
    assert [type(item.shape) for item in scene.objects] == [Sphere, Polygon, Sphere, Cone, Mesh, Mesh]
    ball, _, glass_ball, cone, patches, triangle = (item.shape for item in scene.objects)
    assert ball == Sphere((0, 1, 0), 1.0)
    assert glass_ball == Sphere((2, 1, 0), 0.5)
    assert cone == Cone((3, 0, 0), 0.5, (3, 2, 0), 0.25)
    assert isinstance(patches, Mesh) and isinstance(triangle, Mesh)
    assert len(patches.geometry.faces) == 3  # a triangle and a square in two
    assert patches.geometry.normals is not None and triangle.geometry.normals is None
    assert patches.geometry.normals[2] == pytest.approx(np.array([0, 1, 2]) / math.sqrt(5), rel=1e-15)
    matte, _, glass, *_ = (item.material for item in scene.objects)
    assert (matte.color, matte.diffuse, matte.specular) == ((1, 0.5, 0.25), 0.7, 0.2)
    assert (matte.shininess, matte.reflect, matte.transmit) == (30, 0.2, 0)
    assert (glass.diffuse, glass.specular, glass.reflect, glass.transmit, glass.ior) == (0, 0, 0.1, 0.9, 1.5)


def test_angle_goes_from_the_middle_of_the_top_row_to_that_of_the_bottom_row(tmp_path: Path) -> None:
    scene = load(tmp_path, EVERYTHING)
    world = tracer.prepare(scene)
    ways = [tracer.trace(world, pixel=(x, y)).nodes["direction"][0] for x, y in ((19, 0), (20, 0), (19, 29), (20, 29))]
    top, bottom = ways[0] + ways[1], ways[2] + ways[3]
    assert math.degrees(tracer.optics.angle(tuple(top), tuple(bottom))) == pytest.approx(40.0, rel=1e-14)


def test_same_image_as_the_scene_in_toml_to_the_bit(tmp_path: Path) -> None:
    nff = "l 4 6 5\nf 1 0.5 0.25 0.7 0.2 30 0 0\ns 0 0 0 1\nf 1 1 1 0.1 0.1 9 0.8 1.5\ns 1.5 0 1 0.5\n"
    nff += "c -2 -1 0 0.5 -2 1 0 0.25\n"
    (tmp_path / "scene.toml").write_text("""format = 1
[[light]]
position = [4, 6, 5]
[[material]]
name = "red"
color = [1, 0.5, 0.25]
diffuse = 0.7
specular = 0.2
reflect = 0.2
shininess = 30
[[material]]
name = "glass"
diffuse = 0.1
specular = 0.1
reflect = 0.1
shininess = 9
transmit = 0.8
ior = 1.5
[[object]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
material = "red"
[[object]]
shape = "sphere"
center = [1.5, 0, 1]
radius = 0.5
material = "glass"
[[object]]
shape = "cone"
base = [-2, -1, 0]
base_radius = 0.5
apex = [-2, 1, 0]
apex_radius = 0.25
material = "glass"
""")
    one, other = (tracer.prepare(scene) for scene in (load(tmp_path, nff), tracer.load(tmp_path / "scene.toml")))
    assert np.array_equal(tracer.render(one, (40, 30)).pixels, tracer.render(other, (40, 30)).pixels)


def test_concave_polygon_has_its_notch(tmp_path: Path) -> None:
    """An L of three unit squares, printed with six digits and rotated so that no digit is exact."""
    corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    u, v, n = np.array([0.8, 0, 0.6]), np.array([0.36, 0.8, -0.48]), np.array([-0.48, 0.6, 0.64])
    lines = "\n".join(" ".join(f"{x:.6g}" for x in a / 7 * u + b / 7 * v) for a, b in corners)
    world = tracer.prepare(load(tmp_path, f"f 1 1 1 1 0 0 0 0\np 6\n{lines}\n"))
    for a, b, met in ((0.5, 0.5, True), (1.5, 0.5, True), (0.5, 1.5, True), (1.5, 1.5, False), (1.01, 1.01, False)):
        tree = tracer.trace(world, ray=((a / 7 * u + b / 7 * v + n).tolist(), (-n).tolist()))
        assert (tree.object_name(0) is not None) == met, (a, b)


def test_matched_counts_of_a_mirror_over_a_floor(tmp_path: Path) -> None:
    text = "f 1 1 1 0.5 0.5 9 0 0\ns 0 2 0 1\np 4\n-9 0 -9 -9 0 9 9 0 9 9 0 -9\nl 0 9 0\n"
    tree = tracer.trace(tracer.prepare(load(tmp_path, text)), ray=((0, 2, 9), (0, -2, -9)), depth=1)
    assert kinds(tree) == ["camera", "shadow", "reflection"]


def test_every_fault_is_said_with_its_line(tmp_path: Path) -> None:
    text = "s 0 0 0 1\nf 1 1 1 0.5 0.5 9 0 0\ns 0 0 0 x\nq 3\nc 0 0 0 1 0 0 0 1\np 2 0 0 0 1 1 1\n"
    text += "s 0 0 0 0\nf 1 1 1 0.5 7 9 0 0\npp 3 0 0 0 0 0 0 1 0 0 0 0 1 0 1 0 0 0 1\ns 1 1 nan 1\nb 1 1"
    found = faults(tmp_path, text)
    assert [fault.split(": ")[1] for fault in found] == [f"line {k}" for k in (1, 3, 4, 5, 6, 7, 8, 9, 10, 11)]
    assert found[0] == "scene.nff: line 1: an object must have a material (f) before it, got none"
    assert found[1] == 'scene.nff: line 3: the radius of a sphere must be a number, got "x"'
    assert found[2].startswith("scene.nff: line 4: an entity must be one of v (the camera), ")
    assert found[5] == "scene.nff: line 7: sphere: radius must be > 0, got 0"
    assert found[9] == "scene.nff: line 11: r g b of the background must be a number, got the end of the file"


def test_an_unreadable_material_is_one_fault_and_not_one_for_each_of_its_objects(tmp_path: Path) -> None:
    (found,) = faults(tmp_path, "f 1 1 1 0.5 0.5 9 0\ns 0 0 0 1\ns 3 0 0 1\n")
    assert "ior of f must be a number" in found


def test_what_follows_a_fault_of_value_is_read_again(tmp_path: Path) -> None:
    found = faults(tmp_path, "f 1 1 1 0.5 0.5 9 0 0\nl 0 9 0 -1 0 0\nq 1\ns 0 0 0 0\nfrom 3\n")
    assert [fault.split(": ")[1] for fault in found] == ["line 2", "line 3", "line 4", "line 5"]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "scene.nff: a scene needs at least one object (s, p, pp or c), got none"),
        ("v\nfrom 0 0 1\nat 0 0 0\n", "scene.nff: line 1: v must have from, at, up, angle and resolution, "
         "got no up, angle, resolution"),
        (VIEW.replace("40\n", "180\n", 1), "scene.nff: line 5: angle must be > 0 and < 180, got 180"),
        (VIEW.replace("40 30", "40.5 30"), "scene.nff: line 7: resolution must be two whole numbers, got 40.5 30"),
        (VIEW.replace("at 0 0.5 0", "at 1 2 8"), 'scene.nff: line 3: v: "at" must differ from "from", '
         "got [1, 2, 8] for both"),
        ("f 1 1 1 1 2 0 0 0\n", "scene.nff: line 1: f: Ks must be >= 0 and <= 1, got 2"),
        ("f 1 1 1 1 0 0 0 0\ns 0 0\n0\n# no radius\ns 0 0 0 1\n", "scene.nff: line 3: the radius of a sphere must be "
         'a number, got "s"'),
        ("l 0 0 9 -1 0 0\n", "scene.nff: line 1: light: color must be three numbers [r, g, b] >= 0, got [-1, 0, 0]"),
        ("f 1 1 1 1 0 0 0 0\np 4 0 0 0 1 0 0 1 1 1 0 1 0\n", "scene.nff: line 2: polygon: vertices must lie in one "
         "plane (to 1e-05 of the polygon's size), got vertices[0] off it by 0.2 of that size"),
    ],
)  # fmt: skip
def test_what_cannot_be_meant_is_refused(tmp_path: Path, text: str, fault: str) -> None:
    assert faults(tmp_path, text) == [fault]


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scene.nff").write_bytes(b"s 0 0 0 \0")
    with pytest.raises(tracer.SceneError, match=r"scene\.nff: an NFF file is text, got a zero byte at 8"):
        tracer.load(tmp_path / "scene.nff")


def test_slivers_without_an_area_are_left_out(tmp_path: Path) -> None:
    text = "f 1 1 1 1 0 0 0 0\npp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 0 0 0 0 1\np 4 0 0 0 1 0 0 2 0 0 3 0 0\ns 0 0 0 1\n"
    assert [type(item.shape) for item in load(tmp_path, text).objects] == [Sphere]
