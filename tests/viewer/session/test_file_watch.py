"""The files of the scene on show: a change is noticed when the file is whole, a loss when it lasts."""

from pathlib import Path

import pytest

from viewer.session.loading import file_watch
from viewer.session.loading.file_watch import LOST, SETTLED, FileWatch


@pytest.fixture
def watch(monkeypatch: pytest.MonkeyPatch) -> FileWatch:
    monkeypatch.setattr(file_watch, "PERIOD", 0.0)  # every look is a poll
    return FileWatch()


def test_a_file_that_is_known_later_is_not_lost(watch: FileWatch, tmp_path: Path) -> None:
    """A mesh is known when the scene has been read: the polls before say nothing of it."""
    scene, mesh = tmp_path / "scene.toml", tmp_path / "mesh.obj"
    scene.write_text("1")
    mesh.write_text("1")
    watch.follow(scene)
    for _ in range(2 * LOST):
        assert not watch.changed()
    watch.follow_also([mesh])
    for _ in range(2 * LOST):
        assert watch.lost() is None and not watch.changed()
    mesh.unlink()
    told = [watch.lost() for _ in range(2 * LOST) if not watch.changed()]
    assert told == [None] * (LOST - 1) + [mesh] + [None] * LOST  # once


def test_a_change_is_told_once_when_it_has_settled(watch: FileWatch, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text("1")
    watch.follow(scene)
    for length in (22, 333, 4444):  # an editor that writes it in parts
        scene.write_text("2" * length)
        assert not watch.changed()
    assert [watch.changed() for _ in range(4)] == [False] * (SETTLED - 2) + [True] + [False] * (5 - SETTLED)


def test_a_file_that_is_replaced_is_neither_lost_nor_read_while_it_is_gone(watch: FileWatch, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text("1")
    watch.follow(scene)
    scene.unlink()
    for _ in range(LOST - 1):
        assert not watch.changed() and watch.lost() is None
    scene.write_text("22")
    assert [watch.changed() for _ in range(SETTLED)] == [False] * (SETTLED - 1) + [True]
    assert watch.lost() is None
