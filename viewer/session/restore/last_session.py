"""The last session: what was on show and where the window stood, kept in a file from one start to the next.

It is written when the window closes, and whenever the view has been left unchanged for a moment, since a computer may
crash during a lecture. The file is replaced as a whole: of two windows, the one that writes last is kept.
"""

import contextlib
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from tracer.formats.source import Fault, read_bytes
from tracer.printable import printable
from viewer.base.files import Unusable, write_atomically
from viewer.reopen.view_state import ViewState, from_texts, texts
from viewer.session.restore.command import scene_word
from viewer.session.restore.view import state_of
from viewer.session.session import Session

FORMAT = "raytree-session/1"
MOST_BYTES = 2**20
PERIOD = 0.5  # seconds between looks; a view is settled if two of them agree
FARTHEST = 10**6  # limit of a window's place and size


@dataclass(frozen=True)
class WindowPlace:
    """The place of a window's content on the screens, in their coordinates, and its size in logical pixels. In full
    screen: those to which it goes back.
    """

    x: int
    y: int
    width: int
    height: int
    full_screen: bool = False


@dataclass(frozen=True)
class LastSession:
    """A scene, as the argument that opens it, the state of its view, and the window."""

    scene: str
    state: ViewState
    window: WindowPlace | None = None


def read_last(path: Path) -> tuple[LastSession | None, str]:
    """The last session, if it was kept, and a note if it cannot be used."""
    try:
        return _last(json.loads(read_bytes(path, MOST_BYTES))), ""
    except FileNotFoundError:
        return None, ""
    except OSError as error:
        found = error.strerror or str(error)
    except Fault as fault:
        found = str(fault)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        found = printable(str(error))[:80]
    return None, f"the last session is not restored: {printable(path.name)} cannot be used ({found})"


def _last(found: dict[str, Any]) -> LastSession:
    if found["format"] != FORMAT:
        raise ValueError(f"its format must be {FORMAT}, got {str(found['format'])[:40]}")
    scene = found["scene"]
    if not isinstance(scene, str) or not scene or "\0" in scene:
        raise ValueError("its scene must be a name")
    return LastSession(scene, from_texts(found["view"]), _window(found.get("window")))


def _window(found: Any) -> WindowPlace | None:
    if found is None:
        return None
    place = WindowPlace(**{item.name: found[item.name] for item in fields(WindowPlace)})
    numbers = (place.x, place.y, place.width, place.height)
    whole = all(type(number) is int and abs(number) <= FARTHEST for number in numbers)
    if not whole or type(place.full_screen) is not bool or min(place.width, place.height) < 1:
        raise ValueError("its window must have a place and a size")
    return place


def write_last(path: Path, last: LastSession) -> None:
    """Replace the file. A file that cannot be written stays as it is."""
    content = {
        "format": FORMAT,
        "scene": last.scene,
        "view": texts(last.state),
        "window": asdict(last.window) if last.window else None,
    }
    with contextlib.suppress(Unusable):
        write_atomically(path, json.dumps(content, indent=1).encode("ascii"))


class SessionKeeper:
    """Keeps a session in a file while its window is open. `window` gives the place of the window."""

    def __init__(self, path: Path, session: Session, window: Callable[[], WindowPlace]) -> None:
        self.path, self.session, self.window = path, session, window
        self.seen: LastSession | None = None  # at the last look
        self.kept: LastSession | None = None  # in the file
        self.looked = 0.0

    def look(self) -> None:
        """Write the session if it has changed, and has not since the look before. Cheap: called every frame."""
        now = time.monotonic()
        if now - self.looked < PERIOD:
            return
        self.looked = now
        current = self._current()
        if current == self.seen:
            self._keep(current)
        self.seen = current

    def close(self) -> None:
        """Write the session: of several windows, the last one that is closed is kept."""
        self.kept = None
        self._keep(self._current())

    def _current(self) -> LastSession | None:
        opening = self.session.opening
        if not opening or not self.session.world:
            return None  # nothing has been on show: what was kept stays
        scene = scene_word(opening.path, opening.lesson, opening.figure)
        return LastSession(scene, state_of(self.session), self.window())

    def _keep(self, current: LastSession | None) -> None:
        if current and current != self.kept:
            write_last(self.path, current)
            self.kept = current
