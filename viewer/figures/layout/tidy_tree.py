"""Positions of the nodes of a ray tree: the tidy tree of Reingold & Tilford, IEEE Trans. Softw. Eng. 7(2), 1981.

Reflected rays go to the left of their hit, refracted ones to the right, and the hit is centred above them. Between
them, half a level down, are short stubs to the lights, as in Whitted's figure. Nodes of one level have a minimum
distance, and equal subtrees look the same.
"""

from dataclasses import dataclass

from viewer.figures.layout.planned_rays import PlannedRays


@dataclass(frozen=True)
class Spacing:
    """The room that a node and its stubs take, in node widths."""

    left: float  # from a node's middle
    right: float
    stub_gap: float  # between two stubs
    stub_half: float
    lean: float = 0.5  # sideways offset of an only child
    sides: bool = False  # rays leave at a node's sides instead of its middle, and its stubs are as wide as itself
    passes: float = 0.5  # length of its stubs in levels: down to there, edges of neighbours must stay outside them
    crowded: bool = False  # its stubs reach so far down that they must stay away from nodes of the next level
    bars: bool = False  # whether total internal reflection has a stub for the refracted ray that does not exist


@dataclass(frozen=True)
class Place:
    """The position of a node: x in node widths, y in levels. A stub to a light is half a level below its hit."""

    x: float
    y: float


@dataclass(frozen=True)
class Layout:
    places: dict[int, Place]
    bars: dict[int, Place]  # ends of the stubs that stand for the missing ray on total internal reflection


@dataclass
class _Subtree:
    """Positions relative to its root, and its extent left and right at each half level below the root."""

    offsets: dict[int, float]
    bars: dict[int, float]
    left: list[float]
    right: list[float]


def tidy_layout(rays: PlannedRays, rows: set[int], room: Spacing) -> Layout:
    """Positions of these rows, the root at x = 0. With each row, its parent must be among them."""
    subtrees: dict[int, _Subtree] = {}
    for i in sorted(rows, reverse=True):
        if not rays.is_shadow[i]:
            subtrees[i] = _join(rays, i, rows, subtrees, room)
    depths = rays.depths
    return Layout(
        {i: Place(x, depths[i] + 0.5 * rays.is_shadow[i]) for i, x in subtrees[0].offsets.items()},
        {i: Place(x, depths[i] + 0.5) for i, x in subtrees[0].bars.items()},
    )


def _join(rays: PlannedRays, i: int, rows: set[int], subtrees: dict[int, _Subtree], room: Spacing) -> _Subtree:
    """The subtree of row i, made of those of its children, which are removed from `subtrees`."""
    stubs = [child for child in rays.shadow_rays.get(i, ()) if child in rows]
    children = [child for child in rays.rays.get(i, ()) if child in rows]
    reflected = [child for child in children if not rays.is_refracted[child]]
    refracted = [child for child in children if rays.is_refracted[child]]
    children = [*reflected, *refracted]
    barred = room.bars and any(rays.is_tir[child] for child in reflected)
    count = len(stubs) + barred
    shifts = _apart([subtrees[child] for child in children])
    if reflected and refracted:
        middle = 0.5 * (shifts[0] + shifts[-1])
    elif children:
        middle = shifts[-1] + room.lean if reflected else shifts[0] - room.lean
    else:
        middle = 0.0
    shifts = [shift - middle for shift in shifts]
    offsets, bars = {i: 0.0}, {}
    left, right = ([-room.left] * 2, [room.right] * 2) if room.sides else ([-room.left, 0.0], [room.right, 0.0])
    places = [room.stub_gap * (k - 0.5 * (count - 1)) for k in range(count)]  # in the middle, below the hit
    for x in places:
        left[1], right[1] = min(left[1], x - room.stub_half), max(right[1], x + room.stub_half)
    if barred:
        bars[i] = places.pop()  # in the place of the refracted ray, on the right
    offsets |= dict(zip(stubs, places, strict=True))
    for child, shift in zip(children, shifts, strict=True):
        sub = subtrees.pop(child)
        offsets |= {row: x + shift for row, x in sub.offsets.items()}
        bars |= {row: x + shift for row, x in sub.bars.items()}
        passed = room.passes * shift
        if room.crowded:
            passed = shift + (-room.left if shift < 0.0 else room.right)
        elif room.sides:
            passed += (1.0 - room.passes) * (-room.left if shift < 0.0 else room.right)
        left[1], right[1] = min(left[1], passed), max(right[1], passed)
        for level, (low, high) in enumerate(zip(sub.left, sub.right, strict=True), start=2):
            if level == len(left):
                left.append(low + shift)
                right.append(high + shift)
            left[level], right[level] = min(left[level], low + shift), max(right[level], high + shift)
    return _Subtree(offsets, bars, left, right)


def _apart(subtrees: list[_Subtree]) -> list[float]:
    """Shifts that put subtrees side by side, each as far left as the contours of those before it allow."""
    shifts: list[float] = []
    edge: list[float] = []
    for sub in subtrees:
        shift = max((edge[level] - reach for level, reach in enumerate(sub.left[: len(edge)])), default=0.0)
        shifts.append(shift)
        for level, reach in enumerate(sub.right):
            if level == len(edge):
                edge.append(reach + shift)
            edge[level] = max(edge[level], reach + shift)
    return shifts
