"""The same scene asking for a capability more: what leaving it out saves is the difference.

There is one kernel, and what it does is decided by the scene. So that it does what a scene leaves out, the scene is
made to ask for it in a way that cannot be seen: a surface reflects so faint a share of the light that no sum notices
it, but the ray is traced all the same; a black light is asked for at every hit; a checker has two equal colours. That
is the work of a tracer that follows every ray and multiplies by nothing in the end, for the same picture.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tracer.kernel.left_out import is_open, shines
from tracer.kernel.world import prepare
from tracer.scene import Checker, Light, Material, Object, Scene
from tracer.shapes.mesh import Geometry, Mesh

DEEPEST = 4  # so deep at most: a tree whose every hit sends out two rays doubles with each level
UNSEEN = 2.0**-1000  # a weight that vanishes beside any number a picture is made of
UNFOLLOWED = {"min_weight": 2.0**-990}  # what is unseen is not followed, either
SAMPLES = 16  # a pixel, as lenses and rough mirrors ask for at the very least


@dataclass(frozen=True)
class Variant:
    """Another scene, or the same one rendered otherwise."""

    how: str  # what is different
    scene: Scene
    options: dict[str, Any] = field(default_factory=dict)  # of `render`
    hierarchy: bool | None = None  # of `prepare`
    images: int = 1  # to be rendered


Make = Callable[[Scene], Variant | str]  # or why there is none


def faint(scene: Scene) -> float:
    """A weight of which the power by the depth is still a number."""
    return 2.0 ** -(1000 // max(1, depth_of(scene)))


def depth_of(scene: Scene) -> int:
    """At which it is measured."""
    return min(scene.tracing.depth, DEEPEST)


def with_materials(scene: Scene, change: Callable[[Material], Material]) -> Scene:
    return replace(scene, objects=tuple(replace(item, material=change(item.material)) for item in scene.objects))


def with_tracing(scene: Scene, **changes: Any) -> Scene:
    return replace(scene, tracing=replace(scene.tracing, **changes))


def with_glass(scene: Scene, share: float, ior: float = 1.0) -> Scene:
    """Every opaque object as a thin sheet that lets this share through."""
    return replace(
        scene,
        objects=tuple(
            item
            if item.material.transmit > 0.0
            else replace(item, thin=True, material=replace(item.material, transmit=share, ior=ior))
            for item in scene.objects
        ),
    )


def with_reflection(scene: Scene) -> Variant | str:
    w = faint(scene)
    return Variant(f"every surface reflects {w:.0e}", with_materials(scene, lambda m: replace(m, reflect=w)))


def with_refraction(scene: Scene) -> Variant | str:
    w = faint(scene)
    return Variant(
        f"every surface transmits {w:.0e}",
        with_tracing(with_glass(scene, w), shadows="block"),
    )


def with_media(scene: Scene) -> Variant | str:
    def filled(item: Object) -> Object:
        if item.material.transmit > 0.0 or is_open(item.shape):
            return item
        return replace(item, material=replace(item.material, transmit=UNSEEN, ior=1.5))

    objects = tuple(filled(item) for item in scene.objects)
    if objects == scene.objects:
        return "no object has an inside"
    blocks = all(item.material.transmit == 0.0 for item in scene.objects)
    other = with_tracing(replace(scene, objects=objects), shadows="block" if blocks else scene.tracing.shadows)
    return Variant("closed objects bound media", other, UNFOLLOWED)


def with_fresnel(scene: Scene) -> Variant | str:
    if any(item.material.transmit > 0.0 for item in scene.objects):
        return Variant("Fresnel's law: another picture", with_tracing(scene, model="fresnel"))
    other = with_tracing(with_glass(scene, UNSEEN, ior=1.5), model="fresnel", shadows="block")
    return Variant("Fresnel's shares at every hit", other, UNFOLLOWED)


def with_dispersion(scene: Scene) -> Variant | str:
    return Variant("three images, one a wavelength", scene, images=3)


def with_samples(scene: Scene) -> Variant | str:
    return Variant(f"{SAMPLES} rays a pixel", scene, {"samples": SAMPLES})


def with_shadow_rays(scene: Scene) -> Variant | str:
    other = with_materials(scene, lambda m: m if shines(m) else replace(m, diffuse=1.0))
    if scene.lights:
        lights = tuple(replace(light, color=(0.0, 0.0, 0.0)) for light in scene.lights)
        return Variant("matte surfaces, black lamps", replace(other, lights=lights))
    lamp = Light("black", position=prepare(scene).view().eye, color=(0.0, 0.0, 0.0))
    return Variant("matte surfaces, a black lamp", replace(other, lights=(lamp,)))


def with_filtered_light(scene: Scene) -> Variant | str:
    if not scene.lights or not any(shines(item.material) for item in scene.objects):
        return "no shadow ray asks for it"
    if any(item.material.transmit > 0.0 for item in scene.objects):
        return Variant("glass dims shadows: another picture", with_tracing(scene, shadows="filter"))
    return Variant(
        "shadow rays cross every surface",
        with_tracing(with_glass(scene, UNSEEN), shadows="filter"),
        UNFOLLOWED,
    )


def with_checker(scene: Scene) -> Variant | str:
    return Variant(
        "checkers of two equal colours",
        with_materials(scene, lambda m: replace(m, checker=Checker(m.color))),
    )


def with_hierarchy(scene: Scene) -> Variant | str:
    if all(item.shape.bounds() is None for item in scene.objects):
        return "no surface has an end"
    return Variant("a hierarchy of those few", scene, hierarchy=True)


def with_normals(scene: Scene) -> Variant | str:
    if not any(isinstance(item.shape, Mesh) for item in scene.objects):
        return "no mesh whose vertices could have one"
    return Variant("faces' own normals", with_geometry(scene, _own_normals))


def everything(scene: Scene, left_out: Sequence[str]) -> Variant:
    """What is left out and would change no picture, all at once. Also of a kind of ray that some surfaces need, the
    other surfaces send one."""
    w = faint(scene)
    for name, make in (("shadow rays", with_shadow_rays), ("checker", with_checker)):
        if name in left_out and isinstance(variant := make(scene), Variant):
            scene = variant.scene
    scene = with_materials(scene, lambda m: replace(m, reflect=m.reflect or w))
    if "refraction" not in left_out:
        return Variant("a reflected ray from every hit", scene)
    scene = with_tracing(with_glass(scene, w, ior=1.5), model="fresnel", shadows="filter")
    return Variant("two rays from every hit", scene)


def with_geometry(scene: Scene, change: Callable[[Geometry], Geometry]) -> Scene:
    def changed(item: Object) -> Object:
        if not isinstance(item.shape, Mesh):
            return item
        return replace(item, shape=replace(item.shape, geometry=change(item.shape.geometry)))

    return replace(scene, objects=tuple(changed(item) for item in scene.objects))


def _own_normals(geometry: Geometry) -> Geometry:
    """The same triangles, each with vertices of its own that have its normal."""
    corners = geometry.vertices[geometry.faces]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(n, axis=1, keepdims=True)
    n = np.repeat(n / np.where(size > 0.0, size, 1.0), 3, axis=0)
    return Geometry(corners.reshape(-1, 3), np.arange(len(n)).reshape(-1, 3), n)


# By the names of `tracer.kernel.left_out`.
WITH: dict[str, Make] = {
    "reflection": with_reflection,
    "refraction": with_refraction,
    "media": with_media,
    "fresnel": with_fresnel,
    "dispersion": with_dispersion,
    "lens, glossy samples": with_samples,
    "shadow rays": with_shadow_rays,
    "light through glass": with_filtered_light,
    "checker": with_checker,
    "hierarchy": with_hierarchy,
    "vertex normals": with_normals,
}
