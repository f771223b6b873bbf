"""What a scene needs of the tracer, and what is left out because it does not: first of all for showing it."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tracer.accel.bvh import MAX_UNBOXED
from tracer.compile.simd import WIDTH
from tracer.shapes.cone import Cone
from tracer.shapes.disc import Disc
from tracer.shapes.mesh import NO_FILE, Mesh
from tracer.shapes.polygon import Polygon
from tracer.shapes.triangle import Triangle

if TYPE_CHECKING:
    from tracer.scene import Material, Object, Scene, Shape


TRANSMIT = ("transmits", "transmit")  # one, several


@dataclass(frozen=True, slots=True)
class Need:
    """One capability of the tracer and what this scene makes of it."""

    name: str
    needed: bool
    why: str


def needs(scene: Scene, surfaces: int, nodes: int, blocks: int) -> tuple[Need, ...]:
    """Every capability, needed or left out, with the reason in the scene's own terms."""
    materials = list(dict.fromkeys(item.material for item in scene.objects))
    glass = [item for item in scene.objects if item.material.transmit > 0.0]
    solids = [item for item in glass if not item.thin]
    mirrors = [item for item in scene.objects if item.material.reflect > 0.0]
    fresnel = scene.tracing.model == "fresnel"
    lit = [m for m in materials if shines(m)]
    meshes = [item for item in scene.objects if isinstance(item.shape, Mesh)]
    files = [item for item in meshes if isinstance(item.shape, Mesh) and item.shape.file != NO_FILE]
    smooth = [item for item in meshes if isinstance(item.shape, Mesh) and item.shape.geometry.normals is not None]
    splitting = [item for item in solids if item.material.ior != 1.0]
    return (
        Need("reflection", bool(mirrors) or bool(splitting), _which(mirrors or splitting, "reflects", "reflect")),
        Need("refraction", bool(glass), _which(glass, *TRANSMIT)),
        Need("media", bool(solids), _which(solids, "bounds a medium", "bound media")),
        Need("fresnel", fresnel and bool(glass), 'model = "fresnel"' if fresnel else 'model = "whitted"'),
        Need("dispersion", False, "every index is one number" if glass else _which(glass, *TRANSMIT)),
        Need("lens, glossy samples", False, "a pinhole, and every mirror is smooth"),
        Need("shadow rays", bool(scene.lights) and bool(lit), _shadow_reason(len(scene.lights), len(lit))),
        Need("light from behind", False, "it adds nothing to a surface" if scene.lights else "no light"),
        Need(
            "light through glass",
            bool(glass) and bool(scene.lights) and scene.tracing.shadows == "filter",
            _filter_reason(scene, glass),
        ),
        Need("checker", any(m.checker for m in materials), _checkered(materials)),
        Need("hierarchy", nodes > 0, _hierarchy(surfaces, nodes, blocks)),
        Need("mesh library", bool(files), _which(files, "comes from a mesh file", "come from mesh files")),
        Need(
            "vertex normals",
            bool(smooth),
            _which(smooth, "has normals at its vertices", "have normals at their vertices"),
        ),
    )


def shines(material: Material) -> bool:
    """Whether light makes a surface brighter."""
    return material.diffuse > 0.0 or material.specular > 0.0


def hidden_solids(ranked: list[Object]) -> list[str]:
    """Transparent solids that never show: inside another that outranks them. `ranked`: highest priority first.

    A solid counts as inside where all corners of its box are: what is told is so, though not all that is so is told.
    """
    endless = np.full(3, math.inf)
    boxes = [item.shape.bounds() for item in ranked]
    low = np.array([-endless if box is None else box[:, 0].min(axis=0) for box in boxes]).reshape(-1, 3)
    high = np.array([endless if box is None else box[:, 1].max(axis=0) for box in boxes]).reshape(-1, 3)
    notes = []
    for k, inner in enumerate(ranked):
        if boxes[k] is None:
            continue
        around = ((low[:k] <= low[k]) & (high[:k] >= high[k])).all(axis=1)
        corners = np.array(list(itertools.product(*zip(low[k], high[k], strict=True))))
        for outer in (ranked[j] for j in np.flatnonzero(around)):
            if all(outer.shape.contains(corner) for corner in corners):
                notes.append(f'"{_name(inner)}" lies inside "{_name(outer)}" and never shows: raise its priority')
                break
    return notes


def open_notes(opened: list[Object]) -> list[str]:
    """Of media that begin at a surface without an inside, a line each: light that enters there may never leave."""
    return [
        f'"{_name(item)}" is open: light that enters through it stays in its medium; make it thin, or a closed mesh'
        for item in opened
    ]


def is_open(shape: Shape) -> bool:
    """Whether a shape has no inside."""
    return not shape.is_closed() if isinstance(shape, Mesh) else isinstance(shape, Polygon | Triangle | Cone | Disc)


def _name(item: Object) -> str:
    return item.name or type(item.shape).__name__.lower()


def _which(objects: list, does: str, do: str) -> str:
    if not objects:
        return f"nothing {does}"
    first = objects[0]
    name = f'"{first.name}"' if first.name else f"a {_name(first)}"
    return f"{name} and {len(objects) - 1} more {do}" if len(objects) > 1 else f"{name} {does}"


def _shadow_reason(lights: int, lit: int) -> str:
    if not lights:
        return "no light"
    return _count(lights, "light") if lit else "no surface that light makes brighter"


def _filter_reason(scene: Scene, glass: list) -> str:
    if glass and scene.lights:
        return f'shadows = "{scene.tracing.shadows}"'
    return "no light" if glass else _which(glass, *TRANSMIT)


def _hierarchy(surfaces: int, nodes: int, blocks: int) -> str:
    count = _count(surfaces, "surface")
    if not nodes:
        return f"{count}: up to {MAX_UNBOXED} with an end are quicker tried one by one"
    triangles = f" and {_count(blocks, 'block')} of triangles" if blocks else ""
    return f"{count} in {_count(nodes, 'node')} of {WIDTH} boxes{triangles}"


def _checkered(materials: list) -> str:
    names = [f'"{m.name}"' for m in materials if m.checker]
    return ", ".join(names) or "no material has a checker"


def _count(n: int, one: str, many: str = "") -> str:
    return f"{n} {one if n == 1 else many or one + 's'}"
