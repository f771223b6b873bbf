"""The lines of the 3D view: rays, normals, the camera's frustum, edges of glass."""

from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

from tracer.formulas.camera import View
from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame
from viewer.base.theme import (
    DIMMED,
    EDGE_OPACITY,
    EDGE_WIDTH,
    FRAME_WIDTH,
    NORMAL,
    NORMAL_WIDTH,
    STYLES,
    Arrow,
    Theme,
    faded,
)
from viewer.figures.ray_lines import RayLine
from viewer.gl.creases import creases
from viewer.gl.lines import Line

PLANE_SHARE = 0.30  # of the distance from the camera to `look_at`: where the image plane is drawn


@dataclass(frozen=True)
class StageLines:
    marks: list[Line]
    rays: list[Line]


def style_rays(lines: list[RayLine], kept: Set[int] | None, selected: int | None, theme: Theme) -> list[Line]:
    """Rays in the styles of their kinds. If rows are to be `kept` bright, the others are dimmed."""
    styled = []
    for line in lines:
        style = STYLES[line.kind]
        color = theme.ray(line.kind)
        width = style.width
        if kept is not None:
            color = color if line.row in kept else faded(color, DIMMED)
            width = width + 2.0 if line.row == selected else width
        arrow = style.arrow
        styled.append(Line(line.start, line.end, color, width, line.dash, line.escapes, arrow))
    return styled


def normal_lines(tree: RayTree, rows: Sequence[int], frame: Frame, kept: Set[int] | None, theme: Theme) -> list[Line]:
    """The normal at every hit of these rows, on the side of the incoming ray."""
    nodes = tree.nodes
    hits = np.array(rows)[np.isfinite(nodes["normal"][rows, 0]) & (nodes["kind"][rows] != SHADOW)]
    feet = frame.inside(nodes["point"][hits])
    lines = []
    for i, foot in zip(hits, feet, strict=True):
        color = theme.normal if kept is None or i in kept else faded(theme.normal, DIMMED)
        lines.append(Line(foot, foot + NORMAL * nodes["normal"][i], color, NORMAL_WIDTH, arrow=Arrow.NONE))
    return lines


def image_plane(view: View, frame: Frame, focus: np.ndarray) -> np.ndarray:
    """Corners (4, 3) of the image in the frame: top left, bottom left, top right, bottom right."""
    eye = frame.inside(view.eye)
    away = PLANE_SHARE * max(float((focus - eye) @ view.forward), 0.2)
    aspect = view.width / view.height
    right, up, ahead = (np.array(axis) for axis in (view.right, view.up, view.forward))
    return np.array(
        [eye + away * (ahead + x * aspect * right + y * up) for x, y in ((-1, 1), (-1, -1), (1, 1), (1, -1))]
    )


def frustum_lines(view: View, frame: Frame, corners: np.ndarray, theme: Theme) -> list[Line]:
    """Lines from the eye through the image's corners, and the image's frame."""
    eye = frame.inside(view.eye)
    color = faded(theme.text, 0.75)
    edges = [(eye, corner) for corner in corners]
    edges += [(corners[a], corners[b]) for a, b in ((0, 1), (1, 3), (3, 2), (2, 0))]
    return [Line(start, end, color, FRAME_WIDTH) for start, end in edges]


def glass_edges(world: World, frame: Frame, theme: Theme) -> list[Line]:
    """The edges between the faces of cut glass: clear faces alone can hardly be seen."""
    lines = []
    for item in world.scene.objects:
        if item.material.transmit > 0.0 and item.shape.has_edges:
            for start, end in frame.inside(creases(item.shape.triangles(frame.middle, frame.radius)[0])):
                lines.append(Line(start, end, faded(theme.text, EDGE_OPACITY), EDGE_WIDTH))
    return lines
