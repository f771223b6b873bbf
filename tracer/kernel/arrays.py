"""The world as kernels see it: rows of surfaces, objects, materials and lights, and the hierarchy over the surfaces."""

from typing import NamedTuple

from tracer.accel.rows import NodeRow
from tracer.compile.rows import Bool, Float, Float3, Int32, Numbers, Row, Rows, dtype_of
from tracer.kernel.formulas import Formulas
from tracer.shapes.surface_row import BlockRow, SurfaceRow


class ObjectRow(Row):
    """One object."""

    material: Int32
    sheet: Bool  # whether it is thin: if it transmits light, it bounds no medium
    tiled: Bool  # whether its checkers lie along u and v
    u: Float3
    v: Float3
    placed: Bool  # whether it is a mesh whose vertices were moved, and so rounded


class MaterialRow(Row):
    """One material. Fields are copied from the fields of the same name in `tracer.scene.Material`; `checker_x` from
    `checker.x`.
    """

    color: Float3
    checker_color: Float3
    checker_size: Float  # 0: no checker
    ambient: Float
    diffuse: Float
    specular: Float
    shininess: Float
    reflect: Float
    transmit: Float
    ior: Float


class LightRow(Row):
    """One light. Fields are copied from the fields of the same name in `tracer.scene.Light`; two are derived."""

    position: Float3
    color: Float3
    towards: Float3  # of a light at infinity: unit vector from the scene to it
    distant: Bool


OBJECT, MATERIAL, LIGHT = dtype_of(ObjectRow), dtype_of(MaterialRow), dtype_of(LightRow)


class Arrays(NamedTuple):
    """All that kernels read. Every scene has the same types, so no scene waits for a compilation."""

    surfaces: Rows[SurfaceRow]
    corners: Numbers  # (n, 3) of polygons
    smooth: Numbers  # (n, 3, 3) vertex normals of faces that have them
    objects: Rows[ObjectRow]
    materials: Rows[MaterialRow]
    lights: Rows[LightRow]
    indices: Numbers  # of refraction, by the rank of a solid
    closed: Numbers  # whether a solid has an inside, by its rank
    background: Numbers
    ambient: Numbers
    unboxed: Numbers  # ids of the surfaces tested against every ray: the infinite ones, and all where they are few
    nodes: Rows[NodeRow]  # of the hierarchy over the other surfaces
    blocks: Rows[BlockRow]
    inverse_unit: Numbers  # (1,): one over the hierarchy's unit of length
    formulas: Formulas
