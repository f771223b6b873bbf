"""Scenes that may be shown next, prepared in the background, so that a key of the lecturer shows them at once."""

from dataclasses import dataclass
from pathlib import Path

from tracer.kernel.world import World
from viewer.session.loading.file_watch import Stamp, stamp
from viewer.session.loading.opening import Opening, SceneKey

MOST = 6  # scenes kept, besides those of the sweep that is on show


@dataclass(frozen=True)
class PreparedScene:
    """A scene with the state of its files when it was read."""

    opening: Opening
    key: SceneKey  # of its opening, which would make it anew each time
    world: World
    stamps: dict[Path, Stamp]


class PreparedScenes:
    """The scenes that were prepared last. A scene whose files have been saved since is not found."""

    def __init__(self) -> None:
        self.scenes: list[PreparedScene] = []

    def add(self, opening: Opening, world: World) -> None:
        own = opening.lesson.files if opening.lesson else []
        stamps = {path: stamp(path) for path in (*world.scene.files, *own)}
        key = opening.scene_key
        others = [scene for scene in self.scenes if scene.key != key]
        stops = [scene for scene in others if scene.opening.keeps_view]
        steps = [scene for scene in others if not scene.opening.keeps_view]
        new = [PreparedScene(opening, key, world, stamps)]
        self.scenes = [*steps, *stops, *new] if opening.keeps_view else [*stops, *[*steps, *new][-MOST:]]

    def leave_others(self, opening: Opening) -> None:
        """Drop the scenes of sweeps in other steps than that of this opening."""
        place = (opening.lesson, opening.moment.step)
        self.scenes = [
            scene
            for scene in self.scenes
            if not scene.opening.keeps_view or (scene.opening.lesson, scene.opening.moment.step) == place
        ]

    def find(self, opening: Opening) -> PreparedScene | None:
        key = opening.scene_key
        for scene in self.scenes:
            if scene.key == key and all(stamp(path) == was for path, was in scene.stamps.items()):
                return scene
        return None
