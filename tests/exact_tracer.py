"""The judge of whole trees: Whitted's recursion with 100 digits, from the scene and the camera as written.

It shares no code with the tracer, decides everything itself by trying every surface, and knows no hierarchy. Distances
below NOTHING of the scene's size are 0, and distances that differ by less are equal. A transparent object bounds one
solid.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mpmath import mp, mpf

from tests.exact_scene import DIGITS, Surface, V, add, cross, dot, mul, newell, norm, sub, surfaces, unit, vec
from tracer.formulas.vector import VectorLike
from tracer.scene import Camera, Light, Object, Scene

NOTHING = mpf(10) ** -30


@dataclass
class Ray:
    """A ray of the judge's tree; the fields have the names of the node table's."""

    kind: str
    origin: V
    direction: V
    factor: mpf
    weight: mpf
    depth: int
    inside: frozenset[int]  # the objects whose solid it is in
    t: Any = None
    point: Any = None
    normal: Any = None
    object: int = -1
    n1: Any = None
    n2: Any = None
    radicand: Any = None
    local: Any = None
    radiance: Any = None
    visible: dict[int, mpf | None] = field(default_factory=dict)  # by light: the share that passes; None: faces away
    children: list["Ray"] = field(default_factory=list)


def camera_ray(camera: Camera, size: tuple[int, int], x: float, y: float) -> tuple[V, V]:
    """(origin, unit direction) of the ray through the image point (x, y), from the camera's numbers without
    rounding.
    """
    assert camera.position is not None and camera.look_at is not None
    with mp.workdps(DIGITS):
        eye = vec(camera.position)
        forward = unit(sub(vec(camera.look_at), eye))
        right = unit(cross(forward, vec(camera.up)))
        up, half = cross(right, forward), mp.tan(mp.pi * mpf(camera.fov) / 360)
        u, v = half * (2 * mpf(x) - size[0]) / size[1], half * (size[1] - 2 * mpf(y)) / size[1]
        return eye, unit(add(forward, add(mul(u, right), mul(v, up))))


def given_ray(origin: VectorLike, direction: VectorLike) -> tuple[V, V]:
    """A ray by hand. The tracer rounds its direction to a unit vector."""
    with mp.workdps(DIGITS):
        return vec(origin), unit(vec(direction))


class Judge:
    """Traces rays of one scene."""

    def __init__(self, scene: Scene, depth: int, model: str = "") -> None:
        self.scene, self.depth, self.model = scene, depth, model or scene.tracing.model
        self.surfaces = surfaces(scene)
        self.closed = [item.shape.is_closed() for item in scene.objects]
        boxes = [item.shape.bounds() for item in scene.objects]
        points = [scene.camera.position or (1.0, 1.0, 1.0), *(box for box in boxes if box is not None)]
        self.nothing = NOTHING * max(float(np.abs(point).max()) for point in points)

    def tree(self, origin: V, direction: V) -> Ray:
        inside = frozenset(k for k, item in enumerate(self.scene.objects) if self.starts_inside(k, item, origin))
        ray = Ray("camera", origin, direction, mpf(1), mpf(1), 0, inside)
        with mp.workdps(DIGITS):
            self.trace(ray)
        return ray

    def starts_inside(self, k: int, item: Object, p: V) -> bool:
        """Closed solids only: along any line through the point, the nearest crossing leaves the solid."""
        if not self.is_medium(item) or not self.closed[k]:
            return False
        way = unit(vec((0.3817, 0.5519, 0.7413)))
        found = [hit for s in self.surfaces if s.owner == k for hit in s.crossings(p, way)]
        if not found:
            return False
        t, n, _ = min(found, key=lambda hit: abs(hit[0]))
        return (dot(n, way) > 0) == (t > 0)

    @staticmethod
    def is_medium(item: Object) -> bool:
        return item.material.transmit > 0 and not item.thin

    def hits(self, origin: V, direction: V) -> list[tuple[mpf, Surface, V, V]]:
        """All crossings in front of the origin, nearest first, ties in the file's order."""
        found = []
        for order, s in enumerate(self.surfaces):
            for t, n, shading in s.crossings(origin, direction):
                if t > self.nothing:
                    found.append((t, order, s, n, shading))
        found.sort(key=lambda hit: (hit[0], hit[1]))
        return [(t, s, n, shading) for t, _, s, n, shading in found]

    def interface(self, ray: Ray) -> tuple[tuple[mpf, Surface, V, V] | None, frozenset[int], frozenset[int]]:
        """(hit that is shown, objects before it, objects behind it)."""
        before = ray.inside
        hits = self.hits(ray.origin, ray.direction)
        while hits:
            t = hits[0][0]
            here = [hit for hit in hits if hit[0] - t <= self.nothing]
            hits = hits[len(here) :]
            opaque = [hit for hit in here if self.material(hit[1]).transmit == 0]
            sheets = [hit for hit in here if self.scene.objects[hit[1].owner].thin]
            media = [hit for hit in here if self.is_medium(self.scene.objects[hit[1].owner])]
            behind = set(before)
            for _, s, n, _ in media:
                if dot(n, ray.direction) < 0:
                    behind.add(s.owner)
                else:
                    if not self.closed[s.owner] and s.owner not in before:
                        before |= {s.owner}
                    behind.discard(s.owner)
            if opaque:
                return opaque[0], before, frozenset(behind)
            old, new = self.medium(before), self.medium(frozenset(behind))
            if old != new:
                seen = new if old < 0 else old if new < 0 else min((old, new), key=self.rank)
                enters = seen in behind
                for hit in media:
                    if hit[1].owner == seen and (dot(hit[2], ray.direction) < 0) == enters:
                        return hit, before, frozenset(behind)
            if sheets:
                return sheets[0], before, frozenset(behind)
            before = frozenset(behind)
        return None, before, before

    def rank(self, k: int) -> tuple[int, int]:
        return (-self.scene.objects[k].priority, k)

    def medium(self, inside: frozenset[int]) -> int:
        return min(inside, key=self.rank) if inside else -1

    def index(self, inside: frozenset[int]) -> mpf:
        k = self.medium(inside)
        return mpf(self.scene.objects[k].material.ior) if k >= 0 else mpf(1)

    def material(self, s: Surface):
        return self.scene.objects[s.owner].material

    def trace(self, ray: Ray) -> None:
        hit, before, behind = self.interface(ray)
        ray.n1 = self.index(before)
        if hit is None:
            ray.local = ray.radiance = vec(self.scene.background.color)
            return
        t, s, n, shading = hit
        item, material, d = self.scene.objects[s.owner], self.material(s), ray.direction
        sign = 1 if dot(n, d) < 0 else -1
        n, shading = mul(sign, n), mul(sign, shading)
        ray.t, ray.object, ray.point = t, s.owner, add(ray.origin, mul(t, d))
        if material.transmit > 0:
            ray.n2 = ray.n1 if item.thin else self.index(behind)
            if shading != n and not self.is_usable(d, n, shading, ray.n1, ray.n2):
                shading = n
            ray.radicand = self.root_of(d, shading, ray.n1, ray.n2)
        elif shading != n and not dot(mirrored(d, shading), n) > 0:
            shading = n
        ray.normal = shading
        self.light(ray, item, n)
        for kind, factor, direction, inside in self.scattered(ray, item, before, behind):
            if factor > 0 and ray.depth < self.depth:
                child = Ray(kind, ray.point, direction, factor, ray.weight * factor, ray.depth + 1, inside)
                ray.children.append(child)
                self.trace(child)
        total = ray.local
        for child in ray.children:
            total = add(total, mul(child.factor, child.radiance))
        ray.radiance = total

    @staticmethod
    def root_of(d: V, n: V, n1: mpf, n2: mpf) -> mpf:
        across = cross(d, n)
        return 1 - (n1 / n2) ** 2 * dot(across, across)

    def is_usable(self, d: V, n: V, shading: V, n1: mpf, n2: mpf) -> bool:
        if dot(d, shading) >= 0 or dot(mirrored(d, shading), n) <= 0:
            return False
        root = self.root_of(d, shading, n1, n2)
        return root <= 0 or dot(refracted(d, shading, n1, n2, root), n) < 0

    def scattered(self, ray: Ray, item: Object, before: frozenset[int], behind: frozenset[int]):
        material, d, n = item.material, ray.direction, ray.normal
        kr, kt = mpf(material.reflect), mpf(material.transmit)
        mirror = mirrored(d, n)
        if kt == 0:
            yield "reflection", kr, mirror, before
            return
        fresnel = self.model == "fresnel"
        n1, n2 = ray.n1, mpf(material.ior) if item.thin else ray.n2
        if n1 == n2 and not item.thin:
            yield "refraction", kr + kt if fresnel else kt, d, behind
            return
        root = self.root_of(d, n, n1, n2)
        if root <= 0 and not item.thin:
            yield "tir", kr + kt, mirror, before
            return
        through = d if item.thin else refracted(d, n, n1, n2, root)
        reflect, transmit = kr, kt
        if fresnel:
            share = mpf(1) if root <= 0 else reflectance(-dot(d, n), mp.sqrt(root), n1, n2)
            reflect, transmit = (kr + kt) * share, (kr + kt) * (1 - share)
        yield "reflection", reflect, mirror, before
        yield "refraction", transmit, through, behind

    def light(self, ray: Ray, item: Object, face_n: V) -> None:
        """The local term, and the share of each light that arrives."""
        material, p, n, d = item.material, ray.point, ray.normal, ray.direction
        color = vec(self.color(item, p))
        ambient = vec(self.scene.tracing.ambient)
        total = tuple(mpf(material.ambient) * a * c for a, c in zip(ambient, color, strict=True))
        for j, light in enumerate(self.scene.lights):
            towards, distance = to_light(light, p)
            n_l = dot(n, towards)
            if not (material.is_lit and n_l > 0 and dot(face_n, towards) > 0):
                ray.visible[j] = None
                continue
            share = ray.visible[j] = self.transmittance(p, towards, distance)
            r_v = -dot(sub(mul(2 * n_l, n), towards), d)
            shine = mpf(material.specular) * r_v ** mpf(material.shininess) if r_v > 0 and material.specular else 0
            total = tuple(
                total[k] + share * mpf(light.color[k]) * (mpf(material.diffuse) * n_l * color[k] + shine)
                for k in range(3)
            )
        ray.local = total

    def transmittance(self, p: V, towards: V, distance: mpf) -> mpf:
        share, last, owner = mpf(1), mpf(-1), -1
        for t, s, _, _ in self.hits(p, towards):
            if t >= distance:
                break
            kt = mpf(0) if self.scene.tracing.shadows == "block" else mpf(self.material(s).transmit)
            if owner != s.owner or t - last > self.nothing:
                share *= kt
            last, owner = t, s.owner
        return share

    def color(self, item: Object, p: V):
        material = item.material
        if material.checker is None:
            return material.color
        size = mpf(material.checker.size)
        axes = [vec((1, 0, 0)), vec((0, 1, 0)), vec((0, 0, 1))]
        if item.shape.checker_in_plane:
            axes = list(plane_axes(flat_normal(item)))
        cells = sum(mp.floor(dot(axis, p) / size) for axis in axes)
        return material.checker.color if int(cells) % 2 else material.color


def flat_normal(item: Object) -> V:
    shape: Any = item.shape
    if hasattr(shape, "normal"):
        return unit(vec(shape.normal))
    return unit(newell([vec(corner) for corner in shape.vertices]))


def plane_axes(n: V) -> tuple[V, V]:
    """Two axes in a plane, near the two of the world that are farthest from its normal."""
    along = max(range(3), key=lambda k: abs(n[k]))
    first, second = (vec(float(j == k) for j in range(3)) for k in range(3) if k != along)
    v = unit(cross(n, first))
    v = mul(-1, v) if dot(v, second) < 0 else v
    u = cross(n, v)
    return mul(-1, u) if dot(u, first) < 0 else u, v


def mirrored(d: V, n: V) -> V:
    return sub(d, mul(2 * dot(n, d), n))


def refracted(d: V, n: V, n1: mpf, n2: mpf, root: mpf) -> V:
    eta = n1 / n2
    return add(mul(eta, d), mul(-eta * dot(d, n) - mp.sqrt(root), n))


def reflectance(c1: Any, c2: Any, n1: Any, n2: Any) -> Any:
    along = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2)
    across = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2)
    return (along**2 + across**2) / 2


def to_light(light: Light, p: V) -> tuple[V, mpf]:
    if light.direction is not None:
        return mul(-1, unit(vec(light.direction))), mp.inf
    assert light.position is not None
    way = sub(vec(light.position), p)
    return unit(way), norm(way)
