"""Decision margins of a tree's rows: the deciding quantity over its own told error, dimensionless.

Below 1, the ray could have gone otherwise: rounding may have decided. Worked out afterwards from the scene, as the
errors are. A row's margin is the smallest of its decisions: hit or miss at an edge, a silhouette or a plane that the
ray runs along; which of two surfaces comes first; total internal reflection; the border of a checker; and for a shadow
ray, whether its surface faces the light. Which normal a smooth mesh is shaded with is not among them.
"""

from typing import NamedTuple

import numpy as np

from tracer.formulas.double_double import U
from tracer.kernel.nodes import SHADOW
from tracer.kernel.world import World
from tracer.tree.margins.candidates import Rays
from tracer.tree.margins.surfaces import Doubt, Ends, surface_margins

# What is said of a decision. {} is the object.
DECISIONS = (
    "the edge of {}",
    "the silhouette of {}",
    "whether the ray runs towards {} or away",
    "which surface comes first, here or {}",
    "whether the ray starts before or behind {}",
    "total internal reflection or not",
    "the border of two colours of the checker",
    "whether the surface faces the light",
)
TIR, CHECKER, HORIZON = range(5, 8)
NOWHERE = np.zeros(0)  # in tables that were not traced


class Details(NamedTuple):
    """Fields of rows that only the kernel knows, and the errors of normals, one entry a row."""

    start: np.ndarray  # id of the surface that the ray leaves, -1 for the eye
    surface: np.ndarray  # id of the surface hit, -1 for none
    magnitude: np.ndarray  # as in `tracer.rays.Ray`
    face_normal: np.ndarray  # (n, 3) of the face hit
    bend: np.ndarray  # error of the normal at the hit, radians
    hit_side: np.ndarray = NOWHERE  # +1 or -1: the side of the outward normal from which the ray hits; 0 for none


class Margins(NamedTuple):
    """The smallest margin of each row. inf: none below `candidates.REACH`."""

    margin: np.ndarray
    decision: np.ndarray  # as DECISIONS numbers them, -1 for none
    object: np.ndarray  # that the decision is about, -1 for none


def find_margins(world: World, nodes: np.ndarray, details: Details, rows: np.ndarray) -> Margins:
    """The margins of some rows of a node table."""
    found = Margins(np.full(len(rows), np.inf), np.full(len(rows), -1), np.full(len(rows), -1))
    if len(rows) == 0:
        return found
    of = nodes[rows]
    away = faces_away(nodes, of)
    traced = np.flatnonzero(~away)
    rays, ends = rays_of(nodes, details, rows[traced]), ends_of(nodes, details, rows[traced])
    owners = np.asarray(world.arrays.surfaces["object"])
    for doubt in surface_margins(world, rays, ends):
        keep(found, traced, doubt, owners)
    for doubt in hit_margins(world, nodes, details, rows):
        keep(found, np.arange(len(rows)), doubt, owners)
    return found


def keep(found: Margins, index: np.ndarray, doubt: Doubt, owners: np.ndarray) -> None:
    """Note margins that are smaller than those so far."""
    usable = np.isfinite(doubt.margin)
    order = np.flatnonzero(usable)[np.argsort(-doubt.margin[usable], kind="stable")]  # the smallest last
    k, margin = index[doubt.ray[order]], doubt.margin[order]
    less = margin < found.margin[k]
    k, order = k[less], order[less]
    found.margin[k] = doubt.margin[order]
    found.decision[k] = doubt.decision
    surface = doubt.surface[order]
    found.object[k] = np.where(surface >= 0, owners[np.maximum(surface, 0)], -1)


def faces_away(nodes: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Whether each row is a shadow ray that adds nothing, whatever it meets."""
    cosine = (nodes["normal"][of["parent"]] * of["direction"]).sum(axis=1)
    return (of["kind"] == SHADOW) & ((of["t"] == 0.0) | ~(cosine > 0.0))


def rays_of(nodes: np.ndarray, details: Details, rows: np.ndarray) -> Rays:
    of = nodes[rows]
    off = np.where(of["parent"] >= 0, nodes["error"][of["parent"]], 0.0)
    end = np.where(np.isnan(of["t"]), np.inf, of["t"])
    size = np.maximum(details.magnitude[rows], np.abs(of["origin"]).sum(axis=1))
    return Rays(rows, of["origin"], of["direction"], end, off, of["turn"], size)


def ends_of(nodes: np.ndarray, details: Details, rows: np.ndarray) -> Ends:
    of, parent = nodes[rows], nodes["parent"][rows]
    nowhere = np.full(3, np.nan)
    first = np.where((parent >= 0)[:, None], details.face_normal[parent], nowhere)
    return Ends(
        details.start[rows],
        first,
        details.surface[rows],
        details.face_normal[rows],
        np.where(np.isnan(of["error"]), 0.0, of["error"]),
    )


def hit_margins(world: World, nodes: np.ndarray, details: Details, rows: np.ndarray) -> list[Doubt]:
    """The margins of what is decided at the hit itself."""
    of, scene = nodes[rows], world.scene
    none = np.full(len(rows), -1)
    found = []
    thin = np.array([item.thin for item in scene.objects])
    glass = np.flatnonzero(np.isfinite(of["radicand"]) & (of["n1"] > of["n2"]))  # else it is never total
    glass = glass[~thin[of["object"][glass]]]
    eta = of["n1"][glass] / of["n2"][glass]
    c1 = -(of["direction"][glass] * of["normal"][glass]).sum(axis=1)
    s1 = np.sqrt(np.maximum(0.0, 1.0 - c1 * c1))
    wrong = of["turn"][glass] + details.bend[rows][glass]
    error = eta * eta * (2.0 * s1 * np.abs(c1) * wrong + wrong * wrong) + 4.0 * U * (1.0 + eta * eta)
    found.append(Doubt(TIR, glass, np.abs(of["radicand"][glass]) / error, none[glass]))
    size = np.array([item.material.checker.size if item.material.checker else np.nan for item in scene.objects])
    tiled = np.flatnonzero((of["kind"] != SHADOW) & (of["object"] >= 0) & np.isfinite(size[of["object"]]))
    for k, along in checker_coordinates(world, of, tiled):
        side = size[of["object"][k]]
        gap = np.abs(along / side - np.round(along / side)) * side
        found.append(Doubt(CHECKER, k, gap / (of["error"][k] + 4.0 * U * np.abs(of["point"][k]).sum(axis=1)), none[k]))
    lit = np.array([item.material.is_lit for item in scene.objects])
    shadow = np.flatnonzero(of["kind"] == SHADOW)
    parent = of["parent"][shadow]
    shadow, parent = shadow[lit[nodes["object"][parent]]], parent[lit[nodes["object"][parent]]]
    for normal in (nodes["normal"][parent], details.face_normal[parent]):
        cosine = (normal * of["direction"][shadow]).sum(axis=1)
        error = details.bend[parent] + of["turn"][shadow] + 4.0 * U
        found.append(Doubt(HORIZON, shadow, np.abs(cosine) / error, none[shadow]))
    return found


def checker_coordinates(world: World, of: np.ndarray, rows: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """(rows, coordinate) for each axis along which cells of a checker are counted."""
    objects = np.asarray(world.arrays.objects)[of["object"][rows]]
    point, plain = of["point"][rows], ~objects["tiled"]
    found = [(rows[plain], point[plain, k]) for k in range(3)]
    for axis in ("u", "v"):
        found.append((rows[~plain], (objects[axis][~plain] * point[~plain]).sum(axis=1)))
    return found
