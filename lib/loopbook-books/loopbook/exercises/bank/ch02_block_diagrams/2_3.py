"""Python beside the page of exercise 2.3."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw


def motion(m, D, K, y_start, t):
    """Position and speed of the real mass at a moment."""
    from scipy.linalg import expm  # not before it is asked: a page of the site loads it then

    A = np.array([[0, 1], [-K / m, -D / m]], dtype=float)
    return (expm(A * float(t)) @ [float(y_start), 0]).tolist()


def picture(m, D, K, y_0):
    """A mass of {m} on a wall by a spring of {K} and a damper of {D}, still held {y_0} away from its rest."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, force="", position=f"$y(0) = {written(y_0)}$ cm")
