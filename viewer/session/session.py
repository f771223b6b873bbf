"""What is on show: the only state that changes. Panels read it and call its methods; it knows no panel and no GPU."""

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np

import tracer
from tracer.kernel.limits import MODELS, Limits, make_limits
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame, Orbit, home
from viewer.base.theme import DARK, LECTURE_ZOOM, LIGHT, Theme
from viewer.lessons.lesson import Lesson
from viewer.session.convergence import Convergence
from viewer.session.figure_export import TakeHome
from viewer.session.progressive import Picture, Progressive
from viewer.session.view_state import Look, Notice, Shown
from viewer.session.warmup import Warmup
from viewer.session.watch import Watch

STEP_DEPTH = 3  # trees are laid out for at least this depth, so that stepping 0..3 moves nothing
MOST_ROWS = 20_000  # of a tree in the window; the command line has no such limit


class Session:
    """One scene, one picked pixel, one selected ray."""

    def __init__(self, changed: Callable[[], None] = lambda: None) -> None:
        self.changed = changed
        self.warmup = Warmup()
        self.loader = ThreadPoolExecutor(1)
        self.loading: Future | None = None
        self.image = Progressive(changed)
        self.convergence = Convergence()
        self.watch = Watch()
        self.shown = Shown()
        self.image_view = Look()
        self.tree_view = Look(center=(0.0, 0.0))  # moved by logical pixels
        self.theme: Theme = DARK
        self.zoom = 1.0  # of all text
        self.path: Path | None = None
        self.lesson: Lesson | None = None
        self.attempt: tuple[Path, Lesson | None] | None = None  # what was last to be opened, well or not
        self.faults: list[str] = []  # of the file that could not be shown; the last good scene stays
        self.world: World | None = None
        self.frame = Frame(np.zeros(3), 1.0)
        self.orbit = Orbit()
        self.depth = 3
        self.model = MODELS[0]
        self.pixel: tuple[int, int] | None = None
        self.tree: RayTree | None = None  # of the picked pixel at the depth on show
        self.full_tree: RayTree | None = None  # the same pixel, at least STEP_DEPTH deep: its first rows are `tree`'s
        self.selected: int | None = None
        self.seen_finished: Picture | None = None  # the finished image that the last update knew of
        self.notice = Notice()
        self.takehome = TakeHome()
        self.shows_help = False
        self.wants_open = False  # the dialog that opens a scene
        self.wants_quit = False
        self.wants_numbers = False  # the panel of the selected ray is to come to the front
        self.wants_text = False  # the lesson's is
        self.wants_error = False  # that of the error against time is
        self.folder: Path | None = None  # which that dialog shows
        self.not_found = ""  # what was typed into it
        self.wanted_pixel: tuple[int, int] | None = None  # to be picked once the scene is there
        self.wanted_depth: int | None = None
        self.wanted_model: str | None = None

    # --- opening scenes ---------------------------------------------------------------------------------------------

    def open(
        self,
        path: Path,
        lesson: Lesson | None = None,
        depth: int | None = None,
        pixel: tuple[int, int] | None = None,
        model: str | None = None,
    ) -> None:
        """Load a scene in the background; until it is there, and if it has faults, what is on show stays."""
        self.wanted_depth = depth if depth is not None else lesson.depth if lesson else None
        self.wanted_pixel = pixel or (lesson.pixel if lesson else None)
        self.wanted_model = model
        self._load(path, lesson)

    def reload(self) -> None:
        """Read the file once more; of a scene that is on show already, pixel, depth and view stay."""
        if self.attempt:
            self._load(*self.attempt)

    def _load(self, path: Path, lesson: Lesson | None) -> None:
        self.attempt = (path, lesson)
        self.watch.follow(path)
        if self.loading:
            self.loading.cancel()
        again = self.world is not None and path == self.path

        def load() -> tuple:
            world = tracer.prepare(tracer.load(path))
            return world, path, lesson, again, world.notes

        self.loading = self.loader.submit(self._and_tell, load)

    def _and_tell(self, load: Callable[[], tuple]) -> tuple:
        if not self.warmup.ready and self.warmup.compiles:
            self.warmup.wait()  # what prepares a large scene is being compiled as well
        try:
            return load()
        finally:
            threading.Timer(0.0, self.changed).start()  # after the future is done

    def update(self) -> bool:
        """Take in what happened in the background since the last frame; whether there is anything new to see."""
        news = self.notice.passes() | self.takehome.finish(self)
        if self.watch.changed():
            self.reload()
        if self.loading and self.loading.done():
            self._finish_loading(self.loading)
            self.loading = None
            news = True
        if self.world and self.warmup.ready and self.pixel and not self.tree:
            self._trace()
            news = True
        if self.world and self.warmup.ready and not self.image.picture:
            self.render()
            news = True
        self.convergence.go_on(self)
        picture = self.image.picture
        finished = picture if picture and picture.finished else None
        if finished is not self.seen_finished:
            self.seen_finished = finished
            news = True
        return news

    def _finish_loading(self, loading: Future) -> None:
        try:
            world, path, lesson, again, notes = loading.result()
        except tracer.SceneError as error:
            self.faults = error.faults
            return
        except Exception as error:  # a fault of ours must not end a lecture: it is shown, the last scene stays
            self.faults = [f"{type(error).__name__}: {error}"]
            return
        self.faults = []
        scene = world.scene
        self.image.forget()
        self.convergence.forget()
        self.wants_text = lesson is not None and self.world is not None and not again
        self.world, self.path, self.lesson = world, path, lesson
        self.watch.follow_meshes(path, scene)
        self.frame = Frame.of(world)
        self.tree = self.full_tree = None
        self.model = self.wanted_model or scene.tracing.model
        if not again:
            self.depth = scene.tracing.depth if self.wanted_depth is None else self.wanted_depth
            self.pixel = self.wanted_pixel
            self.selected = None
            self.image_view = Look()
            self.home()
        self._check_pixel(again)
        for note in notes[:1]:
            self.notice.say(note)

    def _check_pixel(self, moves: bool) -> None:
        """A pixel that is outside the image is a fault; but where the image has become smaller, it moves inside."""
        if not self.pixel:
            return
        x, y = self.pixel
        width, height = self.size
        inside = (min(max(x, 0), width - 1), min(max(y, 0), height - 1))
        if inside != self.pixel and not moves:
            self.faults = [f"pixel must be within 0,0 .. {width - 1},{height - 1}, got {x},{y}"]
            self.pixel = None
        else:
            self.pixel = inside

    # --- the tree behind a pixel --------------------------------------------------------------------------------------

    @property
    def size(self) -> tuple[int, int]:
        """Of the image, in pixels."""
        assert self.world
        return (self.world.scene.image.width, self.world.scene.image.height)

    @property
    def limits(self) -> Limits:
        """Of the image's trees."""
        assert self.world
        return make_limits(self.world, self.depth, model=self.model, records=False)

    def pick(self, x: int, y: int) -> None:
        """Show the tree behind this pixel; outside the image the nearest one counts."""
        if not self.world:
            return
        width, height = self.size
        pixel = (min(max(x, 0), width - 1), min(max(y, 0), height - 1))
        if pixel != self.pixel:
            self.pixel = pixel
            self.selected = None
            self.tree = None
            self.update()

    def nudge(self, dx: int, dy: int) -> None:
        """Move the picked pixel; the first nudge picks the middle of the image."""
        if not self.world:
            return
        width, height = self.size
        x, y = self.pixel or (width // 2 - dx, height // 2 - dy)
        self.pick(x + dx, y + dy)

    def select(self, row: int | None) -> None:
        """Select one ray of the tree, or none."""
        if row is None or (self.tree and 0 <= row < len(self.tree)):
            self.selected = row
            self.wants_numbers = row is not None

    def clear(self) -> None:
        """First nothing is selected, then nothing is picked."""
        if self.selected is not None:
            self.selected = None
        else:
            self.pixel = self.tree = self.full_tree = None

    def set_depth(self, depth: int) -> None:
        depth = max(0, depth)
        if depth != self.depth:
            self.depth = depth
            self._retrace()

    def set_model(self, model: str) -> None:
        if model != self.model:
            self.model = model
            self._retrace()

    def toggle_model(self) -> None:
        self.set_model(MODELS[1 - MODELS.index(self.model)])

    def step(self, by: int) -> None:
        """Select the next ray in the order of the table, or the one before."""
        if self.tree:
            row = (-1 if by > 0 else len(self.tree)) if self.selected is None else self.selected
            self.select(min(max(row + by, 0), len(self.tree) - 1))

    def _retrace(self) -> None:
        """The same pixel and image by other rules; the selected ray stays selected while it is there."""
        if not self.world or not self.warmup.ready:
            return
        if self.pixel:
            self._trace()
        if self.selected is not None and self.tree and self.selected >= len(self.tree):
            self.selected = None
        self.render()

    def _trace(self) -> None:
        assert self.world and self.pixel
        options = {"pixel": self.pixel, "model": self.model, "max_nodes": MOST_ROWS}
        self.tree = tracer.trace(self.world, depth=self.depth, **options)
        deeper = max(self.depth, STEP_DEPTH)
        self.full_tree = self.tree if deeper == self.depth else tracer.trace(self.world, depth=deeper, **options)

    def render(self) -> None:
        """The image of one ray a pixel, as it is now to be seen."""
        assert self.world
        self.convergence.current = None
        self.image.show(self.world, self.limits, self.size)

    # --- how it is looked at ------------------------------------------------------------------------------------------

    def home(self) -> None:
        """The 3D view as the lesson or the scene begins."""
        if not self.world:
            return
        self.orbit = home(self.world, self.frame, self.lesson.view if self.lesson else None)

    def through_camera(self) -> None:
        """Look at the scene from where its own camera stands."""
        if self.world:
            view = self.world.view()
            self.orbit = Orbit.of_camera(view, self.world.scene.camera.up, self.frame.inside(view.eye))

    def toggle_kind(self, kind: str) -> None:
        self.shown.kinds ^= {kind}

    def toggle_theme(self) -> None:
        self.theme = LIGHT if self.theme is DARK else DARK

    @property
    def is_lecture_size(self) -> bool:
        return self.zoom > 1.0

    def toggle_lecture_size(self) -> None:
        """Everything larger, for the last row."""
        self.zoom = 1.0 if self.is_lecture_size else LECTURE_ZOOM

    def close(self) -> None:
        self.warmup.close()
        self.image.close()
        self.loader.shutdown(wait=False, cancel_futures=True)
