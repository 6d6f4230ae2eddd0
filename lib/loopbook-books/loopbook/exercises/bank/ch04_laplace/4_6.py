"""Python beside the page of exercise 4.6."""

import numpy as np
from sympy import Heaviside

from exercisebook.parameters import written
from loopbook.expressions import t
from loopbook.figures import time_plot


def picture(full):
    """The power against time: $u_1$ = {full} from t = 0 to $t_1$, and from then on a lower one, $u_2$; this is not to
    scale."""
    power = {"$u$": (float(full) * (1 - 0.45 * Heaviside(t - 1)), "control signal")}
    plot = time_plot(power, np.linspace(0, 2.5, 251), ylim=(0, 1.3 * float(full)), xlabel="$t$", low=True)
    axes = plot.figure.axes[0]
    axes.set_xticks([0, 1], ["0", "$t_1$"])
    axes.set_yticks([0, 0.55 * float(full), float(full)], ["0", "$u_2$", f"$u_1$ = {written(full)} kW"])
    return plot
