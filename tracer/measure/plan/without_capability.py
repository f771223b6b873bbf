"""Variants of a scene without a capability that the scene needs.

Except for the hierarchy, this changes the picture: each variant is a simpler scene, and the difference is the
additional cost of the original picture.
"""

from dataclasses import replace

from tracer.choices import BLOCK, MODELS, SHADOWS, WHITTED
from tracer.kernel.capabilities import Capability
from tracer.measure.plan.variants import Make, Variant, with_geometry, with_materials, with_tracing
from tracer.scene import Scene


def without_reflection(scene: Scene) -> Variant | str:
    other = with_tracing(with_materials(scene, lambda m: replace(m, reflect=0.0)), model=MODELS[WHITTED])
    return Variant("no reflection but total internal reflection", other)


def without_refraction(scene: Scene) -> Variant | str:
    return Variant("glass is opaque", with_materials(scene, lambda m: replace(m, transmit=0.0)))


def without_media(scene: Scene) -> Variant | str:
    return Variant("glass is thin sheets", replace(scene, objects=tuple(replace(x, thin=True) for x in scene.objects)))


def without_fresnel(scene: Scene) -> Variant | str:
    return Variant("Whitted's fixed weights", with_tracing(scene, model=MODELS[WHITTED]))


def without_shadow_rays(scene: Scene) -> Variant | str:
    return Variant("no lights", replace(scene, lights=()))


def without_filtered_light(scene: Scene) -> Variant | str:
    return Variant("glass blocks shadow rays", with_tracing(scene, shadows=SHADOWS[BLOCK]))


def without_checker(scene: Scene) -> Variant | str:
    return Variant("no checker", with_materials(scene, lambda m: replace(m, checker=None)))


def without_hierarchy(scene: Scene) -> Variant | str:
    return Variant("every ray tests every surface", scene, hierarchy=False)


def without_normals(scene: Scene) -> Variant | str:
    return Variant("flat faces", with_geometry(scene, lambda g: replace(g, normals=None)))


WITHOUT: dict[str, Make] = {
    Capability.REFLECTION: without_reflection,
    Capability.REFRACTION: without_refraction,
    Capability.MEDIA: without_media,
    Capability.FRESNEL: without_fresnel,
    Capability.SHADOW_RAYS: without_shadow_rays,
    Capability.LIGHT_THROUGH_GLASS: without_filtered_light,
    Capability.CHECKER: without_checker,
    Capability.HIERARCHY: without_hierarchy,
    Capability.VERTEX_NORMALS: without_normals,
}
