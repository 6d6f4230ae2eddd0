"""Python beside the page of exercise 11.10."""

import numpy as np
from scipy.linalg import expm

from loopbook import diagrams
from loopbook.exercises.bank.ch11_control_structures.shared import lag
from loopbook.figures import time_plot


def picture(K_1, T_1, K_2, T_2):
    """The block diagram: the integral of the control error, minus both temperatures, each with its gain."""
    layout = """
        .     .  .         .    .  .    .       .  .     .  .
        y_SP  e  Integral  k_i  f  u    Jacket  1  Glue  2  x_1
        .     .  .         .    9  k_2  .       3  .     .  .
        .     .  .         .    7  k_1  .       .  .     4  .
        .     6  .         .    .  .    .       .  .     5  ."""
    wires = "y_SP e Integral k_i f u Jacket 1 Glue 2 x_1, 1 3 k_2 9 - f, 2 4 k_1 7 - f, 4 5 6 - e"
    blocks = {"Integral": r"\frac{1}{s}", "Jacket": lag(K_2, T_2), "Glue": lag(K_1, T_1)}
    return diagrams.grid_diagram(layout, wires, blocks | {name: name for name in ("k_i", "k_1", "k_2")})


def solution_picture(K_1, T_1, K_2, T_2, L, k_1, k_2, k_i):
    """The glue after a setpoint step and, later, a load at the valve, with these gains."""
    a, b, K_a, K_b, k_1, k_2, k_i = map(float, (T_1, T_2, K_1, K_2, k_1, k_2, k_i))
    A = np.array([[-1 / a, K_a / a, 0], [-K_b * k_1 / b, -(1 + K_b * k_2) / b, K_b * k_i / b], [-1, 0, 0]])
    times = np.linspace(0, 30 * float(L), 301)
    advance, x = expm(A * times[1]), np.zeros((times.size, 3))
    for k in range(1, times.size):
        at_rest = -np.linalg.solve(A, [0, 10 * K_b / b * (times[k] > 15 * float(L)), 1])  # a load of 10 % of the valve
        x[k] = at_rest + advance @ (x[k - 1] - at_rest)
    curves = {"setpoint": (1, "setpoint"), "glue": (x[:, 0], "measurement")}
    return time_plot(curves, times, ylabel="$x_1$ [K]").event(15 * float(L), "load")
