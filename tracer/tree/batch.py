"""Many rays at once: their trees in one table, without a Python loop over the rays."""

from dataclasses import dataclass

import numpy as np

from tracer.choices import MODELS
from tracer.compile.rows import as_rows
from tracer.fields import LARGEST
from tracer.formulas.vector import VectorLike, vector
from tracer.kernel.entry import Batch, trace_rays_in_turn
from tracer.kernel.limits import MAX_NODES, make_limits
from tracer.kernel.nodes import NODE, NodeRow
from tracer.kernel.workspace import Eye, Workspace
from tracer.kernel.world import World
from tracer.tree.margins.margins import Details
from tracer.tree.raytree import RayTree
from tracer.tree.trace import public_rows


@dataclass(frozen=True, eq=False, repr=False)
class RayTrees:
    """The trees of n rays.

    trees = tracer.trace_rays(world, origins, directions)
    trees.hits["t"], trees.hits["object"], trees.tree(7).to_text()
    """

    world: World
    nodes: np.ndarray  # the rows of all trees, one tree after another; `id` and `parent` count from the first row
    details: Details  # what readers of the rows do not see
    starts: np.ndarray  # (n + 1,) the first row of each tree, and the end of the last one
    residuals: np.ndarray  # (n,) of each tree, as `RayTree.residual`
    origins: np.ndarray  # (n, 3) of the rays, as given
    directions: np.ndarray  # (n, 3)
    depth: int
    model: str
    max_nodes: int = MAX_NODES  # the limit of rows of each tree

    def __len__(self) -> int:
        return len(self.residuals)

    def __repr__(self) -> str:
        return f"<RayTrees of {len(self)} rays: depth {self.depth}, {len(self.nodes)} rows>"

    @property
    def hits(self) -> np.ndarray:
        """The first row of each tree (n,): what each ray hits."""
        return self.nodes[self.starts[:-1]]

    def tree(self, k: int) -> RayTree:
        """The tree of ray k, as `tracer.trace` gives it."""
        first, end = (int(row) for row in self.starts[k : k + 2])
        nodes = self.nodes[first:end].copy()
        nodes["id"] -= first
        nodes["parent"][1:] -= first
        nodes.flags.writeable = False
        size = self.world.view().width, self.world.view().height
        return RayTree(
            self.world,
            nodes,
            Details(*(column[first:end] for column in self.details)),
            float(self.residuals[k]),
            self.depth,
            self.model,
            None,
            size,
            ray=(vector(self.origins[k]), vector(self.directions[k])),
            max_nodes=self.max_nodes,
        )


def trace_rays(
    world: World,
    origins: VectorLike | np.ndarray,
    directions: VectorLike | np.ndarray,
    *,
    depth: int = 0,
    min_weight: float = 0.0,
    max_nodes: int = MAX_NODES,
    model: str | None = None,
) -> RayTrees:
    """The trees of rays with these origins (n, 3) and directions (n, 3) of any length above 0; one of the two may be a
    single vector. By default of depth 0: the first hits and their shadow rays.

    Each tree equals that of `tracer.trace`, to the last bit. ValueError for a ray without a direction, numbers that are
    not finite, or another shape.
    """
    given = np.asarray(origins, np.float64), np.asarray(directions, np.float64)
    try:
        starts, ways = np.broadcast_arrays(*given)
        fits = starts.ndim == 2 and starts.shape[1] == 3
    except ValueError:
        fits = False
    if not fits:
        shapes = " and ".join(str(array.shape) for array in given)
        raise ValueError(f"origins and directions must have the shape (n, 3), got {shapes}")
    if not (np.abs(starts) <= LARGEST).all():
        raise ValueError(f"origins must be finite, and within {LARGEST:g}")
    rays = np.concatenate([starts, unit_directions(ways)], axis=1)
    limits = make_limits(world, depth, min_weight, None, max_nodes, model, records=True)
    batch = Batch(np.zeros(len(rays) + 1, np.int64), np.zeros(len(rays)), np.zeros(1, np.int64))
    eyes = world.eyes(starts)
    workspace = Workspace(Eye(np.zeros(eyes.solids.shape[1], np.int64), eyes.surfaces[:0]))
    table = np.zeros(2 * len(rays) + 64, NODE)
    while True:
        into = as_rows(table, NodeRow)
        ended = trace_rays_in_turn(world.arrays, limits, rays, eyes, into, batch, workspace.space)
        if ended == 0:
            break
        if ended < 0:
            workspace.grow()
        else:
            table = np.concatenate([table, np.zeros(len(table), NODE)])
    nodes, details = public_rows(world, table, int(batch.starts[-1]), limits.model)
    made = (batch.starts, batch.residuals, starts, ways, limits.depth, MODELS[limits.model], limits.max_nodes)
    return RayTrees(world, nodes, details, *made)


def unit_directions(ways: np.ndarray) -> np.ndarray:
    """Directions (n, 3) with length 1, as `unit(rescale(v))` gives them."""
    size = np.abs(ways).max(axis=1, initial=0.0)
    if not (np.isfinite(size) & (size > 0.0)).all():
        raise ValueError("directions must be finite, and none 0,0,0")
    _, exponent = np.frexp(size)
    x, y, z = np.ldexp(ways, -exponent[:, None]).T
    length = np.sqrt(x * x + y * y + z * z)
    return np.stack([x / length, y / length, z / length], axis=1)
