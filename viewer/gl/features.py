"""Parts of the surfaces' shader that some scenes need: their GLSL stands between `#ifdef` and `#endif`.

A scene without glass has no glass pass, and its shader has no code for glass. Each variant is compiled when a scene
first asks for it, and kept.
"""

from collections.abc import Callable
from dataclasses import dataclass

from tracer.kernel.capabilities import Need
from tracer.scene import Material, Scene


@dataclass(frozen=True)
class Feature:
    """A part of the shader."""

    name: str  # in GLSL
    title: str  # in `raytree plan`
    asks: Callable[[Material], bool]  # whether a material needs it
    needed: str  # reasons
    not_needed: str


FEATURES = (
    Feature("GLASS", "glass pass, shader", lambda m: m.transmit > 0.0, "something transmits", "nothing transmits"),
    Feature(
        "MIRROR", "mirrors in shader", lambda m: m.reflect > 0.0 and m.transmit == 0.0,
        "something opaque reflects", "nothing opaque reflects",
    ),
    Feature(
        "CHECKER", "checkers in shader", lambda m: m.checker is not None,
        "a material has one", "no material has a checker",
    ),
)  # fmt: skip

Features = frozenset[str]


def features_of(scene: Scene) -> Features:
    """The names of the features that a scene needs."""
    materials = {item.material for item in scene.objects}
    return frozenset(feature.name for feature in FEATURES if any(map(feature.asks, materials)))


def shader_needs(scene: Scene) -> list[Need]:
    """Each feature, and why the scene needs it or not."""
    own = features_of(scene)
    return [
        Need(feature.title, feature.name in own, feature.needed if feature.name in own else feature.not_needed)
        for feature in FEATURES
    ]
