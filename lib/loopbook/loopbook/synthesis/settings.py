"""PID settings of a controller: exact where it is a PID controller, and otherwise the first terms of its series."""

from __future__ import annotations

from dataclasses import dataclass

import sympy

from loopbook.approximation import taylor
from loopbook.laplace import without_delays
from loopbook.pid import PID
from loopbook.transfer import simplified, transfer_function
from loopbook.types import TransferFunctionLike
from plainmath.expressions import s
from plainmath.validation import one_of

KINDS = ("P", "PI", "PID", "PID with filter")


@dataclass(frozen=True)
class Match:
    """A controller read as a PID controller.

    Attributes:
        controller: the controller itself, an expression in `s`.
        settings: the `PID`.
        exact: whether both are the same; otherwise the settings are the first terms of a series around s = 0, which
            agree at low frequencies.
    """

    controller: sympy.Expr
    settings: PID
    exact: bool

    def _repr_latex_(self):
        return f"{self.settings._repr_latex_()}, {'exact' if self.exact else 'the first terms of a series'}"

    @property
    def rest(self) -> sympy.Expr:
        """What the PID controller lacks, an expression in `s`: 0 for an exact match."""
        return sympy.S.Zero if self.exact else simplified(self.controller - self.settings.expr)


def as_pid(controller: TransferFunctionLike, kind: str | None = None) -> Match:
    """Read a controller as a PID controller, exactly if it is one, and otherwise by its series around s = 0.

    The series ``c[-1]/s + c[0] + c[1]*s + ...`` is that of ``Kp*(1 + 1/(Ti*s) + Td*s)``, for a PID with filter
    ``Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1))``.

    Arguments:
        controller: an expression in `s`; dead times may stand anywhere in it.
        kind: "P", "PI", "PID" or "PID with filter", to keep no more than that; without it, the controller that matches
            exactly, or else a PID, or a PI where the derivative time would be negative.
    Returns:
        A `Match`. The form is serial where only that is exact, as for a PI controller behind a lag.
    Raises:
        ValueError: for a controller that is not a PID controller even at low frequencies: with two integrators, without
            proportional part, or whose series gives times that are negative. With symbols, signs that they leave open
            are not refused.
    Source: Seborg et al., Table 12.1, where the rows K and L are such series.

    >>> as_pid((2 * s + 1) * (5 * s + 1) / (4 * s)).settings
    PID(Kp=7/4, Ti=7, Td=10/7)
    >>> match = as_pid(1 / (1 - sympy.exp(-2 * s)), "PI")
    >>> match.settings, match.exact
    (PID(Kp=1/2, Ti=1), False)
    """
    if kind is not None:
        one_of("kind", kind, KINDS)
    C = transfer_function(controller)
    without_delays(C)  # refuses what is neither rational nor a dead time
    settings = _exactly(C)
    if settings is not None and (kind is None or KINDS.index(_kind(settings)) <= KINDS.index(kind)):
        return Match(C, settings, exact=True)
    return Match(C, _by_series(C, kind), exact=False)


def _kind(settings):
    if settings.Tf != 0:
        return "PID with filter"
    return "PID" if settings.Td != 0 else "P" if sympy.oo == settings.Ti else "PI"


def _exactly(C):
    """The settings of ``C = (n2*s**2 + n1*s + n0)/(s*(Tf*s + 1))``, or None where C is something else."""
    if any(factor.has(s) for factor in C.atoms(sympy.exp)):
        return None
    above, below, field = _coefficients(*sympy.fraction(sympy.together(C)))
    if below[0]:
        above = [field.zero, *above]  # s above and below the fraction bar
    else:
        below = below[1:]
    if len(below) > 2 or len(above) > 3 or not below[0]:
        return None
    n0, n1, n2 = (c / below[0] for c in [*above, field.zero, field.zero][:3])
    Tf = below[1] / below[0] if len(below) > 1 else field.zero
    if field.to_sympy(Tf).is_negative:
        return None
    try:
        return _pid(field, n0, n1 - n0 * Tf, n2 - n1 * Tf + n0 * Tf**2, Tf)
    except ValueError:
        pass
    try:
        return _serial_pid(*(_written(field, x) for x in (n0, n1, n2, Tf)))
    except ValueError:
        return None


def _serial_pid(n0, n1, n2, Tf):
    """The serial settings of ``(n2*s**2 + n1*s + n0)/(s*(Tf*s + 1))``, or None; ValueError for negative times."""
    if n1 == 0:
        return None
    if n0 == 0:
        return PID(n1, Td=n2 / n1, Tf=Tf, form="serial")
    difference = sympy.sqrt(sympy.factor((n1 / n0) ** 2 - 4 * n2 / n0))
    if not difference.is_real:
        return None
    Ti, Td = ((n1 / n0 + sign * difference) / 2 for sign in (1, -1))
    return PID(n0 * Ti, Ti, Td, Tf, form="serial")


def _coefficients(above, below, cancelled=True):
    """The coefficients of two polynomials from the lowest power of s, without their common factors, in a field.

    In a field of fractions, sums and products cancel at once, which is quick even with many symbols.
    """
    above, below = sympy.Poly(above, s), sympy.Poly(below, s)
    field = above.domain.unify(below.domain).get_field()
    if cancelled:
        above, below = above.set_domain(field).cancel(below.set_domain(field), include=True)
    return *(polynomial.set_domain(field).rep.to_list()[::-1] for polynomial in (above, below)), field


def _written(field, element):
    """An element of a field as an expression, factored."""
    parts = []
    for part in sympy.fraction(field.to_sympy(element)):
        symbols = sorted(part.free_symbols, key=str)
        if symbols and part.is_polynomial(*symbols):
            content, factors = sympy.Poly(part, *symbols).factor_list()
            part = content * sympy.Mul(*(factor.as_expr() ** n for factor, n in factors))
        parts.append(part)
    return parts[0] / parts[1]


def _pid(field, integral, proportional, derivative, Tf):
    """The settings of ``integral/s + proportional + derivative*s/(Tf*s + 1)``; ValueError where there are none."""
    if not proportional:
        raise ValueError("it has no proportional part")
    Ti = _written(field, proportional / integral) if integral else sympy.oo
    Td = _written(field, derivative / proportional)
    return PID(_written(field, proportional), Ti, Td, _written(field, Tf) if derivative else 0)


def _by_series(C, kind):
    (integral, proportional, derivative, second), field = _series(C)
    zero = Tf = field.zero
    falling = field.to_sympy(derivative / proportional if proportional else derivative).is_negative
    if kind == "P":
        integral = zero
    if kind in ("P", "PI") or (kind is None and falling):
        derivative = zero
    elif kind == "PID with filter" and derivative:
        Tf = -second / derivative  # of derivative*s/(Tf*s + 1), the next term is -Tf*derivative*s**2
    try:
        return _pid(field, integral, proportional, derivative, Tf)
    except ValueError as error:
        raise ValueError(f"{C} is no {kind or 'PID'} controller at low frequencies: {error}") from None


def _series(C):
    """The coefficients of 1/s, 1, s and ``s**2`` in the series of C around s = 0, and the field they are in."""
    rational, delays = without_delays(C)
    dead_times = {symbol: sympy.exp(-delay * s) for symbol, delay in delays.items()}
    parts = [part.xreplace(dead_times) for part in sympy.fraction(sympy.together(rational))]
    for order in (8, 16, 32):  # powers of s may cancel, and those beyond the order are wrong
        above, below, field = _coefficients(*(taylor(part, order) for part in parts), cancelled=False)
        first_above, first_below = (next((k for k, c in enumerate(x) if c), order) for x in (above, below))
        if max(first_above, first_below) + 3 <= order or not delays:
            break
    else:
        raise ValueError(f"{C} has no series to read a controller off: more than 29 powers of s cancel")
    lowest = first_above - first_below
    if lowest < -1:
        raise ValueError(f"{C} grows faster than 1/s at low frequencies: expected at most one integrator")
    above, below = ([*x[first:], *[field.zero] * 4] for x, first in ((above, first_above), (below, first_below)))
    found = []
    for k in range(4):
        found.append((above[k] - sum((found[i] * below[k - i] for i in range(k)), field.zero)) / below[0])
    return ([field.zero] * (lowest + 1) + found)[:4], field
