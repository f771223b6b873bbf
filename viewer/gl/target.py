"""The framebuffers of the 3D view, and the textures that they fill.

Surfaces are drawn with several samples per pixel and then resolved into layers, which are kept until they change: the
opaque surfaces with their depth, the transparent surfaces, and the depth of the frontmost glass. Put together with the
image they make the scene, which is kept, too. Lines are drawn over a copy of it. They need only one sample per pixel,
since their shader computes how much of a pixel they cover.
"""

from typing import Any

import moderngl
import numpy as np

SAMPLES = 4


class Target:
    """The framebuffers of one size. Textures have the bottom row first, as OpenGL has it."""

    size = (0, 0)

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.owned: list[Any] = []

    def resize(self, size: tuple[int, int]) -> None:
        """Change the size in pixels; each side is at least 1."""
        size = (max(1, size[0]), max(1, size[1]))
        if size == self.size:
            return
        ctx = self.ctx
        samples = min(SAMPLES, ctx.max_samples)
        old, self.owned = self.owned, []
        # The formats of all colours and of all depths are the same, or OpenGL could not copy from one to another.
        self.sampled = self._framebuffer(
            [ctx.renderbuffer(size, 4, samples=samples)], ctx.depth_renderbuffer(size, samples=samples)
        )
        self.opaque = self._framebuffer([ctx.texture(size, 4)], ctx.depth_renderbuffer(size))
        self.clear_texture = ctx.texture(size, 4)
        self.clear = self._framebuffer([self.clear_texture], None)
        self.front_texture = self._depth_texture(size)
        self.front = self._framebuffer([], self.front_texture)
        self.solid_texture = self._depth_texture(size)
        self.scene = self._framebuffer([ctx.texture(size, 4)], self.solid_texture)
        self.texture = ctx.texture(size, 4)
        self.shown = self._framebuffer([self.texture], None)
        self.shown.use()  # before the old ones are released: OpenGL must not lose the framebuffer in use
        _release(old)
        self.size = size

    def _framebuffer(self, colors: list[Any], depth: Any) -> moderngl.Framebuffer:
        framebuffer = self.ctx.framebuffer(colors, depth)
        self.owned += [*colors, *([depth] if depth else []), framebuffer]
        return framebuffer

    def _depth_texture(self, size: tuple[int, int]) -> moderngl.Texture:
        texture = self.ctx.depth_texture(size)
        texture.compare_func = ""  # shaders read it as numbers
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def pixels(self) -> np.ndarray:
        """The picture: 8-bit RGB (height, width, 3), top row first."""
        width, height = self.size
        content = self.shown.read(components=3, alignment=1)
        return np.frombuffer(content, np.uint8).reshape(height, width, 3)[::-1]

    def release(self) -> None:
        _release(self.owned)
        self.owned = []
        self.size = (0, 0)


def _release(owned: list[Any]) -> None:
    for thing in reversed(owned):
        thing.release()
