"""Pictures as files: PNG clipped to 8-bit sRGB, NumPy and OpenEXR linear. A new format: a writer, a line in WRITERS."""

import io
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from viewer.base.files import Unusable, write_atomically
from viewer.base.theme import Color

BINS = 4096  # of linear light: more than sRGB's steepest slope of 255 * 12.92, so that none holds two borders


def _linear(encoded: np.ndarray) -> np.ndarray:
    """The light that sRGB (IEC 61966-2-1) encodes so, both in 0..1."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


BORDERS = np.append(_linear((np.arange(255) + 0.5) / 255.0), np.inf)  # where 8-bit value k ends and k + 1 begins
FIRST = np.searchsorted(BORDERS, np.arange(BINS + 1) / BINS, "right").astype(np.uint8)  # the value a bin begins with


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB of linear RGB, clipped to 0..1. By table: a power for each pixel takes longer than simple rays."""
    x = np.fmin(np.fmax(linear, 0.0), 1.0)
    value = FIRST[(x * BINS).astype(np.intp)]
    return value + (x >= BORDERS[value])


LUMINANCE = (0.2126, 0.7152, 0.0722)  # of sRGB's red, green and blue (Rec. 709)


def as_shown(rgb: object) -> Color:
    """Linear RGB as the colour a picture shows."""
    r, g, b = (srgb(np.asarray(rgb, float)) / 255.0).tolist()
    return (r, g, b, 1.0)


COMPRESSION = 4  # of zlib's levels: half the time of its usual 6, for 5 % more bytes


def png(pixels: np.ndarray) -> bytes:
    """PNG of linear RGB (height, width, 3), or of 8-bit sRGB as it is."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(pixels if pixels.dtype == np.uint8 else srgb(pixels)).save(
        buffer, "PNG", compress_level=COMPRESSION
    )
    return buffer.getvalue()


def npy(pixels: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, pixels)
    return buffer.getvalue()


def exr(pixels: np.ndarray) -> bytes:
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "image.exr"
        OpenEXR.File(header, {"RGB": np.ascontiguousarray(pixels, np.float32)}).write(str(path))
        return path.read_bytes()


WRITERS: dict[str, Callable[[np.ndarray], bytes]] = {".png": png, ".npy": npy, ".exr": exr}


def check_format(path: Path) -> None:
    if path.suffix.lower() not in WRITERS:
        raise Unusable(f"{path}: an image must be one of {', '.join(WRITERS)}, got {path.suffix or 'no suffix'}")


def write_picture(path: Path, pixels: np.ndarray) -> None:
    write_atomically(path, WRITERS[path.suffix.lower()](pixels))
