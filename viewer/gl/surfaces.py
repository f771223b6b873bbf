"""The scene's surfaces as the 3D view shows them: opaque ones first, glass over the rays, back faces before front ones."""

import math
from typing import Any

import moderngl
import numpy as np

from tracer.shapes.plane import Plane
from tracer.shapes.sphere import Sphere
from tracer.world import World
from viewer.gl.geometry import ball, triangles
from viewer.gl.program import make_program, put
from viewer.orbit import Frame, Orbit
from viewer.theme import Theme

MOST_LIGHTS = 8  # as in surface.frag
ROUND = 96  # segments of a ball where few are drawn
TRIANGLES = 400_000  # that all balls together may take


class Group:
    """One draw call: triangles at one place, or one ball many times."""

    def __init__(self, array: moderngl.VertexArray, middle: np.ndarray, glass: bool, endless: bool, count: int) -> None:
        self.array = array
        self.middle = middle
        self.glass = glass
        self.endless = endless
        self.count = count


class Surfaces:
    """A world's surfaces on the GPU. `release` when another world takes its place."""

    def __init__(self, ctx: moderngl.Context, program: moderngl.Program, world: World, frame: Frame) -> None:
        self.ctx = ctx
        self.program = program
        self.world = world
        self.frame = frame
        self.owned: list[Any] = []
        self.groups: list[Group] = []
        self._make_textures()
        self._make_balls()
        self._make_triangles()

    def release(self) -> None:
        for thing in reversed(self.owned):
            thing.release()
        self.owned.clear()

    def draw(self, orbit: Orbit, matrix: np.ndarray, theme: Theme, glass: bool) -> None:
        """The opaque surfaces, or those of glass, farthest first."""
        if not any(group.glass == glass for group in self.groups):
            return
        self._set_uniforms(orbit, matrix, theme, glass)
        chosen = [group for group in self.groups if group.glass == glass]
        chosen.sort(key=lambda group: -float(np.linalg.norm(group.middle - orbit.eye)))
        ctx = self.ctx
        if not glass:
            for group in sorted(chosen, key=lambda group: group.endless):
                self._draw_group(group)
            return
        ctx.fbo.depth_mask = False
        ctx.enable(moderngl.CULL_FACE)
        for group in chosen:
            for face in ("front", "back"):  # what is culled: first the near side, so that the far side is drawn first
                ctx.cull_face = face
                self._draw_group(group)
        ctx.disable(moderngl.CULL_FACE)
        ctx.fbo.depth_mask = True

    def _draw_group(self, group: Group) -> None:
        # An endless plane fades before its square's edge shows.
        put(self.program, fade_from=3.0 if group.endless else 0.0, fade_to=10.0)
        group.array.render(moderngl.TRIANGLES, instances=group.count)

    def _set_uniforms(self, orbit: Orbit, matrix: np.ndarray, theme: Theme, glass: bool) -> None:
        lights = np.zeros((MOST_LIGHTS, 4), np.float32)
        colors = np.zeros((MOST_LIGHTS, 3), np.float32)
        rows = self.world.arrays.lights[:MOST_LIGHTS]
        for j, row in enumerate(rows):
            lights[j] = (*row["towards"], 0.0) if row["distant"] else (*self.frame.inside(row["position"]), 1.0)
            colors[j] = row["color"]
        background = np.array(self.world.scene.background.color)
        put(
            self.program,
            world_to_clip=tuple(matrix.T.astype(np.float32).ravel()),
            materials=0,
            axes=1,
            light_count=len(rows),
            ambient=tuple(self.world.arrays.ambient),
            eye=tuple(orbit.eye),
            up=tuple(orbit.up),
            sky_top=tuple(background * 0.9 + 0.12),
            sky_bottom=tuple(background * 0.25 + 0.05),
            fade_center=(0.0, 0.0, 0.0),
            origin=tuple(self.frame.middle / self.frame.radius),
            glass_pass=1.0 if glass else 0.0,
        )
        self.program["lights"].write(lights.tobytes())  # type: ignore[union-attr]
        self.program["light_colors"].write(colors.tobytes())  # type: ignore[union-attr]
        self.materials.use(0)
        self.axes.use(1)

    def _make_textures(self) -> None:
        scene, arrays = self.world.scene, self.world.arrays
        # A column an object, not a material: a flat checker's axes are the object's own.
        table = np.zeros((4, len(scene.objects), 4), np.float32)
        axes = np.zeros((2, len(scene.objects), 4), np.float32)
        for k, item in enumerate(arrays.objects):
            material = arrays.materials[item["material"]]
            table[0, k] = (*material["color"], material["ambient"])
            table[1, k] = (*material["checker_color"], material["checker_size"] / self.frame.radius)
            table[2, k] = (material["diffuse"], material["specular"], material["shininess"], material["reflect"])
            table[3, k] = (material["transmit"], material["ior"], 0.0, 0.0)
            axes[0, k] = (*item["u"], float(item["flat"]))
            axes[1, k] = (*item["v"], 0.0)
        self.materials = self._texture(table)
        self.axes = self._texture(axes)

    def _texture(self, table: np.ndarray) -> moderngl.Texture:
        texture = self.ctx.texture((table.shape[1], table.shape[0]), 4, table.tobytes(), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.owned.append(texture)
        return texture

    def _make_balls(self) -> None:
        objects = self.world.scene.objects
        balls = [(k, item.shape) for k, item in enumerate(objects) if isinstance(item.shape, Sphere)]
        if not balls:
            return
        segments = int(min(ROUND, max(8, math.sqrt(TRIANGLES / len(balls)))))
        corners = ball(segments - segments % 2).reshape(-1, 3).astype(np.float32)
        shared = self._buffer(np.hstack([corners, corners]))
        places = np.array([(*self.frame.inside(shape.center), shape.radius / self.frame.radius, k) for k, shape in balls])
        glass = np.array([objects[k].material.transmit > 0.0 for k, _ in balls])
        if (~glass).any():
            self._ball_group(shared, places[~glass], False)
        for row in places[glass]:  # one by one: they are sorted by distance
            self._ball_group(shared, row[None], True)

    def _ball_group(self, shared: moderngl.Buffer, places: np.ndarray, glass: bool) -> None:
        own = self._buffer(places.astype(np.float32))
        content = [(shared, "3f 3f", "corner", "normal"), (own, "4f 1f/i", "ball", "material")]
        self._add(content, places[:, :3].mean(axis=0), glass, False, len(places))

    def _make_triangles(self) -> None:
        opaque = []
        for k, item in enumerate(self.world.scene.objects):
            if isinstance(item.shape, Sphere):
                continue
            corners, normals = triangles(item.shape, self.frame)
            rows = np.concatenate(
                [self.frame.inside(corners), normals, np.full((*corners.shape[:2], 1), k)], axis=2
            ).reshape(-1, 7)
            endless = isinstance(item.shape, Plane)
            glass = item.material.transmit > 0.0
            if glass or endless:
                self._triangle_group(rows, glass, endless)
            else:
                opaque.append(rows)
        if opaque:
            self._triangle_group(np.concatenate(opaque), False, False)

    def _triangle_group(self, rows: np.ndarray, glass: bool, endless: bool) -> None:
        everywhere = self._buffer(np.array([[0.0, 0.0, 0.0, 1.0]], np.float32))
        content = [
            (self._buffer(rows.astype(np.float32)), "3f 3f 1f", "corner", "normal", "material"),
            (everywhere, "4f/i", "ball"),
        ]
        self._add(content, rows[:, :3].mean(axis=0), glass, endless, 1)

    def _add(self, content: list, middle: np.ndarray, glass: bool, endless: bool, count: int) -> None:
        array = self.ctx.vertex_array(self.program, content)
        self.owned.append(array)
        self.groups.append(Group(array, middle, glass, endless, count))

    def _buffer(self, rows: np.ndarray) -> moderngl.Buffer:
        buffer = self.ctx.buffer(np.ascontiguousarray(rows, np.float32).tobytes())
        self.owned.append(buffer)
        return buffer


def make_surface_program(ctx: moderngl.Context) -> moderngl.Program:
    return make_program(ctx, "surface")
