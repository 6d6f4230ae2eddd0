"""Dead time as a fraction of polynomials: Taylor, Pade, and the repeated Pade approximation of first order."""

from __future__ import annotations

import sympy

from loopbook.laplace import without_delays
from loopbook.transfer import transfer_function
from loopbook.types import TransferFunctionLike
from plainmath.expressions import s
from plainmath.validation import whole


def taylor(H: TransferFunctionLike, order: int = 1, inverted: bool = False) -> sympy.Expr:
    """Return H with each dead time replaced by its Taylor polynomial: ``exp(-delay*s)`` becomes ``1 - delay*s + ...``

    Arguments:
        H: transfer function; dead times may stand anywhere.
        order: degree of the polynomial, at least 1.
        inverted: whether to expand ``exp(delay*s)`` below the fraction bar instead: ``1/(1 + delay*s + ...)``.
    Raises:
        ValueError: for another order, or what is no function of `s` and dead times.
    Source: Skogestad, slide on the half rule; Seborg et al., before equation (12-11).

    >>> taylor(sympy.exp(-3 * s)), taylor(sympy.exp(-3 * s), inverted=True)
    (1 - 3*s, 1/(3*s + 1))
    """
    sign, n = 1 if inverted else -1, whole("order", order)

    def polynomial(delay):
        return sum((sign * delay * s) ** k / sympy.factorial(k) for k in range(n + 1)) ** -sign

    return _without_dead_time(H, polynomial)


def pade(H: TransferFunctionLike, order: int = 1) -> sympy.Expr:
    """Return H with each dead time replaced by its Pade approximation, both polynomials of the same degree.

    It agrees with the Taylor series of the dead time up to the power ``2*order`` of `s`.

    Arguments:
        H: transfer function; dead times may stand anywhere.
        order: degree of numerator and denominator, at least 1.
    Raises:
        ValueError: as `taylor`.

    >>> pade(sympy.exp(-2 * s), order=2)
    (s**2/3 - s + 1)/(s**2/3 + s + 1)
    """
    n = whole("order", order)
    share = [sympy.binomial(n, k) / sympy.ff(2 * n, k) for k in range(n + 1)]

    def fraction(delay):
        above, below = (sum(c * (sign * delay * s) ** k for k, c in enumerate(share)) for sign in (-1, 1))
        return above / below

    return _without_dead_time(H, fraction)


def repeated_pade(H: TransferFunctionLike, order: int) -> sympy.Expr:
    """Return H with each dead time cut into equal parts and each part replaced by its first-order Pade approximation.

    It is ``exp(-delay*s) = ((1 - delay*s/(2*n))/(1 + delay*s/(2*n)))**n``, which agrees with the Taylor series up to
    the second power of `s` only, whatever n, but keeps all its zeros and poles real.

    Arguments:
        H: transfer function; dead times may stand anywhere.
        order: number n of parts, at least 1.
    Raises:
        ValueError: as `taylor`.
    Source: Skogestad, slide on the n-th order Pade approximation of a time delay.

    >>> repeated_pade(sympy.exp(-2 * s), order=2)
    (1 - s/2)**2/(s/2 + 1)**2
    """
    n = whole("order", order)
    return _without_dead_time(H, lambda delay: ((1 - delay * s / (2 * n)) / (1 + delay * s / (2 * n))) ** n)


def _without_dead_time(H, approximation):
    H = transfer_function(H)
    rational, delays = without_delays(H)
    shortest = [_shortest(part, delays) for part in sympy.fraction(sympy.together(rational))]
    if (shortest[0] - shortest[1]).is_negative:
        raise ValueError(f"{H} comes before its input: expected dead times exp(-delay*s) that are not negative")
    return rational.xreplace({symbol: approximation(delay) for symbol, delay in delays.items()})


def _shortest(part, delays):
    """The shortest dead time among the terms of a polynomial in symbols that stand for dead times."""
    powers = sympy.Poly(part, *delays).monoms() if delays else [()]
    return sympy.Min(*(sympy.Add(*(n * d for n, d in zip(term, delays.values(), strict=True))) for term in powers))
