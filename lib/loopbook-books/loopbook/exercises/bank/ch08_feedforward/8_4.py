"""Python beside the page of exercise 8.4."""

import numpy as np

from loopbook.figures import time_plot


def _sinusoids(theta, P):
    """Times, what the wind does and what the late feedforward does, with the amplitude one."""
    times, turn = np.linspace(0, 2 * float(P), 4001), 2 * np.pi / float(P)
    return times, np.sin(turn * times), np.sin(turn * (times - float(theta)))


def largest(theta, P, k):
    """The amplitude of what is left, with k times the force."""
    _, wind, late = _sinusoids(theta, P)
    return max(abs(wind - float(k) * late))


def solution_picture(e_0, theta, P):
    """What the wind does, what the late feedforward does, and the difference of the two."""
    times, wind, late = _sinusoids(theta, P)
    wind, late = float(e_0) * wind, float(e_0) * late
    curves = {"wind": (wind, "disturbance"), "feedforward": (late, 3), "difference": (wind - late, "measurement")}
    return time_plot(curves, times, ylabel="position [m]", low=True)
