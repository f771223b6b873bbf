"""The scene with a pixel's rays over it. The part of a ray that is behind opaque objects is drawn faintly.

The camera is that of the 3D view. Objects are flat areas with outlines, a shade darker where they turn away from the
camera. Rays and labels are those of the tree figure.
"""

import math
import sys
from collections.abc import Sequence, Set
from dataclasses import replace

from tracer.formulas.vector import Vector
from tracer.kernel.nodes import KINDS, SHADOW
from tracer.tree.raytree import RayTree
from tracer.tree.text import heaviest_rows
from viewer.base.theme import DIMMED, HALO, STYLES, TO_LIGHT, Arrow, Color, Theme, faded
from viewer.figures import signs
from viewer.figures.figure.scene_hit import SceneHit
from viewer.figures.font import text_width
from viewer.figures.labels import ray_label, ray_title
from viewer.figures.layout.label_placement import LabelPlacer, Spot
from viewer.figures.lights import many_lights, pointed_lights
from viewer.figures.marks import Line, Mark, Piece, Point, Rectangle, Shape, Stroke, inside, point_along, widened
from viewer.figures.ray_lines import MOST_IN_FIGURE, RayLine, ray_lines, relatives
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Pages, Subject, line_share
from viewer.figures.visible.looks import between, surface_look
from viewer.figures.visible.outlines import Area
from viewer.figures.visible.scene_view import SceneView
from viewer.figures.visible.scenery import Part

SHADE = 0.09  # opacity of the shade
GLASS = 0.13  # opacity of glass
OUTLINE, CREASE = 1.3, 0.8  # widths
GLASS_SHADE = 0.6  # of the shading, on glass
FAINT = 0.3  # opacity of the hidden part of a ray
SLIM = 0.7  # of a ray's width, for shadow rays: there are many, and the figure is not about them
STRONG = 1.8  # factor of a ray's width on the page that adds it
HEAD_ROOM = 8.0  # from an arrow's middle to the border, in widths of its ray: the tail of a double arrow is 7 away
SIGN_ROOM = 1.0  # from the middle of an eye or a light to the border, in text sizes
SPOTS = (0.4, 0.5, 0.3, 0.6, 0.7, 0.2, 0.8, 0.1, 0.9)  # places for a name, as shares of the visible part of a ray
ROOMY = 2.2  # a ray this many times longer than its name has its name on it, a shorter one beside it
LABELS = 24  # rays that are named: the heaviest
FIRST = 12  # of these, rays whose names may cross other rays


Named = tuple[frozenset[int], list[Mark]]  # the rays with which a label is drawn (empty: always), and its marks


def pages(subject: Subject, style: FigureStyle, where: Rectangle | None = None) -> Pages:
    """The scene with the rays of each step."""
    view = subject.view(where or style.canvas)
    return view_pages(view, subject.steps, style.text_size, style.theme, style.selected)


def view_pages(view: SceneView, steps: Sequence[Step], size: float, theme: Theme, selected: int | None = None) -> Pages:
    """One page for each step. Names are placed for the last, the fullest step, and keep their places.

    Around the hit of the selected ray are its normal and angles. What is neither above nor below that ray is dimmed.
    """
    fullest = steps[-1]
    pointed = pointed_lights(fullest.tree, selected if selected in fullest.rows else None)
    drawings = [_Drawing(view, step, size, theme, selected, pointed) for step in steps]
    names = drawings[-1].named()
    return [
        drawing.marks + [mark for rows, marks in names if not rows or rows & drawing.step.rows for mark in marks]
        for drawing in drawings
    ]


class _Drawing:
    def __init__(
        self, view: SceneView, step: Step, size: float, theme: Theme, selected: int | None, pointed: Set[int]
    ) -> None:
        self.view, self.step, self.size, self.theme, self.pointed = view, step, size, theme, pointed
        self.tree: RayTree = step.tree
        self.scene = view.world.scene
        self.marks: list[Mark] = []
        self.names = LabelPlacer(view.where, size, theme)
        self.share = line_share(size)
        for part in view.seen.opaque:
            self._thing(part, 1.0)
        for part in view.seen.glass:
            self._thing(part, GLASS)
        # Dashes to many lights would hide all other rays: the figure has only those that the step adds to a hit.
        left_out = many_lights(self.tree)
        if step.current <= left_out:
            left_out = left_out - step.current
        self.has_many = bool(left_out)
        rows = sorted(step.rows & heaviest_rows(self.tree, MOST_IN_FIGURE, set(range(len(self.tree))) - left_out))
        self.selected = selected if selected in step.rows else None
        self.kept = None if self.selected is None else relatives(self.tree, self.selected, rows)
        self.lines = ray_lines(self.tree, rows, view.frame, frozenset(KINDS))
        for line in sorted(self.lines, key=lambda line: -line.row):  # the first rays lie over the later ones
            self._ray(line)
        self.lights = self._lights()
        self._eye()
        self.hit = None if self.selected is None else SceneHit.of(view, self.step, self.selected, size, theme)
        self.marks += self.hit.marks(view, theme, self.share) if self.hit else []

    # --- things -------------------------------------------------------------------------------------------------------

    def _thing(self, part: Part, opacity: float) -> None:
        theme = self.theme
        item = self.scene.objects[part.number]
        name = f"object-{part.number}"
        fill = faded(theme.text, GLASS) if opacity < 1.0 else surface_look(item.material, theme)
        title = self.scene.object_name(part.number)
        for k, face in enumerate(part.faces):
            for area in face:
                width = CREASE if len(part.faces) > 1 else OUTLINE
                self._area(name, area, fill, Stroke(theme.muted, width), title if k == 0 else "")
        checker = item.material.checker
        if opacity == 1.0 and checker:
            other = surface_look(replace(item.material, color=checker.color), theme)
            for colored, areas in ((between(fill, other), part.mingled), (other, part.checks)):
                for area in areas:
                    self._area(name, area, colored, None)
        # On glass, shading tells one flat face from another, such as a water surface from the side of the water.
        if opacity == 1.0 or len(part.faces) > 1:
            for shade in part.shades:
                for area in shade:
                    self._area(name, area, (0.0, 0.0, 0.0, SHADE * (1.0 if opacity == 1.0 else GLASS_SHADE)), None)

    def _area(self, name: str, area: Area, fill: Color, stroke: Stroke | None, title: str = "") -> None:
        half = 0.5 * self.share * stroke.width if stroke else 0.0
        outline, *holes = (self._clamped(ring, half) for ring in (area.outline, *area.holes))
        self.marks.append(Shape(name, outline, fill, stroke, holes=tuple(holes), title=title))

    def _clamped(self, ring: Sequence[Point], rim: float) -> tuple[Point, ...]:
        """A ring that keeps this distance from the figure's border, so that its line lies inside."""
        left, top, right, bottom = widened(self.view.where, -rim)
        return tuple((min(max(x, left), right), min(max(y, top), bottom)) for x, y in ring)

    # --- rays ---------------------------------------------------------------------------------------------------------

    def _ray(self, line: RayLine) -> None:
        style, color = STYLES[line.kind], self._ink(line)
        name, title = f"ray-{line.row}", ray_title(self.tree, line.row)
        sign = TO_LIGHT if line.row in self.pointed else style.arrow
        slim = SLIM if line.kind == "shadow" and sign is Arrow.NONE else 1.0
        halo = 2.0 * HALO if line.kind != "shadow" else 0.0
        is_strong = line.row in self.step.current or line.row == self.selected
        stroke = Stroke(color, (STRONG if is_strong else 1.0) * slim * style.width, line.dash)
        faint = Stroke(faded(color, FAINT), style.width, line.dash)
        strong = self.share * STRONG * style.width
        arrow = self.view.arrow_at(line, 0.0 if sign is Arrow.NONE else HEAD_ROOM * strong)
        widest = strong + self.share * halo  # on any page: a ray keeps its ends
        for stretch in self.view.parts(line):
            piece = self.view.piece(line, stretch.begin, stretch.end, widest)
            if piece is None:
                continue
            a, b = piece
            self.names.ways.append((name, piece))
            if not stretch.seen:
                self.marks.append(Line(name, a, b, faint, title=title))
                continue
            if halo:
                self.marks.append(Line("halo", a, b, Stroke(self.theme.ground, stroke.width + halo)))
            self.marks.append(Line(name, a, b, stroke, title=title))
            head = self.view.piece(line, stretch.begin, arrow) if stretch.begin < arrow < stretch.end else None
            if head and sign is not Arrow.NONE and math.dist(*head) > 1.0:
                self.marks.append(Line(name, *_last(head, 2.0), Stroke(color, stroke.width), sign, 1.0))
                self.names.take(head[1], 0.9 * self.size)
        met = self.view.piece(line, 0.999, 1.0)
        if met and line.kind != "shadow":  # the end of a shadow ray has a sign of its own
            self.names.take(met[1], 0.5 * self.size)
        if met and line.blocked and inside(met[1], widened(self.view.where, -0.5 * self.size)):
            self.marks += signs.cross(name, met[1], self.size, color)

    def _ink(self, line: RayLine) -> Color:
        """The colour of a ray, dimmed if it does not belong to the selected one."""
        color = self.theme.ray(line.kind)
        return color if self.kept is None or line.row in self.kept else faded(color, DIMMED)

    # --- signs and labels ---------------------------------------------------------------------------------------------

    def _place(self, point: Vector) -> Point | None:
        """The place of a sign at a point of the scene: moved inwards if the picture ends too near; None outside it."""
        at = self.view.place(self.view.frame.inside(point))
        if at is None:
            return None
        left, top, right, bottom = widened(self.view.where, -SIGN_ROOM * self.size)
        return (min(max(at[0], left), right), min(max(at[1], top), bottom))

    def _lights(self) -> dict[int, Point]:
        """The places of the lights in the picture."""
        found = {}
        for j, light in enumerate(self.scene.lights):
            at = self._place(light.position) if light.position else None
            if at:
                name = self.scene.light_name(j)
                self.marks += signs.sun(f"light-{j}", at, 1.4 * self.size, self.theme.sun, title=name)
                self.names.take(at, 1.2 * self.size)
                found[j] = at
        return found

    def _eye(self) -> None:
        at = self._place(self.view.world.view().eye)
        if at:
            self.marks += signs.eye(at, self.size, self.theme)
            self.names.take(at, 1.6 * self.size)

    def named(self) -> list[Named]:
        """A note on what is left out, then names of lights if they are few, then of rays, the heaviest first, then of
        the objects that these meet. A shadow ray needs no name beside that of its light.
        """
        found: list[Named] = []
        if self.has_many:
            found.append((frozenset(), self._note(len(self.scene.lights))))
        for j, at in self.lights.items() if not found else ():
            name = self.scene.light_name(j)
            found.append((frozenset(), self.names.label(f"light-{j}", name, [Spot(at)], self.theme.text)))
        if self.hit and self.selected is not None:
            sent = [child for child in self.tree.children[self.selected] if self.tree.kind(child) == "refraction"]
            for name, marks in self.hit.labels(self.view, self.names, self.theme):
                found.append((frozenset(sent if name.of_refracted else (self.selected,)), marks))
        nodes = self.tree.nodes
        rays = [line for line in self.lines if nodes["kind"][line.row] != SHADOW]
        shadows = [line for line in self.lines if nodes["kind"][line.row] == SHADOW]
        rays.sort(key=lambda line: (-nodes["weight"][line.row].max(), line.row))
        for k, line in enumerate(rays[:LABELS]):
            piece = self.view.piece(line, 0.0, 1.0)
            if piece:
                label, color = ray_label(self.tree, line.row), self._ink(line)
                spots = self._along(f"ray-{line.row}", label, piece)
                most = sys.maxsize if k < FIRST else 0
                words = self.names.label(f"ray-{line.row}", label, spots, color, most)
                found.append((frozenset((line.row,)), words))
        found += self._ways_out(shadows)
        for part in (*self.view.seen.opaque, *self.view.seen.glass):
            rows = frozenset(line.row for line in rays if nodes["object"][line.row] == part.number)
            if rows:
                name = self.scene.object_name(part.number)
                upon = _wide(part) > 1.1 * text_width(name, self.size)  # otherwise the name would hide the object
                spots = [Spot(at, upon=True) for at in part.spots if upon]
                if not upon or not self.names.fits(name, spots):
                    spots = [Spot(at) for at in part.spots[:3]]
                label = self.names.label(f"object-{part.number}", name, spots, self.theme.text, lead=True)
                found.append((rows, label))
        return found

    def _note(self, lights: int) -> list[Mark]:
        """What is said of lights whose rays are left out, in a corner."""
        left, top, right, bottom = self.view.where
        for words in (
            f"L: rays to {lights} lights are left out",
            f"{lights} lights: rays left out",
            f"{lights} lights",
        ):
            half = (0.5 * text_width(words, self.size) + 0.5 * self.size, 0.9 * self.size)
            corners = [(x, y) for y in (bottom - half[1], top + half[1]) for x in (left + half[0], right - half[0])]
            marks = self.names.label("lights", words, [Spot(at, upon=True) for at in corners], self.theme.text)
            if marks:
                return marks
        return []

    def _along(self, name: str, label: str, piece: Piece) -> list[Spot]:
        """Spots for a label: on the ray if it is long enough, and beside it."""
        upon = math.dist(*piece) > ROOMY * max(self.size, text_width(label, self.size))
        places = [point_along(piece, share) for share in SPOTS]
        return [Spot(at, upon=True, spare=name) for at in places if upon] + [Spot(at) for at in places]

    def _ways_out(self, shadows: Sequence[RayLine]) -> list[Named]:
        """The names of lights outside the picture, where rays to them leave it."""
        found: list[Named] = []
        left, top, right, bottom = self.view.where
        for j in sorted(set(range(len(self.scene.lights))) - self.lights.keys()):
            ends: list[Spot] = []
            rows: set[int] = set()
            for line in shadows:
                piece = self.view.piece(line, 0.0, 1.0) if self.tree.nodes["light"][line.row] == j else None
                if piece is None:
                    continue
                x, y = piece[1]
                if min(x - left, right - x, y - top, bottom - y) < 0.5:
                    inner = max(0.0, 1.0 - 1.2 * self.size / max(1.0, math.dist(*piece)))
                    ends.append(Spot(point_along(piece, inner)))
                    rows.add(line.row)
            words = f"to {self.scene.light_name(j)}"
            marks = self.names.label(f"light-{j}", words, ends, self.theme.text)
            if marks:
                found.append((frozenset(rows), marks))
        return found


def _wide(part: Part) -> float:
    across = [x for face in part.faces for area in face for x, _ in area.outline]
    return max(across) - min(across)


def _last(piece: Piece, length: float) -> Piece:
    """The last `length` of a segment."""
    (x0, y0), (x1, y1) = piece
    share = min(1.0, length / max(1e-9, math.dist(*piece)))
    return (x1 - share * (x1 - x0), y1 - share * (y1 - y0)), (x1, y1)
