"""The nodes of a glTF document: a tree of placements, with a mesh, a camera or a light at some of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tracer.formats.gltf.accessors import Accessors
from tracer.formats.gltf.document import Item
from tracer.formats.notes import Notes
from tracer.formats.source import Fault

IDENTITY = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
INSTANCING = "EXT_mesh_gpu_instancing"


@dataclass(frozen=True)
class Placed:
    """A node, and its matrix (4, 4) in the frame of the scene."""

    node: Item
    matrix: np.ndarray


def placed_nodes(document: Item, notes: Notes) -> Iterator[Placed]:
    """Yield the nodes of the document's scene, each before its children. Raises Fault if one is reached twice."""
    nodes = document.items("nodes")
    waiting = [(number, np.eye(4), "scene") for number in reversed(roots(document, nodes))]
    seen: set[int] = set()
    while waiting:
        number, parent, place = waiting.pop()
        if number >= len(nodes):
            raise Fault(f"{place} must refer to nodes from 0 to {len(nodes) - 1}, got {number}")
        if number in seen:
            raise Fault(f"node {number} must have one parent, got a second")
        seen.add(number)
        node = nodes[number]
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = parent @ matrix_of(node)
        if not np.isfinite(matrix).all():
            raise Fault(f"{node.place} must have a finite placement")
        yield Placed(node, matrix)
        waiting += [(child, matrix, f"{node.place}.children") for child in reversed(node_numbers(node, "children"))]
    if len(document.entries("scenes")) <= 1:
        unseen = sum(node.has("mesh") for number, node in enumerate(nodes) if number not in seen)
        notes.count("nodes with a mesh that are not in the scene are not shown", unseen)


def roots(document: Item, nodes: list[Item]) -> list[int]:
    """The nodes of the scene that the file shows; without scenes, all nodes that no other one contains."""
    scenes = document.items("scenes")
    if not scenes:
        children = {child for node in nodes for child in node_numbers(node, "children")}
        return [number for number in range(len(nodes)) if number not in children]
    number = document.whole("scene", 0)
    if number >= len(scenes):
        raise Fault(f"scene must be from 0 to {len(scenes) - 1}, got {number}")
    return node_numbers(scenes[number], "nodes")


def node_numbers(item: Item, key: str) -> list[int]:
    """A list of node numbers."""
    numbers = item.entries(key)
    for value in numbers:
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise Fault(f"{item.place}.{key} must be numbers of nodes, got {value!r:.40}")
    return numbers


def matrix_of(node: Item) -> np.ndarray:
    """The matrix (4, 4) of a node, from `matrix` (column by column) or from translation, rotation and scale."""
    if node.has("matrix"):
        return np.array(node.numbers("matrix", IDENTITY)).reshape(4, 4).T
    return trs(
        np.array([node.numbers("translation", [0.0, 0.0, 0.0])]),
        np.array([node.numbers("rotation", [0.0, 0.0, 0.0, 1.0])]),
        np.array([node.numbers("scale", [1.0, 1.0, 1.0])]),
    )[0]


def trs(translation: np.ndarray, rotation: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Matrices (n, 4, 4) from translations (n, 3), quaternions x y z w (n, 4), and scales (n, 3)."""
    length = np.sqrt((rotation * rotation).sum(axis=1, keepdims=True))
    x, y, z, w = np.where(length > 0.0, rotation / np.where(length > 0.0, length, 1.0), [0.0, 0.0, 0.0, 1.0]).T
    columns = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
        [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
    matrices = np.tile(np.eye(4), (len(translation), 1, 1))
    matrices[:, :3, :3] = np.array(columns).transpose(2, 1, 0) * scale[:, None, :]
    matrices[:, :3, 3] = translation
    return matrices


def instance_count(placed: Placed, accessors: Accessors) -> int:
    """The number of times that a node's mesh is shown: one, or one for each instance (EXT_mesh_gpu_instancing)."""
    attributes = placed.node.item("extensions").item(INSTANCING).item("attributes")
    for key in ("TRANSLATION", "ROTATION", "SCALE"):
        if attributes.has(key):
            number = attributes.whole(key)
            if number >= len(accessors.accessors):
                raise Fault(f"{attributes.place}.{key} must be an accessor, got {number}")
            return accessors.accessors[number].whole("count")
    return 1


def instances(placed: Placed, accessors: Accessors) -> np.ndarray:
    """The matrices (n, 4, 4) of all instances of a node's mesh."""
    attributes = placed.node.item("extensions").item(INSTANCING).item("attributes")
    found = {
        key: accessors.array(attributes.whole(key), components, attributes.place).astype(np.float64)
        for key, components in (("TRANSLATION", 3), ("ROTATION", 4), ("SCALE", 3))
        if attributes.has(key)
    }
    counts = {len(values) for values in found.values()}
    if not counts:
        return placed.matrix[None]
    if len(counts) > 1:
        raise Fault(f"{attributes.place} must have attributes of one length, got {sorted(counts)}")
    n = counts.pop()
    defaults = {"TRANSLATION": [0.0, 0.0, 0.0], "ROTATION": [0.0, 0.0, 0.0, 1.0], "SCALE": [1.0, 1.0, 1.0]}
    own = trs(*(found.get(key, np.tile(default, (n, 1))) for key, default in defaults.items()))
    return placed.matrix @ own
