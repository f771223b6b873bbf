"""The intersection of a ray and a sphere, in the plane of the ray and the centre, and its quadratic with numbers."""

import math
from itertools import pairwise

from tracer.shapes.sphere import Sphere
from viewer.base.theme import STYLES, faded
from viewer.base.wording import format_number
from viewer.explain.intersection import hit_roots, root_reason, sphere_section, start_error
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.marks import Disc, Line, Mark, Point, Stroke, widened
from viewer.lessons.live.labels import Labels
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters

BEFORE = 2.5  # of the ray in front of the centre, in radii, where it starts farther away
DOT = 0.3  # radius of a root, in text sizes
DIGITS = 4


def sphere(context: LiveContext, _: Parameters) -> list[Mark]:
    """The picture and the quadratic of the hit. ValueError where the ray meets another shape."""
    tree, _world, name = context.hit("sphere")
    row = tree.nodes[context.row]
    shape = tree.scene.objects[int(row["object"])].shape
    found, section = hit_roots(tree, context.row), sphere_section(tree, context.row)
    if not isinstance(shape, Sphere) or found is None or section is None:
        raise ValueError(f"sphere: {name} is a {shape.name}; it needs a hit on a sphere")
    size, theme = context.size, context.theme
    chosen, t = found.nearest(float(row["t"])), format_number(float(row["t"]), DIGITS)
    t1, t2 = (format_number(root, DIGITS) for root in _told(found.roots, start_error(tree, context.row)))
    reason = root_reason(found, chosen, start_error(tree, context.row))
    captions = [f"t₁ = {t1}, t₂ = {t2}; t = {t}: {reason}", f"t₁ = {t1}, t₂ = {t2}; t = {t}", f"t = {t}"]
    picture, text = lay_out(context, [section], captions)
    left, top, right, bottom = widened(picture, -0.3 * MARGIN * size)

    radius, middle = shape.radius, -0.5 * found.b / found.a
    beside = math.sqrt(max(0.0, radius * radius - 0.25 * found.discriminant / found.a))  # of the centre to the ray
    first = max(min(0.0, middle - 1.25 * radius), middle - BEFORE * radius)
    last = middle + 1.8 * radius
    scale = min((right - left) / (last - first), (bottom - top) / (2.1 * radius))
    x0 = 0.5 * (left + right - scale * (last - first))
    y0 = 0.5 * (top + bottom)

    def at(along: float, above: float = beside) -> Point:
        """The point of the picture at a distance along the ray, and above the centre."""
        return (x0 + scale * (along - first), y0 - scale * above)

    kind = tree.kind(context.row)
    ink, style = theme.ray(kind), STYLES[kind]
    center = at(middle, 0.0)
    solid = Stroke(ink, 1.3 * style.width, style.dash)
    start, hit_at = at(max(first, 0.0)), at(found.roots[chosen])
    marks: list[Mark] = [
        Disc("sphere", center, scale * radius, faded(theme.glass, 0.16), Stroke(theme.text, 2.0), title=name),
        Line("line", at(first), at(last), Stroke(theme.muted, 1.2, (3.0, 4.0)), title="the line of the ray"),
        Line(f"ray-{context.row}", start, hit_at, solid, style.arrow, 0.5),
        Line("radius", center, hit_at, Stroke(theme.normal, 1.6)),
        Line("distance", center, at(middle), Stroke(theme.muted, 1.4, (5.0, 4.0))),
        Disc("center", center, 0.2 * size, theme.text, None),
    ]
    for k, root in enumerate(found.roots):
        fill = theme.accent if k == chosen else theme.ground
        marks.append(Disc(f"root-{k}", at(root), DOT * size, fill, Stroke(theme.accent, 2.0)))
    if first <= 0.0 <= last:
        marks.append(Disc("origin", at(0.0), 0.22 * size, ink, None))
    labels = Labels((left, top, right, bottom), size, theme, [m for m in marks if m.name != "sphere"])
    circle = [(center[0] + scale * radius * math.cos(a), center[1] + scale * radius * math.sin(a)) for a in _turns()]
    labels.placer.ways += [("sphere", piece) for piece in pairwise(circle)]
    for k, told in sorted(enumerate((t1, t2)), key=lambda item: item[0] != chosen):
        words = [f"t{'₁₂'[k]} = {told}", f"t{'₁₂'[k]}"]
        (x, y), aside = at(found.roots[k]), (0.4 if k else -0.4) * size
        places = [((x + aside, y + up * size), "start" if k else "end") for up in (-0.85, 0.85)]
        labels.place(f"root-{k}", words, places, theme.accent if k == chosen else theme.text)
    if first <= 0.0 <= last:
        labels.beside("origin", ["o: t = 0", "o"], at(0.0), ink, near=True)
    else:
        (x, y) = at(first)
        labels.place("origin", ["from o", "o"], [((x, y + up * size), "start") for up in (1.0, -1.0)], ink)
    labels.beside("center", ["m"], center, theme.text, near=True)
    distance = format_number(beside, 3)
    shorter = [f"{distance} {'<' if found.discriminant > 0.0 else '='} r = {format_number(radius, 3)}", distance]
    labels.beside("distance", shorter, at(middle, 0.5 * beside), theme.muted, near=True)
    return [*marks, *labels.marks, *text]


def _told(roots: tuple[float, float], error: float) -> tuple[float, ...]:
    """The roots, 0 where the ray starts on the sphere."""
    return tuple(0.0 if abs(root) <= error else root for root in roots)


def _turns() -> list[float]:
    return [2.0 * math.pi * k / 32 for k in range(33)]
