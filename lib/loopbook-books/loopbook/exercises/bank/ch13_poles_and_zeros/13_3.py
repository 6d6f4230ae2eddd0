"""The two effects of exercise 13.3."""

import numpy as np

from loopbook.exercises.bank.ch13_poles_and_zeros.shared import factor
from loopbook.figures import time_plot
from loopbook.transfer import initial_slope, zeros

__all__ = ["factor", "initial_slope", "picture", "solution_picture", "zeros"]


def _responses(tau_1, tau_2):
    """Times, and the step responses of the slow lag and of the fast one."""
    times = np.linspace(0, float(4 * tau_1), 201)
    return times, *(1 - np.exp(-times / float(T)) for T in (tau_1, tau_2))


def picture(k, K, tau_1, tau_2):
    """The two effects of 1 L/min more feed, each alone: a slow rise and a fast fall."""
    times, slow, fast = _responses(tau_1, tau_2)
    curves = {"more to react": float(k) * slow, "cold feed": -float(K) * fast}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]", low=True)


def solution_picture(k, K, tau_1, tau_2, K_limit):
    """The sum of the two effects, and the same with the gain of the fast one at the limit."""
    times, slow, fast = _responses(tau_1, tau_2)
    gains = {"as it is": K, "at the limit": K_limit}
    curves = {name: float(k) * slow - float(gain) * fast for name, gain in gains.items()}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]", low=True)
