"""Python beside the page of exercise 7.10."""

import functools

import numpy as np

from loopbook.figures import time_plot
from loopbook.transfer import static_gain  # noqa: F401

WAYS = ((1, 1), (1, 0), (0, 0))  # the setpoint weights w_p and w_d


@functools.lru_cache(maxsize=8)
def _kicks(K_p, T_i, T_d, step_SP, u_0, order):
    """Times and control signals after the setpoint step, each under its letter, by small Euler steps."""
    h, K_p, T_i, T_d, jump = 0.05, float(K_p), float(T_i), float(T_d), float(step_SP)
    times = np.arange(-0.1 * T_i, 2.5 * T_i, h)
    found = {}
    for letter, (w_p, w_d) in zip(order, WAYS, strict=True):
        x = y = u_i = 0.0
        lag = 0.0  # the filter of the derivative term, with a tenth of T_d
        u = np.zeros(len(times))
        for k, time in enumerate(times):
            y_SP = jump * (time >= 0)
            seen = w_d * y_SP - y
            u_d = 10 * K_p * (seen - lag)
            u[k] = K_p * (w_p * y_SP - y) + u_i + u_d
            lag += h * (seen - lag) / (0.1 * T_d)
            u_i += h * K_p / T_i * (y_SP - y)
            x += h * (0.8 * u[k] - x) / (0.8 * T_i)
            y += h * (x - y) / (0.2 * T_i)
        found[letter] = float(u_0) + u
    return times, dict(sorted(found.items()))


def just_after(*givens):
    """The control signals in the first moment after the step, by letter."""
    times, found = _kicks(*givens)
    return {letter: u[np.argmax(times >= 0)] for letter, u in found.items()}


def _limits(K_p, step_SP, u_0):
    """What the picture shows of the control signals."""
    return float(u_0 - 0.3 * K_p * step_SP), float(u_0 + 1.6 * K_p * step_SP)


def seen(K_p, T_i, T_d, step_SP, u_0, order):
    """The times, and the curves A, B and C as far as the picture shows them."""
    times, found = _kicks(K_p, T_i, T_d, step_SP, u_0, order)
    return times, *(np.minimum(u, _limits(K_p, step_SP, u_0)[1]) for u in found.values())


def picture(K_p, T_i, T_d, step_SP, u_0, order):
    """Three control signals A, B and C after a setpoint step; what is too high is cut off."""
    times, found = _kicks(K_p, T_i, T_d, step_SP, u_0, order)
    return time_plot(found, times, ylabel="control signal [%]", ylim=_limits(K_p, step_SP, u_0))
