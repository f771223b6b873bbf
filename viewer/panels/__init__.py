"""The panels of the window. A new one needs a file with a PANEL and a line here.

They are drawn in this order: a pixel that is picked in the image, and a ray that is selected in the tree, are shown by
the others in the same frame.
"""

from viewer.panels import error, image, lesson, ray, scene, tree

PANELS = (image.PANEL, tree.PANEL, scene.PANEL, lesson.PANEL, ray.PANEL, error.PANEL)
