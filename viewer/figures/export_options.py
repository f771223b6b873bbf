"""The options of `raytree export`. The window makes its figures from the same options."""

from dataclasses import dataclass

from tracer.choices import MODELS
from tracer.formats import UP_AXES
from viewer.base.options import argument, option, switch
from viewer.base.theme import THEMES
from viewer.base.values import (
    AT_HELP,
    DEPTHS,
    FIGURE_TOO,
    INCIDENCE,
    LANGUAGE,
    LANGUAGE_HELP,
    MAX_RAYS_HELP,
    MOMENT,
    ORBIT,
    PAPER,
    PIXEL,
    PIXEL_HELP,
    PIXELS,
    POINTS,
    RAY,
    RAY_HELP,
    RAY_NAME,
    RAY_PATH,
    SAMPLE_HELP,
    SHARE,
    SIZE,
    SWEPT_HELP,
    TEXT,
    UP_HELP,
    WEIGHT,
    Unreadable,
    none_or_some_of,
    one_of,
    some_of,
    whole,
)
from viewer.figures.catalogue import FIGURE_NAMES, FORMATS, ORDERS, STEPS
from viewer.reopen.view_state import GRANULARITIES, KINDS, VIEW_WORDS, ViewState, merged

SLIDE = (960, 540)  # points: 16 to 9
TEXT_SIZE = 18.0  # points: readable in the last row if the figure fills a slide
EYES = ("top", "left")  # of a tree


@dataclass(frozen=True, kw_only=True)
class ExportOptions:
    """`raytree export`."""

    scene: str = argument("SCENE", TEXT, FIGURE_TOO)
    lesson: bool = switch("all steps of a lesson: a page for a browser, slides, a PDF, and figures")
    language: str | None = option(LANGUAGE, f"with --lesson: {LANGUAGE_HELP}")
    at: tuple[int, int] | None = option(MOMENT, AT_HELP)
    swept: float | None = option(SHARE, SWEPT_HELP)
    pixel: tuple[int, int] | None = option(PIXEL, PIXEL_HELP, group="where")
    ray: tuple[float, ...] | None = option(RAY, RAY_HELP, group="where")
    sample: int | None = option(whole(0, metavar="K"), SAMPLE_HELP)
    figure: str = option(one_of(FIGURE_NAMES), "tree by default", "tree")
    view: tuple[float, ...] | None = option(
        ORBIT, "scene: azimuth and elevation in degrees, distance in radii of the scene, target"
    )
    node: str | None = option(
        RAY_NAME, "hit: the hit at the end of this ray, by its path (TR) or label (R3); E by default"
    )
    turn: float | None = option(INCIDENCE, "hit: as it would be at this angle of incidence, in its plane")
    depth: range | None = option(DEPTHS, "recursion depth, or one page per depth: 0..3")
    step: str = option(
        one_of(STEPS),
        "one page per depth; or per level or per ray, and then per hit as the colour is summed up; or only the latter",
        STEPS[0],
    )
    order: str = option(
        one_of(ORDERS),
        "rays, colour: breadth-first as the kernel does it, or depth-first as a recursion does",
        ORDERS[0],
    )
    page: int | None = option(whole(0), "of the steps, only this page, from 0")
    model: str | None = option(one_of(MODELS), "the scene's own by default")
    min_weight: float = option(WEIGHT, "do not follow rays of a smaller weight", 0.0)
    max_rays: int | None = option(whole(1), MAX_RAYS_HELP)
    size: tuple[int, int] | None = option(SIZE, "of the image, the scene's own by default")
    up: str = option(one_of(UP_AXES), UP_HELP, UP_AXES[0])
    format: tuple[str, ...] = option(some_of(tuple(FORMATS)), f"of {', '.join(FORMATS)}; svg by default", ())
    theme: str = option(one_of(tuple(THEMES)), "light by default", "light")
    paper: tuple[int, int] = option(PAPER, "width and height of the page in points, a slide by default", SLIDE)
    swatches: bool = switch("show the radiance of each ray in its box")
    levels: bool = switch("tree: lines with the depths")
    select: str | None = option(RAY_PATH, "emphasise this ray; what is neither above nor below it is dimmed")
    fold: float = option(SHARE, "fold branches of a smaller weight into one box", 0.0)
    text_size: float = option(POINTS, f"points on a slide; {TEXT_SIZE:g} by default", TEXT_SIZE)
    eye: str | None = option(one_of(EYES), f"tree: the side of the eye; {EYES[0]} by default")
    filter: tuple[str, ...] | None = option(
        none_or_some_of(KINDS, "KINDS"), f"draw these kinds of rays only, and none below others: {','.join(KINDS)}"
    )
    no_lights: bool = switch("leave out the rays to the lights")
    ground: bool = switch("on the theme's background; transparent by default")
    width: int | None = option(PIXELS, "PNG: pixels across; 1920 by default")
    reopen: ViewState | None = option(
        VIEW_WORDS, "options of raytree view that the figure opens with, besides its own: '--theme dark --hide normals'"
    )
    output: str = option(
        TEXT, "names in a folder: SCENE_X_Y_FIGURE_dD.EXT", metavar="FILE|FOLDER/", short="-o", required=True
    )

    def state(self, size: tuple[int, int]) -> ViewState:
        """The state of a view that shows what the figure shows. `size` is that of the scene's image: a pixel of an
        image of another size is none of the window's, and a ray given by hand is not either.
        """
        own = ViewState(
            at=self.at,
            swept=self.swept,
            pixel=self.pixel if self.size in (None, size) else None,
            sample=self.sample,
            depth=self.depth[-1] if self.depth else None,
            model=self.model,
            up=self.up,
            select=self._selected(),
            step=self.step if self.step == GRANULARITIES[1] else None,
            order=self.order if self.order != ORDERS[0] else None,
            page=self.page if self.step in GRANULARITIES else None,
            turn=self.turn,
            camera=self.view,
            filter=tuple(k for k in KINDS if k != "shadow") if self.no_lights else self.filter,
        )
        return merged(own, self.reopen) if self.reopen else own

    def _selected(self) -> str | None:
        """The path of the ray that is emphasised, or that a figure of a hit is about, if it was given as a path."""
        if self.select:
            return self.select
        try:
            return RAY_PATH.read(self.node.upper()) if self.node else None
        except Unreadable:
            return None
