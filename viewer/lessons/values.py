"""The numbers of rays that a lesson's text may name, `{theta1}` or `{TR.theta1}`, and that a step may expect.

A name alone is about the step's `hit`. A name after a path and a dot is about the hit of another ray.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from tracer.formulas import optics
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.wording import format_angle, format_color, format_number, format_weight
from viewer.explain.fate import ray_fate
from viewer.explain.formulas import Lecture
from viewer.explain.intersection import barycentric, flattened, format_share, hit_face
from viewer.explain.plain_formula import plain
from viewer.explain.scattering import direction_error, local_error

ABSENT = format_number(math.nan)
RIGHT_ANGLE, SHARE = (0.0, 90.0), (0.0, 1.0)  # limits of values


@dataclass(frozen=True)
class Quantity:
    """A number of a row: its value, in degrees for an angle, and how it is written."""

    value: Callable[[RayTree, int], float]
    written: Callable[[RayTree, int], str]
    limits: tuple[float, float] = (0.0, math.inf)  # the smallest and the largest value that a hit can have
    formula: str = ""  # the lecture's symbol for it, if there is one
    unit: str = ""

    @property
    def symbol(self) -> str:
        """The lecture's symbol as plain text."""
        return plain(self.formula)


def _field(name: str, limits: tuple[float, float] = (0.0, math.inf), formula: str = "") -> Quantity:
    """A number of the table of rays."""
    return Quantity(
        lambda tree, i: float(tree.nodes[name][i]), lambda tree, i: format_number(tree.nodes[name][i]), limits, formula
    )


def _angle(name: str, formula: str) -> Quantity:
    return Quantity(
        lambda tree, i: math.degrees(float(tree.nodes[name][i])),
        lambda tree, i: format_angle(float(tree.nodes[name][i]), direction_error(tree, i)),
        RIGHT_ANGLE, formula, "°",
    )  # fmt: skip


def _computed(
    value: Callable[[RayTree, int], float], limits: tuple[float, float] = (0.0, math.inf), formula: str = ""
) -> Quantity:
    return Quantity(value, lambda tree, i: format_number(value(tree, i)), limits, formula)


def _reflectance(tree: RayTree, i: int) -> float:
    """The share of unpolarised light that is reflected, by Fresnel's formulas; NaN at an opaque surface."""
    row = tree.nodes[i]
    if math.isnan(row["radicand"]):
        return math.nan
    return optics.fresnel(math.cos(float(row["theta1"])), float(row["n1"]), float(row["n2"]))[0]


def _critical(tree: RayTree, i: int) -> float:
    """The critical angle in degrees; NaN where there is none."""
    row = tree.nodes[i]
    found = None if math.isnan(row["radicand"]) else optics.critical_angle(float(row["n1"]), float(row["n2"]))
    return math.nan if found is None else math.degrees(found)


def _share(k: int, formula: str) -> Quantity:
    """A barycentric coordinate of a hit on a triangle; NaN on other shapes."""

    def value(tree: RayTree, i: int) -> float:
        corners = hit_face(tree, i)
        return (
            barycentric(corners, tree.nodes["point"][i])[k] if corners is not None and len(corners) == 3 else math.nan
        )

    return Quantity(value, lambda tree, i: format_share(value(tree, i)), SHARE, formula)


def _crossings(tree: RayTree, i: int) -> float:
    """How many sides a ray to the side crosses from a hit on a polygon; NaN on other shapes."""
    corners = hit_face(tree, i)
    return math.nan if corners is None else float(len(flattened(corners, tree.nodes["point"][i]).crossings()))


def _channel(name: str, k: int) -> Quantity:
    return Quantity(
        lambda tree, i: float(tree.nodes[name][i][k]), lambda tree, i: format_number(float(tree.nodes[name][i][k]), 4)
    )


QUANTITIES: dict[str, Quantity] = {
    "theta1": _angle("theta1", Lecture.THETA_1),
    "theta2": _angle("theta2", Lecture.THETA_2),
    "critical": Quantity(
        _critical, lambda tree, i: format_angle(math.radians(_critical(tree, i))), RIGHT_ANGLE, Lecture.THETA_C, "°"
    ),
    "n1": _field("n1", formula=Lecture.INDEX_1),
    "n2": _field("n2", formula=Lecture.INDEX_2),
    "eta": _computed(lambda tree, i: float(tree.nodes["n1"][i]) / float(tree.nodes["n2"][i]), formula=Lecture.ETA),
    "radicand": _field("radicand", (-math.inf, 1.0), Lecture.RADICAND),
    "reflectance": _computed(_reflectance, SHARE),
    "transmittance": _computed(lambda tree, i: 1.0 - _reflectance(tree, i), SHARE),
    "weight": Quantity(
        lambda tree, i: float(max(tree.nodes["weight"][i])),
        lambda tree, i: format_weight(tree.nodes["weight"][i], float(tree.nodes["weight_error"][i])),
    ),
    "factor": Quantity(
        lambda tree, i: float(max(tree.nodes["factor"][i])),
        lambda tree, i: format_weight(tree.nodes["factor"][i], float(tree.nodes["factor_error"][i])),
    ),
    "t": _field("t"),
    "alpha": _share(0, Lecture.ALPHA),
    "beta": _share(1, Lecture.BETA),
    "gamma": _share(2, Lecture.GAMMA),
    "crossings": _computed(_crossings),
    "red": _channel("radiance", 0),
    "green": _channel("radiance", 1),
    "blue": _channel("radiance", 2),
}
WORDS: dict[str, Callable[[RayTree, int], str]] = {
    "object": lambda tree, i: tree.object_name(i) or ABSENT,
    "label": lambda tree, i: tree.label(i),
    "fate": ray_fate,
    "colour": lambda tree, i: format_color(tree.nodes["radiance"][i], float(tree.nodes["radiance_error"][i])),
    "local": lambda tree, i: format_color(tree.nodes["local"][i], local_error(tree, i)),
}
NAMES = (*QUANTITIES, *WORDS)
OF_TREE = ("rays", "depth")  # that are about the whole tree


def split_name(name: str) -> tuple[str | None, str]:
    """(path of the ray, or None for that of the step, name of the quantity)."""
    path, dot, quantity = name.rpartition(".")
    return (path, quantity) if dot else (None, name)


def row_named(tree: RayTree, path: str | None, hit: str | None) -> int | None:
    """The row of a named ray; without a path of the step's `hit`, or the camera ray; None if the tree has none."""
    wanted = path or hit
    return tree.find(wanted) if wanted else 0


def value_text(tree: RayTree | None, hit: str | None, name: str) -> str | None:
    """The text of a `{name}`; a dash where the tree has no such ray or number; None for a name that is not known."""
    path, quantity = split_name(name)
    if quantity not in (*NAMES, *OF_TREE):
        return None
    if tree is None:
        return ABSENT
    if quantity == "rays":
        return str(int((tree.nodes["kind"] != SHADOW).sum()))
    if quantity == "depth":
        return str(tree.depth)
    row = row_named(tree, path, hit)
    if row is None:
        return ABSENT
    return QUANTITIES[quantity].written(tree, row) if quantity in QUANTITIES else WORDS[quantity](tree, row)
