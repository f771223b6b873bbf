"""The frame of a page: head, style, script. It knows nothing about what stands in the body.

A page is one file. It refers to nothing outside of it, and its Content-Security-Policy (CSP 3) allows nothing else:
only the style and the script that are in it, known by their hashes, and images that are data in it. So no text of a
scene can become a script, and opening a page sends nothing to anyone.
"""

import base64
import hashlib
from collections.abc import Sequence
from functools import cache
from html import escape
from pathlib import Path

from tracer.printable import printable
from viewer.base.theme import Theme, rgb_bytes

FOLDER = Path(__file__).parent
COLORS = ("ground", "panel", "raised", "text", "muted", "accent", "border")  # of a theme, which the style uses


def framed(
    title: str,
    body: Sequence[str],
    theme: Theme,
    head: Sequence[str] = (),
    style: str = "",
    script: str = "",
    schemes: str = "",
    language: str = "en",
) -> bytes:
    """The page as UTF-8. `body` and `head` are lines of HTML, `title` is text. `style` and `script` are added to those
    of every page. `schemes` are the values of `color-scheme`, if it is not that of the theme alone. `language` is that
    of the text (BCP 47).
    """
    style = f"{root_colors(theme)}\n{shipped(FOLDER / 'page.css')}{style}"
    script = f"{shipped(FOLDER / 'page.js')}{script}"
    policy = (
        f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(script)}; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )
    lines = [
        "<!DOCTYPE html>",
        f'<html lang="{text(language)}">',
        "<head>",
        '<meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<meta name="color-scheme" content="{schemes or ("dark" if theme.dark else "light")}">',
        *head,
        f"<title>{text(title)}</title>",
        f"<style>{style}</style>",
        f"<script>{script}</script>",
        "</head>",
        "<body>",
        *body,
        "</body>",
        "</html>",
        "",
    ]
    return "\n".join(lines).encode("utf-8")


def text(content: str) -> str:
    """Text as HTML, also in attributes, without control characters."""
    return escape(printable(content))


def root_colors(theme: Theme) -> str:
    """The theme's colours as custom properties of CSS."""
    named = {name: "#{:02X}{:02X}{:02X}".format(*rgb_bytes(getattr(theme, name))) for name in COLORS}
    return f":root {{ {' '.join(f'--{name}: {code};' for name, code in named.items())} }}"


@cache
def shipped(path: Path) -> str:
    """The text of a file of the program."""
    return path.read_text("utf-8")


def _hash(content: str) -> str:
    """The source expression that allows an inline style or script (CSP 3, 2.3.1)."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()}'"
