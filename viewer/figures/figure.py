"""From trees to pages: which figures there are, and the pages of one. A new figure: its marks in a file of its own, a
line in FIGURES."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tracer.outline import triple
from tracer.tree import RayTree
from viewer.figures.hitfigure import check_node, hit_marks
from viewer.figures.marks import Figure, Mark
from viewer.figures.stage import Stage
from viewer.figures.treefigure import tree_marks
from viewer.figures.treeplan import plan_tree
from viewer.theme import LIGHT, Theme

TEXT_SIZE = 18.0  # points: what the last row reads where the figure fills a slide


@dataclass(frozen=True)
class Wishes:
    """How a figure is to look."""

    theme: Theme = LIGHT
    text_size: float = TEXT_SIZE
    swatches: bool = False  # the colour that each ray sends up, in its box
    fold: float = 0.0  # branches that weigh less are folded
    ground: bool = False  # on the theme's paper, not on transparent ground
    node: int = 0  # which hit, where the figure shows one


def tree_pages(stages: Sequence[Stage], wishes: Wishes) -> list[list[Mark]]:
    plan = plan_tree([stage.tree for stage in stages], wishes.text_size, wishes.swatches, wishes.fold)
    return [tree_marks(plan, stage, wishes.theme) for stage in stages]


def hit_pages(stages: Sequence[Stage], wishes: Wishes) -> list[list[Mark]]:
    """Empty before the hit is there."""
    check_node(stages[-1].tree, wishes.node)
    return [
        hit_marks(stage, wishes.node, wishes.text_size, wishes.theme) if wishes.node in stage.rows else []
        for stage in stages
    ]


FIGURES: dict[str, Callable[[Sequence[Stage], Wishes], list[list[Mark]]]] = {
    "tree": tree_pages,
    "hit": hit_pages,
}


def pages(name: str, stages: Sequence[Stage], wishes: Wishes, command: str = "") -> list[Figure]:
    """The figure of that name, a page a stage; the last stage is the fullest."""
    return [
        Figure(title(stage.tree), description(stage.tree), command, tuple(marks), wishes.theme.ground, wishes.ground)
        for stage, marks in zip(stages, FIGURES[name](stages, wishes), strict=True)
    ]


def title(tree: RayTree) -> str:
    where = f"pixel {tree.pixel[0]},{tree.pixel[1]}" if tree.pixel else "a ray"
    scene = tree.scene.title or (tree.scene.path.name if tree.scene.path else "scene")
    return f"{scene}: the rays behind {where}, depth {tree.depth}"


def description(tree: RayTree) -> str:
    """In words, for who cannot see it."""
    kinds = [tree.kind(i) for i in range(len(tree))]
    counts = [(kinds.count(kind), words) for kind, words in KINDS]
    made_of = ", ".join(f"{count} {words}" for count, words in counts if count)
    rays = "1 ray" if len(tree) == 1 else f"{len(tree)} rays"
    return f"{rays}: {made_of}. The pixel's colour is {triple(tree.radiance)} (linear r g b)."


KINDS = (
    ("camera", "from the eye"),
    ("reflection", "reflected"),
    ("refraction", "refracted"),
    ("tir", "totally reflected"),
    ("shadow", "to lights"),
)
