"""Python beside the page of exercise 5.6."""

import numpy as np

from loopbook.figures import plane_plot, time_plot
from loopbook.transfer import initial_slope  # noqa: F401
from loopbook.transfer import zeros as zeros_of  # noqa: F401


def _times(T_1):
    return np.linspace(0, 6 * float(T_1), 300)


def curves(K, T_1, T_2, T_0, T_r, order):
    """The four step responses, each under its letter."""
    K, T_1, T_2, T_0, T_r = map(float, (K, T_1, T_2, T_0, T_r))
    slow, quick = np.exp(-_times(T_1) / T_1), np.exp(-_times(T_1) / T_2)
    found = (K * (1 - ((T_1 - T) * slow - (T_2 - T) * quick) / (T_1 - T_2)) for T in (0, T_1, T_0, -T_r))
    return dict(sorted(zip(order, found, strict=True)))


def picture(K, T_1, T_2, T_0, T_r, order):
    """Four step responses A to D that end at the same value."""
    return time_plot(curves(K, T_1, T_2, T_0, T_r, order), _times(T_1), ylabel="step response")


def solution_picture(T_1, T_2, T_0, T_r):
    """The poles and the zeros of the four in the complex plane, all of them on the real axis."""
    poles, zeros = [float(-1 / T_1), float(-1 / T_2)], [float(x) for x in (-1 / T_1, -1 / T_0, 1 / T_r)]
    wide = 1.2 * max(map(abs, poles + zeros))
    axes = {"xlim": (-wide, wide), "ylim": (-0.5, 0.5)}
    plot = plane_plot(
        {"imaginary axis": ([0, 0], [-0.5, 0.5], "setpoint")}, "real part [1/s]", "imaginary part [1/s]", **axes
    )
    plot.points(poles, [0, 0], "poles", mark="x").points(zeros, [0, 0, 0], "zeros")
    for which, x in zip((2, 3, 4), zeros, strict=True):
        plot.text(x, 0.12, f"$H_{which}$")
    return plot
