"""An upper bound on the radiance of any ray of a scene.

Let every hit's local term be at most L, and let the factors of the rays that it sends out add up to at most s < 1.
Then the radiance of every ray is at most B = max(background, L / (1 - s)), since L + s B <= B. So a tree lacks at
most residual * B: the weights that were cut, each times the most light that its ray could have brought. If s >= 1
and L > 0, or s > 1 and the background emits light, radiance may grow without limit, and there is no bound. (Hall &
Greenberg, IEEE CG&A 3(8), 1983, cut rays by weight. The weight of one ray is no bound, the sum is.)
"""

import math

from tracer.scene.scene import Material, Scene


def radiance_bound(scene: Scene) -> float:
    """B in its largest component, linear RGB; inf where there is no bound."""
    materials = {item.material for item in scene.objects}
    brightest = max((local_bound(scene, material) for material in materials), default=0.0)
    passed_on = max((material.reflect + material.transmit for material in materials), default=0.0)
    background = max(scene.background.color)
    if passed_on < 1.0:
        return max(background, brightest / (1.0 - passed_on))
    if brightest > 0.0 or (passed_on > 1.0 and background > 0.0):
        return math.inf
    return background


def local_bound(scene: Scene, material: Material) -> float:
    """The largest local term of a material: facing every light, and with every highlight at its maximum."""
    colors = [material.color] + ([material.checker.color] if material.checker else [])
    most = 0.0
    for k in range(3):
        color = max(color[k] for color in colors)
        light = sum(light.color[k] for light in scene.lights)
        ambient = scene.tracing.ambient[k] * material.ambient * color
        most = max(most, ambient + light * (material.diffuse * color + material.specular))
    return most
