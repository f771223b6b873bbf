"""Rays aimed at edges, rims, silhouettes and corners, within some roundings."""

import numpy as np

import tracer
from tracer.scene import Scene
from tracer.shapes import Shape
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import Mesh
from tracer.shapes.plane import Plane
from tracer.shapes.sphere import Sphere

Ray = tuple[tuple[float, ...], tuple[float, ...]]


def planted_ray(seed: int, scene: Scene, world: tracer.World) -> Ray | None:
    """A ray from the camera's position at the outline of one of the objects; None where none was found."""
    random = np.random.default_rng(seed)
    eye, k = np.array(scene.camera.position), int(random.integers(len(scene.objects)))
    aim = outline_point(random, scene.objects[k].shape, eye)
    if aim is None:
        aim = silhouette(random, scene, world, k)
    if aim is None:
        return None
    if random.random() < 0.5:
        aim = aim + random.normal(size=3) * 10.0 ** random.uniform(-17, -14) * np.linalg.norm(aim - eye)
    way = aim - eye
    return (tuple(eye.tolist()), tuple(way.tolist())) if way.any() else None


def across(random: np.random.Generator, axis: np.ndarray) -> np.ndarray:
    """A random unit vector at right angles to an axis."""
    n = axis / np.linalg.norm(axis)
    a = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    a /= np.linalg.norm(a)
    turn = random.uniform(0.0, 2.0 * np.pi)
    return np.cos(turn) * a + np.sin(turn) * np.cross(n, a)


def outline_point(random: np.random.Generator, shape: Shape, eye: np.ndarray) -> np.ndarray | None:
    """A point of the outline as the eye sees it; None for the silhouette of a cone, which is searched."""
    match shape:
        case Sphere(center, radius):
            to_center = np.array(center) - eye
            square = to_center @ to_center
            if square <= radius**2:
                return np.array(center)
            share, size = 1.0 - radius**2 / square, np.sqrt(square)
            return eye + share * to_center + radius * np.sqrt(share) * across(random, to_center / size)
        case Plane():
            return eye + across(random, np.array(shape.normal))
        case Disc():
            return np.array(shape.center) + shape.radius * across(random, np.array(shape.normal))
        case Cone():
            base, apex = np.array(shape.base), np.array(shape.apex)
            if random.random() < 0.6:
                return None
            end, radius = ((base, shape.base_radius), (apex, shape.apex_radius))[int(random.integers(2))]
            return end + radius * across(random, apex - base)
        case Box():
            low, high = np.array(shape.min), np.array(shape.max)
            point = low + random.random(3) * (high - low)
            for j in random.permutation(3)[:2]:
                point[j] = (low, high)[int(random.integers(2))][j]
            return point if random.random() < 0.8 else np.where(random.random(3) < 0.5, low, high)
        case Mesh():
            corners = shape.placed()[int(random.integers(len(shape.geometry.faces)))]
        case _:
            corners = np.array(shape.vertices)  # type: ignore[attr-defined]
    first, share = int(random.integers(len(corners))), random.random() if random.random() < 0.8 else 0.0
    return (1.0 - share) * corners[first] + share * corners[(first + 1) % len(corners)]


def silhouette(random: np.random.Generator, scene: Scene, world: tracer.World, k: int) -> np.ndarray | None:
    """A point beside the silhouette of cone k, by bisection between a hit and a miss; None if the middle is hidden."""
    shape = scene.objects[k].shape
    assert isinstance(shape, Cone)
    eye, base, apex = np.array(scene.camera.position), np.array(shape.base), np.array(shape.apex)
    share = random.random()
    hit = (1.0 - share) * base + share * apex
    aside = np.cross(hit - eye, apex - base)
    miss = hit + 2.0 * (shape.base_radius + shape.apex_radius) * aside / np.linalg.norm(aside)
    if not (meets(world, eye, hit, k) and not meets(world, eye, miss, k)):
        return None
    for _ in range(60):
        middle = 0.5 * (hit + miss)
        if meets(world, eye, middle, k):
            hit = middle
        else:
            miss = middle
    return hit if random.random() < 0.5 else miss


def meets(world: tracer.World, eye: np.ndarray, point: np.ndarray, k: int) -> bool:
    return bool(tracer.trace(world, ray=(tuple(eye), tuple(point - eye)), depth=0).nodes["object"][0] == k)
