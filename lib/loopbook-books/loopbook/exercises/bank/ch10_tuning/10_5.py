"""Python beside the page of exercise 10.5."""

from math import pi

import numpy as np

from loopbook.figures import time_plot
from loopbook.identification import limit_cycle


def _record(low, high, middle, a, period, periods):
    times = np.linspace(0, periods * float(period), 1001)
    wave = np.sin(2 * pi * times / float(period))
    return times, np.where(wave >= 0, float(high), float(low)), float(middle) - float(a) * wave


def of_the_record(*givens):
    """What the library reads off the record."""
    return limit_cycle(*_record(*givens, 5))


def picture(low, high, middle, a, period):
    """Two and a half periods of the experiment: the temperature, and the relay that switches the valve."""
    times, u, y = _record(low, high, middle, a, period, 2.5)
    upper, lower = {"temperature [°C]": (y, "measurement")}, {"valve [%]": (u, "control signal")}
    return time_plot([upper, lower], times, xlabel="$t$ [min]")
