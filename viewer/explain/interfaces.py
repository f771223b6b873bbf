"""The numbers that decide what happens at both ends of a ray: angles, critical angle, radicand."""

import math
from typing import NamedTuple

from tracer.formulas import optics
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_angle, format_number
from viewer.explain.scattering import direction_error

HEADINGS = ("", "θ₁", "θc", "radicand", "θ₂")


class Interface(NamedTuple):
    """A row of the table, with a dash for what does not exist there."""

    place: str  # "start" or "end"
    theta1: str
    critical: str  # angle; only towards a medium of smaller index
    radicand: str  # 1 − η²(1 − c₁²), at a transparent surface; negative for total internal reflection
    theta2: str


def interfaces(tree: RayTree, i: int) -> list[Interface]:
    """The surfaces at the start and at the end of ray i, as far as there are any; none for a shadow ray."""
    row = tree.nodes[i]
    if row["kind"] == SHADOW:
        return []
    ends = [("start", int(row["parent"])), ("end", i)]
    return [_interface(tree, hit, place) for place, hit in ends if hit >= 0 and tree.object_name(hit)]


def _interface(tree: RayTree, hit: int, place: str) -> Interface:
    row = tree.nodes[hit]
    turn = direction_error(tree, hit)
    critical = None if math.isnan(row["radicand"]) else optics.critical_angle(float(row["n1"]), float(row["n2"]))
    return Interface(
        place,
        format_angle(row["theta1"], turn),
        format_angle(math.nan if critical is None else critical),
        _steady(float(row["radicand"])),
        format_angle(row["theta2"], turn),
    )


def _steady(x: float) -> str:
    """A number with five decimals, also where the last ones are 0, so that it keeps its width while it changes."""
    return f"{x:.5f}".replace("-", "−") if 1e-4 <= abs(x) < 1e3 else format_number(x)
