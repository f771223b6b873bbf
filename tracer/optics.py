"""The lecture's optics as a public module: see `tracer.formulas.optics`, where the code lives."""

from tracer.formulas.optics import (
    angle,
    cosine,
    critical_angle,
    fresnel,
    fresnel_shares,
    mirrored,
    radicand,
    reflect,
    refract,
    sine,
    transmission,
)

__all__ = [
    "angle",
    "cosine",
    "critical_angle",
    "fresnel",
    "fresnel_shares",
    "mirrored",
    "radicand",
    "reflect",
    "refract",
    "sine",
    "transmission",
]
