"""Wavefront OBJ: polygons with materials.

Format: "Object Files (.obj)", appendix B1 of the manual of Wavefront's Advanced Visualizer. Read are `v`, `vn`, `f`,
`o`, `g`, `usemtl` and `mtllib`; `vt` is not needed, and other statements are counted in a note.
"""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np

from tracer.formats.mesh_part import MeshFile, make_part
from tracer.formats.mtl import Library, named, spaced, uncommented
from tracer.formats.notes import Notes
from tracer.formats.obj_lines import Block, block_ends, corners_of, normalised, numbers_of
from tracer.formats.polygons import triangulated
from tracer.formats.source import MOST_TEXT, Fault, decode, read_bytes


def read_obj(path: Path, progress: Callable[[float], None]) -> MeshFile:
    """Read a file and its material libraries. Raises Fault."""
    data = normalised(read_bytes(path, MOST_TEXT))
    reader = Reader(path)
    line = 1
    for start, end in block_ends(data):
        progress(start / len(data))
        reader.read(Block(data[start:end], line))
        line += data.count(b"\n", start, end)
    return reader.result()


class Reader:
    """Collects the content of a file, block by block."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.notes = Notes()
        self.library = Library(path, self.notes)
        self.vertices, self.normals = [np.zeros((0, 3))], [np.zeros((0, 3))]
        self.vertex_count = self.normal_count = self.face_count = 0
        self.corners: list[np.ndarray] = []  # (n, 2): the vertex and the normal of each corner, from 1; 0 for no normal
        self.sizes: list[np.ndarray] = []  # corners of each face
        self.lines: list[np.ndarray] = []  # of each face
        self.object, self.group, self.material = "", "", ""
        self.runs: list[tuple[int, str, str]] = []  # first face, name and material
        self.smooths = False

    def read(self, block: Block) -> None:
        if block.is_vertex.any():
            values, counts = numbers_of(block, block.is_vertex, "v", 8)
            self.vertices.append(values)
            self.notes.count("vertex colours are not shown", int((counts >= 6).sum()))
        if block.is_normal.any():
            self.normals.append(numbers_of(block, block.is_normal, "vn", 3)[0])
        faces_before = self.face_count + np.cumsum(block.is_face)
        if block.is_face.any():
            self._faces(block)
        for k, line, text in block.lines(block.is_other):
            self._statement(text, line, int(faces_before[k]))
        self.vertex_count += int(block.is_vertex.sum())
        self.normal_count += int(block.is_normal.sum())
        self.face_count += int(block.is_face.sum())

    def _faces(self, block: Block) -> None:
        corners, sizes = corners_of(block)
        lines = block.numbers[block.is_face]
        before = [self.vertex_count + np.cumsum(block.is_vertex), self.normal_count + np.cumsum(block.is_normal)]
        for column in range(2):
            index = corners[:, column]
            relative = index < 0
            if relative.any():
                index[relative] += 1 + np.repeat(before[column][block.is_face], sizes)[relative]
                if (index[relative] <= 0).any():
                    bad = np.flatnonzero(relative & (index <= 0))[0]
                    raise Fault("a face refers to an element before the first one", int(np.repeat(lines, sizes)[bad]))
        self.corners.append(corners)
        self.sizes.append(sizes)
        self.lines.append(lines)

    def _statement(self, text: bytes, line: int, faces_before: int) -> None:
        word, _, rest = decode(text).partition(" ")
        rest = rest.strip()
        match word:
            case "o":
                self.object, self.group = named(rest), ""
            case "g":
                self.group = named(rest)
            case "usemtl":
                self.material = spaced(rest)
            case "mtllib":
                self.library.read(rest)
            case "s":
                self.smooths |= uncommented(rest) not in ("", "0", "off")
            case _ if not word.startswith("#"):
                self.notes.count(f'statements "{word[:20]}" are not read')
        if word in ("o", "g", "usemtl"):
            self.runs.append((faces_before, self.group or self.object, self.material))

    def result(self) -> MeshFile:
        """The parts of the file: the faces of one name and one material."""
        if not self.face_count:
            raise Fault("must have faces (f), got none")
        vertices, normals = np.concatenate(self.vertices), np.concatenate(self.normals)
        corners, sizes, lines = np.concatenate(self.corners), np.concatenate(self.sizes), np.concatenate(self.lines)
        for column, count, what in ((0, len(vertices), "vertex"), (1, len(normals), "normal")):
            beyond = corners[:, column] > count
            if beyond.any():
                bad = int(beyond.argmax())
                line = int(np.repeat(lines, sizes)[bad])
                raise Fault(f"a face refers to {what} {corners[bad, column]}, but the file has {count}", line)
        if self.smooths and not len(normals):
            self.notes.say("smoothing groups are not shown, since the file has no vertex normals (vn)")
        kept = np.flatnonzero(sizes)
        self.notes.count("faces with fewer than three corners are left out", len(sizes) - len(kept))
        corners -= 1
        triangles, owners = triangulated(vertices[corners[:, 0]], sizes[kept], self.notes)
        owners = kept[owners]
        faces, normal_faces = corners[triangles, 0], corners[triangles, 1]
        parts = []
        for (name, material), spans in self._spans().items():
            which = np.concatenate([np.arange(*np.searchsorted(owners, span)) for span in spans])
            own = self.library.find(material)
            smooth = (normals, normal_faces[which])
            parts.append(make_part(name or named(material), vertices, faces[which], smooth, own, self.notes))
        return MeshFile([part for part in parts if part], self.notes.lines(), tuple(self.library.files))

    def _spans(self) -> dict[tuple[str, str], list[tuple[int, int]]]:
        """The first face and the end of each run of faces, by name and material."""
        spans: dict[tuple[str, str], list[tuple[int, int]]] = {}
        runs = [(0, "", ""), *self.runs, (self.face_count, "", "")]
        for (start, name, material), (end, _, _) in pairwise(runs):
            if start < end:
                spans.setdefault((name, material), []).append((start, end))
        return spans
