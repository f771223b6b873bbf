"""Scene files: everything that they may contain, and every fault, all reported at once and in one line each."""

import re
from pathlib import Path

import pytest

import tracer
from tests.scenes import MATTE, ball, world_of
from tracer.scene import Camera, Image, Light, Material, Object, Scene
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.sphere import Sphere

BALL = '[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n'

CONE = '[[object]]\nshape = "cone"\nbase = [0, 0, 0]\nbase_radius = 1\napex = [0, 2, 0]\napex_radius = 0\n'
DISC = '[[object]]\nshape = "disc"\ncenter = [0, 0, 0]\nnormal = [0, 2, 0]\nradius = 1\n'

FULL = """
format = 1
title = "All of it"
[camera]
position = [0, 1, 6]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 40
lens_radius = 0
focus_distance = 6
[image]
width = 64
height = 48
[background]
color = [0.3, 0.4, 0.6]
[tracing]
depth = 3
shadows = "filter"
model = "fresnel"
ambient = [1, 1, 1]
[[light]]
name = "key"
position = [4, 6, 5]
color = [0.7, 0.7, 0.7]
[[light]]
name = "sun"
direction = [0, -1, 0]
radius = 0
[[material]]
name = "glass"
color = [1, 1, 1]
ambient = 0.0
diffuse = 0.1
specular = 0.3
shininess = 50
reflect = 0.1
transmit = 0.9
ior = "water"
roughness = 0
[[material]]
name = "tiles"
diffuse = 1
checker = { color = [0.2, 0.2, 0.2], size = 0.5 }
[[object]]
name = "ball"
shape = "sphere"
center = [0, 0.5, 0]
radius = 0.5
material = "glass"
priority = 2
thin = false
[[object]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 2, 0]
material = "tiles"
[[object]]
shape = "polygon"
vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
[[object]]
shape = "triangle"
vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
[[object]]
shape = "box"
min = [0, 0, 0]
max = [1, 2, 3]
[[object]]
shape = "cone"
base = [0, 0, 0]
base_radius = 2
apex = [0, 3, 0]
apex_radius = 0
[[object]]
shape = "disc"
center = [0, 1, 0]
normal = [0, 0, 5]
radius = 2
"""


def faults_of(path: Path) -> list[str]:
    with pytest.raises(tracer.SceneError) as caught:
        tracer.load(path)
    assert all(fault.startswith(str(path)) for fault in caught.value.faults)
    assert all("\n" not in fault for fault in caught.value.faults)
    return [fault[len(str(path)) + 2 :] for fault in caught.value.faults]


def test_every_key_is_read(scene_file) -> None:
    scene = tracer.load(scene_file(FULL))
    assert scene.title == "All of it"
    assert scene.camera == Camera((0.0, 1.0, 6.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0, 0.0, 6.0)
    assert scene.image == Image(64, 48)
    assert scene.background.color == (0.3, 0.4, 0.6)
    assert (scene.tracing.depth, scene.tracing.shadows, scene.tracing.model) == (3, "filter", "fresnel")
    assert scene.lights[0] == Light("key", (4.0, 6.0, 5.0), None, (0.7, 0.7, 0.7))
    assert scene.lights[1].direction == (0.0, -1.0, 0.0)
    item = scene.objects[0]
    assert (item.name, item.priority, item.shape) == ("ball", 2, Sphere((0.0, 0.5, 0.0), 0.5))
    assert item.material.ior == 1.33
    checker = scene.objects[1].material.checker
    assert checker is not None
    assert (checker.color, checker.size) == ((0.2, 0.2, 0.2), 0.5)
    assert scene.objects[4].shape == Box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    assert scene.objects[5].shape == Cone((0.0, 0.0, 0.0), 2.0, (0.0, 3.0, 0.0), 0.0)
    assert scene.objects[6].shape == Disc((0.0, 1.0, 0.0), (0.0, 0.0, 5.0), 2.0)
    tracer.trace(tracer.prepare(scene), (30, 20))


def test_format_and_one_object_are_enough(scene_file) -> None:
    """The default camera frames the scene: the ball is in view as a whole and fills a good part of the image."""
    world = tracer.prepare(tracer.load(scene_file(f"format = 1\n{BALL}")))
    assert world.scene.objects[0].material == Material()
    assert world.scene.tracing.depth == 3
    seen = [
        [tracer.trace(world, (x, y)).object_name(0) is not None for x in range(0, 640, 16)] for y in range(0, 480, 16)
    ]
    assert not any(seen[0] + seen[-1] + [row[0] for row in seen] + [row[-1] for row in seen])
    assert sum(map(sum, seen)) > 0.12 * len(seen) * len(seen[0])


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "format is missing: add the line format = 1 before the first table"),
        (f"format = 2\n{BALL}", "format must be 1, got 2"),
        ("format = 1\n", "a scene needs at least one [[object]], got none"),
        ("format = 1\nthis is no toml", 'line 2: not TOML: expected \'=\' after a key in a key/value pair, got "this is no toml"'),
        ("format = 1\n# x\ndepth = \n", 'line 3: not TOML: invalid value, got "depth ="'),
        (f"format = 1\nlihgt = 3\n{BALL}", 'unknown key "lihgt" (did you mean "light"?)'),
        (f"format = 1\nlight = 3\n{BALL}", "light must be written as [[light]], got 3"),
        (f"format = 1\ntitle = 3\n{BALL}", "title must be a text, got 3"),
        (f"format = 1\ncamera = 3\n{BALL}", "camera: must be a table, got 3"),
        (f"format = 1\n{BALL}".replace("radius = 1", "radius = -1"), "object[0]: radius must be > 0, got -1"),
        (f"format = 1\n{BALL}".replace("radius = 1", "radius = 0"), "object[0]: radius must be > 0, got 0"),
        (
            f'format = 1\n{BALL}name = "ball"'.replace("radius = 1", "radius = nan"),
            'object[0] "ball": radius must be a number with an absolute value of at most 1e+150, got nan',
        ),
        (f"format = 1\n{BALL}".replace("radius = 1", 'radius = "1"'), 'object[0]: radius must be a number > 0, got "1"'),
        (f"format = 1\n{BALL}".replace("radius = 1", "radius = true"), "object[0]: radius must be a number > 0, got true"),
        (f"format = 1\n{BALL}".replace("radius = 1", ""), "object[0]: radius is missing"),
        (f"format = 1\n{BALL}".replace("radius", "raduis"), 'object[0]: unknown key "raduis" (did you mean "radius"?)'),
        (f"format = 1\n{BALL}".replace("[0, 0, 0]", "[0, 0]"), "object[0]: center must be three numbers [x, y, z], got [0, 0]"),
        (
            f"format = 1\n{BALL}".replace("[0, 0, 0]", "[0, inf, 0]"),
            "object[0]: center must be three numbers [x, y, z] with absolute values of at most 1e+150, got [0, inf, 0]",
        ),
        (f"format = 1\n{BALL}".replace("sphere", "shpere"), 'object[0]: shape must be one of "sphere", '),
        ("format = 1\n[[object]]\n", "object[0]: shape is missing: it must be one of "),
        (f'format = 1\n{BALL}material = "glas"\n[[material]]\nname = "glass"', 'object[0]: material must be the name of a '),
        (f'format = 1\n{BALL}[[material]]\nname = "a"\n[[material]]\nname = "a"', "material[1] \"a\": name must be unique"),
        (f"format = 1\n{BALL}[[material]]\ndiffuse = 1", "material[0]: name is missing: objects refer to materials by name"),
        (f'format = 1\n{BALL}[[material]]\nname = "a"\nreflect = 1.5', 'material[0] "a": reflect must be >= 0 and <= 1, got 1.5'),
        (f'format = 1\n{BALL}[[material]]\nname = "a"\nior = 0', 'material[0] "a": ior must be > 0, got 0'),
        (f'format = 1\n{BALL}[[material]]\nname = "a"\nior = "wtaer"', 'material[0] "a": ior must be a number > 0 or one of '),
        (
            f'format = 1\n{BALL}[[material]]\nname = "a"\nchecker = {{ size = 0, color = [1, 1, 1] }}',
            'material[0] "a": checker: size must be > 0, got 0',
        ),
        (f'format = 1\n{BALL}[[material]]\nname = "a"\nroughness = 0.1', 'material[0] "a": roughness must be 0 (this version'),
        (f"format = 1\n[camera]\nlens_radius = 0.1\n{BALL}", "camera: lens_radius must be 0 (this version"),
        (f"format = 1\n[camera]\nfov = 180\n{BALL}", "camera: fov must be > 0 and < 180, got 180"),
        (
            f"format = 1\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 5]\n{BALL}",
            "camera: look_at must differ from position, got [0, 0, 5] for both",
        ),
        (
            f"format = 1\n[camera]\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]\n{BALL}",
            "camera: up must not point along the line of sight, got [0, 1, 0]",
        ),
        (f"format = 1\n[camera]\nup = [0, 0, 0]\n{BALL}", "camera: up must be a direction other than [0, 0, 0]"),
        (f"format = 1\n[image]\nwidth = 0\n{BALL}", "image: width must be a whole number from 1 to 16384, got 0"),
        (f"format = 1\n[image]\nheight = 1000000\n{BALL}", "image: height must be a whole number from 1 to 16384, got 1000000"),
        (f"format = 1\n[image]\nheight = 10.5\n{BALL}", "image: height must be a whole number from 1 to 16384, got 10.5"),
        (f"format = 1\n[background]\ncolor = [0, -1, 0]\n{BALL}", "background: color must be three numbers [r, g, b] >= 0"),
        (f"format = 1\n[tracing]\ndepth = -1\n{BALL}", "tracing: depth must be a whole number from 0 to 1000000000, got -1"),
        (f'format = 1\n[tracing]\nmodel = "phong"\n{BALL}', 'tracing: model must be one of "whitted", "fresnel", got "phong"'),
        (f"format = 1\n{BALL}[[light]]\n", "light[0]: a light has either a position or a direction, got neither"),
        (
            f'format = 1\n{BALL}[[light]]\nname = "l"\nposition = [0, 1, 0]\ndirection = [0, 1, 0]',
            'light[0] "l": a light has either a position or a direction, got both',
        ),
        (f"format = 1\n{BALL}[[light]]\nposition = [0, 1, 0]\nradius = 2", "light[0]: radius must be 0 (this version"),
        (
            'format = 1\n[[object]]\nshape = "triangle"\nvertices = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]',
            "object[0]: vertices must enclose an area, got corners on one line",
        ),
        (
            'format = 1\n[[object]]\nshape = "triangle"\nvertices = [[0, 0, 0], [1, 1, 1]]',
            "object[0]: vertices must be a list of 3 points [x, y, z], got [[0, 0, 0], [1, 1, 1]]",
        ),
        (
            'format = 1\n[[object]]\nshape = "polygon"\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]',
            "object[0]: vertices must lie in one plane",
        ),
        (
            'format = 1\n[[object]]\nshape = "box"\nmin = [0, 0, 0]\nmax = [1, 0, 1]',
            "object[0]: max must be above min along each axis",
        ),
        (
            'format = 1\n[[object]]\nshape = "plane"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]',
            "object[0]: normal must be a direction other than [0, 0, 0], got [0, 0, 0]",
        ),
        (f"format = 1\n{CONE}".replace("base_radius = 1", "base_radius = -1"), "object[0]: base_radius must be >= 0, got -1"),
        (f"format = 1\n{CONE}".replace("apex_radius = 0", "apex_radius = nan"), "object[0]: apex_radius must be a number with an absolute value of at most"),
        (f"format = 1\n{CONE}".replace("apex_radius = 0", ""), "object[0]: apex_radius is missing"),
        (f"format = 1\n{CONE}".replace("apex_radius", "top_radius"), 'object[0]: unknown key "top_radius" (did you mean "apex_radius"?)'),
        (f"format = 1\n{CONE}".replace("[0, 2, 0]", "[0, 0, 0]"), "object[0]: apex must differ from base, got [0, 0, 0] for both"),
        (
            f"format = 1\n{CONE}".replace("base_radius = 1", "base_radius = 0"),
            "object[0]: base_radius or apex_radius must be > 0, got 0 for both",
        ),
        (f"format = 1\n{DISC}".replace("radius = 1", "radius = 0"), "object[0]: radius must be > 0, got 0"),
        (f"format = 1\n{DISC}".replace("[0, 2, 0]", "[0, 0, 0]"), "object[0]: normal must be a direction other than [0, 0, 0]"),
        (f"format = 1\n{DISC}".replace("center", "centre"), 'object[0]: unknown key "centre" (did you mean "center"?)'),
        ('format = 1\n[[object]]\nshape = "mesh"\nfile = "none.obj"', "object[0]: mesh none.obj: file not found"),
        ('format = 1\n[[object]]\nshape = "mesh"', "object[0]: file is missing"),
        ('format = 1\n[[object]]\nshape = "mesh"\nfile = "scene.toml"', "object[0]: mesh scene.toml: a mesh must be one of .obj, .ply, .stl, .glb, .gltf"),
    ],
)  # fmt: skip
def test_fault(scene_file, text: str, fault: str) -> None:
    found = faults_of(scene_file(text))
    assert any(line.startswith(fault) for line in found), found


def test_faults_come_all_at_once(scene_file) -> None:
    text = FULL.replace("radius = 0.5", "radius = -1").replace("fov = 40", "fov = 400").replace('"key"', "3")
    found = faults_of(scene_file(text.replace("diffuse = 0.1", 'difuse = "x"')))
    places = [line.split(":")[0] for line in found]
    assert places == ["camera", "light[0]", 'material[0] "glass"', 'object[0] "ball"']


def test_text_that_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_bytes(b'format = 1\ntitle = "\xff\xfe"\n')
    assert re.match(r"byte \d+: a scene file is UTF-8 text", faults_of(path)[0])


@pytest.mark.parametrize("name", ["none.toml", "scene.txt", "scene"])
def test_file_that_is_no_scene(tmp_path: Path, name: str) -> None:
    assert len(faults_of(tmp_path / name)) == 1


def test_folder_is_no_scene(tmp_path: Path) -> None:
    folder = tmp_path / "scene.toml"
    folder.mkdir()
    assert faults_of(folder) == ["must be a file, got a folder"]


def test_scene_written_in_python_is_held_to_the_same_rules() -> None:
    with pytest.raises(tracer.SceneError) as caught:
        tracer.prepare(Scene((Object(Sphere((0.0, 0.0, 0.0), -1.0), Material("m", reflect=2.0), "ball"),)))
    assert caught.value.faults == [
        'object[0] "ball": radius must be > 0, got -1',
        'object[0] "ball": material "m": reflect must be >= 0 and <= 1, got 2',
    ]
    with pytest.raises(tracer.SceneError):
        tracer.prepare(Scene(()))
    world_of(ball(material=MATTE))


def test_extreme_but_allowed_numbers_stay_numbers() -> None:
    for scale in (1e-140, 1e-30, 1e30, 1e70):
        world = world_of(ball((0, 0, 0), scale))
        tree = tracer.trace(world, ray=((0, 0, 5 * scale), (0, 0, -1)), depth=1)
        assert tree.nodes["t"][0] == pytest.approx(4 * scale, rel=1e-15, abs=0.0)
