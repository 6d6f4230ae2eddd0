"""Python beside the page of exercise 12.7."""

import numpy as np

from loopbook.diagrams import sequential_function_chart
from loopbook.exercises.authoring import criterion, design, number
from loopbook.figures import time_plot
from loopbook.sequence import Chart

SCAN = 2  # s


def _stuck(limit, A, h_0, q_high, close):
    """Times, and the level if nobody notices that the tank is full, in m."""
    closes, close = float(limit) + SCAN, float(close)
    times = np.linspace(0, closes + 1.5 * close, 301)
    closing = np.clip((times - closes) / close, 0, 1)
    inflow = np.minimum(times, closes) + close * (closing - closing**2 / 2)
    return times, float(h_0) + float(q_high) * inflow / (1000 * float(A))


def highest(*givens):
    """The highest level if nobody notices that the tank is full, in m."""
    return _stuck(*givens)[1][-1]


def _trends(h_1, rim, *givens):
    """That level, with the rim and the level at which filling should end."""
    times, level = _stuck(*givens)
    curves = {"level, transmitter stuck": (level, "measurement"), "full": (float(h_1), "setpoint")}
    return time_plot(curves, times, ylabel="level [m]", low=True).level(rim, "rim")


def asked_limit(key, longest, A, h_0, h_1, rim, q_high, close):
    """A limit beyond normal filling with which the water stays below the rim."""
    return design(
        number(key, "s", "the limit"),
        criterion(
            "the longest normal filling takes at most 90 % of the limit",
            lambda x: float(longest) <= 0.9 * x * (1 + 1e-3),  # a limit that is rounded is right, too
            otherwise="with the weakest supply a normal filling takes more than 90 % of that limit",
        ),
        criterion("the highest level", lambda x: highest(x, A, h_0, q_high, close), below=float(rim), unit="m"),
        draws=lambda x: _trends(h_1, rim, x, A, h_0, q_high, close),
    )


def picture(h_1):
    """The chart: Fill is left at the full level to Heat, or after the limit to Alarm."""
    shut = {"u_valve": False}
    steps = {"Fill": {"u_valve": True}, "Heat": shut, "Alarm": shut}
    ways = [("Fill", "Heat", f"h > {float(h_1):g}"), ("Fill", "Alarm", "Fill.T > limit")]
    return sequential_function_chart(Chart(("h", "limit"), shut, steps, "Fill", ways, final="Heat Alarm"))
