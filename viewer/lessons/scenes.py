"""The scenes of a lesson's steps: each is prepared once for its file and its changes. Faults have the step's line."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import tracer
from tracer.formats.source import Fault
from tracer.kernel.world import World
from viewer.lessons.step import Step


class SceneFaults(Exception):
    """The faults of a step's scene, with lines of lesson.md."""

    def __init__(self, faults: Sequence[Fault]) -> None:
        super().__init__("; ".join(map(str, faults)))
        self.faults = faults


class StepScenes:
    """The scenes that were prepared so far, and the faults of those that could not be."""

    def __init__(self) -> None:
        self._known: list[tuple[tuple[Path, Mapping[str, Any]], World | tracer.SceneError]] = []

    def world(self, step: Step, share: float = 0.0) -> World:
        """The step's scene at this share of its sweep, 0 to 1. Raises SceneFaults."""
        changes = step.state.swept(share).set
        found = self._prepared(step.scene, changes)
        if isinstance(found, World):
            return found
        keys = [*["sweep"] * bool(step.state.sweep), *["set"] * bool(changes), "scene"]
        raise SceneFaults([Fault(fault, step.line_of(*keys)) for fault in found.faults])

    def _prepared(self, path: Path, changes: Mapping[str, Any]) -> World | tracer.SceneError:
        key = (path, changes)
        for known, found in self._known:
            if known == key:
                return found
        try:
            made: World | tracer.SceneError = tracer.prepare(tracer.load(path, changes=changes or None))
        except tracer.SceneError as error:
            made = error
        self._known.append((key, made))
        return made
