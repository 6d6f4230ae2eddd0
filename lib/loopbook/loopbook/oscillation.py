"""Oscillation: what damping and natural period say about a step response and about a pair of poles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy

from loopbook.laplace import by_delay
from loopbook.transfer import transfer_function
from loopbook.types import Number, TransferFunctionLike
from plainmath.expressions import exact, s
from plainmath.validation import exact_positive, exact_real

__all__ = ["Oscillation", "oscillation", "oscillation_of_pole"]


@dataclass(frozen=True)
class Oscillation:
    """A denominator of second order, ``T**2*s**2 + 2*zeta*T*s + 1``. It oscillates for zeta between -1 and 1.

    Arguments:
        T: natural period over ``2*pi``, positive, in the unit of time.
        zeta: relative damping.
    Raises:
        ValueError: for a T that is not positive, or a zeta that is not real; and by the properties for a system that
            does not oscillate.
    Source: Seborg et al., equations (5-50) to (5-53), on Skogestad's slides.

    >>> Oscillation(T=1, zeta=0.6).overshoot.evalf(4)
    0.09478
    """

    T: sympy.Expr
    zeta: sympy.Expr

    if TYPE_CHECKING:  # numbers of any kind are given, and kept as exact ones

        def __init__(self, T: Number, zeta: Number): ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "T", exact_positive("T", self.T))
        object.__setattr__(self, "zeta", exact_real("zeta", self.zeta))

    @property
    def peak_time(self) -> sympy.Expr:
        """The time from the step to the first peak, for a system without zeros. (5-50)"""
        return sympy.pi * self.T / self._root

    @property
    def overshoot(self) -> sympy.Expr:
        """The share of the step by which its first peak exceeds the final value, without zeros. (5-51)"""
        return sympy.exp(-sympy.pi * self.zeta / self._root)

    @property
    def decay_ratio(self) -> sympy.Expr:
        """The size of an oscillation divided by that of the one before. (5-52)"""
        return self.overshoot**2

    @property
    def period(self) -> sympy.Expr:
        """The time between two peaks. (5-53)"""
        return 2 * sympy.pi * self.T / self._root

    @property
    def _root(self):
        if (1 - self.zeta**2).is_positive is False:
            raise ValueError(f"zeta is {self.zeta}: expected one between -1 and 1, because others do not oscillate")
        return sympy.sqrt(1 - self.zeta**2)

    def __repr__(self) -> str:
        return f"Oscillation(T={self.T}, zeta={self.zeta})"


def oscillation(H: TransferFunctionLike) -> Oscillation:
    """Return the `Oscillation` of a transfer function of second order, whatever its numerator.

    Arguments:
        H: transfer function with two poles, the product of which is positive; a dead time does not matter.
    Raises:
        ValueError: for another order, or poles on both sides of the imaginary axis or at the origin.

    >>> oscillation(3 / (4 * s**2 + s + 1))
    Oscillation(T=2, zeta=1/4)
    """
    H = transfer_function(H)
    parts = by_delay(H)
    if len(parts) != 1:
        raise ValueError(f"{H} {'adds several dead times' if H != 0 else 'is zero'}: expected one dead time or none")
    (rational,) = parts.values()
    coefficients = sympy.Poly(sympy.cancel(rational).as_numer_denom()[1], s).all_coeffs()
    if len(coefficients) != 3 or coefficients[2] == 0 or (coefficients[0] / coefficients[2]).is_negative:
        raise ValueError(f"{H} has no denominator T**2*s**2 + 2*zeta*T*s + 1: expected two poles of one sign")
    square, double = (sympy.cancel(c / coefficients[2]) for c in coefficients[:2])
    T = sympy.sqrt(square)
    return Oscillation(T, sympy.simplify(double / (2 * T)))


def oscillation_of_pole(pole: Number | complex) -> Oscillation:
    """Return the `Oscillation` of a pole and its conjugate.

    >>> oscillation_of_pole(complex(-0.6, 0.8))
    Oscillation(T=1, zeta=3/5)
    """
    pole = exact(pole)
    size = sympy.Abs(pole)
    if size == 0 or pole.is_finite is False:
        raise ValueError(f"the pole is {pole}: expected a finite one that is not at the origin")
    return Oscillation(1 / size, -sympy.re(pole) / size)
