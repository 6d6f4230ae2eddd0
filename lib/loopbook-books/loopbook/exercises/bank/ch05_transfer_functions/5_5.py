"""Python beside the page of exercise 5.5."""

import numpy as np

from loopbook import diagrams
from loopbook.exercises.authoring import criterion, design, number
from loopbook.figures import time_plot


def in_two_digits(value):
    """A number as one would set it."""
    return float(f"{float(value):.2g}")


def enough_but_not_too_much(key, *givens):
    """A gain with which the plate is warm enough, quick enough, and gets no more than its power."""
    K, T, share, T_max, u_max, step = map(float, givens)

    def plate_and_heater(gain):
        rate = (1 + gain * K) / T or 1e-9  # the gain of minus one over K leaves an integrator
        times = np.linspace(0, 4 * T_max, 301)
        y = step * gain * K / T * (1 - np.exp(-np.maximum(rate * times, -50))) / rate
        panels = [{"$y$": (y, "measurement")}, {"$u$": (gain * (step - y), 0)}]
        limits = {"ylabel": ["$y$ [K]", "$u$ [kW]"], "ylim": [(-0.2 * step, 1.4 * step), (0, 2 * u_max)]}
        plot = time_plot(panels, times, "The plate in your loop", low=True, **limits)
        plot.level(share / 100 * step, "at least, in the end", "$y$").level(u_max, "at most", "$u$")
        return plot.event(T_max, "63 % of its way by then")

    part = "the share of the step that is reached"
    return design(
        number(key, "kW/K", "the gain of the feedback"),
        criterion("the loop is stable", lambda gain: 1 + gain * K > 0),
        criterion(part, lambda gain: 100 * gain * K / (1 + gain * K), above=share, unit="%"),
        criterion("the time constant", lambda gain: T / (1 + gain * K), below=T_max, unit="s"),
        criterion("the largest power", lambda gain: gain * step, below=u_max, unit="kW"),
        draws=plate_and_heater,
    )


def picture(K, T):
    """The loop: the gain of the feedback and the plate, a lag, with the temperature fed back."""
    plate = diagrams.block(rf"\frac{{{float(K):g}}}{{{float(T):g} s + 1}}")
    return diagrams.block_diagram("r", diagrams.feedback_loop(["e", diagrams.gain("K_c"), "u", plate]), "y")
