"""The ray tree that users get: a `TreeTable` that can show itself as text, as JSON, and in a notebook."""

import math
from importlib.metadata import entry_points
from typing import Any

import numpy as np

from tracer.kernel.nodes import PUBLIC
from tracer.printable import json_text
from tracer.tree.table import TreeTable
from tracer.tree.text import tree_text
from tracer.tree.verified.enclosures import VerifiedTree

FORMAT = "raytree-tree/1"


class RayTree(TreeTable):
    """One pixel's tree.

    tree = tracer.trace(world, pixel=(320, 240), depth=3)
    tree.radiance, tree.nodes["t"], tree.to_json()
    """

    def to_text(self, most: int | None = None, verified: VerifiedTree | None = None) -> str:
        """The tree as text for a terminal: the heaviest rays if there are more than `most`. With what is `verified`."""
        return tree_text(self, most, verified)

    def to_dict(self, verified: VerifiedTree | None = None) -> dict[str, Any]:
        """The content of the JSON: names for codes, None for absent, degrees for angles. With what is `verified`."""
        about = {} if verified is None else {"verified": verified.to_dict()}
        return {
            "format": FORMAT,
            "scene": str(self.scene.path) if self.scene.path else self.scene.title,
            "pixel": list(self.pixel) if self.pixel else None,
            "sample": self.sample,
            "size": list(self.size),
            "depth": self.depth,
            "model": self.model,
            "radiance": _json_value(self.radiance),
            "residual": _json_value(self.residual),
            "bound": _json_value(self.bound),
            "max_nodes": self.max_nodes,
            **about,
            "nodes": [self._node(i, verified) for i in range(len(self))],
        }

    def to_json(self, verified: VerifiedTree | None = None) -> str:
        """The tree as JSON, a line per node. Floats are the shortest text that reads back to the same bits."""
        tree = self.to_dict(verified)
        nodes = tree.pop("nodes")
        head = json_text(tree)
        lines = ",\n  ".join(map(json_text, nodes))
        return f'{head[:-1]}, "nodes": [\n  {lines}]}}\n'

    def _node(self, i: int, verified: VerifiedTree | None) -> dict[str, Any]:
        row = self.nodes[i]
        node: dict[str, Any] = {}
        for field in PUBLIC.names or ():
            match field:
                case "kind":
                    node[field] = self.kind(i)
                case "end":
                    node[field] = self.end(i)
                case "object":
                    k = int(row[field])
                    node[field] = self.scene.objects[k].name or self.object_name(i) if k >= 0 else None
                case "light":
                    j = int(row[field])
                    node[field] = self.scene.lights[j].name or self.light_name(i) if j >= 0 else None
                case "parent":
                    node[field] = int(row[field]) if row[field] >= 0 else None
                case "theta1" | "theta2":
                    node[field] = _json_value(math.degrees(row[field]))
                case _:
                    node[field] = _json_value(row[field])
        node["path"] = self.path(i)
        node["label"] = self.label(i)
        node["light_path"] = self.light_path(i)
        margin = float(self.margins.margin[i])
        node["margin"] = margin if margin < math.inf else None
        node["decision"] = self.decision(self.margins, i) or None
        if verified is not None:
            node["verified"] = verified.row_to_dict(i)
        return node

    def _repr_svg_(self) -> str | None:
        """The tree's figure in a notebook, drawn by the package that has registered for it (pyproject.toml)."""
        for drawer in entry_points(group="raytree.notebook", name="tree"):
            return drawer.load()(self)
        return None


def _json_value(value: Any) -> Any:
    """A number or vector for JSON, which has no NaN: None where it is absent."""
    if isinstance(value, np.ndarray):
        numbers = value.tolist()
        return numbers if all(math.isfinite(x) for x in numbers) else None
    if isinstance(value, np.integer):
        return int(value)
    return float(value) if math.isfinite(value) else None
