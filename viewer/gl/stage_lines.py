"""The lines of the 3D view: rays, normals, the camera's frustum, edges of glass."""

from collections.abc import Sequence, Set
from dataclasses import dataclass

import numpy as np

from tracer.formulas.camera import View
from tracer.kernel.nodes import KINDS, SHADOW
from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame
from viewer.base.theme import (
    DIMMED,
    EDGE_OPACITY,
    EDGE_WIDTH,
    FRAME_OPACITY,
    FRAME_WIDTH,
    GLOW,
    GLOW_WIDTH,
    NORMAL,
    NORMAL_WIDTH,
    QUIET,
    QUIET_WIDTH,
    STYLES,
    TO_LIGHT,
    Theme,
    faded,
)
from viewer.figures.lights import pointed_lights
from viewer.figures.ray_lines import RayLines
from viewer.gl.creases import creases
from viewer.gl.lines import line_rows

PLANE_SHARE = 0.30  # of the distance from the camera to `look_at`: where the image plane is drawn


@dataclass(frozen=True)
class StageLines:
    """Arrays (n,) of `viewer.gl.lines.LINE`."""

    marks: np.ndarray
    rays: np.ndarray
    quiet: np.ndarray  # shadow rays, without a border


def style_rays(
    tree: RayTree, lines: RayLines, kept: Set[int] | None, selected: int | None, theme: Theme
) -> tuple[np.ndarray, np.ndarray]:
    """(rays, quiet rays) in the styles of their kinds. If rows are to be `kept` bright, the others are dimmed. Shadow
    rays are quiet, thin and faint, except for `pointed_lights`, which have arrows.
    """
    tints = np.array([theme.ray(kind) for kind in KINDS])[lines.kinds]
    widths = np.array([STYLES[kind].width for kind in KINDS])[lines.kinds]
    arrows = np.array([STYLES[kind].arrow.value for kind in KINDS])[lines.kinds]
    is_selected = lines.rows == selected
    is_shadow, pointed = lines.kinds == SHADOW, np.isin(lines.rows, list(pointed_lights(tree, selected)))
    arrows[is_shadow & pointed] = TO_LIGHT.value
    quiet = is_shadow & ~pointed
    tints[quiet, 3] *= QUIET
    widths[quiet] *= QUIET_WIDTH
    if kept is not None:
        tints[:, 3] *= brightness(lines.rows, kept)
        widths[is_selected] += 2.0
    styled = line_rows(lines.starts, lines.ends, tints, widths, dash=lines.dashes, fading=lines.escapes, arrow=arrows)
    # The last line lies over the others: first the dimmed rays, then the later ones, and the selected one at the end.
    order = np.lexsort((-lines.rows, is_selected, tints[:, 3]))
    return styled[order[~quiet[order]]], styled[order[quiet[order]]]


def brightness(rows: np.ndarray, kept: Set[int] | None) -> np.ndarray:
    """The factor of the opacity of each row: all are bright, or only those that are `kept`."""
    return np.ones(len(rows)) if kept is None else np.where(np.isin(rows, list(kept)), 1.0, DIMMED)


def glow_lines(lines: RayLines, row: int | None, theme: Theme) -> np.ndarray:
    """A broad line under the ray of this row: it is pointed at."""
    k = lines.find(row)
    found = slice(0, 0) if k is None else slice(k, k + 1)
    widths = np.array([STYLES[kind].width for kind in KINDS])[lines.kinds[found]] + GLOW_WIDTH
    ink = faded(theme.accent, GLOW)
    return line_rows(lines.starts[found], lines.ends[found], ink, widths, fading=lines.escapes[found])


def normal_lines(tree: RayTree, rows: Sequence[int], frame: Frame, kept: Set[int] | None, theme: Theme) -> np.ndarray:
    """The normal at every hit of these rows, on the side of the incoming ray."""
    nodes = tree.nodes
    among = np.asarray(rows, np.int64)
    hits = among[np.isfinite(nodes["normal"][among, 0]) & (nodes["kind"][among] != SHADOW)]
    feet = frame.inside(nodes["point"][hits])
    tints = np.tile(theme.normal, (len(hits), 1))
    tints[:, 3] *= brightness(hits, kept)
    return line_rows(feet, feet + NORMAL * nodes["normal"][hits], tints, NORMAL_WIDTH)


def image_plane(view: View, frame: Frame, focus: np.ndarray) -> np.ndarray:
    """Corners (4, 3) of the image in the frame: top left, bottom left, top right, bottom right."""
    eye = frame.inside(view.eye)
    away = PLANE_SHARE * max(float((focus - eye) @ view.forward), 0.2)
    aspect = view.width / view.height
    right, up, ahead = (np.array(axis) for axis in (view.right, view.up, view.forward))
    return np.array(
        [eye + away * (ahead + x * aspect * right + y * up) for x, y in ((-1, 1), (-1, -1), (1, 1), (1, -1))]
    )


def frustum_lines(view: View, frame: Frame, corners: np.ndarray, theme: Theme) -> np.ndarray:
    """Lines from the eye through the image's corners, and the image's frame."""
    starts = np.concatenate([np.tile(frame.inside(view.eye), (4, 1)), corners[[0, 1, 3, 2]]])
    ends = np.concatenate([corners, corners[[1, 3, 2, 0]]])
    return line_rows(starts, ends, faded(theme.text, FRAME_OPACITY), FRAME_WIDTH)


def glass_edges(world: World, frame: Frame, theme: Theme) -> np.ndarray:
    """The edges between the faces of cut glass: clear faces alone can hardly be seen."""
    found = [
        frame.inside(creases(item.shape.triangles(frame.middle, frame.radius)[0]))
        for item in world.scene.objects
        if item.material.transmit > 0.0 and item.shape.has_edges
    ]
    edges = np.concatenate(found) if found else np.zeros((0, 2, 3))
    return line_rows(edges[:, 0], edges[:, 1], faded(theme.text, EDGE_OPACITY), EDGE_WIDTH)
