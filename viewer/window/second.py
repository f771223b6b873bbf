"""A second window, which shows text: with OpenGL and imgui contexts of its own, which are current while it draws.

Its keys that lead through a lesson act as those of the main window, so that a remote works whichever has the focus.
"""

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# isort: off
from imgui_bundle import imgui
import glfw

# isort: on
import moderngl
from imgui_bundle.imgui import backends

from viewer.window.backend import GLSL, SMALLEST, Surface
from viewer.window.fonts import load_fonts
from viewer.window.screens import screen_of

SIZE = (860, 560)
KEYS = {
    glfw.KEY_PAGE_DOWN: imgui.Key.page_down,
    glfw.KEY_PAGE_UP: imgui.Key.page_up,
    glfw.KEY_HOME: imgui.Key.home,
}
ANYWHERE = 0x80000000  # GLFW_ANY_POSITION


class SecondWindow(Surface):
    """Opened by the window whose contexts are current. Raises RuntimeError if the system refuses another one."""

    def __init__(self, title: str) -> None:
        self.main, self.main_imgui = glfw.get_current_context(), imgui.get_current_context()
        glfw.window_hint(glfw.FOCUS_ON_SHOW, False)  # the keys stay with the main window
        for hint, place in zip((glfw.POSITION_X, glfw.POSITION_Y), self._place() or (ANYWHERE, ANYWHERE), strict=True):
            glfw.window_hint(hint, place)
        self.window = glfw.create_window(*SIZE, title, None, None)
        if not self.window:
            raise RuntimeError("no second window can be opened")
        glfw.set_window_size_limits(self.window, *SMALLEST, glfw.DONT_CARE, glfw.DONT_CARE)
        glfw.set_key_callback(self.window, self._key)
        self.imgui = imgui.create_context()
        with self._current():
            glfw.swap_interval(0)  # it must not make the main window wait
            self.ctx = moderngl.create_context(require=330)
            imgui.get_io().set_ini_filename("")
            load_fonts()
            address = ctypes.cast(self.window, ctypes.c_void_p).value
            assert address is not None
            backends.glfw_init_for_opengl(address, False)
            backends.opengl3_init(GLSL)

    def _place(self) -> tuple[int, int] | None:
        """A corner of a screen that the main window is not on: the room sees that one. None if there is no other."""
        monitors = glfw.get_monitors()
        if len(monitors) < 2:
            return None
        areas = [glfw.get_monitor_workarea(monitor) for monitor in monitors]
        window = (*glfw.get_window_pos(self.main), *glfw.get_window_size(self.main))
        x, y, *_ = areas[1 - min(1, screen_of(window, areas))]
        return (x + 60, y + 60)

    @contextmanager
    def _current(self) -> Iterator[None]:
        """Draw into this window, then go back to the main one."""
        glfw.make_context_current(self.window)
        imgui.set_current_context(self.imgui)
        try:
            yield
        finally:
            imgui.set_current_context(self.main_imgui)
            glfw.make_context_current(self.main)

    def _key(self, _: Any, key: int, code: int, action: int, mods: int) -> None:
        if key in KEYS and action != glfw.REPEAT:
            imgui.get_io().add_key_event(KEYS[key], action == glfw.PRESS)  # of the main window, which is current

    @property
    def closing(self) -> bool:
        return bool(glfw.window_should_close(self.window))

    @property
    def state(self) -> tuple[object, ...]:
        """Size and scale: it is to be drawn again when they change."""
        return glfw.get_framebuffer_size(self.window), glfw.get_window_content_scale(self.window)

    def frame(self, draw: Callable[[float], object]) -> None:
        """Draw the window anew, with a function of its screen's scale."""
        if 0 in glfw.get_framebuffer_size(self.window):
            return
        with self._current():
            backends.opengl3_new_frame()
            backends.glfw_new_frame()
            imgui.new_frame()
            try:
                draw(glfw.get_window_content_scale(self.window)[0])
            finally:
                imgui.render()
            self.ctx.screen.use()
            backends.opengl3_render_draw_data(imgui.get_draw_data())
            glfw.swap_buffers(self.window)

    def picture(self) -> Any:
        """The last frame, as `grab`."""
        with self._current():
            return self.grab()

    def close(self) -> None:
        with self._current():
            backends.opengl3_shutdown()
            backends.glfw_shutdown()
            self.ctx.release()
        imgui.destroy_context(self.imgui)
        glfw.destroy_window(self.window)
