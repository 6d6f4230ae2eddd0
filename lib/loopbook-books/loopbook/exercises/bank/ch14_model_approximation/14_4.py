"""The loops of exercise 14.4."""

from loopbook import PID, Loop, first_order
from loopbook.exercises.bank.ch14_model_approximation.shared import times_until
from loopbook.figures import time_plot


def solution_picture(g, T, theta, Ku):
    """The exact loop at the program's ultimate gain: its oscillation grows; the program shows one that stays."""
    times, processes = times_until(12 * theta), {"exact dead time": first_order(1, T, theta), "in the program": g}
    curves = {name: Loop(G, PID(Ku)).servo.step(times) for name, G in processes.items()}
    return time_plot(curves, times, "Both loops with the program's ultimate gain", ylabel="measurement")
