"""A click has the limit of rows of its image. A tree that is too large to draw is folded, never traced with another."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import tracer
from tests.viewer.cli.test_limits import MIRRORS
from tests.viewer.driver import Driver, viewer
from tests.viewer.session.test_convergence import refine
from tracer.kernel import limits
from viewer.figures import ray_lines
from viewer.panels import draw


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """All texts that panels draw."""
    found, text = [], draw.text

    def note(pad: object, at: object, color: object, content: str, *more: object) -> None:
        found.append(content)
        text(pad, at, color, content, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(draw, "text", note)
    return found


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Driver]:
    (tmp_path / "mirrors.toml").write_text(MIRRORS)
    with viewer() as driver:
        yield driver


def test_click_ends_where_the_image_ends(
    room: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, said: list[str]
) -> None:
    """Bit for bit, for every limit of rows, at several depths; and the image says that its trees were ended."""
    session = room.session
    for rows in (7, 40):
        monkeypatch.setattr(limits, "MAX_RAYS", 64 * 48 * rows)
        monkeypatch.setattr(limits, "LEAST_ROWS", 1)
        room.open_file(tmp_path / "mirrors.toml")
        for depth in (5, 30):
            session.set_depth(depth)
            session.image.wait()
            picture = session.image.picture
            assert picture
            ended = 0
            for x, y in np.ndindex(64, 48):
                if (x + y) % 31 == 0:
                    session.pick(x, y)
                    assert session.tree
                    assert session.tree.max_nodes == picture.max_nodes == rows
                    assert session.tree.radiance.tobytes() == picture.pixels[y, x].tobytes()
                    ended += session.tree.is_limited
            assert (ended > 0) == (rows < 2 * depth)
            assert picture.limited == (64 * 48 if rows < 2 * depth else 0)
            said.clear()
            room.frames()
            note = f"3,072 pixels stopped at the limit of {rows} rays"
            assert (note in said) == (rows < 2 * depth)
    refine(room, 4)
    room.frames()
    assert session.image.picture
    assert f"{session.image.picture.limited:,} samples stopped at the limit of 40 rays" in said
    assert session.image.picture.limited >= 4 * 3072


def test_tree_that_is_too_large_is_folded_when_drawn(
    room: Driver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, said: list[str]
) -> None:
    """The table has every row. The heaviest are drawn, with the selected ray and its ancestors, and that is said."""
    monkeypatch.setattr(ray_lines, "MOST_DRAWN", 300)
    room.open_file(tmp_path / "mirrors.toml")
    session = room.session
    session.pick(30, 20)
    session.set_depth(1000)
    room.frames()
    assert session.tree and session.world
    whole = tracer.trace(session.world, (30, 20), depth=1000)
    assert len(whole) == 2002
    assert session.tree.nodes.tobytes() == whole.nodes.tobytes()
    assert room.canvas.drawn == 300
    assert {line.row for line in room.canvas.lines} <= set(range(300))
    shares = [re.fullmatch(r"\+(\d+) rays?(, .* %)?", text.content) for text in room.tree_texts()]
    assert len(room.canvas.nodes) + sum(int(share[1]) for share in shares if share) == len(whole)
    assert "the heaviest 300 of 2,002 rays are drawn" in said
    last = max(i for i in range(len(whole)) if whole.kind(i) != "shadow")
    session.select(last)
    room.frames()
    assert last in {line.row for line in room.canvas.lines}
