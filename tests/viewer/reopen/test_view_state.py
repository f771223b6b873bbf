"""The state of a view: one list of fields for the command line, JSON and the window."""

import subprocess
from dataclasses import fields

import pytest
from hypothesis import given, settings, strategies as st

from tests.viewer.base.test_options import options as random_options
from viewer.base.options import shell_line, words
from viewer.base.values import Unreadable
from viewer.cli.main import parse
from viewer.cli.options import ViewOptions
from viewer.reopen.view_state import (
    KINDS,
    SWITCHES,
    UNCHANGED,
    VIEW_WORDS,
    ViewState,
    differing,
    from_texts,
    merged,
    texts,
)
from viewer.session.view_state import Visibility

STATES = random_options(ViewState)


@settings(max_examples=200, deadline=None)
@given(STATES)
def test_a_state_is_read_back_from_json_and_from_words(state: ViewState) -> None:
    assert from_texts(texts(state)) == state
    assert VIEW_WORDS.read(VIEW_WORDS.show(state)) == state
    _, options = parse(["view", *words(state)])
    assert options.state == state


@settings(max_examples=200, deadline=None)
@given(STATES, STATES)
def test_what_differs_completes_the_base(state: ViewState, base: ViewState) -> None:
    """Except for a field that has a value in the base alone: a difference cannot take it away."""
    more = differing(state, base)
    for item in fields(ViewState):
        found, wanted = getattr(merged(base, more), item.name), getattr(state, item.name)
        assert found == wanted or (wanted == item.default and found == getattr(base, item.name))
    assert differing(state, state) == UNCHANGED


def test_every_switch_of_the_window_is_in_the_list() -> None:
    assert ("kinds", *SWITCHES) == tuple(item.name for item in fields(Visibility))
    assert Visibility().kinds == set(KINDS)


@settings(max_examples=200, deadline=None)
@given(
    st.dictionaries(
        st.sampled_from([item.name for item in fields(ViewState)]) | st.text(), st.none() | st.text() | st.integers()
    )
)
def test_hostile_texts_are_refused_in_words(found: dict) -> None:
    try:
        state = from_texts(found)
    except Unreadable as unreadable:
        assert "\n" not in str(unreadable).split(", got ")[0]
    else:
        assert from_texts(texts(state)) == state


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--filter", "mirror"], 'any of camera,reflection,refraction,tir,shadow, or none, got "mirror"'),
        (["--hide", "eye"], 'any of camera,lights,normals,labels, or none, got "eye"'),
        (["--camera", "1,2"], "azimuth and elevation (-90 to 90) in degrees and a distance (1e-09 to 1e+09)"),
        (["--select", "Q"], 'the path of a ray, like E, TR or TR.L(key), got "Q"'),
        (["--theme", "mono"], 'one of dark, light, got "mono"'),
        (["--type-size", "huge"], 'one of normal, lecture, got "huge"'),
        (["--image-zoom", "0,0,0"], 'a zoom from 0.01 to 1000 and a point X,Y, like 2,0.5,0.5, got "0,0,0"'),
        (["--image-zoom", "1,nan,0"], 'a zoom from 0.01 to 1000 and a point X,Y, like 2,0.5,0.5, got "1,nan,0"'),
    ],
)
def test_a_bad_value_is_one_line_with_what_is_allowed(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        parse(["view", "plates", *words])
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


def test_a_line_for_the_shell_has_no_control_characters_and_reads_back() -> None:
    words = ["raytree", "a b'c\\d", "x\x1b[2J\n\x7f'\\", "\u202e\x85", "", "\udcff.toml", "π $HOME `ls`"]
    line = shell_line(words)
    assert line.isprintable()
    run = subprocess.run(
        ["bash", "-c", f"printf '%s\\0' {line}"], capture_output=True, check=True, env={"LC_ALL": "C.UTF-8"}
    )
    assert run.stdout.split(b"\0")[:-1] == [word.encode("utf-8", "surrogateescape") for word in words]


def test_view_options_are_the_state_and_five_more() -> None:
    own = {item.name for item in fields(ViewOptions)} - {item.name for item in fields(ViewState)}
    assert own == {"scene", "screenshot", "size", "speaker", "language"}
