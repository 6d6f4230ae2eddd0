"""The loop of exercise 18.2."""

import numpy as np

from loopbook import diagrams
from loopbook.deadtime import Loop
from loopbook.figures import time_plot
from loopbook.ise import ise
from loopbook.pid import PID
from loopbook.transfer import integrator

__all__ = ["integrator", "ise", "picture", "solution_picture"]


def picture(K):
    """Block diagram: setpoint, PI controller, the load d added to its signal, the tank, and the level fed back."""
    forward = ["e", diagrams.block("PI"), "u", diagrams.disturbance("d"), integrator(K)]
    return diagrams.block_diagram("y_{SP}", diagrams.feedback_loop(forward), "y")


def solution_picture(K, Kc, Ti):
    """The squared errors over time after the setpoint step and after the load step, each with its area shaded."""
    loop, times = Loop(integrator(K), PID(Kc, Ti)), np.linspace(0, 6 * float(Ti), 401)
    e, y = 1 - loop.servo.step(times), loop.regulator.step(times)
    panels = [{"setpoint": (e**2, 0)}, {"load": (y**2, 1)}]
    plot = time_plot(panels, times, "What the ISE adds up", "$t$ [min]", ["$e^2$, setpoint", "$e^2$, load"])
    return plot.area("setpoint").area("load")
