"""The numbers that decide what happens at both ends of a ray: indices, angles, critical angle, radicand."""

import math
from typing import NamedTuple

from tracer.formulas import optics
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_angle, format_number
from viewer.explain.formulas import Lecture
from viewer.explain.scattering import direction_error

ABSENT = format_number(math.nan)


class Interface(NamedTuple):
    """A surface that the ray leaves or meets. A dash stands for what does not exist there."""

    title: str
    formula: str  # of the ray that leaves there, or of those that are sent out; empty if there is none
    n1: str
    n2: str
    theta1: str
    theta2: str
    critical: str  # angle; only towards a medium of smaller index
    dot: str  # n·v
    radicand: str  # 1 − n²(1 − c₁²), at a transparent surface; negative for total internal reflection

    @property
    def is_clear(self) -> bool:
        """Whether light can pass the surface."""
        return self.radicand != ABSENT


def interfaces(tree: RayTree, i: int) -> list[Interface]:
    """The surfaces at the start and at the end of ray i, as far as there are any; none for a shadow ray."""
    row = tree.nodes[i]
    if row["kind"] == SHADOW:
        return []
    found, parent = [], int(row["parent"])
    if parent >= 0:
        formula = Lecture.SNELL if tree.kind(i) == "refraction" else Lecture.REFLECTION
        title = f"How it came to be, at {tree.label(parent)}'s hit"
        found.append(_interface(tree, parent, title, formula))
    if tree.object_name(i):
        clear = not math.isnan(row["radicand"])
        mirrors = tree.scene.objects[row["object"]].material.reflect > 0.0
        formula = Lecture.SNELL if clear else Lecture.REFLECTION if mirrors else ""
        found.append(_interface(tree, i, f"What it meets: {tree.object_name(i)}", formula))
    return found


def _interface(tree: RayTree, hit: int, title: str, formula: str) -> Interface:
    row = tree.nodes[hit]
    turn = direction_error(tree, hit)
    critical = None if math.isnan(row["radicand"]) else optics.critical_angle(float(row["n1"]), float(row["n2"]))
    return Interface(
        title,
        formula,
        format_number(row["n1"]),
        format_number(row["n2"]),
        format_angle(row["theta1"], turn),
        format_angle(row["theta2"], turn),
        format_angle(math.nan if critical is None else critical),
        format_number(-math.cos(float(row["theta1"])), error=turn),
        _steady(float(row["radicand"])),
    )


def _steady(x: float) -> str:
    """A number with five decimals, also where the last ones are 0, so that it keeps its width while it changes."""
    return f"{x:.5f}".replace("-", "−") if 1e-4 <= abs(x) < 1e3 else format_number(x)
