"""Python beside the page of exercise 4.6."""

import numpy as np
from sympy import Heaviside

from exercisebook.parameters import written
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.laplace import transform  # noqa: F401
from loopbook.transfer import step_response


def temperature(K, T, u_1, u_2, t_1, moment):
    """The temperature at a moment: the responses to the two steps of the power, one on the other."""
    lag = step_response(K / (T * s + 1))
    return float(u_1 * lag.subs(t, moment) + (u_2 - u_1) * lag.subs(t, moment - t_1))


def picture(full):
    """The power against time: $u_1$ = {full} from t = 0 to $t_1$, and from then on a lower one, $u_2$; this is not to
    scale."""
    power = {"$u$": (float(full) * (1 - 0.45 * Heaviside(t - 1)), "control signal")}
    plot = time_plot(power, np.linspace(0, 2.5, 251), ylim=(0, 1.3 * float(full)), xlabel="$t$", low=True)
    axes = plot.figure.axes[0]
    axes.set_xticks([0, 1], ["0", "$t_1$"])
    axes.set_yticks([0, 0.55 * float(full), float(full)], ["0", "$u_2$", f"$u_1$ = {written(full)} kW"])
    return plot


def solution_picture(T, full, warmer, far, u_2, t_1):
    """The temperature rises under full power, reaches its goal, and stays; else it would go far beyond."""
    times = np.linspace(0, 3 * float(t_1), 301)
    rising = float(far) * (1 - np.exp(-times / float(T)))
    switched = np.where(times < float(t_1), rising, float(warmer))
    curves = {"$y$": (switched, "measurement"), "full power all the time": (rising, "raw")}
    powers = {"$u$": (full - (full - u_2) * Heaviside(t - t_1), "control signal")}
    names = ["$y$ [K]", "$u$ [kW]"]
    return time_plot([curves, powers], times, xlabel="$t$ [min]", ylabel=names).event(t_1, "$t_1$")
