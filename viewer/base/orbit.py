"""The camera of the 3D view: it orbits around a target, zooms and pans.

It works in a frame of its own (`Frame`), whose origin is the centre of the scene and whose unit is the scene's
radius. So the same numbers suit a scene of light years and one of nanometres, and float32 is enough to draw either.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from tracer.formulas.camera import View
from tracer.formulas.vector import rescale, unit
from tracer.kernel.world import World
from tracer.scene.scene import middle_and_radius
from tracer.shapes.plane import Plane

ENDLESS = 3.0  # a surface with a radius above this many distances from camera to `look_at` is ignored in the frame
FOV = math.radians(35)
WIDE = 16 / 9  # width over height of the pictures that distances are chosen for
CLOSEST, FARTHEST = 0.02, 60.0  # distance to the target
REMOTE = 1e9  # largest distance of a target from the scene, in its radii
STEEPEST = math.radians(89)
MARGIN = 0.04  # share of the picture that `fit` leaves free around the points
AZIMUTH, ELEVATION, DISTANCE = 38.0, 22.0, 2.6  # the default view: degrees, and radii of the scene
SIDES = tuple(  # azimuth and elevation of the views that are tried, in this order
    (azimuth, elevation) for elevation in (ELEVATION, 6.0, -ELEVATION) for azimuth in (AZIMUTH, -AZIMUTH, 14.0, -14.0)
)
NEAR_SHARE = 1 / 400  # the near plane, relative to the distance


@dataclass(frozen=True)
class Frame:
    """The scene's centre and radius."""

    middle: np.ndarray
    radius: float

    @staticmethod
    def of(world: World) -> "Frame":
        """The frame of a world: of its bounded surfaces, and if it has others, or none, also of the eye and the point
        that the camera looks at. They say how much of an infinite plane belongs to the scene.
        """
        boxes = _in_proportion(world)
        if any(item.shape.bounds() is None for item in world.scene.objects) or not len(boxes):
            boxes = np.concatenate([boxes, _gaze(world)[:, None].repeat(2, axis=1)])
        middle, radius = middle_and_radius(boxes)
        return Frame(middle, radius if radius > 0.0 else 1.0)

    def inside(self, points: np.ndarray | tuple) -> np.ndarray:
        """World points (..., 3) in this frame."""
        return (np.asarray(points, float) - self.middle) / self.radius


def _gaze(world: World) -> np.ndarray:
    """(2, 3): the eye and the point that it looks at."""
    view, camera = world.view(), world.scene.camera
    target = camera.look_at if camera.position and camera.look_at else np.add(view.eye, view.forward)
    return np.array([view.eye, target], float)


def _in_proportion(world: World) -> np.ndarray:
    """The boxes (n, 2, 3) of the scene without those that are far larger than the distance from camera to `look_at`.

    A huge floor, or the Earth, would leave nothing else to be seen.
    """
    camera, boxes = world.scene.camera, world.bounds
    if camera.position is None or camera.look_at is None:
        return boxes
    sizes = 0.5 * np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1)
    fitting = sizes <= ENDLESS * math.dist(camera.position, camera.look_at)
    return boxes[fitting] if fitting.any() else boxes


@dataclass
class Orbit:
    """Angles in radians; `target` and `distance` in the frame. `up` is the axis of the orbit, `north` is azimuth 0."""

    azimuth: float = 0.0
    elevation: float = 0.0
    distance: float = 2.6
    target: np.ndarray = field(default_factory=lambda: np.zeros(3))
    north: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    up: np.ndarray = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))

    @staticmethod
    def beside(view: View, up: tuple, azimuth: float, elevation: float, distance: float) -> "Orbit":
        """A camera at these angles (degrees) from the scene's camera, around the origin of the frame."""
        axis = np.array(unit(rescale(up)))
        back = -np.array(view.forward)
        north = back - (back @ axis) * axis
        if np.linalg.norm(north) < 1e-6:
            north = np.array(view.up) - (np.array(view.up) @ axis) * axis
        north /= np.linalg.norm(north)
        return Orbit(math.radians(azimuth), math.radians(elevation), distance, np.zeros(3), north, axis)

    @staticmethod
    def of_camera(view: View, up: tuple, eye: np.ndarray) -> "Orbit":
        """The scene's own camera. `eye` is its position in the frame."""
        orbit = Orbit.beside(view, up, 0.0, 0.0, 1.0)
        forward = np.array(view.forward)
        orbit.elevation = math.asin(float(np.clip(-forward @ orbit.up, -1.0, 1.0)))
        orbit.distance = max(0.5, float(-eye @ forward))
        orbit.target = eye + orbit.distance * forward
        return orbit

    def fit(self, points: np.ndarray) -> None:
        """Move back until all these points (n, 3) of the frame are in a picture of 3:2."""
        for _ in range(60):
            places, depths = project(points, self.matrix(1.5), (1.0, 1.0))
            if (depths > 0.0).all() and (np.abs(places - 0.5) <= 0.5 - MARGIN).all():
                return
            self.distance *= 1.05

    @property
    def outward(self) -> np.ndarray:
        """Unit vector from the target to the eye."""
        east = _cross(self.up, self.north)
        level = math.cos(self.azimuth) * self.north + math.sin(self.azimuth) * east
        return math.cos(self.elevation) * level + math.sin(self.elevation) * self.up

    @property
    def eye(self) -> np.ndarray:
        return self.target + self.distance * self.outward

    @property
    def axes(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors to the right and up in the picture."""
        right = _cross(self.up, self.outward)
        right /= np.linalg.norm(right)
        return right, _cross(self.outward, right)

    def view(self, frame: Frame) -> tuple[float, ...]:
        """Azimuth and elevation in degrees, distance in radii of the scene, and the target in the world."""
        target = frame.middle + frame.radius * self.target
        return (math.degrees(self.azimuth), math.degrees(self.elevation), self.distance, *target.tolist())

    def turn(self, dx: float, dy: float) -> None:
        """Rotate by these angles in radians, so that the scene follows the mouse."""
        self.azimuth -= dx
        self.elevation = min(STEEPEST, max(-STEEPEST, self.elevation + dy))

    def slide(self, dx: float, dy: float) -> None:
        """Pan by these fractions of the picture's height, so that the point under the mouse stays there."""
        right, up = self.axes
        step = 2.0 * math.tan(FOV / 2) * self.distance
        self.target = self.target - step * dx * right + step * dy * up

    def zoom(self, steps: float) -> None:
        self.distance = min(FARTHEST, max(CLOSEST, self.distance * 0.88**steps))

    def framed(self, aspect: float) -> "Orbit":
        """The same view for a picture of this width over height: one that is narrower than 16:9 is seen from farther
        away, since it shows less on both sides.
        """
        return replace(self, distance=self.distance * max(1.0, math.sqrt(WIDE / aspect)))

    def pixel_at(self, point: np.ndarray, height: float) -> float:
        """The size in the frame of a pixel of a picture of this height, at the distance of a point of the frame."""
        depth = max(0.0, float((self.eye - point) @ self.outward))
        return 2.0 * math.tan(FOV / 2) * depth / height

    def direction_to(self, point: np.ndarray) -> tuple[float, float] | None:
        """The unit vector, to the right and down, from the picture's centre towards a point of the frame, which may be
        behind the camera: there one would have to turn. None if the point is straight ahead or straight behind.
        """
        right, up = self.axes
        x, y = float((point - self.eye) @ right), float((point - self.eye) @ up)
        far = math.hypot(x, y)
        return (x / far, -y / far) if far > 1e-9 * float(np.linalg.norm(point - self.eye)) else None

    def matrix(self, aspect: float) -> np.ndarray:
        """The matrix (4, 4) from the frame to clip coordinates, for column vectors. `aspect` is width over height."""
        right, up = self.axes
        back = self.outward
        eye = self.eye
        look = np.eye(4)
        look[0, :3], look[1, :3], look[2, :3] = right, up, back
        look[:3, 3] = -look[:3, :3] @ eye
        near = self.distance * NEAR_SHARE
        far = self.distance + 60.0
        f = 1.0 / math.tan(FOV / 2)
        lens = np.zeros((4, 4))
        lens[0, 0], lens[1, 1] = f / aspect, f
        lens[2, 2], lens[2, 3] = (far + near) / (near - far), 2 * far * near / (near - far)
        lens[3, 2] = -1.0
        return lens @ look


class ViewAngles(Protocol):
    """A view that an author chose: angles in degrees, distance in radii of the scene, target in the world (None: its
    centre).
    """

    @property
    def azimuth(self) -> float: ...
    @property
    def elevation(self) -> float: ...
    @property
    def distance(self) -> float: ...
    @property
    def target(self) -> tuple[float, float, float] | None: ...


def orbit_beside(
    world: World, frame: Frame, azimuth: float, elevation: float, distance: float, target: Sequence[float] | None
) -> Orbit:
    """A camera at these angles (degrees) from the scene's camera. `target` is a point of the world, None for its
    centre. ValueError if the target is too far from the scene.
    """
    orbit = Orbit.beside(world.view(), world.scene.camera.up, azimuth, elevation, distance)
    if target:
        with np.errstate(over="ignore"):
            orbit.target = frame.inside(tuple(target))
        if not np.abs(orbit.target).max() <= REMOTE:
            said = ",".join(map(repr, target))
            raise ValueError(f"the target of the 3D view must be within {REMOTE:g} radii of the scene, got {said}")
    return orbit


def initial_orbit(world: World, frame: Frame, view: ViewAngles | None) -> Orbit:
    """The first view of a scene: `view`, or one from beside the scene's camera that shows the camera and the scene. Of
    several, the first one that has the fewest surfaces in front of the scene's camera; the rest is not tried after one
    that has none.
    """
    if view:
        return orbit_beside(world, frame, view.azimuth, view.elevation, view.distance, view.target)
    eye, target = frame.inside(world.view().eye), world.scene.camera.look_at
    seen = [frame.inside(target)] if target else []

    def seen_from(side: tuple[float, float]) -> Orbit:
        orbit = orbit_beside(world, frame, *side, DISTANCE, None)
        orbit.target = 0.35 * eye
        orbit.fit(np.stack([eye, *seen, np.zeros(3)]))
        return orbit

    tried: list[tuple[int, Orbit]] = []
    for side in SIDES:
        orbit = seen_from(side)
        tried.append((_hiding(world, frame, orbit.eye), orbit))
        if tried[-1][0] == 0:
            break
    return min(tried, key=lambda one: one[0])[1]


def _hiding(world: World, frame: Frame, place: np.ndarray) -> int:
    """The number of planes between a place of the frame and the scene's camera, and of boxes around the place that are
    not around the camera.
    """
    places = np.array([frame.middle + frame.radius * place, world.view().eye])
    planes = [shape for item in world.scene.objects if isinstance(shape := item.shape, Plane)]
    beyond = sum(len({bool(np.dot(at - plane.point, plane.normal) > 0.0) for at in places}) > 1 for plane in planes)
    low, high = world.bounds[:, None, 0], world.bounds[:, None, 1]
    around = np.all(np.logical_and(low < places, places < high), axis=2)  # (boxes, 2)
    return beyond + int(np.sum(around[:, 0] & ~around[:, 1]))


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The cross product of two vectors. For single vectors, numpy's takes five times as long."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def project(points: np.ndarray, matrix: np.ndarray, size: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """(places, depths): points (n, 3) of the frame in pixels from the top left; depth <= 0 is behind the camera."""
    clip = np.c_[points, np.ones(len(points))] @ matrix.T
    depth = clip[:, 3]
    safe = np.where(np.abs(depth) < 1e-12, 1e-12, depth)
    x = (0.5 + 0.5 * clip[:, 0] / safe) * size[0]
    y = (0.5 - 0.5 * clip[:, 1] / safe) * size[1]
    return np.stack([x, y], axis=1), depth
