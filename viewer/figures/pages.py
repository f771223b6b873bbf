"""The pages of a figure: its marks, title, description and the command that makes it again."""

from collections.abc import Sequence
from dataclasses import replace
from pkgutil import resolve_name

from tracer.kernel.world import World
from tracer.tree.digits import rgb_text
from tracer.tree.raytree import RayTree
from viewer.explain.ray import ray_details
from viewer.explain.sections import RayDetails
from viewer.figures.catalogue import FIGURES
from viewer.figures.marks import Figure, Handle, with_line_width
from viewer.figures.picking import ray_of
from viewer.figures.steps import Step
from viewer.figures.subject import FigureStyle, Subject, line_share

MOST_DOUBTS = 3  # that a description lists

# On an upright phone: the size of a page in points (as wide as the screen, its text has about its own size), and the
# figures that are shown below each other in place of one.
PHONE, PHONE_SCENE = (400.0, 600.0), (400.0, 400.0)
PHONE_PARTS = {"both": ("scene", "tree")}


def pages(name: str, subject: Subject, style: FigureStyle, command: str = "") -> list[Figure]:
    """One page of the named figure for each step. ValueError if the subject or the style does not allow it."""
    marks_of = resolve_name(next(kind.function for kind in FIGURES if kind.name == name))
    width = line_share(style.text_size)
    made = [
        [with_line_width(mark, width) for mark in marks if not isinstance(mark, Handle)]
        for marks in marks_of(subject, style)
    ]
    paper = style.theme.ground
    return [
        Figure(title(step.tree), description(step.tree), command, tuple(marks), paper, style.ground, *style.page)
        for step, marks in zip(subject.steps, made, strict=True)
    ]


def with_upright(figures: Sequence[Figure], name: str, subject: Subject, style: FigureStyle) -> list[Figure]:
    """The figures, which are the first pages of the named one, each with the same for an upright phone. They stay as
    they are if they are upright themselves, or if their text is too large for a phone.
    """
    if style.page[0] <= style.page[1]:
        return list(figures)
    try:
        parts = [
            pages(part, subject, replace(style, page=PHONE_SCENE if part == "scene" else PHONE))[: len(figures)]
            for part in PHONE_PARTS.get(name, (name,))
        ]
    except ValueError:
        return list(figures)
    return [replace(figure, upright=tuple(upright)) for figure, *upright in zip(figures, *parts, strict=True)]


def with_details(figures: Sequence[Figure], steps: Sequence[Step], world: World) -> list[Figure]:
    """The figures of these steps, each with what is said of the rays in it. Rows of one tree are explained once."""
    known: dict[tuple[int, int], RayDetails] = {}

    def details(tree: RayTree, row: int) -> RayDetails:
        key = (id(tree), row)  # the steps keep their trees alive
        if key not in known:
            known[key] = ray_details(tree, world, row)
        return known[key]

    made = []
    for figure, step in zip(figures, steps, strict=True):
        marks = (mark for drawn in (figure, *figure.upright) for mark in drawn.marks)
        rows = sorted({row for mark in marks if (row := ray_of(mark.name)) is not None})
        made.append(replace(figure, details=tuple(details(step.tree, row) for row in rows)))
    return made


def title(tree: RayTree) -> str:
    sample = f", {tree.sample_text}" if tree.sample_text else ""
    return f"{tree.scene.caption}: the rays behind {tree.place}{sample}, depth {tree.depth}"


def description(tree: RayTree) -> str:
    """The figure in words, for readers who cannot see it."""
    kinds = [tree.kind(i) for i in range(len(tree))]
    counts = [(kinds.count(kind), words) for kind, words in KINDS]
    made_of = ", ".join(f"{count} {words}" for count, words in counts if count)
    rays = "1 ray" if len(tree) == 1 else f"{len(tree)} rays"
    color = rgb_text(tree.radiance, tree.radiance_error)
    doubts = [f"{tree.label(i)} could have gone otherwise, by rounding: {words}." for i, words in tree.doubts]
    whose = f"colour of {tree.sample_text}" if tree.sample_text else "pixel's colour"
    return " ".join([f"{rays}: {made_of}. The {whose} is {color} (linear r g b).", *doubts[:MOST_DOUBTS]])


KINDS = (
    ("camera", "from the eye"),
    ("reflection", "reflected"),
    ("refraction", "refracted"),
    ("tir", "totally reflected"),
    ("shadow", "to lights"),
)
