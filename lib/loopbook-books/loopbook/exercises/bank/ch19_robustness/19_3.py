"""The record of exercise 19.3."""

import numpy as np

from loopbook.figures import time_plot


def picture(omega, period):
    """The record of the temperature: an oscillation with a constant amplitude around the setpoint."""
    times = np.linspace(0, 3.5 * float(period), 401)
    curves = {"temperature": (np.sin(float(omega) * times), "measurement"), "setpoint": (0, "setpoint")}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="deviation [%]", low=True)
