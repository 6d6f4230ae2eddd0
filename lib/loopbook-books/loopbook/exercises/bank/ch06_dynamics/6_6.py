"""Python beside the page of exercise 6.6."""

import math

import numpy as np

from loopbook.exercises.authoring import criterion, design, number
from loopbook.figures import time_plot


def smooth_and_quick(V, *givens):
    """A volume that keeps the pulse small, and lets 90 % of a change through in time."""
    F, pulse, c, c_max, t_max = map(float, givens)

    def pulse_and_step(volume):
        T = max(60 * volume / F, 1e-3)
        times = np.linspace(0, 1.5 * t_max, 400)
        rise = np.exp(-np.maximum(times - pulse, 0) / T) * (1 - np.exp(-np.minimum(times, pulse) / T))
        panels = [{"after a pulse": (c * rise, 0)}, {"after a change that lasts": (100 - 100 * np.exp(-times / T), 1)}]
        names = ["after a pulse [g/L]", "lasting change [%]"]
        plot = time_plot(panels, times, "Outflow of your tank", xlabel="$t$ [min]", ylabel=names, low=True)
        plot.level(c_max, "tolerated", "after a pulse").level(90, "90 %", "after a change that lasts")
        return plot.event(t_max, "at the latest")

    def highest(volume):
        return c * (1 - math.exp(-pulse * F / 60 / volume))

    return design(
        number(V, "m³", "the volume of the tank"),
        criterion("it is positive", lambda volume: volume > 0, otherwise="a volume is more than zero"),
        criterion("the highest concentration above normal", highest, below=c_max, unit="g/L"),
        criterion("the time to 90 %", lambda volume: 60 * volume / F * math.log(10), below=t_max, unit="min"),
        draws=pulse_and_step,
    )
