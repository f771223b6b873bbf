"""The panels of the window. A new one needs a file with a PANEL and a line here."""

from viewer.panels import error, image, lesson, ray, recursion, scene, tree

PANELS = (scene.PANEL, image.PANEL, tree.PANEL, lesson.PANEL, ray.PANEL, error.PANEL, recursion.PANEL)
