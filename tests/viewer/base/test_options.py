"""Options of every command: the printed command line parses to the same options, for random options."""

from dataclasses import fields, replace

import pytest
from hypothesis import given, settings, strategies as st

from viewer.base import values
from viewer.base.options import spelling, words
from viewer.base.values import Value
from viewer.cli.main import COMMANDS, Command, parse
from viewer.figures.catalogue import FORMATS
from viewer.reopen import view_state

NUMBER = st.floats(allow_nan=False, allow_infinity=False)
WORD = st.text("abcdefghij-_./ öπ'\"$", min_size=1).filter(lambda text: not text.startswith("-"))

# Values of each kind of option. A kind that is missing here fails the test.
STRATEGIES: dict[Value, st.SearchStrategy] = {
    values.TEXT: WORD,
    values.FILE: WORD.map(values.FILE.read),
    values.PIXEL: st.tuples(st.integers(-99, 9999), st.integers(-99, 9999)),
    values.MOMENT: st.tuples(st.integers(1, 999), st.integers(0, 99)),
    values.SIZE: st.tuples(st.integers(1, 9999), st.integers(1, 9999)),
    values.RAY: st.tuples(*[NUMBER] * 6),
    values.RAY_NAME: st.sampled_from(("T", "T4", "TIR12", "E", "r7", "TRI")),
    values.ORBIT: st.tuples(NUMBER, st.floats(-90, 90), st.floats(1e-9, 1e9)),
    values.DEPTHS: st.tuples(st.integers(0, 9), st.integers(0, 9)).map(lambda ab: range(min(ab), max(ab) + 1)),
    values.WEIGHT: st.floats(0, 1e300),
    values.POSITIVE: st.floats(1e-300, 1e300),
    values.SHARE: st.floats(0, 1),
    values.PIXELS: st.integers(16, values.MAX_PIXELS),
    values.POINTS: st.floats(8, 48),
    values.INCIDENCE: st.floats(0, 89),
    values.RAY_PATH: st.sampled_from(("E", "TRI", "T[3]R", "E.L(key)", "TR.L(a 'b' $c)[5]")),
    values.PAPER: st.tuples(st.integers(200, 4000), st.integers(200, 4000)),
    values.LANGUAGE: st.sampled_from(("de", "pt_BR", "gsw")),
    values.SHARES: st.tuples(*[st.floats(0.15, 0.85)] * 3),
    values.PAN_ZOOM: st.tuples(st.floats(0.01, 1000), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6)),
    view_state.VIEW_WORDS: st.deferred(lambda: options(view_state.ViewState)).filter(
        lambda s: s != view_state.UNCHANGED
    ),
}
NAMES = {"KINDS": view_state.KINDS, "PARTS": view_state.SWITCHES}  # by the option's metavar
LISTS = {"A,B": tuple(FORMATS), "PANELS": view_state.PANEL_NAMES}  # not empty, in any order


def strategy(value: Value) -> st.SearchStrategy:
    """Values of one kind: of the table, one of some names, some of them, or integers."""
    if value in STRATEGIES:
        return STRATEGIES[value]
    names = value.metavar.split("|")
    if len(names) > 1:
        return st.sampled_from(names)
    if value.metavar in LISTS:
        return st.lists(st.sampled_from(LISTS[value.metavar]), min_size=1, unique=True).map(tuple)
    if value.metavar in NAMES:
        known = NAMES[value.metavar]
        return st.sets(st.sampled_from(known)).map(lambda chosen: tuple(name for name in known if name in chosen))
    return st.integers(1, 10**9)


@st.composite
def options(draw: st.DrawFn, kind: type) -> object:
    """Random options, at most one of each exclusive group."""
    chosen, taken = {}, set()
    for item in fields(kind):
        how = spelling(item)
        must = how.is_required or (how.is_positional and how.nargs in ("", "+"))
        if how.group in taken or not (must or draw(st.booleans())):
            continue
        taken |= {how.group} - {""}
        if how.value is None:
            chosen[item.name] = True
        else:
            many = how.nargs in ("+", "*")
            one = strategy(how.value)
            chosen[item.name] = draw(st.lists(one, min_size=1, max_size=3).map(tuple) if many else one)
    return kind(**chosen)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_printed_options_parse_to_the_same(command: Command, data: st.DataObject) -> None:
    given_options = data.draw(options(command.options))
    assert parse([command.name, *words(given_options)]) == (command, given_options)


def test_defaults_are_not_printed_and_fields_can_be_left_out() -> None:
    (export,) = (command for command in COMMANDS if command.name == "export")
    own = export.options(scene="drop", output="out/")
    assert words(own) == ["drop", "--output", "out/"]
    assert words(replace(own, swatches=True, fold=0.25), leave_out=("output",)) == [
        "drop",
        "--swatches",
        "--fold",
        "0.25",
    ]
