"""The direction of reflection as a sum of arrows: v, from which its part along the normal is taken away twice.

With a light it is Phong's formula: twice the part of l along the normal, from which l is taken away. The picture has
the sides of the scene. The handle `times` takes the part away so many times, 0 to 2.
"""

import numpy as np

from tracer.formulas import optics
from tracer.formulas.vector import vector
from viewer.base.theme import Color, faded
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section
from viewer.figures.marks import Handle, Mark
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.pieces.phong import chosen_light, phong_mirrored
from viewer.lessons.live.side_view import SideView, Vector

TWICE = 2
DASH = (6.0, 4.0)
FAINT = 0.7  # opacity of a copy of a vector
DECIMALS = 4
FOOT = (0.0, 0.0)


def reflect(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture of the hit's v and r, or with the parameter `light` of a light's l and R beside them. ValueError
    without a hit, without that light, and for `times` that is not 0, 1 or 2.
    """
    tree, world, name = context.hit("reflect")
    row = tree.nodes[context.row]
    times = round(parameters.get("times", TWICE))
    if not 0 <= times <= TWICE:
        raise ValueError(f"reflect: times must be from 0 to {TWICE}, got {times}")
    v, n = np.array(row["direction"]), np.array(row["normal"])
    r = np.array(optics.reflect(vector(v), vector(n)))
    view = SideView(v, n, world.scene.camera.up)
    if "light" in parameters:
        to_light = tree.nodes["direction"][chosen_light("reflect", tree, context.row, parameters["light"], name)]
        return _of_light(context, view, r, np.array(to_light))
    section = Section("The reflected ray", Lecture.REFLECTION)
    for symbol, of in ((Lecture.INCOMING, v), (Lecture.NORMAL, n), (Lecture.REFLECTED, r)):
        section.add(symbol, _numbers(of))
    cosine = float(n @ v)
    section.add(Lecture.COSINE, _number(cosine))
    left = ("v", "v − (n·v) n", "v − 2 (n·v) n")[times]
    told = f"{left} = ({_numbers(v - times * cosine * n)})"
    picture, text = lay_out(context, [section], [f"n·v = {_number(cosine)}:  {told}", told])
    drawn = view.draw(
        _of_ray(context, view, v, times), picture, context.size, context.theme, [view.flat(to) for to in (v, r, -v)]
    )
    path = tuple(drawn.at(view.flat(v - k * cosine * n)) for k in range(TWICE + 1))
    ink, title = context.theme.ray("reflection"), "drag to take the part along n away"
    return [*drawn.marks, Handle("times", times, (0, TWICE), path, ink, title=title), *text]


def _of_ray(context: LiveContext, view: SideView, v: np.ndarray, times: int) -> list[Vector]:
    """The arrows of v, of its part along the normal, and of what is left of v."""
    theme, tree = context.theme, context.tree
    assert tree is not None
    white, blue = theme.ray(tree.kind(context.row)), theme.ray("reflection")
    s, c = view.flat(v)
    arrows = [_arriving(view, v, white), _normal(theme.normal)]
    if times:
        arrows.append(Vector("vector-v-on", "v", FOOT, (s, c), faded(white, FAINT), DASH, "v carried on", at=0.55))
    for k in range(times):
        title = "the part of v along n, taken away"
        arrows.append(Vector(f"part-{k}", "−(n·v) n", (s, c * (1 - k)), (s, -c * k), theme.normal, title=title, at=0.5))
    end = (s, c * (1 - times))
    title = "what is left of v" if times < TWICE else "the direction of the reflected ray"
    arrows.append(Vector("vector-r", ("v", "", "r")[times], FOOT, end, blue, title=title, at=0.6))
    return arrows


def _of_light(context: LiveContext, view: SideView, r: np.ndarray, to_light: np.ndarray) -> list[Mark]:
    """The arrows of Phong's formula, beside v and r."""
    theme, tree = context.theme, context.tree
    assert tree is not None
    n = view.normal
    mirrored, cosine = phong_mirrored(n, to_light), float(n @ to_light)
    section = Section("Phong's R", Lecture.PHONG_REFLECTION)
    for symbol, of in ((Lecture.PHONG_LIGHT, to_light), (Lecture.PHONG_NORMAL, n), (Lecture.PHONG_MIRRORED, mirrored)):
        section.add(symbol, _numbers(of))
    told = f"R = 2 (n·l) n − l = ({_numbers(mirrored)})"
    picture, text = lay_out(context, [section], [f"n·l = {_number(cosine)}:  {told}", told])
    (s, c), grey = view.rotated(to_light), theme.ray("shadow")
    direction = np.array(tree.nodes["direction"][context.row])
    title = "the part of l along n"
    arrows = [
        _arriving(view, direction, theme.ray(tree.kind(context.row))),
        Vector("vector-r", "r", FOOT, view.flat(r), theme.ray("reflection"), title="where the reflected ray goes"),
        Vector("part-0", "", FOOT, (0.0, c), theme.normal, title=title, at=0.5),
        Vector("part-1", "2 (n·l) n", (0.0, c), (0.0, 2.0 * c), theme.normal, title=title, at=0.7),
        Vector("vector-l", "l", FOOT, (s, c), grey, title="to the light"),
        Vector("vector-l-off", "−l", (0.0, 2.0 * c), (-s, c), faded(grey, FAINT), DASH, "l, taken away", at=0.5),
        Vector("vector-R", "R", FOOT, (-s, c), grey, DASH, "the mirror direction of l"),
    ]
    drawn = view.draw(arrows, picture, context.size, theme)
    view.note(drawn, to_light, "l", picture, theme)
    return [*drawn.marks, *text]


def _arriving(view: SideView, v: np.ndarray, ink: Color) -> Vector:
    s, c = view.flat(v)
    return Vector("vector-v", "v", (-s, -c), FOOT, ink, title="the ray that arrives", at=0.4)


def _normal(ink: Color) -> Vector:
    return Vector("vector-n", "n", FOOT, (0.0, 1.0), ink, title="the normal")


def _number(x: float) -> str:
    """Without the rounding errors of a direction."""
    return format_number(round(x, DECIMALS) + 0.0, DECIMALS)


def _numbers(of: np.ndarray) -> str:
    return ", ".join(_number(float(x)) for x in of)
