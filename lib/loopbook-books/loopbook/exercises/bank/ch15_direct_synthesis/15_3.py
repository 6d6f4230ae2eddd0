"""Python beside the page of exercise 15.3."""

import math

import numpy as np

from loopbook.deadtime import Loop  # noqa: F401
from loopbook.figures import plane_plot
from loopbook.stability import margins  # noqa: F401
from loopbook.synthesis import imc  # noqa: F401
from loopbook.transfer import first_order  # noqa: F401


def solution_picture(delay, margin):
    """The Nyquist curve of the loop. It crosses the negative real axis well to the right of the point minus one."""
    w = np.linspace(0.3, 8, 600) / float(delay)
    L = np.exp(-1j * w * float(delay)) / (1j * w * 2 / math.pi * float(margin * delay))
    limits = {"xlim": (-1.2, 0.4), "ylim": (-1.2, 0.4)}
    plot = plane_plot({"$L(j\\omega)$": (L.real, L.imag)}, "real part", "imaginary part", equal=True, **limits)
    return plot.points([-1], [0], "$-1$", "x").points([-1 / float(margin)], [0], "$-1/$gain margin")
