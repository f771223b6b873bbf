"""Whose images are compared: the scenes made here, and a folder's NAME.nff with NAME.pov beside it or in `pov`.

A folder's POV-Ray source is taken for its language of version 3.1, with its defaults: five levels with the camera's,
and rays that weigh less than 1/255 are not followed. Our own source for the made scenes says the same.
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
    file: Path | None = None  # of a folder's scene; None: made here

    def race(self) -> Race:
        """As both programs do by default."""
        if self.file:
            return Race(tracer.load(self.file), self.pov_source(), SIZE, DEPTH, LEAST, ("+MV3.1",))
        scene = self.made()
        return Race(scene, povray.write_scene(scene, DEPTH, SIZE, LEAST), SIZE, DEPTH, LEAST)

    def count(self) -> Race:
        """With nothing cut. POV-Ray also counts the rays that are too deep to be traced: it gets one level less."""
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
