"""Pieces of laws."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def between(start: Sequence[float], end: Sequence[float], length: float) -> np.ndarray:
    """A piece of ``length`` revolutions, shape (7,): the polynomial of degree 5 that goes from one value
    with its first and second derivative, ``start``, to another with its own, ``end``."""
    (a, b, c), (value, slope, bend) = start, end
    h = length
    p = value - a - b * h - 0.5 * c * h * h
    q = slope - b - c * h
    r = bend - c
    c3 = (10.0 * p - 4.0 * q * h + 0.5 * r * h * h) / h**3
    c4 = (-15.0 * p + 7.0 * q * h - r * h * h) / h**4
    c5 = (6.0 * p - 3.0 * q * h + 0.5 * r * h * h) / h**5
    return np.array([h, a, b, 0.5 * c, c3, c4, c5])
