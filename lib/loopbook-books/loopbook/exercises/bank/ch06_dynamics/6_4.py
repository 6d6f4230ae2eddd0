"""Python beside the page of exercise 6.4."""

import numpy as np

from loopbook.deadtime import System
from loopbook.expressions import t
from loopbook.figures import time_plot
from loopbook.transfer import dead_time, integrator, series  # noqa: F401


def at(m, time):
    """The mass at a moment."""
    return m.subs(t, time)


def arrived(H, F, run, time):
    """The same by simulation of the belt: a step of the feed, and one back."""
    on, off = (System(H).step(np.array([0, float(moment)]))[-1] for moment in (time, time - run))
    return float(F) * (on - off)


def solution_picture(delay, last, F, run):
    """The mass in the hopper and the mass on the belt against time."""
    times = np.linspace(0, 1.15 * float(last), 300)
    fed = np.clip(times, 0, float(run)) * float(F)
    arrived = np.clip(times - float(delay), 0, float(run)) * float(F)
    curves = {"in the hopper": arrived, "on the belt": fed - arrived}
    return time_plot(curves, times, ylabel="mass [kg]", low=True).event(run, "feeder stops")
