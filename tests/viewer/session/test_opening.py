"""Scenes that are opened, dropped, edited while on show, and repaired. Real GL, no screen."""

import os
from pathlib import Path

import numpy as np

from tests.viewer.driver import Driver, viewer
from viewer.lessons import lesson
from viewer.lessons.text import Run, inlines


def write_ball(path: Path, radius: str, color: str = "[1, 0, 0]") -> None:
    path.write_text(
        f'format = 1\n[image]\nwidth = 64\nheight = 48\n[[material]]\nname = "m"\nambient = 1\ncolor = {color}\n'
        f'[[object]]\nname = "ball"\nshape = "sphere"\ncenter = [0, 0, 0]\nradius = {radius}\nmaterial = "m"\n'
    )


def saved(driver: Driver, path: Path) -> None:
    """Let the watcher see the file that was just written, without waiting for its timer."""
    stamp = path.stat().st_mtime_ns + 1_000_000
    os.utime(path, ns=(stamp, stamp))
    for _ in range(3):
        driver.session.loader.watch.last = -1e9
        driver.session.update()
    driver.app.settle()


def test_saving_the_scene_file_shows_it_and_a_mistake_keeps_the_last(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    write_ball(path, "1")
    with viewer() as driver:
        driver.open_file(path)
        session = driver.session
        session.pick(32, 24)
        session.select(0)
        assert session.tree and session.tree.radiance.tolist() == [1.0, 0.0, 0.0]
        orbit = session.orbit

        write_ball(path, "1", "[0, 1, 0]")
        saved(driver, path)
        assert session.tree.radiance.tolist() == [0.0, 1.0, 0.0]
        assert session.pixel == (32, 24)
        assert session.orbit is orbit
        assert not session.faults

        good = session.world
        write_ball(path, "-1")
        saved(driver, path)
        assert session.faults == [f'{path}: object[0] "ball": radius must be > 0, got -1']
        assert session.world is good
        assert session.tree.radiance.tolist() == [0.0, 1.0, 0.0]
        driver.frames()

        write_ball(path, "0.5", "[0, 0, 1]")
        saved(driver, path)
        assert not session.faults
        assert session.tree and session.tree.radiance.tolist() == [0.0, 0.0, 1.0]


def test_first_scene_with_faults_is_shown_once_they_are_mended(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    write_ball(path, '"one"')
    with viewer() as driver:
        driver.open_file(path)
        assert driver.session.world is None
        assert len(driver.session.faults) == 1
        driver.frames()
        write_ball(path, "1")
        saved(driver, path)
        assert driver.session.world is not None
        assert not driver.session.faults


def test_dropping_a_file_opens_it(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    write_ball(path, "1")
    with viewer() as driver:
        driver.open("two-lights")
        driver.app.surface.dropped = [path]
        driver.app.frame()
        driver.app.settle()
        assert driver.session.path == path
        assert driver.session.lesson is None


def test_mesh_opens_without_a_camera_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "face.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with viewer() as driver:
        driver.open_file(path)
        assert driver.session.world and not driver.session.faults
        driver.click(*driver.pixel_at(320, 240))
        assert driver.session.tree


def test_scene_of_any_size_is_drawn(tmp_path: Path) -> None:
    """Light years or nanometres: the 3D view has the same relative accuracy."""
    pictures = []
    for scale in (1.0, 1e60, 1e-60):
        folder = tmp_path / str(scale)
        folder.mkdir()
        path = folder / "scene.toml"  # one name, since it is on show
        path.write_text(
            'format = 1\n[[material]]\nname = "m"\nambient = 0.5\ndiffuse = 0.5\n'
            f"[[light]]\nposition = [{5 * scale}, {5 * scale}, 0]\n"
            f'[[object]]\nshape = "sphere"\ncenter = [0, {scale}, 0]\nradius = {scale}\nmaterial = "m"\n'
            f'[[object]]\nshape = "box"\nmin = [{-2 * scale}, {-0.1 * scale}, {-2 * scale}]\n'
            f'max = [{2 * scale}, 0, {2 * scale}]\nmaterial = "m"\n'
        )
        with viewer((640, 480)) as driver:
            driver.open_file(path)
            driver.session.pick(320, 240)
            driver.frames(3)
            left, top, width, height = (int(value) for value in driver.canvas.stage_place)
            pictures.append(driver.picture()[top : top + height, left : left + width].astype(int))
    for picture in pictures[1:]:
        assert (np.abs(picture - pictures[0]).max(axis=2) > 8).mean() < 0.001


def test_saving_a_material_library_shows_the_change(tmp_path: Path) -> None:
    """Also one that was missing when the scene was opened. Until then a note says so, and is shown."""
    path, library = tmp_path / "face.obj", tmp_path / "face.mtl"
    path.write_text("mtllib face.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with viewer() as driver:
        driver.open_file(path)
        assert len(driver.session.notes) == 2
        driver.frames()
        library.write_text("newmtl red\nKd 1 0 0\n")
        saved(driver, library)
        assert driver.session.world
        assert driver.session.world.scene.objects[0].material.color == (1.0, 0.0, 0.0)
        assert driver.session.notes == []
        library.write_text("newmtl red\nKd nan\n")
        saved(driver, library)
        assert driver.session.faults
        library.write_text("newmtl red\nKd 0 1 0\n")
        saved(driver, library)
        assert driver.session.world.scene.objects[0].material.color == (0.0, 1.0, 0.0)


def text_of(found: lesson.Lesson) -> str:
    """The text of the first step."""
    return "".join(item.text for _, item in inlines(found.first.parts[0].blocks) if isinstance(item, Run))


def test_a_saved_lesson_is_read_again(tmp_path: Path) -> None:
    write_ball(tmp_path / "scene.toml", "1")
    text = '+++\ntitle = "Mine"\nscene = "scene.toml"\npixel = [3, 4]\n+++\n## One\n'
    (tmp_path / "lesson.md").write_text(f"{text}before")
    with viewer() as driver:
        found = lesson.read_file(tmp_path / "lesson.md")
        driver.session.loader.open(found.scene, found)
        driver.app.settle()
        driver.session.pick(20, 20)
        (tmp_path / "lesson.md").write_text(f"{text}after")
        saved(driver, tmp_path / "lesson.md")
        assert driver.session.lesson and text_of(driver.session.lesson) == "after"
        assert driver.session.pixel == (20, 20)
        other = text.replace("[3, 4]", "[5, 6]")
        (tmp_path / "lesson.md").write_text(f"{other}after")  # another state of the step is shown
        saved(driver, tmp_path / "lesson.md")
        assert driver.session.pixel == (5, 6)
        (tmp_path / "lesson.md").write_text("no data")
        saved(driver, tmp_path / "lesson.md")
        assert text_of(driver.session.lesson) == "after" and "a lesson begins with" in driver.session.faults[0]
        driver.frames()


def test_a_file_that_is_gone_is_said_and_the_scene_stays(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    write_ball(path, "1")
    with viewer() as driver:
        driver.open_file(path)
        session, world = driver.session, driver.session.world
        path.unlink()
        for polls in range(12):
            assert polls > 2 or not session.faults  # an editor may be replacing it
            session.loader.watch.last = -1e9
            session.update()
        assert session.faults == [f"{path}: the file is gone"] and session.world is world
        session.show_faults([])
        for _ in range(6):
            session.loader.watch.last = -1e9
            session.update()
        assert not session.faults  # it is said once
        write_ball(path, "0.5")
        saved(driver, path)
        assert session.world is not world and not session.faults
