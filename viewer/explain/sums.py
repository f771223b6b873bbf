"""The radiance of a hit as a sum: its local light, and each child's radiance times its factor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracer.kernel.nodes import SHADOW
from tracer.tree.digits import color_decimals
from tracer.tree.raytree import RayTree
from viewer.base.srgb import LUMINANCE
from viewer.base.wording import NO_DIGITS, format_number, format_rgb
from viewer.explain.scattering import local_error

DECIMALS = 3  # of colours: what changes a pixel on the screen, and short enough for a figure


@dataclass(frozen=True)
class Term:
    """A line of the sum: `+ 0.918 × T4 (0.541 0.489 0.402)`."""

    name: str
    value: str
    row: int | None = None  # the ray whose radiance this is: a child, or on the last line the hit itself


def sum_terms(tree: RayTree, i: int, luminance: bool = False) -> list[Term]:
    """The sum of hit i, line by line, with colours (linear r g b), or with the `luminance` of each (Rec. 709).

    A sum of one term has one line. No number has digits that its rounding error makes uncertain.
    """
    row = tree.nodes[i]
    total = _value(row["radiance"], row["radiance_error"], luminance)
    rays = [child for child in tree.children[i] if tree.nodes["kind"][child] != SHADOW]
    if not rays:
        return [Term(f"{tree.label(i)} = {'background' if tree.end(i) == 'background' else 'local'}", total, i)]
    found = [Term("local", _value(row["local"], local_error(tree, i), luminance))]
    for child in rays:
        below = tree.nodes[child]
        factor = _factor(below["factor"], below["factor_error"], luminance)
        brought = _value(below["radiance"], below["radiance_error"], luminance)
        found.append(Term(f"+ {tree.label(child)}: {factor} ×", brought, child))
    return [*found, Term(f"= {tree.label(i)}", total, i)]


def _factor(factor: np.ndarray, error: float, luminance: bool) -> str:
    """A factor with three digits; all components if they differ."""
    if luminance or factor[0] == factor[1] == factor[2]:
        return format_number(float(factor @ LUMINANCE if luminance else factor[0]), 3, error)
    return _value(factor, error, False)


def _value(rgb: Sequence[float] | np.ndarray, error: float, luminance: bool) -> str:
    decimals = min(DECIMALS, color_decimals(error))
    if decimals < 0:
        return NO_DIGITS
    if luminance:
        return f"{float(np.asarray(rgb) @ LUMINANCE):.{decimals}f}"
    return f"({format_rgb(rgb, decimals, gap=' ')})"
