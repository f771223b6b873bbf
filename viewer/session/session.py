"""The state of the viewer: the scene on show, the picked pixel, the selected ray, and the views.

Only the window's thread changes it. Panels read it and call its methods. It imports no panel and no OpenGL.
"""

from pathlib import Path

import numpy as np

import tracer
from tracer.choices import MODELS
from tracer.compile.numba_private import NOTE
from tracer.formats import UP_AXES
from tracer.kernel.limits import Limits, image_max_nodes, make_limits
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.clipboard import copy_to_clipboard
from viewer.base.files import Unusable
from viewer.base.orbit import Frame, Orbit, initial_orbit
from viewer.figures.export_options import ExportOptions
from viewer.lessons.lesson import Lesson
from viewer.session.call_queue import CallQueue
from viewer.session.figure_export import FigureExport, Shown
from viewer.session.image_renderer import ImageRenderer
from viewer.session.refinement import Refinement, Strategy
from viewer.session.scene_loader import Opening, SceneLoader
from viewer.session.verification import Verification
from viewer.session.view_state import Appearance, Notice, OpenDialog, PanZoom, Request, Visibility
from viewer.session.warmup import Warmup

LAYOUT_DEPTH = 3  # the tree is laid out for at least this depth, so that no node moves when the depth is stepped 0..3


class Session:
    """One scene, one picked pixel, one selected ray."""

    def __init__(self) -> None:
        self.calls = CallQueue()
        self.requests: list[Request] = []  # to the window
        self.warmup = Warmup(lambda note: self.calls.post(lambda: self.notice.say(note)))
        self.loader = SceneLoader(self.calls, self.warmup, self._show, self.show_faults)
        self.image = ImageRenderer(self.calls.post)
        self.refinement = Refinement(self.image)
        self.export = FigureExport(self.calls.post)
        self.verification = Verification(self.calls.post)
        # How the scene is looked at.
        self.shown = Visibility()
        self.image_view = PanZoom()
        self.tree_view = PanZoom(center=(0.0, 0.0))  # moved by logical pixels
        self.appearance = Appearance()
        self.notice = Notice()
        self.dialog = OpenDialog()
        self.shows_help = False
        # The scene on show.
        self.faults: list[str] = []  # of the last opened scene or the last action; the last good scene stays on show
        self.notes: list[str] = []  # on the scene on show, until they are closed
        self.path: Path | None = None
        self.up = UP_AXES[0]  # of a mesh file
        self.lesson: Lesson | None = None
        self.world: World | None = None
        self.frame = Frame(np.zeros(3), 1.0)
        self.orbit = Orbit()
        self.depth = 3
        self.model = MODELS[0]
        self.pixel: tuple[int, int] | None = None
        self.tree: RayTree | None = None  # of the picked pixel
        self.full_tree: RayTree | None = None  # the same at least LAYOUT_DEPTH deep; `tree` is its first rows
        self.selected: int | None = None
        if NOTE:
            self.notice.say(NOTE)

    # --- the scene ----------------------------------------------------------------------------------------------------

    def _show(self, world: World, opening: Opening) -> None:
        """Show a scene. If it was on show already, pixel, depth and view stay."""
        again = self.world is not None and opening.path == self.path
        self.faults = []
        self.image.forget()
        self.refinement.forget()
        if opening.lesson and self.world and not again:
            self.requests.append(Request.SHOW_LESSON)
        self.world, self.path, self.lesson, self.up = world, opening.path, opening.lesson, opening.up
        self.frame = Frame.of(world)
        self.tree = self.full_tree = None
        tracing = world.scene.tracing
        self.model = opening.model or tracing.model
        if not again:
            self.depth = tracing.depth if opening.depth is None else opening.depth
            self.pixel = opening.pixel
            self.selected = None
            self.image_view = PanZoom()
            self.home()
        self._check_pixel(again)
        self.notes = world.notes

    def _check_pixel(self, moves: bool) -> None:
        """A pixel outside the image is a fault. If the image has become smaller (`moves`), the pixel moves inside."""
        if not self.pixel:
            return
        x, y = self.pixel
        width, height = self.size
        inside = self._inside(x, y)
        if inside != self.pixel and not moves:
            self.faults = [f"pixel must be within 0,0 .. {width - 1},{height - 1}, got {x},{y}"]
            self.pixel = None
        else:
            self.pixel = inside

    def update(self) -> bool:
        """Process the results of background threads since the last frame. Returns whether a redraw is needed."""
        news = self.notice.expires() | self.calls.run_posted()
        self.loader.look()
        if self.world and self.warmup.ready:
            if self.pixel and not self.tree:
                self._trace()
                news = True
            if self.tree:
                self.verification.ask(self.tree)
            if not self.image.picture:
                self.render()
                news = True
            if not self.refinement.proceed(self.world, self.limits, self.size, self.model):
                self.render()
        return news

    def take_requests(self) -> list[Request]:
        """The requests to the window since the last call."""
        taken, self.requests = self.requests, []
        return taken

    # --- the tree behind a pixel --------------------------------------------------------------------------------------

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the image, in pixels."""
        assert self.world
        return (self.world.scene.image.width, self.world.scene.image.height)

    @property
    def limits(self) -> Limits:
        """The limits of the image's trees."""
        assert self.world
        width, height = self.size
        max_nodes = image_max_nodes(self.world, width * height)
        return make_limits(self.world, self.depth, max_nodes=max_nodes, model=self.model, records=False)

    def pick(self, x: int, y: int) -> None:
        """Show the tree behind a pixel; outside the image, behind the nearest pixel."""
        if not self.world:
            return
        pixel = self._inside(x, y)
        if pixel != self.pixel:
            self.pixel = pixel
            self.selected = None
            self.tree = None
            self.update()

    def _inside(self, x: int, y: int) -> tuple[int, int]:
        """The nearest pixel of the image."""
        width, height = self.size
        return (min(max(x, 0), width - 1), min(max(y, 0), height - 1))

    def nudge(self, dx: int, dy: int) -> None:
        """Move the picked pixel. The first time, pick the centre of the image."""
        if not self.world:
            return
        width, height = self.size
        x, y = self.pixel or (width // 2 - dx, height // 2 - dy)
        self.pick(x + dx, y + dy)

    def select(self, row: int | None) -> None:
        """Select one ray of the tree, or none."""
        if row is None or (self.tree and 0 <= row < len(self.tree)):
            self.selected = row
            if row is not None:
                self.requests.append(Request.SHOW_RAY)

    def clear(self) -> None:
        """Unselect the ray; if none is selected, unpick the pixel."""
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
        """Select the next ray in the order of the table, or the previous one."""
        if self.tree:
            row = (-1 if by > 0 else len(self.tree)) if self.selected is None else self.selected
            self.select(min(max(row + by, 0), len(self.tree) - 1))

    def _retrace(self) -> None:
        """Trace the pixel and the image again, with another depth or model."""
        if not self.world or not self.warmup.ready:
            return
        if self.pixel:
            self._trace()
        if self.selected is not None and self.tree and self.selected >= len(self.tree):
            self.selected = None
        self.render()

    def _trace(self) -> None:
        assert self.world and self.pixel
        options = {"pixel": self.pixel, "model": self.model, "max_nodes": self.limits.max_nodes}
        self.tree = tracer.trace(self.world, depth=self.depth, **options)
        deeper = max(self.depth, LAYOUT_DEPTH)
        self.full_tree = self.tree if deeper == self.depth else tracer.trace(self.world, depth=deeper, **options)

    # --- the image ----------------------------------------------------------------------------------------------------

    def render(self) -> None:
        """Show the image with one sample per pixel."""
        assert self.world
        self.refinement.current = None
        self.image.show(self.world, self.limits, self.size)

    def toggle_refinement(self) -> None:
        """Give pixels more samples, or pause."""
        self.refinement.toggle()
        if self.refinement.is_running:
            self.requests.append(Request.SHOW_ERROR)

    def set_strategy(self, strategy: Strategy) -> None:
        """Distribute samples in another way. The curves of the other strategies stay for comparison."""
        changed, self.refinement.strategy = strategy != self.refinement.strategy, strategy
        if changed and self.refinement.is_running and self.world:
            self.render()

    # --- figures ------------------------------------------------------------------------------------------------------

    def export_figure(self, copied: bool = False) -> None:
        """Write the figure on show into the current folder, or copy it."""
        if not self.tree or not self.world or not self.path:
            self.notice.say("nothing to export yet: pick a pixel")
            return
        figure, lesson = self.export.figure, self.lesson
        options = ExportOptions(
            scene=lesson.name if lesson else str(self.path),
            pixel=self.pixel,
            figure=figure,
            view=self.orbit.view(self.frame) if figure in ("both", "scene") else None,
            node=str(self.selected or 0) if figure == "hit" else None,
            depth=range(self.depth, self.depth + 1),
            model=self.model,
            no_lights="shadow" not in self.shown.kinds,
            up=self.up,
            output=".",
        )
        name, angles = (lesson.name, lesson.view) if lesson else (self.path.stem, None)
        shown = Shown(options, self.appearance.theme.name, self.world, name, angles)
        self.export.start(shown, copied, self.notice.say, self.show_faults)

    def copy_command(self) -> None:
        """Copy the command line of the last figure."""
        if not self.export.command:
            self.notice.say("no command line to copy yet: export a figure first")
            return
        try:
            copy_to_clipboard(self.export.command)
            self.notice.say("the figure's command line is copied")
        except Unusable as unusable:
            self.show_faults(list(unusable.faults))

    def show_faults(self, faults: list[str]) -> None:
        self.faults = faults

    # --- how it is looked at ------------------------------------------------------------------------------------------

    def home(self) -> None:
        """Reset the 3D view."""
        if not self.world:
            return
        self.orbit = initial_orbit(self.world, self.frame, self.lesson.view if self.lesson else None)

    def through_camera(self) -> None:
        """Look at the scene from its own camera."""
        if self.world:
            view = self.world.view()
            self.orbit = Orbit.of_camera(view, self.world.scene.camera.up, self.frame.inside(view.eye))

    def toggle_kind(self, kind: str) -> None:
        self.shown.kinds ^= {kind}

    def close(self) -> None:
        self.warmup.close()
        self.image.close()
        self.loader.close()
