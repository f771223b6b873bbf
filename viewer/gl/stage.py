"""The 3D view: background, surfaces, the camera with its image, glass, and rays over them.

Surfaces take nearly all of the time, and only another view or another scene changes them. So they are drawn into
layers, which are kept (`target`). From these the scene is composed, again only if the image has changed:

1. the opaque surfaces;
2. the image plane where it is behind the frontmost glass;
3. the transparent surfaces;
4. the image plane where it is before the frontmost glass.

A pick, a selection or another depth draws only lines over a copy of the scene. They are seen through glass, and more
faintly behind opaque things (`shaders/veil.glsl`).
"""

from dataclasses import dataclass

import moderngl
import numpy as np

from tracer.kernel.world import World
from viewer.base.cached import Cached, Changed
from viewer.base.orbit import Frame, Orbit
from viewer.base.theme import HIDDEN, Theme
from viewer.gl.features import Features, features_of
from viewer.gl.float32 import float32
from viewer.gl.lines import LinePrograms, Lines
from viewer.gl.program import make_program, put
from viewer.gl.stage_lines import StageLines
from viewer.gl.surfaces import Surfaces, make_surface_program
from viewer.gl.target import Target

IMAGE_OPACITY = 0.78  # of the image on the image plane: both the image and what is behind it are seen
# Surfaces are pushed back a little, so that lines that end on a surface stay in front of it.
PUSHED = (1.0, 2.0)
# The target stays opaque whatever is blended into it, and an empty layer becomes colour times opacity, and opacity.
BLENDED = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)


@dataclass(frozen=True)
class ImagePlane:
    """The camera's image in the scene. Corners in the frame: top left, bottom left, top right, bottom right."""

    corners: np.ndarray
    texture: moderngl.Texture
    state: object  # of the image: the texture's content changes with it


@dataclass(frozen=True)
class _Look:
    """The view of one picture: `size` in pixels, `scale` in pixels per logical pixel."""

    matrix: np.ndarray
    size: tuple[int, int]
    scale: float
    theme: Theme


class Stage:
    """Draws one world into one target."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.target = Target(ctx)
        self.programs: dict[Features, moderngl.Program] = {}  # of surfaces, by the features that scenes have asked for
        self.ground = make_program(ctx, "ground")
        self.layer = make_program(ctx, "layer")
        self.picture = make_program(ctx, "picture")
        self.empty = ctx.vertex_array(self.ground, [])
        self.layer_array = ctx.vertex_array(self.layer, [])
        self.picture_array = ctx.vertex_array(self.picture, [])
        self.lines = LinePrograms(ctx)
        self.marks = Lines(ctx, self.lines)  # frustum, normals
        self.rays = Lines(ctx, self.lines)
        self.quiet = Lines(ctx, self.lines)  # rays that are not to be noticed first
        self.glow = Lines(ctx, self.lines)  # under the ray that is pointed at
        self.interface = Lines(ctx, self.lines)  # normal, angles and critical cone at the selected hit
        self.edges = Lines(ctx, self.lines)  # of cut glass
        self.surfaces: Surfaces | None = None
        self.pictures = self.layers = 0  # how often a picture, and its surfaces, have been drawn
        self._layers_changed, self._scene_changed = Changed(), Changed()
        self._depths: Cached[np.ndarray] = Cached()
        self._scenes = 0  # how often the scene has been composed

    def set_world(self, world: World, frame: Frame, features: Features | None = None) -> None:
        """Show this world, with the features that it needs, or with these."""
        if self.surfaces:
            self.surfaces.release()
        features = features_of(world.scene) if features is None else features
        if features not in self.programs:
            self.programs[features] = make_surface_program(self.ctx, features)
        self.surfaces = Surfaces(self.ctx, self.programs[features], world, frame, features)
        self.forget()

    def set_edges(self, rows: np.ndarray) -> None:
        self.edges.set(rows)
        self.forget()

    def set_lines(self, lines: StageLines) -> None:
        self.marks.set(lines.marks)
        self.rays.set(lines.rays)
        self.quiet.set(lines.quiet)

    def set_glow(self, rows: np.ndarray) -> None:
        self.glow.set(rows)

    def set_interface(self, rows: np.ndarray) -> None:
        self.interface.set(rows)

    def depths(self) -> np.ndarray:
        """Depth (height, width) of the frontmost opaque thing in each pixel, 0 to 1, top row first."""

        def read() -> np.ndarray:
            width, height = self.target.size
            content = self.target.solid_texture.read(alignment=1)
            return np.frombuffer(content, np.float32).reshape(height, width)[::-1]

        return self._depths.get(self._scenes, read)

    def forget(self) -> None:
        """Draw the surfaces again for the next picture."""
        self._layers_changed, self._scene_changed = Changed(), Changed()

    def draw(self, orbit: Orbit, theme: Theme, size: tuple[int, int], scale: float, plane: ImagePlane | None) -> None:
        """Draw into the target. `size` in pixels, `scale` pixels per logical pixel."""
        ctx, target = self.ctx, self.target
        target.resize(size)
        look = _Look(orbit.matrix(target.size[0] / target.size[1]), target.size, scale, theme)
        ctx.enable_only(moderngl.BLEND)
        ctx.blend_func = BLENDED  # type: ignore[assignment]  # the type stub lacks the form with four factors
        ctx.depth_func = "<="
        self.lines.look(look.matrix, look.size, look.scale)
        view = (look.size, scale, theme, look.matrix.tobytes())
        self._layers_changed.run(view, lambda: self._draw_layers(orbit, look))
        image = plane and (plane.corners.tobytes(), plane.texture, plane.state)
        self._scene_changed.run((view, image), lambda: self._compose(look, plane))
        ctx.copy_framebuffer(target.shown, target.scene)
        self._draw_lines(look)
        self.pictures += 1

    # --- the layers that are kept -------------------------------------------------------------------------------------

    def _draw_layers(self, orbit: Orbit, look: _Look) -> None:
        ctx, target, surfaces = self.ctx, self.target, self.surfaces
        self.layers += 1
        sampled = target.sampled
        sampled.use()
        sampled.depth_mask = True
        sampled.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)
        put(self.ground, top=look.theme.sky[:3], bottom=look.theme.haze[:3])
        self.empty.render(moderngl.TRIANGLES, vertices=3)
        ctx.enable(moderngl.DEPTH_TEST)
        if surfaces:
            ctx.polygon_offset = PUSHED
            surfaces.draw_opaque(orbit, look.matrix, look.theme)
            ctx.polygon_offset = 0.0, 0.0
        ctx.copy_framebuffer(target.opaque, sampled)
        if surfaces and surfaces.has_clear:
            sampled.depth_mask = False
            sampled.clear(0.0, 0.0, 0.0, 0.0)
            self.edges.draw()
            surfaces.draw_clear(orbit)
            ctx.copy_framebuffer(target.clear, sampled)
        target.front.use()
        target.front.clear(depth=1.0)
        if surfaces and surfaces.has_glass:
            ctx.polygon_offset = PUSHED
            surfaces.draw_front(orbit)
            ctx.polygon_offset = 0.0, 0.0
        ctx.disable(moderngl.DEPTH_TEST)

    # --- the scene and the lines --------------------------------------------------------------------------------------

    def _compose(self, look: _Look, plane: ImagePlane | None) -> None:
        """Put the layers and the image plane together."""
        ctx, target, surfaces = self.ctx, self.target, self.surfaces
        self._scenes += 1
        ctx.copy_framebuffer(target.scene, target.opaque)
        target.scene.use()
        if plane:
            self._draw_picture(look.matrix, plane, before=False)
        if surfaces and surfaces.has_clear:
            ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
            target.clear_texture.use(0)
            self.layer_array.render(moderngl.TRIANGLES, vertices=3)
            ctx.blend_func = BLENDED  # type: ignore[assignment]
        if plane:
            self._draw_picture(look.matrix, plane, before=True)

    def _draw_lines(self, look: _Look) -> None:
        target = self.target
        target.shown.use()
        for k, texture in enumerate((target.solid_texture, target.front_texture, target.clear_texture)):
            texture.use(k)
        for lines in (self.marks, self.glow, self.quiet):
            lines.draw(HIDDEN)
        self.rays.draw(HIDDEN, seam=look.theme.ground)
        self.interface.draw(HIDDEN)

    def _draw_picture(self, matrix: np.ndarray, plane: ImagePlane, before: bool) -> None:
        """Draw the image plane before or behind the frontmost glass. It hides rays, as a surface does."""
        ctx = self.ctx
        self.target.front_texture.use(0)
        plane.texture.use(1)
        put(
            self.picture,
            world_to_clip=tuple(float32(matrix.T).ravel()),
            front=0,
            before=before,
            picture=1,
            opacity=IMAGE_OPACITY,
        )
        self.picture["corners"].write(float32(plane.corners).tobytes())  # type: ignore[union-attr]
        ctx.enable(moderngl.DEPTH_TEST)
        ctx.polygon_offset = PUSHED
        self.picture_array.render(moderngl.TRIANGLE_STRIP, vertices=4)
        ctx.polygon_offset = 0.0, 0.0
        ctx.disable(moderngl.DEPTH_TEST)

    def release(self) -> None:
        if self.surfaces:
            self.surfaces.release()
        lines = (self.marks, self.rays, self.quiet, self.glow, self.interface, self.edges)
        for thing in (*lines, self.empty, self.layer_array, self.picture_array, self.target):
            thing.release()
        for program in (*self.programs.values(), self.lines, self.ground, self.layer, self.picture):
            program.release()
