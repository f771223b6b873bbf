"""What a report is made of: a chapter a scene, in it a section a source of error."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from tracer.measure.precision.precision import Source


@dataclass
class Chapter:
    name: str  # for files
    title: str
    sources: Sequence[Source]
    left_out: Sequence[str] = ()
    plots: dict[str, list[bytes]] = field(default_factory=dict)  # SVG, by a source's name

    @property
    def anchor(self) -> str:
        """Its name as a page and the drawings in it can refer to it: a file's may have spaces and quotes."""
        return re.sub(r"[^\w-]", "-", self.name)
