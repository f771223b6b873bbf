"""Conditions of a goal that no pixel of the scene can meet, as far as it can be said without looking at all of them."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tracer import fields
from tracer.choices import FRESNEL, MODELS
from tracer.kernel.nodes import ENDS
from tracer.scene import Scene
from tracer.tree.names import LETTERS, light_names
from viewer.base.values import RAY_PATH, Unreadable
from viewer.lessons.expectation import SENT_ON, entries, half_unit, key_of, name_fault, number_of, number_words
from viewer.lessons.values import QUANTITIES

EYE, REFLECTED, TO_LIGHT = (LETTERS[kind] for kind in ("camera", "reflection", "shadow"))
ENDS_AT_LIGHT = ("lit", "filtered", "blocked")


class Possible:
    """The rays and the values that pixels of a scene can have, at a depth and with a model."""

    def __init__(self, scene: Scene, depth: int, model: str) -> None:
        self.scene, self.depth = scene, depth
        materials = [item.material for item in scene.objects]
        transmits = any(material.transmit > 0.0 for material in materials)
        reflects = any(material.reflect > 0.0 for material in materials) or (transmits and model == MODELS[FRESNEL])
        self.letters = "R" * reflects + "TI" * transmits  # that paths can have

    def faults(self, goal: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """(name, fault) of each condition that cannot be met."""
        for path, name, value in entries(goal):
            if fault := name_fault(name):
                yield name, fault
            elif fault := self._path_fault(path) or self._value_fault(path, name, value):
                yield name, f"{key_of(path, name)} {fault}"

    def _path_fault(self, path: str) -> str:
        """The reason why no ray has this path; empty if one can have it."""
        if not path:
            return ""
        try:
            RAY_PATH.read(path)
        except Unreadable as unreadable:
            return f"must begin with {unreadable}"
        way, light = _letters(path), path.partition(f".{TO_LIGHT}(")[2].partition(")")[0]
        if fault := self._kind_fault(way):
            return fault
        if len(way) > self.depth:
            return f"must be about a ray of depth {self.depth} at most, which is that of the step"
        known = light_names(self.scene)
        return f"must be about a light of the scene{_of(known, light)}" if light and light not in known else ""

    def _kind_fault(self, letters: Sequence[str]) -> str:
        """The reason why there are no rays of these letters."""
        for letter in letters:
            if letter not in self.letters:
                what = "reflects" if letter == REFLECTED else "transmits"
                return f"asks for a ray {letter}, and nothing in the scene {what}"
        return ""

    def _value_fault(self, path: str, name: str, value: Any) -> str:
        """The reason why no hit has this value; empty if one can have it."""
        match name:
            case "children":
                return self._children_fault(path, value)
            case "end":
                at_light = f".{TO_LIGHT}(" in path
                return _choice_fault(value, [end for end in ENDS if (end in ENDS_AT_LIGHT) == at_light])
            case "object":
                return _choice_fault(value, [self.scene.object_name(k) for k in range(len(self.scene.objects))])
        number, (low, high) = number_of(value), QUANTITIES[name].limits
        if number is None:
            return number_words(value)
        if number + half_unit(number) < low or number - half_unit(number) > high:
            return f"must be from {low:g} to {high:g}, got {value}"
        return ""

    def _children_fault(self, path: str, value: Any) -> str:
        if fault := _choice_fault(value, [list(kinds) for kinds in SENT_ON]):
            return fault
        if value and len(_letters(path)) >= self.depth:
            return f"must be [], since no ray goes on at depth {self.depth}, which is that of the step"
        return self._kind_fault(value)


def _letters(path: str) -> list[str]:
    """The letters of a path below the camera ray, without a light."""
    return [letter for letter in path.partition(".")[0] if letter.isalpha() and letter != EYE]


def _choice_fault(value: Any, allowed: list[Any]) -> str:
    if value in allowed:
        return ""
    names = ", ".join(dict.fromkeys(map(fields.shown, allowed)))
    meant = fields.nearest(value, filter(lambda one: isinstance(one, str), allowed)) if isinstance(value, str) else ""
    return f"must be one of {names}{meant}, got {fields.shown(value)}"


def _of(known: Sequence[str], name: str) -> str:
    """The names that there are, and which of them may be meant."""
    return f" ({', '.join(known) or 'it has none'}){fields.nearest(name, known)}, got {name}"
