"""Scene files, format 1: reads TOML into a Scene, and reports every fault of the file at once.

A fault is one line: `scene.toml: object[2] "ball": radius must be > 0, got -1`. Tables are counted from 0.
"""

import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from tracer import fields
from tracer.formats.mesh_part import MeshFile
from tracer.formats.meshes import load_mesh, part_objects
from tracer.formats.source import MOST_TEXT, Fault, decode, read_bytes
from tracer.printable import printable, shown_path
from tracer.scene import Background, Camera, Checker, Image, Light, Material, Object, Scene, SceneError, Tracing
from tracer.scene.changes import overridden
from tracer.scene.scene import place
from tracer.shapes import SHAPE_NAMES, SHAPES
from tracer.shapes.mesh import Mesh

T = TypeVar("T")

FORMAT = 1
PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)")  # at the end of the parser's messages
MOST_SHOWN = 60  # characters of a line in a fault
TABLES = ("camera", "image", "background", "tracing")
LISTS = ("light", "material", "object")
KEYS = ("format", "title", *TABLES, *LISTS)
OWN_KEYS = ("name", "priority", "thin")  # keys of an object of any shape
KINDS = {shape.name: shape for shape in SHAPES}
NO_MATERIAL = Material()
OBJECT_KEYS = ("shape", "material", *OWN_KEYS)


def read_scene(path: Path, progress: Callable[[float], None], changes: Mapping[str, Any] | None = None) -> Scene:
    """Read a file, with these changes to its document (`tracer.scene.changes`). Raises SceneError with every fault,
    and OSError if it cannot be read.
    """
    try:
        document = parsed(read_bytes(path, MOST_TEXT))
    except Fault as fault:
        raise SceneError([fault.within(shown_path(path))]) from None
    if changes:
        document, faults = overridden(document, changes, TABLES, LISTS)
        if faults:
            raise SceneError([f"{shown_path(path)}: {fault}" for fault in faults], (path,))
    return Reader(path).scene(document, progress)


def parsed(data: bytes) -> dict[str, Any]:
    """The document. In a file that is not UTF-8, only comments may have other bytes. Raises Fault."""
    text = decode(data, replaced=True)
    try:
        document = tomllib.loads(text)
    except RecursionError:
        raise Fault("not TOML that can be read: tables or lists are nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise _not_toml(text, str(error)) from None
    except ValueError as error:
        raise Fault(f"not TOML that can be read: {str(error).split(';')[0]}") from None
    if "\ufffd" in text and "\ufffd" in repr(document):
        raise Fault(f"byte {first_bad_byte(data)}: a scene file is UTF-8 text, got something else")
    return document


def _not_toml(text: str, what: str) -> Fault:
    """The fault of a text that is not TOML, with its line and what stands there. `what` is the parser's message."""
    windows = "\\" in what or "hex value" in what
    hint = " (write a Windows path in '...', or with / instead of \\)" if windows else ""
    what, place = PLACE.split(what, maxsplit=1)[0], PLACE.search(what)
    lines = text.rstrip().split("\n")
    number = min(int(place[1]), len(lines)) if place and place[1] else len(lines)
    found = printable(lines[number - 1].strip())
    found = found if len(found) <= MOST_SHOWN else f"{found[: MOST_SHOWN - 1]}…"
    return Fault(f'not TOML: {what[:1].lower()}{what[1:]}, got "{found}"{hint}', number)


def first_bad_byte(data: bytes) -> int:
    """The position of the first byte that is not UTF-8."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        return error.start
    return len(data)


class Reader:
    """Reads one document, and collects its faults."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.faults: list[str] = []
        self.notes: dict[str, None] = {}
        self.files: dict[Path, MeshFile | Fault] = {}  # mesh files that were read

    def fault(self, where: str, *what: str) -> None:
        if not what:
            return
        path = shown_path(self.path)
        self.faults += [f"{path}: {where}: {line}" if where else f"{path}: {line}" for line in what]

    def scene(self, document: dict[str, Any], progress: Callable[[float], None]) -> Scene:
        self._format(document)
        for key in document:
            if key not in KEYS:
                self.fault("", f'unknown key "{key}"{fields.hint(key, KEYS)}')
        title = document.get("title", "")
        if not isinstance(title, str):
            self.fault("", fields.refusal("title", "a text", title))
        camera = self.table(Camera, "camera", document.get("camera", {}))
        image = self.table(Image, "image", document.get("image", {}))
        background = self.table(Background, "background", document.get("background", {}))
        tracing = self.table(Tracing, "tracing", document.get("tracing", {}))
        lights = [self.table(Light, *item) for item in self.tables(document, "light")]
        materials = self._materials(document)
        objects: list[Object] = []
        tables = list(self.tables(document, "object"))
        for k, item in enumerate(tables):
            progress(k / len(tables))  # each may name a mesh file
            objects += self._object(*item, materials)
        if not document.get("object"):
            self.fault("", "a scene needs at least one [[object]], got none")
        if self.faults or camera is None or image is None or background is None or tracing is None:
            raise SceneError(self.faults, self._files())
        kept_lights = tuple(light for light in lights if light is not None)
        own = (camera, image, background, tracing, title, self.path)
        return Scene(tuple(objects), kept_lights, *own, tuple(self.notes), self._files())

    def _files(self) -> tuple[Path, ...]:
        """All files that were read, also those that were not found."""
        files = [self.path]
        for path, found in self.files.items():
            files.append(path)
            if isinstance(found, MeshFile):
                files += found.files
            elif found.file:
                files.append(found.file)
        return tuple(files)

    def _format(self, document: dict[str, Any]) -> None:
        found = document.get("format")
        if found is None:
            self.fault("", f"format is missing: add the line format = {FORMAT} before the first table")
        elif found != FORMAT or isinstance(found, bool):
            self.fault("", fields.refusal("format", str(FORMAT), found))

    def tables(self, document: dict[str, Any], key: str) -> Iterable[tuple[str, Any]]:
        """(place, table) for each [[key]]."""
        found = document.get(key, [])
        if not isinstance(found, list):
            self.fault("", f"{key} must be written as [[{key}]], got {fields.shown(found)}")
            return
        for k, table in enumerate(found):
            name = table.get("name", "") if isinstance(table, dict) else ""
            yield place(key, k, name if isinstance(name, str) else ""), table

    def values(self, kind: type, where: str, table: Any, also: tuple[str, ...] = ()) -> dict[str, Any] | None:
        """The values of a dataclass from one table; None if there are faults. `also`: keys that are read elsewhere."""
        if not isinstance(table, dict):
            self.fault(where, f"must be a table, got {fields.shown(table)}")
            return None
        found: list[str] = []
        values = fields.read_fields(kind, table, found, also)
        self.fault(where, *found)
        return None if found else values

    def table(self, kind: type[T], where: str, table: Any, also: tuple[str, ...] = (), **more: Any) -> T | None:
        """A dataclass from one table. `more`: values from elsewhere."""
        values = self.values(kind, where, table, also)
        if values is None:
            return None
        made = kind(**values, **more)
        found = made.faults() if hasattr(made, "faults") else []  # type: ignore[attr-defined]
        self.fault(where, *found)
        return None if found else made

    def _materials(self, document: dict[str, Any]) -> dict[str, Material | None]:
        """Materials by name; None for one with errors, so that objects that use it do not cause a second error."""
        materials: dict[str, Material | None] = {}
        for where, table in self.tables(document, "material"):
            checker = None
            if isinstance(table, dict) and "checker" in table:
                checker = self.table(Checker, f"{where}: checker", table["checker"])
            material = self.table(Material, where, table, ("checker",), checker=checker)
            name = table.get("name") if isinstance(table, dict) else None
            if not isinstance(name, str):
                if name is None:
                    self.fault(where, "name is missing: objects refer to materials by name")
            elif name in materials:
                self.fault(where, f'name must be unique, got "{name}" twice')
            else:
                materials[name] = material
        return materials

    def _object(self, where: str, table: Any, materials: dict[str, Material | None]) -> list[Object]:
        """One object, or one for each material of its mesh file; none if there are faults."""
        if not isinstance(table, dict):
            self.fault(where, f"must be a table, got {fields.shown(table)}")
            return []
        before = len(self.faults)
        material = self._material_of(where, table, materials)
        parts = self._shape(where, table)
        given_keys = {key: table[key] for key in OWN_KEYS if key in table}
        own = self.values(Object, where, given_keys) if given_keys else {}
        if len(self.faults) > before or own is None:
            return []
        if not given_keys and len(parts) == 1 and not parts[0].name:
            return [Object(parts[0].shape, material or parts[0].material, thin=parts[0].thin and material is None)]
        given = own.pop("name", "")
        objects = []
        for part in parts:
            name = ".".join(filter(None, (given, part.name if len(parts) > 1 or not given else "")))
            thin = own.get("thin", part.thin and material is None)
            objects.append(replace(part, material=material or part.material, name=name, **{**own, "thin": thin}))
        return objects

    def _material_of(self, where: str, table: dict[str, Any], materials: dict[str, Material | None]) -> Material | None:
        name = table.get("material")
        if name is None:
            return None if table.get("shape") == Mesh.name else NO_MATERIAL
        if not isinstance(name, str) or name not in materials:
            got = f"{fields.shown(name)}{fields.hint(name, materials)}"
            self.fault(where, f"material must be the name of a [[material]], got {got}")
            return None
        return materials[name] or NO_MATERIAL

    def _shape(self, where: str, table: dict[str, Any]) -> list[Object]:
        """The objects that this table makes, as its file describes them."""
        name = table.get("shape")
        if name is None:
            self.fault(where, f"shape is missing: it must be {fields.one_of(SHAPE_NAMES)}")
            return []
        if name not in SHAPE_NAMES:
            allowed = fields.one_of(SHAPE_NAMES) + fields.nearest(name, SHAPE_NAMES)
            self.fault(where, fields.refusal("shape", allowed, name))
            return []
        own = {key: value for key, value in table.items() if key not in OBJECT_KEYS}
        if name == Mesh.name:
            return self._mesh(where, own)
        shape = self.table(KINDS[name], where, own, OBJECT_KEYS)
        return [] if shape is None else [Object(shape, NO_MATERIAL)]

    def _mesh(self, where: str, own: dict[str, Any]) -> list[Object]:
        values = self.values(Mesh, where, own, OBJECT_KEYS)
        if "file" not in own:
            self.fault(where, "file is missing: it must be the path of a mesh, relative to the scene file")
        if values is None or "file" not in values:
            return []
        path = self.path.parent / values["file"]
        if path not in self.files:
            try:
                self.files[path] = load_mesh(path)
            except Fault as fault:
                self.files[path] = fault
        found = self.files[path]
        if isinstance(found, Fault):
            self.fault(where, found.within(f"mesh {shown_path(path.name)}"))
            return []
        notes = list(found.notes)
        if found.camera or found.lights:
            notes.append("camera and lights of a mesh file are not taken over into a scene file")
        self.notes.update(dict.fromkeys(f"{shown_path(path.name)}: {note}" for note in notes))
        objects = part_objects(found.parts, **values)
        for fault in dict.fromkeys(fault for item in objects for fault in item.shape.faults()):
            self.fault(where, fault)
        return objects
