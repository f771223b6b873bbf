"""Warnings about scenes that are valid but probably not intended."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from tracer.scene.scene import Object
from tracer.shapes.mesh import Mesh


def hidden_notes(ranked: list[Object]) -> list[str]:
    """Warnings about transparent solids that are never visible, since they lie inside one of higher priority; a line
    each.

    `ranked` is in the order of priority. A solid counts as inside if all corners of its box are, so every note is
    true, but not every hidden solid is found.
    """
    infinite = np.full(3, math.inf)
    boxes = [item.shape.bounds() for item in ranked]
    low = np.array([-infinite if box is None else box[:, 0].min(axis=0) for box in boxes]).reshape(-1, 3)
    high = np.array([infinite if box is None else box[:, 1].max(axis=0) for box in boxes]).reshape(-1, 3)
    notes = []
    for k, inner in enumerate(ranked):
        if boxes[k] is None:
            continue
        around = ((low[:k] <= low[k]) & (high[:k] >= high[k])).all(axis=1)
        corners = np.array(list(itertools.product(*zip(low[k], high[k], strict=True))))
        for outer in (ranked[j] for j in np.flatnonzero(around)):
            if all(outer.shape.contains(corner) for corner in corners):
                notes.append(f'"{_name(inner)}" lies inside "{_name(outer)}" and is never visible: raise its priority')
                break
    return notes


def mesh_notes(objects: Sequence[Object]) -> list[str]:
    """Warnings of the readers of mesh files, a line for each file."""
    meshes = [item.shape for item in objects if isinstance(item.shape, Mesh)]
    return list(dict.fromkeys(f"{mesh.file}: {mesh.geometry.note}" for mesh in meshes if mesh.geometry.note))


def open_notes(opened: list[Object]) -> list[str]:
    """Warnings about media that are bounded by an open surface; a line each."""
    return [
        f'"{_name(item)}" is open: light that enters through it stays in its medium; make it thin, or a closed mesh'
        for item in opened
    ]


def _name(item: Object) -> str:
    return item.name or item.shape.name
