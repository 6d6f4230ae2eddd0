"""What several pages of chapter 17 need: Smith predictors."""

import numpy as np
from sympy import exp

from loopbook import closed_loop, diagrams, first_order, s
from loopbook.laplace import evaluate


def predictor(K, T, model, pid):
    """A PI controller with a lag, less the same lag behind the dead time of the model, fed back around it."""
    return closed_loop(pid, first_order(K, T) - first_order(K, T, model))


def predictor_diagram(K, T, delay):
    """Block diagram of the predictor: controller C, process, and the model with its dead time behind the model."""
    layout = """
        .     .  .  .  .  .  .  .  .  .
        y_SP  e  C  u  1  .  P  .  2  y
        .     .  .  .  3  G  4  D  m  .
        .     7  .  .  .  .  f  .  6  ."""
    wires = "y_SP e C u 1 P 2 y, 1 3 G 4 D - m, 2 m 6 f, 4 f 7 - e"
    blocks = {"C": "C", "G": first_order(K, T), "D": exp(-delay * s), "P": first_order(K, T) * exp(-delay * s)}
    return diagrams.grid_diagram(layout, wires, blocks)


def times_until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def is_step_response(y, H, end):
    """Whether a function of time is the response of a system to a unit step."""
    times = times_until(end)[1:-1]
    return np.allclose(evaluate(y, times), H.step(times), atol=1e-5)
