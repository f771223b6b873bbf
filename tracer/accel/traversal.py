"""A ray's way through the hierarchy: the one walk of both questions, what is nearest and what is in the way.

A box is entered where the latest of the three entries between its planes comes before the earliest exit (Kay & Kajiya,
"Ray Tracing Complex Scenes", SIGGRAPH 1986), here for eight boxes at once.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from tracer.accel.bvh import BLOCK_CHILD, CHILD_KINDS, NODE_CHILD
from tracer.compile.intrinsics import as_unsigned, prefetch
from tracer.compile.jit import compiled, inlined
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
from tracer.shapes.triangle import candidate_mask

STOP = -1.0  # as how far to look: nothing more

# Three roundings on either side of the comparison, each at most 2^-53 of its value (pbr-book 4ed, 6.1.2 and 6.8.2).
ROUND_UP = 1.0 + 8 * U


class BoxRay(NamedTuple):
    """A ray as boxes see it, in the hierarchy's unit."""

    origin: Vector
    inverse: Vector
    outward: Vector  # the inverse, a little larger: what is left later is not left too early
    entry: tuple[int, int, int]  # which of a node's planes the ray meets first along x, y, z; its exit is the other one


@inlined
def make_box_ray(ray: Ray, inverse_unit: float) -> BoxRay:
    x, y, z = ray.inverse
    # and not the direction: it may be -0, its inverse is then -inf
    entry = (1 if x < 0.0 else 0, 3 if y < 0.0 else 2, 5 if z < 0.0 else 4)
    return BoxRay(scale(inverse_unit, ray.origin), ray.inverse, scale(ROUND_UP, ray.inverse), entry)


@inlined
def hit_boxes(planes: Any, way: BoxRay, limit: float) -> tuple[int, Any]:
    """(which boxes are entered no farther than the limit, bit by bit; where, 0 from inside).

    A 0 * inf sets no limit: no number is larger or smaller than it.
    """
    o, inverse, outward, (x, y, z) = way.origin, way.inverse, way.outward, way.entry
    near = lanes_max(
        lanes_max((load_lanes(planes[x]) - o[0]) * inverse[0], (load_lanes(planes[y]) - o[1]) * inverse[1]),
        lanes_max((load_lanes(planes[z]) - o[2]) * inverse[2], broadcast(0.0)),
    )
    far = lanes_min(
        lanes_min((load_lanes(planes[x ^ 1]) - o[0]) * outward[0], (load_lanes(planes[y ^ 1]) - o[1]) * outward[1]),
        lanes_min((load_lanes(planes[z ^ 1]) - o[2]) * outward[2], broadcast(limit)),
    )
    return (mask_less_equal(near, far), near)


def make_traversal(visit: Callable[..., Any], nearest_first: bool) -> Callable[..., Any]:
    """A search that shows `visit` the surfaces that may lie on a ray's way.

    `visit(world, s, ray, asked, known, space)` gives what is known after surface s; its first number is how far to look
    on, and NO_FARTHER ends the search.
    """

    @compiled
    def walk(world: Any, ray: Ray, asked: Any, known: Any, space: Any) -> Any:
        for k in range(len(world.unboxed)):
            known = visit(world, world.unboxed[as_unsigned(k)], ray, asked, known, space)
            if known[0] < 0.0:
                return known
        if len(world.nodes) == 0:
            return known
        stack, depth = space.stack, 0
        inverse_unit = world.inverse_unit[0]
        way = make_box_ray(ray, inverse_unit)
        child = NODE_CHILD  # and number 0: the first node
        while True:
            kind, number = child % CHILD_KINDS, child // CHILD_KINDS
            if kind == NODE_CHILD:
                node = world.nodes[as_unsigned(number)]
                met, near = hit_boxes(node.planes, way, ROUND_UP * (inverse_unit * known[0]))
                others = met & (met - 1)
                if met != 0 and others & (others - 1) == 0:  # one or two: the most frequent, without a loop or a sort
                    first, second = as_unsigned(lowest_bit(met)), as_unsigned(lowest_bit(others | 128))
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
                while met != 0:
                    k = lowest_bit(met)
                    met &= met - 1
                    prefetch_child(world, node.child[as_unsigned(k)])
                    if nearest_first:
                        push_sorted(stack, base, depth, node.child[as_unsigned(k)], space.near[as_unsigned(k)])
                    else:
                        stack[as_unsigned(depth)].child = node.child[as_unsigned(k)]
                    depth += 1
            else:
                if kind == BLOCK_CHILD:
                    space.tests[0] += WIDTH
                met = candidate_mask(world.blocks[as_unsigned(number)], ray, inverse_unit) if kind == BLOCK_CHILD else 1
                while met != 0:
                    s = (
                        world.blocks[as_unsigned(number)].surface[as_unsigned(lowest_bit(met))]
                        if kind == BLOCK_CHILD
                        else number
                    )
                    met &= met - 1
                    known = visit(world, s, ray, asked, known, space)
                    if known[0] < 0.0:
                        return known
            if nearest_first:
                while depth > 0 and stack[as_unsigned(depth - 1)].near > ROUND_UP * (inverse_unit * known[0]):
                    depth -= 1
            if depth == 0:
                return known
            depth -= 1
            child = stack[as_unsigned(depth)].child

    return walk


@inlined
def prefetch_child(world: Any, child: int) -> None:
    """What is laid onto the stack waits there; a mesh's boxes and triangles are seldom in the processor's cache."""
    if child % CHILD_KINDS == NODE_CHILD:
        prefetch(world.nodes, child // CHILD_KINDS)
    else:
        prefetch(world.blocks, child // CHILD_KINDS)


@inlined
def push_sorted(stack: Any, base: int, depth: int, child: int, near: float) -> None:
    """Lay something onto the stack, below what is nearer and above `base`."""
    k = depth
    while k > base and stack[as_unsigned(k - 1)].near < near:
        here, below = stack[as_unsigned(k)], stack[as_unsigned(k - 1)]
        here.child, here.near = below.child, below.near
        k -= 1
    here = stack[as_unsigned(k)]
    here.child, here.near = child, near
