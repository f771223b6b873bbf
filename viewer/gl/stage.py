"""The 3D view: background, surfaces, the camera with its image, rays, glass, and hidden lines more faintly.

The order matters. Rays are drawn before glass, so that they are seen inside it, and then once more, faintly, where
an opaque surface hides them.
"""

from dataclasses import dataclass

import moderngl
import numpy as np

from tracer.kernel.world import World
from viewer.base.orbit import Frame, Orbit
from viewer.base.theme import EDGE_OPACITY, HIDDEN, Theme, faded
from viewer.gl.features import Features, features_of
from viewer.gl.float32 import float32
from viewer.gl.lines import Line, Lines
from viewer.gl.program import make_program, put
from viewer.gl.stage_lines import StageLines
from viewer.gl.surfaces import Surfaces, make_surface_program
from viewer.gl.target import Target

IMAGE_OPACITY = 0.78  # of the image on the image plane: both the image and what is behind it are seen


@dataclass(frozen=True)
class ImagePlane:
    """The camera's image in the scene. Corners in the frame: top left, bottom left, top right, bottom right."""

    corners: np.ndarray
    texture: moderngl.Texture


class Stage:
    """Draws one world into one target."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.target = Target(ctx)
        self.programs: dict[Features, moderngl.Program] = {}  # of surfaces, by the features that scenes have asked for
        self.ground = make_program(ctx, "ground")
        self.picture = make_program(ctx, "picture")
        self.empty = ctx.vertex_array(self.ground, [])
        self.picture_array = ctx.vertex_array(self.picture, [])
        self.marks = Lines(ctx)  # frustum, normals
        self.rays = Lines(ctx)
        self.edges = Lines(ctx)  # of cut glass
        self.surfaces: Surfaces | None = None

    def set_world(self, world: World, frame: Frame, features: Features | None = None) -> None:
        """Show this world, with the features that it needs, or with these."""
        if self.surfaces:
            self.surfaces.release()
        features = features_of(world.scene) if features is None else features
        if features not in self.programs:
            self.programs[features] = make_surface_program(self.ctx, features)
        self.surfaces = Surfaces(self.ctx, self.programs[features], world, frame, features)

    def set_edges(self, lines: list[Line]) -> None:
        self.edges.set(lines)

    def set_lines(self, lines: StageLines) -> None:
        self.marks.set(lines.marks)
        self.rays.set(lines.rays)

    def draw(self, orbit: Orbit, theme: Theme, size: tuple[int, int], scale: float, plane: ImagePlane | None) -> None:
        """Draw into the target. `size` in pixels, `scale` pixels per logical pixel."""
        ctx = self.ctx
        self.target.resize(size)
        size = self.target.size
        matrix = orbit.matrix(size[0] / size[1])
        edge = faded(theme.text, EDGE_OPACITY)
        self.target.use()
        ctx.enable_only(moderngl.BLEND)
        # The target stays opaque, whatever is blended into it.
        ctx.blend_func = (  # type: ignore[assignment]  # the type stub lacks the form with four factors
            moderngl.SRC_ALPHA,
            moderngl.ONE_MINUS_SRC_ALPHA,
            moderngl.ONE,
            moderngl.ONE_MINUS_SRC_ALPHA,
        )
        put(self.ground, top=theme.sky[:3], bottom=theme.haze[:3])
        self.target.drawn.depth_mask = False
        self.empty.render(moderngl.TRIANGLES, vertices=3)
        self.target.drawn.depth_mask = True
        ctx.enable(moderngl.DEPTH_TEST)
        ctx.depth_func = "<="
        if self.surfaces:
            # Surfaces are pushed back a little, so that lines that end on a surface stay in front of it.
            ctx.polygon_offset = 1.0, 2.0
            self.surfaces.draw_opaque(orbit, matrix, edge)
            ctx.polygon_offset = 0.0, 0.0
        self.target.drawn.depth_mask = False
        self.edges.draw(matrix, size, scale)
        self._draw_lines(matrix, theme, size, scale, 1.0)
        if plane:
            self._draw_picture(matrix, plane)
        if self.surfaces:
            self.surfaces.draw_clear(orbit)
        ctx.depth_func = ">"
        self._draw_lines(matrix, theme, size, scale, HIDDEN)
        ctx.depth_func = "<="
        self.target.drawn.depth_mask = True
        ctx.disable(moderngl.DEPTH_TEST)
        self.target.finish()

    def _draw_lines(
        self, matrix: np.ndarray, theme: Theme, size: tuple[int, int], scale: float, opacity: float
    ) -> None:
        self.marks.draw(matrix, size, scale, opacity)
        self.rays.draw(matrix, size, scale, opacity, halo=theme.ground)
        self.rays.draw(matrix, size, scale, opacity)

    def _draw_picture(self, matrix: np.ndarray, plane: ImagePlane) -> None:
        plane.texture.use(0)
        put(self.picture, world_to_clip=tuple(float32(matrix.T).ravel()), picture=0, opacity=IMAGE_OPACITY)
        self.picture["corners"].write(float32(plane.corners).tobytes())  # type: ignore[union-attr]
        self.picture_array.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        if self.surfaces:
            self.surfaces.release()
        for thing in (self.marks, self.rays, self.edges, self.empty, self.picture_array, self.target):
            thing.release()
        for program in (*self.programs.values(), self.ground, self.picture):
            program.release()
