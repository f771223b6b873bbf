"""From trees to pages: which figures there are, and the pages of one. A new figure: its marks in a file of its own, a
line in FIGURES."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tracer.kernel.world import World
from tracer.tree.raytree import RayTree
from tracer.tree.text import rgb_text
from viewer.base.orbit import Orbit
from viewer.base.theme import LIGHT, Theme
from viewer.figures.figure import tree
from viewer.figures.figure.hit import hit_marks
from viewer.figures.layout.tree_plan import Wanted, plan_tree
from viewer.figures.marks import HEIGHT, WIDTH, Figure, Mark, Rectangle, inked
from viewer.figures.steps import Stage

if TYPE_CHECKING:
    from viewer.figures.visible.scene_view import SceneView

DIVIDE = 0.46 * WIDTH  # where the scene ends and the tree begins
TREES = {"tree": (0.0, WIDTH), "both": (DIVIDE + 4.0, WIDTH)}  # between which left and right a figure has its tree
TEXT_SIZE = 18.0  # points: what the last row reads where the figure fills a slide
THINNEST, THICKEST = 0.45, 1.6  # of how thick lines are at that size of the text: they go with it


@dataclass(frozen=True)
class Wishes:
    """How a figure is to look."""

    theme: Theme = LIGHT
    text_size: float = TEXT_SIZE
    swatches: bool = False  # the colour that each ray sends up, in its box
    fold: float = 0.0  # branches that weigh less are folded
    ground: bool = False  # on the theme's paper, not on transparent ground
    node: int = 0  # which hit, where the figure shows one
    eye: str = "top"  # of the tree, or left
    lights: bool = True  # with the rays to the lights


@dataclass(frozen=True)
class Subject:
    """What a figure is of: the stages of one tree, the fullest last, and where the scene is to be seen the scene."""

    stages: Sequence[Stage]
    world: World | None = None
    orbit: Orbit | None = None  # from where the scene is seen

    def view(self, where: Rectangle) -> SceneView:
        from viewer.figures.visible.scene_view import SceneView

        if self.world is None or self.orbit is None:
            raise ValueError("a figure of the scene needs the scene and from where it is seen")
        wide = (where[2] - where[0]) / (where[3] - where[1])
        back = max(1.0, math.sqrt(WIDTH / HEIGHT / wide))  # a narrow picture shows less: from a little farther away
        return SceneView(self.world, replace(self.orbit, distance=back * self.orbit.distance), where)


Pages = list[list[Mark]]


def tree_pages(subject: Subject, wishes: Wishes, where: tuple[float, float] = TREES["tree"]) -> Pages:
    trees = [stage.tree for stage in subject.stages]
    plan = plan_tree(trees, wanted(wishes, where))
    return tree.tree_pages(plan, subject.stages, wishes.theme)


def wanted(wishes: Wishes, where: tuple[float, float]) -> Wanted:
    return Wanted(wishes.text_size, wishes.swatches, wishes.fold, where, wishes.eye, wishes.lights)


def scene_pages(subject: Subject, wishes: Wishes, where: Rectangle = (0.0, 0.0, WIDTH, HEIGHT)) -> Pages:
    from viewer.figures.figure import scene

    return scene.scene_pages(subject.view(where), subject.stages, wishes.text_size, wishes.theme)


def both_pages(subject: Subject, wishes: Wishes) -> Pages:
    """Whitted's two panels: the scene, and beside it the tree with the same labels."""
    scenes = scene_pages(subject, wishes, (0.0, 0.0, DIVIDE - 4.0, HEIGHT))
    trees = tree_pages(subject, wishes, TREES["both"])
    return [[*scene, *tree] for scene, tree in zip(scenes, trees, strict=True)]


def hit_pages(subject: Subject, wishes: Wishes) -> Pages:
    """Empty before the hit is there."""
    node, size, theme = wishes.node, wishes.text_size, wishes.theme
    return [
        hit_marks(stage, node, size, theme, subject.world) if node in stage.rows else [] for stage in subject.stages
    ]


FIGURES: dict[str, Callable[[Subject, Wishes], Pages]] = {
    "tree": tree_pages,
    "scene": scene_pages,
    "both": both_pages,
    "hit": hit_pages,
}


def pages(name: str, subject: Subject, wishes: Wishes, command: str = "") -> list[Figure]:
    """The figure of that name, a page a stage."""
    thick = min(THICKEST, max(THINNEST, wishes.text_size / TEXT_SIZE))
    made = [[inked(mark, thick) for mark in marks] for marks in FIGURES[name](subject, wishes)]
    return [
        Figure(title(stage.tree), description(stage.tree), command, tuple(marks), wishes.theme.ground, wishes.ground)
        for stage, marks in zip(subject.stages, made, strict=True)
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
    return f"{rays}: {made_of}. The pixel's colour is {rgb_text(tree.radiance)} (linear r g b)."


KINDS = (
    ("camera", "from the eye"),
    ("reflection", "reflected"),
    ("refraction", "refracted"),
    ("tir", "totally reflected"),
    ("shadow", "to lights"),
)
