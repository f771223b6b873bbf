from tracer import (
    Image as Image,
    MissingBoundError as MissingBoundError,
    RayTree as RayTree,
    RayTrees as RayTrees,
    Scene as Scene,
    SceneError as SceneError,
    World as World,
    cluster as cluster,
    load as load,
    nodes as nodes,
    optics as optics,
    prepare as prepare,
    render as render,
    trace as trace,
    trace_rays as trace_rays,
    verify as verify,
)
from viewer.figures.notebook import tree_svg as tree_svg

__version__: str
