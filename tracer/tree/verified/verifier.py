"""Traces a recorded tree again in ball arithmetic, row by row."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from tracer.formulas.camera import View
from tracer.formulas.media import VACUUM, WORD
from tracer.formulas.shading import surface_color as recorded_color
from tracer.kernel.nodes import BACKGROUND, BLOCKED, FILTERED, LIT, SHADOW
from tracer.scene import Camera
from tracer.scene.cameras import placed_camera
from tracer.tree.raytree import RayTree
from tracer.tree.verified.balls import (
    Ball,
    BallVector,
    add,
    ball,
    balls,
    between,
    bounds,
    cross,
    flint,
    scale,
    subtract,
    unit,
    up_product,
    up_sum,
)
from tracer.tree.verified.enclosures import VerifiedRow, VerifiedTree
from tracer.tree.verified.face import Face
from tracer.tree.verified.interface import Interface, Solids, first_interface, medium
from tracer.tree.verified.light import Passage, light_share, surface_color
from tracer.tree.verified.scatter import Hit, Sent, scattered, usable_normal
from tracer.tree.verified.scenery import Scenery

REPORTED = 100  # rows between two reports of progress
ROUNDING = 1.0 + 2.0**-40  # makes up for the rounding of B itself


class State(NamedTuple):
    """A ray before it is traced."""

    o: BallVector
    d: BallVector
    weight: Ball
    inside: Solids
    start: tuple[Face, ...]


class Verifier:
    """The work on one tree at one precision."""

    def __init__(self, tree: RayTree) -> None:
        self.world, self.tree = tree.world, tree
        self.scenery = Scenery(tree.world)
        self.rows = [VerifiedRow() for _ in range(len(tree))]
        self.states: dict[int, State] = {}
        self.own: list[BallVector | None] = [None] * len(tree)  # local term or background; None: not certain
        self.sent: dict[int, Sent] = {}
        self.undecided: dict[int, Ball] = {}  # rows whose children are not certain: the sum of their factors
        self.cut = ball(0.0)  # weight of the rays that were not followed
        self.decisions = self.certified = 0

    def run(self, bits: int, progress: Callable[[float], None]) -> VerifiedTree:
        self.states[0] = self.first_state()
        for i in range(len(self.tree)):
            if i in self.states:
                self.trace(i)
            if i % REPORTED == 0:
                progress(i / len(self.tree))
        self.sum_up()
        reason = self.tree.radiance_bound.reason
        unbounded = reason if math.isinf(max(high for _, high in self.rows[0].radiance)) else ""
        counts = (self.decisions, self.certified, self.scenery.tested, self.scenery.boxed)
        cut = bounds(self.cut)[1]
        red, green, blue = (up_product(cut, most) for most in self.most())
        return VerifiedTree(self.rows, bits, *counts, cut, (red, green, blue), unbounded)

    def most(self) -> list[float]:
        """B, the most that a ray can bring, by channel."""
        return [b * ROUNDING for b in self.tree.radiance_bound.rgb]

    def first_state(self) -> State:
        """The camera ray, or the ray by hand."""
        world, tree = self.world, self.tree
        view = world.view(tree.size)
        if tree.ray is not None:
            o, d = balls(tree.ray[0]), unit(balls(tree.ray[1]))
        else:
            camera = placed_camera(world.scene, world.extent, tree.size)
            o, d = camera_ray(camera, view, *tree.image_point)
        eye = (tree.nodes["origin"][0, 0].item(), tree.nodes["origin"][0, 1].item(), tree.nodes["origin"][0, 2].item())
        words = world.eye(eye).solids.tolist()
        inside = {WORD * k + bit for k, word in enumerate(words) for bit in range(WORD) if word >> bit & 1}
        return State(o, d, ball(1.0), frozenset(inside), ())

    def decide(self, i: int, doubt: str) -> bool:
        """Count a decision of row i. `doubt` is empty if it is certified."""
        self.decisions += 1
        self.certified += not doubt
        if doubt:
            self.rows[i].doubts += (doubt,)
        return not doubt

    def trace(self, i: int) -> None:
        """Certify row i, enclose its numbers, and hand its children their rays."""
        row, recorded, state = self.rows[i], self.tree.nodes[i], self.states[i]
        row.weight = bounds(state.weight)
        found = first_interface(self.scenery, state.o, state.d, state.start, state.inside)
        shown = found.shown if found else None
        owner = int(self.scenery.owners[shown.face.surface]) if shown else -1
        n1 = self.index(found.before) if found else math.nan
        p = add(state.o, scale(shown.t, state.d)) if shown else None
        if found is None:
            doubt = "which surface it meets"
        elif owner != recorded["object"] or (owner < 0) != (recorded["end"] == BACKGROUND):
            doubt = "it meets another surface than recorded"
        elif not self.is_recorded(i, found):
            doubt = "it meets another face than recorded"
        elif p and not self.is_at(i, p):
            doubt = "it meets the surface at another point than recorded"
        elif n1 != recorded["n1"] or self.differs_behind(found, owner, recorded["n2"]):
            doubt = "it runs in another medium than recorded"
        else:
            doubt = ""
        above = recorded["parent"]
        row.certified = self.decide(i, doubt) and bool(above < 0 or self.rows[above].certified)
        if doubt or found is None:
            return
        if shown is None or p is None:
            self.own[i] = balls(self.world.scene.background.color)
            return
        row.point = (bounds(p[0]), bounds(p[1]), bounds(p[2]))
        if shown.entering is None:
            self.doubt(i, "from which side it meets the surface")
            return
        side = ball(1 if shown.entering else -1)
        item = self.world.scene.objects[owner]
        n = scale(side, shown.normal)
        hit = Hit(item, state.d, n, n, n1, n1 if item.thin else self.index(found.behind))
        interpolated = shown.face.shading_normal(p, shown.normal)
        if interpolated is not shown.normal:
            usable = usable_normal(hit, scale(side, interpolated))
            if usable is None:
                self.doubt(i, "which normal it is shaded with")
                return
            hit = hit._replace(normal=usable)
        self.light(i, hit, shown.normal, p, found.faces)
        self.scatter(i, hit, p, found.faces, found.before, found.behind)

    def is_recorded(self, i: int, found: Interface) -> bool:
        """Whether the face on which row i was recorded lies at the interface, or in one plane with it."""
        if found.shown is None:
            return True
        details = self.tree.details
        faces = self.scenery.faces(int(details.surface[i])) or ()
        if len(faces) > 1:
            faces = [face for face in faces if face.may_have_normal(details.face_normal[i].tolist())]
        return any(face is own or face.is_same(own) for face in faces for own in found.faces)

    def is_at(self, i: int, p: BallVector) -> bool:
        """Whether row i was recorded at this point, within its told error. A ray can meet a curved surface twice."""
        row = self.tree.nodes[i]
        error = float(row["error"])
        ends = zip(row["point"].tolist(), map(bounds, p), strict=True)
        return not any(x < low - error or x > high + error for x, (low, high) in ends)

    def doubt(self, i: int, doubt: str) -> None:
        """Count a decision of row i that is not certified, without which the row is not."""
        self.decide(i, doubt)
        self.rows[i].certified = False

    def differs_behind(self, found: Interface, owner: int, recorded: float) -> bool:
        """Whether another medium was recorded behind the interface."""
        item = self.world.scene.objects[owner]
        if found.shown is None or item.material.transmit == 0.0 or item.thin:
            return False
        return self.index(found.behind) != recorded

    def index(self, solids: Solids) -> float:
        """Index of refraction of the medium in a set of solids."""
        k = medium(solids)
        return float(self.world.arrays.indices[k]) if k >= 0 else VACUUM

    def children(self, i: int, shadows: bool) -> list[int]:
        kinds = self.tree.nodes["kind"]
        return [k for k in self.tree.children[i] if (kinds[k] == SHADOW) == shadows]

    def light(self, i: int, hit: Hit, outward: BallVector, p: BallVector, start: Sequence[Face]) -> None:
        """Enclose the local term of row i, and certify its shadow rays."""
        scene = self.world.scene
        color, sure = surface_color(hit.item, outward, p)
        if hit.item.material.checker:
            if not sure:
                doubt = "which colour of the checker"
            else:
                doubt = "" if self.has_recorded(i, color) else "it has another colour than recorded"
            self.decide(i, doubt)
        ambient, strength = balls(scene.tracing.ambient), ball(hit.item.material.ambient)
        total = tuple(strength * ambient[k] * color[k] for k in range(3))
        recorded = {int(self.tree.nodes["light"][k]): k for k in self.children(i, True)}
        for j in range(len(scene.lights)):
            share = light_share(self.scenery, hit, color, p, start, j)
            total = (total[0] + share.rgb[0], total[1] + share.rgb[1], total[2] + share.rgb[2])
            k = recorded[j]
            doubt = share.doubt
            if not doubt and share.passage is not None:
                end = self.tree.nodes["end"][k]
                doubt = "" if end == expected_end(share.passage) else "it ends otherwise than recorded"
            if not doubt and hit.item.material.is_lit and self.tree.faces_away(k) != (share.passage is None):
                doubt = "it faces the light or not, otherwise than recorded"
            shadow = self.rows[k]
            passes = between(share.passage.low, share.passage.high) if share.passage else ball(0.0)
            shadow.certified = self.decide(k, doubt) and self.rows[i].certified
            shadow.weight = bounds(self.states[i].weight * passes)
            shadow.radiance = (bounds(share.rgb[0]), bounds(share.rgb[1]), bounds(share.rgb[2]))
        self.own[i] = (total[0], total[1], total[2])

    def has_recorded(self, i: int, color: BallVector) -> bool:
        """Whether row i was recorded with this colour of its checker."""
        arrays, row = self.world.arrays, self.tree.nodes[i]
        this = arrays.objects[int(row["object"])]
        x, y, z = row["point"].tolist()
        recorded = recorded_color(arrays.materials[this.material], this, (x, y, z))
        return all(low <= c <= high for c, (low, high) in zip(recorded, map(bounds, color), strict=True))

    def scatter(self, i: int, hit: Hit, p: BallVector, faces: tuple[Face, ...], before: Solids, behind: Solids) -> None:
        """Hand the recorded children of row i their rays."""
        rays = scattered(hit, self.tree.model)
        material = hit.item.material
        recorded = {self.tree.kind(k): k for k in self.children(i, False)}
        doubt = ""
        if rays is None:
            doubt = "total internal reflection or not"
        elif not recorded.keys() <= rays.keys():
            doubt = "it sends out other rays than recorded"
        if material.transmit > 0.0 or doubt:
            self.decide(i, doubt)
        if doubt or rays is None:
            self.rows[i].certified = False
            factors = ball(material.reflect) + ball(material.transmit)
            if recorded:
                self.undecided[i] = factors
            else:
                self.cut = self.cut + self.states[i].weight * factors
            return
        for kind, ray in rays.items():
            weight = self.states[i].weight * ray.factor
            k = recorded.get(kind)
            if k is None:
                self.cut = self.cut + weight
            else:
                self.sent[k] = ray
                self.states[k] = State(p, ray.direction, weight, behind if ray.refracted else before, faces)

    def sum_up(self) -> None:
        """Enclose the radiances, from the last row to the first: certain terms in balls, and at most so much more."""
        most = self.most()
        sums: dict[int, tuple[BallVector, list[float]]] = {}
        for i in range(len(self.tree) - 1, -1, -1):
            if self.tree.nodes["kind"][i] == SHADOW:
                continue
            own, row = self.own[i], self.rows[i]
            if i not in self.states or own is None:
                row.radiance = ((0.0, most[0]), (0.0, most[1]), (0.0, most[2]))
                sums[i] = (balls((0.0, 0.0, 0.0)), list(most))
                continue
            total, more = own, [0.0, 0.0, 0.0]
            if i in self.undecided:
                more = [up_product(bounds(self.undecided[i])[1], most[k]) for k in range(3)]
            else:
                for k in self.children(i, False):
                    factor = self.sent[k].factor
                    below, extra = sums.pop(k)
                    total = add(total, scale(factor, below))
                    highest = bounds(factor)[1]
                    more = [up_sum(more[c], up_product(highest, extra[c])) for c in range(3)]
            sums[i] = (total, more)
            ranges = [bounds(total[c]) for c in range(3)]
            red, green, blue = ((max(low, 0.0), up_sum(high, more[c])) for c, (low, high) in enumerate(ranges))
            row.radiance = (red, green, blue)


def camera_ray(camera: Camera, view: View, x: float, y: float) -> tuple[BallVector, BallVector]:
    """(origin, unit direction) of the ray through an image point, from the camera's numbers without rounding."""
    assert camera.position is not None and camera.look_at is not None
    eye = balls(camera.position)
    forward = unit(subtract(balls(camera.look_at), eye))
    right = unit(cross(forward, balls(camera.up)))
    half = (flint().arb.pi() * ball(camera.fov) / 360).tan() / view.height
    u, v = half * (2 * ball(x) - view.width), half * (view.height - 2 * ball(y))
    return eye, unit(add(forward, add(scale(u, right), scale(v, cross(right, forward)))))


def expected_end(passage: Passage) -> int:
    """The end of a shadow row."""
    return BLOCKED if passage.high == 0 else FILTERED if passage.through_glass else LIT
