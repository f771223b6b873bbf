"""Work that a scene does not need is left out: passes, features of the shader, the lesson panel, libraries."""

import subprocess
import sys
from pathlib import Path

import moderngl
import pytest
from imgui_bundle.imgui import internal

from tests.viewer.driver import Driver, viewer
from viewer.gl.features import FEATURES
from viewer.gl.surfaces import Surfaces
from viewer.panels import ray
from viewer.panels.lessons import lesson
from viewer.session import actions

MATTE = (
    "format = 1\n[[light]]\nposition = [1, 5, 3]\n"
    '[[material]]\nname = "matte"\ncolor = [0.8, 0.6, 0.2]\ndiffuse = 0.9\n'
)
BALL = '[[object]]\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "matte"\n'
MIRROR = "reflect = 0.5\n"
CHECKER = "checker = { color = [0, 0, 0], size = 0.5 }\n"
GLASS = "transmit = 0.5\nior = 1.5\n"

LIBRARIES = {"trimesh", "PIL", "OpenEXR", "imgui_bundle", "moderngl", "glfw", "mapbox_earcut"}


@pytest.fixture
def room():
    with viewer((900, 600)) as driver:
        yield driver


def show(room: Driver, folder: Path, material: str = "") -> Surfaces:
    path = folder / "scene.toml"
    path.write_text(MATTE + material + BALL)
    room.session.loader.open(path)
    room.app.settle()
    surfaces = room.canvas.stage.surfaces
    assert surfaces and not room.session.faults
    return surfaces


@pytest.mark.parametrize(
    ("material", "features"),
    [
        ("", set()),
        (MIRROR, {"MIRROR"}),
        (CHECKER, {"CHECKER"}),
        (GLASS, {"GLASS"}),
        (GLASS + MIRROR, {"GLASS"}),  # a mirror of glass is drawn by the shader's glass
        (MIRROR + CHECKER, {"MIRROR", "CHECKER"}),
    ],
)
def test_shader_has_in_it_what_the_scene_needs(room: Driver, tmp_path: Path, material: str, features: set[str]) -> None:
    """The shader is compiled without the features that a scene does not use. The full shader draws the same picture."""
    surfaces = show(room, tmp_path, material)
    stage, session = room.canvas.stage, room.session
    assert set(stage.programs) == {frozenset(features)}
    asked = {"edge": "GLASS", "sky_top": "MIRROR", "axes": "CHECKER"}  # uniforms that nothing else reads
    for name, feature in asked.items():
        wanted = feature in features or (name == "sky_top" and "GLASS" in features)
        assert (name in surfaces.program) == wanted
    pictures = []
    for chosen in (None, frozenset(feature.name for feature in FEATURES)):
        assert session.world
        stage.set_world(session.world, session.frame, chosen)
        stage.draw(session.orbit, session.appearance.theme, (400, 300), 1.0, None)
        pictures.append(stage.target.pixels())
    assert (pictures[0] == pictures[1]).all()
    assert len(set(pictures[0].reshape(-1, 3)[::7].astype(int).sum(axis=1).tolist())) > 20  # the picture is not empty


def fragments(room: Driver) -> int:
    """The number of fragments that the pass for transparent surfaces has drawn."""
    stage = room.canvas.stage
    assert stage.surfaces
    query = stage.ctx.query(samples=True)
    stage.target.sampled.use()
    stage.ctx.enable_only(moderngl.BLEND)
    with query:
        stage.surfaces.draw_clear(room.session.orbit)
    return query.samples


def test_glass_pass_is_drawn_for_glass_only(room: Driver, tmp_path: Path) -> None:
    show(room, tmp_path)
    assert fragments(room) == 0
    show(room, tmp_path, GLASS)
    assert fragments(room) > 0


def test_variants_are_compiled_once(room: Driver, tmp_path: Path) -> None:
    first = show(room, tmp_path).program
    second = show(room, tmp_path, MIRROR).program
    assert first is not second
    assert show(room, tmp_path).program is first


def test_scene_without_a_lesson_has_no_lesson_panel(room: Driver, tmp_path: Path) -> None:
    show(room, tmp_path)
    assert internal.find_window_by_name(lesson.PANEL.title) is None
    actions.open_lesson(room.session, "two-lights")
    room.app.settle(4)
    found, numbers = (internal.find_window_by_name(panel.title) for panel in (lesson.PANEL, ray.PANEL))
    assert found and found.active and not (numbers and numbers.active)  # both share a place
    show(room, tmp_path)
    room.frames(4)
    numbers = internal.find_window_by_name(ray.PANEL.title)
    assert not found.active and numbers and numbers.active


def loaded(program: str) -> set[str]:
    """The libraries in the list that a program has imported, in a process of its own."""
    lines = f"import sys\n{program}\nprint(*sorted({LIBRARIES!r} & set(sys.modules)))"
    run = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


MAIN = "from viewer.cli.main import main\nassert main({}) == 0"


def test_libraries_are_imported_when_they_are_used(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(MATTE + BALL)

    def used(*arguments: object) -> set[str]:
        return loaded(MAIN.format([str(argument) for argument in arguments]))

    assert used("plan", scene) == set()
    assert used("trace", scene, "--pixel", "1,1") == set()
    assert used("render", scene, "--size", "8x8", "-o", tmp_path / "a.npy") == set()
    assert used("render", scene, "--size", "8x8", "-o", tmp_path / "a.png") == {"PIL"}
    assert used("render", scene, "--size", "8x8", "-o", tmp_path / "a.exr") == {"OpenEXR"}
    assert used("plan", "glass-ball") == set()
    window = {"imgui_bundle", "moderngl", "glfw"}
    assert loaded("import viewer.window.app") == window
    assert used("view", scene, "--screenshot", tmp_path / "b.png", "--size", "400x300") == window | {"PIL"}
