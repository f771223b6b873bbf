"""The small lesson, read once."""

import pytest

from tests.viewer.handout.sample import write_lesson
from viewer.handout.document import Handout
from viewer.handout.reading import read_handout
from viewer.lessons.lesson import read_file


@pytest.fixture(scope="session")
def handout(tmp_path_factory: pytest.TempPathFactory) -> Handout:
    return read_handout(read_file(write_lesson(tmp_path_factory.mktemp("lessons") / "glass") / "lesson.md"))
