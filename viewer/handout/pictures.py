"""The pictures of a step: the scene, its ray tree, a hit, the numbers of a ray. Each draws any of its frames."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from tracer.kernel.world import World
from viewer.base.orbit import Orbit
from viewer.explain.ray import ray_numbers
from viewer.explain.sections import Section
from viewer.figures.figure import scene as scene_figure, tree as tree_figure
from viewer.figures.figure.hit import LARGEST, hit_marks
from viewer.figures.font import BASELINE, fitted, text_width
from viewer.figures.layout.hit_frame import MARGIN
from viewer.figures.layout.tree_plan import fitting_size
from viewer.figures.marks import Formula, Handle, Mark, Rectangle, Text, widened, with_line_width
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Subject, line_share
from viewer.figures.visible.scene_view import SceneView
from viewer.handout.document import Picture, Room
from viewer.handout.sentences import of_hit, of_tree

LINE, LEAST = 1.9, 1.25  # distance of the lines of a table, and the least, in text sizes


class Scenery:
    """A scene as it is seen in a step. What is visible in a rectangle is found once."""

    def __init__(self, world: World, orbit: Orbit) -> None:
        self.world, self.orbit = world, orbit
        self._views: dict[Rectangle, SceneView] = {}

    def view(self, where: Rectangle) -> SceneView:
        if where not in self._views:
            self._views[where] = Subject([], self.world, self.orbit).view(where)
        return self._views[where]


@dataclass(frozen=True)
class Frame:
    """The rays of a frame in their scene. Frames of one `group` are laid out alike, for the last of them."""

    step: Step
    scenery: Scenery
    group: int = 0
    hit: int = 0  # the row of the hit that it is about


@dataclass(frozen=True)
class Frames:
    """All frames of a show."""

    all: tuple[Frame, ...]
    selects: bool = False  # whether the ray of the hit is emphasised
    swatches: bool = False  # whether boxes of the tree show colours

    def groups(self, asked: Sequence[int]) -> Iterator[tuple[list[int], list[Frame]]]:
        """The frames that are asked for, by group: (their places among those asked for, the frames). The last of the
        group comes at the end, without a place if it is not asked for.
        """
        for group in dict.fromkeys(self.all[k].group for k in asked):
            places = [place for place, k in enumerate(asked) if self.all[k].group == group]
            fullest = [frame for frame in self.all if frame.group == group][-1]
            yield places, [*(self.all[asked[place]] for place in places), fullest]

    def selected(self, frame: Frame) -> int | None:
        return frame.hit if self.selects else None


Drawn = list[list[Mark]]
Draw = Callable[[Frames, Room, list[Frame]], Drawn]


def _scene(frames: Frames, room: Room, group: list[Frame]) -> Drawn:
    first = group[0]
    steps = [frame.step for frame in group]
    view = first.scenery.view(room.where)
    return scene_figure.view_pages(view, steps, room.size, room.theme, frames.selected(first))


def _tree(frames: Frames, room: Room, group: list[Frame]) -> Drawn:
    steps = [frame.step for frame in group]
    style = FigureStyle(room.theme, room.size, swatches=frames.swatches, selected=frames.selected(group[-1]))
    size = fitting_size(tree_figure.planned(steps), tree_figure.tree_style(steps, style, room.where))
    if size and room.least <= size < room.size:
        style = replace(style, text_size=size)
    return tree_figure.pages(Subject(steps), style, room.where)


def _hit(frames: Frames, room: Room, group: list[Frame]) -> Drawn:
    size = min(room.size, LARGEST)
    return [
        hit_marks(frame.step, frame.hit, size, room.theme, frame.scenery.world, room.where)
        if frame.step.tree.object_name(frame.hit) and frame.hit in frame.step.rows
        else []
        for frame in group
    ]


def _ray(frames: Frames, room: Room, group: list[Frame]) -> Drawn:
    return [table(ray_numbers(frame.step.tree, frame.hit), room) for frame in group]


def table(section: Section, room: Room) -> list[Mark]:
    """The lines of a section below each other: names on the left, values on the right."""
    left, top, right, bottom = widened(room.where, -MARGIN * room.size)
    pitch = min(LINE * room.size, (bottom - top) / len(section.lines))
    size, theme = min(room.size, pitch / LEAST), room.theme
    marks: list[Mark] = []
    for k, line in enumerate(section.lines):
        y = top + (k + 0.5) * pitch
        if line.symbol:
            symbol = Formula("numbers", line.symbol, (left, y + BASELINE * size), size, theme.muted, "start")
            marks.append(symbol)
            name = symbol.box()[2]
        else:
            marks.append(Text("numbers", (left, y), line.name, size, theme.muted, "start"))
            name = left + text_width(line.name, size)
        value = fitted(line.value, right - name - size, size)
        marks.append(Text("numbers", (right, y), value, size, theme.text, "end"))
    return marks


@dataclass(frozen=True)
class PictureKind:
    """A panel of the window that has a picture on paper."""

    name: str  # of the panel
    title: str
    draw: Draw
    says: Callable[[Frame], str]


KINDS = {
    kind.name: kind
    for kind in (
        PictureKind("scene", "Scene", _scene, lambda frame: of_tree(frame.step)),
        PictureKind("tree", "Ray tree", _tree, lambda frame: of_tree(frame.step)),
        PictureKind("hit", "The hit", _hit, lambda frame: of_hit(frame.step.tree, frame.hit)),
        PictureKind("ray", "Numbers of the ray", _ray, lambda frame: of_hit(frame.step.tree, frame.hit)),
    )
}


def picture(name: str, frames: Frames) -> Picture:
    """The picture of a panel with this name."""
    kind = KINDS[name]

    def draw(room: Room, asked: Sequence[int]) -> Drawn:
        found: Drawn = [[] for _ in asked]
        for places, group in frames.groups(asked):
            drawn = kind.draw(frames, room, group)
            for place, marks in zip(places, drawn, strict=False):
                found[place] = finished(marks, room.size)
        return found

    return Picture(name, kind.title, draw, lambda k, _: kind.says(frames.all[k]))


def finished(marks: Sequence[Mark], size: float) -> list[Mark]:
    """Marks as they are on paper: without handles, and with lines as thick as the text asks for."""
    share = line_share(size)
    return [with_line_width(mark, share) for mark in marks if not isinstance(mark, Handle)]
