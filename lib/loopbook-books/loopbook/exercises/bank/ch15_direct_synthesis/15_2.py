"""The loop of exercise 15.2."""

import numpy as np

from loopbook import PID, Loop, diagrams
from loopbook.figures import time_plot


def picture(process):
    """Block diagram: the setpoint, a controller, the load d added to its signal, the tank, and the level fed back."""
    forward = ["e", diagrams.block("Controller"), "u", diagrams.disturbance("d"), process]
    return diagrams.block_diagram("y_{SP}", diagrams.feedback_loop(forward), "y")


def solution_picture(process, gain, controller, total, load):
    """The level after the load with both controllers: with the gain alone it stays away, with the PI it returns."""
    times, both = np.linspace(0, float(12 * total), 401), {"gain alone": PID(gain), "with the lead": controller}
    curves = {name: float(load) * Loop(process, pid).regulator.step(times) for name, pid in both.items()}
    return time_plot(curves, times, "The level after the load", "$t$ [min]", "deviation [%]")
