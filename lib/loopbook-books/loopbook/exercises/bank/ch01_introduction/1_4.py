"""Python beside the page of exercise 1.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.expressions import t
from loopbook.figures import time_plot


def level_at(h, seconds):
    """The level at a moment."""
    return float(h.subs(t, seconds))


def picture(A, h_0, h_low, q, more):
    """A tank of {A} with the level {h_0}: a pump brings {q}, {q} are drawn, and a hydrant takes {more} besides."""
    layout = """
        water  pump  in    1     .     .      .
        .      .     .     tank  tank  .      .
        .      .     .     tank  tank  .      drawn
        .      .     .     tank  tank  valve  hydrant
        .      .     .     tank  tank  LAL    alarm"""
    parts = {"pump": draw.pump(), "valve": draw.valve(kind="hand")}
    parts["tank"] = draw.tank(f"${written(A)}$ m²", level=f"${written(h_0)}$ m", filled=0.9)
    names = {
        "in": f"${written(q)}$ L/s",
        "alarm": f"at ${written(h_low)}$ m",
        "drawn": f"${written(q)}$ L/s",
        "hydrant": f"${written(more)}$ L/s",
    }
    pipes = "water pump in 1 tank drawn, tank valve hydrant"
    return draw.instrumentation_diagram(layout, pipes, "tank LAL", parts, names)


def solution_picture(h, h_0, h_low, rate, seconds):
    """The level falls along a straight line, past the alarm, until the tank is empty."""
    times = np.linspace(0, float(h_0 / rate), 101)
    plot = time_plot({"$h$": (h, "measurement")}, times, ylabel="$h$ [m]")
    return plot.level(h_low, "alarm").mark(seconds, "the alarm")
