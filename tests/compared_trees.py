"""A recorded tree beside the judge's, row by row."""

from typing import Any, NamedTuple

import numpy as np

import tracer
from tests.exact_tracer import Judge, Ray, camera_ray, given_ray
from tracer.kernel.nodes import SHADOW
from tracer.shapes.box import Box
from tracer.shapes.cone import Cone


class Pair(NamedTuple):
    """A recorded row and the judge's ray; of a shadow row, the ray above it."""

    row: int
    ray: Ray
    agrees: bool  # on what is met and which rays are sent out; of a shadow row, on the share that passes
    whole: bool  # agrees, and so do all rows below


def judged_pixel(world: tracer.World, tree: tracer.RayTree) -> Ray:
    """The judge's tree of a pixel's centre."""
    scene = world.scene
    x, y = tree.image_point
    return Judge(scene, tree.depth, tree.model).tree(*camera_ray(scene.camera, tree.size, x, y))


def judged_ray(world: tracer.World, tree: tracer.RayTree) -> Ray:
    """The judge's tree of a ray by hand."""
    assert tree.ray is not None
    return Judge(world.scene, tree.depth, tree.model).tree(*given_ray(*tree.ray))


def compared(tree: tracer.RayTree, ray: Ray, i: int = 0) -> list[Pair]:
    """All pairs, down to the first row of each branch that does not agree."""
    row = tree.nodes[i]
    kinds = tree.nodes["kind"]
    below = [k for k in tree.children[i] if kinds[k] != SHADOW]
    same_surface = bool(row["object"] == ray.object) and is_same_face(tree, i, ray)
    agrees = same_surface and [tree.kind(k) for k in below] == [one.kind for one in ray.children]
    if not agrees:
        return [Pair(i, ray, False, False)]
    pairs: list[Pair] = []
    for k in tree.children[i]:
        if kinds[k] == SHADOW:
            same = shadow_agrees(tree, k, ray)
            pairs.append(Pair(k, ray, same, same))
    for k, one in zip(below, ray.children, strict=True):
        pairs += compared(tree, one, k)
    return [Pair(i, ray, True, all(pair.whole for pair in pairs)), *pairs]


def is_same_face(tree: tracer.RayTree, i: int, ray: Ray) -> bool:
    """Whether a box or a cone was hit on the judge's face of it; of a cone, on its side or on an end disc."""
    shape, recorded = tree.scene.objects[ray.object].shape, tree.nodes["normal"][i]
    if ray.normal is None or not isinstance(shape, Box | Cone):
        return True
    exact = np.array([float(x) for x in ray.normal])
    if isinstance(shape, Box):
        return abs(float(recorded @ exact)) > 0.99
    axis = np.subtract(shape.apex, shape.base) / np.linalg.norm(np.subtract(shape.apex, shape.base))
    return is_parallel(recorded, axis) == is_parallel(exact, axis)


def is_parallel(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.abs(np.cross(a, b)).max() < 1e-9)


def shadow_agrees(tree: tracer.RayTree, k: int, ray: Ray) -> bool:
    share: Any = ray.visible[int(tree.nodes["light"][k])]
    adds = bool(tree.nodes["local"][k].any())
    if share is None or not adds:
        lit = share is not None and float(share) > 0.0 and tree.scene.objects[ray.object].material.is_lit
        return not adds and not (lit and not tree.faces_away(k) and tree.nodes["factor"][k][0] == 0.0)
    return abs(float(tree.nodes["factor"][k][0]) - float(share)) <= 1e-12
