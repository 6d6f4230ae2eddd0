"""Python beside the page of exercise 7.8."""

import numpy as np

from loopbook import signals
from loopbook.exercises import authoring
from loopbook.figures import time_plot
from loopbook.pid import LowpassFilter

STEP = 0.2  # s, between the samples


def read_off(key, unit, what, within):
    """A number that is given, and is asked where it is only seen in the picture."""
    return authoring.number(key, unit, what, within=float(within))


def samples(p, jump, start, T_f, noise):
    """Times, measurement and filtered measurement."""
    times = np.arange(0, float(start + 7 * T_f), STEP)
    raw = (times >= float(start)) * float(jump) + signals.noise(times, jump / 20, seed=int(noise))
    lowpass = LowpassFilter(T_f, STEP)
    return times, float(p) + raw, float(p) + np.array([lowpass.update(x) for x in raw])


def reached(t, values, level):
    """When a curve is above a level for the first time."""
    return float(t[np.argmax(values >= float(level))])


def behind_a_ramp(T, rate):
    """How far a filter is behind a ramp in the end, by simulation."""
    times = np.linspace(0, 10 * float(T), 2001)
    lowpass = LowpassFilter(float(T), float(times[1]))
    return [float(rate * time) - lowpass.update(float(rate * time)) for time in times][-1]


def picture(t, p_raw, p_filtered):
    """A noisy pressure that steps up, and the filtered pressure, which follows along an exponential."""
    curves = {"measurement": (p_raw, "raw"), "filtered": (p_filtered, "measurement")}
    return time_plot(curves, t, ylabel="pressure [kPa]")


def solution_picture(t, p_raw, p_filtered, moment, start):
    """The same picture, with the point where the filtered pressure has covered 63 % of its rise."""
    return picture(t, p_raw, p_filtered).mark(moment, "63 %, after $T_f$", "filtered").event(start, "step")
