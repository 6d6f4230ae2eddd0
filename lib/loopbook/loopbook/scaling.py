"""Scaling: the linear functions between engineering units, electrical signals and percent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import sympy

from loopbook.types import Number
from plainmath.expressions import exact
from plainmath.latex import latex
from plainmath.validation import is_number

__all__ = ["PERCENT", "Scaling"]

PERCENT = (0, 100)


class Scaling:
    """The linear function z = a x + b that maps one range onto another. (Haugen, equations 7.2 to 7.5)

    Arguments:
        x_range, z_range: (lowest, highest) before and after the scaling, each in its unit.

    Attributes:
        a: the slope, in units of z for one unit of x.
        b: the value of z where x is zero.

    Raises:
        ValueError: for a range that is not two different finite numbers.

    >>> f_5 = Scaling(PERCENT, (4, 20))    # control signal in %, current in mA
    >>> f_5.a, f_5.b, f_5(50)
    (4/25, 4, 12)
    >>> f_5.inverse(8)
    25
    """

    x_range: tuple[sympy.Expr, sympy.Expr]
    z_range: tuple[sympy.Expr, sympy.Expr]
    a: sympy.Expr
    b: sympy.Expr

    def __init__(self, x_range: Sequence[Number], z_range: Sequence[Number]):
        (x_min, x_max), (z_min, z_max) = self.x_range, self.z_range = _ends(x_range), _ends(z_range)
        self.a = (z_max - z_min) / (x_max - x_min)
        self.b = z_min - self.a * x_min

    def __call__(self, x: Number | np.ndarray) -> Any:
        """Return a x + b for a number, an expression or an array."""
        if hasattr(x, "dtype") or isinstance(x, float):
            return float(self.a) * x + float(self.b)
        return self.a * exact(x) + self.b

    @property
    def inverse(self) -> Scaling:
        """The scaling back from z to x."""
        return Scaling(self.z_range, self.x_range)

    def then(self, following: Scaling) -> Scaling:
        """Return the combined scaling of this one and a following one. (f_3 of Haugen, Figure 7.1)

        >>> sensor, percent = Scaling((0, 15), (4, 20)), Scaling((4, 20), PERCENT)
        >>> sensor.then(percent).a
        20/3
        """
        return Scaling(self.x_range, tuple(following(z) for z in self.z_range))

    def of_differences(self) -> Scaling:
        """Return the scaling without its offset, for differences such as the control error. (f_6 of Figure 7.1)

        >>> Scaling(PERCENT, (4, 20)).of_differences()(50)
        8
        """
        return Scaling((0, self.x_range[1] - self.x_range[0]), (0, self.z_range[1] - self.z_range[0]))

    def __repr__(self) -> str:
        return f"Scaling({self.x_range}, {self.z_range})"

    def _repr_latex_(self):
        return f"$z = {latex(self.a * sympy.Symbol('x') + self.b)}$"


def _ends(given):
    try:
        low, high = map(exact, given)
    except (TypeError, ValueError):
        raise ValueError(f"the range is {given!r}: expected its lowest and highest number") from None
    if low == high or not (is_number(low) and is_number(high)):
        raise ValueError(f"the range is {given!r}: expected two different finite numbers")
    return low, high
