"""An upper bound on the radiance of any ray of a scene, and on the light that a tree lacks.

Let L be the largest local term of a material, and s the largest sum of the factors of the rays that it sends out. Then
no ray is brighter than B, the largest of the background and of L / (1 - s) over all materials: a surface that gets at
most B returns L + s B <= B. So a tree lacks at most the sum of the weights that were cut, times B.

B is infinite only if one material has s >= 1 and L > 0, or s > 1 while anything shines. (Hall & Greenberg, IEEE CG&A
3(8), 1983, cut rays by weight. The weight of one ray is no bound, the sum is.)
"""

import math
from typing import NamedTuple

from tracer.formulas.vector import Vector
from tracer.printable import printable
from tracer.scene.scene import Material, Scene

MARGIN = 2.0**-48  # relative: of the rounding errors between a sum of weights and the light that it can bring


class MissingBoundError(ValueError):
    """A limit on the missing light was asked for, of a scene whose rays have no bound on their light."""


class RadianceBound(NamedTuple):
    """B for each channel, linear RGB; inf where there is no bound."""

    rgb: Vector
    reason: str  # the material because of which a channel has no bound, as it is shown; empty if all have one

    @property
    def largest(self) -> float:
        return max(self.rgb)

    def missing(self, residual: float) -> Vector:
        """The most light that rays of this weight can bring."""
        r, g, b = (residual * most if residual > 0.0 else 0.0 for most in self.rgb)
        return (r, g, b)

    def weight(self, missing: float) -> float:
        """A weight of cut rays that cannot bring more light than `missing`, in any channel; inf in a scene without
        light. MissingBoundError if there is no bound.
        """
        if math.isinf(self.largest):
            adds_up = "it passes on all the light that it gets, or more, so light can add up without limit"
            raise MissingBoundError(
                f'missing needs a bound on the light of a ray, and the material "{self.reason}" has none: {adds_up}'
            )
        return missing / self.largest * (1.0 - MARGIN) if self.largest > 0.0 else math.inf


def radiance_bound(scene: Scene) -> RadianceBound:
    """B of a scene."""
    names = {item.material: item.material.name or item.name or item.shape.name for item in reversed(scene.objects)}
    most, reason = list(scene.background.color), ""
    local = {material: local_bound(scene, material) for material in names}
    for k in range(3):
        shines = most[k] > 0.0 or any(own[k] > 0.0 for own in local.values())
        for material, name in names.items():
            passed_on = material.reflect + material.transmit
            if passed_on < 1.0:
                most[k] = max(most[k], local[material][k] / (1.0 - passed_on))
            elif local[material][k] > 0.0 or (passed_on > 1.0 and shines):
                most[k], reason = math.inf, reason or name
    return RadianceBound((most[0], most[1], most[2]), printable(reason))


def local_bound(scene: Scene, material: Material) -> Vector:
    """The largest local term of a material: facing every light, and with every highlight at its maximum."""
    colors = [material.color] + ([material.checker.color] if material.checker else [])
    terms = []
    for k in range(3):
        color = max(color[k] for color in colors)
        light = sum(light.color[k] for light in scene.lights)
        ambient = scene.tracing.ambient[k] * material.ambient * color
        terms.append(ambient + light * (material.diffuse * color + material.specular))
    return (terms[0], terms[1], terms[2])
