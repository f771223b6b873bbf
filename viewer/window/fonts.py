"""The fonts of the window."""

from pathlib import Path

import imgui_bundle
from imgui_bundle import imgui

from viewer.base.theme import FONT_SIZE

WIDE = 2048  # pixels: of the atlas, which formulas are drawn into as well: room for a line on a large screen


def load_fonts() -> None:
    """Roboto, regular, bold and italic, with the arrows and subscripts of DejaVu Sans that it lacks, and Inconsolata
    for source text. Panels take the fonts in this order: `viewer.panels.draw`.
    """
    shipped = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
    symbols = Path(__file__).parent.parent / "fonts" / "DejaVuSans-symbols.ttf"
    fonts = imgui.get_io().fonts
    fonts.tex_min_width = WIDE  # the atlas grows in height only
    for weight in ("Regular", "Bold", "RegularItalic"):
        fonts.add_font_from_file_ttf(str(shipped / "Roboto" / f"Roboto-{weight}.ttf"), FONT_SIZE)
        config = imgui.ImFontConfig()
        config.merge_mode = True
        fonts.add_font_from_file_ttf(str(symbols), 0.86 * FONT_SIZE, config)
    fonts.add_font_from_file_ttf(str(shipped / "Inconsolata-Medium.ttf"), FONT_SIZE)
