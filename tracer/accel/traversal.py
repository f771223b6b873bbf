"""A ray's way through the hierarchy: the one walk of both questions, what is nearest and what is in the way.

A box is entered where the latest of the three entries between its planes comes before the earliest exit (Kay & Kajiya,
"Ray Tracing Complex Scenes", SIGGRAPH 1986), here for eight boxes at once.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from tracer.accel.bvh import BOXES, KINDS, TRIANGLES
from tracer.compile.intrinsics import natural, soon
from tracer.compile.jit import compiled, routine
from tracer.compile.simd import WIDTH, alike, first_of, keep, lanes, larger, no_more, smaller
from tracer.formulas.double_double import U
from tracer.formulas.vector import Vector, scale
from tracer.rays import Ray
from tracer.shapes.triangle import within

NO_FARTHER = -1.0  # as how far to look: nothing more

# Three roundings on either side of the comparison, each at most 2^-53 of its value (pbr-book 4ed, 6.1.2 and 6.8.2).
OUTWARD = 1.0 + 8 * U


class Way(NamedTuple):
    """A ray as boxes see it, in the hierarchy's unit."""

    origin: Vector
    inverse: Vector
    outward: Vector  # the inverse, a little larger: what is left later is not left too early
    entry: tuple[int, int, int]  # which of a node's planes the ray meets first along x, y, z; its exit is the other one


@compiled
def way_of(ray: Ray, per_unit: float) -> Way:
    x, y, z = ray.inverse
    # and not the direction: it may be -0, its inverse is then -inf
    entry = (1 if x < 0.0 else 0, 3 if y < 0.0 else 2, 5 if z < 0.0 else 4)
    return Way(scale(per_unit, ray.origin), ray.inverse, scale(OUTWARD, ray.inverse), entry)


@compiled
def enter(planes: Any, way: Way, limit: float) -> tuple[int, Any]:
    """(which boxes are entered no farther than the limit, bit by bit; where, 0 from inside).

    A 0 * inf sets no limit: no number is larger or smaller than it.
    """
    o, inverse, outward, (x, y, z) = way.origin, way.inverse, way.outward, way.entry
    near = larger(
        larger((lanes(planes[x]) - o[0]) * inverse[0], (lanes(planes[y]) - o[1]) * inverse[1]),
        larger((lanes(planes[z]) - o[2]) * inverse[2], alike(0.0)),
    )
    far = smaller(
        smaller((lanes(planes[x ^ 1]) - o[0]) * outward[0], (lanes(planes[y ^ 1]) - o[1]) * outward[1]),
        smaller((lanes(planes[z ^ 1]) - o[2]) * outward[2], alike(limit)),
    )
    return (no_more(near, far), near)


def walker(visit: Callable[..., Any], nearest_first: bool) -> Callable[..., Any]:
    """A search that shows `visit` the surfaces that may lie on a ray's way.

    `visit(world, s, ray, asked, known, space)` gives what is known after surface s; its first number is how far to look
    on, and NO_FARTHER ends the search.
    """

    @routine
    def walk(world: Any, ray: Ray, asked: Any, known: Any, space: Any) -> Any:
        for k in range(len(world.unboxed)):
            known = visit(world, world.unboxed[natural(k)], ray, asked, known, space)
            if known[0] < 0.0:
                return known
        if len(world.nodes) == 0:
            return known
        stack, depth = space.stack, 0
        per_unit = world.per_unit[0]
        way = way_of(ray, per_unit)
        child = BOXES  # and number 0: the first node
        while True:
            kind, number = child % KINDS, child // KINDS
            if kind == BOXES:
                node = world.nodes[natural(number)]
                met, near = enter(node.planes, way, OUTWARD * (per_unit * known[0]))
                others = met & (met - 1)
                if met != 0 and others & (others - 1) == 0:  # one or two: the most frequent, without a loop or a sort
                    first, second = natural(first_of(met)), natural(first_of(others | 128))
                    child, other = node.child[first], node.child[second]
                    if others != 0:
                        if nearest_first:
                            keep(near, space.near)
                            a, b = space.near[first], space.near[second]
                            child, other = (other, child) if b < a else (child, other)
                            stack[natural(depth)].near = max(a, b)
                        stack[natural(depth)].child = other
                        depth += 1
                        fetch(world, other)
                    continue
                if nearest_first:
                    keep(near, space.near)
                base = depth
                while met != 0:
                    k = first_of(met)
                    met &= met - 1
                    fetch(world, node.child[natural(k)])
                    if nearest_first:
                        put(stack, base, depth, node.child[natural(k)], space.near[natural(k)])
                    else:
                        stack[natural(depth)].child = node.child[natural(k)]
                    depth += 1
            else:
                if kind == TRIANGLES:
                    space.tests[0] += WIDTH
                met = within(world.blocks[natural(number)], ray, per_unit) if kind == TRIANGLES else 1
                while met != 0:
                    s = world.blocks[natural(number)].surface[natural(first_of(met))] if kind == TRIANGLES else number
                    met &= met - 1
                    known = visit(world, s, ray, asked, known, space)
                    if known[0] < 0.0:
                        return known
            if nearest_first:
                while depth > 0 and stack[natural(depth - 1)].near > OUTWARD * (per_unit * known[0]):
                    depth -= 1
            if depth == 0:
                return known
            depth -= 1
            child = stack[natural(depth)].child

    return walk


@compiled
def fetch(world: Any, child: int) -> None:
    """What is laid onto the stack waits there; a mesh's boxes and triangles are seldom in the processor's cache."""
    if child % KINDS == BOXES:
        soon(world.nodes, child // KINDS)
    else:
        soon(world.blocks, child // KINDS)


@compiled
def put(stack: Any, base: int, depth: int, child: int, near: float) -> None:
    """Lay something onto the stack, below what is nearer and above `base`."""
    k = depth
    while k > base and stack[natural(k - 1)].near < near:
        here, below = stack[natural(k)], stack[natural(k - 1)]
        here.child, here.near = below.child, below.near
        k -= 1
    here = stack[natural(k)]
    here.child, here.near = child, near
