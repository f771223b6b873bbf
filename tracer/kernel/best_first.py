"""Traces one pixel's ray tree best-first: the ray of largest weight is next, until the weights of the others sum up to
at most the tolerance.

Between glass plates the tree doubles at every face while the weights hardly decay. A limit on the depth, or on the
weight of a single ray, then cuts off an unknown amount. Here the rays that are not traced yet are in a priority
queue. The sum of their weights bounds what is missing, and tracing the heaviest lowers it fastest. Whenever tracing
stops, the tree is the best so far.

The queue is a binary heap (Williams, CACM 7(6), 1964). An open ray takes little memory: when its turn comes, the hit
of its parent is scattered again.
"""

from tracer.compile.jit import compiled, inlined
from tracer.compile.rows import Rows
from tracer.formulas.double_double import dd_add
from tracer.formulas.vector import max_component, vector
from tracer.kernel.arrays import Arrays
from tracer.kernel.limits import Limits
from tracer.kernel.nodes import NODES, NONE, SURFACE, TOLERANCE
from tracer.kernel.scatter import cut_reason, scatter, start_child
from tracer.kernel.trace import accumulate_radiance, direct_light, trace_ray
from tracer.kernel.workspace import OpenRow, Space


@compiled
def trace_best_first(world: Arrays, limits: Limits, space: Space) -> int:
    """Trace the tree whose camera ray is row 0. Rows are in order of tracing, each followed by its shadow rays.

    Returns the number of rows, -1 if the table is too short.
    """
    table, heap = space.table, space.open
    lights = len(world.lights)
    i, count, waiting, created = 0, 1, 0, 0
    planned = (
        1 + lights
    )  # counts shadow rays that an image does not trace, so that it ends where the recorded tree does
    left = (0.0, 0.0)  # sum of the weights of open and cut rays, in double-double
    stopped_by = TOLERANCE
    while True:
        if count + lights + 1 > len(table):
            return -1
        trace_ray(world, space, i)
        count = direct_light(world, limits, space, i, count)
        row = table[i]
        if row.surface >= 0:
            rays = scatter(world, limits, row)
            if rays.reflected == 0.0 and rays.refracted == 0.0:
                row.end = SURFACE
            for refracted in (False, True):
                factor = rays.refracted if refracted else rays.reflected
                if factor > 0.0:
                    weight = max_component(vector(row.weight)) * factor
                    left = dd_add(left, (weight, 0.0))
                    reason = cut_reason(limits, row, rays, refracted, weight)
                    if reason == NONE:
                        heap_push(heap, waiting, weight, created, i, refracted)
                        waiting += 1
                        created += 1
                    else:
                        row.end = reason
                        row.cut += weight
        if waiting == 0 or left[0] + left[1] <= limits.tolerance:
            break
        if planned + 1 + lights > limits.max_nodes:
            stopped_by = NODES
            space.tree[2] = 1.0
            break
        parent, refracted = heap[0].parent, heap[0].refracted
        left = dd_add(left, (-heap[0].weight, 0.0))
        waiting -= 1
        heap_pop(heap, waiting)
        i = count
        planned += 1 + lights
        start_child(world, limits, space, parent, scatter(world, limits, table[parent]), refracted, i)
        count += 1
    for k in range(waiting):
        row = table[heap[k].parent]
        row.end = stopped_by
        row.cut += heap[k].weight
    accumulate_radiance(table, count)
    return count


@inlined
def precedes(heap: Rows[OpenRow], a: int, b: int) -> bool:
    """Whether entry a is traced before entry b: heavier first, ties in order of creation."""
    if heap[a].weight != heap[b].weight:
        return heap[a].weight > heap[b].weight
    return heap[a].number < heap[b].number


@inlined
def heap_push(heap: Rows[OpenRow], size: int, weight: float, number: int, parent: int, refracted: bool) -> None:
    """Push a ray onto a heap of `size` entries."""
    k = size
    heap[k].weight, heap[k].number, heap[k].parent, heap[k].refracted = weight, number, parent, refracted
    while k > 0 and precedes(heap, k, (k - 1) // 2):
        heap_swap(heap, k, (k - 1) // 2)
        k = (k - 1) // 2


@inlined
def heap_pop(heap: Rows[OpenRow], size: int) -> None:
    """Remove the first entry; `size` entries are left."""
    heap_swap(heap, 0, size)
    k = 0
    while 2 * k + 1 < size:
        below = 2 * k + 1
        if below + 1 < size and precedes(heap, below + 1, below):
            below += 1
        if not precedes(heap, below, k):
            return
        heap_swap(heap, below, k)
        k = below


@inlined
def heap_swap(heap: Rows[OpenRow], a: int, b: int) -> None:
    """Exchange two entries."""
    weight, number, parent, refracted = heap[a].weight, heap[a].number, heap[a].parent, heap[a].refracted
    heap[a].weight, heap[a].number = heap[b].weight, heap[b].number
    heap[a].parent, heap[a].refracted = heap[b].parent, heap[b].refracted
    heap[b].weight, heap[b].number, heap[b].parent, heap[b].refracted = weight, number, parent, refracted
