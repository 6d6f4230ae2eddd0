"""The predictor of exercise 17.3."""

import numpy as np

from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor, predictor_diagram
from loopbook.expressions import s
from loopbook.transfer import first_order

__all__ = ["are_equal", "first_order", "picture", "smith", "written"]

smith = predictor


def are_equal(one, other):
    """Whether two transfer functions have the same values."""
    return all(np.isclose(complex(one.subs(s, jw)), complex(other.subs(s, jw))) for jw in (0.02j, 0.3j, 0.1 + 0.1j))


def written(*poles):
    """Poles in words."""

    def one(pole):
        size = f"{pole.real:.4g}"
        return f"{size} {'-' if pole.imag < 0 else '+'} {abs(pole.imag):.4g}j" if pole.imag else size

    return " and ".join(one(complex(pole)) for pole in poles)


def picture(K, T, delay):
    """Block diagram of the predictor: controller C, process, and the model with its dead time behind the model."""
    return predictor_diagram(K, T, delay)
