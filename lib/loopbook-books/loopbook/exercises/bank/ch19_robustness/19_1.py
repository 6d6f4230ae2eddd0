"""The Nyquist curve of exercise 19.1."""

import math

import numpy as np

from loopbook.exercises.bank.ch19_robustness.shared import nyquist
from loopbook.stability import margins
from loopbook.transfer import first_order

__all__ = ["first_order", "margins", "solution_picture"]


def solution_picture(a, delay):
    """The Nyquist curve with the unit circle, and the two crossings at which gain and phase margin are read."""
    a, theta = float(a), float(delay)
    w = np.geomspace(a / 3, 40 * a, 800)
    plot = nyquist(a * np.exp(-1j * w * theta) / (1j * w), (-1.6, 1.2), (-1.6, 1.2))
    plot.points([-2 * a * theta / math.pi], [0], "gain margin", "o")
    turned = np.exp(-1j * (math.pi / 2 + a * theta))
    return plot.points([turned.real], [turned.imag], "phase margin", "s")
