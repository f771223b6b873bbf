"""The places that were looked at: Alt+Left goes back to the one before, Alt+Right forward again."""

from dataclasses import dataclass, replace
from typing import Any

from viewer.session.loading.opening import Opening


@dataclass(frozen=True)
class Place:
    """An opening that leads to it: a scene with the picked pixel and the selected ray."""

    opening: Opening
    by: object = None  # of a series, such as one drag of the mouse: only its last place is kept

    def is_in(self, opening: Opening) -> bool:
        """Whether it is a place of this scene."""
        return self.opening.lesson == opening.lesson and self.opening.is_of(opening)


class History:
    """The places in the order of time, with a position among them, as in a browser."""

    def __init__(self) -> None:
        self.places: list[Place] = []
        self.at = -1

    @property
    def now(self) -> Place | None:
        return self.places[self.at] if self.places else None

    def add(self, place: Place) -> None:
        """Go to a new place. Those that lie ahead are dropped."""
        del self.places[self.at + 1 :]
        if self.now and place.by is not None and place.by == self.now.by and self.now.is_in(place.opening):
            self.places.pop()
        self.places.append(place)
        self.at = len(self.places) - 1

    def note(self, **changes: Any) -> None:
        """Note the changes of a view's state at this place, such as the ray that is selected there."""
        if self.now:
            opening = self.now.opening
            self.places[self.at] = replace(self.now, opening=replace(opening, state=replace(opening.state, **changes)))

    def move(self, by: int) -> Place | None:
        """Go back (-1) or forward (1), and return the place; None at either end."""
        if not 0 <= self.at + by < len(self.places):
            return None
        self.at += by
        return self.now
