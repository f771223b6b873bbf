"""`raytree view`: the viewer in a window; or a screenshot of it, which needs no display."""

import contextlib
import json
from dataclasses import replace
from pathlib import Path

import platformdirs

import tracer
from tracer.formulas.sampler import sample_number
from tracer.printable import shown_path
from viewer.base.files import Unusable, check_writable, is_there, write_atomically
from viewer.base.pictures import png
from viewer.base.progress import Progress
from viewer.base.streams import put
from viewer.cli.loading import faults, find, found_scene, prepared
from viewer.cli.options import ViewOptions
from viewer.cli.place import ray_of
from viewer.cli.terminal import compile_once, compiling
from viewer.lessons import lesson as lessons
from viewer.lessons.language import wanted
from viewer.reopen.places import is_figure
from viewer.reopen.view_state import merged
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import with_lesson
from viewer.session.restore.last_session import LastSession, SessionKeeper, read_last
from viewer.session.restore.view import restore_appearance
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window.app import FRAMES_AFTER_EVENT, App
from viewer.window.backend import NoWindow, Offscreen, Window

SIZE = (1280, 720)
MOST_PATHS = 12  # that a fault lists
NOT_RESTORED = "the last scene is not restored: "
CONTENTS = "raytree window"  # the text in a screenshot that names what is shown


def view(options: ViewOptions) -> int:
    if options.screenshot:
        if options.screenshot.suffix.lower() != ".png":
            raise Unusable(f"{options.screenshot}: a screenshot must be a .png file")
        opening = _opening(options)
        check_writable(options.screenshot)
        take_screenshot(opening, options, options.screenshot)
        return 0
    folder = _settings_folder()
    last, opening = _with_last_session(options, folder)
    place = last.window if last else None
    size = options.size or ((place.width, place.height) if place else SIZE)
    try:
        window = Window("raytree", size, folder / "panels.ini" if folder else None, place=place)
    except NoWindow as reason:
        return without_display(options, str(reason))
    app = App(window, Session(wanted(options.language)))
    session = app.session
    restore_appearance(session.appearance, opening.state)
    keeper = SessionKeeper(folder / "session.json", session, lambda: window.place) if folder else None
    check = TreeCheck(session, options.select, options.page, options.sample)
    if folder:
        session.export.remember(folder / "figure.json")

    def look() -> None:
        check.look()
        if keeper:
            keeper.look()

    app.each_round = look
    if options.speaker:
        session.requests.append(Request.SPEAKER)
    try:
        session.loader.load(opening)
        app.run()
        if keeper:
            keeper.close()
    finally:
        app.close()
    return 0


def _opening(options: ViewOptions) -> Opening:
    """The scene, lesson or figure that was asked for; the first lesson if none was. Unusable for a place that it does
    not have.
    """
    path, lesson = find(options.scene or lessons.names()[0], True, options.language)
    if not is_figure(path):  # that of a figure is read when it is loaded
        with_lesson(options.state, lesson, path)
    if not is_there(path):  # a file that cannot be read is shown with its faults: perhaps it is being written
        raise Unusable(f"{shown_path(path)}: file not found")
    is_whole = options.depth is not None or options.page is not None  # as in a copied command line
    return Opening(path, lesson, options.state, shows_stage=options.at is not None and not is_whole).at_its_step()


def _with_last_session(options: ViewOptions, folder: Path | None) -> tuple[LastSession | None, Opening]:
    """The last session, if neither a scene nor a pixel is asked for, and what to open. If its scene cannot be opened
    any more, the first lesson is, with a note.
    """
    first = _opening(options)
    if options.scene or options.pixel or not folder:
        return None, first
    last, note = read_last(folder / "session.json")
    if last is None:
        return None, replace(first, note=note)
    try:
        opening = _opening(replace(options, scene=last.scene))
    except Unusable as unusable:
        return last, replace(first, note=f"{NOT_RESTORED}{unusable.faults[0]}")
    instead = replace(first, note=NOT_RESTORED)
    again = replace(opening, state=merged(last.state, options.state), shows_stage=False, instead=instead)
    return last, again.at_its_step()


class TreeCheck:
    """Says once if the tree on show does not have the ray or the step that was asked for, or the pixel the sample."""

    def __init__(self, session: Session, select: str | None, page: int | None, sample: int | None) -> None:
        self.session, self.asked, self.page, self.sample = session, select, page, sample

    def fault(self) -> str | None:
        """The fault; None if there is none, or no tree yet."""
        if self.session.world and self.sample is not None:
            try:
                sample_number(self.session.world.scene.image.samples, self.sample)
            except ValueError as error:
                return f"--{error}"
        tree, steps = self.session.tree, self.session.reveal.steps if self.page is not None else None
        if steps and self.page is not None and self.page >= len(steps):
            return f"--page {self.page}: must be a step of this tree, 0 .. {len(steps) - 1}"
        if not self.asked or not tree or self.session.selection != self.asked or self.session.selected is not None:
            return None
        known = ", ".join(tree.path(i) for i in range(min(len(tree), MOST_PATHS)))
        more = " ..." if len(tree) > MOST_PATHS else ""
        return f"--select {self.asked}: must be a ray of this tree, which has depth {tree.depth}: {known}{more}"

    def look(self) -> None:
        """Show the fault as soon as the tree is there."""
        fault = self.fault()
        if fault:
            self.session.show_faults([fault])
        if self.session.world:
            self.sample = None
        if self.session.tree:
            self.asked = self.page = None


def take_screenshot(opening: Opening, options: ViewOptions, target: Path) -> None:
    """Draw the viewer until the first full image and the tree are finished, and write a screenshot."""
    try:
        app = App(Offscreen(options.size or SIZE), Session(wanted(options.language)))
    except NoWindow as reason:
        raise Unusable(str(reason)) from None
    session = app.session
    check = TreeCheck(session, options.select, options.page, options.sample)
    try:
        restore_appearance(session.appearance, opening.state)
        session.loader.load(opening)
        with Progress(compiling(), at_once=True) if session.warmup.compiles else Progress("load the scene") as progress:

            def say(doing: str) -> None:
                fault = check.fault()
                if session.faults or fault:
                    raise Unusable(*session.faults, *([fault] if fault else []))
                progress.say(doing)

            app.settle(FRAMES_AFTER_EVENT, say, progress)
            say("write the screenshot")
            if session.opening and session.opening.note:
                progress.put(f"note: {session.opening.note}")
            write_atomically(target, png(app.surface.grab(), {CONTENTS: json.dumps(app.contents())}))
    finally:
        app.close()


def without_display(options: ViewOptions, reason: str) -> int:
    """If no window can be opened: print the picked pixel's tree, and take a screenshot."""
    put(f"{reason}.\n")
    compile_once()
    opening = _opening(options)
    with contextlib.ExitStack() as stack, faults():
        asked = (options.scene or lessons.names()[0], options.at, options.swept, options.language)
        scene = stack.enter_context(found_scene(*asked))
        state = merged(scene.state, options.state)
        world = prepared(scene.path, state.up, changes=scene.changes)
        image = world.scene.image
        pixel = state.pixel or (image.width // 2, image.height // 2)
        ray = None if options.pixel else ray_of(world, scene)
        sample = None if ray else sample_number(image.samples, state.sample)
        tree = tracer.trace(world, None if ray else pixel, ray, sample=sample, depth=state.depth, model=state.model)
        name = scene.lesson.name if scene.lesson else scene.path.stem
    target = Path("out") / f"{name}.png"
    put(f"Drawing the viewer into {shown_path(target)} instead; this is the ray tree it shows:\n\n{tree.to_text()}")
    target.parent.mkdir(exist_ok=True)
    check_writable(target)
    take_screenshot(replace(opening, state=replace(opening.state, pixel=pixel)), options, target)
    return 0


def _settings_folder() -> Path | None:
    """The folder for what is kept from one start to the next: the last session, the places of the panels, the last
    choice of a figure. None if there can be none.
    """
    try:
        folder = platformdirs.user_config_path("raytree")
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        return None
    return folder
