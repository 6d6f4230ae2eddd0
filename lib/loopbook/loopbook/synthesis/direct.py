"""Direct synthesis: the controller that gives a loop the response that is wanted, if there is one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import sympy

from loopbook.laplace import by_delay, roots, without_delays
from loopbook.transfer import simplified, transfer_function
from loopbook.types import TransferFunctionLike
from plainmath.expressions import s


def direct_synthesis(model: TransferFunctionLike, desired: TransferFunctionLike) -> sympy.Expr:
    """Return the controller that gives the loop with `model` the setpoint response `desired`.

    It is desired/(1 - desired)/model. Dead time stays exact: a desired response with dead time gives a controller that
    predicts, and `taylor` or `pade` makes a rational one of it.

    Arguments:
        model: transfer function of the process with all that stands in the loop.
        desired: transfer function from setpoint to measurement; 1 at s = 0 for a loop without offset.
    Returns:
        The controller, an expression in `s`.
    Raises:
        ValueError: where no controller can do it: the desired response is not stable or not proper, or faster than the
            dead time of the process, lacks a zero of the process in the right half-plane or on the imaginary axis, or
            leaves a pole there where it is; and for a desired response of 0 or 1. With symbols, what they leave open is
            not refused.
    Source: Seborg et al., equation (12-3b); Haugen, equation (10.10); Haugen on tuning, equation (7.88).

    >>> K, T, Tc = sympy.symbols("K T Tc", positive=True)
    >>> direct_synthesis(K / (T * s + 1), 1 / (Tc * s + 1))
    (T*s + 1)/(K*Tc*s)
    """
    G, wanted = transfer_function(model), transfer_function(desired)
    if G == 0:
        raise ValueError("the model is 0: expected a process that the controller can reach")
    if wanted == 0 or simplified(1 - wanted) == 0:
        raise ValueError(f"the desired response is {desired}: expected one that lags behind the setpoint")
    _refuse_impossible(G, wanted)
    return simplified(wanted / (G * (1 - wanted)))


def _refuse_impossible(G, desired):
    for p in _poles_outside(desired):
        raise ValueError(f"the desired response {desired} has a pole at {p}: expected a stable one")
    answers, wanted = by_delay(G), by_delay(desired)
    for part in wanted.values():
        above, below = sympy.cancel(part).as_numer_denom()
        if sympy.degree(above, s) > sympy.degree(below, s):
            raise ValueError(f"the desired response {desired} has more zeros than poles: expected at most as many")
    if any(all((delay - d).is_negative for d in answers) for delay in wanted):
        raise ValueError(
            f"the desired response {desired} comes before the process {G} can answer: "
            f"expected at least the dead time of the process in it"
        )
    if len(answers) == 1:  # zeros of a sum of dead times are not known
        for p in _poles_outside(desired / G):
            raise ValueError(f"the process {G} has a zero at {p}: expected a desired response with that zero")
    for p, n in Counter(_poles_outside(G)).items():
        if _zeros_at(p, 1 - desired, n) < n:
            how = "1 there" if n == 1 else f"1 there, and flat up to its derivative {n - 1}"
            raise ValueError(f"the process {G} has a pole at {p}: expected a desired response that is {how}")


def _poles_outside(H):
    """The known poles that are known not to be in the left half-plane, each as often as it occurs."""
    by_delay(H)  # refuses a dead time in a denominator
    rational, delays = without_delays(H)
    above, below = sympy.fraction(sympy.cancel(rational))
    above = above.xreplace({symbol: sympy.exp(-delay * s) for symbol, delay in delays.items()})
    for p, n in Counter(known_roots(below)).items():
        if sympy.re(p).is_nonnegative:  # dead times may leave no pole, as in (1 - exp(-s))/s
            yield from (n - (_zeros_at(p, above, n) if delays else 0)) * [p]


def _zeros_at(p, f, most):
    """How many zeros f(s) has at p, of the first `most`."""
    for n in range(most):
        left = sympy.simplify(sympy.diff(f, s, n).subs(s, p))
        if abs(left.evalf()) > 1e-9 if left.has(sympy.Float) else left != 0:
            return n
    return most


def known_roots(polynomial: sympy.Expr | sympy.Poly) -> Iterator[sympy.Expr]:
    """The roots of the factors whose roots are known: symbols may stand in a factor of high degree."""
    for factor, n in sympy.Poly(polynomial, s).factor_list()[1]:
        if factor.degree() == 1:
            yield from n * [-factor.eval(0) / factor.LC()]
        elif factor.degree() == 2 or not factor.free_symbols_in_domain:
            yield from n * roots(factor.as_expr())
