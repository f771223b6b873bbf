"""Eric Haines' Neutral File Format, in which ray tracers have been compared since 1987.

E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the text NFF.TXT of his
Standard Procedural Databases. A file is a sequence of entities, each a letter and its numbers. A line end only ends
a comment:

    v   from, at, up, angle, hither, resolution        f   r g b Kd Ks shine T ior, of all objects that follow
    b   r g b of the background                        s   centre, radius
    l   position [r g b]                               p   count, corners;  pp  the same, each corner with its normal
    c   base, its radius, apex, its radius: the side of a cone or a cylinder

Ks is both the specular and the reflection coefficient. Consecutive triangles and patches of one material become one
mesh. A transparent ball of negative radius inside another ball is a cavity: empty space with a higher priority. Other
surfaces are seen from both sides, also those of negative radius, which the format means to be seen from inside.
"""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tracer import fields
from tracer.formats.nff_polygons import Patches, flattened
from tracer.formats.notes import Notes
from tracer.formats.source import Fault, read_text
from tracer.formats.words import Word, Words
from tracer.formulas.vector import Vector, as_floats, rescale, unit
from tracer.printable import shown_path
from tracer.scene import Background, Camera, Image, Light, Material, Object, Scene, SceneError, Shape
from tracer.shapes.cone import Cone
from tracer.shapes.planar import unit_normal
from tracer.shapes.polygon import Polygon
from tracer.shapes.sphere import Sphere

ENTITIES = {
    "v": "the camera", "b": "the background", "l": "a light", "f": "a material",
    "s": "a sphere", "p": "a polygon", "pp": "a patch", "c": "a cone",
}  # fmt: skip
VIEW = {"from": 3, "at": 3, "up": 3, "angle": 1, "hither": 1, "resolution": 2}

# The names of fields in the format.
FORMAT_NAMES: dict[type, dict[str, str]] = {
    Camera: {"position": '"from"', "look_at": '"at"'},
    Material: {
        "color": "r g b", "diffuse": "Kd", "specular": "Ks", "shininess": "shine", "reflect": "Ks", "transmit": "T",
    },
}  # fmt: skip

MOST_CORNERS = 10**6


def read_nff(path: Path, progress: Callable[[float], None]) -> Scene:
    """Read a file. Raises SceneError with every fault, and OSError if it cannot be read."""
    try:
        text = read_text(path)
    except Fault as fault:
        raise SceneError([fault.within(shown_path(path))]) from None
    if "\0" in text:
        raise SceneError([f"{shown_path(path)}: an NFF file is text, got a zero byte at {text.index(chr(0))}"])
    return Reader(path, Words(text, {*ENTITIES, *VIEW})).scene(progress)


class Reader:
    """Reads one entity after another. After a fault it goes on with the next, so that all faults are found at once."""

    def __init__(self, path: Path, words: Words) -> None:
        self.path = path
        self.words = words
        self.faults: list[tuple[int, str]] = []  # with the line
        self.line = 0  # of the entity that is read
        self.unchecked: dict[type, list[tuple[int, str, Shape]]] = {}  # (line, name, shape), by type
        self.camera, self.image, self.background = Camera(), Image(), Background()
        self.lights: list[tuple[Vector, Vector | None]] = []
        self.material: Material | None = None
        self.shapes: list[tuple[Shape, Material]] = []
        self.run: Patches | None = None
        self.inverted: list[int] = []  # shapes of negative radius

    def scene(self, progress: Callable[[float], None]) -> Scene:
        while self.words.left():
            progress(self.words.share())
            word = self.words.take()
            self.line = word.line
            try:
                self._entity(word)
            except Fault as fault:
                self.faults.append((fault.line or word.line, str(fault)))
                if word.text == "f":
                    self.material = Material()  # what follows has one, though it could not be read
                self.words.skip()
        self._end_run()
        self._check_shapes()
        path = shown_path(self.path)
        if self.faults:
            raise SceneError([f"{path}: line {line}: {text}" for line, text in sorted(self.faults)])
        if not self.shapes:
            raise SceneError([f"{path}: a scene needs at least one object (s, p, pp or c), got none"])
        cavities = self._cavities()
        notes = Notes()
        notes.count(
            "surfaces of negative radius inside no ball are shown from both sides", len(self.inverted) - len(cavities)
        )
        objects = [
            Object(shape, replace(material, ior=1.0), priority=1) if k in cavities else Object(shape, material)
            for k, (shape, material) in enumerate(self.shapes)
        ]
        parts = (tuple(objects), tuple(self._lights()), self.camera, self.image, self.background)
        own = tuple(f"{self.path.name}: {note}" for note in notes.lines())
        return Scene(*parts, title=self.path.stem, path=self.path, notes=own, files=(self.path,))

    def _check_shapes(self) -> None:
        """Check all shapes: those of one type together, and one by one if that finds a fault."""
        for kind, shapes in self.unchecked.items():
            if kind.faults is Shape.faults and fields.allow_all([shape for _, _, shape in shapes]):
                continue
            for line, name, shape in shapes:
                try:
                    self._checked(shape, name)
                except Fault as fault:
                    self.faults.append((line, str(fault)))

    def _cavities(self) -> set[int]:
        """The transparent balls of negative radius that lie inside a transparent ball of positive radius."""
        balls = [
            (k, shape.center, shape.radius)
            for k, (shape, material) in enumerate(self.shapes)
            if self.inverted and isinstance(shape, Sphere) and material.transmit > 0.0
        ]
        inverted = set(self.inverted)
        outer = [(center, radius) for k, center, radius in balls if k not in inverted]
        if not outer:
            return set()
        centers, radii = np.array([center for center, _ in outer]), np.array([radius for _, radius in outer])
        found = set()
        for k, center, radius in balls:
            if k in inverted and (np.linalg.norm(centers - center, axis=1) + radius <= radii).any():
                found.add(k)
        return found

    def _entity(self, word: Word) -> None:
        number, vector = self.words.number, self.words.vector
        match word.text:
            case "v":
                self._view()
            case "b":
                self.background = self._checked(Background(vector("r g b of the background")), "background")
            case "l":
                self._light()
            case "f":
                self._fill()
            case "s":
                center, radius = vector("the centre of a sphere"), number("the radius of a sphere")
                self._add(Sphere(center, abs(radius)), "sphere")
                if radius < 0.0:
                    self.inverted.append(len(self.shapes) - 1)
            case "p" | "pp":
                self._polygon(word.text == "pp")
            case "c":
                base, base_radius = vector("the base of a cone"), number("its radius")
                apex, apex_radius = vector("the apex of a cone"), number("its radius")
                if base_radius * apex_radius < 0.0:
                    raise Fault(f"a cone's radii must have one sign, got {base_radius:g} and {apex_radius:g}")
                self._add(Cone(base, abs(base_radius), apex, abs(apex_radius)), "cone")
                if base_radius < 0.0 or apex_radius < 0.0:
                    self.inverted.append(len(self.shapes) - 1)
            case other:
                known = ", ".join(f"{name} ({what})" for name, what in ENTITIES.items())
                raise Fault(f'an entity must be one of {known}, got "{other}"')

    def _view(self) -> None:
        found: dict[str, list[float]] = {}
        lines: dict[str, int] = {}
        while self.words.next_in(VIEW):
            name, lines[name] = self.words.take()
            found[name] = [self.words.number(f"{name} of v") for _ in range(VIEW[name])]
        missing = [name for name in VIEW if name not in found and name != "hither"]
        if missing:
            raise Fault(f"v must have from, at, up, angle and resolution, got no {', '.join(missing)}")
        width, height = found["resolution"]
        if not (width.is_integer() and height.is_integer()):
            raise Fault(f"resolution must be two whole numbers, got {width:g} {height:g}", lines["resolution"])
        self.image = self._checked(Image(int(width), int(height)), "resolution", lines["resolution"])
        angle = found["angle"][0]
        if not 0.0 < angle < 180.0:
            raise Fault(f"angle must be > 0 and < 180, got {angle:g}", lines["angle"])
        # The angle is from the middle of the top row of pixels to that of the bottom row. The field of view of a Camera
        # is from edge to edge.
        edge = math.tan(0.5 * math.radians(angle)) * height / max(1.0, height - 1.0)
        eye, middle, up = (as_floats(found[name]) for name in ("from", "at", "up"))
        self.camera = self._checked(Camera(eye, middle, up, 2.0 * math.degrees(math.atan(edge))), "v", lines["at"])

    def _light(self) -> None:
        position = self.words.vector("the position of a light")
        color = self.words.vector("r g b of a light") if self.words.number_follows() else None
        self._checked(Light(position=position, color=color or (1.0, 1.0, 1.0)), "light")
        self.lights.append((position, color))

    def _fill(self) -> None:
        color = self.words.vector("r g b of f")
        names = ("Kd", "Ks", "shine", "T", "ior")
        diffuse, mirror, shine, transmit, ior = (self.words.number(f"{name} of f") for name in names)
        # Files have 0 for unused values: the exponent if there is no highlight, the index of an opaque material.
        material = Material(
            color=color,
            diffuse=diffuse,
            specular=mirror if shine > 0.0 else 0.0,
            shininess=shine or 1.0,
            reflect=mirror,
            transmit=transmit,
            ior=ior if transmit > 0.0 else 1.0,
        )
        self.material = self._checked(material, "f")

    def _polygon(self, smooth: bool) -> None:
        count = self.words.number("the number of corners")
        if not (count.is_integer() and 3 <= count <= MOST_CORNERS):
            raise Fault(f"a polygon must have a whole number of corners from 3 to {MOST_CORNERS}, got {count:g}")
        points: list[Vector] = []
        normals: list[Vector] = []
        for _ in range(int(count)):
            points.append(self.words.vector("a corner of a polygon"))
            if smooth:
                normals.append(self.words.vector("a normal of a patch"))
        if smooth and not all(any(normal) for normal in normals):
            raise Fault("a normal of a patch must not be 0 0 0")
        if len(points) == 3 or smooth:
            if any(abs(value) > fields.LARGEST for point in points for value in point):
                self._checked(Polygon(tuple(points)), "polygon")  # reports the fault
            self._patch(points, normals)
        elif unit_normal(np.array(points)).any():  # degenerate polygons are left out, like degenerate triangles
            self._add(Polygon(tuple(flattened(points))), "polygon")

    def _patch(self, points: list[Vector], normals: list[Vector]) -> None:
        """Add a patch as triangles around its first corner, to the mesh in progress if the material is the same."""
        material = self._filled()
        smooth = bool(normals)
        if self.run is None or self.run.material != material or self.run.smooth != smooth:
            self._end_run()
            self.run = Patches(material, smooth, [], [])
        for k in range(1, len(points) - 1):
            self.run.corners += [points[0], points[k], points[k + 1]]
            if smooth:
                self.run.normals += [unit(rescale(normals[i])) for i in (0, k, k + 1)]

    def _end_run(self) -> None:
        if self.run and (mesh := self.run.mesh()):
            self.shapes.append((mesh, self.run.material))
        self.run = None

    def _add(self, shape: Any, name: str) -> None:
        self._end_run()
        self.shapes.append((shape, self._filled()))
        self.unchecked.setdefault(type(shape), []).append((self.line, name, shape))

    def _filled(self) -> Material:
        if self.material is None:
            raise Fault("an object must have a material (f) before it, got none")
        return self.material

    def _lights(self) -> Iterator[Light]:
        """Yield the lights. A light without a colour has the brightness 1 / sqrt(number of lights)."""
        share = 1.0 / math.sqrt(max(1, len(self.lights)))
        for position, color in self.lights:
            yield Light(position=position, color=color or (share, share, share))

    def _checked(self, part: Any, name: str, line: int | None = None) -> Any:
        faults = fields.value_faults(part)
        if not faults and hasattr(part, "faults"):
            faults = part.faults()
        if faults:
            names = FORMAT_NAMES.get(type(part), {})
            text = re.sub(r"\w+", lambda word: names.get(word.group(), word.group()), "; ".join(faults))
            raise Fault(f"{name}: {text}", line)
        return part
