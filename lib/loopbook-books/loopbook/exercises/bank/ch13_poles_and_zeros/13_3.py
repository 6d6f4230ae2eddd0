"""Python beside the page of exercise 13.3."""

import numpy as np

from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.transfer import first_order


def _steps(tau_1, systems):
    times = np.linspace(0, float(4 * tau_1), 201)
    curves = {name: System(G).step(times) for name, G in systems.items()}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]", low=True)


def picture(k, K, tau_1, tau_2):
    """The two effects of 1 L/min more feed, each alone: a slow rise and a fast fall."""
    return _steps(tau_1, {"more to react": first_order(k, tau_1), "cold feed": first_order(-K, tau_2)})


def solution_picture(k, tau_1, tau_2, G, K_limit):
    """The sum of the two effects, and the same with the gain of the fast one at the limit."""
    return _steps(tau_1, {"as it is": G, "at the limit": first_order(k, tau_1) - first_order(K_limit, tau_2)})
