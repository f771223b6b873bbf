"""The arrangement of the panels: every place has its room, none overlaps another."""

import itertools

from hypothesis import given, strategies as st

from viewer.panels import PANELS
from viewer.reopen.view_state import PANEL_NAMES
from viewer.session.layout import Arrangement, Corner, Layout, tile

SHARES = st.floats(-1.0, 2.0)


@given(SHARES, SHARES, SHARES, st.sets(st.sampled_from(Corner)), st.sets(st.sampled_from(Corner)))
def test_places_fill_the_room_and_do_not_overlap(
    columns: float, left: float, right: float, closed: set[Corner], filled: set[Corner]
) -> None:
    arrangement = Arrangement()
    for which, share in ((None, columns), (0, left), (1, right)):
        arrangement.split(which, share)
    room = (10.0, 20.0, 1000.0, 700.0)
    places, borders = tile(arrangement, closed, filled, room, 4.0)
    assert set(places) == filled - closed
    rectangles = [*places.values(), *borders.values()]
    for (x0, y0, w0, h0), (x1, y1, w1, h1) in itertools.combinations(rectangles, 2):
        assert x0 + w0 <= x1 or x1 + w1 <= x0 or y0 + h0 <= y1 or y1 + h1 <= y0
    for x, y, w, h in rectangles:
        assert x >= 10.0 and y >= 20.0 and x + w <= 1010.0 and y + h <= 720.0
    area = sum(w * h for _, _, w, h in rectangles)
    assert not places or area == 1000.0 * 700.0


@given(st.lists(st.sampled_from(PANEL_NAMES), min_size=1, unique=True), st.booleans())
def test_the_panels_that_are_to_be_shown_are_shown(names: list[str], is_lecture: bool) -> None:
    """Of those that share a place, the first. One alone has all of the room."""
    layout = Layout()
    layout.show(names, is_lecture)
    first: dict[Corner, str] = {}
    beside = is_lecture and "recursion" in names and len(names) > 1
    for name in ("tree", "recursion") if beside else names:  # in lecture mode, these two stand beside each other
        first.setdefault(layout.place_in(name, is_lecture), name)
    assert set(layout.shown(is_lecture)) == set(first.values())
    layout.show(layout.shown(is_lecture), is_lecture)
    assert set(layout.shown(is_lecture)) == set(first.values())


def test_the_names_are_those_of_the_panels_in_their_order() -> None:
    assert tuple(panel.name for panel in PANELS) == PANEL_NAMES


def test_a_panel_has_all_of_the_room_and_gives_it_back() -> None:
    layout = Layout()
    usual = layout.shown(is_lecture=False)
    layout.maximise("tree")
    assert layout.shown(is_lecture=False) == ("tree",)
    layout.maximise("hit")
    assert layout.shown(is_lecture=False) == ("hit",)
    layout.maximise("hit")
    assert layout.shown(is_lecture=False) == usual == ("scene", "image", "tree", "ray")
