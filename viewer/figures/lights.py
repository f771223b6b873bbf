"""Shadow rays in figures: their fates, with dashes and words. If a hit has many, one line of words stands for them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tracer.kernel.nodes import SHADOW, SURFACE
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


def many_lights(tree: RayTree) -> frozenset[int]:
    """The shadow rays of hits that have more than MOST_LIGHTS."""
    shadows = np.flatnonzero(tree.nodes["kind"] == SHADOW)
    parents = tree.nodes["parent"][shadows]
    many = np.bincount(parents, minlength=len(tree)) > MOST_LIGHTS
    return frozenset(shadows[many[parents]].tolist())


def pointed_lights(tree: RayTree, selected: int | None) -> frozenset[int]:
    """The shadow rays that a view of the scene is about, drawn with arrows: the selected one and those of the selected
    hit; and those of a tree's only hit, if it sends no other rays at any depth.
    """
    hits = tree.nodes["kind"] != SHADOW
    is_lone = np.count_nonzero(hits) == 1 and tree.nodes["end"][0] == SURFACE
    lone = shadow_rays(tree, 0) if is_lone and len(tree) - 1 <= MOST_LIGHTS else []
    if selected is None:
        return frozenset(lone)
    return frozenset((*lone, *shadow_rays(tree, selected), *(() if hits[selected] else (selected,))))


def counted(tree: RayTree, rows: Iterable[int]) -> list[tuple[Fate, int]]:
    """The number of these shadow rays of each fate that occurs, in the order of FATES."""
    found = [way_of(tree, i) for i in rows]
    return [(fate, found.count(fate)) for fate in FATES if fate in found]


def light_words(counts: Iterable[tuple[Fate, int]]) -> list[str]:
    """The parts of the line that stands for shadow rays, like "5 reach", "7 face away"."""
    return [f"{count} {fate.one if count == 1 else fate.many}" for fate, count in counts]


def light_line(tree: RayTree, rows: Iterable[int]) -> str:
    """The line that stands for these shadow rays, like "L: 5 reach, 7 face away"."""
    return f"L: {', '.join(light_words(counted(tree, rows)))}"


def light_title(tree: RayTree, rows: Iterable[int]) -> str:
    """The same for a title, with the number of those that add nothing though nothing blocks them."""
    shadows = list(rows)
    idle = sum(fate_of(tree, i).name == "nothing" for i in shadows)
    if not idle:
        return light_line(tree, shadows)
    adds, them = ("adds", "it") if idle == 1 else ("add", "them")
    return f"{light_line(tree, shadows)}; {idle} {adds} nothing, though nothing blocks {them}"


def turn_to_light(tree: RayTree, i: int) -> tuple[float, float]:
    """The angles of shadow ray i, in radians: from the normal of its hit, positive on the side to which the ray to the
    hit runs on, and out of the plane of incidence.
    """
    row = tree.nodes[int(tree.nodes["parent"][i])]
    v, n, to_light = (np.array(vector) for vector in (row["direction"], row["normal"], tree.nodes["direction"][i]))
    along = v - float(v @ n) * n
    up = float(to_light @ n)
    beside = float(np.linalg.norm(to_light - up * n))
    length = float(np.linalg.norm(along))
    right = float(to_light @ along) / length if length > 1e-9 else beside
    out = math.asin(min(1.0, math.sqrt(max(0.0, beside**2 - right**2))))
    return math.copysign(math.atan2(beside, up), right), out
