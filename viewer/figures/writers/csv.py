"""The node table as CSV: one line per ray, one column per component of a vector, named as in the JSON."""

from typing import Any

from tracer.tree.raytree import RayTree
from viewer.base.cells import csv_text

AXES = ("x", "y", "z")
CHANNELS = ("r", "g", "b")
COLORS = ("factor", "weight", "local", "radiance")
VECTORS = ("origin", "direction", "point", "normal")


def write_csv(tree: RayTree) -> str:
    nodes = tree.to_dict()["nodes"]
    rows = [_flat(node) for node in nodes]
    return csv_text([list(rows[0]), *(list(row.values()) for row in rows)])


def _flat(node: dict[str, Any]) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for name, value in node.items():
        if name in VECTORS or name in COLORS:
            parts = CHANNELS if name in COLORS else AXES
            row |= {f"{name}_{part}": None if value is None else value[k] for k, part in enumerate(parts)}
        else:
            row[name] = value
    return row
