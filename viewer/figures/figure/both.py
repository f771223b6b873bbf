"""The scene, and beside it the ray tree with the same labels: the two panels of Whitted's figure."""

from viewer.figures.figure import scene, tree
from viewer.figures.marks import HEIGHT, WIDTH
from viewer.figures.subject import FigureStyle, Pages, Subject

DIVIDE = 0.46 * WIDTH  # between the scene and the tree
GAP = 4.0  # on either side of it
TREE = (DIVIDE + GAP, WIDTH)  # left and right of the tree


def pages(subject: Subject, style: FigureStyle) -> Pages:
    """Both panels on each page."""
    scenes = scene.pages(subject, style, (0.0, 0.0, DIVIDE - GAP, HEIGHT))
    trees = tree.pages(subject, style, TREE, scenes)
    return [[*left, *right] for left, right in zip(scenes, trees, strict=True)]
