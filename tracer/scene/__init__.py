"""The scene as frozen dataclasses with their defaults, and the camera view that follows from them."""

from tracer.scene.scene import (
    Background as Background,
    Camera as Camera,
    Checker as Checker,
    Image as Image,
    Light as Light,
    Material as Material,
    Object as Object,
    Scene as Scene,
    SceneError as SceneError,
    Shape as Shape,
    Tracing as Tracing,
)
