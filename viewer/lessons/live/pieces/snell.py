"""Snell's law as a curve: the angle of refraction against the angle of incidence, with the picked hit on it.

Where n1 > n2 the curve ends at the critical angle, and beyond it is the region of total internal reflection.
"""

import math

from viewer.base.theme import faded
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section
from viewer.figures.marks import Mark, Stroke
from viewer.lessons.live.interface import MOST, Interface, interface_of
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.plot import Axis, Plot

DEGREES = (15.0, 30.0, 45.0, 90.0)  # distances of ticks
TINT = 0.08  # opacity of the region of total internal reflection


def snell(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The plot for the media of the hit, or for the parameters `n1` and `n2`; the handle is `theta1`, in degrees."""
    media = interface_of(context, parameters, "snell")
    picture, text = lay_out(context, [section(media)], captions(media))
    theme, theta1, theta2 = context.theme, media.theta1, media.refracted(media.theta1)
    plot = Plot(
        picture,
        Axis(("angle of incidence θ₁", "incidence θ₁", "θ₁"), 0.0, MOST, DEGREES, "°"),
        Axis(("angle of refraction θ₂", "refraction θ₂", "θ₂"), 0.0, MOST, DEGREES, "°"),
        context.size,
        theme,
    )
    color, total = theme.ray("refraction"), theme.ray("tir")
    if media.critical is not None:
        ends = (media.critical, MOST)
        plot.region("tir", ends, faded(total, TINT), "total internal reflection: no ray is refracted")
        plot.line("critical", (media.critical, 0.0), (media.critical, MOST), Stroke(total, 1.6, (5.0, 4.0)))
    plot.line("diagonal", (0.0, 0.0), (MOST, MOST), Stroke(theme.muted, 1.2, (3.0, 4.0)))
    plot.curve("snell", lambda x: media.refracted(x) or 0.0, (0.0, media.steepest), Stroke(color, 2.6), media.words)
    ink = Stroke(theme.accent, 1.4, (2.0, 3.0))
    if theta2 is not None:
        plot.line("theta1", (theta1, 0.0), (theta1, theta2), ink)
        plot.line("theta2", (0.0, theta2), (theta1, theta2), ink)
    else:
        plot.line("theta1", (theta1, 0.0), (theta1, MOST), ink)
    picked = media.picked
    if picked is not None and picked != theta1 and (there := media.refracted(picked)) is not None:
        plot.point("picked", picked, there, color, hollow=True, title="the picked hit")
    if theta2 is not None:
        plot.point("point", theta1, theta2, theme.accent, title=f"θ₁ = {theta1:.2f}°, θ₂ = {theta2:.2f}°")
    plot.handle("theta1", theta1, theme.accent, "drag to change the angle of incidence")
    if theta2 is not None:
        words = [f"{theta1:.2f}° → {theta2:.2f}°", f"→ {theta2:.2f}°"]
        plot.label("point", words, theta1, theta2, theme.text)
    if media.critical is not None:
        plot.label("critical", [f"θc = {media.critical:.2f}°"], media.critical, 12.0, total)
        words = ["total internal reflection", "total reflection", "TIR"]
        plot.label("tir", words, 0.5 * (media.critical + MOST), 45.0, total)
    plot.label("diagonal", ["θ₂ = θ₁ (n₁ = n₂)", "θ₂ = θ₁"], 68.0, 68.0, theme.muted, near=True)
    return [*plot.drawn(), *text]


def section(media: Interface) -> Section:
    """Snell's law with the numbers of an angle of incidence."""
    found = Section("Snell's law", Lecture.SNELL)
    theta2 = media.refracted(media.theta1)
    found.add("n₁ sin θ₁", _side(media.n1, media.theta1))
    if theta2 is None:
        sine = media.n1 / media.n2 * math.sin(math.radians(media.theta1))
        found.add("sin θ₂ would be", f"{format_number(sine)} > 1")
        found.add("total internal reflection")
    else:
        found.add("n₂ sin θ₂", _side(media.n2, theta2))
    found.add(Lecture.THETA_1, f"{media.theta1:.2f}°")
    if theta2 is not None:
        found.add(Lecture.THETA_2, f"{theta2:.2f}°")
    if media.critical is not None:
        found.add(Lecture.THETA_C, f"{media.critical:.2f}°")
    elif media.n1 < media.n2:
        found.add("bends towards the normal")
    return found


def captions(media: Interface) -> list[str]:
    """The law in one line, the longest first."""
    theta2 = media.refracted(media.theta1)
    left = f"{format_number(media.n1)} sin {media.theta1:.2f}°"
    if theta2 is None:
        side = format_number(media.n1 * math.sin(math.radians(media.theta1)), 4)
        return [f"{left} = {side} > n₂ = {format_number(media.n2)}: total internal reflection", f"{left} = {side} > n₂"]
    return [f"{left} = {format_number(media.n2)} sin {theta2:.2f}°", f"θ₂ = {theta2:.2f}°"]


def _side(n: float, degrees: float) -> str:
    sine = math.sin(math.radians(degrees))
    return f"{format_number(n)} × {sine:.4f} = {n * sine:.4f}"
