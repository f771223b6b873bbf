"""The two media of an interface: those of the hit looked at, or two indices that are given."""

import math
from dataclasses import dataclass

from tracer.formulas import optics
from viewer.base.wording import format_number
from viewer.lessons.live.piece import LiveContext, Parameters

THETA = 40.0  # degrees: the angle of incidence without a hit
MOST = 90.0


@dataclass(frozen=True)
class Interface:
    """Indices before and behind the surface, and angles of incidence in degrees."""

    n1: float
    n2: float
    theta1: float  # the one that the piece shows
    picked: float | None  # that of the hit, None without one

    @property
    def critical(self) -> float | None:
        """The critical angle in degrees; None where the second medium is not thinner."""
        angle = optics.critical_angle(self.n1, self.n2)
        return None if angle is None else math.degrees(angle)

    @property
    def steepest(self) -> float:
        """The largest angle of incidence with a refracted ray, in degrees."""
        return MOST if self.critical is None else self.critical

    def refracted(self, theta1: float) -> float | None:
        """The angle of refraction in degrees; None on total internal reflection. At `steepest` it is that limit."""
        if theta1 > self.steepest:
            return None
        sine = self.n1 / self.n2 * math.sin(math.radians(theta1))
        return math.degrees(math.asin(min(1.0, sine)))

    @property
    def words(self) -> str:
        return f"n₁ = {format_number(self.n1)}, n₂ = {format_number(self.n2)}"


def interface_of(context: LiveContext, parameters: Parameters, piece: str, before: str = "") -> Interface:
    """The interface of the hit, or of the parameters `n1` and `n2`, which go before the hit; `theta1` goes before its
    angle. With one index only, the other is that of the hit, or 1. ValueError without either, for an index that is not
    above 0 and for an angle outside 0 to 90 degrees. `before` are the words before the indices in a lesson.
    """
    theta1 = parameters.get("theta1")
    if theta1 is not None and not 0.0 <= theta1 <= MOST:
        raise ValueError(f"{piece}: theta1 must be from 0 to 90 degrees, got {theta1:g}")
    if "n1" in parameters or "n2" in parameters:
        n1, n2 = (parameters.get(name, _of_hit(context, name)) for name in ("n1", "n2"))
        for name, n in (("n1", n1), ("n2", n2)):
            if not 0.0 < n < math.inf:
                raise ValueError(f"{piece}: {name} must be a number above 0, got {n:g}")
        return Interface(n1, n2, THETA if theta1 is None else theta1, None)
    words = f"two indices, like `{piece}{before} 1.33 1`"
    if context.tree is None:
        raise ValueError(f"{piece}: no pixel is picked; it needs a hit on a transparent surface, or {words}")
    tree, _, name = context.hit(piece)
    row = tree.nodes[context.row]
    if math.isnan(row["n2"]):
        raise ValueError(f"{piece}: {name} is opaque; it needs a hit on a transparent surface, or {words}")
    picked = math.degrees(float(row["theta1"]))
    return Interface(float(row["n1"]), float(row["n2"]), picked if theta1 is None else theta1, picked)


def _of_hit(context: LiveContext, name: str) -> float:
    """An index of the hit looked at; 1 where there is none."""
    n = float(context.tree.nodes[context.row][name]) if context.tree else math.nan
    return 1.0 if math.isnan(n) else n
