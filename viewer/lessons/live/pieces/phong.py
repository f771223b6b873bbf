"""Phong's local light at a hit: N, L, R and V as the scene is seen from the side, and the three terms of one light.

The angles from the normal are true. V lies in the plane of incidence; L, which rarely does, is rotated into it. Where a
reflected ray leaves the hit, its r is beside Phong's R.
"""

import numpy as np

from tracer.formulas import optics
from tracer.formulas.vector import vector
from tracer.tree.raytree import RayTree
from viewer.base.theme import faded
from viewer.base.wording import format_number, format_point
from viewer.explain.formulas import Lecture
from viewer.explain.lighting import light_cosines, one_light, phong_terms
from viewer.explain.scattering import direction_error
from viewer.explain.sections import Section
from viewer.figures.font import text_width
from viewer.figures.lights import shadow_rays
from viewer.figures.marks import Box, Mark, Rectangle, Text
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.plot import Stacked, stacked_bars
from viewer.lessons.live.side_view import SideView, Vector

WIDE = 1.2  # the least ratio of width to height with the bars beside the arrows
ARROWS = 0.42  # the share of the width that the arrows have beside the bars
BARS, PITCH, LEGEND = 5.2, 1.35, 1.4  # heights of bars below the arrows, of a bar, of a line of the legend; text sizes
REACHES = ("lit", "filtered")
MIRRORED = 0.8  # length of R and r
DASH = (6.0, 4.0)
WORDS = ("ambient", "diffuse", "specular", "other lights")
SEEN = 1e-4  # of the largest term: those below are not shown
TINTS = (0.3, 0.6, 1.0, 0.15)  # of the bars' parts


def phong(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture, the terms and the numbers of one light: number `light` of the scene, else the first that reaches the
    hit, else the first. ValueError without a hit or a light.
    """
    tree, world, name = context.hit("phong")
    row, size = context.row, context.size
    child = chosen_light("phong", tree, row, parameters.get("light"), name)
    light = int(tree.nodes["light"][child])
    normal, to_light = tree.nodes["normal"][row], tree.nodes["direction"][child]
    turn = direction_error(tree, row)
    phongs = Section("Phong's R", Lecture.PHONG_REFLECTION)
    phongs.add(Lecture.PHONG_MIRRORED, format_point(phong_mirrored(normal, to_light), turn))
    cosines = [format_number(x, 3) for x in light_cosines(tree, row, child)]
    caption = f"N·L = {cosines[0]},  R·V = {cosines[1]}"
    picture, text = lay_out(context, [one_light(tree, world, row, light), phongs], [caption])
    left, top, right, bottom = picture
    terms = [*phong_terms(tree, world, row, child)]
    others = sum((tree.nodes["radiance"][k] for k in shadow_rays(tree, row) if k != child), np.zeros(3))
    if right - left >= WIDE * (bottom - top):
        across = left + ARROWS * (right - left)
        arrows, bars = (left, top, across, bottom), (across + size, top, right, bottom)
    else:
        arrows, bars = (left, top, right, bottom - (BARS + 0.4) * size), (left, bottom - BARS * size, right, bottom)
    return [*_arrows(context, child, arrows), *_bars([*terms, others], bars, context), *text]


def phong_mirrored(normal: np.ndarray, to_light: np.ndarray) -> np.ndarray:
    """Phong's R (3,), which leads back from the mirrored direction of the light's."""
    return -np.array(optics.reflect(vector(to_light), vector(normal)))


def chosen_light(piece: str, tree: RayTree, row: int, light: float | None, name: str) -> int:
    """The row of the shadow ray of hit `row` to a light: the number that is given, else as `phong` says."""
    rays = shadow_rays(tree, row)
    if not rays:
        raise ValueError(f"{piece}: {name} has no ray to a light; it needs a scene with a light")
    if light is not None:
        found = [child for child in rays if tree.nodes["light"][child] == light]
        if not found:
            raise ValueError(f"{piece}: light must be from 0 to {int(tree.nodes['light'][rays].max())}, got {light:g}")
        return found[0]
    lit = (child for child in rays if tree.end(child) in REACHES and tree.nodes["radiance"][child].any())
    return next(lit, rays[0])


def _arrows(context: LiveContext, child: int, where: Rectangle) -> list[Mark]:
    """N, V, L and its mirror direction R; r, if the hit sends a reflected ray."""
    tree, row, size, theme = context.tree, context.row, context.size, context.theme
    assert tree is not None and context.world is not None
    normal, direction, to_light = (
        np.array(tree.nodes[name][k]) for name, k in (("normal", row), ("direction", row), ("direction", child))
    )
    view = SideView(direction, normal, context.world.scene.camera.up)
    along, above = view.rotated(to_light)
    grey = theme.ray("shadow")
    foot = (0.0, 0.0)
    arrows = [
        Vector("vector-N", "N", foot, (0.0, 1.0), theme.normal, title="the normal"),
        Vector(
            "vector-V", "V", foot, view.flat(-direction), theme.ray(tree.kind(row)), title="to where the ray is from"
        ),
        Vector("vector-L", "L", foot, (along, above), grey, title="to the light"),
    ]
    if above > 0.0:
        end = (-MIRRORED * along, MIRRORED * above)
        arrows.append(Vector("vector-R", "R", foot, end, grey, DASH, "the mirror direction of L, for the highlight"))
    if any(tree.kind(k) == "reflection" for k in tree.children[row]):
        end = view.flat(MIRRORED * np.array(optics.reflect(vector(direction), vector(normal))))
        arrows.append(Vector("vector-r", "r", foot, end, theme.ray("reflection"), DASH, "where the reflected ray goes"))
    drawn = view.draw(arrows, where, size, theme)
    view.note(drawn, to_light, "L", where, theme)
    return drawn.marks


def _bars(values: list[np.ndarray], where: Rectangle, context: LiveContext) -> list[Mark]:
    """The terms as bars, with a legend below that has the terms that are not 0, and their largest channels."""
    size, theme = context.size, context.theme
    left, top, right, bottom = where
    parts = [Stacked(f"term-{k}", value, faded(theme.text, TINTS[k]), WORDS[k]) for k, value in enumerate(values)]
    least = SEEN * max(float(part.value.max()) for part in parts)
    shown = [part for part in parts if part.value.max() > least] or parts[:1]
    stacked = bottom - top >= (3.0 * PITCH + len(shown) * LEGEND) * size
    if stacked:
        top = 0.5 * (top + bottom - (3.0 * PITCH + len(shown) * LEGEND) * size)
        below = top + 3.0 * PITCH * size
    else:
        below = bottom - 1.5 * size
    marks = stacked_bars(shown, (left, top, right, below), size, theme)
    x, y = left, below + 0.8 * size
    for part in shown:
        words = f"{part.title} {format_number(float(part.value.max()), 3)}" if stacked else part.title
        if x + 1.1 * size + text_width(words, size) > right:
            break
        marks.append(Box(part.name, (x + 0.4 * size, y), (0.8 * size, 0.8 * size), 0.0, part.ink, None))
        marks.append(Text(part.name, (x + 1.1 * size, y), words, size, theme.text, "start"))
        if stacked:
            y += LEGEND * size
        else:
            x += 1.9 * size + text_width(words, size)
    return marks
