"""Python beside the page of exercise 3.7."""

import math

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises.authoring import criterion, design, number
from loopbook.figures import time_plot


def picture(C):
    """An RC circuit: the voltage v_in is across the resistor R and the capacitor of {C} in series, v_out across the
    capacitor alone."""
    return draw.rc_circuit(capacitor=f"${written(C)}$ µF")


def little_hum_and_quick(key, *givens):
    """A resistance that lets little of the hum through and the step come in time."""
    f, rest, t_95, C = map(float, givens)
    omega = 2 * math.pi * f / 1000  # per millisecond, in which kΩ times µF are

    def hum(R):
        return 100 / math.hypot(1, omega * R * C)

    def step_and_hum(R):
        times = np.linspace(0, 2 * t_95, 2001)
        step = 100 * (1 - np.exp(-times / (max(R, 1e-6) * C)))
        noisy = step + hum(R) / 3 * np.sin(omega * times)
        signals = {"step and hum, filtered": (noisy, "measurement"), "the step alone": (step, "setpoint")}
        plot = time_plot(signals, times, f"With $R$ = {R:.4g} kΩ", xlabel="$t$ [ms]", ylabel="share of the step [%]")
        return plot.event(t_95, "from here on at least 95 %").level(95, "95 %")

    return design(
        number(key, "kΩ", "the resistance"),
        criterion("the resistance is positive", lambda R: R > 0),
        criterion("the rest of the hum", hum, below=rest, unit="%"),
        criterion("the time to 95 % of the step", lambda R: math.log(20) * R * C, below=t_95, unit="ms"),
        draws=step_and_hum,
    )
