"""The command line that opens the view on show, and the data with which a figure carries it."""

from importlib.metadata import version
from pathlib import Path

from viewer.base.options import shell_line, words
from viewer.base.values import SIZE
from viewer.lessons import lesson as lessons
from viewer.lessons.lesson import Lesson
from viewer.reopen.embedded import Embedded
from viewer.reopen.scene_files import SceneFiles
from viewer.reopen.view_state import ViewState, differing
from viewer.session.restore.view import Viewed, restore_camera, state_of, type_size_of
from viewer.session.view_state import Appearance


def scene_word(path: Path, lesson: Lesson | None, figure: Path | None = None) -> str:
    """The argument that opens a scene: a lesson of the program by name, all else by its absolute path. `figure`: the
    one whose copy of the scene is on show.
    """
    if figure:
        return str(figure.absolute())
    if lesson is None:
        return str(path.absolute())
    folder = lesson.path.absolute().parent
    return lesson.name if folder == lessons.folder() / lesson.name else str(folder)


def view_command(viewed: Viewed, scene: str, size: tuple[int, int], language: str = "") -> str:
    """The command line that opens an equal window. `size` is that of the window, `language` that of the lesson's
    translation.

    The 3D view is set to the numbers in the command line, which differ from it by rounding: so both are equal.
    """
    state = state_of(viewed)
    restore_camera(viewed, state)
    plain = Appearance()
    new = ViewState(theme=plain.theme.name, type_size=type_size_of(plain))
    more = ["--language", language] if language else []
    return shell_line(["raytree", "view", scene, *words(differing(state, new)), "--size", SIZE.show(size), *more])


def embedded(files: SceneFiles, state: ViewState) -> Embedded:
    """The data of a figure. The files of the program's lessons are named without the place of the program."""
    home = lessons.folder()
    own = files.folder.is_relative_to(home)
    folder = files.folder.relative_to(home) if own else files.folder
    return Embedded(version("raytree"), state, SceneFiles(folder, files.main, files.lesson, files.files), own)
