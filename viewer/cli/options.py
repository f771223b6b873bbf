"""The options of each command. Those of `export`, which the window uses too: `viewer.figures.export_options`."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from tracer.choices import MODELS, SAMPLERS
from tracer.formats import UP_AXES
from viewer.base.options import argument, option, switch
from viewer.base.pictures import WRITERS
from viewer.base.values import (
    AT_HELP,
    DEPTH_HELP,
    FIGURE_TOO,
    FILE,
    LANGUAGE,
    LANGUAGE_HELP,
    LIGHT,
    MAX_RAYS_HELP,
    MODEL_HELP,
    MOMENT,
    PIXEL,
    PIXEL_HELP,
    POSITIVE,
    RAY,
    RAY_HELP,
    SAMPLE_HELP,
    SCENE_HELP,
    SHARE,
    SIZE,
    SWEPT_HELP,
    TEXT,
    UP_HELP,
    WEIGHT,
    one_of,
    whole,
)
from viewer.figures.catalogue import DATA
from viewer.reopen.view_state import ViewState

HEAVIEST = 300  # rays that `trace` prints as text
OUTPUT = "FILE|FOLDER/"


def _depth() -> Any:
    return option(whole(0, metavar="D"), DEPTH_HELP)


def _model() -> Any:
    return option(one_of(MODELS), MODEL_HELP)


def _min_weight() -> Any:
    return option(WEIGHT, "do not follow rays of a smaller weight", 0.0)


def _tolerance() -> Any:
    return option(
        WEIGHT, "trace best-first, to any depth, until the weights of the other rays sum up to at most T",
        metavar="T", group="cut",
    )  # fmt: skip


def _missing() -> Any:
    return option(
        LIGHT, "trace best-first, to any depth, until the other rays can add no more light than E to any channel",
        group="cut",
    )  # fmt: skip


def _max_rays() -> Any:
    return option(whole(1), MAX_RAYS_HELP)


def _size(of: str = "of the image, the scene's own by default") -> Any:
    return option(SIZE, of)


def _up() -> Any:
    return option(one_of(UP_AXES), UP_HELP, UP_AXES[0])


@dataclass(frozen=True, kw_only=True)
class ViewOptions(ViewState):
    """`raytree view`. The fields of ViewState bring a view back."""

    scene: str | None = argument("SCENE", TEXT, FIGURE_TOO, nargs="?")
    screenshot: Path | None = option(FILE, "draw the viewer into a file, and exit", metavar="FILE.png")
    size: tuple[int, int] | None = _size("of the window or the screenshot")
    language: str | None = option(LANGUAGE, LANGUAGE_HELP)
    speaker: bool = switch("open a second window for the speaker: notes, next step, clock")

    @property
    def state(self) -> ViewState:
        """The state of the view that the options ask for."""
        return ViewState(**{item.name: getattr(self, item.name) for item in fields(ViewState)})


@dataclass(frozen=True, kw_only=True)
class TraceOptions:
    """`raytree trace`."""

    scene: str = argument("SCENE", TEXT, FIGURE_TOO)
    at: tuple[int, int] | None = option(MOMENT, AT_HELP)
    swept: float | None = option(SHARE, SWEPT_HELP)
    pixel: tuple[int, int] | None = option(PIXEL, PIXEL_HELP, group="where")
    ray: tuple[float, ...] | None = option(RAY, RAY_HELP, group="where")
    sample: int | None = option(whole(0, metavar="K"), SAMPLE_HELP)
    depth: int | None = _depth()
    model: str | None = _model()
    min_weight: float = _min_weight()
    tolerance: float | None = _tolerance()
    missing: float | None = _missing()
    max_rays: int | None = _max_rays()
    size: tuple[int, int] | None = _size()
    up: str = _up()
    verify: bool = switch("guaranteed ends of each number and of the colour; needs the extra raytree[verify]")
    format: str = option(one_of(DATA), "text by default", "text")
    rays: int = option(whole(0), f"text: show the N rays of largest weight, {HEAVIEST} by default; 0: all", HEAVIEST)
    output: Path | None = option(FILE, "write there instead of the terminal", short="-o")


@dataclass(frozen=True, kw_only=True)
class RenderOptions:
    """`raytree render`."""

    scenes: tuple[str, ...] = argument("SCENE", TEXT, SCENE_HELP, nargs="+")
    output: str = option(
        TEXT, ".png, .npy or .exr; a folder for several scenes", metavar=OUTPUT, short="-o", required=True
    )
    format: str | None = option(one_of(tuple(WRITERS)), "of the files in a folder, png by default")
    depth: int | None = _depth()
    model: str | None = _model()
    min_weight: float = _min_weight()
    tolerance: float | None = _tolerance()
    missing: float | None = _missing()
    max_rays: int | None = _max_rays()
    size: tuple[int, int] | None = _size()
    up: str = _up()
    samples: int | None = option(
        whole(1), "samples per pixel, the scene's own by default; their maximum with --until-error or --until-seconds"
    )
    sampler: str = option(
        one_of(SAMPLERS), "placement of the samples; jittered needs a square number of samples", SAMPLERS[0]
    )
    until_error: float | None = option(POSITIVE, "adaptive sampling, until the estimated error (RMSE) is at most E")
    until_seconds: float | None = option(POSITIVE, "adaptive sampling for S seconds", metavar="S")
    bounds: bool = switch(
        "write guaranteed bounds of each pixel, as .npy or .exr, instead of the picture; slow; needs raytree[verify]"
    )
    threads: int | None = option(whole(1), "the number of processors by default", group="machine")
    dask: str | None = option(
        TEXT, "trace on the Dask cluster of this scheduler", metavar="tcp://HOST:PORT", group="machine"
    )
    stats: Path | None = option(FILE, "write times, ray counts and what was left out", metavar="FILE.json")


def limits_of(options: TraceOptions | RenderOptions) -> dict[str, Any]:
    """The arguments of `tracer.trace` and `tracer.render` that say which rays are followed, and their weights."""
    names = ("depth", "size", "min_weight", "tolerance", "missing", "max_rays", "model")
    return {name: getattr(options, name) for name in names}


@dataclass(frozen=True, kw_only=True)
class ReportOptions:
    """`raytree report`."""

    scene: str | None = argument("SCENE", TEXT, SCENE_HELP, nargs="?")
    all: bool = switch("every lesson, and stiff trees with exact answers")
    size: tuple[int, int] | None = _size("of its images; about 240 pixels across by default")
    quick: bool = switch("fewer settings on smaller images: under a minute")
    output: str = option(TEXT, "for the page, its plots and its data", metavar="FOLDER", short="-o", required=True)


@dataclass(frozen=True, kw_only=True)
class PlanOptions:
    """`raytree plan`."""

    scene: str = argument("SCENE", TEXT, SCENE_HELP)
    up: str = _up()
    measure: bool = switch("measure rays and time with and without each capability; about 10 seconds")
    json: bool = switch("print JSON")


@dataclass(frozen=True, kw_only=True)
class CheckOptions:
    """`raytree check`."""

    cases: tuple[str, ...] = argument("CASE", TEXT, "names like A1, or groups like A; all by default", nargs="*")
    explain: bool = switch(
        "explain the error of the textbook's formula, and show every setting and how errors are distributed"
    )
    json: bool = switch("print JSON")


@dataclass(frozen=True, kw_only=True)
class LessonsOptions:
    """`raytree lessons`."""

    check: str | None = option(TEXT, "say everything that is wrong with a lesson", metavar="FOLDER", group="what")
    new: str | None = option(TEXT, "write a new lesson to begin with", metavar="FOLDER", group="what")
    language: str | None = option(
        LANGUAGE, "titles in this language, by default in that of the system; of the check: this translation only"
    )
