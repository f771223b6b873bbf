"""HTML pages in a real browser: pointing, keys, phones, screen readers, hostile names; and their files."""

import json
import math
import re
from pathlib import Path

import html5lib
import numpy as np
import pytest

import tracer
from tests.scenes import named_scene
from tests.viewer.chromium import Browser
from tracer.kernel.nodes import SHADOW
from tracer.printable import printable
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame, initial_orbit
from viewer.base.theme import THEMES
from viewer.cli.main import main
from viewer.explain.formulas import Lecture
from viewer.explain.plain_formula import plain
from viewer.figures.pages import pages, with_upright
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.lessons import lesson

LESSON = "glass-ball"
DEPTHS = range(2, 4)
TAP = 24.0  # pixels: the least size of a target (WCAG 2.2, 2.5.8)
EVIL = "<script>evil=1</script><img src=x onerror=evil=2>\"'&amp;</style>--></svg>\x1b[2J\u202e"
VISIBLE = "document.querySelector('.page:not([hidden])')"
MARKS = f"[...{VISIBLE}.querySelectorAll('.on')].filter(mark => mark.getClientRects().length)"
LIT = f"[...new Set({MARKS}.map(mark => mark.dataset.ray))]"
STATUS = "document.querySelector('[role=status]').textContent"
# The one article on show, as {name: value}, with its title under "".
ARTICLE = """(() => {
  const shown = [...document.querySelectorAll('article')].filter(a => a.offsetHeight);
  if (shown.length !== 1) return shown.length;
  const rows = [...shown[0].querySelectorAll(':scope > dl > div')].map(row => [
    row.querySelector('[aria-label]')?.getAttribute('aria-label') ?? row.querySelector('dt').textContent,
    row.querySelector('dd').textContent]);
  return Object.fromEntries([['', shown[0].querySelector('h3').textContent], ...rows]);
})()"""
# Ratio of the relative luminances (WCAG 2, 1.4.3) of each text outside the figures to what is behind it.
CONTRASTS = """(() => {
  const numbers = color => color.match(/[\\d.]+/g).map(Number);
  const luminance = color => numbers(color).slice(0, 3).map(c => c / 255)
    .map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0);
  const behind = element => {
    const color = getComputedStyle(element).backgroundColor;
    return numbers(color)[3] === 0 ? behind(element.parentElement) : color;
  };
  const ratio = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  const texts = [...document.querySelectorAll('body *')].filter(e => !e.closest('svg')
    && [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim()));
  const edges = [...document.querySelectorAll('button')];
  return [Math.min(...texts.map(e => ratio(getComputedStyle(e).color, behind(e)))),
          Math.min(...edges.map(e => ratio(getComputedStyle(e).borderTopColor, behind(e.parentElement))))];
})()"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Scene and tree of a lesson, at these depths."""
    path = tmp_path_factory.mktemp("pages") / "both.html"
    assert main(["export", LESSON, "--figure", "both", "--depth", f"{DEPTHS[0]}..{DEPTHS[-1]}", "-o", str(path)]) == 0
    return path


@pytest.fixture(scope="module")
def trees(worlds: dict[str, tracer.World]) -> list[RayTree]:
    return [tracer.trace(worlds[LESSON], lesson.read(LESSON).first.state.pixel, depth=d) for d in DEPTHS]


def middle(browser: Browser, selector: str) -> tuple[float, float]:
    """The middle of an element of the page on show, in pixels."""
    box = browser.run(f"{VISIBLE}.querySelector({json.dumps(selector)}).getBoundingClientRect().toJSON()")
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def messages(browser: Browser) -> list[dict]:
    """Errors and warnings of the page."""
    kinds = ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")
    return [message for kind in kinds for message in browser.said(kind)]


def agrees(shown: str, number: float) -> bool:
    """The number shown is that of a table, up to half a unit of its last digit."""
    if math.isnan(number):
        return shown == "–"
    text = shown.replace("−", "-").rstrip("°")
    unit = 10.0 ** -len(re.sub(r"e.*", "", text).partition(".")[2]) * 10.0 ** int(text.partition("e")[2] or 0)
    return abs(float(text) - number) <= 0.5 * unit * (1.0 + 1e-9)


def test_pointing_lights_the_ray_in_scene_and_tree_and_shows_its_numbers(
    desktop: Browser, trees: list[RayTree]
) -> None:
    for tree in trees:
        for row in np.flatnonzero(tree.nodes["kind"] != SHADOW).tolist():
            desktop.move(*middle(desktop, f"[data-mark=hit-{row}] rect"))
            assert desktop.run(LIT) == [str(row)]
            parts = desktop.run(f"{MARKS}.map(mark => mark.dataset.mark)")
            assert parts.count(f"ray-{row}") == 2 and f"hit-{row}" in parts  # in the scene and in the tree
            shown, node = desktop.run(ARTICLE), tree.nodes[row]
            assert shown[""].endswith(f" {tree.label(row)}") and shown["path"] == tree.path(row)
            assert shown["object"] == (tree.object_name(row) or "none")
            assert agrees(shown["distance t"], float(node["t"]))
            for name in ("radiance", "weight", "factor"):
                texts = shown[name].split()  # one number for three that are equal
                assert all(map(agrees, texts * (3 // len(texts)), map(float, node[name])))
            indices, angles = (node["n1"], node["n2"]), np.degrees([node["theta1"], node["theta2"]])
            for name, ends in ((plain(Lecture.INDICES), indices), (plain(Lecture.ANGLES), angles)):
                texts = shown[name].split(" → ")  # one number for two that are equal, or of which one does not exist
                assert agrees(texts[0], float(ends[0])) and (len(texts) == 1 or agrees(texts[1], float(ends[1])))
            assert (plain(Lecture.RADICAND) in shown) == (not math.isnan(node["radicand"]))
            assert agrees(shown.get(plain(Lecture.RADICAND), "–"), float(node["radicand"]))
        desktop.key("PageDown")
    desktop.move(1, 1)
    assert desktop.run(LIT) == [] and desktop.run(ARTICLE)[""] == shown[""]  # the numbers stay, to be read


def test_a_line_can_be_pointed_at_from_beside_it_and_a_click_keeps_it(desktop: Browser, trees: list[RayTree]) -> None:
    desktop.run("location.hash = '#2'")
    for row in np.flatnonzero(trees[-1].nodes["kind"] == SHADOW)[:2].tolist():
        ends = f"""(() => {{ const line = {VISIBLE}.querySelector('[data-mark=ray-{row}] path');
          return [0.5, 0.55].map(share => line.getPointAtLength(share * line.getTotalLength())
            .matrixTransform(line.getScreenCTM())).map(p => [p.x, p.y]); }})()"""
        (x, y), (x1, y1) = desktop.run(ends)
        away = 3.0 / math.hypot(x1 - x, y1 - y)
        desktop.move(x + away * (y1 - y), y - away * (x1 - x))
        assert desktop.run(LIT) == [str(row)]
    desktop.click(*middle(desktop, "[data-mark=hit-0] rect"))
    desktop.move(1, 1)
    assert desktop.run(LIT) == ["0"]
    desktop.key("Home")  # it is kept on another page
    assert desktop.run(LIT) == ["0"] and desktop.run(ARTICLE)["depth"] == "0"
    desktop.key("Escape")
    assert desktop.run(LIT) == []


def test_keys_go_from_page_to_page_and_from_ray_to_ray(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    assert main(["export", LESSON, "--step", "levels", "--depth", "2", "-o", str(path)]) == 0  # 3 levels and 5 sums
    browser.size(1280, 720)
    browser.open(f"{path.as_uri()}#3")
    said = [browser.run(STATUS)]
    for key in ("PageDown", "ArrowRight", "Home", "ArrowRight", "End", "PageUp", "ArrowLeft"):
        browser.key(key)
        said.append(browser.run(f"{STATUS} + location.hash + document.querySelectorAll('.page:not([hidden])').length"))
    order = (4, 5, 1, 2, 8, 7, 6)
    assert said == ["Position 3 of 8", *(f"Position {k} of 8#{k}1" for k in order)]
    reached = []
    for _ in range(3):
        browser.key("Tab")
        reached.append(browser.run("document.activeElement.dataset.ray ?? document.activeElement.textContent"))
    assert reached == ["0", "Previous", "Next"]
    browser.key("Tab", shift=True)
    browser.key("Tab", shift=True)
    for row in range(1, 4):
        browser.key("ArrowDown")
        assert browser.run("document.activeElement.dataset.ray") == str(row) and browser.run(LIT) == [str(row)]
    browser.key("Enter")
    assert browser.run("document.activeElement.getAttribute('aria-pressed')") == "true"
    browser.key("PageDown")
    assert browser.run(f"{VISIBLE}.contains(document.activeElement) && document.activeElement.dataset.ray") == "3"
    browser.key("Tab")
    assert browser.run(LIT) == ["3"]  # kept
    assert browser.run("document.activeElement.textContent") == "Previous"


@pytest.mark.parametrize("figure", ["both", "hit"])
def test_a_phone_has_all_of_it(browser: Browser, page: Path, figure: str, tmp_path: Path) -> None:
    path = page if figure == "both" else tmp_path / "a.html"
    if figure == "hit":
        assert main(["export", LESSON, "--figure", figure, "--depth", "2..3", "-o", str(path)]) == 0
    browser.size(360, 740, phone=True)
    browser.open(path.as_uri())
    scrolled = "[document.documentElement.scrollWidth, window.innerWidth, document.scrollingElement.clientWidth]"
    assert browser.run(scrolled) == [360, 360, 360]
    smallest = f"""Math.min(...[...{VISIBLE}.querySelectorAll('text')].filter(text => text.getClientRects().length)
      .map(text => text.getAttribute('font-size') * text.getScreenCTM().a))"""
    assert browser.run(smallest) >= 12.0
    x, y = middle(browser, ".upright svg")
    browser.touch((x + 100, y), (x, y + 5), (x - 100, y + 5))
    assert browser.run(STATUS) == "Position 2 of 2"
    browser.touch((x - 100, y), (x, y + 5), (x + 100, y))
    assert browser.run(STATUS) == "Position 1 of 2"
    sizes = "[...document.querySelectorAll('button, summary')].filter(e => e.offsetHeight).map(e => e.offsetHeight)"
    assert min(browser.run(sizes)) >= TAP
    browser.click(*middle(browser, ".upright svg [data-mark=ray-0] path"))
    numbers = browser.run("document.querySelector('.numbers').getBoundingClientRect().toJSON()")
    assert browser.run(LIT) == ["0"]
    assert (
        370.0 < numbers["top"] < 600.0 < numbers["bottom"] <= 740.0
    )  # the lower half of the screen, without scrolling
    browser.size(740, 360, phone=True)
    browser.run("document.querySelector('.enlarge').scrollIntoView({block: 'center'})")
    browser.click(*middle(browser, ".enlarge"))
    assert browser.run(smallest) >= 12.0 and browser.run(scrolled) == [740, 740, 740]
    assert not messages(browser)


@pytest.mark.parametrize("theme", THEMES)
def test_it_can_be_read_and_every_control_has_a_name(browser: Browser, theme: str, tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    assert main(["export", LESSON, "--theme", theme, "--depth", "1..2", "-o", str(path)]) == 0
    browser.size(1280, 720)
    browser.open(path.as_uri())
    desktop_names = browser.named()
    assert all(name for _, name in desktop_names)
    rays = [name for role, name in desktop_names if role == "button" and ": " in name]
    assert any(name.startswith("E: camera ray, meets glass ball, weight 1") for name in rays)
    browser.click(*middle(browser, "[data-mark=hit-0] rect"))
    for key in ("Home", "End"):  # with other buttons that have no effect
        browser.key(key)
        texts, edges = browser.run(CONTRASTS)
        assert texts >= 4.5 and edges >= 3.0
    roles = browser.run("[...document.querySelectorAll('svg[aria-labelledby]')].map(svg => svg.role)")
    assert roles == ["group"] * 4  # two pages, each also for a phone
    landmarks = "['header h1', 'main', 'nav[aria-label]', 'section.numbers[aria-labelledby]', 'footer']"
    assert browser.run(f"{landmarks}.every(place => document.querySelectorAll(place).length === 1)")


def test_paper_and_a_browser_without_scripts_have_all_pages_and_numbers(browser: Browser, page: Path) -> None:
    shown = "[...document.querySelectorAll('{}')].map(e => e.offsetHeight > 0)"
    browser.size(1280, 720)
    browser.open(page.as_uri())
    browser.ask("Emulation.setEmulatedMedia", media="print")
    assert browser.run(shown.format(".page")) == [True] * 2 and browser.run(shown.format("nav")) == [False]
    still = [{"name": "prefers-reduced-motion", "value": "reduce"}, {"name": "forced-colors", "value": "active"}]
    browser.ask("Emulation.setEmulatedMedia", media="", features=still)
    assert browser.run("getComputedStyle(document.querySelector('[data-ray]')).transitionDuration") == "0s"
    assert browser.run("getComputedStyle(document.querySelector('.canvas svg')).forcedColorAdjust") == "none"
    browser.ask("Emulation.setEmulatedMedia", media="", features=[])
    browser.ask("Emulation.setScriptExecutionDisabled", value=True)
    try:
        browser.open(page.as_uri())
        assert browser.run(shown.format(".page")) == [True] * 2
        articles = browser.run(shown.format("article"))
        assert len(articles) > 19 and all(articles)
        assert browser.run("[...document.querySelectorAll('.canvas svg')].every(svg => svg.role === 'img')")
    finally:
        browser.ask("Emulation.setScriptExecutionDisabled", value=False)


def test_hostile_names_stay_text_and_nothing_is_asked_of_the_network(browser: Browser, tmp_path: Path) -> None:
    scene, path = tmp_path / "scene.toml", tmp_path / "a.html"
    scene.write_text(named_scene(EVIL), "utf-8")
    assert main(["export", str(scene), "--figure", "both", "--pixel", "20,15", "--depth", "0..2", "-o", str(path)]) == 0
    browser.size(1280, 720)
    browser.open(path.as_uri())
    browser.click(*middle(browser, "[data-mark=hit-0] rect"))
    assert printable(EVIL) in browser.run("document.querySelector('h1').textContent")
    assert browser.run("[typeof evil, document.scripts.length]") == ["undefined", 1]
    assert browser.run(ARTICLE)["object"] == printable(EVIL)
    assert [request["request"]["url"] for request in browser.said("Network.requestWillBeSent")] == [path.as_uri()]
    assert not messages(browser)
    # The policy holds: neither a script nor a style, a picture or a request that is put into the page does anything.
    browser.run('document.body.innerHTML += \'<img src=x onerror="evil=1"><p style="color: red">\'')
    assert browser.run("fetch('data:,').then(() => 'sent', () => 'refused')") == "refused"
    assert browser.run("[typeof evil, getComputedStyle([...document.querySelectorAll('p')].at(-1)).color]") == [
        "undefined",
        browser.run("getComputedStyle(document.body).color"),
    ]
    html5lib.HTMLParser(strict=True).parse(path.read_text("utf-8"))


@pytest.mark.parametrize("figure", ["tree", "hit"])
def test_the_file_is_valid_refers_to_nothing_and_is_the_same_each_time(
    worlds: dict[str, tracer.World], figure: str, tmp_path: Path
) -> None:
    files = [tmp_path / name for name in ("a.html", "b.html")]
    for file in files:
        assert main(["export", "underwater", "--figure", figure, "--depth", "1..2", "-o", str(file)]) == 0
    content = files[0].read_text("utf-8")
    assert content == files[1].read_text("utf-8")
    tree = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(content)
    elements = list(tree.iter())
    ids = [name for element in elements if (name := element.get("id"))]
    assert len(set(ids)) == len(ids)
    for element in elements:
        for name, value in element.attrib.items():
            if name in ("aria-labelledby", "aria-describedby", "data-numbers"):
                assert value in ids
            elif "href" in str(name):
                assert value[0] == "#" and value[1:] in ids
            assert name != "src" and name != "style" and not str(name).startswith("on")
    found = lesson.read("underwater")
    world = worlds["underwater"]
    steps = by_depth([tracer.trace(world, found.first.state.pixel, depth=d) for d in range(1, 3)])
    subject = Subject(steps, world, initial_orbit(world, Frame.of(world), found.first.state.view))
    style = FigureStyle()
    drawn = with_upright(pages(figure, subject, style), figure, subject, style)
    drawings = [element for element in elements if element.get("aria-describedby")]
    for drawing, one in zip(drawings, [one for page in drawn for one in (page, *page.upright)], strict=True):
        names = [element.get("data-mark") for element in drawing.iter() if element.get("data-mark")]
        assert names == [name for name, _, _ in one.groups()]
