"""8-bit pictures: sRGB by table against its definition (IEC 61966-2-1)."""

import numpy as np

from viewer.base.srgb import srgb


def defined(linear: np.ndarray) -> np.ndarray:
    """The value of the sRGB curve in 0..255, without rounding."""
    x = np.clip(linear, 0.0, 1.0)
    return 255.0 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(x, 1 / 2.4) - 0.055)


def test_srgb_is_the_curve_rounded() -> None:
    """Except within a few rounding errors of the border between two values, where either is right."""
    rng = np.random.default_rng(4)
    linear = np.concatenate([np.linspace(-0.1, 1.1, 1_200_001), rng.random(100_000) ** 4, [0.0, 1.0, 1e300, -1e300]])
    exact = defined(linear)
    found = srgb(linear)
    assert found.dtype == np.uint8
    assert (np.abs(found - exact) <= 0.5 + 8 * 255 * np.finfo(float).eps).all()


def test_srgb_of_what_is_no_number_is_a_value() -> None:
    assert srgb(np.array([np.nan, np.inf, -np.inf])).tolist() == [0, 255, 0]


def test_every_value_comes_back_from_its_own_light() -> None:
    """The 256 values, decoded by the standard and encoded by us, stay the same."""
    encoded = np.arange(256) / 255.0
    light = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    assert srgb(light).tolist() == list(range(256))
