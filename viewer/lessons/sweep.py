"""A sweep: a step of a lesson in which a number goes from one value to another.

The number is the picked place in the image, or one of the scene. A place between two pixels is an image point: its ray
is the camera's ray through that point.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tracer import fields

PIXEL = "pixel"  # what a sweep may change, beside the numbers of a scene
STOPS = 24  # the scene is prepared at this many equal distances; a place in the image moves continuously
SAID = "a table { of = 'pixel', from = [x, y], to = [x, y] } or { of = 'material.water.ior', from = 1, to = 1.5 }"
NAMED = ("object", "material", "light")  # their parts have names
KEYS = ("of", "from", "to", "expect")


@dataclass(frozen=True)
class Sweep:
    """A number, or several of a list, that go from one value to another."""

    of: str  # "pixel", or a key of the scene such as `material."water".ior`
    start: tuple[float, ...]
    end: tuple[float, ...]
    expect: Mapping[str, Any] = field(default_factory=dict)  # what must hold at its end

    @property
    def is_pixel(self) -> bool:
        return self.of == PIXEL

    def at(self, share: float) -> tuple[float, ...]:
        """The value at this share of the way, 0 to 1. Exact at both ends."""
        if share >= 1.0:
            return self.end
        return tuple(a + share * (b - a) for a, b in zip(self.start, self.end, strict=True))

    def stop(self, share: float) -> float:
        """The nearest share at which the sweep can stand."""
        return share if self.is_pixel else round(share * STOPS) / STOPS

    def pixel(self, share: float) -> tuple[int, int]:
        """The pixel nearest to the place in the image; halfway, the later one."""
        x, y = self.at(share)
        return (int(x + 0.5), int(y + 0.5))

    def between(self, share: float) -> tuple[float, float] | None:
        """The place in the image, in pixels from the centre of pixel (0, 0), if it is no pixel's centre."""
        if not self.is_pixel:
            return None
        x, y = self.at(share)
        return None if (x, y) == self.pixel(share) else (x, y)

    def changes(self, share: float) -> Mapping[str, Any]:
        """The change to the scene's document: `{"material": {"water": {"ior": 1.2}}}`."""
        if self.is_pixel:
            return {}
        values = list(self.at(share))
        written = repr(values if len(values) > 1 else values[0])
        return tomllib.loads(f"{self.of} = {written}")

    def words(self, share: float) -> str:
        """The value at this share of the way, for the reader."""
        values = self.at(share)
        if self.is_pixel:
            place = ", ".join(f"{value:.1f}".removesuffix(".0") for value in values)
            return f"pixel {place}" + (", between pixels" if self.between(share) else "")
        written = ", ".join(f"{value:.4g}" for value in values)
        section, *names, key = self.of.replace('"', "").split(".")
        name = f"{key} of {'.'.join(names)}" if names and section in NAMED else f"{section}.{'.'.join([*names, key])}"
        return f"{name} = [{written}]" if len(values) > 1 else f"{name} = {written}"


def read_sweep(value: Any) -> Sweep:
    """The sweep of a table in a block `step`. Raises Refused."""
    if not isinstance(value, dict) or not {"of", "from", "to"} <= set(value) <= set(KEYS):
        raise fields.Refused(SAID)
    of, expect = value["of"], value.get("expect", {})
    if not isinstance(of, str) or not isinstance(expect, dict):
        raise fields.Refused(SAID)
    start, end = (tuple(item) if isinstance(item, list) else (item,) for item in (value["from"], value["to"]))
    numbers = (int,) if of == PIXEL else (int, float)
    count = 2 if of == PIXEL else max(1, len(start))
    if not all(len(side) == count and all(type(n) in numbers for n in side) for side in (start, end)):
        raise fields.Refused(SAID)
    sweep = Sweep(of, tuple(map(float, start)), tuple(map(float, end)), expect)
    try:
        sweep.changes(0.0)
    except tomllib.TOMLDecodeError:
        raise fields.Refused('a table whose `of` is "pixel" or a key like material.water.ior') from None
    return sweep


def with_changes(changes: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Changes to a scene's document, and more of them, which go before."""
    found = dict(changes)
    for key, value in more.items():
        before = found.get(key)
        if isinstance(before, Mapping) and isinstance(value, Mapping):
            value = with_changes(before, value)
        found[key] = value
    return found
