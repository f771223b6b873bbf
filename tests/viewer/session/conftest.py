"""The lesson that tests of giving one share."""

from pathlib import Path

import pytest

from tests.viewer.session.given import TEXT
from viewer.lessons.lesson import Lesson, read_file
from viewer.lessons.skeleton import SCENE


@pytest.fixture
def mine(tmp_path: Path) -> Lesson:
    (tmp_path / "scene.toml").write_text(SCENE, "utf-8")
    (tmp_path / "lesson.md").write_text(TEXT, "utf-8")
    return read_file(tmp_path / "lesson.md")
