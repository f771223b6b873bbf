"""The colours of the picked pixel: that of the tree on show, and the mean of the pixel's samples."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from imgui_bundle import imgui

from tracer.tree.raytree import RayTree
from viewer.base.srgb import display_color
from viewer.panels import draw as d
from viewer.session.session import Session

BETWEEN = 12.0  # logical pixels between two colours
GAP = 6.0  # between a swatch and its text
UNITS = "red, green, blue: linear light, before it is encoded as sRGB for the screen"


class Shade(NamedTuple):
    """A colour with its name."""

    name: str  # empty: nothing else has to be told from it
    rgb: np.ndarray
    meaning: str

    @property
    def numbers(self) -> str:
        return "  ".join(f"{value:.4f}" for value in self.rgb)


def tree_shade(tree: RayTree) -> Shade:
    """The colour of the tree on show."""
    whose = tree.sample_text or "the ray through the pixel's centre"
    return Shade("", tree.radiance, f"{whose}: the sum over the rays on show")


def mean_shade(session: Session) -> Shade | None:
    """The mean of the pixel's samples, if the image shows it."""
    mean = pixel_mean(session)
    if mean is None:
        return None
    count, rgb = mean
    return Shade(f"mean of {count}", rgb, f"the mean of {count} samples: the pixel's colour in the image")


def pixel_mean(session: Session) -> tuple[int, np.ndarray] | None:
    """The number of samples of the picked pixel in the image, and their mean; None if its centre is shown."""
    picture, run = session.image.picture, session.refinement.current
    if not picture or not session.pixel:
        return None
    x, y = session.pixel
    if picture.is_endless and run and run.image:
        statistics = run.image.statistics
        count = int(statistics.counts[y, x])
        if count >= picture.least_refined:
            return count, statistics.sums[y, x, :3] / count
    if picture.samples > 1 and not picture.is_preview:
        return picture.samples, picture.pixels[y, x]
    return None


def draw_colors(session: Session, tree: RayTree, room: float) -> None:
    """The colour of the pixel in the image, and of its centre if the rays on show are those of the centre."""
    mean = mean_shade(session)
    found = ([tree_shade(tree)] if tree.sample is None else []) + ([mean] if mean else [])
    if found:
        draw_shades(found, room)
    else:
        imgui.text_colored(session.appearance.theme.muted, f"mean of {tree.samples} ...")


def draw_shades(found: Sequence[Shade], room: float) -> None:
    """A swatch for each colour, with its name and its numbers as far as there is room."""
    unit, side = d.unit(), imgui.get_frame_height()

    def width(texts: Sequence[str]) -> float:
        wide = sum(imgui.calc_text_size(text).x + GAP * unit if text else 0.0 for text in texts)
        return wide + len(texts) * side + (len(texts) - 1) * BETWEEN * unit

    names = [shade.name for shade in found]
    full = [f"{shade.name}  {shade.numbers}".strip() for shade in found]
    texts = next((texts for texts in (full, [*full[:1], *names[1:]], names) if width(texts) <= room), [""] * len(found))
    for k, (shade, text) in enumerate(zip(found, texts, strict=True)):
        if k:
            imgui.same_line(0.0, BETWEEN * unit)
        flags = imgui.ColorEditFlags_
        color = display_color(shade.rgb)
        imgui.color_button(f"##color {shade.name}", color, flags.no_tooltip | flags.no_drag_drop, (side, side))
        hovered = imgui.is_item_hovered()
        if text:
            imgui.same_line(0.0, GAP * unit)
            imgui.text(text)
            hovered = hovered or imgui.is_item_hovered()
        if hovered:
            imgui.set_tooltip("\n\n".join(f"{shade.meaning}\n{shade.numbers}" for shade in found) + f"\n\n{UNITS}")
