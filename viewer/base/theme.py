"""The colours, line widths and font sizes, with reasons.

There are four ray colours (reflected rays and total internal reflection share one), and the kinds of rays also
differ by dash and arrow. In both palettes, any two of these colours are at least 28 units of CIE76 apart, also as
seen with deutan, protan or tritan vision (simulated after Machado et al. 2009), and have a contrast of at least 4.7
to the background (WCAG asks for 3).
"""

from dataclasses import dataclass
from enum import Enum

from tracer.choices import SYMBOLS

Color = tuple[float, float, float, float]  # sRGB and opacity, each 0..1


def rgb(code: str, opacity: float = 1.0) -> Color:
    """'#0072B2' as a Color."""
    r, g, b = (int(code[k : k + 2], 16) / 255.0 for k in (1, 3, 5))
    return (r, g, b, opacity)


def rgb_bytes(color: Color) -> tuple[int, int, int]:
    """Red, green and blue, each 0..255."""
    r, g, b, _ = (round(255 * x) for x in color)
    return (r, g, b)


def faded(color: Color, opacity: float) -> Color:
    return (*color[:3], color[3] * opacity)


def blend(color: Color, share: float, paper: Color) -> Color:
    """The colour, of which only a share is left, on the colour of the paper; as opaque as before."""
    r, g, b = (share * x + (1.0 - share) * y for x, y in zip(color[:3], paper[:3], strict=True))
    return (r, g, b, color[3])


class Arrow(Enum):
    """The arrow on a ray, which shows its direction and kind."""

    NONE = 0
    FILLED = 1
    OPEN = 2  # a chevron
    DOUBLE = 3  # two chevrons


@dataclass(frozen=True)
class RayStyle:
    """The style of one kind of ray, in the window and in figures."""

    label: str  # in the legend
    letter: str  # at the ray
    dark: str  # colour on a dark background
    light: str  # colour on a light background
    width: float  # pixels
    dash: tuple[float, float]  # pixels on and off; (0, 0): solid
    arrow: Arrow


# The camera ray is thickest, so that the eye finds the start first. Shadow rays are dashed, since no light is followed
# along them. A blocked one has shorter dashes and ends in a cross. A ray that adds nothing is dotted, also in print.
STYLES = {
    "camera": RayStyle("camera ray", SYMBOLS["camera"], "#FFFFFF", "#000000", 3.0, (0, 0), Arrow.FILLED),
    "reflection": RayStyle("reflected", SYMBOLS["reflection"], "#56B4E9", "#0072B2", 2.4, (0, 0), Arrow.OPEN),
    "refraction": RayStyle("refracted", SYMBOLS["refraction"], "#E69F00", "#B35C00", 2.4, (0, 0), Arrow.FILLED),
    "tir": RayStyle("total internal reflection", SYMBOLS["tir"], "#56B4E9", "#0072B2", 2.4, (14, 3), Arrow.DOUBLE),
    "shadow": RayStyle("shadow ray", SYMBOLS["shadow"], "#B0B0B0", "#5A5A5A", 1.8, (9, 6), Arrow.NONE),
}
TO_LIGHT = Arrow.FILLED  # on the shadow rays that a view of the scene is about; others have none, as they can be many
BLOCKED_DASH = (4.0, 5.0)
FILTERED_DASH = (12.0, 4.0)
NOTHING_DASH = (1.6, 5.0)

HALO = 1.6  # pixels of background colour on either side of a ray, so that it is visible on any image
HIDDEN = 0.30  # opacity of what is behind or inside an opaque object
DIMMED = 0.55  # opacity of rays that are not on the path of the selected one
QUIET, QUIET_WIDTH = 0.55, 0.6  # opacity of shadow rays whose hit is not selected, and the share of their width
GLOW, GLOW_WIDTH = 0.55, 7.0  # opacity of what lies under the ray that is pointed at, and its additional width
ARROW = 11.0  # pixels
ARROW_AT = 0.58  # of the ray's length: at the end, an arrow would be hidden by the surface
ESCAPE = 0.9  # of the scene's radius: length of a ray that leaves the scene
NORMAL = 0.16  # of the scene's radius: length of a normal
NORMAL_WIDTH = 1.5
FRAME_WIDTH, FRAME_OPACITY = 1.2, 0.75  # the camera's frustum
EDGE_WIDTH, EDGE_OPACITY = 1.1, 0.55  # edges of cut glass: thinner than any ray
OUTLINE_OPACITY = 0.8  # outline of curved glass

# Colours of curves in a plot, in turn. Curves also differ by marker.
CURVES = (("#F2C14E", "#B0127B"), ("#56B4E9", "#0072B2"), ("#7FD6A2", "#11723F"), ("#FF8A80", "#B35C00"),
          ("#C7A6F0", "#5B3A9C"), ("#ECEFF3", "#14181D"), ("#B8C94A", "#7A6A00"), ("#5FD0C8", "#007A75"))  # fmt: skip

# The scale of `colormap`. Each stop is lighter than the one before, also in grey.
MAP = (rgb("#0B1026"), rgb("#2F2A7A"), rgb("#8C2F7F"), rgb("#DD5A4F"), rgb("#F7A93B"), rgb("#FCF3B8"))

FONT_SIZE = 17.0  # pixels at 1280x720, from ascender to descender: room for four panels
SMALL = 0.9  # of the font's size, for labels in figures
LABEL_TEXT = 12.5  # logical pixels: of labels in the 3D view
PANEL_TEXT = 14.5  # points: of figures in panels, as large as the window's text
LECTURE_ZOOM = 28.0 / FONT_SIZE  # of all sizes in lecture mode: capitals are 17 pixels high, as 18 points on a slide


@dataclass(frozen=True)
class Theme:
    name: str
    ground: Color  # behind everything
    panel: Color
    raised: Color  # buttons, tabs, table heads
    hover: Color
    text: Color
    muted: Color  # units and hints
    accent: Color  # what is selected or switched on
    on_accent: Color
    fault: Color
    sky: Color  # top of the 3D view
    haze: Color  # bottom of the 3D view
    border: Color
    dark: bool
    mono: bool  # black only: kinds of rays differ by letter, dash and arrow

    def ray(self, kind: str) -> Color:
        if self.mono:
            return self.text
        style = STYLES[kind]
        return rgb(style.dark if self.dark else style.light)

    @property
    def normal(self) -> Color:
        """Normals are not rays: a green that no kind of ray has, thin, with a short bar at the foot."""
        if self.mono:
            return self.text
        return rgb("#7FD6A2") if self.dark else rgb("#11723F")

    @property
    def glass(self) -> Color:
        """Clear glass and water in the 3D view."""
        return rgb("#78C8E6") if self.dark else rgb("#2E86B0")

    @property
    def sun(self) -> Color:
        """A light that is reached."""
        if self.mono:
            return self.text
        return (1.0, 0.82, 0.25, 1.0) if self.dark else (0.80, 0.55, 0.0, 1.0)


def curve_color(theme: Theme, k: int) -> Color:
    """The colour of the k-th curve in a plot."""
    dark, light = CURVES[k % len(CURVES)]
    return rgb(dark if theme.dark else light)


# The colours of the themes: dark, light, and mono for print, without colour and without a grey that a copier loses.
PALETTE = {
    "ground": ("#16181C", "#E9ECF0", "#FFFFFF"),
    "panel": ("#1E2126", "#FBFCFD", "#FFFFFF"),
    "raised": ("#2B3038", "#E3E8EE", "#EEEEEE"),
    "hover": ("#3A414C", "#CFD7E1", "#DDDDDD"),
    "text": ("#ECEFF3", "#14181D", "#000000"),
    "muted": ("#9AA4B2", "#5A6572", "#3A3A3A"),
    "accent": ("#F2C14E", "#B0127B", "#000000"),
    "on_accent": ("#16181C", "#FFFFFF", "#FFFFFF"),
    "fault": ("#FF8A80", "#B3261E", "#000000"),
    "sky": ("#262B33", "#FFFFFF", "#FFFFFF"),
    "haze": ("#16181C", "#E4E9EF", "#FFFFFF"),
    "border": ("#30363F", "#C3CBD5", "#8A8A8A"),
}


def _colors(k: int) -> dict[str, Color]:
    return {part: rgb(codes[k]) for part, codes in PALETTE.items()}


DARK = Theme("dark", dark=True, mono=False, **_colors(0))
LIGHT = Theme("light", dark=False, mono=False, **_colors(1))
MONO = Theme("mono", dark=False, mono=True, **_colors(2))

THEMES = {theme.name: theme for theme in (LIGHT, DARK, MONO)}
