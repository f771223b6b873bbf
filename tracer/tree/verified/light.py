"""The local term at a hit, in balls: ambient light, and each lamp's share with its shadow ray."""

from collections.abc import Sequence
from typing import NamedTuple

from tracer.choices import BLOCK, SHADOWS
from tracer.formulas.vector import Vector
from tracer.kernel.packing import plane_axes
from tracer.scene import Light, Object
from tracer.tree.verified.balls import (
    Ball,
    BallVector,
    ball,
    balls,
    between,
    cross,
    dot,
    power,
    scale,
    sign,
    square,
    subtract,
    unit,
)
from tracer.tree.verified.face import Crossing, Face
from tracer.tree.verified.scatter import Hit
from tracer.tree.verified.scenery import Scenery


class Passage(NamedTuple):
    """The fraction of a light that passes all surfaces on the way."""

    low: Ball
    high: Ball
    through_glass: bool | None  # None: not known

    @property
    def doubt(self) -> str:
        """The part that is not certain; empty if all is."""
        if self.low != self.high:
            return "in shadow or not"
        return "through glass or past it" if self.through_glass is None else ""


class Share(NamedTuple):
    """The contribution of a light to the local term."""

    rgb: BallVector
    passage: Passage | None  # None: the surface faces away
    doubt: str  # what is not certain; empty if all is


def surface_color(item: Object, normal: BallVector, p: BallVector) -> tuple[BallVector, bool]:
    """(colour at a point, whether it is certain which of a checker's two it is)."""
    checker = item.material.checker
    plain = balls(item.material.color)
    if checker is None:
        return plain, True
    axes = [balls((1, 0, 0)), balls((0, 1, 0)), balls((0, 0, 1))]
    if item.shape.checker_in_plane and (plane := item.shape.plane()):
        axes = in_plane(plane[1], normal)
    cells = [(dot(axis, p) / ball(checker.size)).floor().unique_fmpz() for axis in axes]
    other = balls(checker.color)
    if None in cells:
        return (between(plain[0], other[0]), between(plain[1], other[1]), between(plain[2], other[2])), False
    return (other if sum(map(int, cells)) % 2 else plain), True


def in_plane(rounded: Vector, normal: BallVector) -> list[BallVector]:
    """The two axes of a checker that `plane_axes` gives for a rounded normal, for the exact one."""
    along = max(range(3), key=lambda k: abs(rounded[k]))
    first = next(j for j in range(3) if j != along)
    v = unit(cross(normal, balls(float(j == first) for j in range(3))))
    guides = [balls(axis) for axis in plane_axes(rounded)]
    axes = [cross(normal, v), v]
    return [a if dot(a, guide) > 0 else scale(ball(-1.0), a) for a, guide in zip(axes, guides, strict=True)]


def to_light(light: Light, p: BallVector) -> tuple[BallVector, Ball | None]:
    """(unit direction, distance) to a light; None for one at infinity."""
    if light.direction is not None:
        return scale(ball(-1.0), unit(balls(light.direction))), None
    assert light.position is not None
    way = subtract(balls(light.position), p)
    distance = square(way).sqrt()
    return scale(1 / distance, way), distance


def transmittance(
    scenery: Scenery, p: BallVector, towards: BallVector, distance: Ball | None, start: Sequence[Face]
) -> Passage:
    """The fraction of a light that passes all surfaces on the way."""
    low = high = ball(1.0)
    crossings = scenery.crossings(p, towards, start)
    if crossings is None:
        return Passage(ball(0.0), high, None)
    through_glass: bool | None = False
    blocks = scenery.world.scene.tracing.shadows == SHADOWS[BLOCK]
    last: Crossing | None = None
    for c in crossings:
        if distance is not None and (c.t > distance or (not c.certain and c.face.avoids(p, towards, distance))):
            continue
        passes = ball(0.0 if blocks else scenery.material(c.face.surface).transmit)
        if last and scenery.owners[last.face.surface] == scenery.owners[c.face.surface] and not c.t > last.t:
            if not c.face.is_same(last.face):  # an edge: crossed once or twice
                low = low * passes
            continue
        low = low * passes
        if c.certain and (distance is None or c.t < distance):
            high = high * passes
            through_glass = True
            last = c
        elif not through_glass:
            through_glass = None
    return Passage(low, high, through_glass)


def light_share(scenery: Scenery, hit: Hit, color: BallVector, p: BallVector, start: Sequence[Face], j: int) -> Share:
    """The share of light j at a hit."""
    light, material = scenery.world.scene.lights[j], hit.item.material
    dark = balls((0.0, 0.0, 0.0))
    towards, distance = to_light(light, p)
    n_l = dot(hit.normal, towards)
    faces = [sign(n_l), sign(dot(hit.face_normal, towards))]
    if -1 in faces or 0 in faces:
        return Share(dark, None, "")
    passage = transmittance(scenery, p, towards, distance, start)
    r_v = -dot(subtract(scale(2 * n_l, hit.normal), towards), hit.d)
    shine = ball(material.specular) * power(r_v, material.shininess) if material.specular > 0.0 else ball(0.0)
    diffuse = ball(material.diffuse) * n_l
    visible = between(passage.low, passage.high)
    rgb = [visible * ball(light.color[k]) * (diffuse * color[k] + shine) for k in range(3)]
    doubt = passage.doubt
    if None in faces:
        rgb = [between(ball(0.0), x.abs_upper()) for x in rgb]
        doubt = "faces the light or not"
    return Share((rgb[0], rgb[1], rgb[2]), passage, doubt)
