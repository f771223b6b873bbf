"""A lesson as a page, in a real browser: stages, sweeps, handles, hidden parts, phones, schemes, screen readers."""

import json
import math
from pathlib import Path

import html5lib
import pytest

from tests.viewer.chromium import Browser
from tests.viewer.figures.writers.test_html import ARTICLE, CONTRASTS, TAP, messages
from tests.viewer.handout.sample import EVIL
from viewer.figures.marks import Text
from viewer.handout.document import Handout, Room, Show, paper
from viewer.handout.html.page import write_page
from viewer.handout.html.shows import ROOMS
from viewer.handout.live import LIVE_ROOM
from viewer.handout.sweeps import POSITIONS

COMMAND = "raytree export EVIL --lesson"
# The texts that are seen in the k-th figure of a show, in order.
TEXTS = """[...[...document.querySelectorAll('#{0} .canvas svg')].filter(s => s.closest('.show').id === '{0}')[{1}]
  .querySelectorAll('text')]
  .filter(text => text.getClientRects().length).map(text => text.textContent)"""
LIT = (
    "[...new Set([...document.querySelectorAll('.on')].filter(m => m.getClientRects().length).map(m => m.dataset.ray))]"
)
HANDLE = """[[...document.querySelectorAll('#{} [data-handle] circle')].find(c => c.getClientRects().length)
  .getBoundingClientRect()].map(box => [box.x + box.width / 2, box.y + box.height / 2])[0]"""
SEEN = "[...document.querySelectorAll({})].map(e => e.checkVisibility())"


@pytest.fixture(scope="module")
def page(handout: Handout, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("pages") / "glass.html"
    path.write_bytes(write_page(handout, COMMAND))
    return path


def move_to(browser: Browser, place: str, position: int) -> str:
    """Move the slider of a show. Returns what is said of the position."""
    show = f"document.getElementById('{place}')"
    browser.run(f"""(() => {{ const input = {show}.querySelector(':scope > .moved > .control input');
      input.value = {position}; input.dispatchEvent(new Event('input')); }})()""")
    return browser.run(f"{show}.querySelector(':scope > .moved > .control output').textContent")


def expected_texts(show: Show, k: int, frame: int) -> list[str]:
    """The texts of the k-th picture of a show, as its panel or its piece makes them."""
    picture = show.pictures[k]
    (marks,) = picture.draw(Room(ROOMS.get(picture.kind, LIVE_ROOM.where), LIVE_ROOM.size, paper("light")), [frame])
    return [mark.content for mark in marks if isinstance(mark, Text)]


def contrast(one: str, other: str) -> float:
    """The ratio of the relative luminances of two colours `rgb(r, g, b)` (WCAG 2, 1.4.3)."""
    values = []
    for color in (one, other):
        channels = [float(c) / 255.0 for c in color[4:-1].split(",")]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        values.append(0.05 + sum(a * b for a, b in zip((0.2126, 0.7152, 0.0722), linear, strict=True)))
    return max(values) / min(values)


def test_a_reveal_begins_with_the_first_ray_and_each_stage_shows_its_rays(desktop: Browser, handout: Handout) -> None:
    show = handout.pages[0].show
    rays = """[...document.querySelectorAll('#step-1-show .tree [data-mark^=hit-]')]
      .filter(m => m.getClientRects().length).map(m => Number(m.dataset.ray.split('-')[1]))"""
    for position in range(show.frames):
        said = move_to(desktop, "step-1-show", position) if position else ""
        (marks,) = show.pictures[1].draw(Room(ROOMS["tree"], LIVE_ROOM.size, paper("light")), [position])
        hits = {int(mark.name[4:]) for mark in marks if mark.name.startswith("hit-")}
        assert set(desktop.run(rays)) == hits
        for k in range(2):
            assert sorted(desktop.run(TEXTS.format("step-1-show", k))) == sorted(expected_texts(show, k, position))
        assert not position or said == f"{position + 1} of {show.frames}: {show.controls[0].positions[position]}"
    assert not messages(desktop)


def test_positions_of_a_sweep_and_of_handles_have_the_numbers_that_were_computed(
    desktop: Browser, handout: Handout
) -> None:
    page = handout.pages[2]
    (snell,), (lifeguard,) = (part.live.values() for part in page.parts)
    places = [("step-3-show", page.show)]
    desktop.run("document.querySelectorAll('details.answer').forEach(answer => answer.open = true)")
    ids = desktop.run("[...document.querySelectorAll('#\\\\33  .live')].map(show => show.id)")
    places += zip(ids, (snell, lifeguard), strict=True)
    assert len(page.show.controls[0].positions) == POSITIONS
    for place, show in places:
        control = show.controls[0]
        last = len(control.positions) - 1
        for position in {0, last // 3, last}:
            said = move_to(desktop, place, position)
            assert said.endswith(control.positions[position])
            for k in range(len(show.pictures)):
                expected = expected_texts(show, k, control.first + position)
                assert sorted(desktop.run(TEXTS.format(place, k))) == sorted(expected)
    trees = [shown.tree for shown in page.show.shown]
    angles = [float(tree.nodes["theta1"][0]) for tree in trees if tree]
    assert len(set(angles)) == len(angles) == POSITIONS  # no two positions are alike, also between pixels
    assert trees[0] and trees[0].pixel == (30, 18) and trees[-1] is page.parts[1].shown.tree


def test_a_live_piece_in_the_first_part_goes_along_with_the_sweep(desktop: Browser, handout: Handout) -> None:
    """And the box of the sweep covers nothing: it stands above the pictures."""
    page = handout.pages[2]
    (snell,) = page.parts[0].live.values()
    place = desktop.run("document.querySelector('#step-3-show .live').id")
    assert snell.follows is not None
    seen = []
    for position in (0, POSITIONS // 2, POSITIONS - 1):
        move_to(desktop, "step-3-show", position)
        seen.append(sorted(desktop.run(TEXTS.format(place, 0))))
        assert seen[-1] == sorted(expected_texts(snell, 0, snell.follows + position))
        control = snell.controls[0]
        tree = page.show.shown[position].tree
        assert tree
        value = control.positions[desktop.run(f"Number(document.querySelector('#{place} input').value)")].split(";")[0]
        assert abs(float(value) - math.degrees(float(tree.nodes["theta1"][0]))) <= 0.5 + 1e-9
        assert desktop.run(f"document.querySelector('#{place} output').textContent") == ""
    assert len({tuple(texts) for texts in seen}) == 3
    move_to(desktop, place, 0)  # its own handle
    assert sorted(desktop.run(TEXTS.format(place, 0))) == sorted(expected_texts(snell, 0, snell.controls[0].first))
    box = "(e => { const b = e.getBoundingClientRect(); return [b.top, b.bottom]; })"
    show = "document.getElementById('step-3-show').querySelector(':scope > .moved > {}')"
    (_, low), (high, _) = (desktop.run(f"{box}({show.format(name)})") for name in (".control", ".pictures"))
    assert low <= high and desktop.run(f"getComputedStyle({show.format('.control')}).position") == "static"


def test_a_handle_is_dragged(desktop: Browser, handout: Handout) -> None:
    (lifeguard,) = handout.pages[2].parts[1].live.values()
    desktop.run("document.querySelector('#\\\\33  details.answer').open = true")
    place = desktop.run("document.querySelector('details.answer .live').id")
    desktop.run(f"document.querySelector('#{place} svg').scrollIntoView({{block: 'center'}})")
    x, y = desktop.run(HANDLE.format(place))
    mouse = {"button": "left", "buttons": 1, "clickCount": 1}
    desktop.move(x, y)
    desktop.ask("Input.dispatchMouseEvent", type="mousePressed", x=x + 2, y=y, **mouse)
    for away in (30, 80, 117):
        desktop.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x + away, y=y + 40, **mouse)
    desktop.ask("Input.dispatchMouseEvent", type="mouseReleased", x=x + 117, y=y + 40, **mouse)
    desktop.move(x + 200, y)  # it is let go
    moved = desktop.run(HANDLE.format(place))
    step = desktop.run(f"document.querySelector('#{place} svg').getScreenCTM().a") * 460.0 / 90.0  # of 90 positions
    assert abs(moved[0] - x - 117) <= step and moved[1] == y
    position = desktop.run(f"Number(document.querySelector('#{place} input').value)")
    assert (
        desktop.run(f"document.querySelector('#{place} output').textContent")
        == (lifeguard.controls[0].positions[position])
    )
    desktop.run(f"document.querySelector('#{place} input').focus()")
    desktop.key("ArrowLeft")
    assert (
        desktop.run(f"document.querySelector('#{place} input').getAttribute('aria-valuetext')")
        == (lifeguard.controls[0].positions[position - 1])
    )


def test_a_link_in_the_text_lights_its_ray_in_scene_and_tree(desktop: Browser, handout: Handout) -> None:
    tree = handout.pages[0].parts[0].shown.tree
    assert tree
    row = tree.find("T")
    move_to(desktop, "step-1-show", handout.pages[0].show.frames - 1)
    desktop.run("document.querySelector('a[data-to]').focus()")
    assert desktop.run(LIT) == [f"t1-{row}"]
    parts = desktop.run("[...document.querySelectorAll('#step-1-show .on')].map(m => m.dataset.mark)")
    assert parts.count(f"ray-{row}") >= 2 and f"hit-{row}" in parts
    shown = desktop.run(ARTICLE)
    assert shown["path"] == "T" and shown["object"] == EVIL
    desktop.key("Enter")
    desktop.move(1, 1)
    assert desktop.run(LIT) == [f"t1-{row}"]
    desktop.key("Escape")
    assert desktop.run(LIT) == []


def test_a_step_has_the_text_of_a_function_and_what_is_to_be_reached(desktop: Browser) -> None:
    step = "document.getElementById('4')"
    assert desktop.run(f"{step}.querySelector('pre').textContent").startswith("def critical_angle(")
    assert "tracer/formulas/optics.py, line" in desktop.run(f"{step}.querySelector('em').textContent")
    assert desktop.run(f"[...{step}.querySelectorAll('li')].map(item => item.textContent.trim())") == ["θ₁ = 12°"]
    rasters = desktop.run(f"{step}.querySelectorAll('.live image, .live use').length")
    place = desktop.run(f"{step}.querySelector('.live').id")
    assert rasters >= 3 and move_to(desktop, place, 2).startswith("2; mean ")


def test_what_is_hidden_is_shown_when_it_is_asked_for_and_on_paper(desktop: Browser) -> None:
    answers = SEEN.format(json.dumps("details.answer p"))
    assert not any(desktop.run(answers))
    desktop.run("document.querySelector('summary').focus()")
    assert desktop.run("document.activeElement.textContent") == "Show the answer"
    desktop.ask("Input.dispatchKeyEvent", type="keyDown", key="Enter", text="\r", windowsVirtualKeyCode=13)
    assert desktop.run("document.querySelector('details.answer').innerText").strip().endswith("is floor.")
    desktop.run("document.querySelector('details.answer').open = false")
    desktop.run("window.dispatchEvent(new Event('beforeprint'))")
    assert all(desktop.run(f"{answers}.slice(0, 1)"))
    desktop.run("window.dispatchEvent(new Event('afterprint'))")
    assert not any(desktop.run(answers))


def test_a_phone_has_all_of_it_and_the_text_is_large_enough(browser: Browser, page: Path) -> None:
    browser.size(390, 844, phone=True)
    browser.open(page.as_uri())
    browser.run("document.querySelectorAll('details.answer').forEach(answer => answer.open = true)")
    assert browser.run("[document.documentElement.scrollWidth, window.innerWidth]") == [390, 390]
    smallest = """Math.min(...[...document.querySelectorAll('svg text')].filter(t => t.getClientRects().length)
      .map(t => t.getAttribute('font-size') * t.getScreenCTM().a))"""
    assert browser.run(smallest) >= 11.0
    sizes = (
        "[...document.querySelectorAll('button, summary, input')].filter(e => e.offsetHeight).map(e => e.offsetHeight)"
    )
    assert min(browser.run(sizes)) >= TAP
    move_to(browser, "step-1-show", 3)
    browser.run("document.querySelector('#step-1-show .tree').scrollIntoView({block: 'center'})")
    x, y = (
        browser.run("""(() => { const box = [...document.querySelectorAll('#step-1-show .tree [data-mark=hit-0] rect')]
      .find(r => r.getClientRects().length).getBoundingClientRect(); return [box.x + box.width / 2, box.y + 3]; })()""")
    )
    browser.click(x, y)
    assert browser.run(LIT) == ["t1-0"] and browser.run(ARTICLE)["path"] == "E"
    assert not messages(browser)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrasts_and_names_of_all_controls(browser: Browser, page: Path, scheme: str) -> None:
    browser.size(1280, 720)
    browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    try:
        browser.open(page.as_uri())
        browser.run("document.querySelectorAll('details.answer').forEach(answer => answer.open = true)")
        texts, edges = browser.run(CONTRASTS)
        assert texts >= 4.5 and edges >= 3.0
        ground = browser.run("getComputedStyle(document.documentElement).backgroundColor")
        assert (sum(map(int, ground[4:-1].split(","))) < 382) == (scheme == "dark")
        inks = browser.run("""[...document.querySelectorAll('#step-1-show svg text')]
          .filter(t => t.getClientRects().length).map(t => getComputedStyle(t).fill)""")
        assert min(contrast(ink, ground) for ink in inks) >= 4.5
        names = browser.named()
        assert all(name for _, name in names) and {"slider", "link", "button"} <= {role for role, _ in names}
    finally:
        browser.ask("Emulation.setEmulatedMedia", features=[])


def test_without_scripts_all_is_there_and_nothing_is_asked_of_the_network(
    browser: Browser, page: Path, handout: Handout
) -> None:
    browser.size(1280, 720)
    browser.open(page.as_uri())
    asked = [request["request"]["url"] for request in browser.said("Network.requestWillBeSent")]
    assert [url for url in asked if not url.startswith("data:image/")] == [page.as_uri()]
    assert browser.run("[typeof evil, document.scripts.length]") == ["undefined", 1]
    assert EVIL in browser.run("document.querySelector('h1').textContent")
    browser.ask("Emulation.setScriptExecutionDisabled", value=True)
    try:
        browser.open(page.as_uri())
        show = handout.pages[0].show
        for k in range(2):
            assert sorted(browser.run(TEXTS.format("step-1-show", k))) == sorted(expected_texts(show, k, show.last))
        assert not any(browser.run(SEEN.format("'.control'"))) and all(browser.run(SEEN.format("'article'")))
    finally:
        browser.ask("Emulation.setScriptExecutionDisabled", value=False)


def test_the_file_is_valid_refers_to_nothing_and_is_the_same_each_time(page: Path, handout: Handout) -> None:
    content = page.read_text("utf-8")
    assert write_page(handout, COMMAND).decode("utf-8") == content
    tree = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(content)
    elements = list(tree.iter())
    ids = [name for element in elements if (name := element.get("id"))]
    assert len(set(ids)) == len(ids)
    for element in elements:
        for name, value in element.attrib.items():
            if name in ("aria-labelledby", "aria-describedby", "data-numbers", "for"):
                assert value in ids
            elif "href" in str(name):
                assert value.startswith("data:image/") or value[1:] in ids
            assert name != "src" and name != "style" and not str(name).startswith("on")
    for figure in (element for element in elements if element.tag == "figure"):
        (svg,) = (child for child in figure.iter() if str(child.tag).endswith("svg"))
        said = next(e for e in elements if e.get("id") == svg.get("aria-describedby"))
        assert all("".join(p.itertext()).strip() for p in said) and len(said)
