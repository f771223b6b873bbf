"""Pictures as files: PNG clipped to 8-bit sRGB, NumPy and OpenEXR linear. A new format: a writer, a line in WRITERS."""

import io
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from viewer.files import Unusable, write_atomically


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB (IEC 61966-2-1) of linear RGB, clipped to 0..1."""
    x = np.clip(linear, 0.0, 1.0)
    encoded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)
    return (encoded * 255.0 + 0.5).astype(np.uint8)


def png(pixels: np.ndarray) -> bytes:
    """PNG of linear RGB (height, width, 3), or of 8-bit sRGB as it is."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(pixels if pixels.dtype == np.uint8 else srgb(pixels)).save(buffer, "PNG")
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
