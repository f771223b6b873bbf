"""Nothing ends the window: exceptions in any part become messages, and the last good scene stays."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from imgui_bundle import imgui

from tests.viewer.driver import Driver, viewer
from tracer.kernel.world import World
from viewer.gl import surfaces
from viewer.panels import PANELS, error
from viewer.panels.panel import Panel
from viewer.session import saving
from viewer.session.figure_export import SHOWN
from viewer.session.session import Session
from viewer.window import bar, bindings, menu
from viewer.window.overlays import help, messages

SCENE = """
format = 1
image = {{ width = 64, height = 48 }}
light = [{{ position = [0, 5, 5], color = [1, 1, 1] }}]
material = [{{ name = "m", diffuse = 0.5, transmit = {transmit}, ior = {ior} }}]
object = [
    {{ shape = "sphere", center = [-2, 0, 0], radius = 1, material = "m" }},
    {{ shape = "polygon", vertices = {vertices}, material = "m" }},
]
"""
SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]


def write(path: Path, ior: float = 1.5, transmit: float = 0.5, vertices: list[list[float]] = SQUARE) -> Path:
    path.write_text(SCENE.format(ior=ior, transmit=transmit, vertices=vertices))
    return path


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Driver]:
    with viewer() as driver:
        driver.open_file(write(tmp_path / "good.toml"))
        driver.session.pick(20, 20)
        driver.frames()
        driver.provokes = True
        yield driver


def breaking(*_: object) -> None:
    """Fail in the midst of everything that imgui keeps on stacks."""
    imgui.begin("another window")
    imgui.push_id("x")
    imgui.push_style_color(imgui.Col_.text, (1.0, 0.0, 0.0, 1.0))
    imgui.push_text_wrap_pos(10.0)
    imgui.begin_table("table", 2)
    imgui.begin_group()
    raise ZeroDivisionError("so it goes")


def failing(*_: object, **__: object) -> None:
    raise ZeroDivisionError("so it goes")


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.title)
def test_a_panel_that_fails_twice_is_closed_and_the_others_go_on(
    panel: Panel, room: Driver, monkeypatch: pytest.MonkeyPatch
) -> None:
    room.open("mirror-balls")  # a lesson, so that every panel exists
    drawn: list[str] = []
    if panel.request:  # so that it is on show
        room.session.requests.append(panel.request)
    front = room.session.layout.current(is_lecture=False).front
    while panel.title == "Hit" and front.get(panel.place) != panel.name:
        room.type("p")
    room.frames()
    right = panel.draw
    for other in PANELS:
        draw = breaking if other is panel else _noting(other.title, other.draw, drawn)
        monkeypatch.setitem(other.__dict__, "draw", draw)
    room.frames(1)
    (fault,) = room.session.guard.caught
    assert fault.startswith(f"{panel.title}: ZeroDivisionError: so it goes (tests/viewer/window/test_guard.py, line ")
    assert room.session.faults == [fault]
    room.frames(1)
    assert panel.title in room.session.guard.closed and len(room.session.guard.caught) == 2
    assert "it is closed until" in room.session.faults[0]
    room.frames(5)
    assert len(room.session.guard.caught) == 2
    assert {"Scene", "Image", "Ray tree"} - {panel.title} <= set(drawn)
    assert not room.app.is_over() and room.session.world
    monkeypatch.setitem(panel.__dict__, "draw", right)
    room.session.guard.open_all()
    room.frames(3)
    assert len(room.session.guard.caught) == 2


def _noting(title: str, draw: Callable[..., None], drawn: list[str]) -> Callable[..., None]:
    def noted(*arguments: object) -> None:
        drawn.append(title)
        draw(*arguments)

    return noted


@pytest.mark.parametrize("part", (bar, menu, messages, help), ids=lambda part: part.__name__)
def test_other_parts_of_a_frame(part: object, room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part, "draw", breaking)
    room.frames(4)
    assert len(room.session.guard.caught) == 2 and len(room.session.guard.closed) == 1
    room.click(*room.pixel_at(30, 30))
    assert room.session.pixel == (30, 30)


def test_a_key_that_fails_works_again(room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(bindings.TYPED, "t", breaking)
    for _ in range(3):
        room.type("t")
    assert len(room.session.guard.caught) == 3 and not room.session.guard.closed
    room.type("2")
    assert room.session.depth == 2


def test_an_export_that_fails_is_a_message(room: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    before = set(tmp_path.iterdir())
    with monkeypatch.context() as broken:
        broken.setattr("viewer.figures.export.make", failing)
        saving.export_figure(room.session)
        assert room.session.export.making
        with pytest.raises(ZeroDivisionError):
            room.session.export.making.result()
        room.frames(1)
    assert "so it goes" in room.session.faults[0] and set(tmp_path.iterdir()) == before
    saving.export_figure(room.session)
    assert room.session.export.making
    room.session.export.making.result()
    room.frames(1)
    assert room.session.notice.text.startswith("wrote ")


def test_a_scene_that_cannot_be_drawn_leaves_the_last_good_one(
    room: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = room.session
    room.type("1")
    session.select(0)
    room.frames()
    good, pixel, path = session.world, session.pixel, session.path
    make = surfaces.Surfaces.__init__

    def make_or_fail(self: surfaces.Surfaces, ctx: object, program: object, world: World, *rest: object) -> None:
        if world is not good:
            breaking()
        make(self, ctx, program, world, *rest)  # type: ignore[arg-type]

    with monkeypatch.context() as broken:
        broken.setattr(surfaces.Surfaces, "__init__", make_or_fail)
        room.open_file(write(tmp_path / "bad.toml", ior=2.0))
    assert session.world is good and session.path == path and session.pixel == pixel
    assert (session.depth, session.selected) == (1, 0)
    assert "so it goes" in session.faults[0]
    assert not session.guard.closed and room.canvas.stage.surfaces
    caught = len(session.guard.caught)
    room.frames(3)
    room.click(*room.pixel_at(40, 20))
    assert session.pixel == (40, 20) and session.tree
    room.open_file(tmp_path / "bad.toml")  # it can be drawn now
    assert session.path == tmp_path / "bad.toml" and not session.faults
    assert len(session.guard.caught) == caught


def test_rays_that_cannot_be_traced_unpick_the_pixel(room: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as broken:
        broken.setattr("tracer.trace", failing)
        room.session.pick(3, 4)
        room.frames(2)
    assert room.session.pixel is None and "so it goes" in room.session.faults[0]
    room.session.pick(3, 4)
    assert room.session.tree


@pytest.mark.parametrize(
    "change",
    (
        {"vertices": [[0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]},
        {"vertices": [[0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]]},
        {"vertices": [[0, 0, 0], [1, 0, 0], [0.5, 1e-300, 0]]},
        {"vertices": [[0, 0, 0], [1, 0.3, 0.1], [0.5, 0.15, 0.05 + 1e-16]]},
        {"ior": 1e150},
        {"ior": 1e300, "transmit": 1.0},
        {"vertices": [[1e300, 0, 0], [0, 1e300, 0], [0, 0, 1e300]]},
        {"vertices": [[1e-300, 0, 0], [0, 1e-300, 0], [0, 0, 1e-300]]},
    ),
)
def test_extreme_scenes_are_drawn_or_refused_in_a_line(change: dict, room: Driver, tmp_path: Path) -> None:
    room.provokes = False
    room.open_file(write(tmp_path / "extreme.toml", **change))
    assert room.session.path == tmp_path / "extreme.toml" or len(room.session.faults) == 1
    for pixel in ((20, 20), (40, 24), (32, 24)):
        room.session.pick(*pixel)
        room.frames()


@pytest.mark.parametrize("name", ("scene.toml", "mesh.obj", "mesh.ply", "mesh.stl", "mesh.glb", "mesh.gltf", "a.nff"))
def test_a_pipe_is_not_waited_for(name: str, room: Driver, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / name)
    room.open_file(tmp_path / name)
    assert len(room.session.faults) == 1 and "must be a file, got a pipe" in room.session.faults[0]
    assert not room.session.guard.caught


def test_a_file_of_settings_that_cannot_be_read_is_ignored(room: Driver, tmp_path: Path) -> None:
    for k, make in enumerate((os.mkfifo, Path.mkdir, lambda path: path.write_bytes(b"\xff" * 99))):
        make(tmp_path / f"{k}.json")
        room.session.export.remember(tmp_path / f"{k}.json")
        assert room.session.export.figure == SHOWN


def test_every_guarded_exception_fails_a_test(tmp_path: Path) -> None:
    with viewer() as driver:
        driver.open_file(write(tmp_path / "good.toml"))
        with pytest.raises(AssertionError), pytest.MonkeyPatch.context() as broken:
            broken.setitem(error.PANEL.__dict__, "draw", breaking)
            driver.type("r")
        assert isinstance(driver.session, Session)
