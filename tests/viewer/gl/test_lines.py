"""Rays as arrays of lines: they are the lines that the rows of the tree define, one by one."""

import math

import numpy as np
import pytest

import tracer
from tests.conftest import EACH_LESSON
from tracer.kernel.nodes import BLOCKED, KINDS, SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame
from viewer.base.theme import DARK, DIMMED, ESCAPE, LIGHT, QUIET, QUIET_WIDTH, STYLES, Arrow
from viewer.figures.lights import MOST_LIGHTS, pointed_lights, ray_dash
from viewer.figures.ray_lines import drawn_rows, nearest_row, ray_lines, relatives
from viewer.gl.stage_lines import normal_lines, style_rays
from viewer.lessons import lesson


def trees(name: str, worlds: dict[str, tracer.World]) -> list[RayTree]:
    x, y = lesson.read(name).first.state.pixel or (0, 0)
    return [tracer.trace(worlds[name], (x + dx, y), depth=6) for dx in (-40, 0, 35)]


def line_end(tree: RayTree, i: int, frame: Frame) -> np.ndarray:
    """The hit, or where the line of a ray that hits nothing ends: a third of its way out of the scene, and a bit."""
    row = tree.nodes[i]
    if np.isfinite(row["point"]).all():
        return frame.inside(row["point"])
    start, d = frame.inside(row["origin"]), row["direction"]
    b = float(start @ d)
    root = b * b - (float(start @ start) - 1.0)
    leaving = max(0.0, -b + math.sqrt(root)) if root > 0.0 else 0.0
    return start + (0.35 * leaving + ESCAPE) * d


@pytest.mark.parametrize("name", EACH_LESSON)
def test_lines_are_those_of_the_rows(name: str, worlds: dict[str, tracer.World]) -> None:
    frame = Frame.of(worlds[name])
    for tree in trees(name, worlds):
        for kinds in (frozenset(KINDS), frozenset(("camera", "shadow")), frozenset()):
            lines = ray_lines(tree, drawn_rows(tree), frame, kinds)
            nodes = tree.nodes
            assert [line.row for line in lines] == [
                i
                for i in range(len(tree))
                if tree.kind(i) in kinds and not (tree.kind(i) == "shadow" and nodes["t"][i] == 0)
            ]
            for line in lines:
                i = line.row
                assert line.kind == tree.kind(i)
                assert line.dash == ray_dash(tree, i)
                assert line.start == pytest.approx(frame.inside(nodes["origin"][i]), abs=1e-12)
                assert line.end == pytest.approx(line_end(tree, i, frame), rel=1e-12, abs=1e-12)
                assert line.escapes == np.isnan(nodes["point"][i]).any()
                stopped = nodes["kind"][i] == SHADOW and nodes["end"][i] == BLOCKED
                assert line.blocked == (stopped and not tree.faces_away(i))


@pytest.mark.parametrize("name", EACH_LESSON)
def test_styles_are_those_of_the_kinds(name: str, worlds: dict[str, tracer.World]) -> None:
    """Colour, width, dash and arrow of each ray. Shadow rays are quiet unless they or their hit are selected, or their
    hit is the only one; then they have arrows.
    """
    frame = Frame.of(worlds[name])
    for tree, theme in zip(trees(name, worlds), (DARK, LIGHT, DARK), strict=True):
        rows = drawn_rows(tree)
        lines = ray_lines(tree, rows, frame, frozenset(KINDS))
        shadows = int((tree.nodes["kind"] == SHADOW).sum())
        is_lone = len(tree) - shadows == 1 and shadows <= MOST_LIGHTS and tree.end(0) == "surface"
        for selected in (None, *range(0, len(tree), max(1, len(tree) // 8))):
            kept = None if selected is None else relatives(tree, selected, rows)
            loud, quiet = style_rays(tree, lines, kept, selected, theme)
            assert len(loud) + len(quiet) == len(lines)
            found = {(*row["from"], *row["to"]): (row, k) for k, part in enumerate((loud, quiet)) for row in part}
            for line in lines:
                ends = (*line.start.astype(np.float32), *line.end.astype(np.float32))
                row, is_quiet = found[ends]
                same = [
                    other for other in lines if (*other.start.astype(np.float32), *other.end.astype(np.float32)) == ends
                ]
                if len(same) > 1:
                    continue  # rays on one line
                style, meant = STYLES[line.kind], selected in (line.row, int(tree.nodes["parent"][line.row]))
                pointed = line.kind == "shadow" and (is_lone or (selected is not None and meant))
                assert is_quiet == (line.kind == "shadow" and not pointed)
                shine = (QUIET if is_quiet else 1.0) * (1.0 if kept is None or line.row in kept else DIMMED)
                assert row["tint"] == pytest.approx((*theme.ray(line.kind)[:3], shine), abs=1e-6)
                wide = style.width * (QUIET_WIDTH if is_quiet else 1.0) + (2.0 if line.row == selected else 0.0)
                assert row["width"] == pytest.approx(wide)
                assert tuple(row["dash"]) == pytest.approx(line.dash)
                arrow = Arrow.FILLED if pointed else style.arrow
                assert (row["arrow"], row["fading"]) == (arrow.value, line.escapes)
            if selected is not None and tree.nodes["kind"][selected] != SHADOW:
                start = frame.inside(tree.nodes["origin"][selected])
                assert loud[-1]["from"] == pytest.approx(start, rel=1e-6, abs=1e-6)


def test_a_lone_hit_points_at_its_lights_only_if_no_depth_adds_rays(worlds: dict[str, tracer.World]) -> None:
    """So that its shadow rays do not change while a depth is revealed."""
    mirror = tracer.trace(worlds["mirror-balls"], (370, 272), depth=0)
    table = tracer.prepare(tracer.load(lesson.read("shadow-rays").scene))
    matte = tracer.trace(table, (400, 300), depth=0)
    assert pointed_lights(mirror, None) == frozenset() and pointed_lights(matte, None) == {1, 2}
    assert pointed_lights(mirror, 0) == {1, 2} and pointed_lights(mirror, 2) == {2}


def test_normals_stand_on_every_hit(worlds: dict[str, tracer.World]) -> None:
    frame = Frame.of(worlds["glass-ball"])
    for tree in trees("glass-ball", worlds):
        rows = drawn_rows(tree)
        hits = [i for i in rows if tree.kind(i) != "shadow" and tree.object_name(i)]
        lines = normal_lines(tree, rows, frame, None, DARK)
        assert len(lines) == len(hits) > 0
        for line, i in zip(lines, hits, strict=True):
            assert line["from"] == pytest.approx(frame.inside(tree.nodes["point"][i]), abs=1e-5)
            along = (line["to"] - line["from"]) @ tree.nodes["normal"][i]
            assert along == pytest.approx(np.linalg.norm(line["to"] - line["from"]), rel=1e-5)


def test_the_nearest_line_is_found_and_of_several_the_one_in_front(worlds: dict[str, tracer.World]) -> None:
    tree = trees("glass-ball", worlds)[1]
    lines = ray_lines(tree, drawn_rows(tree), Frame.of(worlds["glass-ball"]), frozenset(KINDS))
    count = len(lines)
    places = np.full((count, 2, 2), 1e4)
    depths = np.ones((count, 2))
    places[3], places[5], places[7] = [(0, 0), (100, 0)], [(0, 2), (100, 2)], [(50, -50), (50, 50)]
    depths[3], depths[5], depths[7] = 2.0, 1.0, -1.0
    assert nearest_row(lines, places, depths, (50, 1.2), 9.0) == lines.rows[5]
    assert nearest_row(lines, places, depths, (50, -4.0), 9.0) == lines.rows[3]
    assert nearest_row(lines, places, depths, (110, 12.0), 9.0) is None
    assert nearest_row(lines, places, depths, (50, 40.0), 9.0) is None  # line 7 is behind the camera
