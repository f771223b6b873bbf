"""The scene on show, what follows from it, and how it is looked at."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from tracer.choices import MODELS
from tracer.formats import UP_AXES
from tracer.kernel.limits import Limits, image_max_nodes, make_limits
from tracer.kernel.world import World
from viewer.base.orbit import Frame, Orbit, initial_orbit
from viewer.lessons.lesson import Lesson
from viewer.lessons.step import Step
from viewer.session.loading.opening import Opening
from viewer.session.view_state import Looks


def image_limits(world: World, depth: int, model: str) -> Limits:
    """The limits of the trees of a scene's image."""
    image = world.scene.image
    max_nodes = image_max_nodes(world, image.width * image.height)
    return make_limits(world, depth, max_nodes=max_nodes, model=model, records=False)


@dataclass(eq=False)
class OnShow(Looks):
    """The scene on show, how deep it is traced, and the 3D view of it."""

    opening: Opening | None = None
    world: World | None = None
    depth: int = 3
    model: str = MODELS[0]
    frame: Frame = field(default_factory=lambda: Frame(np.zeros(3), 1.0))
    orbit: Orbit = field(default_factory=Orbit)

    @property
    def path(self) -> Path | None:
        """The file of the scene on show."""
        return self.opening.path if self.opening else None

    @property
    def lesson(self) -> Lesson | None:
        """The lesson on show, if the scene belongs to one."""
        return self.opening.lesson if self.opening else None

    @property
    def lesson_step(self) -> Step | None:
        """The step of the lesson on show."""
        return self.opening.step if self.opening else None

    @property
    def up(self) -> str:
        """The axis of a mesh file that points upwards."""
        return self.opening.up if self.opening else UP_AXES[0]

    @property
    def scene_depth(self) -> int:
        """The depth of the scene on show, by its file."""
        return self.world.scene.tracing.depth if self.world else 0

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the image, in pixels."""
        assert self.world
        return (self.world.scene.image.width, self.world.scene.image.height)

    @property
    def limits(self) -> Limits:
        """The limits of the image's trees."""
        assert self.world
        return image_limits(self.world, self.depth, self.model)

    def home(self) -> None:
        """Reset the 3D view, and fit the image and the tree into their panels."""
        self.image_view.fit()
        self.tree_view.fit()
        self.turn_back()
        self.reset_orbit()

    def reset_orbit(self) -> None:
        """Look at the scene as at first."""
        if self.world:
            self.orbit = initial_orbit(
                self.world, self.frame, self.opening.step.state.view if self.opening and self.opening.step else None
            )
