"""Python beside the page of exercise 4.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook.figures import time_plot


def picture(T, start, bath, rest):
    """The temperature around the thermometer: {start} until t = 0, and {bath} from then on. The reading is
    drawn up to t = 0, and also the line {rest} below the water."""
    times = np.linspace(-float(T), 5 * float(T), 601)
    before = times < 0
    signals = {
        "surroundings, $u$": (np.where(before, float(start), float(bath)), "setpoint"),
        "reading, $y$": (np.where(before, float(start), np.nan), "measurement"),
        f"{written(rest)} K below": (np.where(before, np.nan, float(bath - rest)), "raw"),
    }
    return time_plot(signals, times, ylabel="temperature [°C]", low=True)
