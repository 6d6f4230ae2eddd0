"""Python beside the page of exercise 6.8."""

import numpy as np

from loopbook.figures import time_plot


def curves(T, tau, order):
    """The times, and the curves A to D."""
    T, tau = float(T), float(tau)
    times = np.linspace(0, 3.2 * T, 400)
    two, four, after = 2 * times / T, 4 * times / T, np.maximum(times - tau, 0)
    responses = (
        1 - np.exp(-times / T),
        1 - np.exp(-two) * (1 + two),
        1 - np.exp(-four) * (1 + four + four**2 / 2 + four**3 / 6),
        1 - np.exp(-after / max(T - tau, 1e-9)),
    )
    return times, *dict(sorted(zip(order, responses, strict=True))).values()


def picture(t, A, B, C, D):
    """Four step responses A to D, all from zero to one, each with a beginning of its own."""
    return time_plot({"A": A, "B": B, "C": C, "D": D}, t, ylabel="response")
