"""The node table: one row per ray, level by level. The kernel writes it, viewer and JSON read it.

The rays of a level come first, then their shadow rays, then the next level. So the tree of depth d is a prefix of the
tree of depth d + 1, and stepping the depth slices the table. Codes are integers, -1 for none. NaN stands for absent.
"""

from typing import Annotated

from tracer.compile.rows import Float, Float3, Int32, Int64, Row, dtype_of
from tracer.rays import HISTORY, HistoryRow

KINDS = ("camera", "reflection", "refraction", "tir", "shadow")
CAMERA, REFLECTION, REFRACTION, TIR, SHADOW = range(5)

# The reason why a ray has no children; for a shadow ray, its result. -1: it has children, and none was cut.
ENDS = ("surface", "background", "depth", "weight", "tolerance", "nodes", "invalid", "lit", "filtered", "blocked")
SURFACE, BACKGROUND, DEPTH, WEIGHT, TOLERANCE, NODES, INVALID, LIT, FILTERED, BLOCKED = range(10)

NONE = -1


class RecordedRow(Row):
    """The fields that the kernel writes and readers see."""

    id: Int64
    parent: Int64
    kind: Int32  # as KINDS numbers them
    depth: Int32  # a shadow ray has its parent's
    origin: Float3
    direction: Float3  # unit vector
    t: Float  # distance to `point`
    point: Float3  # the hit; of a shadow ray, the occluder's hit or the light
    normal: Float3  # unit normal on the side the ray comes from: the n of every formula at this hit
    object: Int32  # what was hit; of a shadow ray, the occluder, or the first transparent object crossed
    light: Int32  # of a shadow ray
    n1: Float  # index of refraction of the medium that the ray is in
    n2: Float  # index behind a transparent surface
    theta1: Float  # angle of incidence, radians
    theta2: Float  # angle of refraction, radians
    factor: Float3  # factor by which the parent multiplies this ray's radiance
    weight: Float3  # product of the factors from the eye down
    radicand: Float  # 1 - n^2 (1 - c1^2): total internal reflection where it is <= 0
    local: Float3  # local illumination
    radiance: Float3  # local + sum of factor * radiance over the children that are no shadow rays
    end: Int32  # as ENDS numbers them


class PublicRow(RecordedRow):
    """The fields that readers see: what was recorded, and what `tracer.tree` tells about it afterwards.

    An error is a bound to first order on the rounding error (`tracer.tree.error_propagation`); of a colour, on that of
    its largest component.
    """

    error: Float  # of `point`, a length
    turn: Float  # of `direction`, radians
    factor_error: Float
    weight_error: Float
    radiance_error: Float


class NodeRow(RecordedRow):
    """The fields of the kernel: what it records for readers, and what only it uses."""

    start: Int32  # id of the surface that the ray leaves, -1 for the eye; of coincident surfaces the first
    history: Annotated[HistoryRow, HISTORY]  # as in `tracer.rays.Ray`
    magnitude: Float  # scale of the rounding errors in `origin`, as in `tracer.rays.Ray`
    surface: Int32  # id of the surface hit
    side: Float  # +1 or -1: the side of the normal on which the ray leaves its start
    hit_side: Float  # +1 or -1: the side of the normal from which the ray hits
    face_normal: Float3  # unit normal of the face hit, on the side the ray comes from; `normal` may be interpolated
    cut: Float  # sum of the largest weights of its children that were cut
    child: Int64  # its first child that is no shadow ray, -1 for none
    sibling: Int64  # the next child of its parent, -1 for none


PUBLIC, NODE = dtype_of(PublicRow), dtype_of(NodeRow)
