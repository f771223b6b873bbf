"""Notes about scenes that are valid but probably not intended, or not shown as they are. One line for each kind."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from tracer.scene.solids import Solid

MOST_NAMES = 3  # in a note
PRIORITY = "unless it has a higher priority"
MOST_COMPARED = 2000  # solids of which each is compared with all others


def listed(names: Sequence[str]) -> str:
    """Names in quotes, each once; of a long list the first few."""
    different = list(dict.fromkeys(names))
    shown = ", ".join(f'"{name}"' for name in different[:MOST_NAMES])
    return shown if len(different) <= MOST_NAMES else f"{shown} and {len(different) - MOST_NAMES} more"


def turned_notes(names: Sequence[str]) -> list[str]:
    """The note about closed meshes that were wound inside out."""
    return [f"{listed(names)}: wound inside out in the file, and turned"] if names else []


def open_notes(solids: Sequence[Solid], names: Sequence[str]) -> list[str]:
    """The notes about media that are bounded by an open surface."""
    stays = "light that enters stays in the medium"
    found = []
    for misaligned, cause, help_ in (
        (False, "", "use thin = true, or close the mesh"),
        (True, ", since some faces are wound against their neighbours", "turn these faces, so that all point outwards"),
    ):
        opened = [names[s.objects[0]] for s in solids if not s.closed and s.misaligned == misaligned]
        if opened:
            what = "is open" if len(opened) == 1 else f"are open ({len(opened)} surfaces)"
            found.append(f"{listed(opened)} {what}{cause}: {stays}; {help_}")
    return found


def hidden_notes(solids: Sequence[Solid], names: Sequence[str]) -> list[str]:
    """Notes about solids that are never visible, since they lie inside one of higher priority; a line for each such
    pair of names.

    `solids` are in the order of priority. A solid counts as inside if all corners of its box are, so every note is
    true, but not every hidden solid is found; none in scenes with more than MOST_COMPARED solids.
    """
    if len(solids) > MOST_COMPARED:
        return []
    infinite = np.array([[-math.inf] * 3, [math.inf] * 3])
    boxes = [solid.bounds() for solid in solids]
    low, high = np.moveaxis(np.array([infinite if box is None else box for box in boxes]).reshape(-1, 2, 3), 1, 0)
    found: dict[tuple[str, str], list[str]] = {}
    for k, inner in enumerate(solids):
        if boxes[k] is None:
            continue
        around = ((low[:k] <= low[k]) & (high[:k] >= high[k])).all(axis=1)
        corners = np.array(list(itertools.product(*zip(low[k], high[k], strict=True))))
        for outer in (solids[j] for j in np.flatnonzero(around).tolist()):
            if all(outer.contains(corner) for corner in corners):
                way = PRIORITY if inner.corners is None else f"{PRIORITY} or, as a cavity, is wound inside out"
                found.setdefault((names[outer.objects[0]], way), []).append(names[inner.objects[0]])
                break
    return [
        f'{listed(inner)} lies inside "{outer}" and is never visible, {way}' for (outer, way), inner in found.items()
    ]
