"""Scene files, format 1: reads TOML into a Scene, and reports every fault of the file at once.

A fault is one line: `scene.toml: object[2] "ball": radius must be > 0, got -1`. Tables are counted from 0.
"""

import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

from tracer import fields
from tracer.formats.meshes import MeshError, load_parts
from tracer.scene import Background, Camera, Checker, Image, Light, Material, Object, Scene, SceneError, Tracing
from tracer.scene.scene import place
from tracer.shapes import SHAPE_NAMES, SHAPES
from tracer.shapes.mesh import Mesh

T = TypeVar("T")

FORMAT = 1
TABLES = ("camera", "image", "background", "tracing")
LISTS = ("light", "material", "object")
KEYS = ("format", "title", *TABLES, *LISTS)
OWN_KEYS = ("name", "priority", "thin")  # keys of an object of any shape
OBJECT_KEYS = ("shape", "material", *OWN_KEYS)


def read_scene(path: Path, progress: Callable[[float], None]) -> Scene:
    """Read a file. Raises SceneError with every fault, and OSError if it cannot be read."""
    try:
        document = tomllib.loads(path.read_bytes().decode("utf-8"))
    except UnicodeDecodeError as error:
        raise SceneError([f"{path}: byte {error.start}: a scene file is UTF-8 text, got something else"]) from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError([f"{path}: not TOML: {str(error)[:1].lower()}{str(error)[1:]}"]) from None
    return Reader(path).scene(document, progress)


class Reader:
    """Reads one document, and collects its faults."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.faults: list[str] = []

    def fault(self, where: str, *what: str) -> None:
        self.faults += [f"{self.path}: {where}: {line}" if where else f"{self.path}: {line}" for line in what]

    def scene(self, document: dict[str, Any], progress: Callable[[float], None]) -> Scene:
        self._format(document)
        for key in document:
            if key not in KEYS:
                self.fault("", f'unknown key "{key}"{fields.nearest(key, KEYS) or known(KEYS)}')
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
            raise SceneError(self.faults)
        kept_lights = tuple(light for light in lights if light is not None)
        return Scene(tuple(objects), kept_lights, camera, image, background, tracing, title, self.path)

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
        own = self.values(Object, where, {key: table[key] for key in OWN_KEYS if key in table})
        if len(self.faults) > before or own is None:
            return []
        given = own.pop("name", "")
        objects = []
        for shape, part_name, part_material in parts:
            name = ".".join(filter(None, (given, part_name)))
            objects.append(Object(shape, material or part_material, name, **own))
        return objects

    def _material_of(self, where: str, table: dict[str, Any], materials: dict[str, Material | None]) -> Material | None:
        name = table.get("material")
        if name is None:
            return None if table.get("shape") == Mesh.name else Material()
        if not isinstance(name, str) or name not in materials:
            hint = fields.nearest(name, materials) or known(materials)
            self.fault(where, f"material must be the name of a [[material]], got {fields.shown(name)}{hint}")
            return None
        return materials[name] or Material()

    def _shape(self, where: str, table: dict[str, Any]) -> list[tuple[Any, str, Material]]:
        """(shape, name of the part, material of the part) for each object that this table makes."""
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
        kind = next(shape for shape in SHAPES if shape.name == name)
        shape = self.table(kind, where, own, OBJECT_KEYS)
        return [] if shape is None else [(shape, "", Material())]

    def _mesh(self, where: str, own: dict[str, Any]) -> list[tuple[Any, str, Material]]:
        values = self.values(Mesh, where, own, OBJECT_KEYS)
        if "file" not in own:
            self.fault(where, "file is missing: it must be the path of a mesh, relative to the scene file")
        if values is None or "file" not in values:
            return []
        try:
            parts = load_parts(self.path.parent / values["file"])
        except MeshError as error:
            self.fault(where, str(error))
            return []
        return [(Mesh(part.geometry, **values), part.name if len(parts) > 1 else "", part.material) for part in parts]


def known(names: Iterable[str]) -> str:
    return f" (known: {', '.join(names) or 'none'})"
