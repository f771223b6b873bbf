"""The sum at a hit, with the digits that its rounding errors leave."""

from dataclasses import replace

import numpy as np
import pytest

import tracer
from tracer.tree.raytree import RayTree
from viewer.base.srgb import LUMINANCE
from viewer.explain.sums import sum_terms


@pytest.fixture
def tree(worlds: dict[str, tracer.World]) -> RayTree:
    return tracer.trace(worlds["glass-ball"], (248, 180), depth=3)


def names(tree: RayTree, i: int) -> list[str]:
    return [term.name for term in sum_terms(tree, i)]


def shown(tree: RayTree, decimals: int) -> list[str]:
    """The colours of the camera ray's sum, from the table."""
    nodes = tree.nodes
    colors = [nodes["local"][0], *nodes["radiance"][[3, 4, 0]]]
    return [f"({' '.join(f'{x:.{decimals}f}' for x in rgb)})" for rgb in colors]


def test_the_terms_are_local_light_and_the_children_in_their_order(tree: RayTree) -> None:
    assert names(tree, 0) == ["local", "+ R1: 0.044 ×", "+ T2: 0.956 ×", "= E"]
    assert names(tree, 3) == ["R1 = background"] and names(tree, 8) == ["T4 = local"]
    assert [term.row for term in sum_terms(tree, 0)] == [None, 3, 4, 0]
    assert [term.value for term in sum_terms(tree, 0)] == shown(tree, 3)


def test_luminances_are_those_of_the_colours(tree: RayTree) -> None:
    values = [float(term.value) for term in sum_terms(tree, 0, luminance=True)]
    nodes = tree.nodes
    exact = [rgb @ LUMINANCE for rgb in (nodes["local"][0], *nodes["radiance"][[3, 4, 0]])]
    assert np.abs(np.subtract(values, exact)).max() <= 0.5e-3


def test_no_number_has_a_digit_that_rounding_leaves_uncertain(tree: RayTree) -> None:
    nodes = tree.nodes.copy()
    nodes["radiance_error"], nodes["factor_error"] = 0.02, 0.01
    doubtful = replace(tree, nodes=nodes)
    assert [term.value for term in sum_terms(doubtful, 0)][1:] == shown(tree, 1)[1:]
    assert names(doubtful, 0)[1:3] == ["+ R1: no digit left ×", "+ T2: 1 ×"]  # 0.04404 and 0.956, both to within 0.01
    nodes["radiance_error"] = 2.0
    assert sum_terms(doubtful, 0)[-1].value == "no digit left"


def test_a_factor_that_differs_from_channel_to_channel_has_three_numbers(tree: RayTree) -> None:
    nodes = tree.nodes.copy()
    nodes["factor"][3] = (0.1, 0.2, 0.3)
    assert names(replace(tree, nodes=nodes), 0)[1] == "+ R1: (0.100 0.200 0.300) ×"
