"""The mark under the mouse."""

import math

from hypothesis import given, strategies as st

import tracer
from tests.viewer.figures.geometry import rectangle
from viewer.base.theme import LIGHT
from viewer.figures.figure.tree import pages
from viewer.figures.marks import Box, Disc, Handle, Line, Point, Shape, Stroke, Text
from viewer.figures.picking import distance, handle_at, mark_at, nearest_value, row_of
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject

BLACK = (0.0, 0.0, 0.0, 1.0)
THICK = Stroke(BLACK, 4.0)
LINE = Line("ray-1", (10.0, 10.0), (110.0, 10.0), THICK)
BOX = Box("hit-1", (110.0, 10.0), (40.0, 20.0), 4.0, None, THICK)


def test_the_nearest_mark_within_reach_is_found() -> None:
    text = Text("ray-2", (60.0, 30.0), "R2", 10.0, BLACK)
    marks = [LINE, BOX, text]
    assert mark_at(marks, (50.0, 12.0), 0.0) == "ray-1"  # on its edge
    assert mark_at(marks, (50.0, 15.0), 2.0) is None
    assert mark_at(marks, (50.0, 15.0), 3.0) == "ray-1"
    assert mark_at(marks, (60.0, 31.0), 0.0) == "ray-2"
    assert mark_at(marks, (60.0, 22.0), 30.0) == "ray-2"  # nearer than the line
    assert mark_at(marks, (9.0, 10.0), 1.0) == "ray-1"  # beyond the line's end: half its width is less
    assert mark_at([], (0.0, 0.0), math.inf) is None


def test_of_marks_that_cover_each_other_the_upper_one_is_found() -> None:
    assert mark_at([LINE, BOX], (100.0, 10.0), 5.0) == "hit-1"
    assert mark_at([BOX, LINE], (100.0, 10.0), 5.0) == "ray-1"


def test_only_marks_that_belong_to_a_row_are_found() -> None:
    medium = Shape("medium-1", ((0.0, 0.0), (200.0, 0.0), (200.0, 90.0)), BLACK, None)
    assert mark_at([LINE, medium, Disc("eye", (50.0, 10.0), 9.0, None, None)], (50.0, 13.0), 2.0) == "ray-1"
    assert mark_at([Line("fold-4", (0.0, 0.0), (9.0, 0.0), THICK)], (5.0, 0.0), 1.0, kinds=("fold",)) == "fold-4"
    assert row_of("ray-12") == 12 and row_of(None) is None


def test_a_closed_outline_is_its_inside_and_an_open_one_its_curve() -> None:
    corners = ((0.0, 0.0), (20.0, 0.0), (10.0, 10.0), (20.0, 20.0), (0.0, 20.0))
    assert distance(Shape("ray-1", corners, BLACK, None), (2.0, 10.0)) == 0.0
    assert distance(Shape("ray-1", corners, BLACK, None), (16.0, 10.0)) > 4.0  # in the notch
    assert distance(Shape("ray-1", corners, None, THICK, closed=False), (-5.0, 10.0)) > 5.0  # its last side is missing
    assert distance(Shape("ray-1", corners, BLACK, THICK), (-5.0, 10.0)) == 3.0


@given(st.floats(0.0, 1.0), st.floats(0.0, 2.0 * math.pi), st.floats(2.1, 30.0))
def test_the_distance_to_a_line_is_that_to_its_edge(share: float, turn: float, away: float) -> None:
    start, end = (40.0, 60.0), (40.0 + 100.0 * math.cos(turn), 60.0 + 100.0 * math.sin(turn))
    line = Line("ray-1", start, end, THICK)
    x, y = line.at(share)
    aside = (x - away * math.sin(turn), y + away * math.cos(turn))
    assert math.isclose(distance(line, aside), away - 2.0, abs_tol=1e-9)


def test_every_box_and_label_of_a_tree_is_found_where_it_is_drawn(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["glass-ball"], (248, 180), depth=3)
    (marks,) = pages(Subject(by_depth([tree])), FigureStyle(theme=LIGHT))
    boxes = [mark for mark in marks if isinstance(mark, Box) and mark.name.startswith("hit-")]
    assert len(boxes) > 5
    for box in boxes:
        left, top, right, bottom = rectangle(box)
        for at in (box.center, (left + 1.0, top + 1.0), (right - 1.0, bottom - 1.0)):
            assert mark_at(marks, at, 6.0) == box.name
    for text in marks:
        if isinstance(text, Text) and text.name.startswith("ray-"):
            assert mark_at(marks, text.at, 6.0) == text.name


COORDINATE = st.floats(-900.0, 900.0)


@given(
    st.lists(st.tuples(COORDINATE, COORDINATE), min_size=2, max_size=9, unique=True),
    st.floats(0.0, 1.0),
    st.tuples(COORDINATE, COORDINATE),
)
def test_a_handle_goes_to_the_nearest_place_of_its_path(path: list[Point], share: float, mouse: Point) -> None:
    low, high = -3.0, 17.0

    def handle(value: float) -> Handle:
        return Handle("turn", value, (low, high), tuple(path), BLACK)

    value = low + share * (high - low)
    at = handle(value).at
    assert math.dist(handle(nearest_value(handle(value), at)).at, at) <= 1e-6
    nearest = math.dist(handle(nearest_value(handle(value), mouse)).at, mouse)
    others = [handle(low + k / 60 * (high - low)) for k in range(61)]
    assert nearest <= min(math.dist(other.at, mouse) for other in others) + 1e-6
    assert handle_at([LINE, handle(value)], at, 1.0) == handle(value)
    assert handle_at([LINE, handle(value)], (at[0] + 5.0, at[1]), 1.0) is None
