"""The scene as frozen dataclasses, each field with its rule and its default.

Format 1 of scene files uses the same names. Lengths are in the author's unit, colours in linear RGB, angles in
degrees; the frame is right-handed.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tracer import fields
from tracer.choices import MODELS, SHADOWS
from tracer.formulas.media import INDICES
from tracer.formulas.vector import Vector
from tracer.printable import printable
from tracer.shapes import Shape


def _zero() -> Any:
    """A number of format 1 that is not traced yet. It is refused, not ignored."""

    def read(value: Any) -> float:
        if value != 0 or isinstance(value, bool):
            raise fields.Refused("0 (this version traces no other)")
        return 0.0

    return fields.rule(read)


def _index() -> Any:
    """An index of refraction: a number or the name of a medium."""

    def read(value: Any) -> float:
        if isinstance(value, str):
            if value in INDICES:
                return INDICES[value]
            raise fields.Refused(f"a number > 0 or {fields.one_of(INDICES)}{fields.nearest(value, INDICES)}")
        if isinstance(value, dict):
            raise fields.Refused("a number > 0 or the name of a medium (this version traces no dispersion)")
        return fields.number(above=0)["read"](value)

    return fields.rule(read)


@dataclass(frozen=True, slots=True)
class Camera:
    position: Vector | None = field(default=None, metadata=fields.point())  # None: where it sees the whole scene
    look_at: Vector | None = field(default=None, metadata=fields.point())  # None: the middle of the scene
    up: Vector = field(default=(0.0, 1.0, 0.0), metadata=fields.direction())
    fov: float = field(default=40.0, metadata=fields.number(above=0, below=180))  # degrees over the image's full height
    lens_radius: float = field(default=0.0, metadata=_zero())
    focus_distance: float = field(default=1.0, metadata=fields.number(above=0))

    def faults(self) -> list[str]:
        if self.position is None or self.look_at is None:
            return []
        gaze = np.subtract(self.look_at, self.position)
        if not gaze.any():
            return [f"look_at must differ from position, got {fields.shown(self.look_at)} for both"]
        if not np.cross(gaze / np.abs(gaze).max(), self.up).any():
            return [f"up must not point along the line of sight, got {fields.shown(self.up)}"]
        return []


@dataclass(frozen=True, slots=True)
class Image:
    width: int = field(default=640, metadata=fields.whole(1, 16384))
    height: int = field(default=480, metadata=fields.whole(1, 16384))
    samples: int = field(default=1, metadata=fields.whole(1, 4096))  # of a pixel; 1: its centre


@dataclass(frozen=True, slots=True)
class Background:
    color: Vector = field(default=(0.0, 0.0, 0.0), metadata=fields.color())


@dataclass(frozen=True, slots=True)
class Tracing:
    depth: int = field(default=3, metadata=fields.whole(0, 10**9))  # 0: camera rays and their shadow rays only
    shadows: str = field(default=SHADOWS[0], metadata=fields.choice(*SHADOWS))  # of transparent surfaces
    model: str = field(default=MODELS[0], metadata=fields.choice(*MODELS))
    ambient: Vector = field(default=(1.0, 1.0, 1.0), metadata=fields.color())


@dataclass(frozen=True, slots=True)
class Light:
    name: str = field(default="", metadata=fields.text())
    position: Vector | None = field(default=None, metadata=fields.point())
    direction: Vector | None = field(default=None, metadata=fields.direction())  # in which its light travels
    color: Vector = field(default=(1.0, 1.0, 1.0), metadata=fields.color())
    radius: float = field(default=0.0, metadata=_zero())

    def faults(self) -> list[str]:
        if (self.position is None) == (self.direction is None):
            found = "neither" if self.position is None else "both"
            return [f"a light has either a position or a direction, got {found}"]
        return []


@dataclass(frozen=True, slots=True)
class Checker:
    color: Vector = field(metadata=fields.color())
    size: float = field(default=1.0, metadata=fields.number(above=0))


@dataclass(frozen=True, slots=True)
class Material:
    name: str = field(default="", metadata=fields.text())
    color: Vector = field(default=(1.0, 1.0, 1.0), metadata=fields.color())  # C: tints ambient and diffuse
    ambient: float = field(default=0.0, metadata=fields.number(least=0))  # ka
    diffuse: float = field(default=0.0, metadata=fields.number(least=0))  # kd
    specular: float = field(default=0.0, metadata=fields.number(least=0))  # ks
    shininess: float = field(default=1.0, metadata=fields.number(above=0))  # p
    reflect: float = field(default=0.0, metadata=fields.number(least=0, most=1))  # kr
    transmit: float = field(default=0.0, metadata=fields.number(least=0, most=1))  # kt
    ior: float = field(default=1.0, metadata=_index())  # counts only where transmit > 0
    roughness: float = field(default=0.0, metadata=_zero())
    checker: Checker | None = None

    @property
    def is_lit(self) -> bool:
        """Whether its local term depends on the lights."""
        return self.diffuse > 0.0 or self.specular > 0.0


@dataclass(frozen=True, slots=True)
class Object:
    shape: Shape
    material: Material
    name: str = field(default="", metadata=fields.text())
    priority: int = field(default=0, metadata=fields.whole(-(10**6), 10**6))  # higher wins where glass overlaps
    thin: bool = field(default=False, metadata=fields.flag())  # a sheet that transmits unbent and bounds no medium


@dataclass(frozen=True, slots=True)
class Scene:
    objects: tuple[Object, ...]
    lights: tuple[Light, ...] = ()
    camera: Camera = Camera()
    image: Image = Image()
    background: Background = Background()
    tracing: Tracing = Tracing()
    title: str = ""
    path: Path | None = None  # the file it came from
    notes: tuple[str, ...] = ()  # what its files have and it has not, a line each
    files: tuple[Path, ...] = ()  # the files that it was read from, also those that were not found

    @property
    def caption(self) -> str:
        """Its title, else the name of its file, as it is shown."""
        return printable(self.title or (self.path.name if self.path else "scene"))

    @property
    def has_glass(self) -> bool:
        """Whether an object lets light through."""
        return any(item.material.transmit > 0.0 for item in self.objects)

    def object_name(self, k: int) -> str:
        """The name of object k as it is shown, or its shape and number if the author gave none."""
        item = self.objects[k]
        return printable(item.name) or f"{item.shape.name} {k}"

    def light_name(self, j: int) -> str:
        """The name of light j as it is shown, or its number if the author gave none."""
        return printable(self.lights[j].name) or f"light {j}"

    def faults(self) -> list[str]:
        """Every value that is not allowed, a line each, by the same rules as for a file."""
        parts: list[tuple[str, Any]] = [("camera", self.camera), ("image", self.image)]
        parts += [("background", self.background), ("tracing", self.tracing)]
        parts += [(place("light", k, light.name), light) for k, light in enumerate(self.lights)]
        items: dict[type, list[Object]] = {}
        for item in self.objects:
            items.setdefault(type(item.shape), []).append(item)
        # Of many shapes of one type, nearly always all values are allowed: they are checked together.
        fine = {kind for kind, own in items.items() if kind.faults is Shape.faults and _allows_all(own)}
        materials: set[int] = set()
        for k, item in enumerate(self.objects):
            if type(item.shape) not in fine:
                here = place("object", k, item.name)
                parts += [(here, item), (here, item.shape)]
            if id(item.material) not in materials:
                materials.add(id(item.material))
                here = place("object", k, item.name)
                parts.append((f'{here}: material "{printable(item.material.name)}"', item.material))
        found = []
        for here, part in parts:
            faults = fields.value_faults(part)
            if not faults and hasattr(part, "faults"):
                faults = part.faults()
            found += [f"{here}: {fault}" for fault in faults]
        if not self.objects:
            found.append("a scene needs at least one object")
        return found


def _allows_all(items: list[Object]) -> bool:
    """Whether all values of objects with shapes of one type are allowed; see `fields.allow_all`."""
    return fields.allow_all([item.shape for item in items]) and fields.allow_all(items)


class SceneError(ValueError):
    """A scene that cannot be used. `faults` has a line for each fault, `files` are those that were read."""

    def __init__(self, faults: list[str], files: tuple[Path, ...] = ()) -> None:
        self.faults = [printable(fault) for fault in faults]
        super().__init__("\n".join(self.faults))
        self.files = files


def place(table: str, k: int, name: str = "") -> str:
    """The place of a fault in a file, like `object[2] "ball"`: the k-th table of a kind, counted from 0."""
    return f'{table}[{k}] "{printable(name)}"' if name else f"{table}[{k}]"


def middle_and_radius(bounds: np.ndarray) -> tuple[np.ndarray, float]:
    """(centre, radius) of a ball around boxes (n, 2, 3)."""
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    return 0.5 * (low + high), 0.5 * math.dist(low, high)
