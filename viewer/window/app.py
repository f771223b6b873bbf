"""The frame loop: events in, the session brought up to date, every panel drawn, and sleep while nothing happens."""

import contextlib
import time
from collections.abc import Callable

from imgui_bundle import imgui
from imgui_bundle.imgui import internal

from viewer.gl.canvas import Canvas
from viewer.panels import PANELS, bar, error, image, lesson, menu, ray, scene, tree
from viewer.session.session import Session
from viewer.window import keys, style
from viewer.window.backend import Offscreen, Window

DOCK = "dock"

IDLE = 0.3  # seconds of sleep between looks at the scene's file
FASTEST = 1 / 60  # seconds between frames, at least: what comes faster is seen by nobody
BUSY = 1 / 30  # the same while an image renders and nothing else happens
SHARE = 0.1  # of the time that frames may take from an image that renders
EAGER = 0.6  # the same while the user does something
SMALLEST = (560, 360)  # room for the panels, in pixels
AFTERGLOW = 3  # frames drawn after the last event: imgui needs one or two to settle


class App:
    """Ties a surface to a session. `frame` draws once; `run` draws for as long as the window is open."""

    def __init__(self, surface: Window | Offscreen, session: Session) -> None:
        self.surface = surface
        self.session = session
        self.canvas = Canvas(surface.ctx, session)
        self.has_layout = False
        self.styled: object = None
        self.title = ""
        session.changed = surface.wake
        session.image.changed = self._image_changed
        if isinstance(surface, Window):
            surface.on_refresh = self._redraw

    def run(self) -> None:
        glow = AFTERGLOW
        drawn = took = 0.0
        while not self.surface.closing and not self.session.wants_quit:
            busy = self._is_busy()
            since = time.perf_counter() - drawn
            rest = self._rest(busy, glow > 0, took)
            self.surface.wait(max(0.0, rest - since) if glow > 0 or busy else IDLE)
            news = self.session.update()
            if news or self._has_events():
                glow = AFTERGLOW
                rest = self._rest(busy, True, took)
            now = time.perf_counter()
            if now - drawn < rest or not (glow > 0 or busy) or self.surface.minimised:
                continue
            glow -= 1
            self.frame()
            drawn = time.perf_counter()
            took = drawn - now

    @staticmethod
    def _rest(busy: bool, glows: bool, took: float) -> float:
        """Seconds between frames, where one takes `took`: not so few that an image gets no time to be made."""
        if glows:
            return max(FASTEST, took / EAGER) if busy else FASTEST
        return max(BUSY, took / SHARE) if busy else IDLE

    def settle(
        self,
        frames: int = 3,
        say: Callable[[str], None] = lambda doing: None,
        progress: Callable[[float], None] = lambda share: None,
    ) -> None:
        """Draw until everything is there: the scene, the first full image, the tree.

        `say` is told what is waited for, `progress` the share of the image.
        """
        session = self.session
        woken = session.image.changed
        session.image.changed = lambda: progress(session.image.picture.share if session.image.picture else 0.0)
        self.frame()  # what every frame needs of the graphics card is compiled while the scene is loaded
        session.warmup.wait()
        say("load the scene")
        while session.loading:
            with contextlib.suppress(Exception):
                session.loading.exception()
            session.update()
        say("render the image")
        session.update()
        self.frame()  # while the image renders: what the graphics card has to compile and to be sent is then there
        session.image.wait()
        session.image.changed = woken
        say("draw the viewer")
        for _ in range(frames):
            self.frame()

    def frame(self) -> None:
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
        """While the window is being resized the system keeps the loop to itself: then it asks for each frame."""
        if not self.surface.minimised:
            self.frame()

    def _image_changed(self) -> None:
        """Frames are drawn while an image renders, at their own pace: only its end is worth waking up for."""
        picture = self.session.image.picture
        if picture and picture.finished:
            self.surface.wake()

    def _has_events(self) -> bool:
        """Whether the user did anything: imgui has been told by its callbacks."""
        return len(_pending_events()) > 0

    def _is_busy(self) -> bool:
        session = self.session
        picture = session.image.picture
        return not session.warmup.ready or session.loading is not None or (picture is not None and not picture.finished)

    def _take_dropped(self) -> None:
        dropped, self.surface.dropped = self.surface.dropped, []
        if dropped:
            menu.open_file(self.session, dropped[-1])

    def _apply_style(self) -> None:
        wanted = (self.session.theme, self.surface.scale, self.session.zoom)
        if wanted != self.styled:
            style.apply(*wanted)
            self.styled = wanted

    def _set_title(self) -> None:
        world = self.session.world
        title = f"{world.scene.title or self.session.path} – raytree" if world else "raytree"
        if title != self.title:
            self.surface.set_title(title)
            self.title = title

    def _draw(self) -> None:
        session = self.session
        keys.handle(session)
        reset = menu.draw(session)
        room = imgui.get_main_viewport()
        left, top = room.work_pos
        # In a window that is too small the panels are cut off, not squeezed: else they would stay squeezed for good.
        width = max(room.work_size.x, SMALLEST[0])
        height = max(room.work_size.y, SMALLEST[1]) - bar.height()
        self._dock(left, top, width, height, reset)
        for panel in filter(lambda panel: panel.exists(session), PANELS):
            self._panel(panel.title, lambda panel=panel: panel.draw(session, self.canvas))
        self._bring_forward()  # after it has come to be
        bar.draw(session, left, top + height, width)

    def _bring_forward(self) -> None:
        """Of panels that share a place, the one that has news."""
        session = self.session
        if session.wants_text:
            imgui.set_window_focus(lesson.TITLE)
        elif session.wants_numbers:
            imgui.set_window_focus(ray.TITLE)
        elif session.wants_error:
            imgui.set_window_focus(error.TITLE)
        session.wants_text = session.wants_numbers = session.wants_error = False

    def _panel(self, title: str, draw: Callable[[], None]) -> None:
        tight = title in (scene.TITLE, image.TITLE, tree.TITLE)
        if tight:
            imgui.push_style_var(imgui.StyleVar_.window_padding, (0, 0) if title == scene.TITLE else (6, 5))
        flags = imgui.WindowFlags_
        still = flags.no_scrollbar | flags.no_scroll_with_mouse if tight else flags.none
        opened, _ = imgui.begin(title, None, still)
        if tight:
            imgui.pop_style_var()
        if opened:
            draw()
        imgui.end()

    def _dock(self, left: float, top: float, width: float, height: float, reset: bool) -> None:
        """The room for the panels, and at first which stands where: the eye's way from the image to the numbers."""
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
        internal.dock_builder_add_node(dock)  # with no central node: then all panels share what a larger window brings
        internal.dock_builder_set_node_size(dock, (width, height))
        _, below, above = internal.dock_builder_split_node_py(dock, imgui.Dir.down, 0.42)
        _, above_right, above_left = internal.dock_builder_split_node_py(above, imgui.Dir.right, 0.44)
        _, below_right, below_left = internal.dock_builder_split_node_py(below, imgui.Dir.right, 0.36)
        place = {
            scene.TITLE: above_left,
            image.TITLE: above_right,
            tree.TITLE: below_left,
            lesson.TITLE: below_right,
            ray.TITLE: below_right,
            error.TITLE: below_right,
        }
        for title, node in place.items():
            internal.dock_builder_dock_window(title, node)
        internal.dock_builder_finish(dock)


def _pending_events() -> list:
    """What imgui's callbacks have noted and no frame has taken up."""
    return list(imgui.get_current_context().input_events_queue)
