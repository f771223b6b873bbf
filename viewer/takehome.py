"""What is on show as a figure to take home: the very command that makes it again is what makes it."""

import contextlib
import json
import math
import shlex
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from viewer.files import Unusable, write_atomically
from viewer.theme import THEMES

if TYPE_CHECKING:
    from viewer.session import Session

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
        """The command's arguments for what is on show, but for where to."""
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
        return [*words, f"--theme={self.theme or session.theme.name}", f"--format={self.format}"]

    def make(self, session: "Session") -> None:
        """Write the figure beside where the program was started; it takes up to some seconds, off this thread."""
        if not session.tree or not session.world or not session.path:
            session.notice.say("nothing to export yet: pick a pixel")
            return
        if self.making:
            return
        from viewer import cli, exporting, targets
        from viewer.figures.formats import FORMATS as KINDS

        words = self.words(session)
        options = cli.make_parser().parse_args([*words, "-o", "."])
        self.command = shlex.join(["raytree", *words])
        self._keep()
        world, lesson = session.world, session.lesson
        stem = f"{targets.stem_of(options, lesson)}_{self.figure}_d{session.depth}"
        path = free(Path(stem + KINDS[self.format].suffix))
        target = targets.Target(path, folder=False)
        worker = ThreadPoolExecutor(1)
        session.notice.say(f"exporting {path.name} ...")
        self.making = worker.submit(exporting.make, options, world, lesson, target, [self.format])
        self.making.add_done_callback(lambda _: session.changed())
        worker.shutdown(wait=False)

    def finish(self, session: "Session") -> bool:
        """Say how it ended, once it has; whether there is anything new to see."""
        if not self.making or not self.making.done():
            return False
        making, self.making = self.making, None
        try:
            made = making.result()
            said = [f"wrote {made.files[0].resolve()}  (Ctrl+C copies its command line)", *made.notes]
            session.notice.say("; ".join(said))
        except Unusable as unusable:
            session.faults = list(unusable.faults)
        except ValueError as error:
            session.faults = [str(error)]
        return True


def free(path: Path) -> Path:
    """This name, or the next with a number that is not taken."""
    names = (path.with_stem(f"{path.stem}-{k}") if k > 1 else path for k in range(1, 10**6))
    return next(name for name in names if not name.exists())
