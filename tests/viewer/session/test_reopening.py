"""Figures dropped on the window bring their view back, with the scene's file or without it. Real GL, no screen."""

import shlex
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from imgui_bundle import imgui

from tests.viewer.driver import Driver, are_equal, viewer
from tests.viewer.session.test_figure_export import save
from tests.viewer.session.test_opening import saved, write_ball
from viewer.base.theme import LIGHT
from viewer.cli.main import main
from viewer.lessons import lesson
from viewer.reopen.places import CARRYING, read_figure
from viewer.session.restore.view import state_of

pytestmark = pytest.mark.early

SCROLL_BAR = 24  # pixels
FORMATS = tuple(suffix[1:] for suffix in CARRYING)


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Driver]:
    monkeypatch.chdir(tmp_path)
    with viewer() as driver:
        yield driver


def fresh(driver: Driver) -> Driver:
    """Close this viewer and start another: there is one at a time in a process."""
    driver.app.close()
    driver.__init__()
    return driver


def radius(driver: Driver) -> float:
    """The radius of the only ball, at the origin."""
    assert driver.session.world
    return float(driver.session.world.bounds[0, 1, 0])


def drop(driver: Driver, path: Path) -> None:
    driver.app.surface.dropped = [path]
    driver.app.frame()
    driver.app.settle()
    driver.frames(3)


def still(driver: Driver) -> np.ndarray:
    """The picture without what depends on the clock: the notice, and the seconds that the image took. Without the
    scroll bar at the right: imgui's tables remember the widths of their columns, and so the height of a long text.
    """
    driver.session.verification.wait()
    driver.session.update()
    driver.session.notice.text = ""
    assert driver.session.image.picture
    driver.session.image.picture.seconds = 0.0
    driver.frames()
    return driver.picture()[:, :-SCROLL_BAR]


def change_everything(driver: Driver) -> None:
    """Another state than that of a new window, in every field."""
    session = driver.session
    session.pick(240, 190)
    session.set_depth(2)
    session.set_model("fresnel" if session.model == "whitted" else "whitted")
    driver.app.settle()
    session.orbit.turn(0.3, 0.1)
    session.orbit.slide(0.0123, -0.2)
    session.orbit.zoom(1.7)
    session.image_view.zoom_about((0.3, 0.7), 2.0)
    session.tree_view.move(13.0, -5.5)
    session.shown.kinds = {"camera", "refraction"}
    session.shown.normals = session.shown.labels = False
    session.appearance.theme = LIGHT
    session.appearance.toggle_lecture_size()
    session.select(1)
    session.turn = 33.5
    session.reveal.set_order("recursion")
    session.reveal.go_to(3)
    driver.frames()


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in ("pdf", "pptx", "png") else []) for name in FORMATS]
)
def test_a_dropped_figure_brings_the_view_back_exactly(room: Driver, name: str) -> None:
    room.open("glass-ball")
    change_everything(room)
    room.session.export.format = name
    room.session.export.theme = "dark"  # of the figure, not of the window
    figure = save(room)
    state, picture = state_of(room.session), still(room)
    other = fresh(room)
    other.open("plates")
    drop(other, figure)
    assert state_of(other.session) == state
    assert other.session.lesson and other.session.lesson.name == "glass-ball"
    assert not other.session.notice.text and other.session.opening and not other.session.opening.figure
    assert are_equal(still(other), picture)


def test_a_figure_of_the_scene_on_show_brings_its_own_view_back(room: Driver) -> None:
    room.open("glass-ball")
    figure, state, picture = save(room), state_of(room.session), still(room)
    change_everything(room)
    assert state_of(room.session) != state
    drop(room, figure)
    assert state_of(room.session) == state
    same = still(room) == picture
    assert same[:, :800].all() and same[:400].all()  # at the lower right another panel of texts may be in front


def test_without_its_file_the_scene_is_the_figures_copy(room: Driver, tmp_path: Path) -> None:
    path = tmp_path / "scenes" / "scene.toml"
    path.parent.mkdir()
    write_ball(path, "1")
    room.open_file(path)
    room.session.pick(32, 24)
    room.frames()
    figure, picture = save(room), still(room)

    write_ball(path, "0.5")
    other = fresh(room)
    drop(other, figure)
    assert other.session.notice.text == f"{path} has changed: this is the copy in {figure.name}"
    assert radius(other) == 1.0
    assert are_equal(still(other), picture)

    path.unlink()
    other = fresh(room)
    drop(other, figure)
    session = other.session
    assert session.notice.text == f"{path} is gone: this is the copy in {figure.name}"
    copy = session.path
    assert copy and copy.is_file() and copy != path and are_equal(still(other), picture)
    again = save(other)  # a figure of the copy: it leads to the file, if that comes back
    assert again.read_bytes().count(b"<raytree:view") == 1
    assert read_figure(again).files.folder == path.parent

    other = fresh(room)
    assert not copy.exists() and not copy.parent.parent.parent.exists()
    write_ball(path, "1")
    drop(other, again)
    assert other.session.path == path and not other.session.notice.text
    write_ball(path, "0.25")  # it is watched
    saved(other, path)
    assert radius(other) == 0.25


def test_a_scene_beside_the_figure_is_found(room: Driver, tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    write_ball(tmp_path / "here" / "scene.toml", "1")
    room.open_file(tmp_path / "here" / "scene.toml")
    room.session.pick(32, 24)
    room.frames()
    figure = save(room)
    (tmp_path / "here").rename(tmp_path / "there")
    figure = figure.rename(tmp_path / "there" / figure.name)
    drop(room, figure)
    assert room.session.path == tmp_path / "there" / "scene.toml"
    assert room.session.opening and not room.session.opening.figure


def mesh_scene(folder: Path) -> Path:
    """A scene that names a mesh in another folder, with a material library."""
    (folder / "scenes").mkdir()
    (folder / "meshes").mkdir()
    (folder / "meshes" / "face.obj").write_text("mtllib face.mtl\nusemtl red\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "meshes" / "face.mtl").write_text("newmtl red\nKa 1 0 0\n")
    (folder / "scenes" / "scene.toml").write_text(
        'format = 1\n[image]\nwidth = 64\nheight = 48\n[[object]]\nshape = "mesh"\nfile = "../meshes/face.obj"\n'
    )
    return folder / "scenes" / "scene.toml"


def test_meshes_and_materials_are_carried(room: Driver, tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    room.open_file(mesh_scene(home))
    assert not room.session.faults
    room.session.pick(32, 24)
    room.frames()
    figure, tree, picture = save(room), room.session.tree, still(room)
    shutil.rmtree(home)
    other = fresh(room)
    drop(other, figure)
    assert other.session.tree and tree and other.session.tree.nodes.tobytes() == tree.nodes.tobytes()
    assert are_equal(still(other), picture)


@pytest.mark.parametrize("up", ["y", "z"])
def test_a_bare_mesh_keeps_the_axis_that_points_up(tmp_path: Path, up: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("face.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n")
    assert main(["export", "face.obj", "--up", up, "--pixel", "320,240", "-o", "a.pdf"]) == 0
    Path("face.obj").unlink()
    with viewer() as other:
        drop(other, tmp_path / "a.pdf")
        assert other.session.up == up and other.session.tree and not other.session.faults


def test_a_mesh_that_is_too_large_is_named_and_must_be_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path = mesh_scene(tmp_path)
    noise = np.random.default_rng(1).random((60_000, 3))
    points = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in noise.tolist())
    (tmp_path / "meshes" / "face.obj").write_text(f"mtllib face.mtl\nusemtl red\n{points}f 1 2 3\n")
    assert main(["export", str(path), "--pixel", "32,24", "-o", "a.svg"]) == 0
    assert (tmp_path / "a.svg").stat().st_size < 100_000
    path.unlink()
    mesh = tmp_path / "meshes" / "face.obj"
    with viewer() as other:
        drop(other, tmp_path / "a.svg")
        assert "is gone: this is the copy" in other.session.notice.text and not other.session.faults
    mesh.rename(tmp_path / "moved.obj")
    with viewer() as other:
        drop(other, tmp_path / "a.svg")
        assert other.session.faults == [
            f"{tmp_path}/a.svg: the scene needs {mesh}, which is gone;"
            " it is not in the figure, which carries at most 1 MiB"
        ]


def test_the_note_on_a_mesh_that_is_not_carried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One that the scene names by an absolute path: a copy of the scene elsewhere would not find its copy."""
    monkeypatch.chdir(tmp_path)
    path = mesh_scene(tmp_path)
    mesh = tmp_path / "meshes" / "face.obj"
    path.write_text(path.read_text().replace("../meshes/face.obj", str(mesh)))
    assert main(["export", str(path), "--pixel", "32,24", "-o", "a.svg"]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if "not carried" in line]
    assert len(notes) == 1 and notes[0].startswith(
        "note: meshes/face.obj is not carried in the figure, only its checksum"
    )


def test_a_changed_lesson_opens_as_it_was(room: Driver, tmp_path: Path) -> None:
    """A lesson in a folder of the user's, with its text."""
    home = tmp_path / "mine"
    shutil.copytree(lesson.read("glass-ball").path.parent, home)
    found = lesson.read_file(home / "lesson.md")
    room.session.loader.open(found.scene, found)
    room.app.settle()
    room.frames()
    figure, picture, text = save(room), still(room), found.first.parts
    assert shlex.split(room.session.export.command)[:3] == ["raytree", "export", str(home)]
    (home / "lesson.md").write_text((home / "lesson.md").read_text() + "\nMore.")
    other = fresh(room)
    drop(other, figure)
    assert other.session.lesson and other.session.lesson.first.parts == text and other.session.lesson.name == "mine"
    assert other.session.notice.text.endswith(f"this is the copy in {figure.name}")
    assert are_equal(still(other), picture)


def test_the_user_can_save_the_copy(room: Driver, tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    path = mesh_scene(home)
    room.open_file(path)
    room.session.pick(32, 24)
    room.frames()
    figure = save(room)
    texts = {file.relative_to(home): file.read_text() for file in home.rglob("*") if file.is_file()}
    shutil.rmtree(home)
    from viewer.session.saving import save_scene

    save_scene(room.session)
    assert room.session.notice.text == "this scene is no copy: it is a file already"
    other = fresh(room)
    drop(other, figure)
    save_scene(other.session)
    assert other.session.notice.text == f"wrote {home / 'scenes' / 'scene.toml'}"
    save_scene(other.session)
    assert (tmp_path / "home-2").is_dir()
    assert {file.relative_to(home): file.read_text() for file in home.rglob("*") if file.is_file()} == texts


@pytest.mark.parametrize("spoil", [lambda path: path.write_bytes(b"no figure"), lambda path: path.unlink()])
def test_a_figure_that_cannot_be_read_is_a_message(
    room: Driver, tmp_path: Path, spoil: Callable[[Path], object]
) -> None:
    room.open("plates")
    figure = save(room)
    world = room.session.world
    spoil(figure)
    drop(room, figure)
    assert len(room.session.faults) == 1 and room.session.faults[0].startswith(
        f"{figure.absolute().name}: ".removeprefix("")
    )
    assert room.session.world is world


def test_a_copied_command_line_is_that_of_this_view(room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its screenshot in another process of the program: tests/viewer/cli/test_view_command.py."""
    copied: list[str] = []
    monkeypatch.setattr("viewer.session.saving.copy_to_clipboard", copied.append)
    room.open("glass-ball")
    change_everything(room)
    room.press(imgui.Key.mod_ctrl, imgui.Key.l)
    (line,) = copied
    assert line.startswith("raytree view glass-ball --pixel 240,190 --depth 2 --model whitted --select ")
    assert line.endswith(" --size 1280x720") and " --theme light --type-size lecture " in line
