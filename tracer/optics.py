"""The lecture's optics as a public module: see `tracer.formulas.optics`, where the code lives."""

from tracer.formulas.optics import (
    angle as angle,
    cosine as cosine,
    critical_angle as critical_angle,
    fresnel as fresnel,
    fresnel_shares as fresnel_shares,
    mirrored as mirrored,
    radicand as radicand,
    reflect as reflect,
    refract as refract,
    sine as sine,
    transmission as transmission,
)
