"""Moves the sweep of a lesson's step: by itself in some seconds, or by its handle."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

from tracer.kernel.world import World
from viewer.lessons.sweep import STOPS, Sweep
from viewer.session.loading.opening import Opening
from viewer.session.loading.scene_loader import SceneLoader

SECONDS = 4.0  # of a sweep that moves by itself
FRAME = 1 / 30  # seconds between its places


class Swept(Protocol):
    """The parts of a session that a sweep changes."""

    loader: SceneLoader
    pixel: tuple[int, int] | None
    between: tuple[float, float] | None

    @property
    def opening(self) -> Opening | None: ...
    def show_swept(self, opening: Opening) -> None: ...


class Sweeping:
    """The sweep of the step on show."""

    def __init__(self, session: Swept) -> None:
        self.session = session
        self.is_playing = False
        self._began = math.nan  # on the clock of `advance`; NaN: at its next call

    @property
    def sweep(self) -> Sweep | None:
        opening = self.session.opening
        return opening.step.state.sweep if opening and opening.step else None

    @property
    def share(self) -> float:
        """How far it has gone, 0 to 1."""
        return self.session.opening.share if self.session.opening else 0.0

    @property
    def is_left(self) -> bool:
        """Whether another place of the image is picked than its own."""
        if not self.sweep or not self.sweep.is_pixel:
            return False
        own = (self.sweep.pixel(self.share), self.sweep.between(self.share))
        return (self.session.pixel, self.session.between) != own

    def play(self) -> None:
        """Move it from its beginning to its end."""
        self.is_playing, self._began = self.sweep is not None, math.nan

    def stop(self) -> None:
        """Leave it where it is."""
        self.is_playing = False

    def finish(self) -> bool:
        """Go to the end, if it moves by itself. Returns whether it did."""
        was_playing = self.is_playing
        self.stop()
        if was_playing:
            self.move_to(1.0)
        return was_playing

    def advance(self, now: float) -> bool:
        """Go on at the time `now`, in seconds of any clock that does not go back. Returns whether it has moved. Scenes
        that are not prepared yet are skipped.
        """
        if not self.is_playing:
            return False
        if math.isnan(self._began):
            self._began = now
        share = (now - self._began) / SECONDS
        if share >= 1.0:
            return self.finish()
        opening = self._opening(share)
        if opening is None or opening == self.session.opening or not self._is_ready(opening):
            return False
        self.session.show_swept(opening)
        return True

    def wait(self) -> float:
        """Seconds until it goes on; inf if it does not move by itself."""
        return FRAME if self.is_playing else math.inf

    def move_to(self, share: float) -> None:
        """Show this share of the way."""
        opening = self._opening(min(max(share, 0.0), 1.0))
        if opening and (opening != self.session.opening or self.is_left):
            self.session.show_swept(opening)

    def prepare(self, then: Callable[[World], object]) -> None:
        """Prepare the scenes of the way in the background, the first ones first. `then` is called after each."""
        if self.sweep and not self.sweep.is_pixel:
            for k in range(STOPS + 1):
                opening = self._opening(k / STOPS)
                if opening and not self._is_ready(opening):
                    self.session.loader.prepare(opening, then)

    def _is_ready(self, opening: Opening) -> bool:
        sweep = self.sweep
        return sweep is None or sweep.is_pixel or self.session.loader.prepared.find(opening) is not None

    def _opening(self, share: float) -> Opening | None:
        """The opening of the nearest place at which the sweep can stand."""
        opening, sweep = self.session.opening, self.sweep
        if not opening or not sweep:
            return None
        share = sweep.stop(share)
        asked = replace(opening, state=replace(opening.state, swept=None))
        # The ends are the moments of the lesson: they have no share of their own.
        state = replace(opening.state, swept=None if asked.share == share else share)
        if sweep.is_pixel:
            state = replace(state, pixel=sweep.pixel(share))
        return replace(opening, state=state, sets_view=False, shows_stage=False, keeps_view=True)
