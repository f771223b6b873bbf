"""The exported tree: JSON, CSV, DOT, text; and the node table itself."""

import csv
import io
import json
import math
import re

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tests.scenes import MIRROR, plane, world_of
from tracer.kernel.nodes import ENDS, KINDS
from tracer.tree.text import END_REASONS, heaviest_rows, tree_text
from viewer.figures.writers.csv import write_csv
from viewer.figures.writers.dot import write_dot

FIELDS = [
    "id", "parent", "kind", "depth", "origin", "direction", "t", "point", "normal", "object", "light", "n1", "n2",
    "theta1", "theta2", "factor", "weight", "radicand", "local", "radiance", "end", "error", "turn",
    "factor_error", "weight_error", "radiance_error", "path", "label", "light_path", "margin", "decision",
]  # fmt: skip


@pytest.fixture(params=EACH_LESSON)
def tree(request: pytest.FixtureRequest, worlds: dict[str, tracer.World]) -> tracer.RayTree:
    return tracer.trace(worlds[request.param], (380, 310), depth=3)


def test_json_has_every_field_and_reads_back_to_the_same_bits(tree: tracer.RayTree) -> None:
    document = json.loads(tree.to_json(), parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    assert list(document) == [
        "format",
        "scene",
        "pixel",
        "sample",
        "size",
        "depth",
        "model",
        "radiance",
        "residual",
        "bound",
        "max_nodes",
        "nodes",
    ]
    assert document["format"] == "raytree-tree/1"
    assert (document["pixel"], document["size"]) == ([380, 310], list(tree.size))
    assert document["radiance"] == tree.radiance.tolist()
    assert len(document["nodes"]) == len(tree)
    for i, node in enumerate(document["nodes"]):
        row = tree.nodes[i]
        assert sorted(node) == sorted(FIELDS)
        assert node["id"] == i
        assert node["parent"] == (None if i == 0 else int(row["parent"]))
        assert node["kind"] in KINDS
        assert node["end"] in (None, *ENDS)
        for name in ("origin", "direction", "factor", "weight", "local", "radiance"):
            assert node[name] == row[name].tolist()
        for name in ("t", "n1", "n2", "radicand", "error", "turn", "factor_error", "weight_error", "radiance_error"):
            assert node[name] == (None if math.isnan(row[name]) else row[name])
        for name in ("point", "normal"):
            assert node[name] == (None if np.isnan(row[name]).any() else row[name].tolist())
        for name in ("theta1", "theta2"):
            assert node[name] == (None if math.isnan(row[name]) else math.degrees(row[name]))


def test_table_cannot_be_written_to(tree: tracer.RayTree) -> None:
    with pytest.raises(ValueError, match="read-only"):
        tree.nodes["t"] = 0.0
    assert tree.nodes.dtype.names == tuple(FIELDS[:-5])


def test_hits_lie_where_the_ray_says(tree: tracer.RayTree) -> None:
    """point = origin + t direction, up to the rounding of a hit that was projected onto its surface."""
    nodes = tree.nodes
    hit = np.isfinite(nodes["t"])
    reached = nodes["origin"][hit] + nodes["t"][hit, None] * nodes["direction"][hit]
    scale = np.abs(nodes["origin"][hit]).sum(axis=1) + nodes["t"][hit]
    assert (np.abs(reached - nodes["point"][hit]).max(axis=1) <= 32 * 2.0**-53 * scale).all()
    lengths = np.linalg.norm(nodes["direction"], axis=1)
    assert np.abs(lengths - 1.0).max() <= 4 * 2.0**-53


def test_normals_face_the_ray_and_angles_fit_them(tree: tracer.RayTree) -> None:
    nodes = tree.nodes
    for row in nodes[np.isfinite(nodes["normal"][:, 0])]:
        cosine = -float(row["direction"] @ row["normal"])
        assert cosine > 0.0
        assert math.cos(row["theta1"]) == pytest.approx(cosine, abs=1e-14)
        if row["radicand"] > 0.0:
            assert row["n1"] * math.sin(row["theta1"]) == pytest.approx(row["n2"] * math.sin(row["theta2"]), abs=1e-14)
            assert math.cos(row["theta2"]) ** 2 == pytest.approx(row["radicand"], abs=1e-13)


def test_weights_are_products_of_factors(tree: tracer.RayTree) -> None:
    nodes = tree.nodes
    for i in range(1, len(tree)):
        expected = nodes["weight"][nodes["parent"][i]] * nodes["factor"][i]
        assert nodes["weight"][i].tolist() == expected.tolist()


def test_csv_is_the_json_in_columns(tree: tracer.RayTree) -> None:
    rows = list(csv.DictReader(io.StringIO(write_csv(tree))))
    nodes = json.loads(tree.to_json())["nodes"]
    assert len(rows) == len(nodes)
    for row, node in zip(rows, nodes, strict=True):
        assert row["kind"] == node["kind"]
        assert row["object"] == (node["object"] or "")
        assert float(row["origin_x"]) == node["origin"][0]
        assert float(row["radiance_b"]) == node["radiance"][2]
        assert row["t"] == ("" if node["t"] is None else repr(node["t"]))
        assert row["point_y"] == ("" if node["point"] is None else repr(node["point"][1]))


def test_dot_has_a_node_and_an_edge_a_ray(tree: tracer.RayTree) -> None:
    text = write_dot(tree)
    assert text.count(" -> ") == len(tree)
    assert sum(f"  n{i} [label=" in text for i in range(len(tree))) == len(tree)
    assert text.count('"') % 2 == 0
    assert text.startswith("digraph") and text.endswith("}\n")


def test_text_draws_a_line_a_ray_below_its_parent(tree: tracer.RayTree) -> None:
    lines = tree_text(tree).splitlines()[4:]
    assert len(lines) == len(tree)
    order = list(tree.preorder())
    assert sorted(order) == list(range(len(tree)))
    for i, line in zip(order, lines, strict=True):
        name = tree.light_label(i) if tree.kind(i) == "shadow" else tree.label(i)
        assert f"{name} {tree.kind(i)}" in line
        idle = tree.kind(i) == "shadow" and tree.end(i) != "blocked" and not tree.nodes["radiance"][i].any()
        assert ("adds nothing" in line) == (idle or tree.faces_away(i))
        assert "the surface faces away" in line if tree.faces_away(i) else idle or END_REASONS[tree.end(i)] in line
        assert (tree.object_name(i) or "") in line
    assert all(len(line) <= 160 for line in lines)
    for place, i in enumerate(order[1:], start=1):
        assert order.index(int(tree.nodes["parent"][i])) < place


def test_light_paths() -> None:
    """E the eye, S a reflection or transmission, D where a shadow ray starts or an opaque surface ends the path, L the
    light.
    """
    from tests.scenes import MATTE, ball, plane, world_of
    from tracer.scene import Light, Material

    lamp = Light("lamp", position=(0.0, 9.0, 9.0))
    mirror = plane((0, 0, 0), (0, 1, 0), Material("mirror", diffuse=0.5, reflect=0.5), "mirror")
    world = world_of(mirror, ball((0, 3, 0), 1, MATTE), lights=[lamp])
    tree = tracer.trace(world, ray=((0, 3, 6), (0, -1, -1)), depth=1)
    found = {(tree.kind(i), tree.light_path(i)) for i in range(len(tree))}
    assert ("camera", "E") in found
    assert ("shadow", "EDL") in found
    assert {path for kind, path in found if kind == "reflection"} <= {"ES", "ESD"}


def test_text_of_a_very_deep_tree_is_no_wider_for_it() -> None:
    walls = (plane((0, 0, 0), (1, 0, 0), MIRROR, "left"), plane((1, 0, 0), (-1, 0, 0), MIRROR, "right"))
    tree = tracer.trace(world_of(*walls), ray=((0.5, 0, 0), (1, 0.1, 0)), depth=20_000)
    lines = tree.to_text().splitlines()
    assert len(lines) == 20_001 + 4
    assert max(map(len, lines)) < 150
    assert lines[-1].startswith("level 20000: R20000 reflection")
    few = tree.to_text(100).splitlines()
    assert few[2] == "the heaviest 100 of 20001 rays are shown"
    assert [line.split()[:3] for line in few[5:]] == [line.split()[:3] for line in lines[4:104]]


def test_text_shows_the_heaviest_rays_with_their_ancestors(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["plates"], pixel=(400, 300), tolerance=1e-3)
    weights = tree.nodes["weight"].max(axis=1)
    kept = heaviest_rows(tree, 60, set(range(len(tree))))
    rays = [i for i in range(len(tree)) if tree.kind(i) != "shadow"]
    assert min(weights[i] for i in rays if i in kept) >= max(weights[i] for i in rays if i not in kept)
    assert all(int(tree.nodes["parent"][i]) in kept for i in kept - {0})
    shown = [re.search(r"(\S+) (camera|reflection|refraction|tir) ", line) for line in tree.to_text(60).splitlines()]
    assert {found[1] for found in shown if found} == {tree.label(i) for i in kept & set(rays)}
