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
from viewer.panels import PANELS
from viewer.session.layout import Corner
from viewer.session.saving import copy_view
from viewer.session.session import Session
from viewer.session.view_state import Request
from viewer.window import bar, bindings, keys, menu, speaker, style
from viewer.window.backend import Offscreen, Window
from viewer.window.overlays import blank, help, messages, notice, open_dialog, pointer
from viewer.window.second import SecondWindow
from viewer.window.tiles import Tiles

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
        self.tiles = Tiles(session, self.canvas, self._part, self._fulfil)
        self.drawn_state: object = None  # of the surface when it was drawn last
        self.speaker: SecondWindow | None = None
        self.speaker_changed = Changed()
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
            pause = max(0.0, rest - since) if frames_left > 0 or busy else IDLE
            self.surface.wait(min(pause, self.session.wait()))
            news = self.session.update()
            self.each_round()
            self.tell_speaker()
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
        session.player.sweeping.finish()
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
        session.recursion.wait()  # it begins when its panel is drawn
        session.small_images.wait()  # and these with the pieces of a lesson
        if session.calls.run_posted():
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
        self.session.clock.look(self.session.lesson, self.session.player.moment)
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

    def tell_speaker(self) -> None:
        """Draw the speaker's window if its content has changed: with each second, and with each press."""
        session = self.session
        if self.speaker and self.speaker.closing:
            self._toggle_speaker()
        if not self.speaker:
            return
        shown = (session.lesson_step, session.player.moment, session.player.stages, session.appearance.theme)
        if self.speaker_changed((shown, session.clock.seconds, self.speaker.state)):
            window = self.speaker
            session.guard.run("the speaker's window", lambda: window.frame(lambda scale: speaker.draw(session, scale)))

    def _toggle_speaker(self) -> None:
        """Open the speaker's window, or close it."""
        if self.speaker:
            self.speaker.close()
            self.speaker = None
        elif isinstance(self.surface, Window):
            self.speaker, self.speaker_changed = SecondWindow(speaker.TITLE), Changed()
        else:
            self.session.notice.say("there is no screen for a second window")

    def close(self) -> None:
        if self.speaker:
            self._toggle_speaker()
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
        self._part("the help", lambda: help.draw(session, bindings.HELP))
        self._fulfil()
        # In lecture mode, the menu lies over the panels.
        is_lecture = session.appearance.is_lecture_size
        (left, top), size = (room.pos, room.size) if is_lecture else (room.work_pos, room.work_size)
        # In a window that is too small the panels are cut off.
        width = max(size.x, SMALLEST[0])
        height = max(size.y, SMALLEST[1]) - bar.height()
        self.tiles.draw((left, top, width, height))
        session.scroll = 0
        self._part("the bar", lambda: bar.draw(session, left, top + height, width))
        over = self.tiles.places.get(Corner.TOP_LEFT, (left, top, width, height))
        self._part("the notice", lambda: notice.draw(session, over[0], over[1] + over[3], over[2]))
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

    def _fulfil(self) -> None:
        """Fulfil the session's requests."""
        for request in self.session.take_requests():
            self._part("a request", lambda request=request: self._do(request), closes=False)

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
        elif request is Request.SPEAKER:
            self._toggle_speaker()
        elif request is Request.NEXT_PANEL:
            self.tiles.show_next()
        elif request is Request.MAXIMISE:
            self.tiles.maximise()
        else:
            self.tiles.bring_to_front(next(panel for panel in PANELS if panel.request is request))
