"""The surfaces of a scene: opaque ones first, then glass, whose back faces come before its front faces.

Walls are one-way. From the side of the scene's camera they are opaque, from the other side nearly transparent, so
that one can look into a room from outside.
"""

import math
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from tracer.kernel.world import World
from tracer.shapes.sphere import Sphere
from tracer.shapes.tessellation import SEGMENTS, unit_ball
from viewer.base.orbit import Frame, Orbit
from viewer.base.theme import OUTLINE_OPACITY, Theme, faded
from viewer.gl.features import Features
from viewer.gl.float32 import float32
from viewer.gl.program import make_program, put

MOST_LIGHTS = 8  # as in surface.frag
TRIANGLES = 400_000  # of all balls together


GHOST = 0.13  # opacity of a wall seen from its other side
FADES = {True: (1.1, 2.4), False: (3.0, 10.0)}  # radii between which an infinite plane fades out: of glass, and opaque


@dataclass(frozen=True)
class Group:
    """One draw call: triangles, or one ball many times."""

    array: moderngl.VertexArray
    middle: np.ndarray
    glass: bool = False
    infinite: bool = False
    wall: bool = False
    count: int = 1


class Surfaces:
    """The surfaces of a world on the GPU. Call `release` before another world is shown."""

    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, world: World, frame: Frame, features: Features
    ) -> None:
        self.ctx = ctx
        self.features = features
        self.program = program
        self.world = world
        self.frame = frame
        self.owned: list[Any] = []
        self.groups: list[Group] = []
        self.camera = np.array(world.view().eye)
        self._make_textures()
        self._make_balls()
        self._make_triangles()

    def release(self) -> None:
        for thing in reversed(self.owned):
            thing.release()
        self.owned.clear()

    def draw_opaque(self, orbit: Orbit, matrix: np.ndarray, theme: Theme) -> None:
        self._set_uniforms(orbit, matrix, theme)
        chosen = [group for group in self.groups if not group.glass]
        for group in sorted(chosen, key=lambda group: group.infinite):
            self._draw_group(group, culled="back" if group.wall else None)

    @property
    def has_glass(self) -> bool:
        return "GLASS" in self.features

    @property
    def has_clear(self) -> bool:
        """Whether there are transparent surfaces: glass, or walls seen from behind."""
        return self.has_glass or any(group.wall for group in self.groups)

    def draw_clear(self, orbit: Orbit) -> None:
        """Draw the transparent surfaces, after the opaque ones: glass, the farthest first, and walls from behind."""
        self._use_textures()  # other textures have been in use meanwhile
        for group in self._glass(orbit):
            if not group.wall:
                self._draw_group(group, culled="front")  # the far side first
                self._draw_group(group, culled="back")
        for group in self.groups:
            if group.wall and not group.glass:
                self._draw_group(group, culled="front", ghost=GHOST)

    def draw_front(self, orbit: Orbit) -> None:
        """Draw the glass once, for its depth. The uniforms are those of the last `draw_opaque`."""
        for group in self._glass(orbit):
            self._draw_group(group, culled=None)

    def _glass(self, orbit: Orbit) -> list[Group]:
        """The glass, the farthest first."""
        chosen = [group for group in self.groups if group.glass] if self.has_glass else []
        return sorted(chosen, key=lambda group: -float(np.linalg.norm(group.middle - orbit.eye)))

    def _draw_group(self, group: Group, culled: str | None, ghost: float = 0.0) -> None:
        if culled:
            self.ctx.enable(moderngl.CULL_FACE)
            self.ctx.cull_face = culled
        # An infinite plane fades out before the edge of its square shows.
        fade_from, fade_to = FADES[group.glass] if group.infinite else (0.0, 0.0)
        put(self.program, fade_from=fade_from, fade_to=fade_to, ghost=ghost)
        group.array.render(moderngl.TRIANGLES, instances=group.count)
        if culled:
            self.ctx.disable(moderngl.CULL_FACE)

    def _set_uniforms(self, orbit: Orbit, matrix: np.ndarray, theme: Theme) -> None:
        lights = np.zeros((MOST_LIGHTS, 4))
        colors = np.zeros((MOST_LIGHTS, 3))
        rows = self.world.arrays.lights[:MOST_LIGHTS]
        for j, row in enumerate(rows):
            lights[j] = (*row["towards"], 0.0) if row["distant"] else (*self.frame.inside(row["position"]), 1.0)
            colors[j] = row["color"]
        background = float32(self.world.scene.background.color)
        put(
            self.program,
            world_to_clip=tuple(float32(matrix.T).ravel()),
            materials=0,
            axes=1,
            light_count=len(rows),
            ambient=tuple(float32(self.world.arrays.ambient)),
            eye=tuple(orbit.eye),
            up=tuple(orbit.up),
            sky_top=tuple(background * 0.9 + 0.12),
            sky_bottom=tuple(background * 0.25 + 0.05),
            fade_center=(0.0, 0.0, 0.0),
            edge=faded(theme.text, OUTLINE_OPACITY),
            tint=theme.glass[:3],
            origin=tuple(float32(self.frame.middle / self.frame.radius)),
        )
        self.program["lights"].write(float32(lights).tobytes())  # type: ignore[union-attr]
        self.program["light_colors"].write(float32(colors).tobytes())  # type: ignore[union-attr]
        self._use_textures()

    def _use_textures(self) -> None:
        self.materials.use(0)
        self.axes.use(1)

    def _make_textures(self) -> None:
        scene, arrays = self.world.scene, self.world.arrays
        # One column per object, not per material: the axes of a flat checker belong to the object.
        table = np.zeros((4, len(scene.objects), 4))
        axes = np.zeros((2, len(scene.objects), 4))
        for k, item in enumerate(arrays.objects):
            material = arrays.materials[item["material"]]
            table[0, k] = (*material["color"], material["ambient"])
            table[1, k] = (*material["checker_color"], material["checker_size"] / self.frame.radius)
            table[2, k] = (material["diffuse"], material["specular"], material["shininess"], material["reflect"])
            table[3, k] = (material["transmit"], material["ior"], 0.0, 0.0)
            axes[0, k] = (*item["u"], float(item["tiled"]))
            axes[1, k] = (*item["v"], 0.0)
        self.materials = self._texture(table)
        self.axes = self._texture(axes)

    def _texture(self, table: np.ndarray) -> moderngl.Texture:
        texture = self.ctx.texture((table.shape[1], table.shape[0]), 4, float32(table).tobytes(), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.owned.append(texture)
        return texture

    def _make_balls(self) -> None:
        objects = self.world.scene.objects
        shapes = [(k, item.shape) for k, item in enumerate(objects)]
        balls = [(k, shape) for k, shape in shapes if isinstance(shape, Sphere) and self._is_plain_ball(shape)]
        if not balls:
            return
        segments = int(min(SEGMENTS, max(8, math.sqrt(TRIANGLES / len(balls)))))
        corners, faces = unit_ball(segments - segments % 2)
        shared = self._buffer(np.hstack([corners, corners]))
        self.faces = self.ctx.buffer(faces.astype(np.uint32).tobytes())
        self.owned.append(self.faces)
        places = np.array(
            [(*self.frame.inside(shape.center), shape.radius / self.frame.radius, k) for k, shape in balls]
        )
        glass = np.array([objects[k].material.transmit > 0.0 for k, _ in balls])
        if (~glass).any():
            self._ball_group(shared, places[~glass], glass=False)
        for row in places[glass]:  # one draw call each, since they are sorted by distance
            self._ball_group(shared, row[None], glass=True)

    def _is_plain_ball(self, shape: object) -> bool:
        """Whether it is a sphere that does not contain the camera."""
        return isinstance(shape, Sphere) and not shape.contains(self.camera)

    def _ball_group(self, shared: moderngl.Buffer, places: np.ndarray, glass: bool) -> None:
        own = self._buffer(places)
        content = [(shared, "3f 3f", "corner", "normal"), (own, "4f 1f/i", "ball", "material")]
        self._add(content, places[:, :3].mean(axis=0), self.faces, glass=glass, count=len(places))

    def _make_triangles(self) -> None:
        plain: list[np.ndarray] = []
        walls: list[np.ndarray] = []
        for k, item in enumerate(self.world.scene.objects):
            if self._is_plain_ball(item.shape):
                continue
            corners, normals = item.shape.triangles(self.frame.middle, self.frame.radius)
            glass = item.material.transmit > 0.0
            infinite = item.shape.bounds() is None
            wall = (item.shape.plane() is not None and not infinite) or item.shape.contains(self.camera)
            if wall and not glass and not infinite:
                corners, normals = _turned(corners, normals, self.camera)
            rows = np.concatenate(
                [self.frame.inside(corners), normals, np.full((*corners.shape[:2], 1), k)], axis=2
            ).reshape(-1, 7)
            if glass or infinite:
                self._triangle_group(rows, glass=glass, infinite=infinite)
            else:
                (walls if wall else plain).append(rows)
        if plain:
            self._triangle_group(np.concatenate(plain))
        if walls:
            self._triangle_group(np.concatenate(walls), wall=True)

    def _triangle_group(self, rows: np.ndarray, **options: bool) -> None:
        everywhere = self._buffer(np.array([[0.0, 0.0, 0.0, 1.0]]))
        content = [
            (self._buffer(rows), "3f 3f 1f", "corner", "normal", "material"),
            (everywhere, "4f/i", "ball"),
        ]
        self._add(content, rows[:, :3].mean(axis=0), None, **options)

    def _add(self, content: list, middle: np.ndarray, faces: moderngl.Buffer | None, **options: Any) -> None:
        array = self.ctx.vertex_array(self.program, content, index_buffer=faces)
        self.owned.append(array)
        self.groups.append(Group(array, middle, **options))

    def _buffer(self, rows: np.ndarray) -> moderngl.Buffer:
        buffer = self.ctx.buffer(float32(rows).tobytes())
        self.owned.append(buffer)
        return buffer


def _turned(corners: np.ndarray, normals: np.ndarray, camera: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The triangles with their front facing the camera."""
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    away = (area * (camera - corners[:, 0])).sum(axis=1) < 0.0
    corners, normals = corners.copy(), normals.copy()
    corners[away], normals[away] = corners[away][:, ::-1], -normals[away][:, ::-1]
    return corners, normals


def make_surface_program(ctx: moderngl.Context, features: Features) -> moderngl.Program:
    return make_program(ctx, "surface", features)
