"""Transparent objects in layers: those of one layer do not hide each other, so that one picture shows all of each."""

import itertools
from collections.abc import Sequence

import numpy as np

from tracer.formulas.camera import View, make_view
from tracer.scene import Camera, Object
from viewer.figures.marks import Rectangle, overlap

EVERYWHERE = (-np.inf, -np.inf, np.inf, np.inf)


def layers(objects: Sequence[Object], glass: Sequence[int], camera: Camera) -> list[list[int]]:
    """The numbers of these objects in layers, each object in the first layer with whose objects it does not overlap.

    Rectangles around the projected boxes decide, so objects may be in different layers without need.
    """
    assert camera.position is not None and camera.look_at is not None
    view = make_view(camera.position, camera.look_at, camera.up, camera.fov, (1, 1))
    found: list[tuple[list[int], list[Rectangle]]] = []
    for k in glass:
        place = _projected(objects[k], view)
        for numbers, places in found:
            if not any(overlap(place, other) for other in places):
                numbers.append(k)
                places.append(place)
                break
        else:
            found.append(([k], [place]))
    return [numbers for numbers, _ in found]


def _projected(item: Object, view: View) -> Rectangle:
    """A rectangle of the image plane that the object lies in, in any unit; EVERYWHERE if it reaches behind the
    camera.
    """
    boxes = item.shape.bounds()
    if boxes is None or not np.isfinite(boxes).all():
        return EVERYWHERE
    ends = np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
    away = np.array(list(itertools.product(*ends.T))) - view.eye
    depth = away @ np.array(view.forward)
    if not (depth > 0.0).all():
        return EVERYWHERE
    x, y = away @ np.array(view.right) / depth, away @ np.array(view.up) / depth
    return (float(x.min()), float(y.min()), float(x.max()), float(y.max()))
