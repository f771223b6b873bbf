"""The frame loop: take events, update the session, draw every panel, and sleep while nothing happens."""

import contextlib
import time
from collections.abc import Callable

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from tracer.printable import shown_path
from viewer.base.cached import Changed
from viewer.base.theme import STYLES
from viewer.gl.canvas import Canvas
from viewer.panels import PANELS, bar, blank, help, menu, messages, open_dialog
from viewer.panels.panel import Corner, Panel
from viewer.session.saving import copy_view
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
FRAMES_AFTER_EVENT = 6  # frames drawn after the last event: imgui's tables need some to settle


class App:
    """A window or an offscreen surface, with a session. `frame` draws once; `run` draws until the window is closed."""

    def __init__(self, surface: Window | Offscreen, session: Session) -> None:
        self.surface = surface
        self.session = session
        self.canvas = Canvas(surface.ctx, session)
        self.has_layout = False
        self.resets_layout = False
        self.drawn_state: object = None  # of the surface when it was drawn last
        self.each_round: Callable[[], None] = lambda: None  # called by `run`, some times a second
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
            self.each_round()
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
        """Draw all panels once. A part that fails is reported, and the others go on."""
        began = time.perf_counter()
        guard, caught = self.session.guard, len(self.session.guard.caught)
        guard.run("opening the dropped file", self._take_dropped, closes=False)
        guard.run("the style", self._apply_style)
        self.surface.begin()
        self._draw()
        self.surface.present()
        guard.run("the title", self._set_title)
        self.drawn_state = self.surface.state
        if len(guard.caught) == caught:
            self.session.approve()
        self.canvas.frame_took(time.perf_counter() - began)

    def contents(self) -> dict[str, list[str]]:
        """The names in the window: menus, panels, the legend, and the labels of the rays on show."""
        session, tree = self.session, self.session.tree
        return {
            "menus": list(menu.MENUS),
            "panels": [panel.title for panel in PANELS if panel.exists(session)],
            "legend": [style.label for style in STYLES.values()],
            "rays": [tree.label(i) for i in range(len(tree))] if tree else [],
        }

    def close(self) -> None:
        self.session.close()
        self.canvas.release()
        self.surface.close()

    def _redraw(self) -> None:
        """While the window is being resized, the system keeps the event loop to itself, and asks for each frame."""
        if not self.surface.minimised:
            self.frame()

    def _has_events(self) -> bool:
        """Whether there are input events or dropped files that no frame has processed, or another size or scale of the
        screen.
        """
        events = len(imgui.get_current_context().input_events_queue) > 0 or len(self.surface.dropped) > 0
        return events or self.surface.state != self.drawn_state

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
        self.style_changed.run(wanted, lambda: style.apply(*wanted))

    def _set_title(self) -> None:
        world = self.session.world
        title = f"{shown_path(world.scene.title or self.session.path or '')} – raytree" if world else "raytree"
        self.title_changed.run(title, lambda: self.surface.set_title(title))

    def _draw(self) -> None:
        session = self.session
        room = imgui.get_main_viewport()
        self._part("the keys", lambda: keys.handle(session), closes=False)
        self._part("the menu", self._menu)
        self._part("the dialog", lambda: open_dialog.draw(session))
        self._part("the messages", lambda: messages.draw(session))
        self._part("the help", lambda: help.draw(session, keys.HELP))
        left, top = room.work_pos
        # In a window that is too small the panels are cut off, since imgui would keep reduced panel sizes.
        width = max(room.work_size.x, SMALLEST[0])
        height = max(room.work_size.y, SMALLEST[1]) - bar.height()
        self._part("the layout", lambda: self._dock(left, top, width, height), closes=False)
        for panel in PANELS:
            if panel.exists(session):
                self._panel(panel)
        session.scroll = 0
        for request in session.take_requests():
            self._part("a request", lambda request=request: self._do(request), closes=False)
        self._part("the bar", lambda: bar.draw(session, left, top + height, width))
        if session.is_blank:
            self._part("the black screen", blank.draw)

    def _part(self, name: str, draw: Callable[[], object], closes: bool = True) -> bool:
        """Draw one part. If it fails, imgui's stacks are set back to where they were."""
        state = internal.ErrorRecoveryState()
        internal.error_recovery_store_state(state)

        def recover() -> None:
            io = imgui.get_io()
            io.config_error_recovery_enable_assert = False  # it is known that the stacks do not match
            io.config_error_recovery_enable_debug_log = io.config_error_recovery_enable_tooltip = False
            internal.error_recovery_try_to_recover_state(state)
            io.config_error_recovery_enable_assert = True
            self.session.reject()

        return self.session.guard.run(name, draw, recover, closes)

    def _menu(self) -> None:
        if menu.draw(self.session):
            self.resets_layout = True
            self.session.guard.open_all()

    def _do(self, request: Request) -> None:
        """Fulfil a request of the session."""
        if request is Request.QUIT:
            self.surface.close_requested()
        elif request is Request.OPEN_DIALOG:
            open_dialog.open_dialog()
        elif request is Request.COPY_VIEW:
            copy_view(self.session, self.surface.size)
        elif request is Request.FULL_SCREEN:
            self.surface.toggle_full_screen()
        elif request is Request.NEXT_PANEL:
            self._show_next_panel()
        else:
            panel = next(panel for panel in PANELS if panel.request is request)
            imgui.set_window_focus(panel.title)

    def _show_next_panel(self) -> None:
        """Of the panels that share a place at the lower right, show the one after that on show."""
        panels = [p for p in PANELS if p.place is Corner.BOTTOM_RIGHT and p.exists(self.session)]
        windows = [internal.find_window_by_name(panel.title) for panel in panels]
        shown = next((k for k, window in enumerate(windows) if window and not window.hidden), 0)
        imgui.set_window_focus(panels[(shown + 1) % len(panels)].title)

    def _panel(self, panel: Panel) -> None:
        flags = imgui.WindowFlags_
        still = flags.no_scrollbar | flags.no_scroll_with_mouse if panel.padding else flags.none
        if panel.padding:
            imgui.push_style_var(imgui.StyleVar_.window_padding, panel.padding)
        opened, _ = imgui.begin(panel.title, None, still)
        if panel.padding:
            imgui.pop_style_var()
        if opened and panel.title in self.session.guard.closed:
            imgui.text_wrapped(self.session.guard.closed[panel.title])
        elif opened:
            self._part(panel.title, lambda: panel.draw(self.session, self.canvas))
            if self.session.scroll and not panel.padding:
                lines = self.session.scroll * imgui.get_text_line_height_with_spacing()
                imgui.set_scroll_y(imgui.get_scroll_y() + lines)
        imgui.end()

    def _dock(self, left: float, top: float, width: float, height: float) -> None:
        """The room for the panels. At first, or if it is to be reset, each panel is put in its place."""
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
        if self.resets_layout or (not self.has_layout and internal.dock_builder_get_node(dock) is None):
            self._lay_out(dock, width, height)
        self.has_layout, self.resets_layout = True, False
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
