"""Python beside the page of exercise 11.9."""

import numpy as np

from loopbook.deadtime import System
from loopbook.exercises.authoring import criterion, design, settings
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.transfer import simplified


def _level(pid, A, F, times):
    """The level above its setpoint after a step F of the inflow, in m."""
    return System(simplified(F / (1000 * A * s - pid.expr))).step(times)


def rise_of_level(pid, A, F):
    """The highest point of the level after a step F of the inflow, in m."""
    slowest = 20000 * float(A / abs(pid.Kp))
    return float(_level(pid, A, F, np.linspace(0, slowest, 2001)).max())


def away_later(pid, A, F):
    """The deviation of the level two hours after the step of the inflow, in m."""
    return float(abs(_level(pid, A, F, [0, 7200])[-1]))


def flow_gain(pid, A, w):
    """How large a wave of the inflow comes out, in %; for one frequency or several."""
    controller = float(pid.Kp) * (1 - 1j / (float(pid.Ti) * w))
    return 100 * abs(controller / (1000j * float(A) * w - controller))


def largest_flow_gain(pid, A):
    """That of the worst wave, in %."""
    quick = float(abs(pid.Kp) / (1000 * A))
    return float(flow_gain(pid, A, quick * np.geomspace(1e-4, 1e3, 4001)).max())


def as_said(deviation):
    """A deviation of the level as one says it: what nobody can measure is less than a tenth of a millimetre."""
    return "less than 0.1 mm" if deviation < 0.0001 else (1000 * deviation, "mm")


def _drawn(pid, A, F, dh, period):
    """The level after the step of the inflow, and the wave of the inflow with what comes out of it."""
    times = np.linspace(0, max(18600 * float(A * dh / F), 3 * float(period)), 401)
    w = 2 * np.pi / float(period)
    waves = {"wave in": 100 * np.sin(w * times)}
    waves |= {"wave out, without its delay": flow_gain(pid, A, w) * np.sin(w * times)}
    limits = [(-float(dh), 2 * float(dh)), (-120, 220)]
    panels = [{"level": (_level(pid, A, F, times), "measurement")}, waves]
    plot = time_plot(panels, times, ylabel=["rise of the level [m]", "wave [%]"], ylim=limits)
    return plot.level(dh, "highest allowed", "level")


def buffer(controller, A, F, dh, period, gain):
    """Settings with which level and wave stay within what is demanded."""
    w = 2 * np.pi / float(period)
    return design(
        settings(controller, gain="kg/(s m)", time="s", what="the settings"),
        criterion("there is no derivative term", lambda pid: pid.Td == 0),
        criterion(
            "the loop is stable",
            lambda pid: pid.Kp < 0,
            otherwise="the loop is not stable: must more or less flow out when the level is too high, "
            "and where is $e$ then?",
        ),
        criterion("the rise of the level", lambda pid: rise_of_level(pid, A, F), below=float(dh), unit="m"),
        criterion("the flow gain at the wave's period", lambda pid: flow_gain(pid, A, w), below=float(gain), unit="%"),
        criterion("the largest flow gain", lambda pid: largest_flow_gain(pid, A), below=130, unit="%"),
        criterion("the deviation two hours later", lambda pid: away_later(pid, A, F), below=0.01, unit="m"),
        draws=lambda pid: _drawn(pid, A, F, dh, period),
    )
