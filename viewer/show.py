"""The commands that open the viewer: in a window, into a screenshot, and without a screen."""

from argparse import Namespace
from pathlib import Path

import platformdirs

import tracer
from tracer.outline import outline
from viewer.app import App
from viewer.commands import faults, put
from viewer.files import Unusable, check_writable
from viewer.lesson import Lesson
from viewer.picture import write_picture
from viewer.session import Session
from viewer.window import NoDisplay, Offscreen, Window

SIZE = (1280, 720)


def show(path: Path, lesson: Lesson | None, options: Namespace) -> int:
    """The viewer on a scene, as the options say."""
    if options.screenshot:
        if options.screenshot.suffix.lower() != ".png":
            raise Unusable(f"{options.screenshot}: a screenshot must be a .png file")
        check_writable(options.screenshot)
        take_screenshot(path, lesson, options, options.screenshot)
        return 0
    try:
        window = Window("raytree", options.size or SIZE, _settings())
    except NoDisplay:
        return without_display(path, lesson, options)
    app = App(window, Session())
    try:
        app.session.open(path, lesson, options.depth, options.pixel)
        app.run()
    finally:
        app.close()
    return 0


def take_screenshot(path: Path, lesson: Lesson | None, options: Namespace, target: Path) -> App:
    """Draw the viewer until the first full image and the tree are there, write it, leave."""
    app = App(Offscreen(options.size or SIZE), Session())
    try:
        app.session.open(path, lesson, options.depth, options.pixel)
        app.settle()
        if app.session.faults:
            raise Unusable(*app.session.faults)
        write_picture(target, app.surface.grab())
    finally:
        app.close()
    return app


def without_display(path: Path, lesson: Lesson | None, options: Namespace) -> int:
    """The same job where no window can be opened: a screenshot, and the picked pixel's tree in the terminal."""
    target = Path("out") / f"{lesson.name if lesson else path.stem}.png"
    put(f"There is no display to open a window on: drawing the viewer into {target} instead.\n")
    target.parent.mkdir(exist_ok=True)
    session = take_screenshot(path, lesson, options, target).session
    if session.pixel is None:
        with faults():
            world = tracer.prepare(tracer.load(path))
            size = world.scene.image
            session.tree = tracer.trace(world, (size.width // 2, size.height // 2), depth=options.depth)
    assert session.tree
    put(f"\n{outline(session.tree)}")
    return 0


def _settings() -> Path:
    """Where the panels' places are kept from one start to the next."""
    folder = platformdirs.user_config_path("raytree")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path()
    return folder / "panels.ini"
