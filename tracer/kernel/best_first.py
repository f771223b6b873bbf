"""A tree to a tolerance: the heaviest ray first, until what is left weighs too little in sum.

Glass plates double the tree at every face while the weights hardly decay: a limit to the depth or to the weight of a
single ray cuts off no one knows how much. Here the open rays wait in a heap. Their weights' sum bounds what is missing
at any moment, and following the heaviest lowers it fastest. Tracing can stop anywhere: the tree is the best so far.

The heap is a binary one (Williams, CACM 7(6), 1964). An open ray takes little room: where it is followed, its parent is
asked again what it sends out.
"""

from typing import Any

import numpy as np

from tracer.compile.jit import compiled, inlined
from tracer.formulas.double_double import dd_add
from tracer.formulas.vector import max_component, vector
from tracer.kernel.limits import Limits
from tracer.kernel.nodes import NODES, NONE, SURFACE, TOLERANCE
from tracer.kernel.scatter import cut_reason, scatter, start_child
from tracer.kernel.trace import accumulate_radiance, direct_light, trace_ray

OPEN_RAY = np.dtype(
    [
        ("weight", np.float64),  # its largest component
        ("number", np.int64),  # of equal ones the first to be created is followed first
        ("parent", np.int64),
        ("refracted", np.bool_),
    ],
    align=True,
)


@compiled
def trace_best_first(world: Any, limits: Limits, space: Any) -> int:
    """Rows of the tree whose camera ray stands in row 0, in the order of tracing, each with its shadow rays behind it;
    -1 where the table is too short for it."""
    table, heap = space.table, space.open
    lights = len(world.lights)
    i, count, waiting, created = 0, 1, 0, 0
    planned = 1 + lights  # rows spoken for, whether an image needs them or not: it is to end where the tree does
    left = (0.0, 0.0)  # sum of the weights of what is open or cut
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
def precedes(heap: Any, a: int, b: int) -> bool:
    if heap[a].weight != heap[b].weight:
        return heap[a].weight > heap[b].weight
    return heap[a].number < heap[b].number


@inlined
def heap_push(heap: Any, size: int, weight: float, number: int, parent: int, refracted: bool) -> None:
    """A ray more in a heap of this size."""
    k = size
    heap[k].weight, heap[k].number, heap[k].parent, heap[k].refracted = weight, number, parent, refracted
    while k > 0 and precedes(heap, k, (k - 1) // 2):
        heap_swap(heap, k, (k - 1) // 2)
        k = (k - 1) // 2


@inlined
def heap_pop(heap: Any, size: int) -> None:
    """The first out of the heap, of which this many are left."""
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
def heap_swap(heap: Any, a: int, b: int) -> None:
    weight, number, parent, refracted = heap[a].weight, heap[a].number, heap[a].parent, heap[a].refracted
    heap[a].weight, heap[a].number = heap[b].weight, heap[b].number
    heap[a].parent, heap[a].refracted = heap[b].parent, heap[b].refracted
    heap[b].weight, heap[b].number, heap[b].parent, heap[b].refracted = weight, number, parent, refracted
