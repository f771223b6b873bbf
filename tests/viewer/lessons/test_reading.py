"""Reading a lesson: steps, the states that they inherit, hidden parts, and faults with their lines."""

from pathlib import Path

import pytest

from viewer.base.files import Unusable
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.markdown import blocks_of
from viewer.lessons.moments import Shown, count_presses, shown_at
from viewer.lessons.step import State
from viewer.lessons.text import (
    Fence,
    Formula,
    InlineFormula,
    Items,
    Paragraph,
    Quote,
    Run,
    Table,
    count_words,
    filled,
    inlines,
    names_of_values,
)

HEAD = '+++\ntitle = "Mine"\nquestion = "Why?"\ndepth = 2\n+++\n'
BODY = """\
## First
```step
pixel = [3, 4]
hit = "T"
set = { material."pool tiles".ior = 1.5 }
expect = { theta1 = "47.26", TR.end = "surface" }
panels = ["scene", "hit"]
reveal = "rays"
```
Seen {theta1}.
???
Hidden [ray](#T).
```notes
Say it.
```

???

Last.

```live
snell 1.33 1
```

## Second
```step
depth = 0
show = ["camera", "shadow"]
```
```text
## no heading
???
```
"""


@pytest.fixture
def made(tmp_path: Path):
    def make(body: str, head: str = HEAD) -> Lesson:
        (tmp_path / "lesson.md").write_text(head + body, "utf-8")
        return read_file(tmp_path / "lesson.md")

    return make


def plain(blocks: tuple) -> str:
    return "".join(item.text for _, item in inlines(blocks) if isinstance(item, Run))


def test_steps_have_absolute_states(made) -> None:
    """A step inherits the fields that it leaves out, except for those about its own rays."""
    first, second = made(BODY).steps
    assert first.state == State(
        set={"material": {"pool tiles": {"ior": 1.5}}}, pixel=(3, 4), depth=2, panels=("scene", "hit"), hit="T",
        reveal="rays", expect={"theta1": "47.26", "TR": {"end": "surface"}},
    )  # fmt: skip
    assert second.state == State(
        set=first.state.set, pixel=(3, 4), depth=0, panels=("scene", "hit"), show=("camera", "shadow")
    )
    assert (first.title, first.line, second.title) == ("First", 6, "Second")
    assert [first.line_of(key) for key in ("pixel", "hit", "theta1", "end", "depth")] == [8, 9, 11, 11, 6]


def test_parts_are_hidden_behind_question_marks_outside_of_fences(made) -> None:
    first, second = made(BODY).steps
    assert [plain(part.blocks) for part in first.parts] == ["Seen {theta1}.", "Hidden ray.", "Last."]
    assert first.notes == "Say it."
    assert [[fence.content for fence in part.live] for part in first.parts] == [[], [], ["snell 1.33 1\n"]]
    assert [part.blocks for part in second.parts] == [(Fence(35, "text", "## no heading\n???\n"),)]


def test_every_press_shows_more_until_the_end_of_the_step(made) -> None:
    """The stages of the reveal come first, then the hidden parts; none is skipped."""
    first, second = made(BODY).steps
    shown = [shown_at(first, 3, press) for press in range(count_presses(first, 3) + 1)]
    assert shown == [Shown(1, 0), Shown(1, 1), Shown(1, 2), Shown(2, 2), Shown(3, 2)]
    assert count_presses(second, 1) == 0


def test_markdown_has_its_blocks_and_lines() -> None:
    text = "a *b* **c** `d {t}` [e](#TR) $x_1$ {t}\nf\n\n- one\n- two\n  1. three\n\n> q\n\n"
    table = "| a | b |\n|--|--|\n| 1 | 2 |\n"
    found = blocks_of(f"{text}{table}\n$$\n\\frac{{a}}{{b}}\n$$\n\n### Sub\n", 10)
    assert [(type(block), block.line) for block in found] == [
        (Paragraph, 10), (Items, 13), (Quote, 17), (Table, 19), (Formula, 23), (Paragraph, 27)
    ]  # fmt: skip
    assert [item for _, item in inlines(found[:1])] == [
        Run("a "), Run("b", italic=True), Run(" "), Run("c", bold=True), Run(" "), Run("d {t}", code=True), Run(" "),
        Run("e", link="#TR"), Run(" "), InlineFormula("x_1"), Run(" {t} f"),
    ]  # fmt: skip
    assert list(names_of_values(found)) == [(10, "t")]  # that in code is no value
    assert plain(filled(found[:1], lambda name: f"<{name}>")) == "a b c d {t} e  <t> f"
    assert count_words(found) == 9 + 3 + 1 + 4 + 1


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("", "line 6: a lesson has at least one step"),
        ("text\n## One\n", "line 6: text before the first step"),
        ("## One\n```step\npixle = [1, 2]\n```\n", 'line 8: unknown key "pixle" (did you mean "pixel"?)'),
        ("## One\n```step\n\npixel = [1, -2]\n```\n", "line 9: pixel must be two whole numbers"),
        ("## One\n```step\n\npixel = [1 2]\n```\n", 'line 9: not TOML: unclosed array, got "pixel = [1 2]"'),
        ("## One\n```step\ndepth = two\n```\n", 'line 8: not TOML: invalid value, got "depth = two"'),
        ("## One\n```step\ndepth = 1\ndepth = 2\n```\n", 'line 9: not TOML: cannot overwrite a value, got "depth = 2"'),
        ("## One\n```step\npanels = ['scene', 'tree', 'hit', 'image']\n```\n", "line 8: panels must be a list of at"),
        ("## One\n```step\npanels = ['scen']\n```\n", '(did you mean "scene"?)'),
        ("## One\n```step\nhit = 'X'\n```\n", "line 8: hit must be the path of a ray"),
        ("## One\n```step\nview = { elevation = 95 }\n```\n", "line 8: view: elevation must be > -90 and < 90, got 95"),
        ("## One\n```step\nsweep = { of = 'pixel', from = 1, to = 2 }\n```\n", "line 8: sweep must be a table"),
        ("## One\n```step\nsweep = { of = 'a b', from = 1, to = 2 }\n```\n", "line 8: sweep must be a table whose"),
        (
            "## One\n```step\npixel = [1, 2]\nsweep = { of = 'pixel', from = [1, 3], to = [2, 2] }\n```\n",
            "line 8: pixel is that with which the sweep begins",
        ),
        (
            "## One\n```step\nreveal = 'depth'\nsweep = { of = 'a', from = 1, to = 2 }\n```\n",
            "line 9: a step has a reveal or a sweep, not both",
        ),
        ("## One\n```step\nexpect = 1\n```\n", "line 8: expect must be a table, got 1"),
        ("## One\nText.\n```step\ndepth = 1\n```\n", "line 8: the block step stands right below the heading"),
        ("## One\n```stp\ndepth = 1\n```\n", 'line 7: unknown block "stp" (did you mean "step"?)'),
    ],
)  # fmt: skip
def test_a_fault_is_said_with_its_line(made, body: str, said: str) -> None:
    with pytest.raises(Unusable) as caught:
        made(body)
    assert any(said in fault for fault in caught.value.faults), caught.value.faults


def test_what_belongs_to_a_step_is_no_data_of_the_lesson(made) -> None:
    with pytest.raises(Unusable) as caught:
        made("## One\n", HEAD.replace("depth = 2", 'hit = "E"\nminutes = 0'))
    assert [fault.partition("lesson.md: ")[2].partition(" (")[0] for fault in caught.value.faults] == [
        'line 4: unknown key "hit"', "line 5: minutes must be a whole number from 1 to 600, got 0"
    ]  # fmt: skip
