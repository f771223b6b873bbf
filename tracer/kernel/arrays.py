"""The rows of a world's arrays: what kernels know of surfaces, objects, materials and lights."""

from typing import NamedTuple

import numpy as np

SURFACE = np.dtype(
    [
        ("a", np.float64, 3),  # a..count: as the shape's file says under "Packed as"
        ("b", np.float64, 3),
        ("c", np.float64, 3),
        ("normal", np.float64, 3),  # unit, of a flat face
        ("low", np.float64, 3),  # what rounding took from it, times any one number near 1
        ("r", np.float64),
        ("first", np.int32),  # of a polygon's corners, -1 for none
        ("count", np.int32),  # corners of a flat face, 1 for a sphere, 0 for what has none
        ("form", np.int32),  # which shape, as CODES numbers them
        ("object", np.int32),
        (
            "coincident",
            np.int32,
        ),  # the first surface that is curved the very same way in the same place: for most, itself
        ("smooth", np.int32),  # row of `smooth`, -1 for none
    ],
    align=True,
)

OBJECT = np.dtype(
    [
        ("material", np.int32),
        ("solid", np.int32),  # its rank among the transparent solids, -1 for what bounds no medium
        ("closed", np.bool_),  # whether this solid has an inside that a point can be tested for
        ("tiled", np.bool_),  # whether a checker lies along its own two axes
        ("u", np.float64, 3),
        ("v", np.float64, 3),
    ],
    align=True,
)

MATERIAL = np.dtype(
    [
        ("color", np.float64, 3),
        ("checker_color", np.float64, 3),
        ("checker_size", np.float64),  # 0: no checker
        ("ambient", np.float64),
        ("diffuse", np.float64),
        ("specular", np.float64),
        ("shininess", np.float64),
        ("reflect", np.float64),
        ("transmit", np.float64),
        ("ior", np.float64),
    ],
    align=True,
)

LIGHT = np.dtype(
    [
        ("position", np.float64, 3),
        ("towards", np.float64, 3),  # unit, of a light at infinity: from the scene to it
        ("color", np.float64, 3),
        ("distant", np.bool_),
    ],
    align=True,
)


class Arrays(NamedTuple):
    """The world as kernels see it. Every scene has the same types, so none has to wait for a compiler."""

    surfaces: np.ndarray
    corners: np.ndarray  # (n, 3) of polygons
    smooth: np.ndarray  # (n, 3, 3) vertex normals of smooth faces
    objects: np.ndarray
    materials: np.ndarray
    lights: np.ndarray
    indices: np.ndarray  # of refraction, by a solid's rank
    background: np.ndarray
    ambient: np.ndarray
    unboxed: np.ndarray  # surfaces that every ray is tested against: those without end, and all where they are few
    nodes: np.ndarray  # of the hierarchy of boxes over the others
    blocks: np.ndarray  # of triangles in it
    inverse_unit: np.ndarray  # (1,) of the hierarchy, one over its unit of length
