"""The node table: one row a ray, level by level. What the kernel writes, the viewer draws and JSON spells out.

A level's rays stand first, then its shadow rays, then the next level: so the tree of depth d is a prefix of the tree
of depth d+1, and stepping the depth is slicing the table. Codes are whole numbers, -1 for none; NaN stands for absent.
"""

import numpy as np

KINDS = ("camera", "reflection", "refraction", "tir", "shadow")
CAMERA, REFLECTION, REFRACTION, TIR, SHADOW = range(5)

# Why a ray has nothing below it; on a shadow row, what it met. -1: it has children and none was cut.
ENDS = ("surface", "background", "depth", "weight", "tolerance", "nodes", "invalid", "lit", "filtered", "blocked")
SURFACE, BACKGROUND, DEPTH, WEIGHT, TOLERANCE, NODES, INVALID, LIT, FILTERED, BLOCKED = range(10)

NONE = -1

NODE = np.dtype(
    [
        ("id", np.int64),
        ("parent", np.int64),
        ("kind", np.int32),
        ("depth", np.int32),  # a shadow ray has its parent's
        ("origin", np.float64, 3),
        ("direction", np.float64, 3),  # unit
        ("t", np.float64),  # distance to `point`
        ("point", np.float64, 3),  # the hit; on a shadow row the occluder's, or the light's
        ("normal", np.float64, 3),  # unit, on the side the ray comes from: the n of every formula at this hit
        ("object", np.int32),  # what was hit; on a shadow row the occluder, or the first glass it went through
        ("light", np.int32),  # shadow rows only
        ("n1", np.float64),  # index of the medium the ray runs in
        ("n2", np.float64),  # index behind a transparent surface
        ("theta1", np.float64),  # radians
        ("theta2", np.float64),
        ("factor", np.float64, 3),  # what the parent multiplies this ray by
        ("weight", np.float64, 3),  # the product of factors from the eye down
        ("radicand", np.float64),  # 1 - n^2 (1 - c1^2): total internal reflection where it is <= 0
        ("local", np.float64, 3),
        ("radiance", np.float64, 3),  # local + sum of factor * radiance over the children but shadow rays
        ("end", np.int32),
        ("error", np.float64),  # how far rounding may have moved `point`, estimated to first order; a length
        ("turn", np.float64),  # and how far it may have turned `direction`; radians
        # From here on for the kernel alone:
        ("start", np.int32),  # the surface the ray leaves, of twins the first
        ("reach", np.float64),  # scale of the rounding errors in its origin
        ("surface", np.int32),  # the surface it hits
        ("side", np.float64),  # of its start's normal, on which it leaves: +1, -1
        ("hit_side", np.float64),  # of the hit surface's normal, from which it comes
        ("face", np.float64, 3),  # the hit face's own normal, on the side the ray comes from
        ("cut", np.float64),  # weight of the rays it would send out that were cut: their largest components' sum
        ("child", np.int64),  # the first ray it sends out, -1 for none
        ("sibling", np.int64),  # the next that its parent sends out
    ],
    align=True,
)

_NAMES: tuple[str, ...] = NODE.names  # type: ignore[assignment]
PUBLIC = np.dtype([(name, NODE[name]) for name in _NAMES[: _NAMES.index("start")]])
