"""Python beside the page of exercise 1.7."""

from functools import lru_cache
from types import SimpleNamespace

import numpy as np

from loopbook.exercises import authoring
from loopbook.figures import time_plot

_NIGHT = np.linspace(0, 180, 721)
_SLOWEST, _FASTEST, _HEIGHT, _FILLING = 20.0, 100.0, 4.0, 0.003


def times():
    """The minutes of the night."""
    return _NIGHT


@lru_cache
def night(h_SP, u_0, Kp, t_load, size, outflow, fault):
    """Level and control signal of a water tower; `size` is by how many percent the pump would have to go up or down."""
    setpoint, start, gain = float(h_SP), float(u_0), float(Kp)
    missing = float(size) if outflow == "larger" else -float(size)
    if fault == "at a limit":  # two or three percent more than the pump can give, or than it can be held back
        missing = (_FASTEST - start if missing > 0 else _SLOWEST - start) + 0.13 * missing
    time_of_integration = 25.0 if fault == "at a limit" else np.inf
    sign = -1 if fault == "wrong action" else 1
    level, integral, h, u = setpoint, 0.0, [], []
    step = _NIGHT[1] - _NIGHT[0]
    for now in _NIGHT:
        error = 100 * (setpoint - level) / _HEIGHT
        control = start + sign * gain * (error + integral / time_of_integration)
        limited = min(max(control, _SLOWEST), _FASTEST)
        integral += error * step if control == limited else 0.0
        h.append(level)
        u.append(limited)
        balance = limited - start - (missing if now >= t_load else 0.0)
        level = min(max(level + _FILLING * balance * step, 0.0), _HEIGHT)
    return np.array(h), np.array(u)


def first_time(x, low, high):
    """When a signal is at one of its ends for the first time; 0 if it never is."""
    there = _NIGHT[(x <= float(low)) | (x >= float(high))]
    return float(there[0]) if there.size else 0


def seen(h, u):
    """What the trend tells: when the level begins to move, which way, and where the control signal ends."""
    moved = h != h[0]
    way = np.sign(h[moved][0] - h[0])
    against = (u[-1] - u[0]) * way < 0
    fault = "wrong action" if not against else "at a limit" if u[-1] in (_SLOWEST, _FASTEST) else "no integral term"
    return SimpleNamespace(moment=_NIGHT[moved][0], outflow="smaller" if way > 0 else "larger", fault=fault)


def moment(key, what):
    """A moment that is read off the picture."""
    return authoring.number(key, "min", what, within=0.06)


def choice_of(key, among, what):
    """One of some words."""
    return authoring.word(key, among, what)


def picture(h_SP, h, u):
    """Level with its setpoint, and control signal: both rest at first, and then they move."""
    panels = [{"setpoint": (h_SP, "setpoint"), "$h$": (h, "measurement")}, {"$u$": (u, "control signal")}]
    names, ranges = ["$h$ [m]", "$u$ [%]"], [None, (10, 110)]
    title = "The water tower in the night"
    return time_plot(panels, _NIGHT, title, xlabel="$t$ [min]", ylabel=names, ylim=ranges)
