"""The only file that uses glfw and imgui's backend: a window on a screen, or an offscreen surface.

Both have an OpenGL context, feed imgui, and present what it drew. `imgui_bundle` is imported before `glfw`, so that
both use the same copy of that library on systems where each brings its own.
"""

import contextlib
import ctypes
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

# isort: off
import glfw

# isort: on
import moderngl
import numpy as np
from imgui_bundle import imgui, implot
from imgui_bundle.imgui import backends

from viewer.base.files import Unusable, write_atomically
from viewer.figures.writers.imgui_atlas import forget_images
from viewer.session.restore.last_session import WindowPlace
from viewer.window.fonts import load_fonts
from viewer.window.screens import is_reachable, screen_of

GLSL = "#version 330"
SMALLEST = (480, 320)  # of a window, in its own units


class NoWindow(Exception):
    """No window can be opened, or not even a picture can be drawn without one. The text says why."""


NO_GRAPHICS = "OpenGL 3.3 is not available (on Debian: install the packages libegl1, libgl1 and libgl1-mesa-dri)"


class Surface:
    """The common part of window and offscreen surface: imgui's context, and reading the picture."""

    ctx: moderngl.Context

    def _start_imgui(self, ini: Path | None) -> None:
        imgui.create_context()
        implot.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")  # imgui would write the file in place, and an interrupted run would leave a part of it
        self.ini = ini
        if ini:
            with contextlib.suppress(OSError, ValueError):
                imgui.load_ini_settings_from_memory(ini.read_text("utf-8"))
        io.config_flags |= imgui.ConfigFlags_.docking_enable
        io.config_windows_move_from_title_bar_only = True
        io.config_error_recovery_enable_assert = True
        load_fonts()

    def _end_imgui(self) -> None:
        implot.destroy_context()
        imgui.destroy_context()
        forget_images()

    def keep_layout(self) -> None:
        """Store the places of the panels, if there is a file for them, and it can be written."""
        if self.ini:
            with contextlib.suppress(Unusable):  # then they hold for this time only
                write_atomically(self.ini, imgui.save_ini_settings_to_memory().encode("utf-8"))
        imgui.get_io().want_save_ini_settings = False

    def grab(self) -> np.ndarray:
        """The last frame as 8-bit RGB (height, width, 3), top row first, drawn again into a framebuffer of our own."""
        data = imgui.get_draw_data()
        width = max(1, int(data.display_size.x * data.framebuffer_scale.x))
        height = max(1, int(data.display_size.y * data.framebuffer_scale.y))
        before = self.ctx.fbo or self.ctx.detect_framebuffer()  # in a tiny window nothing has used one yet
        buffer = self.ctx.simple_framebuffer((width, height), components=4)
        try:
            buffer.use()
            buffer.clear(0.0, 0.0, 0.0, 1.0)
            backends.opengl3_render_draw_data(data)
            content = buffer.read(components=3, alignment=1)
        finally:
            before.use()  # first: OpenGL must not lose the framebuffer in use
            buffer.release()
        return np.frombuffer(content, np.uint8).reshape(height, width, 3)[::-1]


class Window(Surface):
    """A window on the screen. Raises NoWindow if none can be opened."""

    def __init__(
        self, title: str, size: tuple[int, int], ini: Path | None = None, place: WindowPlace | None = None
    ) -> None:
        """`place`: where it stood before, if that is still on a screen."""
        self.dropped: list[Path] = []
        self.windowed: tuple[int, int, int, int] | None = None  # place and size to go back to from full screen
        self.on_refresh: Callable[[], None] = lambda: None
        glfw.set_error_callback(lambda code, text: None)  # failures are detected by return values
        if not glfw.init():
            raise NoWindow("There is no display to open a window on")
        for hint, value in (
            (glfw.CONTEXT_VERSION_MAJOR, 3),
            (glfw.CONTEXT_VERSION_MINOR, 3),
            (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
            (glfw.OPENGL_FORWARD_COMPAT, True),
            (glfw.SCALE_TO_MONITOR, True),
            (glfw.AUTO_ICONIFY, False),  # full screen stays when a window on another screen is used
        ):
            glfw.window_hint(hint, value)
        areas = [glfw.get_monitor_workarea(monitor) for monitor in glfw.get_monitors()]
        if place and is_reachable((place.x, place.y, place.width, place.height), areas):
            glfw.window_hint(glfw.POSITION_X, place.x)
            glfw.window_hint(glfw.POSITION_Y, place.y)
        self.window = glfw.create_window(*size, title, None, None)
        if not self.window:
            glfw.terminate()
            raise NoWindow(f"No window can be opened: {NO_GRAPHICS}")
        glfw.set_window_size_limits(self.window, *SMALLEST, glfw.DONT_CARE, glfw.DONT_CARE)
        glfw.make_context_current(self.window)
        glfw.swap_interval(1)
        self.ctx = moderngl.create_context(require=330)
        self._start_imgui(ini)
        # Before imgui's backend, which calls the callbacks that it finds.
        glfw.set_drop_callback(self.window, self._drop)  # type: ignore[arg-type]  # its stub says int for a list
        glfw.set_window_refresh_callback(self.window, lambda _: self.on_refresh())
        glfw.set_mouse_button_callback(self.window, self._find_mouse)
        address = ctypes.cast(self.window, ctypes.c_void_p).value
        assert address is not None
        backends.glfw_init_for_opengl(address, True)
        backends.opengl3_init(GLSL)
        if place and place.full_screen:
            self.toggle_full_screen()

    def _find_mouse(self, *_: object) -> None:
        """A click counts where the mouse is, also if it has not moved since imgui was told to forget it."""
        if not imgui.is_mouse_pos_valid():
            imgui.get_io().add_mouse_pos_event(*glfw.get_cursor_pos(self.window))

    def _drop(self, _: object, paths: list[str]) -> None:
        self.dropped += [Path(path) for path in paths]

    @property
    def scale(self) -> float:
        """The scale of the screen (HiDPI): pixels per logical pixel.

        macOS and Wayland scale by themselves, with more pixels than window units. Elsewhere the content scale tells.
        """
        content, _ = glfw.get_window_content_scale(self.window)
        width, _ = glfw.get_window_size(self.window)
        pixels, _ = glfw.get_framebuffer_size(self.window)
        return content * width / pixels if pixels else 1.0

    @property
    def state(self) -> tuple[object, ...]:
        """Sizes and scale, which change when a projector is plugged in or the resolution is changed."""
        window = self.window
        return glfw.get_window_size(window), glfw.get_framebuffer_size(window), glfw.get_window_content_scale(window)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in logical pixels, as a window is opened with."""
        return self._logical(*glfw.get_window_size(self.window))

    @property
    def place(self) -> WindowPlace:
        """The window's place. While it is minimised, some systems move it out of all screens."""
        x, y, width, height = self.windowed or (*glfw.get_window_pos(self.window), *glfw.get_window_size(self.window))
        return WindowPlace(x, y, *self._logical(width, height), self.windowed is not None)

    def _logical(self, width: int, height: int) -> tuple[int, int]:
        scale = self.scale
        return (max(1, round(width / scale)), max(1, round(height / scale)))

    def toggle_full_screen(self) -> None:
        """Fill the screen that the window is on, or go back to the place and size before."""
        if self.windowed:
            nothing: Any = None  # its stub asks for a monitor
            glfw.set_window_monitor(self.window, nothing, *self.windowed, glfw.DONT_CARE)
            self.windowed = None
            return
        self.windowed = (*glfw.get_window_pos(self.window), *glfw.get_window_size(self.window))
        monitors = glfw.get_monitors()
        modes = [glfw.get_video_mode(monitor) for monitor in monitors]
        corners = [glfw.get_monitor_pos(monitor) for monitor in monitors]
        screens = [(*at, mode.size.width, mode.size.height) for at, mode in zip(corners, modes, strict=True)]
        k = screen_of(self.windowed, screens)
        glfw.set_window_monitor(self.window, monitors[k], 0, 0, *screens[k][2:], modes[k].refresh_rate)

    @property
    def closing(self) -> bool:
        return bool(glfw.window_should_close(self.window))

    @property
    def minimised(self) -> bool:
        return 0 in glfw.get_framebuffer_size(self.window) or bool(glfw.get_window_attrib(self.window, glfw.ICONIFIED))

    def close_requested(self) -> None:
        glfw.set_window_should_close(self.window, True)

    def set_title(self, title: str) -> None:
        glfw.set_window_title(self.window, title)

    def wait(self, seconds: float) -> None:
        """Sleep until an event, or for so many seconds; not at all for 0."""
        if seconds > 0.0:
            glfw.wait_events_timeout(seconds)
        else:
            glfw.poll_events()

    def wake(self) -> None:
        """End `wait`, from any thread."""
        glfw.post_empty_event()

    def begin(self) -> None:
        backends.opengl3_new_frame()
        backends.glfw_new_frame()
        imgui.new_frame()

    def present(self) -> None:
        imgui.render()
        # moderngl keeps the size that the screen had at the start, so it is not used.
        self.ctx.screen.use()
        self.ctx.screen.clear(0.0, 0.0, 0.0, 1.0)
        backends.opengl3_render_draw_data(imgui.get_draw_data())
        glfw.swap_buffers(self.window)
        if imgui.get_io().want_save_ini_settings:
            self.keep_layout()

    def close(self) -> None:
        self.keep_layout()
        backends.opengl3_shutdown()
        backends.glfw_shutdown()
        self._end_imgui()
        self.ctx.release()
        glfw.destroy_window(self.window)
        glfw.terminate()


class Offscreen(Surface):
    """A surface without a screen: for screenshots, and for tests, which send events through imgui's own queue."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.dropped: list[Path] = []
        options: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
        try:
            self.ctx = moderngl.create_context(standalone=True, require=330, **options)
        except Exception as error:  # of a type of its own on each platform
            raise NoWindow(f"Nothing can be drawn: {NO_GRAPHICS}; {error}") from None
        self._start_imgui(None)
        backends.opengl3_init(GLSL)
        self.resize(size)
        self.closing = False
        self.minimised = False
        self.scale = 1.0

    @property
    def state(self) -> tuple[object, ...]:
        """Size and scale."""
        return (*imgui.get_io().display_size, self.scale)

    def resize(self, size: tuple[int, int]) -> None:
        imgui.get_io().display_size = imgui.ImVec2(*size)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = imgui.get_io().display_size
        return (round(width), round(height))

    def toggle_full_screen(self) -> None:
        """There is no screen."""

    def close_requested(self) -> None:
        self.closing = True

    def set_title(self, title: str) -> None:
        self.title = title

    def wait(self, seconds: float) -> None:
        """Returns at once: there are no events from outside."""

    def wake(self) -> None: ...

    def begin(self) -> None:
        imgui.get_io().delta_time = 1 / 60
        backends.opengl3_new_frame()
        imgui.new_frame()

    def present(self) -> None:
        imgui.render()

    def close(self) -> None:
        backends.opengl3_shutdown()
        self._end_imgui()
        with self.ctx:  # unbinds the context from this thread, which may open a window next
            pass
        self.ctx.release()
