"""A scene changed a little, or rendered in another way, so that a capability is used or not."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from tracer.scene import Material, Scene
from tracer.shapes.mesh import Geometry, Mesh


@dataclass(frozen=True)
class Variant:
    """Another scene, or the same one rendered in another way."""

    how: str  # what differs, in a few words
    scene: Scene
    options: dict[str, Any] = field(default_factory=dict)  # of `render`
    hierarchy: bool | None = None  # of `prepare`


Make = Callable[[Scene], Variant | str]  # a text says why there is no variant


def with_materials(scene: Scene, change: Callable[[Material], Material]) -> Scene:
    """The scene with every material changed."""
    return replace(scene, objects=tuple(replace(item, material=change(item.material)) for item in scene.objects))


def with_tracing(scene: Scene, **changes: Any) -> Scene:
    """The scene with other values of `[tracing]`."""
    return replace(scene, tracing=replace(scene.tracing, **changes))


def with_geometry(scene: Scene, change: Callable[[Geometry], Geometry]) -> Scene:
    """The scene with the geometry of every mesh changed."""

    def changed(shape: Any) -> Any:
        return replace(shape, geometry=change(shape.geometry)) if isinstance(shape, Mesh) else shape

    return replace(scene, objects=tuple(replace(item, shape=changed(item.shape)) for item in scene.objects))
