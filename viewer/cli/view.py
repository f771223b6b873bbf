"""`raytree view`: the viewer in a window; or a screenshot of it, which needs no display."""

import json
from dataclasses import replace
from pathlib import Path

import platformdirs

import tracer
from tracer.printable import shown_path
from viewer.base.files import Unusable, check_writable, is_there, write_atomically
from viewer.base.pictures import png
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, find, prepared
from viewer.cli.options import ViewOptions
from viewer.cli.terminal import compile_once, compiling
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.session.session import Session
from viewer.window.app import App
from viewer.window.backend import NoWindow, Offscreen, Window

SIZE = (1280, 720)
CONTENTS = "raytree window"  # the text in a screenshot that names what is shown


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
    folder = _settings_folder()
    try:
        window = Window("raytree", options.size or SIZE, folder / "panels.ini" if folder else None)
    except NoWindow as reason:
        return without_display(path, lesson, options, str(reason))
    app = App(window, Session())
    if folder:
        app.session.export.remember(folder / "figure.json")
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
            write_atomically(target, png(app.surface.grab(), {CONTENTS: json.dumps(app.contents())}))
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
    put(f"Drawing the viewer into {shown_path(target)} instead; this is the ray tree it shows:\n\n{tree.to_text()}")
    target.parent.mkdir(exist_ok=True)
    check_writable(target)
    take_screenshot(path, lesson, replace(options, pixel=pixel), target)
    return 0


def _settings_folder() -> Path | None:
    """The folder for what is kept from one start to the next: the places of the panels, the last choice of a figure.
    None if there can be none.
    """
    try:
        folder = platformdirs.user_config_path("raytree")
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        return None
    return folder
