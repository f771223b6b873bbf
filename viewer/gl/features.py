"""What of the surfaces' shader and passes a scene needs: names that its GLSL asks for by `#ifdef`.

A scene without glass has no glass pass, and a shader without glass in it. Variants are compiled when a scene first asks
for one, and kept.
"""

from tracer.scene import Scene

FEATURES = ("GLASS", "MIRROR", "CHECKER")

Features = frozenset[str]


def features_of(scene: Scene) -> Features:
    materials = {item.material for item in scene.objects}
    asked = {
        "GLASS": any(material.transmit > 0.0 for material in materials),
        "MIRROR": any(material.reflect > 0.0 and material.transmit == 0.0 for material in materials),
        "CHECKER": any(material.checker for material in materials),
    }
    return frozenset(name for name in FEATURES if asked[name])
