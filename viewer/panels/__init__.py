"""The panels of the window. A new one needs a file with a PANEL and a line here."""

from viewer.panels import error, hit, image, ray, recursion, scene, tree
from viewer.panels.lessons import lesson

# In the order of the keys F2, F3, ... (`viewer.window.keys`). Of those that share a place, the first is in front.
PANELS = (
    scene.PANEL, image.PANEL, tree.PANEL, ray.PANEL, hit.PANEL, lesson.PANEL, error.PANEL, recursion.PANEL,
)  # fmt: skip
