"""Scenes that may be shown next, prepared in the background, so that a key of the lecturer shows them at once."""

from dataclasses import dataclass
from pathlib import Path

from tracer.kernel.world import World
from viewer.lessons.sweep import STOPS
from viewer.session.loading.file_watch import Stamp, stamp
from viewer.session.loading.opening import Opening

MOST = STOPS + 8  # scenes kept: those of a sweep, and of the neighbouring steps


@dataclass(frozen=True)
class PreparedScene:
    """A scene with the state of its files when it was read."""

    opening: Opening
    world: World
    stamps: dict[Path, Stamp]


class PreparedScenes:
    """The scenes that were prepared last. A scene whose files have been saved since is not found."""

    def __init__(self) -> None:
        self.scenes: list[PreparedScene] = []

    def add(self, opening: Opening, world: World) -> None:
        own = opening.lesson.files if opening.lesson else []
        stamps = {path: stamp(path) for path in (*world.scene.files, *own)}
        self.scenes = [scene for scene in self.scenes if not scene.opening.is_of(opening)]
        self.scenes = [*self.scenes, PreparedScene(opening, world, stamps)][-MOST:]

    def find(self, opening: Opening) -> PreparedScene | None:
        for scene in self.scenes:
            if scene.opening.is_of(opening) and all(stamp(path) == was for path, was in scene.stamps.items()):
                return scene
        return None
