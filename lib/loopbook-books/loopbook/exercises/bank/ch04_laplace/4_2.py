"""Python beside the page of exercise 4.2."""

import numpy as np
from sympy import Heaviside

from exercisebook.parameters import written
from loopbook.expressions import t
from loopbook.figures import time_plot


def picture(q, begin, end):
    """The flow of the dye: zero at first, {q} from {begin} on for {duration}, and zero again."""
    flow = q * (Heaviside(t - begin) - Heaviside(t - end))
    times = np.linspace(0, 1.25 * float(end), 201)
    plot = time_plot({"$q(t)$": (flow, "control signal")}, times, "The flow of the dye", ylabel="$q$ [mL/s]", low=True)
    return plot.level(q, f"{written(q)} mL/s")
