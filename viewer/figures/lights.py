"""Shadow rays in figures: their fates, with dashes and words. If a hit has many, one line of words stands for them."""

from collections.abc import Iterable
from dataclasses import dataclass

from tracer.kernel.nodes import SHADOW
from tracer.tree.raytree import RayTree
from viewer.base.theme import BLOCKED_DASH, FILTERED_DASH, NOTHING_DASH, STYLES

MOST_LIGHTS = 4  # shadow rays that are drawn at a hit, and lights that are named in a legend


@dataclass(frozen=True)
class Fate:
    """What becomes of a shadow ray."""

    name: str
    legend: str
    dash: tuple[float, float]
    one: str = ""  # after a number, in the line that stands for many
    many: str = ""


FATES = (
    Fate("lit", "to a light", STYLES["shadow"].dash, "reaches", "reach"),
    Fate("filtered", "through glass", FILTERED_DASH, "through glass", "through glass"),
    Fate("away", "faces away", NOTHING_DASH, "faces away", "face away"),
    Fate("blocked", "blocked", BLOCKED_DASH, "blocked", "blocked"),
    Fate("nothing", "adds nothing", NOTHING_DASH),  # in the line, such a ray counts by what is in its way
)
FATE = {fate.name: fate for fate in FATES}


def fate_of(tree: RayTree, i: int) -> Fate:
    """The fate of shadow ray i, as it is drawn."""
    way = way_of(tree, i)
    return FATE["nothing"] if way.name in ("lit", "filtered") and tree.adds_nothing(i) else way


def way_of(tree: RayTree, i: int) -> Fate:
    """What is in the way of shadow ray i, whether its light adds something or not."""
    return FATE["away" if tree.faces_away(i) else tree.end(i) or "lit"]


def ray_dash(tree: RayTree, i: int) -> tuple[float, float]:
    """The dash of ray i, which says whether it adds light."""
    if tree.nodes["kind"][i] == SHADOW:
        return fate_of(tree, i).dash
    return NOTHING_DASH if tree.adds_nothing(i) else STYLES[tree.kind(i)].dash


def shadow_rays(tree: RayTree, i: int) -> list[int]:
    return [child for child in tree.children[i] if tree.nodes["kind"][child] == SHADOW]


def has_many(tree: RayTree, i: int) -> bool:
    """Whether hit i has so many shadow rays that a line of words stands for them."""
    return len(shadow_rays(tree, i)) > MOST_LIGHTS


def counted(tree: RayTree, rows: Iterable[int]) -> list[tuple[Fate, int]]:
    """The number of these shadow rays of each fate that occurs, in the order of FATES."""
    found = [way_of(tree, i) for i in rows]
    return [(fate, found.count(fate)) for fate in FATES if fate in found]


def light_words(counts: Iterable[tuple[Fate, int]]) -> list[str]:
    """The parts of the line that stands for shadow rays, like "5 reach", "7 face away"."""
    return [f"{count} {fate.one if count == 1 else fate.many}" for fate, count in counts]


def light_title(tree: RayTree, rows: Iterable[int]) -> str:
    """The same as a sentence, with the number of those that add nothing though nothing blocks them."""
    shadows = list(rows)
    idle = sum(fate_of(tree, i).name == "nothing" for i in shadows)
    words = (
        f"{len(shadows)} shadow ray{'s' if len(shadows) > 1 else ''}: {', '.join(light_words(counted(tree, shadows)))}"
    )
    if not idle:
        return words
    return (
        f"{words}; {idle} add{'s' if idle == 1 else ''} nothing, though nothing blocks {'it' if idle == 1 else 'them'}"
    )
