"""The framebuffer of the 3D view: an antialiased picture of any size, as a texture for a panel."""

import moderngl
import numpy as np

SAMPLES = 4


class Target:
    """A framebuffer with several samples per pixel, and the texture that they are resolved into."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.size = (0, 0)
        self.owned: list = []

    def resize(self, size: tuple[int, int]) -> bool:
        """Change the size. Returns whether it was another."""
        size = (max(1, size[0]), max(1, size[1]))
        if size == self.size:
            return False
        ctx = self.ctx
        samples = min(SAMPLES, ctx.max_samples)
        color = ctx.renderbuffer(size, 4, samples=samples)
        depth = ctx.depth_renderbuffer(size, samples=samples)
        drawn = ctx.framebuffer([color], depth)
        drawn.use()  # before the old one is released: OpenGL must not lose the framebuffer in use
        self.release()
        self.drawn = drawn
        self.texture = ctx.texture(size, 4)
        self.merged = ctx.framebuffer([self.texture])
        self.owned = [color, depth, self.drawn, self.texture, self.merged]
        self.size = size
        return True

    def use(self) -> None:
        self.drawn.use()
        self.drawn.depth_mask = True
        self.drawn.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def finish(self) -> None:
        self.ctx.copy_framebuffer(self.merged, self.drawn)

    def pixels(self) -> np.ndarray:
        """8-bit RGB (height, width, 3), top row first."""
        width, height = self.size
        content = self.merged.read(components=3, alignment=1)
        return np.frombuffer(content, np.uint8).reshape(height, width, 3)[::-1]

    def release(self) -> None:
        for thing in reversed(self.owned):
            thing.release()
        self.owned = []
        self.size = (0, 0)
