"""Python beside the page of exercise 13.7: a loop x exp(-s)/s with the dead time as the unit of time."""

from functools import lru_cache

import numpy as np

from loopbook.figures import plane_plot
from loopbook.stability import margins
from loopbook.transfer import integrator


@lru_cache
def margins_of(x):
    """What the library says of the loop, its largest sensitivity among it."""
    return margins(integrator(x, 1))


def sensitivity(x, w):
    """The size of the sensitivity at one frequency or at several."""
    jw = 1j * np.asarray(w, dtype=float)
    found = abs(1 / (1 + float(x) * np.exp(-jw) / jw))
    return found if found.ndim else float(found)


def helps_until(x, limit=1):
    """The frequency up to which the size of the sensitivity is below a limit."""
    from scipy.optimize import brentq  # not before it is asked: a page of the site loads it then

    return brentq(lambda w: sensitivity(x, w) - float(limit), 0.01, margins_of(x).omega_ms)


def curve(x, delay):
    """Frequencies, and the size of the sensitivity at these."""
    w = np.linspace(0.02, 2.6, 259)
    return w / float(delay), sensitivity(x, w)


def picture(w, S, Ms):
    """The size of the sensitivity function against the frequency: it rises from zero over one to a peak, and falls."""
    axes = {"xlim": (0, float(w[-1])), "ylim": (0, 0.5 * float(np.ceil(2.2 * Ms)))}
    plot = plane_plot({"$|S|$": (w, S)}, r"frequency $\omega$ [rad/min]", "$|S|$", **axes)
    plot.axes.minorticks_on()
    plot.axes.grid(which="minor", linewidth=0.3)
    return plot


def solution_picture(w, S, Ms, at, helps, omega, size):
    """The same curve, with the peak, the end of the range in which control helps, and the disturbance."""
    plot = picture(w, S, Ms).points([float(at)], [float(Ms)], "$M_s$")
    plot.points([float(helps)], [1], "control helps up to here", "s")
    return plot.points([float(omega)], [size], "the disturbance", "^")
