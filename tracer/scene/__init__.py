"""What an author writes: a scene as frozen dataclasses with their defaults, and the camera that follows from them."""

from tracer.scene.scene import (
    Background,
    Camera,
    Checker,
    Image,
    Light,
    Material,
    Object,
    Scene,
    SceneError,
    Shape,
    Tracing,
)

__all__ = [
    "Background",
    "Camera",
    "Checker",
    "Image",
    "Light",
    "Material",
    "Object",
    "Scene",
    "SceneError",
    "Shape",
    "Tracing",
]
