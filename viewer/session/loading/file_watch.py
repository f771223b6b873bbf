"""Notices that the scene's file, or a file that it names, has been saved."""

import time
from collections.abc import Iterable
from pathlib import Path

PERIOD = 0.3  # seconds between polls
SETTLED = 2  # consecutive polls that must agree: an editor may write a file in several parts
LOST = 5  # consecutive polls without a file, after which it is not just being replaced

Stamp = tuple[int, int] | None  # time of change and size; None: no such file


class FileWatch:
    """Polls the modification times and sizes of files."""

    def __init__(self) -> None:
        self.known: dict[Path, Stamp] = {}  # when the files were read
        self.seen: dict[Path, Stamp] = {}  # at the last look
        self.agreed = 0  # looks in a row with the same result
        self.told = False  # whether a lost file was reported
        self.last = 0.0

    def follow(self, path: Path) -> None:
        """Look at this file from now on, and at no other. Call it before the file is read."""
        self.known = self.seen = {path: stamp(path)}
        self.agreed, self.told = 0, False

    def follow_also(self, files: Iterable[Path]) -> None:
        """Look at these files, too: meshes, their materials and buffers. A file may be missing: it may come."""
        more = {path: stamp(path) for path in files if path not in self.known}
        self.known, self.seen, self.agreed = {**self.known, **more}, {**self.seen, **more}, 0

    def changed(self) -> bool:
        """Whether a file has changed since it was read, and is not being written any more."""
        now = time.monotonic()
        if now - self.last < PERIOD or not self.known:
            return False
        self.last = now
        stamps = {path: stamp(path) for path in self.known}
        self.agreed = self.agreed + 1 if stamps == self.seen else 1
        self.seen = stamps
        replaced = any(stamps[path] is None and stamp is not None for path, stamp in self.known.items())
        if stamps == self.known or self.agreed < SETTLED or replaced:
            return False
        self.known = stamps
        return True

    def lost(self) -> Path | None:
        """A file that was read and has been missing for some polls. It is reported once."""
        gone = [path for path, stamp in self.known.items() if stamp is not None and self.seen.get(path) is None]
        if self.told or not gone or self.agreed < LOST:
            return None
        self.told = True
        return gone[0]


def stamp(path: Path) -> Stamp:
    """The time of change and the size of a file."""
    try:
        found = path.stat()
    except OSError:
        return None
    return (found.st_mtime_ns, found.st_size)
