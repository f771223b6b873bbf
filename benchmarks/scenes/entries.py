"""The scenes that are compared with POV-Ray: those generated here, and a folder's NAME.nff with NAME.pov beside it or
in `pov`.

A folder's POV-Ray source is read as version 3.1 with its defaults: five levels including the camera's, and rays of
weight below 1/255 are not followed. Our own source for the generated scenes says the same.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import tracer
from benchmarks.race import Race
from benchmarks.scenes import SCENES
from tests import povray
from tracer.scene import Scene

SIZE = (512, 512)
DEPTH = 4
LEAST = 1.0 / 255.0
EVERY_RAY = f"global_settings {{ max_trace_level {DEPTH} adc_bailout 0 }}\n"


@dataclass(frozen=True)
class Entry:
    name: str
    file: Path | None = None  # a scene of the folder; None: generated

    def race(self) -> Race:
        """A race with the defaults of both programs."""
        if self.file:
            return Race(tracer.load(self.file), self.pov_source(), SIZE, DEPTH, LEAST, ("+MV3.1",))
        scene = self.made()
        return Race(scene, povray.write_scene(scene, DEPTH, SIZE, LEAST), SIZE, DEPTH, LEAST)

    def count(self) -> Race:
        """A race without any cut. POV-Ray also counts the rays that are too deep to be traced, so it gets one level
        less.
        """
        if self.file:
            return Race(tracer.load(self.file), EVERY_RAY + self.pov_source(), SIZE, DEPTH, 0.0, ("+MV3.1",))
        scene = self.made()
        return Race(scene, povray.write_scene(scene, DEPTH - 1, SIZE), SIZE, DEPTH)

    def made(self) -> Scene:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"{self.name}.nff"
            file.write_text(SCENES[self.name]())
            return tracer.load(file)

    def pov_source(self) -> str:
        assert self.file
        for source in (self.file.with_suffix(".pov"), self.file.parent / "pov" / f"{self.file.stem}.pov"):
            if source.exists():
                return source.read_text()
        raise FileNotFoundError(f"{self.file}: no {self.file.stem}.pov beside it or in pov/")


def entries(folder: Path | None) -> Iterator[Entry]:
    for name in SCENES:
        yield Entry(name)
    if folder:
        for file in sorted(folder.glob("*.nff")):
            yield Entry(file.stem, file)
