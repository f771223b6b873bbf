"""Signs and names over the 3D view, as marks: lights, the eye, ends of blocked shadow rays, the selected hit, labels.

No text covers another text or a sign. What is placed first has the first choice: signs, then what is said of the
selected hit, then labels of rays, then names of lights and of the eye. Lengths are logical pixels from the top left of
the view.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from tracer.formulas.vector import rescale, unit
from tracer.kernel.nodes import KINDS, SHADOW
from viewer.base.orbit import project
from viewer.base.theme import DIMMED, LABEL_TEXT as TEXT, QUIET, Color, faded
from viewer.figures import signs
from viewer.figures.font import text_box
from viewer.figures.labels import ray_label
from viewer.figures.lights import pointed_lights
from viewer.figures.marks import Disc, Line, Mark, Point, Rectangle, Shape, Stroke, Text, widened, within
from viewer.gl.canvas import Canvas
from viewer.gl.ray_pieces import clear_first, ray_pieces
from viewer.session.session import Session

SUN, EYE, CROSS = 22.0, 17.0, 15.0  # sizes of signs
NAMED, SMALL_SUN = 8, 13.0  # of more lights, the signs are small, and only that of the selected shadow ray is named
DOT = 4.5  # radius of the selected hit's disc
BORDER = 22.0  # from the border of the view to an arrow that points to what is outside
ARROW = 17.0  # its length
LABELS = 24  # rays that are named: the selected one, and the heaviest
CROSSES = 60  # blocked shadow rays that end in a cross: those of the first hits
SAMPLES = 25  # points of a ray at which its visibility is tested
SPOTS = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)  # places for a label, as shares of the visible part of a ray
SHORTEST = 10.0  # visible part of a ray that is named
BACKING = 0.78  # opacity of the background behind a text
FAR = 1e6  # the distance of a light at infinity, in radii of the scene
NEAR = 2e-5  # in depth: what is on a surface is not hidden by it


class SceneMarks:
    """The marks over one picture. `size` is the view's, `depths` are those of `Stage.depths`, `covers` are rectangles
    where other things lie over it.
    """

    def __init__(
        self, session: Session, canvas: Canvas, size: Point, depths: np.ndarray, covers: Sequence[Rectangle] = ()
    ) -> None:
        self.session, self.canvas, self.size, self.depths = session, canvas, size, depths
        self.theme = session.appearance.theme
        self.where: Rectangle = (0.0, 0.0, *size)
        self.orbit = session.orbit.framed(size[0] / size[1])
        self.matrix = self.orbit.matrix(size[0] / size[1])
        self.signs: list[Mark] = []
        self.texts: list[Mark] = []
        self.taken: list[Rectangle] = list(covers)
        self.names: list[tuple[str, Color, list[tuple[Point, str]]]] = []  # of lights and of the eye, placed last

    def marks(self) -> list[Mark]:
        """All marks, the last in front."""
        session = self.session
        if session.tree:
            self._crosses()
        if session.world and session.shown.lights:
            self._lights()
        if session.world and session.shown.camera:
            self._eye()
        if session.tree:
            self._selected()
        if session.shown.labels:
            self._ray_labels()
            for name, color, spots in self.names:
                self._text("name", name, spots, color)
        return [*self.signs, *self.texts]

    # --- places -------------------------------------------------------------------------------------------------------

    def at(self, points: np.ndarray, room: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """(places (n, 2), whether they are in the view, so far from its border) of points (n, 3) of the frame."""
        places, depths = project(points, self.matrix, self.size)
        inside = (places >= room).all(axis=1) & (places <= np.subtract(self.size, room)).all(axis=1)
        return places, (depths > 0.0) & np.isfinite(places).all(axis=1) & inside

    def seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same, with only those points in view that no opaque thing hides."""
        places, inside = self.at(points)
        clip = np.c_[points, np.ones(len(points))] @ self.matrix.T
        depth = 0.5 + 0.5 * clip[:, 2] / np.where(inside, clip[:, 3], 1.0)
        height, width = self.depths.shape
        shares = np.where(inside[:, None], places, 0.0) / self.size * (width, height)
        x, y = np.minimum(shares.astype(int), (width - 1, height - 1)).T
        return places, inside & (depth <= self.depths[y, x] + NEAR)

    def _take(self, at: Point, wide: float) -> None:
        self.taken.append(widened((*at, *at), 0.5 * wide))

    def _is_taken(self, box: Rectangle) -> bool:
        left, top, right, bottom = box  # hundreds of boxes are compared with dozens of others
        return any(right > a and c > left and bottom > b and d > top for a, b, c, d in self.taken)

    def _text(self, name: str, content: str, spots: Iterable[tuple[Point, str]], color: Color, title: str = "") -> bool:
        """Place a text at the first spot (position, anchor) with room. Returns whether there is one."""
        for at, anchor in spots:
            box = widened(text_box(at, content, TEXT, anchor), 2.0)
            if within(box, self.where) and not self._is_taken(box):
                self.taken.append(box)
                left, top, right, bottom = box
                corners = ((left, top), (right, top), (right, bottom), (left, bottom))
                self.texts.append(Shape(f"{name}-label", corners, faded(self.theme.ground, BACKING), None))
                self.texts.append(Text(f"{name}-label", at, content, TEXT, color, anchor, title=title))
                return True
        return False

    # --- signs --------------------------------------------------------------------------------------------------------

    def _crosses(self) -> None:
        """Crosses at the ends of blocked shadow rays. They are as faint as their rays."""
        lines, tree = self.canvas.lines, self.session.tree
        assert tree
        pointed = pointed_lights(tree, self.session.selected)
        blocked = np.flatnonzero(lines.blocked)[:CROSSES]
        places, inside = self.at(lines.ends[blocked])
        for k, place in zip(blocked[inside].tolist(), places[inside].tolist(), strict=True):
            row = int(lines.rows[k])
            color = faded(self.theme.ray("shadow"), 1.0 if row in pointed else QUIET)
            behind = signs.cross(f"ray-{row}", (place[0], place[1]), CROSS, faded(self.theme.ground, color[3]))
            self.signs += [_thick(mark, 2.0) for mark in behind]
            self.signs += signs.cross(f"ray-{row}", (place[0], place[1]), CROSS, color)

    def _lights(self) -> None:
        session, theme = self.session, self.theme
        assert session.world
        scene = session.world.scene
        few = len(scene.lights) <= NAMED
        size, meant = SUN if few else SMALL_SUN, self._meant_light()
        for j, light in enumerate(scene.lights):
            if light.direction:
                point = self.orbit.eye - FAR * np.array(unit(rescale(light.direction)))
            else:
                assert light.position
                point = session.frame.inside(light.position)
            places, inside = self.at(point[None], 0.5 * size)
            name = scene.light_name(j)
            if not inside[0]:
                if few or j == meant:
                    self._way_out(f"light-{j}", point, name, theme.sun)
                continue
            x, y = places[0].tolist()
            self.signs.append(Disc(f"light-{j}", (x, y), 0.5 * size, faded(theme.ground, 0.5), None))
            self.signs += signs.sun(f"light-{j}", (x, y), size, theme.sun, title=name)
            self._take((x, y), 0.8 * size)
            if few or j == meant:
                self.names.append((name, theme.text, _beside((x, y), 0.5 * size)))

    def _meant_light(self) -> int | None:
        """The light that the selected ray goes to; None if it is no shadow ray."""
        tree, selected = self.session.tree, self.session.selected_on_show
        if not tree or selected is None or tree.nodes["kind"][selected] != SHADOW:
            return None
        return int(tree.nodes["light"][selected])

    def _eye(self) -> None:
        assert self.session.world
        point = self.session.frame.inside(self.session.world.view().eye)
        places, inside = self.at(point[None], EYE)
        if not inside[0]:
            self._way_out("eye", point, "eye", self.theme.text)
            return
        x, y = places[0].tolist()
        self.signs += signs.eye((x, y), EYE, self.theme)
        self._take((x, y), 1.4 * EYE)
        self.names.append(("eye", self.theme.text, _beside((x, y), 0.9 * EYE)))

    def _way_out(self, name: str, point: np.ndarray, content: str, color: Color) -> None:
        """An arrow at the border that points to what is outside the view, with its name."""
        towards = self.orbit.direction_to(point)
        if towards is None or min(self.size) < 4.0 * BORDER:
            return
        dx, dy = towards
        half = (0.5 * self.size[0] - BORDER, 0.5 * self.size[1] - BORDER)
        reach = min(side / abs(step) if step else np.inf for side, step in zip(half, towards, strict=True))
        middle = (0.5 * self.size[0], 0.5 * self.size[1])
        # Of several arrows in one direction, the later ones stand further along the border.
        for aside in (0.0, 1.0, -1.0, 2.0, -2.0):
            tip = (middle[0] + reach * dx - aside * ARROW * dy, middle[1] + reach * dy + aside * ARROW * dx)
            if not self._is_taken(widened((*tip, *tip), 0.4 * ARROW)):
                break
        back = (tip[0] - ARROW * dx, tip[1] - ARROW * dy)
        half_wide = 0.36 * ARROW
        corners = (
            (tip[0], tip[1]),
            (back[0] - half_wide * dy, back[1] + half_wide * dx),
            (back[0] + 0.28 * ARROW * dx, back[1] + 0.28 * ARROW * dy),
            (back[0] + half_wide * dy, back[1] - half_wide * dx),
        )
        self.signs.append(Shape(name, corners, color, Stroke(self.theme.ground, 1.5), title=content))
        center = (0.5 * (tip[0] + back[0]), 0.5 * (tip[1] + back[1]))
        self._take(center, ARROW)
        spots = [((center[0] - away * dx, center[1] - away * dy), "middle") for away in (20.0, 28.0, 36.0, 48.0)]
        self.names.append((content, self.theme.text, [*_beside(center, 0.6 * ARROW), *spots]))

    def _selected(self) -> None:
        """The selected hit with its names."""
        session, theme = self.session, self.theme
        assert session.tree
        selected = session.selected_on_show
        if selected is None:
            return
        point = session.frame.inside(session.tree.nodes["point"][selected])
        places, inside = self.at(point[None])
        if not inside[0]:
            return
        x, y = places[0].tolist()
        self.signs.append(Disc("hit", (x, y), DOT + 2.0, theme.ground, None))
        self.signs.append(Disc("hit", (x, y), DOT, theme.accent, None))
        self._take((x, y), 2.0 * DOT)
        pieces = ray_pieces(self.canvas.lines, self.at) if self.canvas.names else []
        for name in self.canvas.names if session.shown.labels else ():
            places, inside = self.at(name.points)
            spots = clear_first([((p[0], p[1]), "middle") for p in places[inside].tolist()], name.content, pieces)
            self._text("interface", name.content, spots, theme.normal if name.of_normal else theme.text)

    # --- labels of rays -----------------------------------------------------------------------------------------------

    def _ray_labels(self) -> None:
        """The label of each ray beside the middle of its visible part: first the selected one, then the heaviest."""
        tree, lines, selected = self.session.tree, self.canvas.lines, self.session.selected
        if not tree or not len(lines):
            return
        rays = np.flatnonzero(lines.kinds != SHADOW)
        weights = tree.nodes["weight"][lines.rows[rays]].max(axis=1)
        order = rays[np.lexsort((lines.rows[rays], -weights, lines.rows[rays] != selected))][:LABELS]
        shares = np.linspace(0.0, 1.0, SAMPLES)[None, :, None]
        points = lines.starts[order, None] + shares * (lines.ends - lines.starts)[order, None]
        places, seen = self.seen(points.reshape(-1, 3))
        places, seen = places.reshape(-1, SAMPLES, 2), seen.reshape(-1, SAMPLES)
        begins, ends = longest_runs(seen)
        which = np.arange(len(order))
        starts, stops = places[which, begins].tolist(), places[which, ends].tolist()
        kept = self.canvas.kept
        for k, start, stop in zip(order.tolist(), starts, stops, strict=True):
            if math.dist(start, stop) < SHORTEST:
                continue
            row = int(lines.rows[k])
            color = self.theme.ray(KINDS[lines.kinds[k]])
            if kept is not None and row not in kept:
                color = faded(color, DIMMED)
            label = ray_label(tree, row)
            self._text(f"ray-{row}", label, _along((start[0], start[1]), (stop[0], stop[1]), label), color)


def longest_runs(seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(first, last): the columns of the longest run of True in each row (n, m); the same column if there is none."""
    count, columns = seen.shape
    run = np.zeros(count, int)
    longest, last = np.zeros(count, int), np.zeros(count, int)
    for k in range(columns):
        run = (run + 1) * seen[:, k]
        longer = run > longest
        longest[longer], last[longer] = run[longer], k
    return last - np.maximum(longest - 1, 0), last


def _along(start: Point, end: Point, label: str) -> Iterator[tuple[Point, str]]:
    """Places beside a line for a text, on either side: so far away that its box touches the line."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    far = max(math.hypot(dx, dy), 1e-9)
    across = (-dy / far, dx / far) if dx >= 0.0 else (dy / far, -dx / far)  # below the line first
    left, top, right, bottom = text_box((0.0, 0.0), label, TEXT, "middle")
    away = 0.5 * (right - left) * abs(across[0]) + 0.5 * (bottom - top) * abs(across[1]) + 5.0
    for share in SPOTS:
        for side in (away, -away):
            yield (start[0] + share * dx + side * across[0], start[1] + share * dy + side * across[1]), "middle"


def _beside(at: Point, away: float) -> list[tuple[Point, str]]:
    """Places around a sign."""
    x, y = at
    gap = away + 4.0
    low = away + 0.8 * TEXT
    return [
        ((x + gap, y), "start"),
        ((x - gap, y), "end"),
        ((x, y - low), "middle"),
        ((x, y + low), "middle"),
        ((x + gap, y - low), "start"),
        ((x + gap, y + low), "start"),
        ((x - gap, y - low), "end"),
        ((x - gap, y + low), "end"),
    ]


def _thick(mark: Mark, by: float) -> Mark:
    """A line, thicker on either side: the border of a sign."""
    assert isinstance(mark, Line)
    return replace(mark, stroke=replace(mark.stroke, width=mark.stroke.width + 2.0 * by))
