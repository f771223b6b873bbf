"""The rows of a ray tree, and queries on them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import SupportsIndex

import numpy as np

from tracer.formulas.vector import Vector
from tracer.kernel.limits import MAX_NODES
from tracer.kernel.nodes import BLOCKED, ENDS, KINDS, NODES, SHADOW, SURFACE
from tracer.kernel.world import World
from tracer.scene import Scene
from tracer.scene.radiance_bound import RadianceBound, radiance_bound
from tracer.tree import names
from tracer.tree.digits import significant_digits
from tracer.tree.ledger import Ledger, make_ledger
from tracer.tree.margins.margins import DECISIONS, Details, Margins, faces_away, find_margins


class Children(Sequence[list[int]]):
    """The rows below each row, from the parents of all rows. It is quick to make for a million rows."""

    def __init__(self, parents: np.ndarray) -> None:
        self.order = np.argsort(parents, kind="stable")
        self.starts = np.searchsorted(parents[self.order], np.arange(len(parents) + 1))

    def __len__(self) -> int:
        return len(self.starts) - 1

    def __getitem__(self, row: SupportsIndex) -> list[int]:  # type: ignore[override]
        first, end = self.starts[int(row) : int(row) + 2]
        return self.order[first:end].tolist()


@dataclass(frozen=True, eq=False, repr=False)
class TreeTable:
    """One pixel's tree. `nodes` is a structured array, one row per ray, with the fields of `tracer.nodes`."""

    world: World
    nodes: np.ndarray
    details: Details  # what readers of the rows do not see
    residual: float  # sum over the rays that were cut of the largest component of their weight
    depth: int
    model: str
    pixel: tuple[int, int] | None  # None: a ray given by hand
    size: tuple[int, int]  # of the image, width and height
    tolerance: float | None = None  # the residual asked for; the rows are then in order of tracing
    missing_allowed: float | None = None  # the missing light asked for; `tolerance` follows from it
    max_nodes: int = MAX_NODES  # the limit of rows
    image_point: tuple[float, float] = (0.0, 0.0)  # the point of the image that the ray goes through, in pixels
    ray: tuple[Vector, Vector] | None = None  # a ray by hand: origin and direction as given
    sample: int | None = None  # the number of the pixel's sample, from 0; None: the pixel's centre
    samples: int = 1  # of a pixel of the image

    @property
    def scene(self) -> Scene:
        return self.world.scene

    @property
    def radiance(self) -> np.ndarray:
        """The colour of the pixel, or of its sample, linear RGB (3,)."""
        return self.nodes["radiance"][0]

    @property
    def radiance_error(self) -> float:
        """Bound to first order on the rounding error of the colour's components."""
        return float(self.nodes["radiance_error"][0])

    @cached_property
    def radiance_bound(self) -> RadianceBound:
        """The most that a ray of the scene can bring."""
        return radiance_bound(self.scene)

    @property
    def missing(self) -> Vector:
        """`radiance` lacks at most this, linear RGB; inf where there is no bound."""
        return self.radiance_bound.missing(self.residual)

    @property
    def bound(self) -> float:
        """The largest component of `missing`."""
        return max(self.missing)

    @cached_property
    def ledger(self) -> Ledger:
        """The camera ray's weight of 1, split into leaves, cut and absorbed."""
        return make_ledger(self.nodes, self.residual, self.scene, self.model)

    @property
    def place(self) -> str:
        """The pixel as text, or "a ray"."""
        return f"pixel {self.pixel[0]},{self.pixel[1]}" if self.pixel else "a ray"

    @property
    def sample_text(self) -> str:
        """The sample as text, like "sample 3 of 16"; empty for the pixel's centre. Samples are numbered from 0."""
        if self.sample is None:
            return ""
        return f"sample {self.sample}" + (f" of {self.samples}" if self.sample < self.samples else "")

    def __len__(self) -> int:
        return len(self.nodes)

    def __repr__(self) -> str:
        color = " ".join(f"{x:.4f}" for x in self.radiance)
        sample = f", {self.sample_text}" if self.sample_text else ""
        return f"<RayTree of {self.place}{sample}: depth {self.depth}, {len(self)} rows, radiance {color}>"

    @cached_property
    def is_limited(self) -> bool:
        """True if the limit of rows ended the tree."""
        return bool((self.nodes["end"] == NODES).any())

    @cached_property
    def children(self) -> "Children":
        """For each row, the rows below it: its shadow rays first, then the rays that it sends out."""
        return Children(self.nodes["parent"])

    def preorder(self) -> Iterator[int]:
        """The rows in preorder: each ray, then all that is below it."""
        waiting = [0]
        while waiting:
            i = waiting.pop()
            yield i
            waiting += reversed(self.children[i])

    def kind(self, i: int) -> str:
        """The kind of ray i, one of KINDS."""
        return KINDS[self.nodes["kind"][i]]

    def end(self, i: int) -> str | None:
        """The reason why no ray follows ray i, one of ENDS; None if it has children and none was cut."""
        code = self.nodes["end"][i]
        return ENDS[code] if code >= 0 else None

    def object_name(self, i: int) -> str | None:
        """The name of the object that ray i hit; of a shadow ray, of the object in its way."""
        k = self.nodes["object"][i]
        return self.scene.object_name(k) if k >= 0 else None

    def light_name(self, i: int) -> str | None:
        """The name of the light that shadow ray i goes to."""
        j = self.nodes["light"][i]
        return self.scene.light_name(int(j)) if j >= 0 else None

    def faces_away(self, i: int) -> bool:
        """Whether ray i is a shadow ray from a surface that faces away from the light. It adds nothing, whatever it
        meets.
        """
        return bool(self.facing_away[i])

    @cached_property
    def facing_away(self) -> np.ndarray:
        """`faces_away` for all rows."""
        return faces_away(self.nodes, self.nodes)

    def adds_nothing(self, i: int) -> bool:
        """Whether ray i adds no light to its pixel, whatever light is at its end: its factor or weight is 0, or it is a
        shadow ray and its light's share of the local term is 0.
        """
        return bool(self.adding_nothing[i])

    @cached_property
    def adding_nothing(self) -> np.ndarray:
        """`adds_nothing` for all rows."""
        factor, weight, share = ((self.nodes[name] == 0.0).all(axis=1) for name in ("factor", "weight", "radiance"))
        return factor | weight | (self.nodes["kind"] == SHADOW) & (self.facing_away | share)

    def from_inside(self, i: int) -> bool:
        """Whether ray i meets its surface from the side away from the outward normal: it leaves the object's medium."""
        return bool(self.details.hit_side[i] < 0.0)

    def digits(self, i: int) -> int:
        """The number of correct decimal digits of the hit point, 0 to 15."""
        row = self.nodes[i]
        size = max(row["t"], np.abs(row["point"]).max())
        if not size > row["error"]:
            return 0
        return min(15, significant_digits(size, row["error"]))

    @cached_property
    def margins(self) -> Margins:
        """The decision margins of all rows."""
        return self.margins_of(np.arange(len(self)))

    def margins_of(self, rows: np.ndarray) -> Margins:
        """The decision margins of some rows. The time is about 25 ns for each row and each surface that is near it."""
        return find_margins(self.world, self.nodes, self.details, rows)

    def decision(self, margins: Margins, k: int) -> str:
        """The decision that entry k of `margins` is about, in words; empty for none within reach."""
        if margins.decision[k] < 0:
            return ""
        owner = margins.object[k]
        return DECISIONS[margins.decision[k]].format(self.scene.object_name(int(owner)) if owner >= 0 else "")

    def doubtful(self, rows: Iterable[int]) -> dict[int, str]:
        """The rays among `rows` that could have gone otherwise, since rounding may have decided; each with the decision
        in words.
        """
        chosen = np.array(sorted(rows), np.int64)
        margins = self.margins_of(chosen)
        low = np.flatnonzero(margins.margin < 1.0).tolist()
        return {int(chosen[k]): self.decision(margins, k) for k in low}

    @cached_property
    def doubts(self) -> list[tuple[int, str]]:
        """`doubtful` among all rays, in their order."""
        return list(self.doubtful(range(len(self))).items())

    def path(self, i: int) -> str:
        """The path of ray i: unique, and the same for every depth and number of lights (`tracer.tree.names`)."""
        return names.path(self.nodes, self._lights, i)

    def label(self, i: int) -> str:
        """The label of ray i: its kind and number, for eyes (`tracer.tree.names`)."""
        return names.label(self.nodes, self._numbers, self._lights, i)

    def light_label(self, i: int) -> str:
        """The end of the label of shadow ray i: its light. Enough where the ray that it starts from is shown."""
        return names.light_part(self._lights, self.nodes[i])

    def find(self, path: str) -> int | None:
        """The row of the ray with this path, or None."""
        rays, dot, light = path.partition(".")
        steps = list("" if rays == self.path(0) else rays) + [light] * bool(dot)
        row: int | None = 0 if rays else None
        for step in steps:
            row = next((k for k in self.children[row or 0] if self._step(k) == step), None)
            if row is None:
                break
        return row

    def _step(self, i: int) -> str:
        """The last part of the path of ray i."""
        return self.light_label(i) if self.nodes["kind"][i] == SHADOW else names.LETTERS[self.kind(i)]

    @cached_property
    def _lights(self) -> list[str]:
        return names.light_names(self.scene)

    @cached_property
    def _numbers(self) -> np.ndarray:
        return names.numbers(self.nodes)

    def light_path(self, i: int) -> str:
        """The light path of ray i in Heckbert's notation (SIGGRAPH 1990), eye first.

        E is the eye, S a mirror or glass on the way, D a surface whose own colour is seen, L a light that is reached.
        """
        row = self.nodes[i]
        letters = "E" + "S" * int(row["depth"])
        if row["kind"] == SHADOW:
            return letters + ("D" if row["end"] == BLOCKED else "DL")
        return letters + ("D" if row["end"] == SURFACE else "")
