"""The scene of a figure: the file that it was made from, if it is still the same, or the copy that the figure carries.

Copies are unpacked into a temporary folder, which is removed when the window closes.
"""

import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tracer.printable import shown_path
from viewer.base.files import Unusable, free_path, write_atomically
from viewer.lessons import lesson as lessons
from viewer.reopen.embedded import MOST_CARRIED, Embedded
from viewer.reopen.places import read_figure
from viewer.reopen.scene_files import SceneFile, SceneFiles, checksum
from viewer.reopen.view_state import ViewState
from viewer.session.loading.opening import InLesson

NETWORK = ("\\\\", "//")  # begin the paths of other computers, which a figure must not make this one ask


@dataclass(frozen=True)
class FigureScene(InLesson):
    """The scene that a figure shows, and its view. `copy_of` is set if it is the figure's own copy."""

    path: Path
    lesson: lessons.Lesson | None
    state: ViewState
    home: Path  # the folder of the files that the figure was made from
    copy_of: Path | None = None
    note: str = ""  # says that it is a copy, and why


class FigureScenes:
    """Finds the scenes of figures. `close` removes the copies."""

    def __init__(self, languages: Sequence[str] | None = None) -> None:
        """`languages` of their lessons, as for `read_file`."""
        self.languages = languages
        self.folder: tempfile.TemporaryDirectory[str] | None = None
        self.count = 0

    def find(self, figure: Path) -> FigureScene:
        """The scene of a figure. Raises Unusable with one line."""
        embedded = read_figure(figure)
        files = embedded.files
        home = lessons.folder() / files.folder if embedded.is_lesson_of_program else files.folder
        for folder in (home, figure.absolute().parent):
            if not str(folder).startswith(NETWORK) and files.are_in(folder):
                return self._scene(folder, embedded, home)
        folder = self._unpacked(figure, embedded, home)
        before = home / files.main
        was = f"the lesson {files.folder}" if embedded.is_lesson_of_program else shown_path(before)
        what = "has changed" if before.is_file() else "is gone"
        note = f"{was} {what}: this is the copy in {shown_path(figure.name)}"
        return replace(self._scene(folder, embedded, home), copy_of=figure.absolute(), note=note)

    def close(self) -> None:
        """Remove the copies."""
        if self.folder:
            self.folder.cleanup()
            self.folder = None

    def _scene(self, folder: Path, embedded: Embedded, home: Path) -> FigureScene:
        files = embedded.files
        lesson = lessons.read_file(folder / files.lesson, self.languages) if files.lesson else None
        return FigureScene(lesson.scene if lesson else folder / files.main, lesson, embedded.state, home)

    def _unpacked(self, figure: Path, embedded: Embedded, home: Path) -> Path:
        """A new folder with copies of the scene's files."""
        self.folder = self.folder or tempfile.TemporaryDirectory(prefix="raytree-", ignore_cleanup_errors=True)
        self.count += 1
        folder = Path(self.folder.name) / str(self.count) / (embedded.files.folder.name or "scene")
        try:
            folder.mkdir(parents=True)
            for file in embedded.files.files:
                target = folder / file.name
                target.parent.mkdir(parents=True, exist_ok=True)
                if file.content is not None:
                    write_atomically(target, file.content)
                elif file.sha256:
                    _take_over(figure, file, home / file.name, target)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise Unusable(f"{shown_path(figure)}: its scene cannot be unpacked: {reason}") from None
        if not embedded.files.are_in(folder):
            raise Unusable(f"{shown_path(figure)}: its scene cannot be unpacked: two of its files have one name here")
        return folder


def _take_over(figure: Path, file: SceneFile, before: Path, target: Path) -> None:
    """Link a file that is not carried to where it was, if it is still the same there."""
    if str(before).startswith(NETWORK) or checksum(before) != file.sha256:
        what = "has changed" if before.is_file() else "is gone"
        raise Unusable(
            f"{shown_path(figure)}: the scene needs {shown_path(before)}, which {what};"
            f" it is not in the figure, which carries at most {MOST_CARRIED / 2**20:g} MiB"
        )
    try:
        target.symlink_to(before)
    except OSError:  # Windows, without the permission
        shutil.copyfile(before, target)


def save_copy(scene: Path, files: SceneFiles) -> Path:
    """Write the copy of a scene that a figure carried into a new folder in the current one. Returns the scene's new
    file. Raises Unusable.
    """
    parents = len(Path(files.main).parts)
    folder = scene.parents[parents - 1]
    target = free_path(Path.cwd() / folder.name)
    for file in files.files:
        if file.sha256:
            path = target / file.name
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(path, (folder / file.name).read_bytes())
    return target / files.main
