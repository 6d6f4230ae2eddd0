"""Python beside the page of exercise 4.5."""

import numpy as np

from loopbook.figures import time_plot
from loopbook.laplace import evaluate, final_value, inverse  # noqa: F401

in_order = sorted


def those_that_settle(signals):
    """The letters of those that do not move any more when a long time has passed."""
    late = np.array([50, 50.3, 50.7])
    return sorted(letter for letter, F in signals.items() if np.ptp(evaluate(inverse(F), late)) < 1e-9)


def solution_picture(order, a, b, p, w):
    """The four signals: one settles, one grows, one oscillates, one dies out."""
    times = np.linspace(0, 5, 501)
    a, b, p, w = map(float, (a, b, p, w))
    growing = (np.exp((p - 1) * times) - 1) * b / (p - 1)
    growing[growing > 2 * max(b / p, a / w)] = np.nan
    fading = a * (np.exp(-times) - np.exp(-w * times)) / (w - 1)
    signals = (b * (1 - np.exp(-p * times)) / p, growing, a * np.sin(w * times) / w, fading)
    return time_plot(dict(sorted(zip(order, signals, strict=True))), times)
