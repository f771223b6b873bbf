"""The options of `raytree export`. The window makes its figures from the same options."""

from dataclasses import dataclass

from tracer.choices import MODELS
from viewer.base.options import argument, option, switch
from viewer.base.theme import THEMES
from viewer.base.values import (
    DEPTHS,
    ORBIT,
    PIXEL,
    PIXELS,
    POINTS,
    RAY,
    RAY_NAME,
    SCENE_HELP,
    SHARE,
    SIZE,
    TEXT,
    WEIGHT,
    one_of,
    some_of,
)
from viewer.figures.catalogue import FIGURE_NAMES, FORMATS, STEPS

TEXT_SIZE = 18.0  # points: readable in the last row if the figure fills a slide
EYES = ("top", "left")  # of a tree


@dataclass(frozen=True, kw_only=True)
class ExportOptions:
    """`raytree export`."""

    scene: str = argument("SCENE", TEXT, SCENE_HELP)
    pixel: tuple[int, int] | None = option(PIXEL, "from the image's top left; a lesson's own by default", group="where")
    ray: tuple[float, ...] | None = option(RAY, "origin and direction of a ray", group="where")
    figure: str = option(one_of(FIGURE_NAMES), "tree by default", "tree")
    view: tuple[float, ...] | None = option(
        ORBIT, "scene: degrees from its camera's side and above, distance in its radii, what is looked at"
    )
    node: str | None = option(RAY_NAME, "hit: of this ray; the first by default")
    depth: range | None = option(DEPTHS, "recursion depth, or a page a depth: 0..3")
    step: str = option(
        one_of(STEPS), "a page a depth; a ray, as they are traced; or a hit, as colour flows back", STEPS[0]
    )
    model: str | None = option(one_of(MODELS), "the scene's own by default")
    min_weight: float = option(WEIGHT, "do not follow rays that weigh less", 0.0)
    size: tuple[int, int] | None = option(SIZE, "of the image, the scene's own by default")
    format: tuple[str, ...] = option(some_of(tuple(FORMATS)), f"of {', '.join(FORMATS)}; svg by default", ())
    theme: str = option(one_of(tuple(THEMES)), "light by default", "light")
    swatches: bool = switch("the colour that each ray sends up, in its box")
    fold: float = option(SHARE, "fold branches that weigh less into one box", 0.0)
    text_size: float = option(POINTS, f"points on a slide; {TEXT_SIZE:g} by default", TEXT_SIZE)
    eye: str | None = option(one_of(EYES), f"tree: where it begins; on {EYES[0]} by default")
    no_lights: bool = switch("leave out the rays to the lights")
    ground: bool = switch("on the theme's ground; transparent by default")
    width: int | None = option(PIXELS, "PNG: pixels across; 1920 by default")
    output: str = option(
        TEXT, "names in a folder: SCENE_X_Y_FIGURE_dD.EXT", metavar="FILE|FOLDER/", short="-o", required=True
    )
