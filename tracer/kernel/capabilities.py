"""The capabilities that a scene needs, and those that the world leaves out because it does not."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from tracer.accel.bvh import MAX_UNBOXED
from tracer.choices import FILTER, FRESNEL, MODELS, SHADOWS
from tracer.compile.simd import WIDTH
from tracer.printable import printable
from tracer.scene import Material, Object, Scene


class Capability(StrEnum):
    """A kind of work that an image may need. `tracer.measure.plan` renders each scene with and without it."""

    REFLECTION = "reflection"
    REFRACTION = "refraction"
    MEDIA = "media"
    FRESNEL = "fresnel"
    SHADOW_RAYS = "shadow rays"
    LIGHT_FROM_BEHIND = "light from behind"
    LIGHT_THROUGH_GLASS = "light through glass"
    CHECKER = "checker"
    HIERARCHY = "hierarchy"
    VERTEX_NORMALS = "vertex normals"


@dataclass(frozen=True, slots=True)
class Need:
    """Whether a scene needs a capability, and why."""

    name: str  # a Capability, or a part of the window
    needed: bool
    why: str


TRANSMITS = ("transmits", "transmit")  # singular and plural


def needs(scene: Scene, surfaces: int, nodes: int, blocks: int) -> tuple[Need, ...]:
    """Each capability, with the reason in the scene's own terms.

    `surfaces`, `nodes` and `blocks` are the counts of the prepared world.
    """
    materials = list(dict.fromkeys(item.material for item in scene.objects))
    glass = [item for item in scene.objects if item.material.transmit > 0.0]
    solids = [item for item in glass if not item.thin]
    mirrors = [item for item in scene.objects if item.material.reflect > 0.0]
    fresnel = scene.tracing.model == MODELS[FRESNEL]
    lit = [m for m in materials if m.is_lit]
    smooth = [item for item in scene.objects if item.shape.smooth() is not None]
    splitting = [item for item in solids if item.material.ior != 1.0]
    filtered = bool(glass) and bool(scene.lights) and scene.tracing.shadows == SHADOWS[FILTER]
    found = {
        Capability.REFLECTION: (bool(mirrors or splitting), _which(mirrors or splitting, "reflects", "reflect")),
        Capability.REFRACTION: (bool(glass), _which(glass, *TRANSMITS)),
        Capability.MEDIA: (bool(solids), _which(solids, "bounds a medium", "bound media")),
        Capability.FRESNEL: (fresnel and bool(glass), f'model = "{scene.tracing.model}"'),
        Capability.SHADOW_RAYS: (bool(scene.lights and lit), _shadow_reason(len(scene.lights), len(lit))),
        Capability.LIGHT_FROM_BEHIND: (
            False,
            "a light behind a surface adds nothing to it" if scene.lights else "no light",
        ),
        Capability.LIGHT_THROUGH_GLASS: (filtered, _filter_reason(scene, glass)),
        Capability.CHECKER: (any(m.checker for m in materials), _checkered(materials)),
        Capability.HIERARCHY: (nodes > 0, _hierarchy(surfaces, nodes, blocks)),
        Capability.VERTEX_NORMALS: (
            bool(smooth),
            _which(smooth, "has normals at its vertices", "have normals at their vertices"),
        ),
    }
    return tuple(Need(capability, *found[capability]) for capability in Capability)


def _which(objects: Sequence[Object], does: str, do: str) -> str:
    """A sentence on these objects, like `"ball" and 2 more transmit`."""
    if not objects:
        return f"nothing {does}"
    first = objects[0]
    name = f'"{first.name}"' if first.name else f"a {first.shape.name}"
    return f"{name} and {len(objects) - 1} more {do}" if len(objects) > 1 else f"{name} {does}"


def _shadow_reason(lights: int, lit: int) -> str:
    if not lights:
        return "no light"
    return _count(lights, "light") if lit else "no material has a diffuse or specular part"


def _filter_reason(scene: Scene, glass: Sequence[Object]) -> str:
    if glass and scene.lights:
        return f'shadows = "{scene.tracing.shadows}"'
    return "no light" if glass else _which(glass, *TRANSMITS)


def _hierarchy(surfaces: int, nodes: int, blocks: int) -> str:
    count = _count(surfaces, "surface")
    if not nodes:
        return f"{count}: up to {MAX_UNBOXED} bounded ones are tested faster one by one"
    triangles = f" and {_count(blocks, 'block')} of triangles" if blocks else ""
    return f"{count} in {_count(nodes, 'node')} of {WIDTH} boxes{triangles}"


def _checkered(materials: Sequence[Material]) -> str:
    names = [f'"{printable(m.name)}"' for m in materials if m.checker]
    return ", ".join(names) or "no material has a checker"


def _count(n: int, one: str) -> str:
    return f"{n} {one if n == 1 else one + 's'}"
