"""The same scene with a capability less: what it costs is the difference.

What a scene needs cannot be taken away without changing its picture, but for the hierarchy; so each of these is a
plainer scene, and the difference is what this one's own picture costs more.
"""

from dataclasses import replace

from tracer.measure.plan.with_capability import Make, Variant, with_geometry, with_materials, with_tracing
from tracer.scene import Scene


def without_reflection(scene: Scene) -> Variant | str:
    other = with_tracing(with_materials(scene, lambda m: replace(m, reflect=0.0)), model="whitted")
    return Variant("no reflection but the total one", other)


def without_refraction(scene: Scene) -> Variant | str:
    return Variant("glass is opaque", with_materials(scene, lambda m: replace(m, transmit=0.0)))


def without_media(scene: Scene) -> Variant | str:
    return Variant("glass is thin sheets", replace(scene, objects=tuple(replace(x, thin=True) for x in scene.objects)))


def without_fresnel(scene: Scene) -> Variant | str:
    return Variant("Whitted's fixed weights", with_tracing(scene, model="whitted"))


def without_shadow_rays(scene: Scene) -> Variant | str:
    return Variant("no lights", replace(scene, lights=()))


def without_filtered_light(scene: Scene) -> Variant | str:
    return Variant("glass blocks shadow rays", with_tracing(scene, shadows="block"))


def without_checker(scene: Scene) -> Variant | str:
    return Variant("no checker", with_materials(scene, lambda m: replace(m, checker=None)))


def without_hierarchy(scene: Scene) -> Variant | str:
    return Variant("every ray tries every surface", scene, hierarchy=False)


def without_normals(scene: Scene) -> Variant | str:
    return Variant("flat faces", with_geometry(scene, lambda g: replace(g, normals=None)))


# By the names of `tracer.kernel.left_out`.
WITHOUT: dict[str, Make] = {
    "reflection": without_reflection,
    "refraction": without_refraction,
    "media": without_media,
    "fresnel": without_fresnel,
    "shadow rays": without_shadow_rays,
    "light through glass": without_filtered_light,
    "checker": without_checker,
    "hierarchy": without_hierarchy,
    "vertex normals": without_normals,
}
