"""A chapter of the report: one scene with a section for each source of error. Measures it, and draws its plots."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tracer.kernel.world import World
from tracer.measure.precision.precision import Source, counted
from tracer.measure.precision.sources import FULL, QUICK, left_out, sources
from tracer.measure.precision.stiff import PROBLEMS, solved, steps
from viewer.base.files import write_atomically
from viewer.report.plots import FORMATS, plot

ACROSS, QUICK_ACROSS = 240, 100  # pixels, of an image whose size was not chosen
PLOTS = (("seconds", "rmse"), ("rays", "rmse"), ("tests", "rmse"), ("seconds", "largest"), ("seconds", "flip"))
EXACT_PLOTS = (("seconds", "largest"), ("rays", "largest"), ("tests", "largest"))  # all pixels are one ray

Progress = Callable[[float], None]


@dataclass
class Chapter:
    name: str  # in file names
    title: str
    sources: Sequence[Source]
    left_out: Sequence[str] = ()
    plots: dict[str, list[bytes]] = field(default_factory=dict)  # SVG, by a source's name

    @property
    def anchor(self) -> str:
        """The name as an HTML id: a file's name may have spaces and quotes."""
        return re.sub(r"[^\w-]", "-", self.name)


def scene_chapter(world: World, name: str, size: tuple[int, int] | None, quick: bool, progress: Progress) -> Chapter:
    """Measure every source of error of a scene. `size` is that of its images; None: small ones."""
    effort = QUICK if quick else FULL
    own = size or small_size(world, QUICK_ACROSS if quick else ACROSS)
    found = sources(world, own, effort, progress, smaller=size is None)
    return Chapter(name, world.scene.title or name, found, left_out(world.scene, effort))


def stiff_chapter(progress: Progress) -> Chapter:
    """Measure the stiff trees whose exact answers are known."""
    step = counted(sum(map(steps, PROBLEMS)), progress)
    return Chapter("stiff", "Stiff trees, with exact answers", [solved(problem, step) for problem in PROBLEMS])


def small_size(world: World, across: int) -> tuple[int, int]:
    """A size with the proportions of the scene's image, at most `across` pixels wide."""
    image = world.scene.image
    share = min(1.0, across / image.width)
    return max(1, round(share * image.width)), max(1, round(share * image.height))


def draw(chapter: Chapter, folder: Path, named: bool) -> list[Path]:
    """Write the chapter's plots, and keep them for the page. Returns the files, with the chapter's name if `named`."""
    written: list[Path] = []
    for source in chapter.sources:
        for work, measure in EXACT_PLOTS if source.exact else PLOTS:
            made = plot(source, work, measure)
            chapter.plots.setdefault(source.name, []).append(made["svg"])
            for kind in FORMATS:
                name = f"{source.name}-{measure}-{work}.{kind}"
                written.append(folder / (f"{chapter.name}-{name}" if named else name))
                write_atomically(written[-1], made[kind])
    return written
