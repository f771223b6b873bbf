"""The interface at a hit, in 3D: the normal, the angles, the two media, and the cone of the critical angle.

Everything lies in the plane of incidence, except for the cone. Its size is constant on the screen, or on the page.
"""

import math
from dataclasses import dataclass

import numpy as np

from tracer.formulas.optics import critical_angle
from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.orbit import Frame
from viewer.base.theme import NORMAL_WIDTH, Theme, faded
from viewer.base.wording import format_angle, format_number
from viewer.explain.scattering import direction_error
from viewer.explain.turned import along_surface
from viewer.figures.marks import Stroke
from viewer.figures.steps import Step

TIR = "tir"  # the kind of rays that belongs to the critical cone
LENGTH = 96.0  # logical pixels: of the normal, if it is seen from the side
SHARE, SHORTEST = 0.7, 0.55  # at most this share of the ray's own length, but at least this share of LENGTH
# Of this length:
BACK = 0.8  # the normal continued into the second medium
AHEAD = 1.1  # the incoming ray continued straight on
RADIUS, RADIUS_2 = 0.46, 0.6  # of the arcs of theta 1 and theta 2
CONE = 0.85  # the side of the cone
AWAY = (0.2, 0.32, 0.45, 0.6, 0.85, 1.15, 1.5)  # distances of an angle's text from its arc
NEAREST = 4  # of these, before the places past the arc's ends
PAST = math.radians(35.0)  # the angle past an arc's end at which its text may stand
STEP = math.radians(4.0)  # between the corners of an arc
# Places (angle from the normal, distance) for the indices of the two media.
N1_PLACES = ((1.1, 0.8), (1.1, 1.1), (1.3, 1.1), (-1.3, 1.1), (1.4, 1.5), (-1.4, 1.5), (0.5, 1.3), (-0.5, 1.3))
N2_PLACES = ((-2.1, 0.8), (-2.1, 1.1), (-1.9, 1.1), (2.0, 1.1), (-1.75, 1.5), (1.75, 1.5), (-2.6, 1.2), (2.6, 1.2))
SIDES = 4  # lines on the cone
SMALLEST = math.radians(1.0)  # an angle below has no arc

AHEAD_WIDTH, AHEAD_DASH = 1.6, (3.0, 4.0)
ARC_WIDTH, CONE_WIDTH, CONE_OPACITY = 1.8, 1.2, 0.75
BACK_DASH, CONE_DASH = (5.0, 4.0), (4.0, 3.0)


@dataclass(frozen=True)
class Hit:
    """The end of a ray on a surface. `foot` is in the frame, angles are in radians."""

    foot: np.ndarray
    normal: np.ndarray  # unit vector to the side that the ray comes from
    along: np.ndarray  # unit vector in the surface and the plane of incidence, to where the ray runs
    theta1: float
    theta2: float | None  # None: no refracted ray is shown
    n1: float
    n2: float | None  # None: the surface is opaque
    critical: float | None  # None: no angle of incidence is reflected totally, or this is not shown
    error: float  # bound on the rounding error of the angles
    reach: float  # length of the ray, in the frame

    def is_small(self, length: float, pixel: float) -> bool:
        """Whether the normal is shorter than usual, because the ray is short."""
        return length < 0.99 * LENGTH * pixel

    def length(self, pixel: float) -> float:
        """The length of the normal in the frame, where a logical pixel has this size. It fits to the ray's length."""
        return max(SHORTEST * LENGTH * pixel, min(LENGTH * pixel, SHARE * self.reach))

    def towards(self, angle: float) -> np.ndarray:
        """The unit vector at this angle from the normal, away from the side of the incoming ray."""
        return math.cos(angle) * self.normal + math.sin(angle) * self.along


@dataclass(frozen=True)
class Name:
    """A text at one of these points (n, 3) of the frame, the first where there is room."""

    content: str
    points: np.ndarray
    of_normal: bool = False
    of_refracted: bool = False  # shown only with the refracted ray


def hit_of(tree: RayTree, row: int, frame: Frame, step: Step | None = None) -> Hit | None:
    """The hit at the end of this ray; None if it has none, or is a shadow ray. In a `step` without its refracted ray it
    has no angle of refraction, and in one without totally reflected rays no critical angle.
    """
    node = tree.nodes[row]
    if node["kind"] == SHADOW or node["object"] < 0 or not np.isfinite(node["normal"]).all():
        return None
    normal = np.array(node["normal"])
    clear = not math.isnan(node["radicand"])
    n1, n2 = float(node["n1"]), float(node["n2"])
    sent = [child for child in tree.children[row] if tree.kind(child) == "refraction"]
    is_refracted = bool(sent) if step is None else not step.rows.isdisjoint(sent)
    has_cone = clear and (step is None or TIR in step.kinds)
    return Hit(
        frame.inside(node["point"]),
        normal,
        along_surface(node["direction"], normal),
        float(node["theta1"]),
        float(node["theta2"]) if is_refracted else None,
        n1,
        n2 if clear else None,
        critical_angle(n1, n2) if has_cone else None,
        direction_error(tree, row),
        float(node["t"]) / frame.radius,
    )


@dataclass(frozen=True)
class Curve:
    """A line through points (n, 3) of the frame. An arrow has its tip at this share of the length; 0: there is none."""

    points: np.ndarray
    stroke: Stroke
    arrow_at: float = 0.0


def interface_curves(hit: Hit, length: float, theme: Theme) -> list[Curve]:
    """The lines at a hit. `length` of the normal in the frame."""
    foot, up = hit.foot, length * hit.normal
    found = [Curve(np.array([foot, foot + up]), Stroke(theme.normal, 2.0 * NORMAL_WIDTH), 0.93)]
    if hit.n2 is not None:
        found.append(Curve(np.array([foot, foot - BACK * up]), Stroke(theme.normal, NORMAL_WIDTH, BACK_DASH)))
        if hit.theta1 > SMALLEST:  # the way straight on, for comparison
            on = AHEAD * length * hit.towards(math.pi - hit.theta1)
            found.append(Curve(np.array([foot, foot + on]), Stroke(theme.text, AHEAD_WIDTH, AHEAD_DASH)))
    arc = Stroke(theme.text, ARC_WIDTH)
    if hit.theta1 > SMALLEST:
        found.append(Curve(_arc(hit, -hit.theta1, 0.0, RADIUS * length), arc))
    if hit.theta2 is not None and hit.theta2 > SMALLEST:
        found.append(Curve(_arc(hit, math.pi, math.pi - hit.theta2, RADIUS_2 * length), arc))
    if hit.critical is not None:
        ink, rim = faded(theme.text, CONE_OPACITY), cone_rim(hit, length)
        found.append(Curve(rim, Stroke(ink, CONE_WIDTH)))
        side = Stroke(ink, CONE_WIDTH, CONE_DASH)
        found += [Curve(np.array([foot, at]), side) for at in rim[:-1][:: (len(rim) - 1) // SIDES]]
    return found


def cone_rim(hit: Hit, length: float) -> np.ndarray:
    """The rim of the critical cone (n, 3), closed. Its first corner is in the plane of incidence."""
    assert hit.critical is not None
    turns = np.linspace(0.0, 2.0 * math.pi, 4 * SIDES * round(90.0 / (math.degrees(STEP) * SIDES)) + 1)[:, None]
    around = np.cos(turns) * hit.along + np.sin(turns) * np.cross(hit.normal, hit.along)
    side = math.cos(hit.critical) * hit.normal + math.sin(hit.critical) * around
    return hit.foot + CONE * length * side


def interface_names(hit: Hit, length: float, is_small: bool = False) -> list[Name]:
    """The texts at a hit, the most important first. Where it `is_small`, they are the symbols of the normal and of the
    angles, since more would cover it.
    """

    def name(content: str, *places: tuple[float, float], **of: bool) -> Name:
        """Places by angle from the normal and distance, in lengths."""
        points = [hit.foot + share * length * hit.towards(angle) for angle, share in places]
        return Name(content, np.array(points), **of)

    def valued(symbol: str, value: str) -> str:
        return symbol if is_small else f"{symbol} {value}"

    found = [name("n", (0.0, 1.12), (0.15, 1.12), (-0.15, 1.12), of_normal=True)]
    if hit.theta1 > SMALLEST:
        ways = _beside_arc(-hit.theta1, 0.0, RADIUS)
        found.append(name(valued("θ₁", format_angle(hit.theta1, hit.error)), *ways))
    if hit.theta2 is not None and hit.theta2 > SMALLEST:
        ways = _beside_arc(math.pi - hit.theta2, math.pi, RADIUS_2)
        found.append(name(valued("θ₂", format_angle(hit.theta2, hit.error)), *ways, of_refracted=True))
    if hit.n2 is not None and not is_small:
        found.append(name(f"n₁ = {format_number(hit.n1)}", *N1_PLACES))
        found.append(name(f"n₂ = {format_number(hit.n2)}", *N2_PLACES))
    if hit.critical is not None and not is_small:
        near, far = (cone_rim(hit, away * length) for away in (1.12, 1.4))
        points = np.concatenate([near[: len(near) // 2 : 4], near[len(near) // 2 :: 4], far[::4]])
        found.append(Name(f"critical {format_angle(hit.critical)}", points))
    return found


def _beside_arc(begin: float, end: float, radius: float) -> list[tuple[float, float]]:
    """Places (angle from the normal, distance) for the text of an arc: outside of its middle, or else past its ends."""
    outside = [(0.5 * (begin + end), radius + away) for away in AWAY]
    near, *far = ([(turn, away) for turn in (begin - PAST, end + PAST)] for away in (0.9, 1.2, 1.5))
    return [*outside[:NEAREST], *near, *outside[NEAREST:], *(place for places in far for place in places)]


def _arc(hit: Hit, begin: float, end: float, radius: float) -> np.ndarray:
    """The corners (n, 3) of an arc around the foot, between two angles from the normal."""
    angles = np.linspace(begin, end, max(2, math.ceil(abs(end - begin) / STEP)))[:, None]
    return hit.foot + radius * (np.cos(angles) * hit.normal + np.sin(angles) * hit.along)
