"""The figure that a notebook shows for a tree. `tracer` finds it through an entry point (pyproject.toml), since it does
not import the viewer.
"""

from tracer.tree.raytree import RayTree
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.writers.svg import write_svg


def tree_svg(tree: RayTree) -> str:
    (figure,) = pages("tree", Subject(by_depth([tree])), FigureStyle(ground=True, swatches=True))
    return write_svg(figure).decode("utf-8")
