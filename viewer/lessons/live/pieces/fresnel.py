"""Fresnel's equations as curves: the reflected and the transmitted share of light, against the angle of incidence.

Light is unpolarised. At Brewster's angle, atan(n2/n1), light polarised in the plane of incidence is not reflected, so
half of the unpolarised light at most is. From the critical angle on, all light is reflected.
"""

import math

from tracer.formulas.optics import shares
from viewer.base.theme import faded
from viewer.base.wording import format_number
from viewer.explain.formulas import Lecture
from viewer.explain.sections import Section
from viewer.figures.marks import Mark, Stroke
from viewer.lessons.live.interface import MOST, Interface, interface_of
from viewer.lessons.live.page import lay_out
from viewer.lessons.live.piece import LiveContext, Parameters
from viewer.lessons.live.pieces.snell import DEGREES, TINT
from viewer.lessons.live.plot import Axis, Plot

SHARES = (0.25, 0.5, 1.0)  # distances of ticks


def reflectance(media: Interface, degrees: float) -> tuple[float, float]:
    """(R, T) for unpolarised light at an angle of incidence."""
    theta1 = math.radians(degrees)
    return shares(math.cos(theta1), math.sin(theta1), media.n1, media.n2)


def brewster(media: Interface) -> float:
    """Brewster's angle, in degrees."""
    return math.degrees(math.atan2(media.n2, media.n1))


def fresnel(context: LiveContext, parameters: Parameters) -> list[Mark]:
    """The plot for the media of the hit, or for the parameters `n1` and `n2`; the handle is `theta1`, in degrees."""
    media = interface_of(context, parameters, "fresnel")
    theme, theta1 = context.theme, media.theta1
    r, t = reflectance(media, theta1)
    brief = f"R = {r:.4f}, T = {t:.4f}"
    picture, text = lay_out(context, [_section(media)], [f"θ₁ = {theta1:.2f}°: {brief}", brief])
    across = Axis(("angle of incidence θ₁", "incidence θ₁", "θ₁"), 0.0, MOST, DEGREES, "°")
    plot = Plot(picture, across, Axis(("share of the light", "share"), 0.0, 1.0, SHARES), context.size, theme)
    mirror, bent, total = theme.ray("reflection"), theme.ray("refraction"), theme.ray("tir")
    if media.critical is not None:
        plot.region("tir", (media.critical, MOST), faded(total, TINT), "total internal reflection")
        plot.line("critical", (media.critical, 0.0), (media.critical, 1.0), Stroke(total, 1.6, (5.0, 4.0)))
    polarized = brewster(media)
    if media.n1 != media.n2:
        plot.line("brewster", (polarized, 0.0), (polarized, 1.0), Stroke(theme.normal, 1.4, (2.0, 3.0)))
    for name, k, ink in (("reflected", 0, mirror), ("transmitted", 1, bent)):
        plot.curve(name, lambda x, k=k: reflectance(media, x)[k], (0.0, media.steepest), Stroke(ink, 2.6), media.words)
        if media.critical is not None:
            plot.line(name, (media.critical, 1.0 - k), (MOST, 1.0 - k), Stroke(ink, 2.6))
    plot.line("theta1", (theta1, 0.0), (theta1, 1.0), Stroke(theme.accent, 1.4, (2.0, 3.0)))
    if media.picked is not None and media.picked != theta1:
        for share, ink in zip(reflectance(media, media.picked), (mirror, bent), strict=True):
            plot.point("picked", media.picked, share, ink, hollow=True, title="the picked hit")
    plot.point("point", theta1, r, mirror, title=f"R = {r:.4f}")
    plot.point("point", theta1, t, bent, title=f"T = {t:.4f}")
    plot.handle("theta1", theta1, theme.accent, "drag to change the angle of incidence")
    plot.label("reflected", [f"R = {r:.3f}", "R"], theta1, r, mirror)
    plot.label("transmitted", [f"T = {t:.3f}", "T"], theta1, t, bent)
    if media.n1 != media.n2:
        words = [f"Brewster {polarized:.2f}°", f"θB = {polarized:.2f}°"]
        plot.label("brewster", words, polarized, 0.62, theme.normal, near=True)
    if media.critical is not None:
        plot.label("critical", [f"θc = {media.critical:.2f}°"], media.critical, 0.4, total, near=True)
        words = ["total internal reflection", "total reflection", "TIR"]
        plot.label("tir", words, 0.5 * (media.critical + MOST), 0.5, total, near=True)
    return [*plot.drawn(), *text]


def _section(media: Interface) -> Section:
    """The shares with their numbers. The amplitudes r_s and r_p are those of the two polarisations."""
    found = Section("Fresnel's equations", Lecture.FRESNEL)
    r, t = reflectance(media, media.theta1)
    theta1, theta2 = media.theta1, media.refracted(media.theta1)
    found.add(Lecture.THETA_1, f"{theta1:.2f}°")
    if theta2 is not None:
        c1, c2 = math.cos(math.radians(theta1)), math.cos(math.radians(theta2))
        found.add(Lecture.AMPLITUDE_S, _amplitude(media.n1 * c1, media.n2 * c2))
        found.add(Lecture.AMPLITUDE_P, _amplitude(media.n2 * c1, media.n1 * c2))
    found.add(Lecture.REFLECTANCE, f"{r:.4f}")
    found.add(Lecture.TRANSMITTED, f"{t:.4f}")
    if media.n1 != media.n2:
        found.add("Brewster", f"{brewster(media):.2f}°")
    if media.critical is not None:
        found.add(Lecture.THETA_C, f"{media.critical:.2f}°")
    found.add(Lecture.INDICES, f"{format_number(media.n1)} → {format_number(media.n2)}")
    return found


def _amplitude(a: float, b: float) -> str:
    return f"{(a - b) / (a + b) if a + b > 0.0 else -1.0:.4f}".replace("-", "−")
