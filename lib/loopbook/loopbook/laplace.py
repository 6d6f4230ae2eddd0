"""The Laplace transform: from time to `s` by its defining integral, and back by partial fractions.

SymPy's own inverse transform leaves many control engineering cases unsolved or ugly; a rational function with dead
times needs no more than its poles.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, overload

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from loopbook.types import Number
from plainmath.expressions import exact, function_of, s, t

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = [
    "definition", "evaluate", "final_value", "initial_value", "inverse", "partial_fractions", "s", "solve_ode", "t",
    "transform",
]  # fmt: skip


# ------------------------------------------------------------------------------------------------ from t to s


def definition(f: Number) -> sympy.Integral:
    """Return the integral that defines the Laplace transform of `f`, not yet worked out (Haugen, equation 4.1).

    >>> definition(sympy.Integer(1))
    Integral(exp(-s*t), (t, 0, oo))
    """
    return sympy.Integral(function_of(t, f) * sympy.exp(-s * t), (t, 0, sympy.oo))


@overload
def transform(f: Number) -> sympy.Expr: ...
@overload
def transform(f: sympy.Equality) -> sympy.Equality: ...
def transform(f: Number | sympy.Equality) -> sympy.Expr | sympy.Equality:
    """Return the Laplace transform F(s) of a time function f(t), worked out from the defining integral.

    Every term is integrated where its integral converges, to the right of its pole. A step that comes late,
    ``Heaviside(t - tau)``, moves the start of the integration; an impulse picks out one value of the integrand; an
    unknown function ``y(t)`` becomes ``Y(s)``; its derivatives are integrated by parts, which brings in the initial
    values; an equation is transformed on both sides.

    Arguments:
        f: expression in `t` (or an equation of two): sums of products of powers of t, exponentials, sines, cosines,
            late steps, impulses, unknown functions of t with their derivatives and integrals. Decimal numbers are
            taken as exact.
    Returns:
        Expression in `s`, factored; an equation in `s` where `f` is one.
    Raises:
        ValueError: for a term whose integral has no closed form here, as a product of unknown functions, and for an
            expression that is no function of the library's own `t`.
    Source: Haugen, Sections 4.2-4.4, equations (4.1) and (4.14)-(4.21).

    >>> k, T = sympy.symbols("k T", positive=True)
    >>> transform(k * (1 - sympy.exp(-t / T)))
    k/(s*(T*s + 1))
    >>> y = sympy.Function("y")
    >>> transform(sympy.Eq(y(t).diff(t), -2 * y(t)))
    Eq(s*Y(s) - y(0), -2*Y(s))
    """
    if isinstance(f, sympy.Equality):
        return sympy.Eq(transform(f.lhs), transform(f.rhs), evaluate=False)
    late, F = {}, sympy.S.Zero
    for coefficient, blocks in _products(function_of(t, f)):
        steps = [block for block in blocks if isinstance(block, sympy.Heaviside)]
        signal = sympy.Mul(*(block**n for block, n in blocks.items() if block not in steps))
        if steps and not signal.has(sympy.DiracDelta, *_IMPLICIT):
            start = sympy.Max(*map(_moment, steps))
            late[start] = late.get(start, 0) + coefficient * signal
        else:
            F += coefficient * _transform_product(blocks)
    for start, signal in late.items():
        # Let time begin with the last step: that is the same signal without steps, coming late.
        F += sympy.exp(-start * s) * transform(signal.subs(t, t + start))
    return F if F.has(AppliedUndef) else _factored(F)


_WAVES = (sympy.sin, sympy.cos, sympy.sinh, sympy.cosh)
_EXPECTED = "expected sums of powers of t, exponentials, sines and cosines, late or not"
_IMPLICIT = (AppliedUndef, sympy.Derivative, sympy.Integral)
_BLOCKS = (sympy.exp, sympy.Heaviside, sympy.DiracDelta, *_IMPLICIT)


def _products(f):
    """Multiply f(t) out: a list of terms (coefficient, {block: power}), the blocks being what depends on t."""
    symbols, constants = {}, {}

    def spelled(part):
        if not part.has(t):
            return part
        if t not in part.free_symbols:  # as an initial value, where t is bound
            return constants.setdefault(part, sympy.Dummy())
        if isinstance(part, _WAVES) and not part.has(AppliedUndef):
            return spelled(part.rewrite(sympy.exp))
        if isinstance(part, _BLOCKS) or (
            part.is_Pow and (part.base == t or part.exp.has(t)) and not part.exp.is_Integer
        ):
            return symbols.setdefault(part, sympy.Dummy())
        return part.func(*map(spelled, part.args)) if part.args else part

    try:
        polynomial = sympy.Poly(spelled(f), t, *symbols.values())
    except sympy.PolynomialError:
        raise ValueError(f"cannot transform {f}: {_EXPECTED}") from None
    blocks = [t, *symbols]
    meaning = {symbol: constant for constant, symbol in constants.items()}
    return [
        (coefficient.xreplace(meaning), {block: n for block, n in zip(blocks, powers, strict=True) if n})
        for powers, coefficient in polynomial.terms()
    ]


def _transform_product(blocks):
    """The transform of a product of blocks, {block: power}."""
    signal = sympy.Mul(*(block**n for block, n in blocks.items()))
    if signal.has(sympy.DiracDelta):
        return _transform_impulse(signal)
    if signal.has(*_IMPLICIT):
        return _transform_implicit(signal)
    constant, p, n = sympy.S.One, sympy.S.Zero, sympy.S.Zero
    for block, power in blocks.items():
        base, exponent = block.as_base_exp()
        if base == t and not exponent.has(t):
            n += power * exponent
        elif not base.has(t) and exponent.is_polynomial(t) and sympy.degree(exponent, t) == 1:
            line = sympy.Poly(exponent, t)
            p += power * line.nth(1) * sympy.log(base)
            constant *= (base ** (power * line.nth(0))).rewrite(sympy.cos if line.nth(0).has(sympy.I) else sympy.exp)
        else:
            raise ValueError(f"cannot transform {block}: {_EXPECTED}")
    # t**n * exp(p*t): the integral converges to the right of p, and only s - p matters there.
    return constant * _power_integral(n)(s - p)


def _transform_impulse(signal):
    """An impulse is what picks one value out of an integral; here, of the signal beside it times ``exp(-s*t)``."""
    impulse = next(iter(signal.atoms(sympy.DiracDelta)))
    beside = signal / impulse
    if beside.has(sympy.DiracDelta) or len(impulse.args) > 1:
        raise ValueError(f"cannot transform {signal}: expected one impulse DiracDelta(t - tau), not differentiated")
    moment = _moment(impulse)
    if any(_moment(step) == moment for step in beside.atoms(sympy.Heaviside)):
        raise ValueError(f"cannot transform {signal}: an impulse at the moment of a step has no definite strength")
    return (beside * sympy.exp(-s * t)).subs(t, moment)


def _moment(event):
    """The moment tau at which Heaviside(t - tau) or DiracDelta(t - tau) acts."""
    moment = sympy.expand(t - event.args[0])
    if moment.has(t) or moment.is_negative:
        raise ValueError(f"cannot transform {event}: expected the argument t - tau with tau not negative")
    return moment


def _transform_implicit(signal):
    """The transforms of an unknown y(t) or y(t - tau), and of derivatives and integrals from 0 to t."""
    match signal:
        case sympy.Derivative() if set(signal.variables) == {t}:
            # By parts: the integral of y' e^(-st) is [y e^(-st)] from 0 to oo, plus s times the integral of y e^(-st).
            y = signal.expr.diff(t, len(signal.variables) - 1)
            return s * transform(y) - y.subs(t, 0)
        case sympy.Integral() if len(signal.limits) == 1 and signal.limits[0][1:] == (0, t):
            # The integral is zero at first and has the integrand as its derivative: the same rule, turned round.
            variable = signal.limits[0][0]
            if variable == t or t not in signal.function.free_symbols:
                return transform(signal.function.subs(variable, t)) / s
        case AppliedUndef() if len(signal.args) == 1 and not (delay := t - signal.args[0]).has(t):
            if not delay.is_negative:
                # With t - tau for t in the integral, exp(-tau*s) comes out; the signal is at rest before t = 0.
                return sympy.exp(-delay * s) * _image(signal.func)(s)
    raise ValueError(f"cannot transform {signal}: expected unknown signals, late or not, times constants only")


def _image(function):
    """The function of `s` that belongs to an unknown function of t: Y to y."""
    name = function.__name__
    return sympy.Function(name[0].upper() + name[1:])


@functools.cache
def _power_integral(n):
    """The integral of ``t**n * exp(-sigma*t)`` from 0 to oo, as a function of sigma, worked out for sigma > 0."""
    sigma, time = sympy.Dummy("sigma", positive=True), sympy.Dummy("t", positive=True)
    if (n + 1).is_nonpositive:
        raise ValueError(f"cannot transform t**({n}): its defining integral has no finite value")
    area = sympy.powsimp(sympy.integrate(time**n * sympy.exp(-sigma * time), (time, 0, sympy.oo), conds="none"))
    return sympy.Lambda(sigma, area.rewrite(sympy.factorial) if n.is_integer else area)


# ------------------------------------------------------------------------------------------------ from s to t


def by_delay(F: Number) -> dict[sympy.Expr, sympy.Expr]:
    """Split F(s) into its dead times: return {delay: rational part}, F being the sum of ``part * exp(-delay*s)``.

    Raises ValueError where F is no such sum: with a dead time in the denominator, a response has no end of terms.

    >>> by_delay((1 - sympy.exp(-2 * s)) / s)
    {0: 1/s, 2: -1/s}
    >>> by_delay((1 + sympy.exp(-s)) * (sympy.exp(-s) + sympy.exp(-2 * s)) / s)
    {1: 1/s, 2: 2/s, 3: 1/s}
    """
    F = function_of(s, F)
    rational, delays = without_delays(F)
    if not delays:
        return {sympy.S.Zero: F} if F != 0 else {}
    numerator, denominator = sympy.together(rational).as_numer_denom()
    if denominator.has(*delays):
        numerator, denominator = sympy.cancel(numerator / denominator).as_numer_denom()
    (lowest, divisor), *more = sympy.Poly(denominator, *delays).terms()
    if more:
        raise ValueError(f"{F} has a dead time in its denominator: expected a finite sum of parts, each delayed or not")
    parts = {}
    for powers, part in sympy.Poly(numerator, *delays).terms():
        delay = sympy.Add(*((n - m) * delay for n, m, delay in zip(powers, lowest, delays.values(), strict=True)))
        if delay.is_negative:
            raise ValueError(f"{F} contains exp({-delay * s}): a dead time cannot be negative")
        parts[delay] = parts.get(delay, 0) + part / divisor
    return {delay: part for delay, part in sorted(parts.items(), key=sympy.default_sort_key) if part != 0}


def without_delays(F: sympy.Expr) -> tuple[sympy.Expr, dict[sympy.Symbol, sympy.Expr]]:
    """Return F(s) with a symbol for each ``exp(-delay*s)``, which makes it rational, and the dictionary {symbol:
    delay}.

    Raises ValueError where F is not a rational function of s and dead times.
    """
    symbols, replaced = {}, {}
    for exponential in sorted(F.atoms(sympy.exp), key=str):
        if exponential.has(s):
            exponent = sympy.expand(exponential.exp)
            rate = exponent.coeff(s, 1)
            # exp(delay*s) is one over exp(-delay*s): one symbol serves for both
            sign = 1 if rate.could_extract_minus_sign() else -1
            symbol = symbols.setdefault(-sign * rate, sympy.Dummy())
            replaced[exponential] = symbol**sign * sympy.exp(sympy.expand(exponent - rate * s))
    delays = {symbol: delay for delay, symbol in symbols.items()}
    rational = F.xreplace(replaced)
    constants = (*symbols, *replaced.values())
    if not rational.is_rational_function(s, *delays) or any(constant.has(s) for constant in constants):
        raise ValueError(f"{F} is not a rational function of s and dead times exp(-delay*s)")
    return rational, delays


def _factored(F):
    """F with each rational part factored, as books write transfer functions; F itself if it is something else."""
    try:
        parts = by_delay(F)
    except ValueError:
        return F
    return sympy.Add(*(sympy.factor(sympy.cancel(part)) * sympy.exp(-delay * s) for delay, part in parts.items()))


def partial_fractions(F: Number) -> sympy.Expr:
    """Return F(s) as a sum of partial fractions, one group for each dead time.

    >>> partial_fractions(1 / (s * (s + 2)))
    -1/(2*(s + 2)) + 1/(2*s)
    """
    return sympy.Add(
        *(fraction * sympy.exp(-delay * s) for delay, part in by_delay(F).items() for fraction in _fractions(part))
    )


def _fractions(rational):
    return sympy.Add.make_args(sympy.apart(sympy.cancel(rational), s))


def inverse(F: Number) -> sympy.Expr:
    """Return the time function f(t), t >= 0, whose Laplace transform is F(s): partial fractions, then one pair each.

    Poles may be real, complex, repeated, numbers or symbols, and a dead time ``exp(-tau*s)`` may stand on any term.
    A denominator that does not factor into linear and quadratic parts over the rational numbers is factored
    numerically, to about 15 digits; with symbols in it that is not possible. Decimal numbers are taken as exact.

    Arguments:
        F: expression in `s`: a sum of rational functions, each times ``exp(-delay*s)`` or not.
    Returns:
        Expression in `t`. What comes late carries ``Heaviside(t - delay)``.
    Raises:
        ValueError: if F is no such sum, or a denominator with symbols cannot be factored.
    Source: Haugen, equations (4.4)-(4.13) and (4.16).

    >>> K, T, U = sympy.symbols("K T U", positive=True)
    >>> inverse(K / (T * s + 1) * U / s)
    K*U - K*U*exp(-t/T)
    >>> inverse(sympy.exp(-3 * s) / s**2)
    (t - 3)*Heaviside(t - 3)
    """
    f = sympy.S.Zero
    for delay, part in by_delay(F).items():
        for fraction in _fractions(part):
            signal = _inverse_fraction(fraction)
            if delay != 0:
                signal = sympy.powsimp(signal.subs(t, t - delay))
                signal *= 1 if signal.has(sympy.DiracDelta) else sympy.Heaviside(t - delay)
            f += signal
    return f


def _inverse_fraction(fraction):
    """The time function of one partial fraction: ``numerator/(linear or quadratic in s)**n``, or a power of s."""
    numerator, denominator = sympy.factor(fraction).as_numer_denom()
    constant, denominator = denominator.as_independent(s, as_Add=False)
    numerator /= constant
    if denominator == 1:
        coefficient, power = numerator.as_independent(s, as_Add=False)
        order = sympy.degree(power, s)
        return coefficient * (sympy.DiracDelta(t, order) if order else sympy.DiracDelta(t))
    base, n = denominator.as_base_exp()
    base = sympy.Poly(base, s)
    if base.degree() == 1:
        p = -base.nth(0) / base.nth(1)
        return sympy.exp(p * t) * _residue(numerator / base.nth(1) ** n, p, n)
    if base.degree() == 2:
        return _inverse_quadratic(sympy.Poly(numerator, s), base, n)
    if symbols := base.free_symbols_in_domain:
        raise ValueError(f"cannot factor {base.as_expr()}: give numbers for {', '.join(sorted(map(str, symbols)))}")
    return _inverse_numerically(numerator, base, n)


def _residue(rest, p, n):
    """The residue of ``rest/(s - p)**n * exp(s*t)`` at the pole p, without the factor ``exp(p*t)``."""
    taylor = (rest.diff(s, n - 1 - k).subs(s, p) / sympy.factorial(n - 1 - k) for k in range(n))
    return sympy.Add(*(c * t**k / sympy.factorial(k) for k, c in enumerate(taylor)))


def _inverse_quadratic(numerator, base, n):
    """``numerator/(a s**2 + b s + c)**n``: a damped oscillation, or two exponentials if the roots are surely real."""
    a, b, c = base.all_coeffs()
    decay = b / (2 * a)
    square = sympy.factor(c / a - decay**2)
    frequency = sympy.I * sympy.sqrt(-square) if square.is_negative else sympy.sqrt(square)
    # Seen from -decay, the poles lie at +p and -p.
    p, shifted = sympy.I * frequency, numerator.as_expr().subs(s, s - decay) / a**n
    if n == 1:
        even, odd = sympy.Poly(shifted, s).nth(0), sympy.Poly(shifted, s).nth(1)
        f = odd * sympy.cos(frequency * t) + even / frequency * sympy.sin(frequency * t)
    else:
        pair = ((q, _residue(shifted / (s + q) ** n, q, n)) for q in (p, -p))
        f = sympy.simplify(sympy.expand(sympy.Add(*((sympy.exp(q * t) * r).rewrite(sympy.cos) for q, r in pair))))
    if square.is_negative:
        f = f.rewrite(sympy.exp)
    return sympy.Add(*(sympy.powsimp(sympy.exp(-decay * t) * term) for term in sympy.Add.make_args(sympy.expand(f))))


def _inverse_numerically(numerator, base, n):
    """``numerator/base**n`` for a base of third or higher degree, at its roots."""
    found, f = base.nroots(n=30, maxsteps=200), sympy.S.Zero
    for p in found:
        others = sympy.Mul(base.LC(), *(s - q for q in found if q != p))
        real, imaginary = sympy.N(sympy.expand(_residue(numerator / others**n, p, n)), 15).as_real_imag()
        decay, w = sympy.N(p, 15).as_real_imag()
        if w == 0:
            f += real * sympy.exp(decay * t)
        elif w > 0:  # with its conjugate, twice the real part
            f += 2 * sympy.exp(decay * t) * (real * sympy.cos(w * t) - imaginary * sympy.sin(w * t))
    return f


# ------------------------------------------------------------------------------------------------ what they serve


@overload
def solve_ode(equations: sympy.Equality, initial: Mapping[sympy.Expr, Number] | None = None) -> sympy.Expr: ...
@overload
def solve_ode(
    equations: Sequence[sympy.Equality], initial: Mapping[sympy.Expr, Number] | None = None
) -> dict[sympy.Expr, sympy.Expr]: ...
def solve_ode(
    equations: sympy.Equality | Sequence[sympy.Equality], initial: Mapping[sympy.Expr, Number] | None = None
) -> sympy.Expr | dict[sympy.Expr, sympy.Expr]:
    """Solve linear differential equations with constant coefficients by the Laplace transform.

    Arguments:
        equations: one equation, or a list of them, in unknown functions of `t`; inputs stand in it as known functions.
        initial: the initial values as in SymPy's dsolve, ``{y(0): 4, y(t).diff(t).subs(t, 0): 1}``. What is not
            given stays in the answer as it is.
    Returns:
        y(t) for one equation; a dictionary ``{y(t): expression}`` for a list.
    Raises:
        ValueError: if the equations are not linear, or not as many as the unknown functions, or if an initial value
            is given that they do not ask for.
    Source: Haugen, Example 4.2.

    >>> y = sympy.Function("y")
    >>> solve_ode(sympy.Eq(y(t).diff(t), -2 * y(t)), {y(0): 4})
    4*exp(-2*t)
    """
    several = isinstance(equations, (list, tuple))
    equations = list(equations) if several else [equations]
    residuals = transformed(equations)
    unknowns = sorted({f.func(t) for e in equations for f in e.atoms(AppliedUndef) if f.free_symbols}, key=str)
    if len(unknowns) != len(equations):
        raise ValueError(
            f"{len(equations)} equation(s) for {len(unknowns)} unknown function(s) of t, "
            f"{', '.join(map(str, unknowns)) or 'none'}: expected one equation for each"
        )
    asked = {value for e in residuals for value in e.atoms(AppliedUndef, sympy.Subs) if not value.free_symbols}
    if not isinstance(initial, (dict, type(None))):
        raise ValueError(f"{initial} gives no initial values: expected a dictionary such as {{y(0): 4}}")
    given = {exact(key): exact(value) for key, value in (initial or {}).items()}
    for key in given:
        if key not in asked:
            expected = ", ".join(sorted(map(str, asked))) or "none"
            raise ValueError(f"{key} is not an initial value here: expected {expected}")
    solution = solve_transformed(equations, unknowns)
    responses = {y: inverse(Y.subs(given)) for y, Y in zip(unknowns, solution, strict=True)}
    return responses if several else responses[unknowns[0]]


def transformed(equations: Iterable[sympy.Equality]) -> list[sympy.Expr]:
    """Return the transforms of several equations, each as left side minus right side.

    Raises ValueError for what is not an equation.

    >>> y = sympy.Function("y")
    >>> transformed([sympy.Eq(y(t).diff(t), 3)])
    [s*Y(s) - y(0) - 3/s]
    """
    for equation in equations:
        if not isinstance(equation, sympy.Equality):
            raise ValueError(f"{equation} is not an equation: expected Eq(left side, right side)")
    return [transform(equation.lhs) - transform(equation.rhs) for equation in equations]


def solve_transformed(equations: Iterable[sympy.Equality], unknowns: Sequence[sympy.Expr]) -> list[sympy.Expr]:
    """Return the transforms of the unknown functions of t, solved from the transformed equations.

    Raises ValueError if the equations are not linear in the unknown functions, or do not determine them.

    >>> y, u = sympy.Function("y"), sympy.Function("u")
    >>> solve_transformed([sympy.Eq(y(t).diff(t) + y(t), u(t))], [y(t)])
    [(U(s) + y(0))/(s + 1)]
    """
    images = [transform(y) for y in unknowns]
    names = ", ".join(map(str, unknowns))
    try:
        matrix, right = sympy.linear_eq_to_matrix(transformed(equations), images)
    except sympy.solvers.solveset.NonlinearError:
        raise ValueError(f"the equations are not linear in {names}") from None
    if matrix.shape[0] != matrix.shape[1] or sympy.cancel(matrix.det()) == 0:
        raise ValueError(f"the equations do not determine {names}")
    return [sympy.factor(Y) for Y in matrix.LUsolve(right)]


def initial_value(F: Number) -> sympy.Expr:
    """Return f(0+), the limit of s F(s) for s to infinity (the Initial Value Theorem).

    >>> initial_value(4 / (s + 2))
    4
    """
    return sympy.limit(s * function_of(s, F), s, sympy.oo)


def final_value(F: Number) -> sympy.Expr:
    """Return what f(t) tends to as t grows, the limit of s F(s) for s to zero (the Final Value Theorem).

    The theorem holds only where f(t) settles: every pole of s F(s) must lie strictly left of the imaginary axis. The
    limit alone gives plausible numbers for functions that grow or oscillate forever; this function does not.

    Raises ValueError when a pole lies elsewhere, or when that cannot be decided because a symbol has no known sign.
    Source: Haugen, equation (4.22), with the condition that it needs.

    >>> final_value(12 / (s * (2 * s + 1)))
    12
    >>> final_value(1 / (s - 2))
    Traceback (most recent call last):
    ValueError: f(t) does not settle: s*F(s) has a pole at 2
    """
    sF = sympy.expand(s * function_of(s, F))
    for part in by_delay(sF).values():
        denominator = sympy.cancel(sympy.together(part)).as_numer_denom()[1]
        for factor, _ in sympy.factor_list(denominator, s)[1]:
            if factor != s and not _is_stable(factor):
                poles = (
                    f" at {', '.join(map(str, roots(factor)))}"
                    if sympy.degree(factor, s) <= 2
                    else f", a root of {factor}"
                )
                raise ValueError(f"f(t) does not settle: s*F(s) has a pole{poles}")
    value = sympy.limit(sF, s, 0)
    if value.has(sympy.oo, -sympy.oo, sympy.zoo):  # at s = 0 itself, dead times may cancel the pole of their parts
        raise ValueError("f(t) does not settle: s*F(s) has a pole at 0")
    return value


def _is_stable(polynomial):
    """Whether every root of a polynomial in `s` lies left of the imaginary axis, by the determinants of Hurwitz.

    Raises ValueError where that cannot be decided because a symbol has no known sign.
    """
    if polynomial.has(sympy.I):
        raise ValueError(f"cannot tell whether f(t) settles: expected real coefficients in {polynomial}")
    coefficients = (sympy.Poly(polynomial, s) * sympy.LC(polynomial, s)).all_coeffs()
    n = len(coefficients) - 1
    hurwitz = sympy.Matrix(n, n, lambda row, column: dict(enumerate(coefficients)).get(2 * column - row + 1, 0))
    minors = [sympy.factor(hurwitz[:k, :k].det()) for k in range(1, n + 1)]
    if any(minor.is_positive is False for minor in minors):
        return False
    if all(minor.is_positive for minor in minors):
        return True
    raise ValueError(f"cannot tell whether f(t) settles: the signs of the roots of {polynomial} are not known")


def roots(polynomial: Number) -> list[sympy.Expr]:
    """Return the roots of a polynomial in `s` as a sorted list, each as often as it occurs.

    Exact where linear and quadratic factors are enough; numbers to 15 digits where they are not.

    Raises ValueError for what is not a polynomial, and for symbols in a factor of third or higher degree.

    >>> roots((s + 1) ** 2 * (s**2 + 4))
    [-1, -1, -2*I, 2*I]
    """
    polynomial, found = function_of(s, polynomial), []
    if not polynomial.is_polynomial(s):
        raise ValueError(f"{polynomial} has no roots here: expected a polynomial in s")
    for factor, n in sympy.factor_list(polynomial, s)[1]:
        factor = sympy.Poly(factor, s)
        symbols = factor.free_symbols_in_domain
        if factor.degree() <= 2:
            found += n * [root for root, times in sympy.roots(factor).items() for _ in range(times)]
        elif symbols:
            names = ", ".join(sorted(map(str, symbols)))
            raise ValueError(f"cannot factor {factor.as_expr()}: give numbers for {names}")
        else:
            found += n * factor.nroots(n=15, maxsteps=200)
    if any(root.free_symbols for root in found):
        return sorted(found, key=sympy.default_sort_key)
    return sorted(found, key=lambda root: tuple(float(x) for x in root.as_real_imag()))


def evaluate(f: Number, times: ArrayLike) -> np.ndarray:
    """Return the values of f(t) at the given times as a NumPy array; a step has its new value at the step itself.

    Raises ValueError where f is no function of time alone: another symbol is left, or an impulse, which has no value;
    and where values are complex.

    >>> evaluate(sympy.exp(-t), [0, 1]).round(3)
    array([1.   , 0.368])
    """
    f, times = function_of(t, f), np.asarray(times, dtype=float)
    symbols = sorted(map(str, f.free_symbols - {t}))
    if symbols:
        raise ValueError(f"cannot evaluate {f}: give a number for {', '.join(symbols)}")
    if f.has(sympy.DiracDelta):
        raise ValueError(f"cannot evaluate {f}: an impulse has an area but no value")
    if f.has(sympy.oo, sympy.zoo):
        raise ValueError(f"cannot evaluate {f}: it is infinite")
    values = np.full(times.shape, np.nan)
    for start, end, between in between_steps(f):
        here = (start <= times) & (times < end)
        if here.any():
            values[here] = _values(between, times[here])
    return values


def zero_between(function: Callable[[float], float], before: float, after: float, accuracy: float) -> float:
    """Return where a function that is seen to be negative `before` and positive `after` is zero, to an accuracy.

    What is seen in an array of values need not hold of a single one: NumPy computes many at once otherwise than one,
    and another machine otherwise again. Where a value at an end is rounding alone, so that its sign is the other one
    there, that end is the zero.

    >>> round(zero_between(lambda x: x * x - 2, 1, 2, 1e-12), 9)
    1.414213562
    >>> zero_between(lambda x: x - 2 - 1e-16, 1, 2, 1e-12)
    2.0
    """
    from scipy.optimize import brentq

    before, after = float(before), float(after)
    if function(before) >= 0:
        return before
    if function(after) <= 0:
        return after
    return brentq(function, before, after, xtol=accuracy, rtol=1e-14)


def between_steps(f: sympy.Expr) -> Iterator[tuple[float, float, sympy.Expr]]:
    """Split f(t) at its steps: (start, end, f without steps) for each stretch of time between them.

    What comes late is left out before its time, when a factor such as exp(1000 - t) would be beyond all numbers.
    """
    rates = {step: sympy.expand(step.args[0]).diff(t) for step in f.atoms(sympy.Heaviside)}
    moments = {step: -step.args[0].subs(t, 0) / rate for step, rate in rates.items() if rate.is_nonzero}
    for start, end in itertools.pairwise([-sympy.oo, *sorted(set(moments.values())), sympy.oo]):
        # a step has its new value from its moment on; one that falls, as Heaviside(1 - t), is on until then
        on = {step: (moment <= start) == (rates[step] > 0) for step, moment in moments.items()}
        yield float(start), float(end), f.xreplace({step: sympy.Integer(bool(value)) for step, value in on.items()})


def _values(f, times):
    """The real values of f(t), which has no steps, at an array of times."""
    try:
        with np.errstate(invalid="ignore"):
            values = np.asarray(_compiled(f)(times))
        values = values.astype(complex if np.iscomplexobj(values) else float)
    except (NameError, NotImplementedError, OverflowError, TypeError):
        raise ValueError(f"cannot evaluate {f}: NumPy has no such function or number") from None
    if np.isnan(values).any() or np.any(abs(values.imag) > 1e-9 * (1 + abs(values))):
        raise ValueError(f"cannot evaluate {f}: its values are not real numbers")
    return values.real


@functools.lru_cache(maxsize=64)  # whoever searches asks for one moment after the other
def _compiled(f):
    """A function of time for f(t)."""
    # NumPy divides floats: a fraction of integers that are too long for one becomes one here
    long = {q: sympy.Float(q, 17) for q in f.atoms(sympy.Rational) if max(abs(q.p), q.q) > 2**53}
    return sympy.lambdify(t, f.xreplace(long), "numpy")
