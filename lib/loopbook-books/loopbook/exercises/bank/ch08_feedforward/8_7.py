"""Python beside the page of exercise 8.7."""

import numpy as np

from loopbook.figures import time_plot


def curves(drop, given, T, shift):
    """Times and temperatures: without feedforward, with a wrong gain, too late, and too early."""
    drop, given, T, shift = map(float, (drop, given, T, shift))
    times = np.linspace(0, 8 * T, 401)
    begins = shift + 0.5 * T  # so that even what comes too early comes after the step

    def pushed(moment):
        x = np.maximum(times - moment, 0) / T
        return drop * (1 - np.exp(-x) * (1 + x))

    cold = -pushed(begins)
    return times, cold, cold + given * pushed(begins), cold + pushed(begins + shift), cold + pushed(begins - shift)


def last(values):
    """The last value of a curve."""
    return float(values[-1])


def picture(t, without, day_A, day_B, day_C):
    """The change of the temperature on three days, A, B and C, and without feedforward; the milk flow steps at zero."""
    days = {"A": (day_A, 0), "B": (day_B, 1), "C": (day_C, 2)}
    return time_plot({"without": (without, "raw")} | days, t, ylabel="change of temperature [K]")
