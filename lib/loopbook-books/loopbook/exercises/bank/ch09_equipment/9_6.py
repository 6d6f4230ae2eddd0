"""Python beside the page of exercise 9.6."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.deadtime import Loop
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.stability import margins  # noqa: F401
from loopbook.transfer import dead_time


def picture(K, T, tau, K_p):
    """The loop: a PI controller with the gain {K_p} and the integral time {T}, and a process with the gain {K}, the
    time constant {T} and the dead time {tau}."""
    controller = draw.block(rf"{written(K_p)}\left(1+\frac{{1}}{{{written(T)}\,s}}\right)")
    process = draw.block(rf"\frac{{{written(K)}\,e^{{-{written(tau)}s}}}}{{{written(T)}\,s+1}}")
    return draw.block_diagram("y_SP", draw.feedback_loop(["e", controller, "u", process]), "y")


def solution_picture(K, T, tau, K_p, h):
    """The response to a setpoint step with a program that runs all the time, and with half a step more dead time."""
    times, steps = np.linspace(0, 15 * float(tau), 301), {"all the time": 0, f"every {float(h):g} s": h}
    loops = {name: Loop(K * K_p / (T * s) * dead_time(tau + step / 2), 1) for name, step in steps.items()}
    curves = {name: loop.servo.step(times) for name, loop in loops.items()}
    return time_plot({"setpoint": (1, "setpoint")} | curves, times, ylabel="pressure [%]", low=True)
