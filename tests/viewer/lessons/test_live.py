"""Live pieces: their numbers against closed forms, and their marks: inside their room, with no text over another."""

import itertools
import math

import numpy as np
import pytest

import tracer
from tests.scenes import MATTE, ball, box, world_of
from tests.viewer.figures.test_inside import check_inside, check_texts
from tracer.formulas.double_double import U
from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.scene import Light, Material, Object
from tracer.shapes.polygon import Polygon
from tracer.tree.raytree import RayTree
from viewer.base.srgb import display_color
from viewer.base.theme import DARK, LIGHT, MONO
from viewer.explain.lighting import phong_terms
from viewer.figures.marks import Disc, Handle, Mark, Shape, Text
from viewer.lessons.live.catalogue import LIVE, LIVE_NAMES, live_kind
from viewer.lessons.live.interface import Interface, interface_of
from viewer.lessons.live.piece import LiveContext
from viewer.lessons.live.pieces.fresnel import brewster, reflectance
from viewer.lessons.live.pieces.lifeguard import Lifeguard
from viewer.lessons.live.pieces.samples import sample_points
from viewer.lessons.live.pieces.sum import parts
from viewer.lessons.live.pieces.transmission import Construction

SIZES = ((300, 200, 11.0), (300, 220, 18.0), (480, 300, 14.0), (400, 480, 13.0), (960, 540, 18.0))
GLASS = Material("glass", diffuse=0.2, specular=0.4, shininess=20.0, ambient=0.1, transmit=0.8, reflect=0.1, ior=1.52)
SHINY = Material("shiny", (0.9, 0.5, 0.3), diffuse=0.6, specular=0.5, shininess=8.0, ambient=0.2)
COMB = Polygon(
    tuple((float(x), float(y), -3.0) for x, y in ((-2, -2), (2, -2), (2, 2), (1, 2), (1, -1), (0, -1), (0, 2), (-2, 2)))
)
LAMPS = [
    Light("key", position=(3.0, 4.0, 5.0), color=(0.7, 0.6, 0.5)),
    Light("fill", position=(-4.0, 1.0, 3.0), color=(0.2, 0.3, 0.4)),
]
RAY = ((0.3, 0.2, 5.0), (0.03, 0.02, -1.0))


def world() -> World:
    return world_of(ball((0, 0, 0), 1.0, GLASS), Object(COMB, SHINY, "comb"), lights=LAMPS, background=(0.2, 0.3, 0.4))


def context(seen: World, tree: RayTree | None, row: int = 0, size: tuple = SIZES[4], theme=LIGHT) -> LiveContext:
    return LiveContext(tree, row, seen, theme, size[2], (0.0, 0.0, float(size[0]), float(size[1])))


def row_of(tree: RayTree, path: str) -> int:
    return next(i for i in range(len(tree)) if tree.path(i) == path and tree.nodes["kind"][i] != SHADOW)


def words(marks: list[Mark]) -> str:
    return " ".join(mark.content for mark in marks if isinstance(mark, Text))


def test_pieces_lie_inside_their_room_and_no_texts_overlap() -> None:
    """Every piece, at several hits, with its handles at an end and in the middle, in rooms of all sizes."""
    seen = world()
    tree = tracer.trace(seen, ray=RAY, depth=3)
    rows = [row_of(tree, path) for path in ("E", "T", "TT")]  # on glass, from inside it, on the polygon
    drawn = dict.fromkeys(LIVE_NAMES, 0)
    given = {"snell": ("1.33", "1"), "fresnel": ("glass", "air"), "lifeguard": ("1", "6"), "media": ("water", "1.7")}
    given |= {
        "transmission": ("2", "1.33", "1"),
        "sphere": ("ball",),
        "inside": ("comb",),
        "reflect": ("fill",),
    }  # the ray from the eye does not reach the polygon
    for kind, (k, size), row in itertools.product(LIVE, enumerate(SIZES), rows):
        if row and (k % 2 or kind.name in ("lifeguard", "samples", "media")):
            continue  # the same picture, or enough of them
        theme = (LIGHT, DARK, MONO)[k % 3]
        for with_words in ((), given.get(kind.name, ())) if row == 0 else ((),):
            try:
                place = context(seen, tree, row, size, theme)
                marks = kind.marks(place, {}, with_words)
            except ValueError as error:
                assert kind.name in ("snell", "fresnel", "transmission", "sphere", "inside"), error
                continue
            handles = [mark for mark in marks if isinstance(mark, Handle)]
            moved = [{h.name: value} for h in handles for value in (h.range[k % 2], 0.5 * sum(h.range))]
            for parameters in [{}, *(moved if kind.name != "hit" and row == 0 else [])]:
                marks = kind.marks(place, parameters, with_words)
                check_inside([mark for mark in marks if not isinstance(mark, Handle)], place.where)
                check_texts(marks)
                drawn[kind.name] += 1
    assert min(drawn.values()) >= 3


def test_snell_and_the_critical_angle() -> None:
    glass = Interface(1.0, 1.5, 45.0, None)
    assert glass.refracted(45.0) == pytest.approx(28.125505702055707, rel=4 * U)
    assert glass.critical is None and glass.refracted(90.0) == pytest.approx(
        math.degrees(math.asin(1 / 1.5)), rel=4 * U
    )
    water = Interface(1.33, 1.0, 40.0, None)
    assert f"{water.critical:.2f}" == "48.75"
    assert water.refracted(water.steepest) == pytest.approx(90.0, abs=1e-5)  # sqrt(U) in radians, near the pole of asin
    assert water.refracted(48.76) is None
    marks = live_kind("snell").marks(context(world(), None), {"theta1": 45.0}, ("1.33", "1"))
    assert "θc = 48.75°" in words(marks) and "1.33 × 0.7071 = 0.9405" in words(marks)


def test_fresnel_at_normal_incidence_at_brewsters_angle_and_beyond_the_critical_angle() -> None:
    media = Interface(1.0, 1.5, 0.0, None)
    assert reflectance(media, 0.0) == pytest.approx((0.04, 0.96), rel=8 * U)
    angle = brewster(media)
    assert angle == pytest.approx(56.309932474020215, rel=4 * U)
    s = (1.5**2 - 1.0) / (1.5**2 + 1.0)  # r_s at Brewster's angle; r_p is 0
    assert reflectance(media, angle)[0] == pytest.approx(0.5 * s * s, rel=32 * U)
    assert reflectance(Interface(1.33, 1.0, 0.0, None), 60.0) == (1.0, 0.0)


def test_the_lifeguards_least_time_is_that_of_the_3_4_5_triangles() -> None:
    given = Lifeguard(4.0, 3.0)
    assert given.least == pytest.approx(4.0, rel=4 * U)
    assert given.time(4.0) == pytest.approx(35.0 / 12.0, rel=4 * U)
    assert given.sines(4.0) == (0.8, 0.6)
    assert all(given.time(x) > given.time(4.0) for x in (-1.0, 3.99, 4.01, 8.0))
    told = words(live_kind("lifeguard").marks(context(world(), None), {"x": 4.0}))
    assert "least time" in told and "2.9167" in told and told.count("= 0.2") == 2
    for speeds in ((1.0, 6.0), (3e8, 2e8), (2.0, 2.0)):
        other = Lifeguard(*speeds)
        sine1, sine2 = other.sines(other.least)
        assert sine1 / speeds[0] == pytest.approx(sine2 / speeds[1], rel=1e3 * U)


def test_a_question_about_the_lifeguard_leaves_its_answer_out() -> None:
    """Neither the curve nor the place of least time: only the time of the path on show."""
    piece = live_kind("lifeguard")
    asked = piece.marks(context(world(), None), {}, ("4", "3", "2", "ask"))
    told = piece.marks(context(world(), None), {}, ("4", "3", "2"))
    curves, others = ({mark.name for mark in marks if isinstance(mark, Shape)} for marks in (told, asked))
    assert curves - others == {"time"} and "least" not in {mark.name for mark in asked}
    assert "least" not in words(asked) and f"time {Lifeguard(4.0, 3.0).time(2.0):.4f} s" in words(asked)


def test_the_transmission_direction_is_the_tracers() -> None:
    """With 3-4-5 triangles the numbers are exact; the limit of total internal reflection belongs to it."""
    angle = math.degrees(math.asin(0.8))
    found = Construction.of(Interface(1.0, 4.0 / 3.0, angle, None))
    assert (found.c1, found.across, found.c2) == pytest.approx((0.6, 0.6, 0.8), rel=8 * U)
    seen = world()
    tree = tracer.trace(seen, ray=RAY, depth=3)
    for row, child in ((row_of(tree, path), row_of(tree, below)) for path, below in (("E", "T"), ("T", "TT"))):
        node, sent = tree.nodes[row], tree.nodes[child]["direction"]
        made = Construction.of(interface_of(context(seen, tree, row), {}, "transmission"))
        assert made.c2 is not None and made.radicand == pytest.approx(node["radicand"], rel=1e-12)
        normal, v = node["normal"], node["direction"]
        assert made.n * v + (made.n * made.c1 - made.c2) * normal == pytest.approx(sent, abs=1e-12)
    assert Construction(1.25, 0.6, 0.8).c2 is None  # n sin theta1 is 1
    piece = live_kind("transmission")
    names = [{mark.name for mark in piece.marks(context(seen, tree), {}, (stage,))} for stage in "1234"]
    assert [{"vector-nv", "vector-t", "rest"} & found for found in names] == [
        set(), {"vector-nv"}, {"vector-nv", "vector-t"}, {"vector-nv", "vector-t", "rest"},
    ]  # fmt: skip
    total = piece.marks(context(seen, None), {"theta1": angle}, ("4", "1.3333333333333333", "1"))
    assert "no root" in words(total) and not {"vector-t", "rest"} & {mark.name for mark in total}


def test_the_parts_of_a_sum_add_up_to_the_radiance_to_the_last_bit() -> None:
    for model in ("whitted", "fresnel"):
        tree = tracer.trace(world(), ray=RAY, depth=5, model=model)
        for i in range(len(tree)):
            if tree.nodes["kind"][i] != SHADOW and tree.nodes["object"][i] >= 0:
                total = np.zeros(3)
                for part in parts(tree, i):
                    total = total + part.value
                assert (total == tree.nodes["radiance"][i]).all()


def test_phongs_terms_add_up_to_the_light_of_a_shadow_ray() -> None:
    seen = world()
    tree = tracer.trace(seen, ray=RAY, depth=3)
    for child in np.flatnonzero(tree.nodes["kind"] == SHADOW).tolist():
        _, diffuse, specular = phong_terms(tree, seen, int(tree.nodes["parent"][child]), child)
        assert diffuse + specular == pytest.approx(tree.nodes["radiance"][child], rel=1e-12, abs=1e-300)
    of_fill = live_kind("phong").marks(context(seen, tree), {}, ("fill",))
    assert of_fill != live_kind("phong").marks(context(seen, tree), {}, ("key",))


def test_sample_points_are_those_that_images_use() -> None:
    """With a pixel of the tree, its own points: one in each cell, and the centre if it is one."""
    assert sample_points(3, 4, 1) == [(0.5, 0.5)]
    points = sample_points(3, 4, 16)
    assert len({(int(4 * u), int(4 * v)) for u, v in points}) == 16
    seen = world()
    x, y = tracer.trace(seen, pixel=(3, 4), sample=5).image_point
    assert (x - 3, y - 4) == pytest.approx(points[5], abs=8 * U * 8)


@pytest.mark.parametrize("count", (1, 16))
def test_samples_have_the_colours_that_their_rays_see_and_the_pixel_their_mean(count: int) -> None:
    seen = world()
    pixel = next((x, 24) for x in range(64) if len(set(_ends(seen, (x, 24)))) > 1)  # at an edge
    tree = tracer.trace(seen, pixel=pixel, depth=2)
    drawn = live_kind("samples").marks(context(seen, tree), {"count": float(count)})
    marks = {mark.name: mark for mark in drawn if isinstance(mark, Disc | Shape)}
    colors = [marks[f"sample-{k}"].fill for k in range(count)]
    numbers = range(16) if count > 1 else [None]
    assert colors == [display_color(tracer.trace(seen, pixel=pixel, sample=k, depth=2).radiance) for k in numbers]
    mean = tracer.render(seen, samples=count, depth=2).pixels[pixel[1], pixel[0]]
    assert marks["pixel"].fill == display_color(mean)


def _ends(seen: World, pixel: tuple[int, int]) -> list[str | None]:
    return [tracer.trace(seen, pixel=pixel, sample=k, depth=0).object_name(0) for k in range(4)]


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("sphere", (), "sphere: comb is a polygon; it needs a hit on a sphere"),
        ("snell", (), "snell: comb is opaque; it needs a hit on a transparent surface"),
        ("snell", ("-1",), "snell: n1 must be a number above 0 or one of vacuum, air"),
        ("samples", ("x",), 'samples: count must be a whole number, got "x"'),
        ("phong", ("moon",), 'phong: light must be a light of the scene, key, fill, got "moon"'),
        ("sphere", ("moon",), 'sphere: object must be an object of the scene, ball, comb, got "moon"'),
        ("sphere", ("comb",), "sphere: comb is a polygon; it needs a hit on a sphere"),
        ("inside", ("ball",), "inside: ball is a sphere; it needs a hit on a polygon"),
        ("reflect", ("moon",), 'reflect: light must be a light of the scene, key, fill, got "moon"'),
        ("hit", ("x",), 'hit: no words may follow, got "x"'),
        (
            "lifeguard",
            ("4", "3", "2", "x"),
            'lifeguard: ask must be the word "ask", which leaves the answer out, got "x"',
        ),
        ("transmission", ("5",), 'transmission: stage must be a whole number from 1 to 4, got "5"'),
        (
            "transmission",
            (),
            "transmission: comb is opaque; it needs a hit on a transparent surface, or two indices, like"
            " `transmission 4 1.33 1`",
        ),
        ("lifeguard", ("0",), 'lifeguard: v1 must be a speed above 0, got "0"'),
    ],
)
def test_faults_are_one_line(name: str, given: tuple[str, ...], said: str) -> None:
    seen = world()
    tree = tracer.trace(seen, ray=((-1.6, -1.5, 5.0), (0.0, 0.0, -1.0)), depth=2)
    with pytest.raises(ValueError) as fault:
        live_kind(name).marks(context(seen, tree), {}, given)
    assert str(fault.value).startswith(said) and "\n" not in str(fault.value)


def test_more_faults() -> None:
    seen = world_of(box((-1, -1, -1), (1, 1, 1), MATTE), ball((5, 0, 0), 1.0))
    tree = tracer.trace(seen, ray=((0.1, 0.2, 5.0), (0.0, 0.0, -1.0)))
    for name, said in (("inside", "inside: box is a box; it needs"), ("phong", "phong: box has no ray to a light")):
        with pytest.raises(ValueError, match=said):
            live_kind(name).marks(context(seen, tree), {})
    with pytest.raises(ValueError, match="sum: no pixel is picked"):
        live_kind("sum").marks(context(seen, None), {})
    with pytest.raises(ValueError, match=r'a live piece is one of snell, .*, got "prism"'):
        live_kind("prism")


def test_hit_is_turned() -> None:
    """The angle of the handle is the angle of the picture; the media of a triangle's piece come from its hit."""
    seen = world()
    tree = tracer.trace(seen, ray=RAY, depth=2)
    marks = live_kind("hit").marks(context(seen, tree), {"turn": 60.0})
    (handle,) = (mark for mark in marks if isinstance(mark, Handle))
    assert handle.value == pytest.approx(60.0, abs=1e-9) and "θ₁ = 60.00°" in words(marks)
