"""A plant with any transfer function."""

from __future__ import annotations

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, Quantity, signals
from loopbook.transfer import polynomials
from loopbook.types import TransferFunctionLike

__all__ = ["Process"]


class Process(Plant):
    """A plant with a given transfer function and a load at its input: y = H (u + d).

    Arguments:
        H: a strictly proper transfer function with numbers, an expression in `s`, with at most one dead time.
    Raises:
        ValueError: for letters in H, more than one dead time, or a numerator of the denominator's degree or more.

    >>> from loopbook import s
    >>> Process(3 * sympy.exp(-2 * s) / (4 * s + 1)).transfer_function("u")
    3*exp(-2*s)/(4*s + 1)
    """

    def __init__(self, H: TransferFunctionLike):
        above, below, delay = polynomials(H)
        above, below = ([c / below.LC() for c in polynomial.all_coeffs()] for polynomial in (above, below))
        order = len(below) - 1
        above = [0] * (order - len(above)) + above
        u, d, y, *x = signals("u d y " + " ".join(f"x_{n}" for n in range(1, order + 1)))
        # the observable canonical form: a chain of integrators that ends in the output
        driven = (u + d).subs(t, t - delay)
        rates = [b * driven - a * x[0] + x_n for a, b, x_n in zip(below[1:], above, [*x[1:], 0], strict=True)]
        self.model = (*(sympy.Eq(x_n.diff(t), rate) for x_n, rate in zip(x, rates, strict=True)), sympy.Eq(y, x[0]))
        self.output, self.manipulated = y, u
        inside = {x_n: Quantity(0, "", "inner state") for x_n in x}
        outside = {u: Quantity(0, "", "control signal"), d: Quantity(0, "", "load at the input")}
        self.quantities = outside | {y: Quantity(None, "", "output")} | inside
        super().__init__()
