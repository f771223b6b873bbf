"""The figure of the tree: nothing overlaps, nothing moves from step to step, every ray is drawn or counted."""

import itertools
import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings, strategies as st

import tracer
from tests.conftest import LESSONS
from tests.scenes import MATTE, ball, world_of
from tests.viewer.figures.geometry import check, check_texts
from tests.viewer.figures.random_tree import random_tree
from tests.viewer.figures.test_tidy_tree import plates
from tracer.kernel.nodes import SHADOW
from tracer.scene import Light, Material
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame, initial_orbit
from viewer.base.srgb import LUMINANCE
from viewer.base.theme import DARK, LIGHT, MONO, PANEL_TEXT, Theme
from viewer.explain.ray import headline
from viewer.figures.catalogue import RECURSION
from viewer.figures.figure.tree import planned
from viewer.figures.labels import ray_label
from viewer.figures.layout.folds import percent
from viewer.figures.layout.placing import EYES
from viewer.figures.layout.sizes import SMALLEST, TreeStyle
from viewer.figures.layout.tree_plan import plan_tree
from viewer.figures.lights import FATE, fate_of, many_lights, shadow_rays
from viewer.figures.marks import Box, Disc, Figure, Line, Text
from viewer.figures.pages import pages
from viewer.figures.steps import by_color, by_depth, by_level, by_ray
from viewer.figures.subject import FigureStyle, Subject
from viewer.lessons import lesson


def hits(figure: Figure) -> dict[int, Box]:
    return {int(m.name[4:]): m for m in figure.marks if isinstance(m, Box) and m.name.startswith("hit-")}


def folded(figure: Figure) -> int:
    """The number of rays that the figure says it has folded."""
    return sum(
        int(m[1])
        for t in figure.marks
        if isinstance(t, Text) and (m := re.fullmatch(r"\+(\d+) rays?(, .* %)?", t.content))
    )


def in_lines(figure: Figure, tree: RayTree) -> int:
    """The number of shadow rays for which lines of words, or of signs with numbers, stand. Each stands for all of its
    hit.
    """
    found = 0
    for hit in hits(figure):
        words = [m.content for m in figure.marks if isinstance(m, Text) and m.name == f"lights-{hit}"]
        if words:
            assert sum(int(n) for n in re.findall(r"\d+", " ".join(words))) == len(shadow_rays(tree, hit))
            found += len(shadow_rays(tree, hit))
    return found


def check_whole(figure: Figure, tree: RayTree, size: float = 18.0) -> None:
    """Each ray of the tree is drawn, with its label, or counted in a folded branch or in a line of shadow rays. If
    there is no room for these lines, all are left out.
    """
    check(figure, size)
    drawn = {int(m.name[4:]) for m in figure.marks if m.name.startswith("ray-")}
    lines = in_lines(figure, tree)
    left_out = sum(len(shadow_rays(tree, hit)) for hit in hits(figure)) if not lines and many_lights(tree) else 0
    assert len(drawn) + folded(figure) + lines + left_out == len(tree)
    words = [m.content for m in figure.marks if isinstance(m, Text)]
    shadows = {i for i in drawn if tree.nodes["kind"][i] == SHADOW}
    named = "L" not in words  # otherwise their lights stand in the order of the legend
    compact = not any(isinstance(m, Text) and m.name == f"ray-{i}" for m in figure.marks for i in shadows)
    labelled = drawn - shadows if compact else drawn  # in the boxes of a compact tree, there are only signs
    labels = Counter(ray_label(tree, i) if named or i not in shadows else "L" for i in labelled)
    for label, count in labels.items():  # rays to one light have the same
        assert sum(text == label or text.startswith(f"{label} ") for text in words) == count, label
    assert set(hits(figure)) == {i for i in drawn if tree.nodes["kind"][i] != SHADOW}


@settings(max_examples=150, deadline=None)
@given(
    st.integers(0, 2**32), st.integers(1, 300), st.sampled_from((0, 1, 2, 3, 4, 5, 9, 64)), st.integers(0, 7),
    st.booleans(),
    st.sampled_from((6.0, 9.0, 18.0, 24.0)), st.sampled_from(EYES),
)  # fmt: skip
def test_random_trees(seed: int, most: int, lights: int, depth: int, swatches: bool, size: float, eye: str) -> None:
    """From one ray to five hundred, also unbalanced trees. Small text has room for many rays, large text folds
    branches.
    """
    tree = random_tree(seed, most, lights, depth)
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(swatches=swatches, text_size=size, eye=eye))
    check_whole(figure, tree, size)


@settings(max_examples=100, deadline=None)
@given(
    st.integers(0, 2**32), st.integers(1, 100), st.sampled_from((0, 1, 2, 4, 9)), st.integers(0, 7),
    st.sampled_from(((766, 258), (350, 370), (640, 320), (500, 900), (1280, 640), (300, 260))), st.booleans(),
)  # fmt: skip
@example(108741, 9, 4, 3, (766, 258), False)  # an edge passed through the corner of a fold
def test_random_trees_in_any_panel(
    seed: int, most: int, lights: int, depth: int, page: tuple[int, int], levels: bool
) -> None:
    """As in the window: low and wide, where the signs of shadow rays stand in the boxes, or narrow and high, where the
    tree is an outline.
    """
    tree = random_tree(seed, most, lights, depth)
    size = (float(page[0]), float(page[1]))
    style = FigureStyle(swatches=True, text_size=PANEL_TEXT, levels=levels, page=size)
    (figure,) = pages("tree", Subject(by_depth([tree])), style)
    assert (figure.width, figure.height) == page
    check_whole(figure, tree, SMALLEST)


@pytest.mark.parametrize("depth", (3, 4))
def test_trees_as_deep_as_a_slide_allows(depth: int) -> None:
    """Levels as close as possible, and leaves beside rays that go on."""
    for seed in range(150):
        tree = random_tree(seed, 14, seed % 3, depth)
        for eye in EYES:
            (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(swatches=seed % 2 == 0, eye=eye))
            check_whole(figure, tree)


@pytest.mark.parametrize("lights", (0, 2))
def test_a_tree_of_five_hundred_rays(lights: int) -> None:
    tree = max((random_tree(seed, 500, lights, 9) for seed in range(40)), key=len)
    assert len(tree) >= 500
    for size, eye in itertools.product((4.0, 18.0), EYES):
        (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(text_size=size, eye=eye))
        check_whole(figure, tree, size)


@pytest.mark.parametrize(("theme", "eye"), ((LIGHT, "top"), (DARK, "left"), (MONO, "top")))
def test_trees_of_the_lessons_grow_and_nothing_moves(worlds: dict[str, tracer.World], theme: Theme, eye: str) -> None:
    for name in LESSONS:
        trees = [tracer.trace(worlds[name], lesson.read(name).first.state.pixel, depth=d) for d in range(5)]
        figures = pages("tree", Subject(by_depth(trees)), FigureStyle(theme, swatches=True, eye=eye))
        last = places(figures[-1])
        for figure, tree in zip(figures, trees, strict=True):
            check_whole(figure, tree)
            for what, place in places(figure).items():
                assert last[what] == place, what


def places(figure: Figure) -> dict[tuple, tuple]:
    """Positions of hits, folded branches, rays and their labels."""
    found: dict[tuple, tuple] = {}
    for mark in figure.marks:
        if mark.name.startswith(("hit-", "ray-", "fold-")):
            match mark:
                case Box():
                    found[mark.name, "box"] = (mark.center, mark.size)
                case Line() if mark.leaves:
                    found[mark.name, "line"] = (mark.start, mark.end, mark.hole)
                case Text() if mark.name.startswith("ray-"):
                    found[mark.name, "label"] = (mark.at, mark.content)
    return found


def test_steps_by_ray_and_by_colour_keep_all_places(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], (248, 180), depth=3)
    (whole,) = pages("tree", Subject(by_depth([tree])), FigureStyle(swatches=True))
    for stages in (by_level(tree), by_ray(tree), by_ray(tree, RECURSION), by_color(tree)):
        figures = pages("tree", Subject(stages), FigureStyle(swatches=True))
        for figure in figures:
            check(figure)
            assert places(figure).items() <= places(whole).items()
        assert places(figures[-1]) == places(whole)
        for stage, figure in zip(stages, figures, strict=True):
            marks = figure.marks
            assert {m.name for m in marks if m.name.startswith("ray-")} == {f"ray-{i}" for i in stage.rows}
            known = {m.name for m in marks if isinstance(m, Disc) and m.name.startswith("hit-")}
            assert known == {f"hit-{i}" for i in stage.summed}
            rays = (m for m in marks if isinstance(m, Line) and m.name.startswith("ray-"))
            strong = {m.name for m in rays if m.stroke.width > 1.7 * width_of(m, whole)}
            assert strong == {f"ray-{i}" for i in stage.current}


def width_of(line: Line, figure: Figure) -> float:
    """The width of this ray in another figure."""
    return next(m.stroke.width for m in figure.marks if isinstance(m, Line) and m.name == line.name)


@pytest.mark.parametrize("figure", ("tree", pytest.param("both", marks=pytest.mark.slow)))
def test_the_sum_at_a_hit_has_the_numbers_of_the_table(figure: str, worlds: dict[str, tracer.World]) -> None:
    """Each page that sums up a hit says how: local light, factors, colours of the children, colour."""
    for name in LESSONS:
        found = lesson.read(name)
        tree = tracer.trace(worlds[name], found.first.state.pixel, depth=3)
        orbit = initial_orbit(worlds[name], Frame.of(worlds[name]), None)
        steps = by_color(tree)
        plain = pages(figure, Subject([steps[-1]], worlds[name], orbit), FigureStyle())[0]
        drawn = hits(plain)
        for step, page in zip(steps, pages(figure, Subject(steps, worlds[name], orbit), FigureStyle()), strict=True):
            texts = [m for m in page.marks if isinstance(m, Text) and m.name.startswith("sum-")]
            least = min((m.size for m in texts), default=18.0)
            check(page, least) if figure == "tree" else check_texts(page, least)
            assert bool(texts) == (step.sum in drawn)
            if step.sum in drawn:
                assert {m.name for m in texts} == {f"sum-{step.sum}"}
                check_sum(tree, step.sum, [m.content for m in texts])


def check_sum(tree: RayTree, i: int, words: list[str]) -> None:
    """Compare a sum's numbers with the table's."""
    colors = words[0] != "luminance"
    words = words[0 if colors else 1 :]
    names, values = words[::2], [np.array(word.strip("()").split(), float) for word in words[1::2]]

    def same(shown: np.ndarray, rgb: np.ndarray) -> bool:
        return bool(np.abs(shown - (rgb if colors else rgb @ LUMINANCE)).max() <= 0.5e-3 + 1e-12)

    row, rays = tree.nodes[i], [c for c in tree.children[i] if tree.nodes["kind"][c] != SHADOW]
    assert names[-1].startswith(f"{tree.label(i)} = ") if len(names) == 1 else names[-1] == f"= {tree.label(i)}"
    assert same(values[-1], row["radiance"])
    if rays:
        assert len(names) == 2 + len(rays) and names[0] == "local" and same(values[0], row["local"])
        for child, term, value in zip(rays, names[1:-1], values[1:-1], strict=True):
            label, factor = re.fullmatch(r"\+ (\S+): (\S+) ×", term).groups()  # type: ignore[union-attr]
            assert label == tree.label(child) and same(value, tree.nodes["radiance"][child])
            assert float(factor) == pytest.approx(tree.nodes["factor"][child][0], rel=0.5e-2)


@pytest.mark.parametrize("eye", EYES)
def test_same_subtree_looks_the_same(eye: str) -> None:
    """The subtrees in a pile of plates repeat: boxes and edges of equal ones differ by a translation only."""
    tree = plates(1, 3, 0)
    plan = plan_tree(planned(by_depth([tree])), TreeStyle(18.0, eye=eye))
    kinds = tree.nodes["kind"]

    def form(i: int) -> tuple:
        rays = [c for c in tree.children[i] if kinds[c] != SHADOW]
        return tuple((int(kinds[c]), tree.end(c), form(c)) for c in rays)

    def shape(i: int) -> list[tuple[float, float]]:
        x, y = plan.at[i]
        found = [(0.0, 0.0)]
        for c in tree.children[i]:
            (cx, cy) = plan.at[c]
            found += [(round(cx - x + dx, 6), round(cy - y + dy, 6)) for dx, dy in shape(c)]
        return found

    seen: dict[tuple, list] = {}
    for i in plan.rows:
        assert seen.setdefault(form(i), shape(i)) == shape(i)
    assert len(seen) < len(plan.rows)


def test_light_branches_are_folded_on_wish() -> None:
    """Branches below a given weight are folded, and the fold shows its weight."""
    tree = plates(2, 4, 1)
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(fold=0.1))
    check_whole(figure, tree)
    weights = tree.nodes["weight"].max(axis=1)
    assert all(weights[i] >= 0.1 for i in hits(figure))
    plan = plan_tree(planned(by_depth([tree])), TreeStyle(18.0, fold=0.1))
    for fold in plan.folds.values():
        assert fold.weight == pytest.approx(sum(weights[i] for i in fold.roots), rel=1e-12)


def test_where_rays_go() -> None:
    """Down or to the right, by the same step a level; R on one side, T on the other."""
    tree = random_tree(5, 12, 1, 3)
    nodes = tree.nodes
    for eye, along, across in (("top", 1, 0), ("left", 0, 1)):
        plan = plan_tree(planned(by_depth([tree])), TreeStyle(9.0, eye=eye))
        steps = set()
        for i in plan.rows - {0}:
            if nodes["kind"][i] != SHADOW:
                here, parent = plan.at[i], plan.at[int(nodes["parent"][i])]
                steps.add(round(here[along] - parent[along], 6))
                assert (here[across] > parent[across]) == (tree.kind(i) == "refraction")
        assert len(steps) == 1
        assert min(steps) > 0.0
        assert plan.places.eye[across] == plan.at[0][across]


def test_names_are_whole_where_there_is_room() -> None:
    """A long name is cut only where its box would push rays out of the figure."""
    long = "a name of twenty letter"
    few = renamed(random_tree(1, 1, 1, 0), long)
    many = renamed(max((random_tree(seed, 60, 2, 4) for seed in range(20)), key=len), long)
    assert words_in_boxes(few) == {long}
    (cut,) = {word for word in words_in_boxes(many) if word.startswith("a name")}
    assert cut.endswith("…")
    assert len(cut) <= 14


def renamed(tree: RayTree, name: str) -> RayTree:
    scene = replace(tree.scene, objects=tuple(replace(item, name=name) for item in tree.scene.objects))
    return replace(tree, world=replace(tree.world, scene=scene))


def words_in_boxes(tree: RayTree) -> set[str]:
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle())
    return {m.content for m in figure.marks if isinstance(m, Text) and m.inside.startswith("hit-")}


def test_total_internal_reflection_has_a_stub_with_a_bar(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["underwater"], lesson.read("underwater").first.state.pixel, depth=3)
    assert tree.kind(int(tree.children[0][-1])) == "tir"
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle())
    assert [m.content for m in figure.marks if m.name == "bar-0" and isinstance(m, Text)] == ["no T"]
    assert sum(isinstance(m, Line) for m in figure.marks if m.name == "bar-0") == 2


def test_mono_has_no_colour(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], (248, 180), depth=3)
    for name in ("tree", "hit"):
        (figure,) = pages(name, Subject(by_depth([tree])), FigureStyle(MONO, swatches=True))
        for mark in figure.marks:
            inks = [getattr(mark, "fill", None), getattr(mark, "color", None)]
            stroke = getattr(mark, "stroke", None)
            inks += [stroke.color] if stroke else []
            assert all(ink[0] == ink[1] == ink[2] for ink in inks if ink), mark


def test_shares_are_said_as_people_say_them() -> None:
    said = [percent(share) for share in (1.0, 0.9996, 0.876, 0.1, 0.0312, 0.004)]
    assert said == ["100", "100", "88", "10", "3.1", "0.4"]


def test_the_legend_explains_every_sign_and_hides_nothing(worlds: dict[str, tracer.World]) -> None:
    """Also in the narrow half of two panels, in which it stands below the tree."""
    world = worlds["underwater"]
    tree = tracer.trace(world, lesson.read("underwater").first.state.pixel, depth=3)
    orbit = initial_orbit(world, Frame.of(world), lesson.read("underwater").first.state.view)
    for name in ("tree", "both"):
        (figure,) = pages(name, Subject(by_depth([tree]), world, orbit), FigureStyle())
        words = {mark.content: mark for mark in figure.marks if isinstance(mark, Text)}
        assert {"total internal reflection", "to a light", "faces away"} <= set(words)
        eye = [m for m in figure.marks if m.name == "eye" and isinstance(m, Disc)][-1]
        for mark in figure.marks:
            if mark.name.startswith("legend-") and isinstance(mark, Line):
                for x, y in (mark.start, mark.end):
                    assert abs(x - eye.center[0]) > 18.0 or abs(y - eye.center[1]) > 18.0


ROOM = world_of(
    ball((0.0, 0.0, 0.0), 1.0, Material("glass", transmit=0.9, reflect=0.1, ior=1.5, diffuse=0.1), "ball"),
    ball((0.0, 3.0, 0.7), 0.3, MATTE, "moon"),
    lights=[
        Light("up", position=(0.0, 9.0, 0.1)),  # behind the moon
        Light("front", position=(0.0, 1.0, 9.0)),
        Light("off", position=(1.0, 0.0, 9.0), color=(0.0, 0.0, 0.0)),
        Light("back", position=(0.0, 0.0, -9.0)),
    ],
)
RAY = ((0.0, 0.2, 4.0), (0.0, 0.12, -1.0))  # meets the ball in front, above its middle


def with_lights(count: int) -> tracer.World:
    """The same with this number of lights: the four in turn."""
    lights = tuple(replace(ROOM.scene.lights[k % 4], name=f"lamp {k}") for k in range(count))
    return tracer.prepare(replace(ROOM.scene, lights=lights))


def test_many_lights_are_one_line() -> None:
    """Of five lights, in words: only the parts that occur, with the right number of the verb."""
    for count, words in (
        (5, "L: 2 reach, 1 faces away, 2 blocked"),
        (12, "L: 6 reach, 3 face away, 3 blocked"),
        (64, "L: 32 reach, 16 face away, 16 blocked"),
    ):
        tree = tracer.trace(with_lights(count), ray=RAY, depth=1)
        for name in ("tree", "hit"):
            (figure,) = pages(name, Subject(by_depth([tree]), tree.world), FigureStyle())
            written = [m.content for m in figure.marks if isinstance(m, Text) and m.name == "lights-0"]
            assert " ".join(written) == words and len(written) <= (1 if name == "tree" else 3), (count, name)
            idle = next(m.title for m in figure.marks if m.name == "lights-0")
            assert idle == f"{words}; {count // 4} add{'s' * (count // 4 == 1)} nothing, though nothing blocks " + (
                "it" if count // 4 == 1 else "them"
            )
            assert not {f"ray-{i}" for i in shadow_rays(tree, 0)} & {m.name for m in figure.marks}
    four = tracer.trace(with_lights(4), ray=RAY, depth=1)
    (figure,) = pages("tree", Subject(by_depth([four])), FigureStyle())
    assert {f"ray-{i}" for i in shadow_rays(four, 0)} <= {m.name for m in figure.marks}


@pytest.mark.parametrize("lights", (5, 12, 64))
@pytest.mark.parametrize("eye", EYES)
def test_no_ray_is_folded_for_lights(lights: int, eye: str) -> None:
    """The rays that are drawn are those of the figure without rays to lights."""
    for seed, size in itertools.product(range(12), (12.0, 18.0)):
        tree = random_tree(seed, 40, lights, 3)
        steps = by_depth([tree])
        drawn = [
            set(hits(pages("tree", Subject(shown), FigureStyle(text_size=size, eye=eye))[0]))
            for shown in (steps, by_depth([tree], lights=False))
        ]
        assert len(drawn[0]) >= len(drawn[1])


def test_rays_that_add_nothing_look_otherwise_and_say_so() -> None:
    """Their dash is that of the legend and of no ray that adds light, in every theme; the title is the window's."""
    tree = tracer.trace(ROOM, ray=RAY, depth=2)
    fates = {i: fate_of(tree, i) for hit in (0, *tree.children[0]) for i in shadow_rays(tree, hit)}
    assert {"lit", "filtered", "blocked", "away", "nothing"} == {fate.name for fate in fates.values()}
    for name, theme in itertools.product(("tree", "scene", "both", "hit"), (LIGHT, DARK, MONO)):
        orbit = initial_orbit(ROOM, Frame.of(ROOM), None)
        (figure,) = pages(name, Subject(by_depth([tree]), ROOM, orbit), FigureStyle(theme))
        lines = [m for m in figure.marks if isinstance(m, Line) and m.stroke.dash != (0.0, 0.0)]
        found = set()
        for i, fate in fates.items():
            for line in lines:
                if line.name == f"ray-{i}" and line.title:
                    found.add(fate.name)
                    assert line.stroke.dash == pytest.approx(fate.dash)
                    assert headline(tree, i)[1].split(": ", 1)[1] in line.title
                    assert ("adds nothing" in line.title) == (fate.name in ("away", "nothing"))
        assert {"away", "nothing", "lit"} <= found
        for line in lines:
            if line.name.startswith("legend-") and line.name[7:] in FATE:
                assert line.stroke.dash == pytest.approx(FATE[line.name[7:]].dash)
    dashes = {fate.dash for fate in FATE.values() if fate.name not in ("away", "nothing")}
    assert not dashes & {FATE["away"].dash, FATE["nothing"].dash}


def test_a_ray_of_factor_0_says_so() -> None:
    tree = tracer.trace(ROOM, ray=RAY, depth=1)
    nodes = tree.nodes.copy()
    (i,) = (k for k in range(len(tree)) if tree.kind(k) == "reflection")
    nodes["factor"][i] = nodes["weight"][i] = 0.0
    none = replace(tree, nodes=nodes)
    (figure,) = pages("tree", Subject(by_depth([none])), FigureStyle())
    (line,) = (m for m in figure.marks if isinstance(m, Line) and m.name == f"ray-{i}")
    assert "adds nothing: its factor is 0" in line.title
    assert line.stroke.dash == FATE["nothing"].dash
    assert "adds nothing: its factor is 0" in headline(none, i)[1]


def test_a_step_is_not_dimmed_by_a_selection(worlds: dict[str, tracer.World]) -> None:
    """The hit that a step sums up is as bright as without a selection, also beside the selected branch."""
    tree = tracer.trace(worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel, depth=2)
    selected, other = tree.find("T"), tree.find("R")
    assert selected is not None and other is not None
    step = next(step for step in by_ray(tree) if step.sum == other)

    def box(**options: object) -> Box:
        (figure,) = pages("tree", Subject([step]), FigureStyle(**options))  # type: ignore[arg-type]
        return next(mark for mark in figure.marks if isinstance(mark, Box) and mark.name == f"hit-{other}")

    assert box(selected=selected) == box()


@pytest.mark.parametrize("page", [(300.0, 350.0), (250.0, 300.0)])
def test_a_tree_shows_more_than_the_first_hit_in_smaller_text(page: tuple[float, float], worlds: dict) -> None:
    tree = tracer.trace(worlds["glass-ball"], lesson.read("glass-ball").first.state.pixel, depth=3)
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(text_size=PANEL_TEXT, swatches=True, page=page))
    hits = {mark.name for mark in figure.marks if isinstance(mark, Box) and mark.name.startswith("hit-")}
    assert "hit-0" in hits and len(hits) > 1
    check(figure, SMALLEST)
