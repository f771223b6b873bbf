"""Lines of constant width with arrow heads, drawn as triangles, since not every driver draws wide lines."""

import moderngl
import numpy as np
from numpy.typing import ArrayLike

from viewer.base.theme import ARROW, ARROW_AT, HALO, Arrow, Color
from viewer.gl.float32 import float32
from viewer.gl.program import make_program, put

LINE = np.dtype(
    [
        ("from", np.float32, 3),
        ("to", np.float32, 3),
        ("tint", np.float32, 4),
        ("width", np.float32),
        ("dash", np.float32, 2),
        ("fading", np.float32),
        ("at", np.float32),
        ("arrow", np.float32),
    ]
)
NO_ROWS = np.zeros(0, LINE)
NO_COLOR = (0.0, 0.0, 0.0, 0.0)


def line_rows(
    starts: ArrayLike,
    ends: ArrayLike,
    tint: ArrayLike,
    width: ArrayLike,
    *,
    dash: ArrayLike = (0.0, 0.0),
    fading: ArrayLike = False,
    arrow: ArrayLike = Arrow.NONE.value,
) -> np.ndarray:
    """Lines as an array (n,) of LINE. `starts` and `ends` (n, 3) are in the frame, `tint` is sRGB and opacity, `width`
    and `dash` are logical pixels; each may be one value for all lines.
    """
    rows = np.zeros(len(np.asarray(starts)), LINE)
    rows["from"], rows["to"] = float32(starts), float32(ends)
    rows["tint"], rows["width"], rows["dash"] = tint, width, dash
    rows["fading"], rows["at"], rows["arrow"] = fading, ARROW_AT, arrow
    return rows


class LinePrograms:
    """The shaders of all lines."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.line = make_program(ctx, "line")
        self.arrow = make_program(ctx, "arrow")
        put(self.arrow, length_px=ARROW)
        for program in (self.line, self.arrow):
            put(program, solid=0, front=1, glass=2)

    def look(self, matrix: np.ndarray, size: tuple[int, int], scale: float) -> None:
        """Draw all lines in this view from now on. `size` in pixels, `scale` pixels per logical pixel."""
        for program in (self.line, self.arrow):
            put(program, world_to_clip=tuple(float32(matrix.T).ravel()), size=size, scale=scale)

    def release(self) -> None:
        for program in (self.line, self.arrow):
            program.release()


class Lines:
    """A set of lines on the GPU, drawn in front of or behind surfaces."""

    def __init__(self, ctx: moderngl.Context, programs: LinePrograms) -> None:
        self.ctx = ctx
        self.programs = programs
        self.count = 0
        self.buffer = ctx.buffer(reserve=LINE.itemsize)
        self._bind()

    def release(self) -> None:
        for thing in (self.strips, self.heads, self.buffer):
            thing.release()

    def set(self, rows: np.ndarray) -> None:
        """Draw these lines (n,) of LINE from now on."""
        self.count = len(rows)
        content = rows.tobytes()
        if len(content) > self.buffer.size:
            for thing in (self.strips, self.heads, self.buffer):
                thing.release()
            self.buffer = self.ctx.buffer(reserve=2 * len(content))
            self._bind()
        if content:
            self.buffer.write(content)

    def draw(self, hidden: float = 1.0, seam: Color = NO_COLOR) -> None:
        """Draw all lines in the view of the programs. `seam` is the colour of their border.

        `hidden` is their opacity behind opaque things. Unless it is 1, textures 0, 1 and 2 are those of
        `shaders/veil.glsl`, and the depth test must be off.
        """
        if not self.count:
            return
        for program in (self.programs.line, self.programs.arrow):
            put(program, extra=HALO if seam[3] else 0.0, seam=seam, hidden=hidden)
        self.strips.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=self.count)
        self.heads.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=self.count)

    def _bind(self) -> None:
        line = "3f 3f 4f 1f 2f 1f 2x4/i"
        self.strips = self.ctx.vertex_array(
            self.programs.line, [(self.buffer, line, "from", "to", "tint", "width", "dash", "fading")]
        )
        head = "3f 3f 4f 4x4 1f 1f/i"
        ends = [(self.buffer, head, "from", "to", "tint", "at", "kind")]
        self.heads = self.ctx.vertex_array(self.programs.arrow, ends)
