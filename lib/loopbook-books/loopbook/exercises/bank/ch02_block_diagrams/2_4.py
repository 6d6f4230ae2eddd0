"""Python beside the page of exercise 2.4."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.figures import time_plot


def pole(value):
    """A pole as a formula, in four digits."""
    value = complex(value)
    if not value.imag:
        return f"${value.real:.4g}$"
    return f"${value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j$"


def picture(m, D, K):
    """A sack of {m} on a platform, which stands on a spring of {K} and a damper of {D}."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, "F", standing=True)


def solution_picture(y_s, poles):
    """How far the platform is pressed down: its way to the position at rest."""
    p, q = map(complex, poles)
    times = np.linspace(0, 5 / min(-p.real, -q.real), 401)
    way = 1 + ((q * np.exp(p * times) - p * np.exp(q * times)) / (p - q)).real
    return time_plot({"$y$": (float(y_s) * way, "measurement")}, times, ylabel="$y$ [mm]").level(y_s, "at rest")
