"""A chapter of the report: one scene with a section for each source of error. Measures it, and draws its plots."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tracer.kernel.world import World
from tracer.measure.precision.experiment import Experiment
from tracer.measure.precision.precision import Source
from tracer.measure.precision.sources import FULL, QUICK, left_out, studies
from tracer.measure.precision.stiff import PROBLEMS, study_of
from tracer.measure.work import Size
from tracer.progress import Progress, divided
from viewer.base.files import write_atomically
from viewer.report.plots import FORMATS, plot

ACROSS, QUICK_ACROSS = 240, 100  # pixels, of an image whose size was not chosen
PLOTS = (("seconds", "rmse"), ("rays", "rmse"), ("tests", "rmse"), ("seconds", "largest"), ("seconds", "flip"))
EXACT_PLOTS = (("seconds", "largest"), ("rays", "largest"), ("tests", "largest"))  # all pixels are one ray

DRAWING = 0.4  # seconds that a plot takes, in all formats


@dataclass
class Chapter:
    """A chapter whose settings have all run once. `measure` fills in the sources, and `draw` the plots."""

    name: str  # in file names
    title: str
    experiments: Sequence[Experiment]
    left_out: Sequence[str] = ()
    sources: Sequence[Source] = ()
    plots: dict[str, list[bytes]] = field(default_factory=dict)  # SVG, by a source's name

    @property
    def anchor(self) -> str:
        """The name as an HTML id: a file's name may have spaces and quotes."""
        return re.sub(r"[^\w-]", "-", self.name)

    @property
    def seconds(self) -> float:
        """The expected time of `measure`."""
        return sum(experiment.seconds for experiment in self.experiments)

    @property
    def drawing(self) -> float:
        """The expected time of `draw`."""
        return DRAWING * sum(len(plots_of(one.study.exact)) for one in self.experiments)

    def measure(self, progress: Progress) -> None:
        parts = divided(progress, [one.seconds for one in self.experiments])
        self.sources = [one.measure(part) for one, part in zip(self.experiments, parts, strict=True)]

    def draw(self, folder: Path, named: bool, progress: Progress) -> int:
        """Write the plots, and keep them for the page. File names have the chapter's name if `named`. Returns how many
        files were written.
        """
        made = [(source, *axes) for source in self.sources for axes in plots_of(source.exact)]
        for (source, work, measure), part in zip(made, divided(progress, [1.0] * len(made)), strict=True):
            drawn = plot(source, work, measure)
            self.plots.setdefault(source.name, []).append(drawn["svg"])
            for kind in FORMATS:
                name = f"{source.name}-{measure}-{work}.{kind}"
                write_atomically(folder / (f"{self.name}-{name}" if named else name), drawn[kind])
            part(1.0)
        return len(made) * len(FORMATS)


def scene_chapter(world: World, name: str, size: Size | None, quick: bool) -> Chapter:
    """The chapter of a scene. `size` is that of its images; None: small ones."""
    effort = QUICK if quick else FULL
    own = size or small_size(world, QUICK_ACROSS if quick else ACROSS)
    found = [Experiment(study) for study in studies(world, own, effort, size is None)]
    return Chapter(name, world.scene.title or name, found, left_out(world.scene, effort))


def stiff_chapter() -> Chapter:
    """The chapter of the stiff trees whose exact answers are known."""
    return Chapter("stiff", "Stiff trees, with exact answers", [Experiment(study_of(one)) for one in PROBLEMS])


def plots_of(exact: bool) -> Sequence[tuple[str, str]]:
    """(work, measure) of each plot of a source."""
    return EXACT_PLOTS if exact else PLOTS


def small_size(world: World, across: int) -> Size:
    """A size with the proportions of the scene's image, at most `across` pixels wide."""
    image = world.scene.image
    share = min(1.0, across / image.width)
    return max(1, round(share * image.width)), max(1, round(share * image.height))
