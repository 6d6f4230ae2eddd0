"""A plant with any transfer function."""

from __future__ import annotations

from fractions import Fraction

import sympy

from loopbook.plants.declarations import Quantity, delayed, signals
from loopbook.plants.plant import Plant
from loopbook.quasipolynomials import read
from loopbook.types import TransferFunctionLike
from plainmath.expressions import t

__all__ = ["Process"]


class Process(Plant):
    """A plant with a given transfer function and a load at its input: y = H (u + d).

    Its states are those of the observable canonical form, a chain of integrators that ends in the output. A dead time
    in the denominator of H, as behind a recycle, is one of the output within this chain.

    Arguments:
        H: a strictly proper transfer function with numbers, an expression in `s`, with dead times wherever they are.
    Raises:
        ValueError: for symbols in H, a numerator of the denominator's degree or more, or a highest derivative of the
            output that occurs with a dead time, as behind a jump that comes back forever.

    >>> from loopbook import s
    >>> Process(3 * sympy.exp(-2 * s) / (4 * s + 1)).transfer_function("u")
    3*exp(-2*s)/(4*s + 1)
    >>> for equation in Process(1 / (s + 2 - sympy.exp(-s))).model:
    ...     print(equation.lhs, "=", equation.rhs)
    Derivative(x_1(t), t) = d(t) + u(t) - 2*x_1(t) + x_1(t - 1)
    y(t) = x_1(t)
    """

    def __init__(self, H: TransferFunctionLike):
        H = read(H)
        order = H.order
        if not H.numerator:
            raise ValueError("the transfer function is 0: expected a process that its input moves")
        if any(delay and len(part) > order for delay, part in H.denominator.items()):
            raise ValueError(
                f"{H.expr} delays the highest power of s in its denominator: expected it without dead time"
            )
        if any(len(part) > order for part in H.numerator.values()):
            raise ValueError(f"{H.expr} is not strictly proper: expected fewer zeros than poles")
        u, d, y, *x = signals("u d y " + " ".join(f"x_{n}" for n in range(1, order + 1)))
        leading = H.denominator[Fraction(0)][order]

        def acting(parts, power, signal):
            """What the coefficient of a power of s, with its dead times, makes of a signal."""
            found = [
                sympy.Rational(part[power], leading)
                * delayed(signal, sympy.Rational(delay.numerator, delay.denominator))
                for delay, part in parts.items()
                if power < len(part)
            ]
            return sympy.Add(*found)

        rates = [
            acting(H.numerator, n, u + d) - acting(H.denominator, n, x[0]) + following
            for n, following in zip(reversed(range(order)), [*x[1:], 0], strict=True)
        ]
        self.measured, self.output, self.manipulated = {y: x[0]}, y, u
        self.model = (*(sympy.Eq(x_n.diff(t), rate) for x_n, rate in zip(x, rates, strict=True)), sympy.Eq(y, x[0]))
        inside = {x_n: Quantity(0, "", "inner state") for x_n in x}
        outside = {u: Quantity(0, "", "control signal"), d: Quantity(0, "", "load at the input")}
        self.quantities = outside | {y: Quantity(None, "", "output")} | inside
        super().__init__()
