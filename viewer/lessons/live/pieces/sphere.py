"""The intersection of a ray and a sphere, in the plane of the ray and the centre, and its quadratic with numbers."""

import math
from collections.abc import Sequence
from itertools import pairwise

from tracer.shapes.sphere import Sphere
from viewer.base.theme import STYLES, faded
from viewer.base.wording import format_number
from viewer.explain.intersection import (
    SphereRoots,
    hit_roots,
    is_hit,
    miss_reason,
    root_reason,
    shape_tested,
    sphere_section,
    start_error,
)
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Disc, Line, Mark, Point, Stroke, widened
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters

BEFORE = 2.0  # of the ray in front of the centre, in radii, where it starts farther away
AFTER = 1.6  # of the ray behind the centre, in radii
HIGH = 0.7  # of the ray beside the centre, in radii: there is no room for labels beside the circle's top
LINE = 1.2  # height of a line of labels, in text sizes
DOT = 0.3  # radius of a root, in text sizes
DIGITS = 4
SIDES = ((-1, "end"), (1, "start"))  # of a label: the side of its point, and its anchor


def sphere(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The picture and the quadratic of the hit, or of the ray and the parameter `object`, which it may miss.
    ValueError if that is no sphere.
    """
    tree, name, number = context.tested("sphere", parameters)
    i, shape = context.row, shape_tested(tree, context.row, number)
    found, section = hit_roots(tree, i, number), sphere_section(tree, i, number)
    if not isinstance(shape, Sphere) or found is None or section is None:
        raise ValueError(f"sphere: {name} is a {shape.name if shape else 'background'}; it needs a hit on a sphere")
    t = float(tree.nodes["t"][i])
    hits = is_hit(tree, i, number)
    chosen = found.nearest(t) if hits else None
    error = start_error(tree, i) if hits else 0.0
    roots = [] if found.misses and not hits else list(found.roots)
    told = [format_number(0.0 if abs(root) <= error else root, DIGITS) for root in roots]
    size, theme = context.size, context.theme
    picture, text = lay_out(context, [section], _captions(found, told, chosen, t, error))
    left, top, right, bottom = widened(picture, -0.3 * MARGIN * size)

    radius, middle = shape.radius, -0.5 * found.b / found.a
    beside = math.sqrt(max(0.0, radius * radius - 0.25 * found.discriminant / found.a))  # of the centre to the ray
    first = max(min(0.0, middle - 1.25 * radius), middle - BEFORE * radius)
    last = max(middle + AFTER * radius, min(0.0, middle + BEFORE * radius) + 0.8 * radius)
    above = max(radius, beside)
    if told and beside > HIGH * radius:
        top += LINE * size  # labels stand above the ray
    scale = min((right - left) / (last - first), (bottom - top) / (1.05 * (radius + above)))
    x0 = 0.5 * (left + right - scale * (last - first))
    y0 = 0.5 * (top + bottom + scale * (above - radius))

    def at(along: float, above: float = beside) -> Point:
        """The point of the picture at a distance along the ray, and above the centre."""
        return (x0 + scale * (along - first), y0 - scale * above)

    kind = tree.kind(i)
    ink, style = theme.ray(kind), STYLES[kind]
    center = at(middle, 0.0)
    solid = Stroke(ink, 1.3 * style.width, style.dash)
    start, end = max(first, 0.0), last if math.isnan(t) else min(last, t)
    marks: list[Mark] = [
        Disc("sphere", center, scale * radius, faded(theme.glass, 0.16), Stroke(theme.text, 2.0), title=name),
        Line("line", at(first), at(last), Stroke(theme.muted, 1.2, (3.0, 4.0)), title="the line of the ray"),
        Line("distance", center, at(middle), Stroke(theme.muted, 1.4, (5.0, 4.0))),
        Disc("center", center, 0.2 * size, theme.text, None),
    ]
    if start < end:
        marks.append(Line(f"ray-{i}", at(start), at(end), solid, style.arrow, 0.5))
    if chosen is not None:
        marks.append(Line("radius", center, at(roots[chosen]), Stroke(theme.normal, 1.6)))
    for k, root in enumerate(roots):
        fill = theme.accent if k == chosen else theme.ground
        marks.append(Disc(f"root-{k}", at(root), DOT * size, fill, Stroke(theme.accent, 2.0)))
    if first <= 0.0 <= last:
        marks.append(Disc("origin", at(0.0), 0.22 * size, ink, None))
    labels = Labels(widened(picture, -0.3 * MARGIN * size), size, theme, [m for m in marks if m.name != "sphere"])
    circle = [(center[0] + scale * radius * math.cos(a), center[1] + scale * radius * math.sin(a)) for a in _turns()]
    labels.placer.ways += [("sphere", piece) for piece in pairwise(circle)]
    if told and roots[0] == roots[1]:
        labels.beside("root-0", [f"t₁ = t₂ = {told[0]}", "t₁ = t₂"], at(roots[0]), theme.accent, near=True)
    else:
        for k, length in sorted(enumerate(told), key=lambda item: item[0] != chosen):
            words = [f"t{'₁₂'[k]} = {length}", f"t{'₁₂'[k]}"]
            (x, y), aside = at(roots[k]), (0.4 if k else -0.4) * size
            places = [((x + aside, y + up * size), "start" if k else "end") for up in (-0.85, 0.85)]
            labels.place(f"root-{k}", words, places, theme.accent if k == chosen else theme.text)
    if first <= 0.0 <= last:
        (x, y) = at(0.0)
        sides = [((x + 0.4 * aside * size, y + up * size), anchor) for up in (0.9, -0.9) for aside, anchor in SIDES]
        labels.place("origin", ["o: t = 0", "o"], sides, ink)
    elif first > 0.0:
        (x, y) = at(first)
        labels.place("origin", ["from o", "o"], [((x, y + up * size), "start") for up in (1.0, -1.0)], ink)
    labels.beside("center", ["m"], center, theme.text, near=True)
    distance = format_number(beside, 3)
    relation = "=" if found.discriminant == 0.0 else "<" if found.discriminant > 0.0 else ">"
    shorter = [f"{distance} {relation} r = {format_number(radius, 3)}", distance]
    labels.beside("distance", shorter, at(middle, 0.5 * beside), theme.muted, near=True)
    return [*marks, *labels.marks, *text]


def _captions(found: SphereRoots, told: Sequence[str], chosen: int | None, t: float, error: float) -> list[str]:
    """What is said below the picture, the longest first."""
    d = f"D = {format_number(found.discriminant, DIGITS)}"
    if not told:
        return [f"{d}: {miss_reason(found)}", d]
    roots = f"t₁ = {told[0]}, t₂ = {told[1]}"
    if chosen is None:
        return [f"{d}, {roots}: {miss_reason(found)}", miss_reason(found)]
    hit = f"t = {format_number(t, DIGITS)}"
    reason = root_reason(found, chosen, error)
    return [f"{d}, {roots}; {hit}: {reason}", f"{d}, {roots}; {hit}", f"{d}; {hit}", hit]


def _turns() -> list[float]:
    return [2.0 * math.pi * k / 32 for k in range(33)]
