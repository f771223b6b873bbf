from . import nodes as nodes, optics as optics
from .formats import load as load
from .image.render import Image as Image, render as render
from .kernel.world import World as World, prepare as prepare
from .scene import Scene as Scene, SceneError as SceneError
from .scene.radiance_bound import MissingBoundError as MissingBoundError
from .tree.batch import RayTrees as RayTrees, trace_rays as trace_rays
from .tree.raytree import RayTree as RayTree
from .tree.trace import trace as trace
from .tree.verified.verified import verify as verify
