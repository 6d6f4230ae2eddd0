"""The poles of exercise 19.2."""

import numpy as np

from loopbook.figures import plane_plot


def solution_picture(x, delay):
    """The poles nearest to the axis: those on its right are the unstable ones."""
    from scipy.special import lambertw  # not before it is asked: a page of the site loads it then

    found = lambertw(-float(x), np.arange(-7, 7)) / float(delay)
    high, wide = 1.1 * max(abs(found.imag)), 1.15 * max(abs(found.real))
    axis = {"imaginary axis": ([0, 0], [-high, high], "setpoint")}
    plot = plane_plot(axis, "real part [1/s]", "imaginary part [rad/s]", xlim=(-wide, wide), ylim=(-high, high))
    return plot.points(found.real, found.imag, "poles", "x")
