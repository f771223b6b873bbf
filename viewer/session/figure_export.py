"""What is on show as a figure to take home: the very command that makes it again is what makes it."""

import contextlib
import io
import json
import math
import shlex
from argparse import Namespace
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from viewer.base.files import Unusable, write_atomically
from viewer.base.theme import THEMES

if TYPE_CHECKING:
    from tracer.kernel.world import World
    from viewer.cli.export import Made
    from viewer.figures.targets import Target
    from viewer.lessons.lesson import Lesson
    from viewer.session.session import Session

FIGURES = {"both": "Scene and tree", "tree": "Ray tree", "scene": "Scene", "hit": "Selected hit"}
FORMATS = {"svg": "SVG", "pdf": "PDF", "png": "PNG", "tikz": "TikZ", "pptx": "PPTX"}


@dataclass
class TakeHome:
    """Which figure in which format and theme, as last chosen; and what has been made of it."""

    figure: str = "both"
    format: str = "svg"
    theme: str = ""  # the window's where none is chosen
    command: str = ""  # that made the last figure
    making: Future | None = None
    kept: Path | None = None  # where the choice is kept from one start to the next

    def remember(self, path: Path) -> None:
        """Choose as last time, and keep the choice there from now on."""
        self.kept = path
        try:
            found = json.loads(path.read_text("utf-8"))
            if found["figure"] in FIGURES and found["format"] in FORMATS and found["theme"] in ("", *THEMES):
                self.figure, self.format, self.theme = found["figure"], found["format"], found["theme"]
        except (OSError, ValueError, KeyError, TypeError):
            return  # never chosen, or not by us

    def _keep(self) -> None:
        if self.kept:
            choice = {"figure": self.figure, "format": self.format, "theme": self.theme}
            with contextlib.suppress(Unusable):  # then it is for this time only
                write_atomically(self.kept, json.dumps(choice).encode("utf-8"))

    def words(self, session: "Session") -> list[str]:
        """The command's arguments for what is on show, but for as what and where to."""
        assert session.path
        assert session.pixel
        scene = session.lesson.name if session.lesson else str(session.path)
        orbit, frame = session.orbit, session.frame
        x, y, z = (frame.middle + frame.radius * orbit.target).tolist()
        view = (math.degrees(orbit.azimuth), math.degrees(orbit.elevation), orbit.distance, x, y, z)
        words = ["export", scene, f"--pixel={session.pixel[0]},{session.pixel[1]}", f"--figure={self.figure}"]
        words += [f"--depth={session.depth}", f"--model={session.model}"]
        if self.figure in ("both", "scene"):
            words.append(f"--view={','.join(map(repr, view))}")
        if self.figure == "hit":
            words.append(f"--node={session.selected or 0}")
        if "shadow" not in session.shown.kinds:
            words.append("--no-lights")
        return [*words, f"--theme={self.theme or session.theme.name}"]

    def make(self, session: "Session", copied: bool = False) -> None:
        """Write the figure beside where the program was started, or copy it; that takes up to some seconds.

        Copied it is a picture, to be pasted onto a slide; as TikZ it is text.
        """
        if not session.tree or not session.world or not session.path:
            session.notice.say("nothing to export yet: pick a pixel")
            return
        if self.making:
            return
        from viewer.cli import main
        from viewer.figures import targets
        from viewer.figures.formats import FORMATS as KINDS

        kind = self.format if not copied or self.format == "tikz" else "png"
        words = [*self.words(session), f"--format={kind}"]
        options = main.make_parser().parse_args([*words, "-o", "."])
        self.command = shlex.join(["raytree", *words])
        self._keep()
        stem = f"{targets.stem_of(options, session.lesson)}_{self.figure}_d{session.depth}"
        target = targets.Target(free(Path(stem + KINDS[kind].suffix)), folder=False)
        session.notice.say("copying the figure ..." if copied else f"exporting {target.path.name} ...")
        worker = ThreadPoolExecutor(1)  # off the window's thread
        task = _Task(options, session.world, session.lesson, target, kind)
        self.making = worker.submit(task.copy if copied else task.write)
        self.making.add_done_callback(lambda _: session.changed())
        worker.shutdown(wait=False)

    def copy_command(self, session: "Session") -> None:
        """The command line of the last figure."""
        if not self.command:
            return
        try:
            put_into_clipboard(self.command)
            session.notice.say("the figure's command line is copied")
        except Unusable as unusable:
            session.faults = list(unusable.faults)

    def finish(self, session: "Session") -> bool:
        """Say how it ended, once it has; whether there is anything new to see."""
        if not self.making or not self.making.done():
            return False
        making, self.making = self.making, None
        try:
            session.notice.say(making.result())
        except Unusable as unusable:
            session.faults = list(unusable.faults)
        except ValueError as error:
            session.faults = [str(error)]
        return True


@dataclass(frozen=True)
class _Task:
    """One figure to be made; what is said when it is done."""

    options: Namespace
    world: "World"
    lesson: "Lesson | None"
    target: "Target"
    kind: str

    def _made(self) -> "Made":
        from viewer.cli import export

        return export.make(self.options, self.world, self.lesson, self.target, [self.kind])

    def write(self) -> str:
        made = self._made()
        made.write()
        return "; ".join([f"wrote {self.target.path.resolve()}  (Ctrl+Shift+C copies its command line)", *made.notes])

    def copy(self) -> str:
        made = self._made()
        ((_, content),) = made.files
        text = self.kind == "tikz"
        put_into_clipboard(content.decode("utf-8") if text else content)
        what = "as TikZ" if text else "as a picture"
        return "; ".join([f"the figure is copied {what}  (Ctrl+Shift+C copies its command line)", *made.notes])


def put_into_clipboard(content: str | bytes) -> None:
    """A text, or a PNG as a picture. Unusable where the system has no clipboard for it.

    Not the window's own clipboard, which knows text only, and which answers no program while the window is busy.
    """
    import copykitten

    try:
        if isinstance(content, str):
            copykitten.copy(content)
            return
        from PIL import Image

        with Image.open(io.BytesIO(content)) as picture:
            copykitten.copy_image(picture.convert("RGBA").tobytes(), *picture.size)
    except copykitten.CopykittenError as error:
        raise Unusable(f"nothing can be copied here: {error}; Ctrl+S writes the figure into a file") from None


def free(path: Path) -> Path:
    """This name, or the next with a number that is not taken."""
    names = (path.with_stem(f"{path.stem}-{k}") if k > 1 else path for k in range(1, 10**6))
    return next(name for name in names if not name.exists())
