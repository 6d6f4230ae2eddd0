"""Python beside the page of exercise 7.8."""

import numpy as np

from loopbook import signals
from loopbook.figures import time_plot
from loopbook.pid import LowpassFilter


def samples(p, jump, start, T_f, noise):
    """Times, measurement and filtered measurement."""
    step = 0.2  # s, between the samples
    times = np.arange(0, float(start + 7 * T_f), step)
    raw = (times >= float(start)) * float(jump) + signals.noise(times, jump / 20, seed=int(noise))
    lowpass = LowpassFilter(T_f, step)
    return times, float(p) + raw, float(p) + np.array([lowpass.update(x) for x in raw])


def picture(t, p_raw, p_filtered):
    """A noisy pressure that steps up, and the filtered pressure, which follows along an exponential."""
    curves = {"measurement": (p_raw, "raw"), "filtered": (p_filtered, "measurement")}
    return time_plot(curves, t, ylabel="pressure [kPa]")


def solution_picture(t, p_raw, p_filtered, moment, start):
    """The same picture, with the point where the filtered pressure has covered 63 % of its rise."""
    return picture(t, p_raw, p_filtered).mark(moment, "63 %, after $T_f$", "filtered").event(start, "step")
