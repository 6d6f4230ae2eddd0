"""Python beside the page of exercise 11.9."""

import cmath
import math

import numpy as np

from loopbook.exercises.authoring import criterion, design, settings
from loopbook.figures import time_plot


def _loop(pid, A):
    """The coefficients a, b of s**2 + a s + b in the closed loop; None where that is not stable."""
    Kp, Ti = float(pid.Kp), float(pid.Ti)
    if Kp >= 0 or Ti <= 0:
        return None
    a = -Kp / (1000 * float(A))
    return a, a / Ti


def rise_of_level(pid, A, F):
    """The highest point of the level after a step F of the inflow, in m."""
    if (loop := _loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, split = float(F) / (1000 * float(A)), a * a / 4 - b
    if b == 0:
        return size / a
    if abs(split) < 1e-9 * a * a:
        return size * 2 / a * math.exp(-1)
    w = math.sqrt(abs(split))
    time = (math.atanh(2 * w / a) if split > 0 else math.atan2(2 * w, a)) / w
    return size * math.exp(-a * time / 2) * (math.sinh if split > 0 else math.sin)(w * time) / w


def flow_gain(pid, A, w):
    """How large a wave of the inflow comes out, in %."""
    if (loop := _loop(pid, A)) is None:
        return math.inf
    a, b = loop
    return 100 * math.sqrt((a * a * w * w + b * b) / ((b - w * w) ** 2 + a * a * w * w))


def largest_flow_gain(pid, A):
    """That of the worst wave, in %; a P controller makes none larger."""
    if (loop := _loop(pid, A)) is None:
        return math.inf
    a, b = loop
    if b == 0:
        return 100.0
    return flow_gain(pid, A, math.sqrt((math.sqrt(b**4 + 2 * a * a * b**3) - b * b) / (a * a)))


def level_after(pid, A, F, time):
    """The deviation of the level at a time after the step of the inflow, in m."""
    if (loop := _loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, w = float(F) / (1000 * float(A)), cmath.sqrt(a * a / 4 - b)
    if abs(w) < 1e-6 * a:
        return size * time * math.exp(-a * time / 2)
    modes = cmath.exp((w - a / 2) * time) - cmath.exp(-(w + a / 2) * time)
    return size * (modes / (2 * w)).real


def highest_point(pid, A, F):
    """The highest level of the curve after a step F of the inflow, in m."""
    T_C = float(pid.Ti) / 2
    return max(level_after(pid, A, F, time) for time in np.linspace(0, 4 * T_C, 4001))


def away(level):
    """A deviation of the level as one says it: what nobody can measure is less than a tenth of a millimetre."""
    size = abs(1000 * level)
    return "less than 0.1 mm" if size < 0.1 else (size, "mm")


def _drawn(pid, A, F, dh, period):
    """The level after the step of the inflow, and the wave of the inflow with what comes out of it."""
    times = np.linspace(0, max(18600 * float(A * dh / F), 3 * float(period)), 401)
    level = np.array([level_after(pid, A, F, time) for time in times])
    phase, size = 2 * np.pi * times / float(period), flow_gain(pid, A, 2 * math.pi / float(period))
    waves = {"wave in": 100 * np.sin(phase), "wave out, without its delay": size * np.sin(phase)}
    limits = [(-float(dh), 2 * float(dh)), (-120, 220)]
    panels = [{"level": (level, "measurement")}, waves]
    plot = time_plot(panels, times, ylabel=["rise of the level [m]", "wave [%]"], ylim=limits)
    return plot.level(dh, "highest allowed", "level")


def buffer(controller, A, F, dh, period, gain):
    """Settings with which level and wave stay within what is demanded."""
    w = 2 * math.pi / float(period)
    return design(
        settings(controller, gain="kg/(s m)", time="s", what="the settings"),
        criterion("there is no derivative term", lambda pid: pid.Td == 0),
        criterion(
            "the loop is stable",
            lambda pid: _loop(pid, A) is not None,
            otherwise="the loop is not stable: must more or less flow out when the level is too high, "
            "and where is $e$ then?",
        ),
        criterion("the rise of the level", lambda pid: rise_of_level(pid, A, F), below=float(dh), unit="m"),
        criterion("the flow gain at the wave's period", lambda pid: flow_gain(pid, A, w), below=float(gain), unit="%"),
        criterion("the largest flow gain", lambda pid: largest_flow_gain(pid, A), below=130, unit="%"),
        criterion("the deviation two hours later", lambda pid: abs(level_after(pid, A, F, 7200)), below=0.01, unit="m"),
        draws=lambda pid: _drawn(pid, A, F, dh, period),
    )
