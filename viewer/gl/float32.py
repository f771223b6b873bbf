"""Numbers of a scene as the graphics card takes them."""

import numpy as np
from numpy.typing import ArrayLike

LARGEST = float(np.finfo(np.float32).max)


def float32(values: ArrayLike) -> np.ndarray:
    """The values as float32. Larger ones become the largest: the 3D view shows no difference, and infinity would
    become NaN in a shader.
    """
    return np.clip(values, -LARGEST, LARGEST).astype(np.float32)
