"""Python beside the page of exercise 1.7."""

from functools import lru_cache

import numpy as np

from loopbook.figures import time_plot

SLOWEST, FASTEST, HEIGHT, FILLING = 20.0, 100.0, 4.0, 0.003


@lru_cache
def night(h_SP, u_0, Kp, t_load, size, outflow, fault):
    """Minutes, level and control signal; `size` is by how many percent the pump would have to change."""
    setpoint, start, missing = float(h_SP), float(u_0), float(size) if outflow == "larger" else -float(size)
    if fault == "at a limit":  # two or three percent more than the pump can give, or than it can be held back
        missing = (FASTEST - start if missing > 0 else SLOWEST - start) + 0.13 * missing
    gain = -float(Kp) if fault == "wrong action" else float(Kp)
    Ti = 25.0 if fault == "at a limit" else np.inf
    times = np.linspace(0, 180, 721)
    level, integral, h, u = setpoint, 0.0, [], []
    for now in times:
        error = 100 * (setpoint - level) / HEIGHT
        control = start + gain * (error + integral / Ti)
        limited = min(max(control, SLOWEST), FASTEST)
        integral += error * times[1] if control == limited else 0.0
        h.append(level)
        u.append(limited)
        balance = limited - start - (missing if now >= t_load else 0.0)
        level = min(max(level + FILLING * balance * times[1], 0.0), HEIGHT)
    return times, np.array(h), np.array(u)


def first_time(t, x, low, high):
    """When a signal is at one of its ends for the first time, if it ever is."""
    there = t[(x <= float(low)) | (x >= float(high))]
    return float(there[0]) if there.size else None


def settled(t, h):
    """When a level has done 99 % of its way to where it is at rest; None if it still moves at the end."""
    left = abs(h - h[-1]) / abs(h[-1] - h[0])
    return float(t[left < 0.01][0]) if left[-40] < 0.01 else None


def seen(t, h, u):
    """What the trend tells: when the level begins to move, what that says of the outflow, and what is wrong."""
    moved = h != h[0]
    rises = h[moved][0] > h[0]
    helps = (u[-1] < u[0]) == rises
    fault = "wrong action" if not helps else "at a limit" if u[-1] in (SLOWEST, FASTEST) else "no integral term"
    return [t[moved][0], "smaller" if rises else "larger", fault]


def picture(h_SP, t, h, u):
    """Level with its setpoint, and control signal: both rest at first, and then they move."""
    panels = [{"setpoint": (h_SP, "setpoint"), "$h$": (h, "measurement")}, {"$u$": (u, "control signal")}]
    axes = {"xlabel": "$t$ [min]", "ylabel": ["$h$ [m]", "$u$ [%]"], "ylim": [None, (10, 110)]}
    return time_plot(panels, t, "The water tower in the night", **axes)
