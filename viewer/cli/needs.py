"""What a scene needs of the window and of the libraries around the tracer, and what is left out."""

from tracer.kernel.left_out import Need
from tracer.scene import Scene
from tracer.shapes.polygon import Polygon
from viewer.gl.features import features_of

# What is imported only where it is used, by the names of the plan.
MODULES = {
    "polygon cutter": ("mapbox_earcut",),
    "window libraries": ("imgui_bundle", "moderngl", "glfw"),
    "PNG library": ("PIL.Image",),
    "EXR library": ("OpenEXR",),
}

SHADER = {"glass pass, shader": "GLASS", "mirrors in shader": "MIRROR", "checkers in shader": "CHECKER"}


def window_needs(scene: Scene, in_lesson: bool) -> tuple[Need, ...]:
    """Of every frame."""
    features = features_of(scene)
    nothing = {
        "GLASS": "nothing transmits",
        "MIRROR": "nothing opaque reflects",
        "CHECKER": "no material has a checker",
    }
    something = {"GLASS": "something transmits", "MIRROR": "something opaque reflects", "CHECKER": "a material has one"}
    drawn = [
        Need(name, feature in features, (something if feature in features else nothing)[feature])
        for name, feature in SHADER.items()
    ]
    return (*drawn, Need("lesson panel", in_lesson, "a lesson" if in_lesson else "the scene belongs to no lesson"))


def start_needs(scene: Scene) -> tuple[Need, ...]:
    """Of a start of the program. What a command needs, not the scene, the scene does without."""
    cut = any(isinstance(item.shape, Polygon) for item in scene.objects)
    return (
        Need("polygon cutter", cut, "polygons in the 3D view" if cut else "no polygon in the 3D view"),
        Need("window libraries", False, "loaded by the viewer"),
        Need("PNG library", False, "loaded to write a PNG"),
        Need("EXR library", False, "loaded to write an EXR"),
    )
