"""A scene as seen by one camera in one part of the canvas: which objects are visible, and which parts of rays.

It is computed once for all steps of a figure. Whether a point is hidden is decided by a ray of the tracer.
"""

import math
from dataclasses import dataclass

import numpy as np

import tracer
from tracer.kernel.world import World
from viewer.base.orbit import Frame, Orbit, project
from viewer.base.theme import ARROW_AT
from viewer.figures.marks import Piece, Point, Rectangle, clipped, inside, widened
from viewer.figures.ray_lines import RayLine
from viewer.figures.visible.scenery import occluder_world, orbit_camera, visible_parts

PIECES = 24  # a ray is tested at this many points; the limits between visible and hidden parts are then bisected
HALVINGS = 7
NEAR = 1e-3  # of the scene's radius: nothing nearer to the camera is drawn


@dataclass(frozen=True)
class Stretch:
    """A part of a ray's line on the canvas, from share `begin` to share `end` of its length."""

    begin: float
    end: float
    seen: bool


class SceneView:
    """A scene as seen by one camera in one rectangle."""

    def __init__(self, world: World, orbit: Orbit, where: Rectangle) -> None:
        self.world, self.where, self.orbit = world, where, orbit
        self.frame = Frame.of(world)
        self.camera = orbit_camera(orbit, self.frame)
        self.size = (where[2] - where[0], where[3] - where[1])
        self.matrix = orbit.matrix(self.size[0] / self.size[1])
        self.seen = visible_parts(world, self.camera, where)
        self.blockers = occluder_world(world, self.camera)
        self.stretches: dict[tuple, list[Stretch]] = {}

    def at(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(places on the canvas, depths) of points of the frame (n, 3)."""
        places, depths = project(points, self.matrix, self.size)
        return places + self.where[:2], depths

    def point_size(self, point: np.ndarray) -> float:
        """The size in the frame of a point (1/72 inch) on the canvas, at the distance of a point of the frame."""
        return self.orbit.pixel_at(point, self.size[1])

    def piece(self, line: RayLine, begin: float, end: float, width: float = 0.0) -> Piece | None:
        """The part of a ray, from share to share of its length, that is in front of the camera and inside the figure
        with a line of this width; None if there is none.
        """
        ends = np.array([line.start + share * (line.end - line.start) for share in (begin, end)])
        places, depths = self.at(ends)
        if (depths <= NEAR).all():
            return None
        if (depths <= NEAR).any():
            share = (NEAR - depths[0]) / (depths[1] - depths[0])
            ends[int(np.argmin(depths))] = ends[0] + share * (ends[1] - ends[0])
            places, _ = self.at(ends)
        (x0, y0), (x1, y1) = places.tolist()
        half = 0.5 * width / max(1e-9, math.hypot(x1 - x0, y1 - y0))
        aside, above = half * abs(y1 - y0), half * abs(x1 - x0)
        left, top, right, bottom = self.where
        piece: Piece = ((x0, y0), (x1, y1))
        return clipped(piece, (left + aside, top + above, right - aside, bottom - above))

    def arrow_at(self, line: RayLine, room: float) -> float:
        """The place of a ray's arrow: the usual one, or the middle of the visible part. 0 if there is none that is at
        least `room` away from the figure's border.
        """
        shares = np.linspace(0.0, 1.0, 101)
        places, depths = self.at(line.start + shares[:, None] * (line.end - line.start))
        left, top, right, bottom = widened(self.where, -room)
        x, y = places.T
        seen = (depths > 0.0) & (x > left) & (x < right) & (y > top) & (y < bottom)
        if seen[round(100 * ARROW_AT)]:
            return ARROW_AT
        return float(np.median(shares[seen])) if seen.any() else 0.0

    def place(self, point: np.ndarray) -> Point | None:
        """A point of the frame on the canvas; None if it is not inside."""
        places, depths = self.at(point[None])
        x, y = places[0].tolist()
        return (x, y) if depths[0] > 0.0 and inside((x, y), self.where) else None

    def hidden(self, point: np.ndarray) -> bool:
        """Whether an opaque object is between the camera and a point of the frame."""
        if self.blockers is None:
            return False
        eye = np.array(self.camera.position)
        gaze = self.frame.middle + self.frame.radius * point - eye
        far = float(np.linalg.norm(gaze))
        tree = tracer.trace(self.blockers, ray=(eye.tolist(), gaze.tolist()), depth=0)
        return bool(tree.nodes["t"][0] < far * (1.0 - 1e-6))

    def parts(self, line: RayLine) -> list[Stretch]:
        """The visible and hidden parts of a ray. Shares are of its length in space."""
        key = (*line.start, *line.end)
        if key not in self.stretches:
            self.stretches[key] = self._parts(line)
        return self.stretches[key]

    def _parts(self, line: RayLine) -> list[Stretch]:
        def hidden(share: float) -> bool:
            return self.hidden(line.start + share * (line.end - line.start))

        shares = [(k + 0.5) / PIECES for k in range(PIECES)]
        states = [hidden(share) for share in shares]
        borders, found = [0.0], []
        for k in range(PIECES - 1):
            if states[k] != states[k + 1]:
                low, high = shares[k], shares[k + 1]
                for _ in range(HALVINGS):
                    middle = 0.5 * (low + high)
                    low, high = (middle, high) if hidden(middle) == states[k] else (low, middle)
                found.append(Stretch(borders[-1], 0.5 * (low + high), not states[k]))
                borders.append(0.5 * (low + high))
        return [*found, Stretch(borders[-1], 1.0, not states[-1])]
