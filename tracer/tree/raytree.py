"""The tree of rays behind one pixel: a read-only view of the node table, and the calls that get one.

tree = trace(world, pixel=(320, 240), depth=3)
tree.radiance, tree.nodes["t"], tree.to_json()
"""

import json
import math
import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import entry_points
from typing import Any

import numpy as np

from tracer.formulas.camera import View
from tracer.formulas.media import WORD
from tracer.formulas.sampler import CENTER, SAMPLERS, SOBOL, make_samples
from tracer.formulas.vector import Vector, rescale, unit
from tracer.kernel.entry import Area, Workspace, eye_view, run
from tracer.kernel.limits import MAX_NODES, MODELS, make_limits
from tracer.kernel.nodes import BLOCKED, ENDS, KINDS, PUBLIC, SHADOW, SURFACE
from tracer.kernel.world import World
from tracer.scene import Scene
from tracer.tree.bounds import Ledger, ledger, radiance_bound
from tracer.tree.error_propagation import propagate_errors
from tracer.tree.text import significant_digits, tree_text


@dataclass(frozen=True, eq=False, repr=False)
class RayTree:
    """One pixel's tree. `nodes`: a structured array, one row a ray, fields as in `tracer.nodes`; angles in radians."""

    nodes: np.ndarray
    residual: float  # sum over the rays that were cut of the largest component of their weight
    scene: Scene
    depth: int
    model: str
    pixel: tuple[int, int] | None  # None: a ray given by hand
    size: tuple[int, int]
    tolerance: float | None = None  # what the residual was to come down to; the rows are then in order of tracing

    @property
    def radiance(self) -> np.ndarray:
        """What the pixel shows, linear RGB."""
        return self.nodes["radiance"][0]

    @cached_property
    def bound(self) -> float:
        """What is missing from `radiance` is at most this in each component; infinite where nothing bounds it."""
        return self.residual * radiance_bound(self.scene) if self.residual > 0.0 else 0.0

    @cached_property
    def ledger(self) -> Ledger:
        """Where the weight of 1 went: leaves, cut, absorbed."""
        return ledger(self)

    def __len__(self) -> int:
        return len(self.nodes)

    def __repr__(self) -> str:
        of = f"pixel {self.pixel[0]},{self.pixel[1]}" if self.pixel else "a ray"
        color = " ".join(f"{x:.4f}" for x in self.radiance)
        return f"<RayTree of {of}: depth {self.depth}, {len(self)} rows, radiance {color}>"

    @cached_property
    def children(self) -> list[list[int]]:
        """For each node the rows below it: its shadow rays first, then the rays it sends out."""
        below: list[list[int]] = [[] for _ in range(len(self.nodes))]
        for i, parent in enumerate(self.nodes["parent"]):
            if parent >= 0:
                below[parent].append(i)
        return below

    def kind(self, i: int) -> str:
        return KINDS[self.nodes["kind"][i]]

    def end(self, i: int) -> str | None:
        """Why nothing follows this ray; None where its children do, none of them cut."""
        code = self.nodes["end"][i]
        return ENDS[code] if code >= 0 else None

    def object_name(self, i: int) -> str | None:
        """What the ray hit; for a shadow ray what stands in its way."""
        k = self.nodes["object"][i]
        return name_of(self.scene, k) if k >= 0 else None

    def faces_away(self, i: int) -> bool:
        """Whether i is a shadow ray to a light behind the surface it starts on: that adds nothing, whatever is met."""
        row = self.nodes[i]
        if row["kind"] != SHADOW:
            return False
        return bool(row["t"] == 0.0 or self.nodes["normal"][row["parent"]] @ row["direction"] <= 0.0)

    def digits(self, i: int) -> int:
        """How many decimal digits of the hit's place are sure; 0 where rounding has left none, 15 at most."""
        row = self.nodes[i]
        size = max(row["t"], np.abs(row["point"]).max())
        if not size > row["error"]:
            return 0
        return min(15, significant_digits(size, row["error"]))

    def light_name(self, i: int) -> str | None:
        j = self.nodes["light"][i]
        return light_name(self.scene, int(j)) if j >= 0 else None

    def path(self, i: int) -> str:
        """The surfaces between the eye and the ray's end, eye first (Heckbert 1990).

        E the eye, S a mirror or glass that sent the ray on, D a surface whose own colour is seen, L a light reached.
        """
        row = self.nodes[i]
        letters = "E" + "S" * int(row["depth"])
        if row["kind"] == SHADOW:
            return letters + ("D" if row["end"] == BLOCKED else "DL")
        return letters + ("D" if row["end"] == SURFACE else "")

    def _repr_svg_(self) -> str | None:
        """What a notebook shows: the tree's figure, by whoever has announced that they can draw it."""
        for drawer in entry_points(group="raytree.notebook", name="tree"):
            return drawer.load()(self)
        return None

    def to_text(self, most: int | None = None) -> str:
        """The tree as it is drawn in a terminal."""
        return tree_text(self, most)

    def to_dict(self) -> dict[str, Any]:
        """The tree as JSON has it: names for codes, None for absent, degrees for angles."""
        return {
            "format": "raytree-tree/1",
            "scene": str(self.scene.path) if self.scene.path else self.scene.title,
            "pixel": list(self.pixel) if self.pixel else None,
            "size": list(self.size),
            "depth": self.depth,
            "model": self.model,
            "radiance": _plain(self.radiance),
            "residual": _plain(self.residual),
            "bound": _plain(self.bound),
            "nodes": [self._node(i) for i in range(len(self))],
        }

    def to_json(self) -> str:
        """Floats as the shortest text that reads back to the same bits; a line a node."""
        tree = self.to_dict()
        nodes = tree.pop("nodes")
        head = json.dumps(tree, allow_nan=False, ensure_ascii=False)
        lines = ",\n  ".join(json.dumps(node, allow_nan=False, ensure_ascii=False) for node in nodes)
        return f'{head[:-1]}, "nodes": [\n  {lines}]}}\n'

    def _node(self, i: int) -> dict[str, Any]:
        row = self.nodes[i]
        node: dict[str, Any] = {}
        for field in PUBLIC.names or ():
            match field:
                case "kind":
                    node[field] = self.kind(i)
                case "end":
                    node[field] = self.end(i)
                case "object":
                    node[field] = self.object_name(i)
                case "light":
                    node[field] = self.light_name(i)
                case "parent":
                    node[field] = int(row[field]) if row[field] >= 0 else None
                case "theta1" | "theta2":
                    node[field] = _plain(math.degrees(row[field]))
                case _:
                    node[field] = _plain(row[field])
        node["path"] = self.path(i)
        return node

    def walk(self) -> Iterator[int]:
        """Rows in the order of an outline: each ray, below it what belongs to it."""
        waiting = [0]
        while waiting:
            i = waiting.pop()
            yield i
            waiting += reversed(self.children[i])


def name_of(scene: Scene, k: int) -> str:
    """An object's name, or its shape and number where the author gave none."""
    item = scene.objects[k]
    return item.name or f"{type(item.shape).__name__.lower()} {k}"


def light_name(scene: Scene, j: int) -> str:
    """A light's name, or its number where the author gave none."""
    return scene.lights[j].name or f"light {j}"


def _plain(value: Any) -> Any:
    """Numbers as JSON has them; a vector that is absent is None as a whole."""
    if isinstance(value, np.ndarray):
        numbers = value.tolist()
        return numbers if all(math.isfinite(x) for x in numbers) else None
    if isinstance(value, np.integer):
        return int(value)
    return float(value) if math.isfinite(value) else None


def trace(
    world: World,
    pixel: tuple[int, int] | None = None,
    ray: tuple[Sequence[float], Sequence[float]] | None = None,
    *,
    depth: int | None = None,
    size: tuple[int, int] | None = None,
    sample: int | None = None,
    min_weight: float = 0.0,
    tolerance: float | None = None,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
    sampler: str = SAMPLERS[SOBOL],
    samples: int | None = None,
) -> RayTree:
    """The tree behind a pixel of the image (counted from the top left), or of a ray (origin, direction).

    `size` (width, height) is the scene's by default, `depth` and `model` too; `sample` is the number of one point of
    the pixel's sampler (of `samples`, which only jittered points ask for), its centre by default. With a `tolerance`
    the heaviest rays are followed first, to any depth but one that is given, until those left weigh no more than that
    in sum, or `max_nodes` rays have been traced. ValueError for a pixel outside the image or a ray without a direction.
    """
    if (pixel is None) == (ray is None):
        raise ValueError("either a pixel or a ray is traced: give one of them")
    scene = world.scene
    size = checked_size(size) or (scene.image.width, scene.image.height)
    limits = make_limits(world, depth, min_weight, tolerance, max_nodes, model, records=True)
    if pixel is not None:
        x, y = (operator.index(value) for value in pixel)
        if not (0 <= x < size[0] and 0 <= y < size[1]):
            raise ValueError(f"pixel must be within 0,0 .. {size[0] - 1},{size[1] - 1}, got {x},{y}")
        view = world.view(size)
    else:
        assert ray is not None
        x, y = 0, 0
        view = _ray_view(*ray)
    points = CENTER if sample is None else make_samples(samples or sample + 1, sampler)._replace(first=sample, count=1)
    workspace = Workspace(words(world))
    pixels = np.zeros((0, 0, 3))  # the colour stands in the table
    area = Area(x, y, x + 1, y + 1, 1, 0)
    run(world.arrays, view, limits, points, area, solids_at(world, view.eye), pixels, workspace)
    space = workspace.arrays
    count = int(space.tree[0])
    propagate_errors(world.arrays, space.table.view(np.recarray), count)
    nodes = np.zeros(count, PUBLIC)
    for name in PUBLIC.names or ():
        nodes[name] = space.table[name][:count]
    _fill_angles(nodes, scene)
    nodes.flags.writeable = False
    residual = float(space.tree[1])
    reached = limits.depth if depth is not None or tolerance is None else int(nodes["depth"].max())
    return RayTree(nodes, residual, scene, reached, MODELS[limits.model], pixel and (x, y), size, tolerance)


def checked_size(size: tuple[int, int] | None) -> tuple[int, int] | None:
    """Width and height of an image, each at least 1; ValueError for others."""
    if size is None:
        return None
    width, height = (operator.index(value) for value in size)
    if width < 1 or height < 1:
        raise ValueError(f"size must be at least 1x1, got {width}x{height}")
    return (width, height)


def words(world: World) -> int:
    """How many words the set of solids takes; none where nothing is transparent."""
    return -(-len(world.solids) // WORD)


def solids_at(world: World, eye: Vector) -> np.ndarray:
    """The set of solids around a point, as kernels carry it."""
    bits = np.zeros(words(world), np.int64)
    for rank in world.around(eye):
        bits[rank // WORD] |= 1 << (rank % WORD)
    return bits


def _ray_view(origin: Sequence[float], direction: Sequence[float]) -> View:
    numbers = [*map(float, origin), *map(float, direction)]
    if len(numbers) != 6 or not all(map(math.isfinite, numbers)):
        raise ValueError(f"a ray must be six finite numbers, got {numbers}")
    if not any(numbers[3:]):
        raise ValueError("a ray's direction must not be 0,0,0")
    return eye_view((numbers[0], numbers[1], numbers[2]), unit(rescale(numbers[3:])))


def _fill_angles(nodes: np.ndarray, scene: Scene) -> None:
    """Angles of incidence and refraction from the recorded vectors: no image needs them, every reader does."""
    hit = np.flatnonzero(np.isfinite(nodes["normal"][:, 0]))
    d, n = nodes["direction"][hit], nodes["normal"][hit]
    across = np.cross(d, n)
    s1 = np.sqrt((across * across).sum(axis=1))
    theta1 = np.arctan2(s1, -(d * n).sum(axis=1))
    nodes["theta1"][hit] = theta1
    n1, n2, radicand = nodes["n1"][hit], nodes["n2"][hit], nodes["radicand"][hit]
    bent = radicand > 0.0  # not where it is absent
    s2 = n1[bent] / n2[bent] * s1[bent]
    theta2 = np.where(n1[bent] == n2[bent], theta1[bent], np.arctan2(s2, np.sqrt(radicand[bent])))
    nodes["theta2"][hit[bent]] = theta2
