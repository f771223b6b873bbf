"""The tracer: a scene in, the tree of rays behind a pixel out.

    scene = tracer.load("scene.toml")
    world = tracer.prepare(scene)
    tree = tracer.trace(world, pixel=(320, 240), depth=3)
    image = tracer.render(world, size=(640, 480), threads=2)

There is one kernel: the image is that kernel run for every pixel, a click is that kernel run once with its table kept.
"""

from tracer import optics
from tracer.formats import load
from tracer.image.render import Image, render
from tracer.kernel.world import World, prepare
from tracer.scene import Scene, SceneError
from tracer.tree.raytree import RayTree, trace

__all__ = ["Image", "RayTree", "Scene", "SceneError", "World", "load", "optics", "prepare", "render", "trace"]
