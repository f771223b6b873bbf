"""The scene, and beside it the ray tree with the same labels: the two panels of Whitted's figure."""

from viewer.figures.figure import scene, tree
from viewer.figures.marks import Rectangle
from viewer.figures.subject import FigureStyle, Pages, Subject

DIVIDE = 0.46  # between the scene and the tree, as a share of the page's width
GAP = 4.0  # on either side of it


def pages(subject: Subject, style: FigureStyle) -> Pages:
    """Both panels on each page."""
    width, height = style.page
    scenes = scene.pages(subject, style, (0.0, 0.0, DIVIDE * width - GAP, height))
    trees = tree.pages(subject, style, tree_part(style), scenes)
    return [[*left, *right] for left, right in zip(scenes, trees, strict=True)]


def tree_part(style: FigureStyle) -> Rectangle:
    """The tree's part of the page."""
    width, height = style.page
    return (DIVIDE * width + GAP, 0.0, width, height)
