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
from viewer.panels import PANELS, bar, blank, draw as d, frame, help, menu, messages, notice, open_dialog, pointer
from viewer.panels.panel import Panel
from viewer.session.layout import GAP, Arrangement, Corner, Rectangle, desk, lecture, tile
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window import keys, style
from viewer.window.backend import Offscreen, Window

IDLE = 0.3  # seconds of sleep between polls of the scene's file
FASTEST = 1 / 60  # least seconds between frames
BUSY = 1 / 30  # the same while an image renders and nothing else happens
SHARE = 0.1  # largest share of the time for drawing frames while an image renders
EAGER = 0.6  # the same while the user does something
SMALLEST = (560, 360)  # room for the panels, in pixels
SLIDE = (1280, 720)  # size of a window, in logical pixels, for which the sizes of text are chosen
FRAMES_AFTER_EVENT = 6  # frames drawn after the last event: imgui's tables need some to settle


class App:
    """A window or an offscreen surface, with a session. `frame` draws once; `run` draws until the window is closed."""

    def __init__(self, surface: Window | Offscreen, session: Session) -> None:
        self.surface = surface
        self.session = session
        self.canvas = Canvas(surface.ctx, session)
        self.places: dict[Corner, Rectangle] = {}  # of the panels, when they were drawn last
        self.drawn_state: object = None  # of the surface when it was drawn last
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
            pause = max(0.0, rest - since) if frames_left > 0 or busy else IDLE
            self.surface.wait(min(pause, self.session.reveal.wait(time.monotonic())))  # the next step of an animation
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
        appearance = self.session.appearance
        zoom = appearance.text_zoom
        if appearance.is_lecture_size:  # as on a slide: the larger the window, the larger the text
            size = imgui.get_io().display_size
            zoom *= max(1.0, min(size.x / SLIDE[0], size.y / SLIDE[1]) / self.surface.scale)
        wanted = (appearance.theme, self.surface.scale, zoom)
        self.style_changed.run(wanted, lambda: style.apply(*wanted))

    def _set_title(self) -> None:
        world = self.session.world
        title = f"{shown_path(world.scene.title or self.session.path or '')} – raytree" if world else "raytree"
        self.title_changed.run(title, lambda: self.surface.set_title(title))

    def _draw(self) -> None:
        session = self.session
        room = imgui.get_main_viewport()
        self._part("the keys", lambda: keys.handle(session), closes=False)
        self._part("the menu", lambda: menu.draw(session))
        self._part("the dialog", lambda: open_dialog.draw(session))
        self._part("the messages", lambda: messages.draw(session))
        self._part("the help", lambda: help.draw(session, keys.HELP))
        # In lecture mode, the menu lies over the panels.
        is_lecture = session.appearance.is_lecture_size
        (left, top), size = (room.pos, room.size) if is_lecture else (room.work_pos, room.work_size)
        # In a window that is too small the panels are cut off.
        width = max(size.x, SMALLEST[0])
        height = max(size.y, SMALLEST[1]) - bar.height()
        self._panels((left, top, width, height))
        session.scroll = 0
        for request in session.take_requests():
            self._part("a request", lambda request=request: self._do(request), closes=False)
        self._part("the bar", lambda: bar.draw(session, left, top + height, width))
        self._part("the notice", lambda: notice.draw(session, left, top + height, width))
        self._part("the pointer", lambda: pointer.draw(session))
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

    def _do(self, request: Request) -> None:
        """Fulfil a request of the session."""
        if request is Request.QUIT:
            self.surface.close_requested()
        elif request is Request.OPEN_DIALOG:
            open_dialog.open_dialog()
        elif request is Request.NEXT_PANEL:
            self._show_next_panel()
        elif request is Request.MAXIMISE:
            self._maximise()
        else:
            self._bring_to_front(next(panel for panel in PANELS if panel.request is request))

    def _front(self, place: Corner) -> tuple[list[Panel], Panel]:
        """The panels of a place, and the one in front."""
        panels = self._sharing()[place]
        chosen = self._arrangement.front.get(place)
        return panels, next((panel for panel in panels if panel.title == chosen), panels[0])

    @property
    def _arrangement(self) -> Arrangement:
        return self.session.layout.current(self.session.appearance.is_lecture_size)

    def _bring_to_front(self, panel: Panel) -> None:
        """Show a panel. The selected ray does not cover a panel that shows it, too."""
        place = panel.place_in(self.session)
        _, front = self._front(place)
        if panel.request is not Request.SHOW_RAY or not front.shows_ray:
            self._arrangement.front[place] = panel.title

    def _show_next_panel(self) -> None:
        """Of the panels that share a place at the lower right, show the one after that on show."""
        panels, front = self._front(Corner.BOTTOM_RIGHT)
        self._arrangement.front[Corner.BOTTOM_RIGHT] = panels[(panels.index(front) + 1) % len(panels)].title

    def _maximise(self) -> None:
        """Give the panel under the mouse all of the room, or give it back."""
        layout, mouse = self.session.layout, imgui.get_mouse_pos()
        if layout.maximised:
            layout.maximise(layout.maximised)
            return
        for place, (left, top, width, height) in self.places.items():
            if left <= mouse.x < left + width and top <= mouse.y < top + height:
                layout.maximise(self._front(place)[1].title)

    def _panels(self, room: Rectangle) -> None:
        """The panel in front of each place, or the one that has all of the room."""
        session = self.session
        layout, sharing = session.layout, self._sharing()
        arrangement = layout.current(session.appearance.is_lecture_size)
        alone = next((p for panels in sharing.values() for p in panels if p.title == layout.maximised), None)
        if alone:
            self.places, borders = {alone.place_in(session): room}, {}
        else:
            self.places, borders = tile(arrangement, set(sharing), room, GAP * d.unit())
        layout.on_show = set(self.places)
        self._part("the borders", lambda: self._borders(arrangement, borders, room), closes=False)
        # The scene comes last: it shows at once what is picked in the image, or selected in the tree.
        for place, where in sorted(self.places.items(), key=lambda item: item[0] is Corner.TOP_LEFT):
            panels = [alone] if alone else sharing[place]
            front = alone or next((p for p in panels if p.title == arrangement.front.get(place)), panels[0])
            frame.draw(session, panels, front, where, lambda front=front: self._panel(front))

    def _sharing(self) -> dict[Corner, list[Panel]]:
        """The panels of each place."""
        found: dict[Corner, list[Panel]] = {}
        for panel in PANELS:
            if panel.exists(self.session):
                found.setdefault(panel.place_in(self.session), []).append(panel)
        return found

    def _panel(self, panel: Panel) -> None:
        closed = self.session.guard.closed.get(panel.title)
        if closed:
            imgui.text_wrapped(closed)
        else:
            self._part(panel.title, lambda: panel.draw(self.session, self.canvas))

    def _borders(self, arrangement: Arrangement, borders: dict[int | None, Rectangle], room: Rectangle) -> None:
        """The borders between places, which can be dragged. A double click puts one back."""
        imgui.set_next_window_pos(room[:2])
        imgui.set_next_window_size(room[2:])
        flags = imgui.WindowFlags_
        imgui.push_style_color(imgui.Col_.window_bg, self.session.appearance.theme.ground)
        imgui.begin(
            "##room", None, flags.no_decoration | flags.no_move | flags.no_docking | flags.no_saved_settings
            | flags.no_bring_to_front_on_focus | flags.no_nav,
        )  # fmt: skip
        imgui.pop_style_color()
        internal.bring_window_to_display_back(internal.get_current_window())
        for which, (left, top, width, height) in borders.items():
            imgui.set_cursor_screen_pos((left, top))
            imgui.invisible_button(f"border {which}", (width, height))
            if imgui.is_item_hovered() or imgui.is_item_active():
                shapes = imgui.MouseCursor_
                imgui.set_mouse_cursor(shapes.resize_ew if which is None else shapes.resize_ns)
                ink = imgui.get_color_u32(self.session.appearance.theme.accent)
                imgui.get_window_draw_list().add_rect_filled((left, top), (left + width, top + height), ink)
            if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
                at_first = lecture() if self.session.appearance.is_lecture_size else desk()
                arrangement.reset_split(which, at_first)
            elif imgui.is_item_active():
                mouse = imgui.get_mouse_pos()
                share = (mouse.x - room[0]) / room[2] if which is None else (mouse.y - room[1]) / room[3]
                arrangement.split(which, share)
        imgui.end()
