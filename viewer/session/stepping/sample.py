"""The chosen sample of a pixel: the one whose tree is on show, if the scene's image has several samples a pixel."""

from tracer.formulas.sampler import image_points, make_samples, sample_number
from tracer.scene import Scene
from viewer.base.cached import Cached


class SampleChoice:
    """The number of the chosen sample, from 0. It is kept from pixel to pixel."""

    def __init__(self) -> None:
        self.chosen = 0  # of another scene perhaps, which had more samples
        self._points: Cached[list[tuple[float, float]]] = Cached()

    def number(self, scene: Scene) -> int | None:
        """The `sample` of `tracer.trace`: None if the pixel's centre is its only sample."""
        count = scene.image.samples
        return sample_number(count, min(self.chosen, count - 1))

    def points(self, scene: Scene, pixel: tuple[int, int]) -> list[tuple[float, float]]:
        """The points of a pixel's samples in their order, in pixels from the top left corner of the image."""
        count = scene.image.samples
        return self._points.get((count, pixel), lambda: image_points(*pixel, make_samples(count)))
