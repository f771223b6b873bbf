"""The frame loop: take events, update the session, draw every panel, and sleep while nothing happens."""

import contextlib
import time
from collections.abc import Callable

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tracer.printable import shown_path
from viewer.base.cached import Changed
from viewer.gl.canvas import Canvas
from viewer.panels import PANELS, bar, help, menu, messages, open_dialog
from viewer.panels.panel import Corner, Panel
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window import keys, style
from viewer.window.backend import Offscreen, Window

DOCK = "dock"

IDLE = 0.3  # seconds of sleep between polls of the scene's file
FASTEST = 1 / 60  # least seconds between frames
BUSY = 1 / 30  # the same while an image renders and nothing else happens
SHARE = 0.1  # largest share of the time for drawing frames while an image renders
EAGER = 0.6  # the same while the user does something
SMALLEST = (560, 360)  # room for the panels, in pixels
FRAMES_AFTER_EVENT = 3  # frames drawn after the last event: imgui needs one or two to settle


class App:
    """A window or an offscreen surface, with a session. `frame` draws once; `run` draws until the window is closed."""

    def __init__(self, surface: Window | Offscreen, session: Session) -> None:
        self.surface = surface
        self.session = session
        self.canvas = Canvas(surface.ctx, session)
        self.has_layout = False
        self.style_changed = Changed()
        self.title_changed = Changed()
        session.calls.wake = surface.wake
        if isinstance(surface, Window):
            surface.on_refresh = self._redraw

    def run(self) -> None:
        frames_left = FRAMES_AFTER_EVENT
        drawn = took = 0.0
        while not self.is_over():
            busy = self._is_busy()
            since = time.perf_counter() - drawn
            rest = self._rest(busy, frames_left > 0, took)
            self.surface.wait(max(0.0, rest - since) if frames_left > 0 or busy else IDLE)
            news = self.session.update()
            if news or self._has_events():
                frames_left = FRAMES_AFTER_EVENT
                rest = self._rest(busy, True, took)
            now = time.perf_counter()
            if now - drawn < rest or not (frames_left > 0 or busy) or self.surface.minimised:
                continue
            frames_left -= 1
            self.frame()
            drawn = time.perf_counter()
            took = drawn - now

    def is_over(self) -> bool:
        """Whether the window is to be closed."""
        return self.surface.closing

    @staticmethod
    def _rest(busy: bool, glows: bool, took: float) -> float:
        """Seconds between frames that take `took` each: long enough to leave an image time to render."""
        if glows:
            return max(FASTEST, took / EAGER) if busy else FASTEST
        return max(BUSY, took / SHARE) if busy else IDLE

    def settle(
        self,
        frames: int = 3,
        say: Callable[[str], None] = lambda doing: None,
        progress: Callable[[float], None] = lambda share: None,
    ) -> None:
        """Draw until the scene, the first full image and the tree are finished.

        `say` is called with what is waited for, `progress` with the share of the image.
        """
        session = self.session
        session.image.progress = lambda: progress(session.image.picture.share if session.image.picture else 0.0)
        self.frame()  # compiles the shaders while the scene is loaded
        session.warmup.wait()
        say("load the scene")
        while session.loader.loading:
            with contextlib.suppress(Exception):
                session.loader.loading.exception()
            session.update()
        say("render the image")
        session.update()
        self.frame()  # compiles and sends what the scene needs while the image renders
        session.image.wait()
        session.image.progress = lambda: None
        session.verification.wait()
        session.update()
        say("draw the viewer")
        for _ in range(frames):
            self.frame()

    def frame(self) -> None:
        """Draw all panels once."""
        began = time.perf_counter()
        self._take_dropped()
        self._apply_style()
        self.surface.begin()
        self._draw()
        self.surface.present()
        self._set_title()
        self.canvas.frame_took(time.perf_counter() - began)

    def close(self) -> None:
        self.session.close()
        self.canvas.release()
        self.surface.close()

    def _redraw(self) -> None:
        """While the window is being resized, the system keeps the event loop to itself, and asks for each frame."""
        if not self.surface.minimised:
            self.frame()

    def _has_events(self) -> bool:
        """Whether there are input events, or dropped files, that no frame has processed."""
        return len(imgui.get_current_context().input_events_queue) > 0 or len(self.surface.dropped) > 0

    def _is_busy(self) -> bool:
        session = self.session
        picture = session.image.picture
        loads = session.loader.loading is not None
        renders = picture is not None and not picture.finished
        return not session.warmup.ready or loads or renders or session.verification.is_running

    def _take_dropped(self) -> None:
        """Open the file that was dropped on the window."""
        dropped, self.surface.dropped = self.surface.dropped, []
        if dropped:
            self.session.loader.open(dropped[-1])

    def _apply_style(self) -> None:
        wanted = (self.session.appearance.theme, self.surface.scale, self.session.appearance.text_zoom)
        if self.style_changed(wanted):
            style.apply(*wanted)

    def _set_title(self) -> None:
        world = self.session.world
        title = f"{shown_path(world.scene.title or self.session.path or '')} – raytree" if world else "raytree"
        if self.title_changed(title):
            self.surface.set_title(title)

    def _draw(self) -> None:
        session = self.session
        keys.handle(session)
        reset = menu.draw(session)
        open_dialog.draw(session)
        messages.draw(session)
        help.draw(session, keys.HELP)
        room = imgui.get_main_viewport()
        left, top = room.work_pos
        # In a window that is too small the panels are cut off, since imgui would keep reduced panel sizes.
        width = max(room.work_size.x, SMALLEST[0])
        height = max(room.work_size.y, SMALLEST[1]) - bar.height()
        self._dock(left, top, width, height, reset)
        for panel in PANELS:
            if panel.exists(session):
                self._panel(panel)
        for request in session.take_requests():
            self._do(request)
        bar.draw(session, left, top + height, width)

    def _do(self, request: Request) -> None:
        """Fulfil a request of the session."""
        if request is Request.QUIT:
            self.surface.close_requested()
        elif request is Request.OPEN_DIALOG:
            open_dialog.open_dialog()
        else:
            panel = next(panel for panel in PANELS if panel.request is request)
            imgui.set_window_focus(panel.title)

    def _panel(self, panel: Panel) -> None:
        flags = imgui.WindowFlags_
        still = flags.no_scrollbar | flags.no_scroll_with_mouse if panel.padding else flags.none
        if panel.padding:
            imgui.push_style_var(imgui.StyleVar_.window_padding, panel.padding)
        opened, _ = imgui.begin(panel.title, None, still)
        if panel.padding:
            imgui.pop_style_var()
        if opened:
            panel.draw(self.session, self.canvas)
        imgui.end()

    def _dock(self, left: float, top: float, width: float, height: float, reset: bool) -> None:
        """The room for the panels. At first, or after `reset`, each panel is put in its place."""
        imgui.set_next_window_pos((left, top))
        imgui.set_next_window_size((width, height))
        flags = imgui.WindowFlags_
        imgui.push_style_var(imgui.StyleVar_.window_padding, (0, 0))
        imgui.begin(
            "##room", None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_bring_to_front_on_focus
            | flags.no_nav_focus | flags.no_background,
        )  # fmt: skip
        imgui.pop_style_var()
        dock = imgui.get_id(DOCK)
        if reset or (not self.has_layout and internal.dock_builder_get_node(dock) is None):
            self._lay_out(dock, width, height)
        self.has_layout = True
        imgui.dock_space(dock)
        imgui.end()

    def _lay_out(self, dock: int, width: float, height: float) -> None:
        internal.dock_builder_remove_node(dock)
        internal.dock_builder_add_node(dock)  # without a central node, so that all panels share a larger window
        internal.dock_builder_set_node_size(dock, (width, height))
        _, below, above = internal.dock_builder_split_node_py(dock, imgui.Dir.down, 0.42)
        _, top_right, top_left = internal.dock_builder_split_node_py(above, imgui.Dir.right, 0.44)
        _, bottom_right, bottom_left = internal.dock_builder_split_node_py(below, imgui.Dir.right, 0.36)
        nodes = {
            Corner.TOP_LEFT: top_left,
            Corner.TOP_RIGHT: top_right,
            Corner.BOTTOM_LEFT: bottom_left,
            Corner.BOTTOM_RIGHT: bottom_right,
        }
        for panel in PANELS:
            internal.dock_builder_dock_window(panel.title, nodes[panel.place])
        internal.dock_builder_finish(dock)
