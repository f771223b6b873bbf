"""Exports the figure on show, by the options of the command that makes it again."""

import contextlib
import json
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from tracer.formats.source import Fault, read_text
from tracer.kernel.world import World
from viewer.base.clipboard import copy_to_clipboard
from viewer.base.files import Unusable, free_path, write_atomically
from viewer.base.options import shell_line, words
from viewer.base.orbit import ViewAngles
from viewer.base.theme import THEMES
from viewer.figures.catalogue import FIGURE_NAMES, FORMATS, PICTURES
from viewer.figures.export_options import ExportOptions
from viewer.reopen.scene_files import SceneFiles
from viewer.session.restore.command import embedded

SHOWN = ""  # in place of a figure's name: that of the panel under the mouse, or scene and tree
HINT = "(Ctrl+Shift+C copies its command line)"


@dataclass(frozen=True)
class Shown:
    """The figure on show: its options of `raytree export` except format and theme, and its scene."""

    options: ExportOptions
    theme: str  # the window's
    world: World
    scene: str  # its name in file names
    view: ViewAngles | None
    files: SceneFiles | None  # carried by the figure
    step: str = ""  # the name of the step in file names

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the image."""
        return (self.world.scene.image.width, self.world.scene.image.height)


class FigureExport:
    """The figure, format and theme that were last chosen, and the export in progress."""

    def __init__(self, post: Callable[[Callable[[], object]], object]) -> None:
        self.post = post  # posts a call to the window's thread
        self.figure = SHOWN
        self.format = "svg"
        self.theme = ""  # empty: the window's
        self.command = ""  # that makes the last figure again
        self.making: Future[str] | None = None
        self.kept: Path | None = None  # file that stores the choice

    def remember(self, path: Path) -> None:
        """Restore the last choice from this file, and store later choices in it."""
        self.kept = path
        try:
            found = json.loads(read_text(path))
            if (
                found["figure"] in (SHOWN, *FIGURE_NAMES)
                and found["format"] in PICTURES
                and found["theme"] in ("", *THEMES)
            ):
                self.figure, self.format, self.theme = found["figure"], found["format"], found["theme"]
        except (OSError, Fault, ValueError, KeyError, TypeError, RecursionError):
            return  # there is no such file, or it is not ours

    def start(
        self, shown: Shown, copied: bool, say: Callable[[str], object], fail: Callable[[list[str]], object]
    ) -> None:
        """Write the figure into the current folder, or copy it, in the background.

        A figure is copied as a picture that can be pasted onto a slide, or as text if it is TikZ. `say` gets notices
        and `fail` faults, in the window's thread.
        """
        if self.making:
            return
        from viewer.figures.targets import Target, stem_of

        name = "png" if copied and self.format != "tikz" else self.format
        theme = self.theme or shown.theme
        # White ink on no ground would be lost on a white slide.
        options = replace(shown.options, format=(name,), theme=theme, ground=THEMES[theme].dark)
        depth = options.depth[-1] if options.depth else 0
        step = f"_{shown.step}" if shown.step else ""
        stem = f"{stem_of(shown.scene, options.pixel)}_{options.figure}_d{depth}{step}"
        target = Target(free_path(Path.cwd() / (stem + FORMATS[name].suffix)), is_folder=False, formats=(name,))
        self.command = shell_line(["raytree", "export", *words(replace(options, output=target.path.name))])
        self._keep()
        say("copying the figure ..." if copied else f"exporting {target.path.name} ...")

        def make() -> str:
            from viewer.figures.export import make

            content = embedded(shown.files, options.state(shown.size)) if shown.files else None
            made = make(options, shown.world, shown.scene, target, shown.view, embedded=content)
            if not copied:
                made.write()
                return "; ".join([f"wrote {target.path.resolve()}  {HINT}", *made.notes])
            ((_, content),) = made.files
            copy_to_clipboard(content.decode("utf-8") if name == "tikz" else content)
            kind = "as TikZ" if name == "tikz" else "as a picture"
            return "; ".join([f"the figure is copied {kind}  {HINT}", *made.notes])

        def finish(future: Future[str]) -> None:
            self.making = None
            try:
                say(future.result())
            except Unusable as unusable:
                fail(list(unusable.faults))
            except ValueError as error:
                fail([str(error)])

        worker = ThreadPoolExecutor(1)  # not the window's thread: it takes up to some seconds
        self.making = worker.submit(make)
        self.making.add_done_callback(lambda future: self.post(lambda: finish(future)))
        worker.shutdown(wait=False)

    def _keep(self) -> None:
        if self.kept:
            choice = {"figure": self.figure, "format": self.format, "theme": self.theme}
            with contextlib.suppress(Unusable):  # then the choice holds for this time only
                write_atomically(self.kept, json.dumps(choice).encode("utf-8"))
