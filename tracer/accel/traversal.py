"""Traversal of the bounding volume hierarchy, for closest-hit and for any-hit searches.

The slab test (Kay & Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986) for the eight boxes of a node at once: a
ray hits a box if the last of the planes by which it enters comes before the first by which it leaves.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from tracer.accel.rows import BLOCK_CHILD, CHILD_KINDS, NODE_CHILD, NodeRow, StackRow
from tracer.compile.intrinsics import as_unsigned, prefetch
from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Numbers, Rows
from tracer.compile.simd import (
    WIDTH,
    broadcast,
    lanes_max,
    lanes_min,
    load_lanes,
    lowest_bit,
    mask_less_equal,
    store_lanes,
)
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, scale
from tracer.rays import Ray
from tracer.shapes.surface_row import BlockRow, ShapeArrays
from tracer.shapes.triangle import candidate_mask

STOP = -1.0  # a search limit that ends the search

# Either side of the comparison is rounded three times, each time by at most 2^-53 of its value (pbr-book 4ed, 6.1.2 and
# 6.8.2).
ROUND_UP = 1.0 + 8 * U


class HierarchyArrays(ShapeArrays, Protocol):
    """The arrays of the world that a traversal reads."""

    @property
    def unboxed(self) -> Numbers:
        """Ids of the surfaces outside the hierarchy, which are tested against every ray."""
        ...

    @property
    def nodes(self) -> Rows[NodeRow]: ...
    @property
    def blocks(self) -> Rows[BlockRow]: ...
    @property
    def inverse_unit(self) -> Numbers:
        """(1,): one over the hierarchy's unit of length."""
        ...


class SearchSpace(Protocol):
    """The memory that a traversal writes."""

    @property
    def stack(self) -> Rows[StackRow]: ...
    @property
    def near(self) -> Numbers:
        """(8,): distances at which the ray enters the boxes of a node."""
        ...

    @property
    def tests(self) -> Numbers:
        """(1,): number of ray-surface intersection tests."""
        ...


class BoxRay(NamedTuple):
    """A ray prepared for the slab test, in the hierarchy's unit of length."""

    origin: Vector
    inverse: Vector
    inverse_up: Vector  # `inverse` times ROUND_UP, for the exits: rounding never ends a box too early
    entry: tuple[int, int, int]  # index of the plane by which the ray enters along x, y, z; its exit is `entry` ^ 1


@inlined
def make_box_ray(ray: Ray, inverse_unit: float) -> BoxRay:
    """Prepare a ray for the slab test."""
    x, y, z = ray.inverse
    # The sign is that of the inverse, since the direction may be -0, whose inverse is -inf.
    entry = (1 if x < 0.0 else 0, 3 if y < 0.0 else 2, 5 if z < 0.0 else 4)
    return BoxRay(scale(inverse_unit, ray.origin), ray.inverse, scale(ROUND_UP, ray.inverse), entry)


@inlined
def hit_boxes(planes: Numbers, ray: BoxRay, limit: float) -> tuple[int, Any]:
    """(bit mask of the boxes that the ray enters before the limit, distances of entry; 0 from inside).

    0 * inf is NaN. Comparisons with NaN are false, so a NaN can only lengthen the interval, never shorten it.
    """
    o, inverse, inverse_up, (x, y, z) = ray.origin, ray.inverse, ray.inverse_up, ray.entry
    near = lanes_max(
        lanes_max((load_lanes(planes[x]) - o[0]) * inverse[0], (load_lanes(planes[y]) - o[1]) * inverse[1]),
        lanes_max((load_lanes(planes[z]) - o[2]) * inverse[2], broadcast(0.0)),
    )
    far = lanes_min(
        lanes_min(
            (load_lanes(planes[x ^ 1]) - o[0]) * inverse_up[0], (load_lanes(planes[y ^ 1]) - o[1]) * inverse_up[1]
        ),
        lanes_min((load_lanes(planes[z ^ 1]) - o[2]) * inverse_up[2], broadcast(limit)),
    )
    return (mask_less_equal(near, far), near)


def make_traversal(visit: Callable[..., Any], nearest_first: bool) -> Callable[..., Any]:
    """Make a traversal that visits all surfaces that a ray may hit.

    `visit(world, s, ray, query, found, space)` tests surface s and returns the updated `found`. Its first number is
    the distance beyond which nothing is searched; STOP ends the search. `query` is passed through. With
    `nearest_first`, nearer boxes are visited first, for closest-hit searches.
    """

    @compiled
    def traverse(world: HierarchyArrays, ray: Ray, query: Any, found: Any, space: SearchSpace) -> Any:
        for k in range(len(world.unboxed)):
            found = visit(world, world.unboxed[as_unsigned(k)], ray, query, found, space)
            if found[0] < 0.0:
                return found
        if len(world.nodes) == 0:
            return found
        stack, depth = space.stack, 0
        inverse_unit = world.inverse_unit[0]
        box_ray = make_box_ray(ray, inverse_unit)
        child = NODE_CHILD  # the root: its index is 0
        while True:
            kind, number = child % CHILD_KINDS, child // CHILD_KINDS
            if kind == NODE_CHILD:
                node = world.nodes[as_unsigned(number)]
                hit, near = hit_boxes(node.planes, box_ray, ROUND_UP * (inverse_unit * found[0]))
                others = hit & (hit - 1)
                if hit != 0 and others & (others - 1) == 0:  # one or two boxes, the usual case: no loop, no sorting
                    first, second = as_unsigned(lowest_bit(hit)), as_unsigned(lowest_bit(others | 128))
                    child, other = node.child[first], node.child[second]
                    if others != 0:
                        if nearest_first:
                            store_lanes(near, space.near)
                            a, b = space.near[first], space.near[second]
                            child, other = (other, child) if b < a else (child, other)
                            stack[as_unsigned(depth)].near = max(a, b)
                        stack[as_unsigned(depth)].child = other
                        depth += 1
                        prefetch_child(world, other)
                    continue
                if nearest_first:
                    store_lanes(near, space.near)
                base = depth
                while hit != 0:
                    k = lowest_bit(hit)
                    hit &= hit - 1
                    prefetch_child(world, node.child[as_unsigned(k)])
                    if nearest_first:
                        push_sorted(stack, base, depth, node.child[as_unsigned(k)], space.near[as_unsigned(k)])
                    else:
                        stack[as_unsigned(depth)].child = node.child[as_unsigned(k)]
                    depth += 1
            else:
                if kind == BLOCK_CHILD:
                    space.tests[0] += WIDTH
                is_block = kind == BLOCK_CHILD
                hit = candidate_mask(world.blocks[as_unsigned(number)], ray, inverse_unit) if is_block else 1
                while hit != 0:
                    s = world.blocks[as_unsigned(number)].surface[as_unsigned(lowest_bit(hit))] if is_block else number
                    hit &= hit - 1
                    found = visit(world, s, ray, query, found, space)
                    if found[0] < 0.0:
                        return found
            if nearest_first:
                while depth > 0 and stack[as_unsigned(depth - 1)].near > ROUND_UP * (inverse_unit * found[0]):
                    depth -= 1
            if depth == 0:
                return found
            depth -= 1
            child = stack[as_unsigned(depth)].child

    return traverse


@inlined
def prefetch_child(world: HierarchyArrays, child: int) -> None:
    """Prefetch a child that was pushed onto the stack: nodes and blocks of a mesh are seldom in the cache."""
    if child % CHILD_KINDS == NODE_CHILD:
        prefetch(world.nodes, child // CHILD_KINDS)
    else:
        prefetch(world.blocks, child // CHILD_KINDS)


@inlined
def push_sorted(stack: Rows[StackRow], base: int, depth: int, child: int, near: float) -> None:
    """Push a child onto the stack, sorted among the entries from `base` on: the nearest is on top."""
    k = depth
    while k > base and stack[as_unsigned(k - 1)].near < near:
        here, below = stack[as_unsigned(k)], stack[as_unsigned(k - 1)]
        here.child, here.near = below.child, below.near
        k -= 1
    here = stack[as_unsigned(k)]
    here.child, here.near = child, near
