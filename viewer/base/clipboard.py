"""The system's clipboard, for text and pictures.

The window's own clipboard is not used: it supports text only, and does not respond to other programs while the
window is busy.
"""

import io

from viewer.base.files import Unusable


def copy_to_clipboard(content: str | bytes) -> None:
    """Copy a text, or a PNG as a picture. Unusable if the system has no clipboard for it."""
    import copykitten

    try:
        if isinstance(content, str):
            copykitten.copy(content)
            return
        from PIL import Image

        with Image.open(io.BytesIO(content)) as picture:
            copykitten.copy_image(picture.convert("RGBA").tobytes(), *picture.size)
    except copykitten.CopykittenError as error:
        raise Unusable(f"cannot copy to the clipboard: {error}; Ctrl+S writes the figure to a file") from None
