"""The tracer: from a scene to the ray tree behind a pixel, and to images.

    scene = tracer.load("scene.toml")
    world = tracer.prepare(scene)
    tree = tracer.trace(world, pixel=(320, 240), depth=3)
    image = tracer.render(world, size=(640, 480), threads=2)

There is one kernel. For an image the kernel runs for every pixel, and the colour is kept. For a click it runs once,
and the table of rays is kept.

The names above are listed in `__init__.pyi`, and imported when they are first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
