"""Catches exceptions in parts of a frame, so that a bug does not end a lecture: it becomes a message."""

import traceback
from collections.abc import Callable
from pathlib import Path

HOME = Path(__file__).parent.parent.parent


class Guard:
    """Every exception that was caught, and the parts of the window that are closed since they failed twice."""

    def __init__(self, report: Callable[[list[str]], object]) -> None:
        self.report = report  # shows messages
        self.caught: list[str] = []  # a line each
        self.closed: dict[str, str] = {}  # a part's name, and the message

    def run(
        self, part: str, act: Callable[[], object], recover: Callable[[], object] = lambda: None, closes: bool = True
    ) -> bool:
        """Run `act`, which draws or updates a part, unless the part is closed. If it fails, run `recover` and report
        it. If it fails in the same way again, the part is closed, if it `closes`. Returns False if it failed now.
        """
        if part in self.closed:
            return True
        try:
            act()
        except Exception as error:
            recover()
            fault = f"{part}: {described(error)}"
            if closes and fault in self.caught:
                self.closed[part] = fault
                self.report([f"{fault}; it is closed until another scene is opened or the panels are reset"])
            else:
                self.report([fault])
            self.caught.append(fault)
            return False
        return True

    def open_all(self) -> None:
        """Open what is closed: it may work again."""
        self.closed.clear()


def described(error: Exception) -> str:
    """An exception in a line, with its place in our files."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if HOME in Path(frame.filename).parents]
    place = f" ({Path(frames[-1].filename).relative_to(HOME).as_posix()}, line {frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())}{place}"
