"""One scene's image by POV-Ray and by raytree: the same size, depth and cut-off, two threads each.

POV-Ray counts the camera ray as a level. Its "Trace Time" is compared with our `seconds["trace"]`: neither includes
reading the scene.
"""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import tracer
from benchmarks.results.figure import in_turn
from tests import povray
from tracer.image.warmup import warm_up
from tracer.scene import Scene

THREADS = 2


@dataclass(frozen=True)
class Race:
    """A scene for both programs."""

    scene: Scene
    source: str  # the same for POV-Ray
    size: tuple[int, int]
    depth: int
    min_weight: float = 0.0
    options: Sequence[str] = ()  # further options of POV-Ray

    def times(self, runs: int) -> tuple[list[float], list[float]]:
        """(ours, theirs) in seconds, run by run."""
        warm_up()
        world = tracer.prepare(self.scene)
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = in_turn(
                runs,
                lambda: self.ours(world).seconds["trace"],
                lambda: povray.render(self.source, self.size, Path(folder), THREADS, self.options)[1],
            )
        return ours, theirs

    def counts(self) -> tuple[dict[str, int], dict[str, int]]:
        """(ours, theirs): rays by kind."""
        with tempfile.TemporaryDirectory() as folder:
            _, _, theirs = povray.render(self.source, self.size, Path(folder), THREADS, self.options)
        return self.ours(tracer.prepare(self.scene)).rays, theirs

    def ours(self, world: tracer.World) -> tracer.Image:
        return tracer.render(
            world, self.size, depth=self.depth, threads=THREADS, min_weight=self.min_weight, model="whitted"
        )


def need_povray() -> None:
    if not povray.available():
        raise RuntimeError("POV-Ray is needed: the Debian package povray")
