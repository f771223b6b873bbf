"""The check of a lesson finds each fault that is planted, with its line; the skeleton has none."""

from pathlib import Path

import pytest

import tracer
from viewer.cli.main import main
from viewer.lessons.check import check
from viewer.lessons.expectation import failures
from viewer.lessons.skeleton import SCENE, write_skeleton
from viewer.lessons.values import QUANTITIES, value_text

HEAD = '+++\ntitle = "Mine"\nquestion = "Why?"\npixel = [160, 150]\n+++\n## One\n'
SWEEP = "sweep = { of = 'material.mirror.reflect', from = 0.5, to = 0 }"  # the reflected ray is gone at its end
STEP = '```step\nhit = "E"\n%s\n```\n%s\n'


def checked(folder: Path, step: str = "", text: str = "", head: str = HEAD) -> list[str]:
    """The faults of a lesson with one step, without the name of the file. The step's block begins on line 8."""
    (folder / "scene.toml").write_text(SCENE, "utf-8")
    (folder / "lesson.md").write_text(head + STEP % (step, text), "utf-8")
    return [fault.partition("lesson.md: ")[2] for fault in check(folder / "lesson.md")]


def test_the_skeleton_passes_and_is_never_written_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["lessons", "--new", "mine"]) == 0
    assert main(["lessons", "--check", "mine"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "mine/lesson.md: nothing is wrong"
    before = (tmp_path / "mine" / "lesson.md").read_bytes()
    assert main(["lessons", "--new", "mine"]) == 2
    assert capsys.readouterr().err == "mine: is there already: name a new folder\n"
    assert (tmp_path / "mine" / "lesson.md").read_bytes() == before


@pytest.mark.parametrize(
    ("step", "text", "said"),
    [
        ("", "{theta3}", 'line 11: {theta3}: unknown value "theta3" (did you mean "theta2"?)'),
        ("", "- a\n- {TT.t}", "line 12: {TT.t}: this pixel has no ray TT (it has E, R)"),
        ("", "{theta2}", "line 11: {theta2}: this hit has no such number"),
        ("", "a [b](#T)", "line 11: link #T: this pixel has no such ray (it has E, R)"),
        ('expect = { object = "floor" }', "", 'line 9: expect: object must be "floor", got "ball"'),
        ('expect = { children = ["T"] }', "", 'line 9: expect: children must be ["T"], got ["R"]'),
        ('expect = { R.object = "ball" }', "", 'line 9: expect: R.object must be "ball", got "floor"'),
        ('expect = { TR.t = "1" }', "", "line 9: expect: TR.t: the tree has no ray TR (it has E, R)"),
        ('expect = { theta2 = "1" }', "", "line 9: expect: theta2 must be 1, but this hit has none"),
        ("expect = { t = 1.5 }", "", "line 9: expect: t must be a number in quotes"),
        ('expect = { thata1 = "1" }', "", 'line 9: expect: unknown name "thata1" (did you mean "theta1"?)'),
        ('goal = { endd = "x" }', "", 'line 9: goal: unknown name "endd"'),
        ('goal = { object = "ball", R.object = "floor" }', "", "line 9: goal: it is reached at this pixel already"),
        ("pixel = [320, 1]", "", "line 9: pixel must be within 0,0 .. 319,239, got 320,1"),
        ("sample = 1", "", "line 9: sample must be within 0 .. 0"),
        ("set = { material.miror.ior = 1 }", "", '(did you mean "mirror"?)'),
        ("set = { material.mirror.ior = -1 }", "", "ior must be > 0, got -1"),
        ("sweep = { of = 'pixel', from = [160, 150], to = [320, 1] }", "", "line 9: sweep: pixel must be within"),
        (
            "sweep = { of = 'pixel', from = [160, 150], to = [161, 150], expect = { object = 'floor' } }",
            "",
            'line 9: sweep: expect: object must be "floor", got "ball"',
        ),
        (
            "sweep = { of = 'material.mirror.ior', from = 1, to = -2 }",
            "",
            'material[0] "mirror": ior must be > 0, got -2',
        ),
        ("sweep = { of = 'material.mirror.iro', from = 1, to = 2 }", "", 'unknown key "iro" (did you mean "ior"?)'),
        ("", "word " * 41, "line 11: 41 words appear at once; at most 40 are allowed"),
        ("", "\n???\n".join(["word " * 31] * 3), "line 6: 93 words in a step; at most 90 are allowed"),
        ("", "```live\nsnel\n```", "line 12: live: a live piece is one of snell, "),
        ("", "```live\nhit 3\n```", 'line 12: live: hit: no words may follow, got "3"'),
        ("", "```live\nsphere lamp\n```", "line 12: live: sphere: object must be an object of the scene, ball, floor"),
        ("", "```live\ninside\n```", "line 12: live: inside"),
        (
            "", "```source tracer.optics.transmision\n```",
            'line 11: source: tracer.optics has no function "transmision" (did you mean "transmission"?)',
        ),
        ("", "```source os.system\n```", 'line 11: source: a function of the tracer, like tracer.optics.transmission,'),
        ("", "```source tracer.optics.refract\nx = 1\n```", "line 12: source: the block must be empty"),
        ("", "```code formla\nx\n```", 'line 11: unknown block "code formla" (did you mean "formula"?)'),
        ("", "```code formula\nx\n\n\\foo\n```", r"line 14: formula '\\foo': \foo is not known"),
        ("", r"$\foo$", r"line 11: formula '\\foo': \foo is not known"),
        ('scene = "other.toml"', "", "other.toml: file not found"),
        ("goal = { t = 3 }", "", 'line 9: goal: t must be a number in quotes, like "47.26", got 3'),
        ('goal = { theta1 = "91" }', "", "line 9: goal: theta1 must be from 0 to 90, got 91"),
        ('goal = { R.reflectance = "1.2" }', "", "line 9: goal: R.reflectance must be from 0 to 1, got 1.2"),
        ('goal = { X.t = "1" }', "", "line 9: goal: X.t must begin with the path of a ray, like E, TR or"),
        ('goal = { RT.t = "1" }', "", "line 9: goal: RT.t asks for a ray T, and nothing in the scene transmits"),
        ('goal = { RRRR.t = "1" }', "", "line 9: goal: RRRR.t must be about a ray of depth 3 at most, which"),
        ('goal = { "E.L(sun)".end = "lit" }', "", "E.L(sun).end must be about a light of the scene (lamp), got sun"),
        ('goal = { "E.L(lamp)".end = "depth" }', "", 'E.L(lamp).end must be one of "lit", "filtered", "blocked", got'),
        ('goal = { end = "lit" }', "", 'line 9: goal: end must be one of "surface", "background", "depth", "weight",'),
        ('goal = { object = "bal" }', "", 'object must be one of "ball", "floor" (did you mean "ball"?), got "bal"'),
        ('goal = { children = "R" }', "", 'children must be one of [], ["R"], ["T"], ["I"], ["R", "T"], got "R"'),
        ('goal = { children = ["I"] }', "", "children asks for a ray I, and nothing in the scene transmits"),
        ('goal = { RRR.children = ["R"] }', "", "RRR.children must be [], since no ray goes on at depth 3, which is"),
        (SWEEP, "a\n\n{R.object}", "line 13: {R.object}: at the end of the sweep this pixel has no ray R (it has E)"),
        (SWEEP, "a\n\n???\n\n[it](#R)", "line 15: link #R: at the end of the sweep this pixel has no such ray"),
        (SWEEP, "```live\nphong x\n```", "line 12: live: phong: light must be a light of the scene, lamp, got"),
        (SWEEP, "{theta3}", "line 11: {theta3}: unknown value"),
        (
            "sweep = { of = 'material.mirror.reflect', from = 0.5, to = 0, expect = { children = ['R'] } }",
            "\n???\n[R](#E)", 'line 9: sweep: expect: children must be ["R"], got []',
        ),
        ("sweep = { of = 'material.mirror.iro', from = 1, to = 2 }", "\n## Two\n", 'unknown key "iro" (did you'),
        ("set = { material.miror.ior = 1 }", f"\n## Two\n```step\n{SWEEP}\n```\n", '(did you mean "mirror"?)'),
        ("sweep = { of = 'material.mirror.ior', from = -1, to = -1 }", "\n## Two\n", "ior must be > 0, got -1"),
        ("", "a\n???\n", "line 6: ??? hides nothing"),
        ('reveal = "rays"\nshow = ["refraction"]', "", "line 9: reveal: no ray of the kinds in `show` follows"),
        ('reveal = "depth"\npanels = ["tree"]\ndepth = 2', "", "line 9: reveal: depth 2 adds no ray to the tree"),
        ("sweep = { of = 'pixel', from = [160, 150], to = [160, 150] }", "", "line 9: sweep: it ends where it begins"),
        ("sweep = { of = 'pixel', from = [160, 150], to = [160, 230] }", "[b](#R)\n???\n[a](#R)",
         "line 13: link #R: at the end of the sweep this pixel has no such ray (it has E)"),
    ],
)  # fmt: skip
def test_a_planted_fault_is_found_with_its_line(tmp_path: Path, step: str, text: str, said: str) -> None:
    assert checked(tmp_path, "", "Right: {theta1}, {R.object}, [it](#R).") == []
    faults = checked(tmp_path, step, text)
    assert len(faults) == 1 and said in faults[0] and faults[0].startswith("line "), faults


def test_a_sweep_may_show_how_a_ray_goes(tmp_path: Path) -> None:
    """A link in the first part may be about a ray that is gone at the end. A later part is only about the end."""
    assert checked(tmp_path, SWEEP, "The [ray](#R) goes.\n\n???\n\n{t}") == []
    other = "sweep = { of = 'material.mirror.reflect', from = 0, to = 0.5 }"
    assert checked(tmp_path, other, "{t}\n\n???\n\nIt meets the {R.object}, [see](#R).") == []


def test_a_goal_that_can_be_reached_is_none_of_these(tmp_path: Path) -> None:
    for goal in (
        'RRR.object = "floor"', "children = []", 'RR.children = ["R"]', '"R.L(lamp)".end = "blocked"', 'theta1 = "90"',
        'radicand = "-2"', 'end = "background"', "E = { object = 'floor' }",
    ):  # fmt: skip
        assert checked(tmp_path, f"goal = {{ {goal} }}") == []


@pytest.mark.parametrize(
    ("step", "said"),
    [
        ('hit = "R"', "line 9: hit: the step has no pixel"),
        ('expect = { object = "ball" }', "line 9: expect: the step has no pixel"),
        ('goal = { object = "bal" }', 'line 9: goal: object must be one of "ball", "floor" (did you mean "ball"?)'),
        (f"{SWEEP[:-2]}, expect = {{ children = [] }} }}", "line 9: sweep: expect: the step has no pixel"),
        ("", "line 12: {t}: the step has no pixel"),
        ("", "line 12: link #R: the step has no pixel"),
        ("", "line 15: live: phong: no pixel is picked"),
    ],
)
def test_what_needs_a_pixel_is_a_fault_without_one(tmp_path: Path, step: str, said: str) -> None:
    text = {"{t}": "{t}", "link": "[a](#R)", "live": "\n\n```live\nphong\n```"}
    used = next((words for key, words in text.items() if key in said), "") if not step else ""
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    head = '+++\ntitle = "Mine"\nquestion = "Why?"\ndepth = 1\n+++\n## One\n'
    (tmp_path / "lesson.md").write_text(f"{head}```step\ndepth = 2\n{step}\n```\n\n{used}\n", "utf-8")
    (fault,) = check(tmp_path / "lesson.md")
    assert said in fault


def test_a_lesson_begins_with_a_question(tmp_path: Path) -> None:
    head = HEAD.replace('question = "Why?"\n', "")
    assert checked(tmp_path, head=head) == [
        'line 2: question is missing: a lesson begins with one, like question = "Why is it dark?"'
    ]


def test_text_without_room_in_the_hall_is_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    rows = "".join(f"- row {k}\n" for k in range(20))
    (tmp_path / "lesson.md").write_text(HEAD + STEP % ("", rows), "utf-8")
    assert main(["lessons", "--check", str(tmp_path)]) == 1
    said = capsys.readouterr().out
    assert "line 6: its text needs scrolling in lecture type at 1280x720" in said


def test_a_number_is_right_within_half_a_unit_of_its_last_digit(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["underwater"], (560, 240), depth=1)
    theta = QUANTITIES["theta1"].value(tree, 0)
    for decimals in range(6):
        rounded, unit = round(theta, decimals), 10.0**-decimals
        assert failures({"theta1": f"{rounded:.{decimals}f}"}, tree, "E") == []
        for wrong in (rounded - unit, rounded + unit):
            assert len(failures({"theta1": f"{wrong:.{decimals}f}"}, tree, "E")) == 1


def test_every_value_is_that_of_the_tree(worlds: dict[str, tracer.World]) -> None:
    tree = tracer.trace(worlds["underwater"], (560, 240), depth=1)
    assert value_text(tree, "E", "n1") == "1.33" and value_text(tree, None, "n2") == "1"
    assert value_text(tree, "E", "critical") == "48.75°"
    assert value_text(tree, "E", "reflectance") == "1" and value_text(tree, "E", "transmittance") == "0"
    assert value_text(tree, "E", "theta2") == "–" and value_text(tree, "E", "I.object") == tree.object_name(
        tree.find("I") or 0
    )
    assert value_text(tree, "E", "R.t") == "–" and value_text(tree, "E", "nothing") is None


def test_a_skeleton_is_complete(tmp_path: Path) -> None:
    assert [path.name for path in write_skeleton(tmp_path / "a" / "b")] == ["lesson.md", "scene.toml"]
