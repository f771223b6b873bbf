"""Thousands of random events: keys, mouse, sizes, scales, and files that are changed, broken, deleted or dropped.

Nothing fails in any part of the window, OpenGL has no error, and neither OpenGL objects nor scenes pile up.
"""

import gc
import os
import random
from pathlib import Path

import moderngl
import pytest
from imgui_bundle import imgui

from tests.viewer.driver import Driver, viewer
from tracer.kernel.world import World
from viewer.lessons import lesson
from viewer.reopen.view_state import ViewState
from viewer.window import bindings

pytestmark = pytest.mark.early

K = imgui.Key
EVENTS = 500  # a seed
NAMED = [K(k) for k in range(K.named_key_begin, K.mouse_left) if K(k) not in (K.q, K.left_super, K.right_super)]
OFTEN = (K.escape, K.page_down, K.page_up, K.f5, K.home, K.end, K.tab, K.left_arrow, K.s, K.c) * 8
MODIFIERS = (K.mod_ctrl, K.mod_shift, K.mod_alt)
CHARACTERS = [*bindings.TYPED, "я", "é", "\0", "𝄞", "Q", " ", "\x1b"]
SIZES = ((1280, 720), (1920, 1080), (640, 400), (200, 150), (1, 1), (3000, 300))
MESH = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SCENE = """format = 1
image = {{ width = {width}, height = 36 }}
light = [{{ name = "key", position = [3, 5, 4] }}]
material = [{{ name = "m", diffuse = 0.5, reflect = 0.3, transmit = {transmit}, ior = {ior} }}]
object = [
    {{ shape = "sphere", center = [0, 0, 0], radius = {radius}, material = "m" }},
    {{ shape = "mesh", file = "part.obj", translate = [1, 0, 0], material = "m" }},
    {{ shape = "plane", point = [0, -1, 0], normal = [0, 1, 0], material = "m" }},
]
"""
LESSON = '+++\ntitle = "Mine"\nscene = "scene.toml"\npixel = [3, 4]\n+++\n# What\n- to see\n'


class Chaos:
    """Random events for one viewer, with files of its own."""

    def __init__(self, driver: Driver, folder: Path, seed: int) -> None:
        self.driver, self.folder = driver, folder
        self.dice = random.Random(seed)
        self.write_all()

    def write_all(self) -> None:
        dice = self.dice
        numbers = {"width": dice.choice((48, 31, 1)), "radius": dice.choice((1, 0.2, 1e-3, 50))}
        glass = {"transmit": dice.choice((0, 0.5)), "ior": dice.choice((1.5, 1.0, 0.3))}
        (self.folder / "scene.toml").write_text(SCENE.format(**numbers, **glass))
        (self.folder / "part.obj").write_text(MESH)
        (self.folder / "lesson.md").write_text(LESSON)

    def event(self) -> None:
        kinds = {self.mouse: 30, self.wheel: 8, self.key: 30, self.character: 20}
        kinds |= {self.file: 6, self.drop: 3, self.open: 2, self.size: 1, self.turn: 3}
        self.dice.choices(list(kinds), list(kinds.values()))[0]()
        self.driver.frames(1)
        if self.dice.random() < 0.2:
            self.driver.session.show_faults([])  # read

    def mouse(self) -> None:
        dice, io = self.dice, imgui.get_io()
        width, height = (max(1, int(side)) for side in io.display_size)
        places = [(dice.randint(-20, width + 20), dice.randint(-20, height + 20))] * 4
        places += [self.driver.pixel_at(dice.randrange(60), dice.randrange(40)) for _ in range(2)]
        places += [dice.choice(list(self.driver.canvas.nodes.values()))] * 2 if self.driver.canvas.nodes else []
        io.add_mouse_pos_event(*dice.choice(places))
        button = dice.choice((0, 0, 0, 1, 2))
        for down in dice.choice(((True, False), (True, False, True, False), (True,), (False,), ())):
            io.add_mouse_button_event(button, down)
            if dice.random() < 0.5:
                self.driver.frames(1)

    def turn(self) -> None:
        """Turn the ray of the hit on show, as its handle does."""
        session = self.driver.session
        session.layout.bring_to_front("hit", session.appearance.is_lecture_size)
        session.turn = self.dice.choice((0.0, 12.3, 45.0, 89.0))

    def wheel(self) -> None:
        imgui.get_io().add_mouse_wheel_event(0.0, self.dice.choice((-3.0, -1.0, 1.0, 5.0)))

    def key(self) -> None:
        io = imgui.get_io()
        held = [key for key in MODIFIERS if self.dice.random() < 0.15]
        pressed = [*held, self.dice.choice((*NAMED, *OFTEN))]
        for key in pressed:
            io.add_key_event(key, True)
        self.driver.frames(1)
        for key in reversed(pressed):
            io.add_key_event(key, False)

    def character(self) -> None:
        imgui.get_io().add_input_character(ord(self.dice.choice(CHARACTERS)))

    def file(self) -> None:
        """Change, break or delete a file of the scene, and let it be noticed."""
        dice = self.dice
        self.write_all()
        path = self.folder / dice.choice(("scene.toml", "part.obj", "lesson.md"))
        match dice.randrange(6):
            case 0:
                path.unlink()
            case 1:
                path.write_bytes(path.read_bytes()[: dice.randrange(200)])
            case 2:
                content = bytearray(path.read_bytes())
                content[dice.randrange(len(content))] = dice.randrange(256)
                path.write_bytes(content)
            case 3:
                path.unlink()
                os.mkfifo(path)
            case _:
                pass
        for _ in range(3):
            self.driver.session.loader.watch.last = -1e9
            self.driver.session.update()
        path.unlink(missing_ok=True)
        self.write_all()

    def drop(self) -> None:
        names = ("scene.toml", "part.obj", "lesson.md", "missing.toml", ".", "missing.glb", "a\x1b\n.ply")
        self.driver.app.surface.dropped.append(self.folder / self.dice.choice(names))

    def open(self) -> None:
        session, dice = self.driver.session, self.dice
        if dice.random() < 0.5:
            found = lesson.read(dice.choice(lesson.names()))
            session.loader.open(found.scene, found)
        else:
            pixel = (dice.randrange(60), dice.randrange(60))
            session.loader.open(self.folder / "scene.toml", state=ViewState(pixel=pixel))
        if dice.random() < 0.6:
            session.loader.worker.submit(lambda: None).result()

    def size(self) -> None:
        surface = self.driver.app.surface
        surface.scale = self.dice.choice((1.0, 1.5, 2.0))  # type: ignore[misc]
        surface.resize(self.dice.choice(SIZES))  # type: ignore[union-attr]


def alive(kind: type) -> list[object]:
    """The objects of a type that are in use. Those of moderngl lose their inner object when they are released."""
    gc.collect()
    found = [thing for thing in gc.get_objects() if type(thing) is kind]
    return [thing for thing in found if not hasattr(thing, "mglo") or "Invalid" not in type(thing.mglo).__name__]


def counts() -> dict[str, int]:
    kinds = (moderngl.Texture, moderngl.Buffer, moderngl.VertexArray, moderngl.Program, moderngl.Framebuffer)
    return {kind.__name__: len(alive(kind)) for kind in kinds}


def run(folder: Path, seed: int) -> None:
    others = len(alive(World))  # of other tests
    with viewer() as driver:
        driver.open("glass-ball")
        chaos = Chaos(driver, folder, seed)
        for _ in range(EVENTS):
            chaos.event()
        driver.app.settle()
        # Whatever happened, the window works.
        for key in NAMED:
            imgui.get_io().add_key_event(key, False)
        for button in range(3):
            imgui.get_io().add_mouse_button_event(button, False)
        driver.app.surface.scale = 1.0  # type: ignore[misc]
        driver.resize((1280, 720))
        driver.press(K.escape)
        driver.press(K.escape)
        driver.session.is_blank = False
        driver.open("mirror-balls")
        driver.session.shown.kinds = {"camera", "reflection"}
        driver.session.home()
        driver.frames(3)
        while driver.session.export.making:
            # The collector's list of objects must not hold a tuple that another thread is building: CPython then
            # raises SystemError in that thread (bugs.python.org/issue15108).
            driver.session.export.making.exception()
            driver.frames(1)
        before = counts()
        driver.open("underwater")
        driver.open("mirror-balls")
        driver.frames(3)
        assert counts() == before
        assert len(alive(World)) - others <= 8  # on show, and what caches and an export in progress hold


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, into which figures are exported."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "files").mkdir()
    return tmp_path / "files"


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))])
def test_random_events(folder: Path, seed: int) -> None:
    run(folder, seed)


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize("seed", range(4, 40))
def test_twenty_thousand_random_events(folder: Path, seed: int) -> None:
    run(folder, seed)
