"""The state of the viewer: the scene on show, the picked pixel, the selected ray, and the views.

Only the window's thread changes it. Panels read it and call its methods. It imports no panel and no OpenGL.
"""

import time
from collections.abc import Sequence
from dataclasses import replace

from tracer.compile.numba_private import NOTE
from tracer.kernel.world import World
from tracer.printable import shown_path
from viewer.base.orbit import Frame
from viewer.figures.steps import Step
from viewer.lessons.image_place import pixel_fault
from viewer.lessons.language import wanted
from viewer.lessons.moments import Moment
from viewer.reopen.view_state import ViewState
from viewer.session.call_queue import CallQueue
from viewer.session.figure_export import FigureExport
from viewer.session.guard import Guard
from viewer.session.history import History, Place
from viewer.session.image_renderer import ImageRenderer, Job
from viewer.session.lecture.clock import LessonClock
from viewer.session.lecture.lesson_list import LessonList
from viewer.session.lecture.player import LessonPlayer
from viewer.session.lecture.small_images import SmallImages
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import SceneLoader
from viewer.session.picked import Picked
from viewer.session.refinement import Refinement
from viewer.session.restore.view import restore
from viewer.session.scene_on_show import image_limits
from viewer.session.stepping.recursion import Recursion
from viewer.session.stepping.reveal import Reveal
from viewer.session.verification import Verification
from viewer.session.view_state import Request
from viewer.session.warmup import Warmup


class Session(Picked):
    """One scene, one picked pixel, one selected ray."""

    def __init__(self, languages: Sequence[str] | None = None) -> None:
        """`languages` are those of the lessons, the first one that there is; None: those of the environment."""
        super().__init__()
        self.languages = wanted() if languages is None else languages
        self.guard = Guard(self.show_faults)
        self.calls = CallQueue(self.guard)
        self.requests: list[Request] = []  # to the window
        self.warmup = Warmup(lambda note: self.calls.post(lambda: self.notice.say(note)))
        self.loader = SceneLoader(
            self.calls, self.warmup, self._show, lambda faults: self.show_faults(faults, True), self.languages
        )
        self.image = ImageRenderer(self.calls.post)
        self.small_images = SmallImages(self.calls.post)
        self.lesson_list = LessonList(self.calls.post, languages=self.languages)
        self.refinement = Refinement(self.image)
        self.export = FigureExport(self.calls.post)
        self.verification = Verification(self.calls.post)
        self.reveal = Reveal(lambda: self.tree, lambda: "shadow" in self.shown.kinds)
        self.recursion = Recursion(self.reveal, self.calls.post)
        self.player = LessonPlayer(self)
        self.clock = LessonClock()
        # The scene on show.
        self.faults: list[str] = []  # of the last opened scene or the last action; the last good scene stays on show
        self.faults_in_files = False  # whether they are of the scene's files
        self.notes: list[str] = []  # on the scene on show, until they are closed
        self._good: tuple[World, Opening] | None = None  # the last scene that was drawn without an exception
        self.history = History()
        self.notice.say(NOTE)

    # --- the scene ----------------------------------------------------------------------------------------------------

    def _show(self, world: World, opening: Opening) -> None:
        """Show a scene. If it was on show already, pixel, depth and view stay."""
        is_same = bool(self.world and self.opening and opening.is_of(self.opening))
        again = (is_same or opening.keeps_view) and not opening.sets_view
        self.faults = []
        if world is not self.world:
            self.guard.open_all()
            if not opening.keeps_view:  # otherwise the image stays until the next one has its first tiles
                self.image.forget([scene.world for scene in self.loader.prepared.scenes])
            self.refinement.forget()
        if opening.lesson and not again:
            self.requests.append(Request.SHOW_LESSON)
        self.world, self.opening = world, opening
        self.frame = Frame.of(world)
        self.tree = self.full_tree = None
        tracing = world.scene.tracing
        state = opening.state
        self.model = state.model or tracing.model
        if not again:
            self.depth = tracing.depth if state.depth is None else state.depth
            self.put(state.pixel, opening.between)
            self.selection = state.select
            self.player.is_due = opening.shows_stage
            self.home()
            restore(self, state, opening.note)
        self._check_pixel(again or opening.instead is not None)
        self.notes = world.notes
        if opening.keeps_view:
            self.render()
        if not again and not opening.is_return:
            self.history.add(Place(self._now()))

    def _check_pixel(self, moves: bool) -> None:
        """A pixel outside the image is a fault. If the image has become smaller (`moves`), the pixel moves inside."""
        if not self.pixel:
            return
        inside = self.inside(*self.pixel)
        if inside != self.pixel and not moves:
            step = self.lesson_step
            said = (
                f"{shown_path(self.lesson.path)}: " if self.lesson and step and step.state.pixel == self.pixel else ""
            )
            self.show_faults([said + pixel_fault(self.size, self.pixel)])
            self.put(None)
        elif inside != self.pixel:
            self.put(inside)

    def show_moment(self, opening: Opening) -> None:
        """Show a moment of a lesson: at once if its scene is on show, otherwise when it is loaded."""
        if self.world and self.opening and self.opening.is_of(opening):
            self._show(self.world, replace(opening, files=self.opening.files, figure=self.opening.figure))
            self.loader.opening = self.opening  # what is loaded again when a file is saved
            self.render()
            self.update()
        else:
            self.loader.load(opening)
            if not self.loader.loading:  # it was prepared: no frame is drawn without its rays and its image
                self.update()

    def show_swept(self, opening: Opening) -> None:
        """Show another place of the step's sweep."""
        if opening.step and opening.step.state.sweep and opening.step.state.sweep.is_pixel:
            self.opening = self.loader.opening = opening
            self.put(opening.state.pixel, opening.between)
        else:
            self.loader.load(opening)

    def approve(self) -> None:
        """Keep the scene on show as the last good one. Called after a frame without an exception."""
        if self.world:
            self._good = (self.world, self._now())

    def reject(self) -> bool:
        """After an exception: if the scene on show is new, go back to the last good one. Returns whether it does."""
        if self._good is None or self._good[0] is self.world:
            return False
        self.world = None  # so that pixel and view are set
        self._show(*self._good)
        return True

    def update(self) -> bool:
        """Process the results of background threads since the last frame. Returns whether a redraw is needed."""
        now = time.monotonic()
        news = self.notice.expires() | self.calls.run_posted() | self.reveal.advance(now)
        news |= self.player.sweeping.advance(now)
        faults = self.faults
        self.loader.look()
        news |= self.faults is not faults
        if self.world and self.warmup.ready:
            before = (self.tree, self.image.picture)
            self._update_rays()
            self.guard.run("the image", self._update_image, self.reject)
            news |= before != (self.tree, self.image.picture)
        return news

    def _update_rays(self) -> None:
        def trace() -> None:
            if self.pixel and not self.tree:
                self.trace()
                self.reveal.go_to_asked()
                self.player.show_stage()
            if self.tree:
                self.verification.ask(self.tree)

        def unpick() -> None:
            if not self.reject():
                self.put(None)

        self.guard.run("the rays of this pixel", trace, unpick, closes=False)

    def _update_image(self) -> None:
        assert self.world
        if not self.image.picture:
            self.render()
        if not self.refinement.proceed(self.world, self.limits, self.size, self.model):
            self.render()

    def wait(self) -> float:
        """Seconds until an animation goes on; inf if there is none."""
        return min(self.reveal.wait(time.monotonic()), self.player.sweeping.wait())

    def take_requests(self) -> list[Request]:
        """The requests to the window since the last call."""
        taken, self.requests = self.requests, []
        return taken

    # --- the tree behind a pixel --------------------------------------------------------------------------------------

    def pick(self, x: int, y: int, series: object = None) -> None:
        """Show the tree behind a pixel; outside the image, behind the nearest pixel. The selection stays, if the tree
        has such a ray. The history keeps only the last pixel of one `series`, such as a drag of the mouse.
        """
        pixel = self.inside(x, y) if self.world else None
        if pixel and (pixel != self.pixel or self.between):
            self.put(pixel)
            self.turn_back()
            self.history.add(Place(self._now(), series))
            self.update()

    def select(self, row: int | None) -> None:
        """Select one ray of the tree, or none."""
        if row is None or (self.tree and 0 <= row < len(self.tree)):
            self.selection = self.tree.path(row) if self.tree and row is not None else None
            self.turn_back()
            self.history.note(select=self.selection)
            if row is not None:
                self.requests.append(Request.SHOW_RAY)

    @property
    def step(self) -> Step | None:
        """The step of the tree that is on show; None if the whole tree is."""
        return self.reveal.step

    @property
    def selected_on_show(self) -> int | None:
        """The row of the selected ray; None, too, if the step on show does not have it yet."""
        step, selected = self.step, self.selected
        return None if step and selected not in step.rows else selected

    @property
    def at(self) -> tuple[int, int] | None:
        """The place in the lesson on show: the step, from 1, and the presses after its beginning. None at its first."""
        moment = self.player.moment
        return None if moment == Moment() and self.swept is None else (moment.step + 1, moment.press)

    @property
    def swept(self) -> float | None:
        """How far the sweep of the lesson's step has gone; None: as the presses say, or as the pixel says."""
        sweep = self.player.sweeping.sweep
        return self.opening.state.swept if self.opening and sweep and (self.between or not sweep.is_pixel) else None

    def _now(self) -> Opening:
        """An opening that leads back to the place on show."""
        assert self.opening and self.world
        tracing = {
            "depth": self.depth,
            "model": self.model,
            "up": self.up,
            "sample": self.sample.number(self.world.scene),
        }
        now = ViewState(at=self.at, swept=self.swept, pixel=self.pixel, select=self.selection, **tracing)
        return replace(self.opening, state=now, is_return=True, sets_view=False, note="", instead=None)

    def set_depth(self, depth: int) -> None:
        if max(0, depth) != self.depth:
            self.depth = max(0, depth)
            self._retrace()

    def set_model(self, model: str) -> None:
        if model != self.model:
            self.model = model
            self._retrace()

    def _retrace(self) -> None:
        """Trace the pixel and the image again, with another depth or model."""
        if not self.world or not self.warmup.ready:
            return
        self.tree = None
        self._update_rays()
        self.render()

    # --- the image ----------------------------------------------------------------------------------------------------

    def render(self) -> None:
        """Show the image with the scene's number of samples of each pixel."""
        assert self.world
        self.refinement.current = None
        self.image.show(*self.image_job(self.depth))

    def image_job(self, depth: int) -> Job:
        """The image of the scene on show at this depth."""
        assert self.world
        return (self.world, image_limits(self.world, depth, self.model), self.size)

    def show_faults(self, faults: list[str], in_files: bool = False) -> None:
        """Show faults of an action, or those `in_files`, which are read again when they are saved."""
        self.faults, self.faults_in_files = faults, in_files

    def close(self) -> None:
        for part in (self.warmup, self.image, self.small_images, self.lesson_list, self.loader):
            part.close()
