"""The pages of a figure: its marks, title, description and the command that makes it again."""

from pkgutil import resolve_name

from tracer.tree.digits import rgb_text
from tracer.tree.raytree import RayTree
from viewer.figures.catalogue import FIGURES
from viewer.figures.marks import Figure, Handle, with_line_width
from viewer.figures.subject import FigureStyle, Subject, line_share

MOST_DOUBTS = 3  # that a description lists


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
