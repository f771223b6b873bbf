"""Phong's local light at a hit: N, L, R and V, the three terms of one light, and the ray's r beside Phong's R.

The angles from the normal are true. V lies in the plane of incidence; L, which rarely does, is rotated into it.
"""

import math

import numpy as np

from tracer.formulas import optics
from tracer.formulas.vector import vector
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import Arrow, Color, curve_color
from viewer.base.wording import format_number, format_point
from viewer.explain.formulas import Lecture
from viewer.explain.lighting import one_light, phong_terms
from viewer.explain.scattering import direction_error
from viewer.explain.sections import Section
from viewer.explain.turned import along_surface
from viewer.figures.font import text_width
from viewer.figures.marks import Line, Mark, Rectangle, Stroke, Text
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.plot import Stacked, stacked_bars

BARS = 5.2  # height of the bars with their legend, in text sizes
REACHES = ("lit", "filtered")
APART = 1e-6  # the least component of L out of the plane that is said


def phong(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture, the terms and the numbers of one light: number `light` of the scene, else the first that reaches the
    hit, else the first. ValueError without a hit or a light.
    """
    tree, world, name = context.hit("phong")
    row, size = context.row, context.size
    child = _shadow_ray(tree, row, parameters.get("light"), name)
    light = int(tree.nodes["light"][child])
    normal, to_light = tree.nodes["normal"][row], tree.nodes["direction"][child]
    mirrored = 2.0 * float(normal @ to_light) * normal - to_light
    turn = direction_error(tree, row)
    phongs, rays = Section("Phong's R", Lecture.PHONG_REFLECTION), Section("The ray's r", Lecture.REFLECTION)
    phongs.add(Lecture.PHONG_MIRRORED, format_point(mirrored, turn))
    reflected = optics.reflect(vector(tree.nodes["direction"][row]), vector(normal))
    rays.add(Lecture.REFLECTED, format_point(reflected, turn))
    ambient, diffuse, specular = phong_terms(tree, world, row, child)
    terms = [ambient, diffuse, specular]
    values = [f"{WORDS[k]} {format_number(float(term.max()), 3)}" for k, term in enumerate(terms)]
    picture, text = lay_out(context, [one_light(tree, world, row, light), phongs, rays], ["  ".join(values)])
    left, top, right, bottom = picture
    bars = (left, bottom - BARS * size, right, bottom)
    others = sum((tree.nodes["radiance"][k] for k in _shadow_rays(tree, row) if k != child), np.zeros(3))
    marks = _bars([*terms, others], bars, context)
    return [*_vectors(context, child, (left, top, right, bars[1] - 0.4 * size)), *marks, *text]


WORDS = ("ambient", "diffuse", "specular", "other lights")


def _shadow_rays(tree: RayTree, row: int) -> list[int]:
    return [child for child in tree.children[row] if tree.nodes["kind"][child] == SHADOW]


def _shadow_ray(tree: RayTree, row: int, light: float | None, name: str) -> int:
    """The row of the shadow ray to a light."""
    rays = _shadow_rays(tree, row)
    if not rays:
        raise ValueError(f"phong: {name} has no ray to a light; it needs a scene with a light")
    if light is not None:
        found = [child for child in rays if tree.nodes["light"][child] == light]
        if not found:
            raise ValueError(f"phong: light must be from 0 to {int(tree.nodes['light'][rays].max())}, got {light:g}")
        return found[0]
    lit = (child for child in rays if tree.end(child) in REACHES and tree.nodes["radiance"][child].any())
    return next(lit, rays[0])


def _vectors(context: LiveContext, child: int, where: Rectangle) -> list[Mark]:
    """N upwards, V on the left, L on its true side, R and r as their mirror directions."""
    tree, row, size, theme = context.tree, context.row, context.size, context.theme
    assert tree is not None
    normal, direction, to_light = (
        tree.nodes[name][k] for name, k in (("normal", row), ("direction", row), ("direction", child))
    )
    along = along_surface(direction, normal)
    theta, phi = float(tree.nodes["theta1"][row]), optics.angle(vector(normal), vector(to_light))
    side = 1.0 if float(along @ to_light) >= 0.0 else -1.0
    left, top, right, bottom = where
    is_above = phi < 0.5 * math.pi
    foot = (0.5 * (left + right), bottom - (0.6 * size if is_above else 0.5 * (bottom - top)))
    reach = min(0.5 * (right - left) - 1.6 * size, foot[1] - top - 1.4 * size)
    vectors: list[tuple[str, float, Color]] = [("N", 0.0, theme.normal), ("V", -theta, theme.ray(tree.kind(row)))]
    vectors.append(("L", side * phi, theme.ray("shadow")))
    if is_above:
        vectors.append(("R", -side * phi, theme.ray("shadow")))
    vectors.append(("r", theta, theme.ray("reflection")))
    marks: list[Mark] = [Line("surface", (left, foot[1]), (right, foot[1]), Stroke(theme.text, 2.2))]
    ends = []
    for letter, turn, ink in vectors:
        length = reach * (0.8 if letter in "Rr" else 1.0)
        end = (foot[0] + length * math.sin(turn), foot[1] - length * math.cos(turn))
        dash = (6.0, 4.0) if letter in "Rr" else (0.0, 0.0)
        marks.append(
            Line(f"vector-{letter}", foot, end, Stroke(ink, 2.2, dash), Arrow.FILLED, 0.97, title=TITLES[letter])
        )
        ends.append((letter, turn, length, ink))
    labels = Labels(where, size, theme, marks)
    for letter, turn, length, ink in ends:
        away = length + 0.75 * size
        places = [
            ((foot[0] + away * math.sin(turn + aside), foot[1] - away * math.cos(turn + aside)), "middle")
            for aside in (0.0, -size / away, size / away, -2.0 * size / away, 2.0 * size / away)
        ]
        labels.place(f"vector-{letter}", [letter], places, ink)
    beside = abs(float(np.cross(along, normal) @ to_light)) > APART
    words = ["L rotated into this plane", "L rotated"] if beside else []
    labels.place("note", words, [((left, top + 0.6 * size), "start"), ((right, top + 0.6 * size), "end")], theme.muted)
    return [*marks, *labels.marks]


TITLES = {
    "N": "the normal",
    "V": "to where the ray comes from",
    "L": "to the light",
    "R": "the mirror direction of L, for the highlight",
    "r": "the ray's own mirror direction: where the reflected ray goes",
}


def _bars(values: list[np.ndarray], where: Rectangle, context: LiveContext) -> list[Mark]:
    """The terms as bars, with a legend below that has the terms that are not 0."""
    size, theme = context.size, context.theme
    left, top, right, bottom = where
    parts = [Stacked(f"term-{k}", value, curve_color(theme, k), WORDS[k]) for k, value in enumerate(values)]
    shown = [part for part in parts if part.value.max() > 1e-12] or parts[:1]
    marks = stacked_bars(shown, (left, top, right, bottom - 1.5 * size), size, theme)
    x = left
    for part in shown:
        wide = text_width(part.title, size)
        if x + wide > right:
            break
        marks.append(Text(part.name, (x, bottom - 0.6 * size), part.title, size, part.ink, "start"))
        x += wide + 0.8 * size
    return marks
