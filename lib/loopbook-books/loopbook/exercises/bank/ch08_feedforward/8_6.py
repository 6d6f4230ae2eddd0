"""Python beside the page of exercise 8.6."""

import math

import numpy as np

from loopbook import signals
from loopbook.exercises import authoring
from loopbook.exercises.authoring import criterion, design
from loopbook.figures import time_plot
from loopbook.pid import LowpassFilter


def _noise(sigma, T_f):
    """The standard deviation behind the filter, which leaves all of it if it is very quick."""
    return float(sigma) * math.sqrt(min(1, 1 / (2 * T_f)))


def _fall_and_noise(T_f, A, jump, e_max, sigma, sigma_max):
    """The level after the jump of the outflow and the noise behind a filter, with their limits."""
    T_f, times = max(T_f, 0), np.arange(0, 300.0)
    lag = 1 - np.exp(-times / T_f) if T_f else np.ones(len(times))
    lowpass = LowpassFilter(T_f, 1)
    lowpass.update(0)
    record = np.array([lowpass.update(x) for x in signals.noise(times, sigma, seed=1)])
    panels = [{"level": (-jump / A * T_f * lag, "measurement")}, {"noise": (record, "raw")}]
    names, limits = ["change of the level [mm]", "noise [L/s]"], [(-2 * e_max, 0), (-4 * sigma_max, 4 * sigma_max)]
    plot = time_plot(panels, times, "With your filter", ylabel=names, ylim=limits)
    return plot.level(-e_max, "at most", "level").level(sigma_max, "standard deviation, at most", "noise")


def quiet_and_quick(key, *givens):
    """A time constant that leaves little of the noise, and lets the level fall only little."""
    A, jump, e_max, sigma, sigma_max = map(float, givens)
    return design(
        authoring.number(key, "s", "the time constant of the filter"),
        criterion("it is positive", lambda T_f: T_f > 0, otherwise="a time constant is more than zero"),
        criterion("the noise in the feedforward", lambda T_f: _noise(sigma, T_f), below=sigma_max, unit="L/s"),
        criterion("the fall of the level", lambda T_f: jump / A * T_f, below=e_max, unit="mm"),
        draws=lambda T_f: _fall_and_noise(float(T_f), A, jump, e_max, sigma, sigma_max),
    )
