"""Variants of a scene that use a capability which the scene does not need, with the same picture.

There is one kernel, and the scene decides what it does. To make it do what a scene leaves out, the scene asks for it
in a way that cannot be seen: a surface reflects a fraction too small to change any sum, but its ray is traced; a
black light is tested at every hit; a checker has two equal colours. This is the work of a tracer that follows every
ray and multiplies by zero in the end.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracer.choices import BLOCK, FILTER, FRESNEL, MODELS, SHADOWS, WHITTED
from tracer.kernel.capabilities import Capability
from tracer.kernel.world import prepare
from tracer.measure.plan.variants import Make, Variant, with_geometry, with_materials, with_tracing
from tracer.scene import Checker, Light, Object, Scene
from tracer.shapes.mesh import Geometry, Mesh

MAX_DEPTH = 4  # a tree whose hits all send out two rays doubles with each level
UNSEEN = 2.0**-1000  # a weight that vanishes beside any number of a picture
UNFOLLOWED = {"min_weight": 2.0**-990}  # rays of such a weight are not followed


def depth_of(scene: Scene) -> int:
    """The depth at which a scene is measured."""
    return min(scene.tracing.depth, MAX_DEPTH)


def faint(scene: Scene) -> float:
    """A weight so faint that it is not seen, but whose power by the depth does not underflow."""
    return 2.0 ** -(1000 // max(1, depth_of(scene)))


def with_glass(scene: Scene, share: float, model: int = WHITTED, ior: float = 1.0) -> Scene:
    """The scene in a model, with its opaque objects as thin sheets that transmit `share`.

    In Fresnel's model mirrors stay opaque: as glass they would reflect less.
    """

    def changed(item: Object) -> Object:
        if item.material.transmit > 0.0 or (model == FRESNEL and item.material.reflect > 0.0):
            return item
        return replace(item, thin=True, material=replace(item.material, transmit=share, ior=ior))

    return with_tracing(replace(scene, objects=tuple(map(changed, scene.objects))), model=MODELS[model])


def with_reflection(scene: Scene) -> Variant | str:
    w = faint(scene)
    return Variant(f"every surface reflects {w:.0e}", with_materials(scene, lambda m: replace(m, reflect=w)))


def with_refraction(scene: Scene) -> Variant | str:
    w = faint(scene)
    return Variant(
        f"every surface transmits {w:.0e}",
        with_tracing(with_glass(scene, w), shadows=SHADOWS[BLOCK]),
    )


def with_media(scene: Scene) -> Variant | str:
    def filled(item: Object) -> Object:
        is_mirror = item.material.reflect > 0.0 and scene.tracing.model == MODELS[FRESNEL]  # glass would reflect less
        if item.material.transmit > 0.0 or is_mirror or not item.shape.is_closed():
            return item
        return replace(item, material=replace(item.material, transmit=UNSEEN, ior=1.5))

    objects = tuple(filled(item) for item in scene.objects)
    if objects == scene.objects:
        return "no closed object"
    blocks = all(item.material.transmit == 0.0 for item in scene.objects)
    shadows = SHADOWS[BLOCK] if blocks else scene.tracing.shadows
    return Variant(
        "closed objects bound media", with_tracing(replace(scene, objects=objects), shadows=shadows), UNFOLLOWED
    )


def with_fresnel(scene: Scene) -> Variant | str:
    if scene.has_glass:
        return Variant("Fresnel's equations: another picture", with_tracing(scene, model=MODELS[FRESNEL]))
    if all(item.material.reflect > 0.0 for item in scene.objects):
        return "no surface but mirrors"
    other = with_tracing(with_glass(scene, UNSEEN, FRESNEL, ior=1.5), shadows=SHADOWS[BLOCK])
    return Variant("Fresnel's shares at every hit", other, UNFOLLOWED)


def with_shadow_rays(scene: Scene) -> Variant | str:
    other = with_materials(scene, lambda m: m if m.is_lit else replace(m, diffuse=1.0))
    if scene.lights:
        lights = tuple(replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
        return Variant("matte surfaces, black lamps", replace(other, lights=lights))
    lamp = Light("black", position=prepare(scene).view().eye, color=(0.0, 0.0, 0.0))
    return Variant("matte surfaces, a black lamp", replace(other, lights=(lamp,)))


def with_filtered_light(scene: Scene) -> Variant | str:
    if not scene.lights or not any(item.material.is_lit for item in scene.objects):
        return "no shadow rays"
    if scene.has_glass:
        return Variant("glass dims shadows: another picture", with_tracing(scene, shadows=SHADOWS[FILTER]))
    return Variant(
        "shadow rays cross every surface",
        with_tracing(with_glass(scene, UNSEEN), shadows=SHADOWS[FILTER]),
        UNFOLLOWED,
    )


def with_checker(scene: Scene) -> Variant | str:
    return Variant(
        "checkers of two equal colours",
        with_materials(scene, lambda m: replace(m, checker=Checker(m.color))),
    )


def with_hierarchy(scene: Scene) -> Variant | str:
    if all(item.shape.bounds() is None for item in scene.objects):
        return "no bounded surface"
    return Variant("a hierarchy over the few surfaces", scene, hierarchy=True)


def with_normals(scene: Scene) -> Variant | str:
    if not any(isinstance(item.shape, Mesh) for item in scene.objects):
        return "no mesh"
    return Variant("faces' own normals", with_geometry(scene, _own_normals))


def everything(scene: Scene, left_out: Sequence[str]) -> Variant:
    """A variant with all left-out capabilities that do not change the picture.

    If only some surfaces need a kind of ray, the others also send one.
    """
    w = faint(scene)
    model = WHITTED if any(item.material.reflect > 0.0 for item in scene.objects) else FRESNEL
    for capability in (Capability.SHADOW_RAYS, Capability.CHECKER):
        if capability in left_out and isinstance(variant := WITH[capability](scene), Variant):
            scene = variant.scene
    if Capability.REFRACTION not in left_out:
        scene = with_materials(scene, lambda m: replace(m, reflect=m.reflect or w))
        return Variant("a reflected ray from every hit", scene)
    scene = with_materials(with_glass(scene, w, ior=1.5), lambda m: replace(m, reflect=m.reflect or w))
    scene = with_tracing(scene, model=MODELS[model], shadows=SHADOWS[FILTER])
    return Variant("two rays from every hit", scene)


def _own_normals(geometry: Geometry) -> Geometry:
    """The same triangles, with the normals of the faces as vertex normals."""
    corners = geometry.vertices[geometry.faces]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(n, axis=1, keepdims=True)
    n = np.repeat(n / np.where(size > 0.0, size, 1.0), 3, axis=0)
    return Geometry(corners.reshape(-1, 3), np.arange(len(n)).reshape(-1, 3), n)


WITH: dict[str, Make] = {
    Capability.REFLECTION: with_reflection,
    Capability.REFRACTION: with_refraction,
    Capability.MEDIA: with_media,
    Capability.FRESNEL: with_fresnel,
    Capability.SHADOW_RAYS: with_shadow_rays,
    Capability.LIGHT_THROUGH_GLASS: with_filtered_light,
    Capability.CHECKER: with_checker,
    Capability.HIERARCHY: with_hierarchy,
    Capability.VERTEX_NORMALS: with_normals,
}
