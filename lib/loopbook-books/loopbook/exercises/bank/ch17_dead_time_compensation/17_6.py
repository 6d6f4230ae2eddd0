"""The runs of exercise 17.6."""

import functools

import numpy as np

from loopbook import PID, Loop, first_order
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor
from loopbook.figures import time_plot


@functools.lru_cache(maxsize=8)
def run(K, T, delay, model):
    """Times, output and control signal after a unit step of the setpoint, with the lag cancelled and T_C = T."""
    times = np.linspace(0, float(3 * max(delay, model) + 2 * T), 601)
    loop = Loop(first_order(K, T, delay), predictor(K, T, model, PID(1 / K, T)))
    return times, loop.servo.step(times), loop.setpoint_to_control.step(times)


def first_moved(t, signal):
    """When a signal leaves the value with which it begins, and whether it rises then."""
    place = np.flatnonzero(abs(signal - signal[0]) > 1e-9)[0]
    return [t[place], bool(signal[place] > signal[0])]


def first_top(t, signal):
    """When a signal has its first maximum above its beginning; the end of the times where it has none."""
    inner = signal[1:-1]
    tops = np.flatnonzero((inner > signal[:-2]) & (inner > signal[2:]) & (inner > signal[0] + 1e-6))
    return t[tops[0] + 1] if tops.size else t[-1]


def covered(t, y, share):
    """When the weight has covered a share of the step."""
    return t[np.argmax(y >= float(share))]


def picture(t, y, u):
    """Above the weight, which waits and then rises; below the valve, which leaves its first position after a while."""
    panels = [{"weight": (y, "measurement")}, {"valve": (u, "control signal")}]
    return time_plot(panels, t, "A unit step of the setpoint", "$t$ [min]", ["weight [%]", "valve [%]"])


def solution_picture(t, u, delay, model):
    """The valve again, with the two corners marked: where the model responds, and where the process does."""
    plot = time_plot({"valve": (u, "control signal")}, t, "Two corners", "$t$ [min]", "valve [%]")
    return plot.mark(delay, "process").mark(model, "model")
