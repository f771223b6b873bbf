"""MTL, the material libraries of OBJ files, and how its numbers become those of our materials.

Format: "MTL material format", appendix B2 of the manual of Wavefront's Advanced Visualizer. `docs/meshes.md` has a
table of the fields.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tracer import fields
from tracer.formats.mesh_part import AMBIENT, CLAY
from tracer.formats.notes import Notes
from tracer.formats.source import Fault, lines_of, read_text
from tracer.formulas.vector import Vector
from tracer.printable import printable
from tracer.scene import Material

COLORS = ("kd", "ks", "tf", "ka")
NUMBERS = {  # statements with one number, and its range
    "ns": (0.0, math.inf), "ni": (1e-3, 1e3), "d": (0.0, 1.0), "tr": (0.0, 1.0), "illum": (0.0, 10.0),
}  # fmt: skip
TEXTURES = ("map_", "bump", "disp", "decal", "refl", "norm")

# Illumination models (illum).
CONSTANT, WITHOUT_HIGHLIGHT = 0, (0, 1)
REFLECTIVE = (3, 4, 5, 6, 7)
REFRACTIVE = (6, 7)
FRESNEL = (5, 7)
PICTURE_REFLECTIONS = (8, 9)

# Linear sRGB from CIE XYZ (IEC 61966-2-1).
XYZ_TO_RGB = (
    (3.2406255, -1.5372080, -0.4986286),
    (-0.9689307, 1.8757561, 0.0415175),
    (0.0557101, -0.2040211, 1.0569959),
)

UNREADABLE = "statements that cannot be read are left out"


class Library:
    """The materials of an OBJ file, from all its libraries. Of materials with one name the first counts."""

    def __init__(self, path: Path, notes: Notes) -> None:
        self.folders = list(dict.fromkeys([path.parent, path.resolve().parent]))  # they differ if the file is a link
        self.notes = notes
        self.files: list[Path] = []  # also those that were not found
        self.entries: dict[str, Entry] = {}
        self.found: dict[str, Material] = {}  # those that faces use

    def read(self, names: str) -> None:
        """Read the libraries that a `mtllib` statement names. A name may have spaces."""
        for path in self._paths(names):
            if path in self.files:
                continue
            self.files.append(path)
            try:
                text = read_text(path)
            except FileNotFoundError:
                self.notes.name("material libraries that were not found", path.name)
                continue
            except (Fault, OSError) as error:
                self.notes.name("material libraries that cannot be read", f"{path.name}: {error}")
                continue
            for entry in entries_of(text, path, self.notes):
                for name in dict.fromkeys((entry.name, named(entry.name), uncommented(entry.name))):
                    if self.entries.setdefault(name, entry) is not entry and name == named(entry.name):
                        self.notes.name("materials that are defined twice: the first counts", name)

    def find(self, name: str) -> Material:
        """The material that a `usemtl` statement names, by the text as written or without its comment."""
        if name not in self.found:
            self.found[name] = self._material(name)
        return self.found[name]

    def _material(self, name: str) -> Material:
        for candidate in (name, named(name), uncommented(name)):
            if candidate in self.entries:
                return material_of(self.entries[candidate], self.notes)
        if name:
            self.notes.name("materials that were not found, shown as clay", named(name))
        return CLAY

    def _paths(self, names: str) -> Iterator[Path]:
        """The files that are named: all of the text, or the longest sequences of words that name an existing file, else
        single words.
        """
        for text in (names, uncommented(names)):
            if path := self._existing(text):
                yield path
                return
        words = [quoted or word for quoted, word in re.findall(r'"([^"]*)"|(\S+)', uncommented(names))]
        start = 0
        while start < len(words):
            for end in range(len(words), start, -1):
                path = self._existing(" ".join(words[start:end]))
                if path or end == start + 1:
                    yield path or self.folders[0] / words[start].replace("\\", "/")
                    start = end
                    break

    def _existing(self, name: str) -> Path | None:
        return next((path for folder in self.folders if (path := existing(folder, name))), None)


def existing(folder: Path, name: str) -> Path | None:
    """The file of a name that was perhaps written on Windows: with backslashes, in another case, or with a path that
    exists only there.
    """
    parts = [part for part in name.replace("\\", "/").split("/") if part]
    for wanted in (parts, parts[-1:]):
        path: Path | None = Path("/") if name.startswith("/") and wanted is parts else folder
        for part in wanted:
            path = path and child(path, part)
        if path and path.is_file():
            return path
    return None


def child(folder: Path, name: str) -> Path | None:
    """An entry of a folder, by its name, or by its name in another case."""
    path = folder / name
    try:
        if path.exists():
            return path
        return next((entry for entry in folder.iterdir() if entry.name.lower() == name.lower()), None)
    except (OSError, ValueError):
        return None


@dataclass
class Entry:
    """The statements of one material, by keyword in lower case."""

    name: str
    colors: dict[str, Vector] = field(default_factory=dict)
    numbers: dict[str, float] = field(default_factory=dict)


def entries_of(text: str, path: Path, notes: Notes) -> list[Entry]:
    """The materials of a library. Raises Fault for a number that is not finite and for a spectral colour. Other
    statements that cannot be read are left out.
    """
    entries: list[Entry] = []
    for line, content in enumerate(lines_of(text), 1):
        keyword, *words = uncommented(content).split() or [""]
        if keyword.lower() == "newmtl":
            entries.append(Entry(spaced(content).partition(" ")[2]))
        elif keyword and not (entries and read_statement(entries[-1], keyword, words, notes, Place(path, line))):
            notes.name(f"{path.name}: {UNREADABLE}", f"line {line}: {' '.join([keyword, *words])[:60]}")
    return entries


class Place(NamedTuple):
    """A line of a file."""

    path: Path
    line: int


def read_statement(entry: Entry, keyword: str, words: list[str], notes: Notes, place: Place) -> bool:
    """Read one statement into the material. Returns whether it can be read."""
    key = keyword.lower()
    if key.startswith(TEXTURES):
        notes.count("textures are not shown")
    elif key in COLORS:
        if words[:1] == ["spectral"]:
            text = f'material "{entry.name}": {keyword} must be r g b or xyz x y z, got a spectral curve'
            raise Fault(text, place.line, place.path)
        is_xyz = words[:1] == ["xyz"]
        values = numbers(entry, keyword, words[is_xyz:], place)
        if len(values) not in (1, 3) or (min(values) < 0.0 and not is_xyz):
            return False
        x, y, z = values if len(values) == 3 else values * 3
        entry.colors[key] = rgb_from_xyz((x, y, z), notes) if is_xyz else (x, y, z)
    elif key in NUMBERS:
        if words[:1] == ["-halo"]:
            notes.say("d -halo is read as d: the same from all sides")
            words = words[1:]
        values = numbers(entry, keyword, words, place)
        least, most = NUMBERS[key]
        if len(values) != 1 or not least <= values[0] <= most:
            return False
        entry.numbers[key] = values[0]
    else:
        notes.count(f'statements "{keyword[:20]}" are not read')
    return True


def numbers(entry: Entry, keyword: str, words: list[str], place: Place) -> list[float]:
    """The numbers of a statement; none if a word is not a number. Raises Fault if one is not finite."""
    try:
        values = [float(word) for word in words]
    except ValueError:
        return []
    if not all(abs(value) <= fields.LARGEST for value in values):
        text = f'material "{entry.name}": {keyword} must have finite numbers, got {" ".join(words)[:40]}'
        raise Fault(text, place.line, place.path)
    return values


def rgb_from_xyz(xyz: Vector, notes: Notes) -> Vector:
    """Linear RGB of a CIE XYZ colour. Components below 0 become 0."""
    r, g, b = (sum(a * x for a, x in zip(row, xyz, strict=True)) for row in XYZ_TO_RGB)
    if min(r, g, b) < 0.0:
        notes.count("xyz colours are more saturated than sRGB, and shown less so")
    return (max(r, 0.0), max(g, 0.0), max(b, 0.0))


def material_of(entry: Entry, notes: Notes) -> Material:
    """The material of an entry. `docs/meshes.md` explains each number."""
    colors, given = entry.colors, entry.numbers
    model = int(given.get("illum", 2))
    if "kd" not in colors:
        notes.name("materials without Kd have the colour of clay", entry.name)
    opacity = given.get("d", 1.0 - given.get("tr", 0.0))
    if "d" in given and "tr" in given and not math.isclose(given["d"], 1.0 - given["tr"], abs_tol=1e-9):
        notes.name("materials whose d and Tr contradict each other: d counts", entry.name)
    transmit = 1.0 - opacity
    if model in REFRACTIVE and "tf" in colors:
        transmit = (transmit or 1.0) * min(1.0, mean(colors["tf"]))
    for key in ("ks", "tf"):
        if key in colors and len(set(colors[key])) > 1 and (key == "ks" or model in REFRACTIVE):
            notes.name(f"coloured {key.capitalize()} is read as its mean", entry.name)
    if model in FRESNEL and transmit > 0.0:
        notes.name('materials with illum 5 or 7 need the model "fresnel"', entry.name)
    if model in PICTURE_REFLECTIONS:
        notes.name("materials with illum 8 or 9 reflect a picture, which is not shown", entry.name)
    if max(colors.get("kd", CLAY.color)) > 1.0:
        notes.name("materials whose Kd is above 1, so that they reflect more light than they get", entry.name)
    if "ka" in colors and model != CONSTANT:
        notes.say("Ka is not read: all materials have the same ambient coefficient")
    highlight = mean(colors.get("ks", (0.0, 0.0, 0.0)))
    return Material(
        name=printable(named(entry.name)),
        color=colors.get("kd", CLAY.color),
        ambient=1.0 if model == CONSTANT else AMBIENT * (1.0 - transmit),
        diffuse=0.0 if model == CONSTANT else 1.0 - transmit,
        specular=0.0 if model in WITHOUT_HIGHLIGHT else highlight,
        shininess=max(1.0, given.get("ns", 1.0)),
        reflect=min(1.0, highlight) * (1.0 - transmit) if model in REFLECTIVE else 0.0,
        transmit=transmit,
        ior=given.get("ni", 1.0),
    )


def mean(color: Vector) -> float:
    return sum(color) / 3.0


def uncommented(text: str) -> str:
    """The text before a comment. A # inside a word belongs to the word."""
    return re.split(r"(?:^|\s)#", text)[0].strip()


def named(text: str) -> str:
    """A name without the comment behind it. A # before a number at the end belongs to the name, as in "Box #1"."""
    return spaced(re.split(r"(?:^|\s)#(?!\d+\s*$)", text)[0])


def spaced(text: str) -> str:
    """A text with single spaces between its words. Other white space than spaces and tabs belongs to words."""
    return re.sub("[ \t\v\f]+", " ", text).strip(" ")
