"""Small images of the scene on show at several depths, for the live pieces of lessons: traced aside, and kept."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np

from tracer.image.passes import Stopped
from tracer.kernel.world import World
from viewer.lessons.live.pieces.difference import small_image
from viewer.session.image_renderer import lower_priority

Key = tuple[int, str]  # depth, model


class SmallImages:
    """Those of one scene. `post` gives a call to the window's thread."""

    def __init__(self, post: Callable[[Callable[[], object]], object]) -> None:
        self.post = post
        self.world: World | None = None
        self.kept: dict[Key, np.ndarray] = {}
        self.asked: dict[Key, Future[None]] = {}
        self.runner = ThreadPoolExecutor(1, initializer=lower_priority)

    def get(self, world: World, depth: int, model: str) -> np.ndarray | None:
        """The image, linear light (height, width, 3); None if it is not there yet: then it is traced."""
        if world is not self.world:
            self.world, self.kept, self.asked = world, {}, {}
        key = (depth, model)
        if key not in self.kept and key not in self.asked:
            self.asked[key] = self.runner.submit(self._trace, world, key)
        return self.kept.get(key)

    @property
    def is_at_rest(self) -> bool:
        """Whether all that were asked for are there."""
        return self.asked.keys() <= self.kept.keys()

    def wait(self) -> None:
        """Wait for those that were asked for. The calls that bring them are posted then."""
        for future in tuple(self.asked.values()):
            future.result()

    def close(self) -> None:
        self.world = None
        self.runner.shutdown()

    def _trace(self, world: World, key: Key) -> None:
        depth, model = key

        def keep(pixels: np.ndarray) -> None:
            if world is self.world:
                self.kept[key] = pixels

        try:
            pixels = small_image(world, depth, model, lambda: world is not self.world)
        except Stopped:
            return
        self.post(lambda: keep(pixels))
