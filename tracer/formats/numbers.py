"""Parsing of many numbers at once."""

import warnings

import numpy as np


def parsed(text: bytes, kind: type, count: int) -> np.ndarray | None:
    """The numbers in a text, if there are `count` of them and nothing else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = np.fromstring(text, kind, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return values if len(values) == count else None
