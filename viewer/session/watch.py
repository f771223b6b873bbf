"""Notices when the scene's file, or a mesh it names, has been saved."""

import time
from pathlib import Path

from tracer.scene import Scene
from tracer.shapes.mesh import Mesh

EVERY = 0.3  # seconds between looks
SETTLED = 2  # looks in a row that must agree: an editor may write in several strokes

Stamp = tuple[int, int] | None  # when and how large; None: not there


class Watch:
    def __init__(self) -> None:
        self.known: dict[Path, Stamp] = {}  # as the files were when they were read
        self.seen: dict[Path, Stamp] = {}
        self.agreed = 0
        self.last = 0.0

    def follow(self, path: Path) -> None:
        """This file is about to be read: look at it from now on, and at no other."""
        self.known = self.seen = {path: _stamp(path)}
        self.agreed = 0

    def follow_meshes(self, path: Path, scene: Scene) -> None:
        """Look also at the files that the scene in `path` has been read from."""
        names = {item.shape.file for item in scene.objects if isinstance(item.shape, Mesh)}
        self.known = {**{path.parent / name: _stamp(path.parent / name) for name in names}, **self.known}

    def changed(self) -> bool:
        """Whether a file is another than when it was read, and its writer has come to rest."""
        now = time.monotonic()
        if now - self.last < EVERY or not self.known:
            return False
        self.last = now
        stamps = {path: _stamp(path) for path in self.known}
        self.agreed = self.agreed + 1 if stamps == self.seen else 1
        self.seen = stamps
        if stamps == self.known or self.agreed < SETTLED or None in stamps.values():
            return False
        self.known = stamps
        return True


def _stamp(path: Path) -> Stamp:
    try:
        found = path.stat()
    except OSError:
        return None
    return (found.st_mtime_ns, found.st_size)
