"""Accessors of a glTF document: typed arrays in its buffers, also interleaved, normalised and sparse."""

from functools import lru_cache
from pathlib import Path

import numpy as np

from tracer.formats.gltf.document import Item, read_buffer
from tracer.formats.source import Fault

TYPES = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}  # by componentType
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
MOST_ELEMENTS = 12_000_000  # of an accessor
FREE_ELEMENTS = 100_000  # of an accessor without data, in any file; in a large one as many as it has bytes


class Accessors:
    """Reads accessors by number. Each buffer is read once."""

    def __init__(self, document: Item, folder: Path, binary: bytes | None) -> None:
        self.accessors = document.items("accessors")
        self.views = document.items("bufferViews")
        self.buffers = document.items("buffers")
        self.folder, self.binary = folder, binary
        self.files: list[Path] = []  # buffers outside the file
        self._buffer = lru_cache(maxsize=None)(self._read_buffer)

    def array(self, number: int, components: int, place: str) -> np.ndarray:
        """The elements (n, components) of an accessor, float64 or integers; normalised integers as float64."""
        if number >= len(self.accessors):
            raise Fault(f"{place} must be an accessor from 0 to {len(self.accessors) - 1}, got {number}")
        accessor = self.accessors[number]
        count = accessor.whole("count", most=MOST_ELEMENTS)
        kind, each = accessor.whole("componentType"), accessor.text("type")
        if kind not in TYPES or COMPONENTS.get(each) != components:
            raise Fault(f"{accessor.place} must have {components} numbers of a known type, got {each} of {kind}")
        dtype = np.dtype("<" + TYPES[kind])
        if accessor.has("bufferView"):
            values = self._view(accessor, dtype, count, components).copy()
        else:
            self._check_small(accessor, count)
            values = np.zeros((count, components), dtype)
        if accessor.has("sparse"):
            self._fill_sparse(accessor.item("sparse"), values, dtype)
        if accessor.flag("normalized") and dtype.kind in "iu":
            largest = np.iinfo(dtype).max
            return np.maximum(values.astype(np.float64) / largest, -1.0)
        with np.errstate(invalid="ignore"):  # a signalling NaN is refused later, as any NaN
            return values.astype(np.float64 if dtype.kind == "f" else np.int64)

    def _check_small(self, accessor: Item, count: int) -> None:
        """An accessor without data is all zeros: a small file must not ask for many."""
        most = max(FREE_ELEMENTS, sum(view.whole("byteLength") for view in self.views))
        if count > most:
            raise Fault(f"{accessor.place} has no data, so it must have at most {most} elements, got {count}")

    def _view(self, accessor: Item, dtype: np.dtype, count: int, components: int) -> np.ndarray:
        """Elements (count, components) in a buffer view; `accessor` has its number and the offset."""
        number = accessor.whole("bufferView")
        if number >= len(self.views):
            raise Fault(f"{accessor.place}.bufferView must be from 0 to {len(self.views) - 1}, got {number}")
        view = self.views[number]
        buffer_number = view.whole("buffer")
        if buffer_number >= len(self.buffers):
            raise Fault(f"{view.place}.buffer must be from 0 to {len(self.buffers) - 1}, got {buffer_number}")
        data = self._buffer(buffer_number)
        size = dtype.itemsize * components
        stride = view.whole("byteStride", 0, most=252) or size
        start, offset = view.whole("byteOffset", 0), accessor.whole("byteOffset", 0)
        end = offset + stride * (count - 1) + size if count else offset
        length = view.whole("byteLength")
        if end > length or start + length > len(data):
            raise Fault(f"{accessor.place} must end within its buffer: it needs {end} of {length} bytes")
        return np.ndarray((count, components), dtype, data, start + offset, (stride, dtype.itemsize))

    def _fill_sparse(self, sparse: Item, values: np.ndarray, dtype: np.dtype) -> None:
        """Replace the elements that a sparse accessor lists."""
        count = sparse.whole("count", most=len(values))
        indices = sparse.item("indices")
        kind = indices.whole("componentType")
        if kind not in (5121, 5123, 5125):
            raise Fault(f"{indices.place}.componentType must be 5121, 5123 or 5125, got {kind}")
        at = self._view(indices, np.dtype("<" + TYPES[kind]), count, 1)[:, 0].astype(np.int64)
        if count and at.max() >= len(values):
            raise Fault(f"{indices.place} must be from 0 to {len(values) - 1}, got {at.max()}")
        values[at] = self._view(sparse.item("values"), dtype, count, values.shape[1])

    def _read_buffer(self, number: int) -> bytes:
        return read_buffer(self.buffers[number], self.folder, self.binary, self.files)
