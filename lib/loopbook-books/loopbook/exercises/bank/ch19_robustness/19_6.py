"""The Nyquist curve of exercise 19.6."""

import math

import numpy as np

from loopbook.figures import plane_plot


def size_at(r, turn):
    """The size of exp(-s)/(r s + 1) where its phase is turned back by an angle in radians."""
    from scipy.optimize import brentq  # not before it is asked: a page of the site loads it then

    r, turn = float(r), float(turn)
    w = brentq(lambda w: w + math.atan(r * w) - turn, turn - math.pi / 2, turn)
    return 1 / math.hypot(1, r * w)


def points(k, r):
    """The Nyquist curve at frequencies from zero on."""
    w = np.concatenate([np.linspace(0, 3, 121), np.linspace(3.05, 30, 540)])
    return float(k) * np.exp(-1j * w) / (1 + 1j * float(r) * w)


def leftmost(k, r):
    """How far the curve goes to the left."""
    return -float(points(k, r).real.min())


def picture(L, x, y, crossover):
    """The last part of a Nyquist curve, which turns around the origin, with the unit circle and the point -1."""
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    curves = {r"$L(j\omega)$": (L.real, L.imag), "unit circle": (circle.real, circle.imag, 3)}
    window = {"xlim": (-1.25, 1.15), "ylim": (-1.35, 1.05), "equal": True}
    plot = plane_plot(curves, "real part", "imaginary part", **window).points([-1], [0], "$-1$", "x")
    plot.axes.set_xticks(np.arange(-1.2, 1.2, 0.2))
    plot.axes.set_yticks(np.arange(-1.2, 1.2, 0.2))
    plot.axes.minorticks_on()
    plot.axes.grid(which="minor", linewidth=0.3)
    plot.points([float(x)], [-float(y)], f"{crossover:.3g} rad/min", "o")
    plot.axes.get_legend().set_loc("upper right")  # where nothing but the unit circle is
    return plot


def solution_picture(L, x, y, crossover, first, second):
    """The same curve, with the crossings of the negative real axis."""
    plot = picture(L, x, y, crossover).points([-float(first), -float(second)], [0, 0], "crossings", "s")
    plot.axes.get_legend().set_loc("upper right")
    return plot
