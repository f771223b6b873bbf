"""Every mark lies inside its panel, and no two texts overlap: all figures of random scenes with 0 to 64 lights."""

import itertools
import math

import numpy as np
import pytest

import tracer
from tests.scenes import ball, box, plane, world_of
from tests.viewer.figures.geometry import overlap
from tracer.formulas.vector import as_floats
from tracer.kernel.nodes import SHADOW
from tracer.scene import Camera, Image, Light, Material, Object
from tracer.shapes.polygon import Polygon
from viewer.base.orbit import Frame, initial_orbit
from viewer.base.theme import THEMES
from viewer.figures.figure import both, scene, tree
from viewer.figures.figure.hit import LARGEST
from viewer.figures.layout.hit_frame import hit_frame
from viewer.figures.layout.placing import EYES
from viewer.figures.marks import HEIGHT, WIDTH, Box, Disc, Formula, Line, Mark, Raster, Rectangle, Shape, Text
from viewer.figures.pages import pages
from viewer.figures.steps import by_depth, by_ray
from viewer.figures.subject import FigureStyle, Subject
from viewer.figures.writers.arrows import heads

LONG = "a name that is longer than any box, any legend and any panel of a figure has room for"
NAMES = ("b", "ball", "glass ball under water", LONG, "WWWWWWWWWWWWWWWWWWWWWWWWWWWWWW")
BLACK, DIM = (0.0, 0.0, 0.0), (0.2, 0.2, 0.2)
PAGE = (0.0, 0.0, WIDTH, HEIGHT)
ROUNDING = 1e-6  # points


def extent(mark: Mark) -> Rectangle:
    """The rectangle around all that is drawn of a mark, with its line width and arrow heads."""
    stroke = getattr(mark, "stroke", None)
    half = 0.5 * stroke.width if stroke else 0.0
    match mark:
        case Text() | Formula():
            return mark.box()
        case Box(center=(x, y), size=(w, h)) | Raster(center=(x, y), size=(w, h)):
            points = [(x - 0.5 * w - half, y - 0.5 * h - half), (x + 0.5 * w + half, y + 0.5 * h + half)]
        case Disc(center=(x, y), radius=r):
            points = [(x - r - half, y - r - half), (x + r + half, y + r + half)]
        case Shape(corners=corners):
            points = [(x + dx, y + dy) for x, y in corners for dx, dy in ((-half, -half), (half, half))]
        case Line():
            points = []
            for (x0, y0), (x1, y1) in mark.pieces():  # its ends are flat
                length = max(math.dist((x0, y0), (x1, y1)), 1e-12)
                dx, dy = half * (y1 - y0) / length, half * (x1 - x0) / length
                points += [(x + s * dx, y - s * dy) for x, y in ((x0, y0), (x1, y1)) for s in (-1.0, 1.0)]
            for corners, filled in heads(mark):
                rim = 0.0 if filled else half
                points += [(x + dx, y + dy) for x, y in corners for dx, dy in ((-rim, -rim), (rim, rim))]
        case _:
            raise TypeError(type(mark).__name__)
    across, down = zip(*points, strict=True)
    return (min(across), min(down), max(across), max(down))


def check_inside(marks: list[Mark], panel: Rectangle) -> None:
    for mark in marks:
        left, top, right, bottom = extent(mark)
        inside = left >= panel[0] - ROUNDING and top >= panel[1] - ROUNDING
        assert inside and right <= panel[2] + ROUNDING and bottom <= panel[3] + ROUNDING, (extent(mark), panel, mark)


def check_texts(marks: list[Mark]) -> None:
    texts = [mark for mark in marks if isinstance(mark, (Text, Formula))]
    for a, b in itertools.combinations(texts, 2):
        assert not overlap(a.box(), b.box()), (a, b)


def random_world(seed: int, lights: int) -> tracer.World:
    """Glass in glass, a mirror in glass, a thin sheet, a floor; a camera that looks at them, and lamps all around."""
    random = np.random.default_rng(seed)
    glass = Material("glass", transmit=0.8, reflect=0.1, ior=1.5, diffuse=float(seed % 2) * 0.1, specular=0.2)
    water = Material("water", transmit=0.9, reflect=0.05, ior=1.33)
    mirror, matte = Material("mirror", reflect=0.9), Material("matte", diffuse=0.6, reflect=0.2)

    def name() -> str:
        return NAMES[int(random.integers(len(NAMES)))]

    def shifted(*middle: float) -> tuple[float, float, float]:
        return as_floats(np.array(middle) + 0.2 * random.normal(size=3))

    def inner() -> Object:
        return ball(shifted(0.0, 0.0, 0.0), 0.4, (mirror, water, matte)[int(random.integers(3))], name())

    sheet = Polygon(((-1.6, -1.0, 1.2), (1.6, -1.0, 1.2), (1.6, 1.3, 1.2), (-1.6, 1.3, 1.2)))
    inside = inner()
    objects = [
        Object(inside.shape, inside.material, inside.name, priority=1),
        ball(shifted(0.0, 0.0, 0.0), 1.0, glass, name()),
        box((1.0, -1.0, -1.0), (2.5, 0.8, 0.5), water, name=name()),
        plane((0.0, -1.0, 0.0), (0.0, 1.0, 0.0), matte, name()),
        Object(sheet, glass, name(), thin=True),
    ]
    kept = [item for item in objects if random.random() < 0.8] or objects
    lamps = [
        Light(f"{name()} {k}", position=as_floats(6.0 * random.normal(size=3)), color=BLACK if k == 3 else DIM)
        for k in range(lights)
    ]
    camera = Camera(shifted(0.0, 0.5, 4.0 if random.random() < 0.8 else 0.5), shifted(0.0, 0.0, 0.0))
    model = ("whitted", "fresnel")[int(random.integers(2))]
    return world_of(*kept, lights=lamps, camera=camera, image=Image(33, 21), model=model)


CASES = [(seed, (0, 1, 4, 5, 12, 64, 3, 2)[seed % 8], seed % 4) for seed in range(24)]


def subject_of(seed: int, lights: int, depth: int) -> Subject:
    world = random_world(seed, lights)
    trees = [tracer.trace(world, (16, 10 + seed % 3), depth=d) for d in range(depth + 1)]
    return Subject(by_depth(trees), world, initial_orbit(world, Frame.of(world), None))


@pytest.mark.parametrize(("seed", "lights", "depth"), CASES)
def test_trees_lie_inside_their_panel(seed: int, lights: int, depth: int) -> None:
    subject = subject_of(seed, lights, depth)
    tree_ = subject.steps[-1].tree
    stepped = Subject(by_ray(tree_)[:: max(1, len(tree_) // 8)])
    theme = list(THEMES.values())[seed % 3]
    for size, eye in itertools.product(((8.0, 31.0), (18.0, 48.0))[seed % 2], EYES):
        for swatches, fold, one in ((False, 0.0, subject), (True, 0.05, stepped)):
            style = FigureStyle(theme, size, swatches, fold, eye=eye)
            for page in pages("tree", one, style):
                check_inside(list(page.marks), PAGE)
                check_texts(list(page.marks))
            for marks in tree.pages(one, style, both.tree_part(FigureStyle())):
                check_inside(marks, both.tree_part(FigureStyle()))
                check_texts(marks)
    bare = Subject(by_depth([step.tree for step in subject.steps], lights=False))
    for page in pages("tree", bare, FigureStyle()):
        check_inside(list(page.marks), PAGE)


@pytest.mark.parametrize(("seed", "lights", "depth"), CASES)
def test_hits_lie_inside_their_panel(seed: int, lights: int, depth: int) -> None:
    subject = subject_of(seed, lights, depth)
    tree_ = subject.steps[-1].tree
    hits = [i for i in range(len(tree_)) if tree_.nodes["kind"][i] != SHADOW and tree_.object_name(i)]
    for node, size in itertools.product(hits, (8.0, 18.0, LARGEST)):
        for page in pages("hit", subject, FigureStyle(list(THEMES.values())[seed % 3], size, node=node)):
            formulas = [mark for mark in page.marks if mark.name == "formulas"]
            frame = hit_frame(PAGE, size)
            check_inside([mark for mark in page.marks if mark.name != "formulas"], frame.picture)
            check_inside(formulas, frame.formulas[0])
            check_texts(list(page.marks))


@pytest.mark.parametrize(("seed", "lights", "depth"), CASES[1:24:6])
def test_scenes_lie_inside_their_panel(seed: int, lights: int, depth: int) -> None:
    subject = subject_of(seed, lights, depth)
    size = (18.0, 8.0, 48.0, 27.0)[seed // 2 % 4]
    style = FigureStyle(list(THEMES.values())[seed % 3], size)
    for page in pages("scene", subject, style):
        check_inside(list(page.marks), PAGE)
        check_texts(list(page.marks))
    if seed % 2 == 0:
        left = scene.pages(subject, style, (0.0, 0.0, both.DIVIDE * WIDTH - both.GAP, HEIGHT))
        for page, marks in zip(pages("both", subject, style), left, strict=True):
            check_inside(list(page.marks[: len(marks)]), (0.0, 0.0, both.DIVIDE * WIDTH - both.GAP, HEIGHT))
            check_inside(list(page.marks[len(marks) :]), both.tree_part(FigureStyle()))
            check_texts(list(page.marks))
