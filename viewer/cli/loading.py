"""Finding and loading the scene that a command line names."""

import contextlib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import tracer
from tracer.extras import MissingExtra
from tracer.formats import OTHER_MESHES, READERS, UP_AXES
from tracer.printable import shown_path
from tracer.scene.radiance_bound import MissingBoundError
from viewer.base.files import Unusable, has_folder, is_there
from viewer.base.progress import Progress
from viewer.base.values import SCENE_HELP
from viewer.lessons import lesson
from viewer.lessons.language import check_language, wanted
from viewer.lessons.lesson import Lesson
from viewer.reopen.places import CARRYING, is_figure
from viewer.reopen.view_state import UNCHANGED, ViewState, merged
from viewer.session.loading.scene_loader import with_lesson
from viewer.session.restore.figure_scene import FigureScene, FigureScenes

LESSON_FILE = "lesson.md"


def find(name: str, takes_figures: bool = False, language: str | None = None) -> tuple[Path, Lesson | None]:
    """The scene's file, and the lesson if a lesson was named, in this language or in that of the system. Unusable if
    there is neither, for a language that the lesson does not have, and for a figure unless the caller takes one.
    """
    path = Path(name)
    if is_figure(path) and not takes_figures:
        raise Unusable(f"{name}: a figure is opened by raytree view, trace and export; a scene is {SCENE_HELP}")
    if file := lesson_file(path):
        return _read(file, language)
    if is_there(path) or path.suffix.lower() in (*READERS, *OTHER_MESHES, *CARRYING):
        return path, None
    if name not in lesson.names() and (path.suffix or len(path.parts) > 1):
        raise Unusable(f"{name}: a scene must be one of {', '.join(READERS)} or a lesson's name")
    return _read(lesson.file_of(name), language)


def _read(file: Path, language: str | None) -> tuple[Path, Lesson]:
    check_language(file, language)
    found = lesson.read_file(file, wanted(language))
    return found.scene, found


def lesson_file(path: Path) -> Path | None:
    """The file of the lesson in a folder, or this file if it is one; None for other paths. Unusable for a folder
    without a lesson.
    """
    if path.name == LESSON_FILE and is_there(path):
        return path
    if not has_folder(path):
        return None
    if not is_there(path / LESSON_FILE):
        raise Unusable(f"{shown_path(path)}: a folder must have a file {LESSON_FILE}, got none")
    return path / LESSON_FILE


@contextlib.contextmanager
def found_scene(
    name: str, at: tuple[int, int] | None = None, swept: float | None = None, language: str | None = None
) -> Iterator[FigureScene]:
    """The scene of a file, a lesson or a figure, with the state that it opens with. `at` is the place in a lesson, and
    `swept` that of its step's sweep. A copy that a figure carries is there until the end. Unusable if there is none.
    """
    path, lesson = find(name, True, language)
    figures = FigureScenes(wanted(language))
    try:
        found = figures.find(path) if is_figure(path) else FigureScene(path, lesson, UNCHANGED, path.parent)
        state = merged(found.state, ViewState(at=at, swept=swept))
        yield replace(found, state=with_lesson(state, found.lesson, path)).at_its_step()
    finally:
        figures.close()


@contextlib.contextmanager
def extra(command: str) -> Iterator[None]:
    """Turn a missing extra into a line about the command."""
    try:
        yield
    except MissingExtra as error:
        raise Unusable(f"raytree {command}: {error}") from None


@contextlib.contextmanager
def faults() -> Iterator[None]:
    """Turn faults of a scene or of an argument into Unusable."""
    try:
        yield
    except tracer.SceneError as error:
        raise Unusable(*error.faults) from None
    except MissingBoundError as error:
        raise Unusable(f"raytree: --{error}") from None
    except ValueError as error:
        raise Unusable(f"raytree: {error}") from None


def prepared(
    path: Path, up: str = UP_AXES[0], prints_notes: bool = True, changes: Mapping[str, Any] | None = None
) -> tracer.World:
    """Load and prepare a scene, with changes to the values of its file."""
    with Progress(f"load {path.name}") as progress:
        scene = tracer.load(path, progress, up, changes)
        progress.say(f"prepare {path.name}")
        world = tracer.prepare(scene)
        for note in world.notes if prints_notes else []:
            progress.put(f"note: {note}")
    return world
