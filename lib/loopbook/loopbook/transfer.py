"""Transfer functions: SymPy expressions in `s`, with dead time as ``exp(-delay*s)``.

The standard models of process control, what characterises a transfer function (poles, zeros, order, gains, its two
written forms), the rules for combining blocks, and the responses to known inputs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from loopbook.laplace import (
    by_delay,
    evaluate,
    final_value,
    inverse,
    roots,
    solve_transformed,
    transform,
    transformed,
    without_delays,
    zero_between,
)
from loopbook.types import Number, TransferFunctionLike
from plainmath.expressions import exact, function_of, s, t
from plainmath.validation import exact_not_negative, exact_real, known_arguments, number

__all__ = [
    "characteristic_polynomial", "dead_time", "double_integrator", "feedback", "first_order", "impulse_response",
    "initial_gain", "initial_slope", "integrator", "integrator_with_lag", "order", "parallel", "poles", "polynomials",
    "response", "response_time", "second_order", "series", "simplified", "static_gain", "step_response",
    "time_constant_form", "transfer_function", "transfer_functions", "zero_pole_form", "zero_pole_gain", "zeros",
]  # fmt: skip


# ------------------------------------------------------------------------------------------------ standard models


@known_arguments
def dead_time(delay: Number) -> sympy.Expr:
    """Return the transfer function of a pure dead time, ``exp(-delay*s)``. (Haugen, equation 6.32)

    Raises ValueError for a negative delay.

    >>> dead_time(3)
    exp(-3*s)
    """
    return sympy.exp(-exact_not_negative("delay", delay) * s)


@known_arguments
def integrator(K: Number, delay: Number = 0) -> sympy.Expr:
    """Return K/s, with the dead time `delay` if there is one. (Haugen, equation 6.4)

    >>> integrator(2)
    2/s
    """
    return exact_real("K", K) / s * dead_time(delay)


@known_arguments
def first_order(K: Number, T: Number, delay: Number = 0) -> sympy.Expr:
    """Return ``K/(T*s + 1)``, a lag (time constant system) with gain K and dead time `delay`. (Haugen, equation 6.13)

    Arguments:
        K: gain, in units of the output for one unit of the input.
        T, delay: lag and dead time in one unit of time, not negative.
    Raises:
        ValueError: for a negative lag or delay.

    >>> first_order(2, 5, delay=1)
    2*exp(-s)/(5*s + 1)
    """
    return exact_real("K", K) / (exact_not_negative("T", T) * s + 1) * dead_time(delay)


@known_arguments
def second_order(K: Number, T1: Number, T2: Number, delay: Number = 0) -> sympy.Expr:
    """Return ``K/((T1*s + 1)*(T2*s + 1))``, two lags in series. (Haugen, equation 6.33)

    >>> second_order(1, 3, 2)
    1/((2*s + 1)*(3*s + 1))
    """
    return first_order(K, T1, delay) / (exact_not_negative("T2", T2) * s + 1)


@known_arguments
def integrator_with_lag(K: Number, T: Number, delay: Number = 0) -> sympy.Expr:
    """Return ``K/(s*(T*s + 1))``, an integrator behind a lag.

    >>> integrator_with_lag(1, 4)
    1/(s*(4*s + 1))
    """
    return first_order(K, T, delay) / s


@known_arguments
def double_integrator(K: Number, delay: Number = 0) -> sympy.Expr:
    """Return ``K/s**2``.

    >>> double_integrator(3)
    3/s**2
    """
    return integrator(K, delay) / s


def transfer_functions(
    equations: sympy.Equality | Sequence[sympy.Equality], output: sympy.Expr, inputs: sympy.Expr | Sequence[sympy.Expr]
) -> tuple[sympy.Expr, ...]:
    """Derive the transfer functions from the inputs to an output out of linear differential equations.

    The equations are transformed and solved for the output. Each input's transfer function is what it is multiplied
    with there; initial values and constants contribute terms of their own, which are left out.

    Arguments:
        equations: one equation or a list of them, in functions of `t`.
        output: the output signal, as ``y(t)``.
        inputs: the input signals, as ``[u_1(t), u_2(t)]``, or the only one. Every other function of t is an unknown.
    Returns:
        A tuple of transfer functions, expressions in `s`, one for each input.
    Raises:
        ValueError: if the equations are not linear, do not determine the output, or lack a signal.
    Source: Haugen, Section 5.2, equations (5.1)-(5.11).

    >>> y, u, v = (sympy.Function(name) for name in "yuv")
    >>> transfer_functions(sympy.Eq(2 * y(t).diff(t) + y(t), 3 * u(t) - v(t)), y(t), [u(t), v(t)])
    (3/(2*s + 1), -1/(2*s + 1))
    """
    equations, inputs = (list(x) if isinstance(x, (list, tuple)) else [x] for x in (equations, inputs))
    transformed(equations)
    # y(0) is a number, but u(theta) under an integral is the signal u
    signals = {f.func(t) for equation in equations for f in equation.atoms(AppliedUndef) if f.free_symbols}
    for signal in (output, *inputs):
        if signal not in signals:
            raise ValueError(f"{signal} does not occur in the equations: expected one of {_listed(signals)}")
    unknowns = sorted(signals - set(inputs), key=str)
    if output not in unknowns:
        raise ValueError(f"{output} is both an output and an input: expected it to be one of the two")
    if len(unknowns) != len(equations):
        raise ValueError(
            f"{len(equations)} equation(s) for {_listed(unknowns)}: expected one equation for each signal "
            f"that is not an input"
        )
    solved = sympy.expand(solve_transformed(equations, unknowns)[unknowns.index(output)])
    return tuple(simplified(solved.coeff(transform(signal))) for signal in inputs)


def _listed(signals):
    return ", ".join(sorted(map(str, signals)))


def transfer_function(value: TransferFunctionLike) -> sympy.Expr:
    """Return the transfer function of whatever stands for a block, an expression in `s` with exact numbers.

    Arguments:
        value: an expression in `s` or a number; whatever has one as its attribute `expr`, as a `PID`, an `SOPDT` and a
            `System`; or a continuous single-input single-output system of python-control.
    Raises:
        ValueError: for anything else.

    >>> import control
    >>> transfer_function(control.tf([2], [10, 1]))
    2/(10*s + 1)
    """
    if str(type(value).__module__).split(".")[0] == "control":  # None for a function as G(s)
        return _from_control(value)
    return function_of(s, value if isinstance(value, sympy.Basic) else getattr(value, "expr", value))


def _from_control(system):
    import control

    if not isinstance(system, (control.TransferFunction, control.StateSpace)):
        raise ValueError(f"{system!r} is neither a transfer function nor a state-space system of python-control")
    if system.ninputs != 1 or system.noutputs != 1:
        raise ValueError(f"the system has {system.ninputs} inputs and {system.noutputs} outputs: expected one of each")
    if system.isdtime(strict=True):
        raise ValueError(f"the system works in discrete time, with the period {system.dt}: expected continuous time")
    names = ("num", "den") if isinstance(system, control.TransferFunction) else ("A", "B", "C", "D")
    for name in names:
        coefficients = getattr(system, name)
        if np.iscomplexobj(coefficients[0][0] if name in ("num", "den") else coefficients):
            raise ValueError(f"{name} of the system is complex: expected real coefficients")
    if isinstance(system, control.TransferFunction):
        above, below = (sympy.Poly([exact(float(c)) for c in x[0][0]], s) for x in (system.num, system.den))
        return above.as_expr() / below.as_expr()
    A, B, C, D = (
        sympy.Matrix([[exact(float(c)) for c in row] for row in x]) for x in (system.A, system.B, system.C, system.D)
    )
    if not system.nstates:
        return D[0]
    # det(sI - A + BC) - det(sI - A) = C adj(sI - A) B
    own, through = (M.to_DM().convert_to(sympy.QQ).charpoly() for M in (A, A - B * C))
    own, through = (sympy.Poly(coefficients, s, domain="QQ") for coefficients in (own, through))
    return D[0] + (through - own).as_expr() / own.as_expr()


# ------------------------------------------------------------------------------------------------ blocks


def simplified(H: TransferFunctionLike) -> sympy.Expr:
    """Return H with common factors cancelled and the rest factored.

    >>> simplified((s + 1) / (s**2 + 3 * s + 2))
    1/(s + 2)
    """
    H = transfer_function(H)
    if H.has(sympy.oo, sympy.zoo):
        raise ValueError(f"{H} is infinite: expected a transfer function")
    try:
        rational, delays = without_delays(H)
    except ValueError:  # with a block that is not known, as G(s)
        return sympy.factor(sympy.cancel(H))
    try:
        parts = by_delay(H)
    except ValueError:  # with a dead time in a denominator, as in a loop around one
        dead_times = {symbol: sympy.exp(-delay * s) for symbol, delay in delays.items()}
        return sympy.factor(sympy.cancel(rational)).xreplace(dead_times)
    # put together first, or `cancel` multiplies out what the terms have in common
    parts = {delay: sympy.factor(sympy.cancel(sympy.together(part))) for delay, part in parts.items()}
    return sympy.Add(*(part * sympy.exp(-delay * s) for delay, part in parts.items()))


def series(*blocks: TransferFunctionLike) -> sympy.Expr:
    """Return the transfer function of blocks in series: their product. (Haugen, Section 5.4 and Figure 5.2)

    >>> series(2 / (s + 1), 3 / s)
    6/(s*(s + 1))
    """
    return simplified(sympy.Mul(*map(transfer_function, blocks)))


def parallel(*blocks: TransferFunctionLike) -> sympy.Expr:
    """Return the transfer function of blocks with one input and added outputs: their sum. (Haugen, Figure 5.2)

    >>> parallel(1, 1 / s)
    (s + 1)/s
    """
    return simplified(sympy.Add(*map(transfer_function, blocks)))


def feedback(forward: TransferFunctionLike, back: TransferFunctionLike = 1, sign: int = -1) -> sympy.Expr:
    """Return the transfer function of a loop: `forward`, with its output fed back through `back`. (Haugen, Figure 5.2)

    Arguments:
        forward, back: transfer functions.
        sign: -1 for negative feedback, the rule in control; +1 for positive.
    Raises:
        ValueError: for another sign, or where the loop has no solution because ``1 - sign*forward*back`` vanishes.

    >>> feedback(2 / s)
    2/(s + 2)
    """
    if sign not in (-1, 1):
        raise ValueError(f"sign is {sign}: expected -1 for negative feedback or 1 for positive feedback")
    forward, back = simplified(forward), simplified(back)
    difference = simplified(1 - sign * forward * back)
    if difference == 0:
        raise ValueError(f"the loop of {forward} and {back} has no solution: it returns exactly what it is given")
    return simplified(forward / difference)


# ------------------------------------------------------------------------------------------------ characteristics


def _fraction(H):
    """Numerator and denominator of H apart from its dead time, common factors cancelled."""
    parts = by_delay(transfer_function(H))
    if len(parts) > 1:
        raise ValueError(f"{H} adds terms of different dead times: its poles and zeros are not known")
    return sympy.cancel(next(iter(parts.values()), sympy.S.Zero)).as_numer_denom()


def polynomials(H: TransferFunctionLike) -> tuple[sympy.Poly, sympy.Poly, sympy.Expr]:
    """Return numerator, denominator and dead time of a strictly proper transfer function with numbers.

    Arguments:
        H: transfer function with real numbers and at most one dead time.
    Returns:
        The polynomials in `s`, as SymPy ``Poly`` with rational coefficients (of others, 30 digits), and the delay.
    Raises:
        ValueError: for zero, symbols, complex numbers, several dead times, or no more poles than zeros.

    >>> polynomials(sympy.exp(-2 * s) / (s + 3))
    (Poly(1, s, domain='QQ'), Poly(s + 3, s, domain='QQ'), 2)
    """
    H = transfer_function(H)
    if symbols := sorted(map(str, H.free_symbols - {s})):
        raise ValueError(f"give a number for {', '.join(symbols)} in {H}")
    if H.has(sympy.I):
        raise ValueError(f"{H} is complex: expected real coefficients")
    if H == 0:
        raise ValueError("the transfer function is 0: expected one that is not zero")
    if len(parts := by_delay(H)) != 1:
        raise ValueError(f"{H} adds terms of different dead times: expected one dead time")
    ((delay, rational),) = parts.items()
    numerator, denominator = (
        sympy.Poly([c if c.is_Rational else sympy.Rational(str(c.evalf(30))) for c in polynomial.all_coeffs()], s)
        for polynomial in (sympy.Poly(part, s) for part in sympy.cancel(rational).as_numer_denom())
    )
    if numerator.degree() >= denominator.degree():
        raise ValueError(f"{H} is not strictly proper: expected more poles than zeros")
    return numerator.set_domain(sympy.QQ), denominator.set_domain(sympy.QQ), delay


def poles(H: TransferFunctionLike) -> list[sympy.Expr]:
    """Return the poles of H, each as often as it occurs, sorted. A dead time has none.

    Raises ValueError where a dead time stands in a denominator, as in a loop around one, or where symbols prevent
    the factoring of a denominator of third or higher degree.
    Source: Haugen, equations (5.12)-(5.14).

    >>> poles((4 * s - 4) / (s**2 + 5 * s + 6))
    [-3, -2]
    """
    return roots(_fraction(H)[1])


def zeros(H: TransferFunctionLike) -> list[sympy.Expr]:
    """Return the zeros of H, each as often as it occurs, sorted. (Haugen, equation 5.12)

    >>> zeros((4 * s - 4) / (s**2 + 5 * s + 6))
    [1]
    """
    return roots(_fraction(H)[0])


def characteristic_polynomial(H: TransferFunctionLike) -> sympy.Expr:
    """Return the denominator of H, scaled so that its highest power of `s` has the coefficient 1. (Haugen, 5.14)

    >>> characteristic_polynomial(3 / (2 * s + 1))
    s + 1/2
    """
    return sympy.Poly(_fraction(H)[1], s).monic().as_expr()


def order(H: TransferFunctionLike) -> int:
    """Return the order of H: the degree of its characteristic polynomial.

    >>> order((4 * s - 4) / (s**2 + 5 * s + 6))
    2
    """
    return int(sympy.degree(_fraction(H)[1], s))


def static_gain(H: TransferFunctionLike) -> sympy.Expr:
    """Return H(0): what a constant input is multiplied with in the end, if the output settles. (Haugen, 5.23)

    It is infinite for an integrator.

    >>> static_gain(3 / (s + sympy.Rational(1, 2)))
    6
    """
    return sympy.limit(transfer_function(H), s, 0)


def initial_gain(H: TransferFunctionLike) -> sympy.Expr:
    """Return H at infinite `s`: the immediate jump of the output for a unit step at the input.

    It is zero where the denominator has the higher degree, and before a dead time is over.

    >>> initial_gain((3 * s + 1) / (s + 2))
    3
    """
    return sympy.limit(transfer_function(H), s, sympy.oo)


def initial_slope(H: TransferFunctionLike) -> sympy.Expr:
    """Return the slope of the unit step response right after the step: the limit of ``s*(H(s) - H(oo))`` for infinite
    `s`.

    It is zero before a dead time is over, and where H has two poles more than zeros.

    Raises ValueError for an improper transfer function, whose step response begins with an impulse.

    >>> initial_slope(first_order(2, 10))
    1/5
    """
    H = transfer_function(H)
    slope = sympy.S.Zero
    for delay, part in by_delay(H).items():
        above, below = (sympy.Poly(x, s) for x in sympy.cancel(part).as_numer_denom())
        if above.degree() > below.degree():
            raise ValueError(f"{H} is improper: expected no more zeros than poles")
        if not delay:
            slope = (above.rem(below) * s).nth(below.degree()) / below.LC()
    return slope


def zero_pole_gain(H: TransferFunctionLike) -> sympy.Expr:
    """Return the gain K of the zero-pole form, the ratio of the leading coefficients. It is not the static gain.

    >>> zero_pole_gain((4 * s - 4) / (s**2 + 5 * s + 6))
    4
    """
    numerator, denominator = _fraction(H)
    return sympy.LC(numerator, s) / sympy.LC(denominator, s)


def zero_pole_form(H: TransferFunctionLike) -> sympy.Expr:
    """Return H as ``K*(s - z1)*(s - z2).../((s - p1)*(s - p2)...)``. (Haugen, equation 5.12)

    Complex pairs of roots stay together, and so do two roots of which symbols leave open whether they are real.

    >>> zero_pole_form((4 * s - 4) / (s**2 + 5 * s + 6))
    4*(s - 1)/((s + 2)*(s + 3))
    """
    return _rebuilt(H, zero_pole_gain(H), scale=lambda factor: 1)


def time_constant_form(H: TransferFunctionLike) -> sympy.Expr:
    """Return H as ``K*(T1*s + 1).../((T2*s + 1)...)``, with factors `s` for poles and zeros at the origin.

    Factors are quadratic for complex pairs of roots, and where symbols leave open whether the roots are real.

    >>> time_constant_form(3 / (4 * s + 2))
    3/(2*(2*s + 1))
    """
    lowest = [next(c for c in reversed(sympy.Poly(x, s).all_coeffs()) if c != 0 or x == 0) for x in _fraction(H)]
    return _rebuilt(H, lowest[0] / lowest[1], scale=lambda factor: 1 if factor == s else factor.subs(s, 0))


def _rebuilt(H, gain, scale):
    """The product of gain, the scaled factors of numerator and denominator, and the dead time of H."""
    above, below = ([sympy.expand(f / scale(f)) for f in _real_factors(polynomial)] for polynomial in _fraction(H))
    return sympy.Mul(
        gain, *above, *(1 / factor for factor in below), *(dead_time(delay) for delay in by_delay(transfer_function(H)))
    )


def _real_factors(polynomial):
    """The factors of a polynomial in `s` with highest coefficient 1: linear for real roots, quadratic for pairs."""
    factors = []
    for factor, n in sympy.factor_list(polynomial, s)[1]:
        factor = sympy.Poly(factor, s).monic()
        if factor.has(sympy.I):
            raise ValueError(f"{polynomial} has no real factors: expected real coefficients")
        found = [] if factor.degree() == 1 else roots(factor.as_expr())
        if (factor.degree() <= 2 and not all(p.is_real for p in found)) or not found:
            factors += n * [factor.as_expr()]
        else:
            factors += n * [s - p for p in found if p.is_real]
            factors += n * [sympy.expand((s - p) * (s - sympy.conjugate(p))) for p in found if sympy.im(p).is_positive]
    return factors


# ------------------------------------------------------------------------------------------------ responses


def response(H: TransferFunctionLike, u: Number) -> sympy.Expr:
    """Return the output y(t) of H, initially at rest, for the input u(t), an expression in `t`.

    Raises ValueError where H or u has no known transform.
    Source: Haugen, Section 5.5.

    >>> response(1 / (s + 1), t)
    t - 1 + exp(-t)
    """
    return inverse(transfer_function(H) * transform(u))


def step_response(H: TransferFunctionLike, U: Number = 1) -> sympy.Expr:
    """Return the output for a step of height U at t = 0. (Haugen, Example 5.1)

    >>> step_response(3 / (s + sympy.Rational(1, 2)), U=2)
    12 - 12*exp(-t/2)
    """
    return inverse(transfer_function(H) * exact(U) / s)


def impulse_response(H: TransferFunctionLike, area: Number = 1) -> sympy.Expr:
    """Return the output for an impulse of the given area at t = 0.

    >>> impulse_response(first_order(2, 4))
    exp(-t/4)/2
    """
    return inverse(transfer_function(H) * exact(area))


_ONE_LAG = 1 - sympy.exp(-1)


def response_time(H: TransferFunctionLike, share: Number = _ONE_LAG) -> float:
    """Return the time at which the unit step response of H first reaches a share of its final value.

    The default share, 1 - 1/e or 63 %, makes it equal to the lag of a first-order system. The response is the exact
    one; the moment is found to about 12 digits.

    Arguments:
        H: transfer function with numbers, or a `System`; stable, with a static gain that is not zero.
        share: between 0 and 1.
    Returns:
        The time, a float, in the unit of the lags.
    Raises:
        ValueError: if the response does not settle at a value other than zero, or symbols are left in H.
    Source: Haugen, equations (6.34)-(6.36), which estimate it by the sum of the lags.

    >>> round(response_time(second_order(1, 1, 1)), 4)
    2.1462
    """
    number("share", share, "a number between 0 and 1", lambda x: 0 < x < 1)
    share = exact(share)
    if hasattr(H, "response_time"):  # a `System`, whose dead times may stand anywhere
        return H.response_time(float(share))
    H = transfer_function(H)
    if symbols := sorted(map(str, H.free_symbols - {s})):
        raise ValueError(f"the response time of {H} is not known: give a number for {', '.join(symbols)}")
    final = final_value(H / s)
    if final == 0:
        raise ValueError(f"the step response settles at {final}: expected a number other than zero")
    missing = step_response(H) / final - share

    def still_missing(time):
        return float(evaluate(missing, time))

    # Search ever longer stretches of time, in steps that are short beside the fastest mode.
    parts = by_delay(H)
    rates = [float(abs(p)) for part in parts.values() for p in poles(part)]
    start, end = 0.0, 1 / max(rates) if rates else float(max(parts)) or 1.0
    while still_missing(start) < 0:
        times = np.linspace(start, end, int(min(max(2000, 10 * max(rates, default=0) * (end - start)), 1e6)) + 1)
        reached = evaluate(missing, times[1:]) >= 0
        if reached.any():
            before, after = times[reached.argmax() :][:2]
            return zero_between(still_missing, before, after, 1e-15 * after)
        start, end = end, 2 * end
    return start
