"""Python beside the page of exercise 2.3."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw


def motion(m, D, K, y_start, t):
    """Position and speed of the real mass at a moment."""
    m, D, K, y_start, t = map(float, (m, D, K, y_start, t))
    root = np.sqrt(complex(D**2 - 4 * m * K)) + 1e-9  # never zero
    p, q = (-D + root) / (2 * m), (-D - root) / (2 * m)
    y = y_start * (p * np.exp(q * t) - q * np.exp(p * t)) / (p - q)
    v = y_start * p * q * (np.exp(q * t) - np.exp(p * t)) / (p - q)
    return float(y.real), float(v.real)


def picture(m, D, K, y_0):
    """A mass of {m} on a wall by a spring of {K} and a damper of {D}, before it is let go {y_0} from its rest."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, force="", position=f"$y(0) = {written(y_0)}$ cm")
