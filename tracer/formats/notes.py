"""Notes of a reader: what a file has and the scene has not. One line for each kind, with a count."""

from tracer.printable import printable
from tracer.scene.notes import listed


class Notes:
    """Collects notes. Equal ones are counted."""

    def __init__(self) -> None:
        self._counts: dict[str, int] = {}
        self._names: dict[str, dict[str, None]] = {}

    def count(self, text: str, n: int = 1) -> None:
        """Add n things to the note `text`, which is followed by their number."""
        if n:
            self._counts[text] = self._counts.get(text, 0) + n

    def name(self, text: str, name: str) -> None:
        """Add a name to the list that follows the note `text`."""
        self._names.setdefault(text, {})[printable(name)] = None

    def say(self, text: str) -> None:
        """Add a note without a count."""
        self._names.setdefault(text, {})

    def lines(self) -> list[str]:
        """The notes, in the order in which their kinds were first added: named ones, then counted ones."""
        named = [f"{text}: {listed(list(names))}" if names else text for text, names in self._names.items()]
        return named + [f"{text}: {n}" for text, n in self._counts.items()]
