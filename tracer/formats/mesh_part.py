"""The content of a mesh file as its reader gives it: parts of one name and one material."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tracer import fields
from tracer.formats.notes import Notes
from tracer.formats.source import Fault
from tracer.formulas.double_double import dd_cross, exact_difference
from tracer.printable import printable
from tracer.scene import Camera, Image, Light, Material
from tracer.shapes.mesh import Geometry

MOST_FACES = 4_000_000  # triangles of a file

# The ambient coefficient of every material of a mesh file, so that no side is black.
AMBIENT = 0.15

# For faces without a material.
CLAY = Material(name="clay", color=(0.8, 0.78, 0.74), ambient=AMBIENT, diffuse=0.8)


@dataclass(frozen=True)
class Part:
    """The triangles of one name and one material."""

    name: str
    geometry: Geometry
    material: Material
    thin: bool = False


@dataclass(frozen=True)
class MeshFile:
    """A mesh file."""

    parts: list[Part]
    notes: list[str]  # what the file has and the parts have not
    files: tuple[Path, ...] = ()  # the other files that it names, also those that were not found
    camera: Camera | None = None
    image: Image | None = None
    lights: tuple[Light, ...] | None = None  # None: the file has none
    scene_notes: tuple[str, ...] = ()  # what camera and lights of the file have and ours have not


def make_part(
    name: str,
    vertices: np.ndarray,
    faces: np.ndarray,
    smooth: tuple[np.ndarray, np.ndarray] | None,
    material: Material,
    notes: Notes,
    thin: bool = False,
) -> Part | None:
    """A part from vertices (n, 3) and triangles (m, 3); None if no triangle has an area.

    `smooth` are normals (k, 3) of any length and, for the corners of each triangle, their indices (m, 3) or -1. Raises
    Fault for numbers that are not allowed.
    """
    if not len(faces):
        return None
    if not 0 <= faces.min() <= faces.max() < len(vertices):
        raise Fault(f"faces must have vertices from 0 to {len(vertices) - 1}, got {faces.min()} to {faces.max()}")
    used = np.zeros(len(vertices), bool)
    used[faces] = True
    kept = np.flatnonzero(used)
    bad = ~(np.abs(vertices[kept]) <= fields.LARGEST).all(axis=1)
    if bad.any():
        k = int(kept[bad.argmax()])
        raise Fault(f"vertex {k} must be three finite numbers of at most {fields.LARGEST:g}, got {shown(vertices[k])}")
    place = np.cumsum(used) - 1
    vertices, faces = vertices[kept], place[faces]
    flat = without_area(vertices, faces)
    notes.count("faces without area are left out", int(flat.sum()))
    if flat.all():
        return None
    normals = normal_faces = None
    if smooth is not None and (smooth[1][~flat] >= 0).any():
        normals, normal_faces = unit_normals(*smooth)
        normal_faces = normal_faces[~flat]
    return Part(printable(name), Geometry(vertices, faces[~flat], normals, normal_faces, faces[flat]), material, thin)


def without_area(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Whether each triangle has no area. Exact: a computed area near the rounding error is computed again in
    double-double.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    with np.errstate(over="ignore", invalid="ignore"):
        size = np.abs(np.cross(b - a, c - a)).max(axis=1)
        scale = np.abs(vertices).max() ** 2
    doubtful = np.flatnonzero(~(size > 1e-14 * scale))
    flat = np.zeros(len(faces), bool)
    a, b, c = (tuple(corner[doubtful].T) for corner in (a, b, c))
    area = dd_cross(exact_difference(b, a), exact_difference(c, a))
    flat[doubtful] = np.all([high == 0.0 for high, _ in area], axis=0)
    return flat


def unit_normals(normals: np.ndarray, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Normals of length 1, and their indices. A corner without a usable normal refers to a last one, which is 0."""
    with np.errstate(over="ignore", invalid="ignore"):
        size = np.abs(normals).max(axis=1, keepdims=True, initial=0.0)
        usable = np.isfinite(size) & (size > 0.0)
        scaled = np.where(usable, normals / np.where(usable, size, 1.0), 0.0)
    length = np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))
    units = np.concatenate([scaled / np.where(length > 0.0, length, 1.0), np.zeros((1, 3))])
    return units, np.where(indices < 0, len(normals), indices)


def shown(vector: np.ndarray) -> str:
    return " ".join(f"{x:g}" for x in vector)
