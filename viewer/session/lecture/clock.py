"""The time since a lesson began, for the window of the speaker."""

import time
from pathlib import Path

from viewer.lessons.lesson import Lesson
from viewer.lessons.moments import Moment


class LessonClock:
    """Begins when a lesson is opened, and again when its first moment is shown again, as after a rehearsal."""

    def __init__(self) -> None:
        self.began = 0.0  # of time.monotonic()
        self._seen: tuple[Path | None, bool] = (None, True)  # the lesson, and whether it is at its first moment

    def look(self, lesson: Lesson | None, moment: Moment) -> None:
        """Note what is on show. Called in every frame."""
        seen = (lesson.path if lesson else None, moment == Moment())
        if seen != self._seen and (seen[0] != self._seen[0] or seen[1]):
            self.began = time.monotonic()
        self._seen = seen

    @property
    def seconds(self) -> int:
        """Whole seconds since the lesson began."""
        return int(time.monotonic() - self.began)
