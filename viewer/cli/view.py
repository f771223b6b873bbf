"""`raytree view`: the viewer in a window; or a screenshot of it, which needs no display."""

from dataclasses import replace
from pathlib import Path

import platformdirs

import tracer
from tracer.formats.source import shown_path
from viewer.base.files import Unusable, check_writable, is_there
from viewer.base.pictures import write_picture
from viewer.base.progress import Progress
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import ViewOptions
from viewer.cli.terminal import compile_once, compiling, put
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import NoWindow, Offscreen, Window

SIZE = (1280, 720)


def view(options: ViewOptions) -> int:
    path, lesson = find(options.scene or lessons.names()[0])
    if not is_there(path):  # a file that cannot be read is shown with its faults: perhaps it is being written
        raise Unusable(f"{shown_path(path)}: file not found")
    if options.screenshot:
        if options.screenshot.suffix.lower() != ".png":
            raise Unusable(f"{options.screenshot}: a screenshot must be a .png file")
        check_writable(options.screenshot)
        take_screenshot(path, lesson, options, options.screenshot)
        return 0
    try:
        window = Window("raytree", options.size or SIZE, _settings())
    except NoWindow as reason:
        return without_display(path, lesson, options, str(reason))
    app = App(window, Session())
    app.session.export.remember(_settings().with_name("figure.json"))
    try:
        app.session.loader.open(path, lesson, options.depth, options.pixel, options.model, options.up)
        app.run()
    finally:
        app.close()
    return 0


def take_screenshot(path: Path, lesson: Lesson | None, options: ViewOptions, target: Path) -> None:
    """Draw the viewer until the first full image and the tree are finished, and write a screenshot."""
    try:
        app = App(Offscreen(options.size or SIZE), Session())
    except NoWindow as reason:
        raise Unusable(str(reason)) from None
    try:
        app.session.loader.open(path, lesson, options.depth, options.pixel, options.model, options.up)
        with (
            Progress(compiling(), at_once=True)
            if app.session.warmup.compiles
            else Progress("load the scene") as progress
        ):

            def say(doing: str) -> None:
                if app.session.faults:
                    raise Unusable(*app.session.faults)
                progress.say(doing)

            app.settle(say=say, progress=progress)
            write_picture(target, app.surface.grab())
    finally:
        app.close()


def without_display(path: Path, lesson: Lesson | None, options: ViewOptions, reason: str) -> int:
    """If no window can be opened: print the picked pixel's tree, and take a screenshot."""
    put(f"{reason}.\n")
    compile_once()
    with faults():
        world = prepared(path, options.up)
        image = world.scene.image
        pixel = options.pixel or (lesson and lesson.pixel) or (image.width // 2, image.height // 2)
        depth = options.depth if options.depth is not None else lesson and lesson.depth
        tree = tracer.trace(world, pixel, depth=depth, model=options.model)
    target = Path("out") / f"{lesson.name if lesson else path.stem}.png"
    put(f"Drawing the viewer into {target} instead; this is the ray tree it shows:\n\n{tree.to_text()}")
    target.parent.mkdir(exist_ok=True)
    check_writable(target)
    take_screenshot(path, lesson, replace(options, pixel=pixel), target)
    return 0


def _settings() -> Path:
    """The file that keeps the places of the panels from one start to the next."""
    folder = platformdirs.user_config_path("raytree")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path()
    return folder / "panels.ini"
