"""Panels: each a function of the session that draws itself. A new one is a file here and its line in PANELS."""

from collections.abc import Callable
from dataclasses import dataclass

from viewer.panels import error, image, lesson, ray, scene, tree
from viewer.session.session import Session


@dataclass(frozen=True)
class Panel:
    title: str
    draw: Callable[..., None]  # (session, canvas)
    exists: Callable[[Session], bool] = lambda session: True


PANELS = (
    Panel(scene.TITLE, scene.draw),
    Panel(image.TITLE, image.draw),
    Panel(tree.TITLE, tree.draw),
    Panel(ray.TITLE, ray.draw),
    Panel(error.TITLE, error.draw),
    Panel(lesson.TITLE, lesson.draw, exists=lambda session: session.lesson is not None),
)
