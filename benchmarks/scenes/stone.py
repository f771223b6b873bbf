"""A closed mesh of 20 * 4^level triangles, an icosphere with waves, and rays towards it."""

import numpy as np
import trimesh

import tracer
from tracer.formulas.vector import as_floats
from tracer.scene import Camera, Light, Material, Object, Scene
from tracer.shapes.mesh import Geometry, Mesh

LARGE = 7  # 327 680 triangles
SMALL = 4  # 5 120 triangles, a 64th
EYE = np.array([1.2, 0.8, 2.6])
MATTE = Material("matte", diffuse=0.8)


def stone(level: int) -> Geometry:
    """A unit sphere, raised and lowered by slow waves: no symmetry, and the same shape at every level."""
    ball = trimesh.creation.icosphere(level)
    points = np.asarray(ball.vertices)
    waves = np.sin(points @ np.array([(3.0, 1.0, 2.0), (-2.0, 4.0, 1.0), (5.0, -1.0, -6.0)]).T + (0.3, 1.1, 2.0))
    heights = 1.0 + waves @ np.array([0.08, 0.06, 0.03])
    # In single precision from the start, so that a program in single precision has the same corners.
    return Geometry((heights[:, None] * points).astype(np.float32).astype(np.float64), np.asarray(ball.faces))


def stone_world(level: int, material: Material = MATTE) -> tracer.World:
    camera = Camera(as_floats(EYE), (0.0, 0.0, 0.0))
    lights = (Light(position=(4.0, 6.0, 5.0)),)
    return tracer.prepare(Scene((Object(Mesh(stone(level)), material, "stone"),), lights, camera))


def coherent_rays(side: int = 512) -> tuple[np.ndarray, np.ndarray]:
    """(origins, directions), float32 (side^2, 3): camera rays row by row; the stone fills most of the image."""
    forward = -EYE / np.linalg.norm(EYE)
    right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    v, u = np.meshgrid(np.linspace(0.42, -0.42, side), np.linspace(-0.42, 0.42, side), indexing="ij")
    directions = forward + u[..., None] * right + v[..., None] * up
    return _single(np.broadcast_to(EYE, (side * side, 3)), directions.reshape(-1, 3))


def scattered_rays(count: int = 512 * 512, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Rays from random points of the bounding box in random directions."""
    random = np.random.default_rng(seed)
    return _single(random.uniform(-1.2, 1.2, (count, 3)), random.normal(size=(count, 3)))


def _single(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    directions = directions / np.linalg.norm(directions, axis=1)[:, None]
    return np.ascontiguousarray(origins, np.float32), np.ascontiguousarray(directions, np.float32)
