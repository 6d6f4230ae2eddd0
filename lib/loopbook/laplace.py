"""The Laplace transform: from time to `s` by its defining integral, and back by partial fractions.

SymPy's own inverse transform leaves many control engineering cases unsolved or ugly; a rational function with dead
times needs no more than its poles.
"""

import functools

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import s, t

__all__ = [
    "definition", "evaluate", "final_value", "initial_value", "inverse", "partial_fractions", "s", "solve_ode", "t",
    "transform",
]  # fmt: skip


# ------------------------------------------------------------------------------------------------ from t to s


def definition(f):
    """Return the integral that defines the Laplace transform of `f`, not yet worked out (Haugen, equation 4.1).

    >>> definition(sympy.Integer(1))
    Integral(exp(-s*t), (t, 0, oo))
    """
    return sympy.Integral(sympy.sympify(f) * sympy.exp(-s * t), (t, 0, sympy.oo))


def transform(f):
    """Return the Laplace transform F(s) of a time function f(t), worked out from the defining integral.

    Every term is integrated where its integral converges, to the right of its pole. A step that comes late,
    ``Heaviside(t - tau)``, moves the start of the integration; an impulse picks out one value of the integrand; an
    unknown function ``y(t)`` becomes ``Y(s)``; its derivatives are integrated by parts, which brings in the initial
    values; an equation is transformed on both sides.

    Arguments:
        f: expression in `t` (or an equation of two): sums of products of powers of t, exponentials, sines, cosines,
            late steps, impulses, unknown functions of t with their derivatives and integrals.
    Returns:
        Expression in `s`, factored; an equation in `s` where `f` is one.
    Raises:
        ValueError: for a term whose integral has no closed form here, as a product of unknown functions.
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
    F = sympy.Add(*(coefficient * _transform_product(blocks) for coefficient, blocks in _products(sympy.sympify(f))))
    return F if F.has(AppliedUndef) else _factored(F)


_WAVES = (sympy.sin, sympy.cos, sympy.sinh, sympy.cosh)
_EXPECTED = "expected sums of powers of t, exponentials, sines and cosines, late or not"
_BLOCKS = (sympy.exp, sympy.Heaviside, sympy.DiracDelta, AppliedUndef, sympy.Derivative, sympy.Integral)


def _products(f):
    """Multiply f(t) out: a list of terms (coefficient, {block: power}), the blocks being what depends on t."""
    letters = {}

    def spelled(part):
        if not part.has(t):
            return part
        if isinstance(part, _WAVES):
            return spelled(part.rewrite(sympy.exp))
        if isinstance(part, _BLOCKS) or (part.is_Pow and part.base == t and not part.exp.is_Integer):
            return letters.setdefault(part, sympy.Dummy())
        return part.func(*map(spelled, part.args)) if part.args else part

    try:
        polynomial = sympy.Poly(spelled(f), t, *letters.values())
    except sympy.PolynomialError:
        raise ValueError(f"cannot transform {f}: {_EXPECTED}") from None
    blocks = [t, *letters]
    return [
        (coefficient, {block: n for block, n in zip(blocks, powers, strict=True) if n})
        for powers, coefficient in polynomial.terms()
    ]


def _transform_product(blocks):
    """The transform of a product of blocks, {block: power}."""
    signal = sympy.Mul(*(block**n for block, n in blocks.items()))
    if signal.has(sympy.DiracDelta):
        return _transform_impulse(signal)
    if signal.has(AppliedUndef):
        return _transform_unknown(signal)
    if signal.has(sympy.Heaviside):
        steps = [block for block in blocks if isinstance(block, sympy.Heaviside)]
        start = sympy.Max(*map(_moment, steps))
        # Let time begin with the last step: that is the same signal without steps, coming late.
        rest = sympy.Mul(*(block**n for block, n in blocks.items() if block not in steps))
        return sympy.exp(-start * s) * transform(rest.subs(t, t + start))
    constant, p, n = sympy.S.One, sympy.S.Zero, sympy.S.Zero
    for block, power in blocks.items():
        base, exponent = block.as_base_exp()
        if base == t and not exponent.has(t):
            n += power * exponent
        elif isinstance(block, sympy.exp) and block.exp.is_polynomial(t) and sympy.degree(block.exp, t) == 1:
            line = sympy.Poly(block.exp, t)
            p += power * line.nth(1)
            constant *= sympy.exp(power * line.nth(0)).rewrite(sympy.cos if line.nth(0).has(sympy.I) else sympy.exp)
        else:
            raise ValueError(f"cannot transform {block}: {_EXPECTED}")
    # t**n * exp(p*t): the integral converges to the right of p, and only s - p matters there.
    return constant * _power_integral(n)(s - p)


def _transform_impulse(signal):
    """An impulse is what picks one value out of an integral; here, of the signal beside it times exp(-s*t)."""
    impulse = next(iter(signal.atoms(sympy.DiracDelta)))
    beside = signal / impulse
    if beside.has(sympy.DiracDelta) or len(impulse.args) > 1:
        raise ValueError(f"cannot transform {signal}: expected one impulse DiracDelta(t - tau), not differentiated")
    return (beside * sympy.exp(-s * t)).subs(t, _moment(impulse))


def _moment(event):
    """The moment tau at which Heaviside(t - tau) or DiracDelta(t - tau) acts."""
    moment = sympy.expand(t - event.args[0])
    if moment.has(t) or moment.is_negative:
        raise ValueError(f"cannot transform {event}: expected the argument t - tau with tau not negative")
    return moment


def _transform_unknown(signal):
    """The transforms of y(t), y(t - tau), their derivatives and their integrals from 0 to t."""
    match signal:
        case sympy.Derivative() if set(signal.variables) == {t}:
            # By parts: the integral of y' e^(-st) is [y e^(-st)] from 0 to oo, plus s times the integral of y e^(-st).
            y = signal.expr.diff(t, len(signal.variables) - 1)
            return s * transform(y) - y.subs(t, 0)
        case sympy.Integral() if len(signal.limits) == 1 and signal.limits[0][1:] == (0, t):
            # The integral is zero at first and has the integrand as its derivative: the same rule, turned round.
            return transform(signal.function.subs(signal.limits[0][0], t)) / s
        case AppliedUndef() if len(signal.args) == 1 and not (delay := t - signal.args[0]).has(t):
            if not delay.is_negative:
                # With t - tau for t in the integral, exp(-tau*s) comes out; the signal is at rest before t = 0.
                return sympy.exp(-delay * s) * _image(signal.func)(s)
    raise ValueError(f"cannot transform {signal}: the transform of a product of unknown signals is not known")


def _image(function):
    """The function of `s` that belongs to an unknown function of t: Y to y."""
    name = function.__name__
    return sympy.Function(name[0].upper() + name[1:])


@functools.cache
def _power_integral(n):
    """The integral of t**n * exp(-sigma*t) from 0 to oo, as a function of sigma, worked out for sigma > 0."""
    sigma, time = sympy.Dummy("sigma", positive=True), sympy.Dummy("t", positive=True)
    if (n + 1).is_nonpositive:
        raise ValueError(f"cannot transform t**({n}): its defining integral has no finite value")
    area = sympy.powsimp(sympy.integrate(time**n * sympy.exp(-sigma * time), (time, 0, sympy.oo), conds="none"))
    return sympy.Lambda(sigma, area.rewrite(sympy.factorial) if n.is_integer else area)


# ------------------------------------------------------------------------------------------------ from s to t


def by_delay(F):
    """Split F(s) into its dead times: return {delay: rational part}, F being the sum of part * exp(-delay*s).

    Raises ValueError where F is no such sum: with a dead time in the denominator, a response has no end of terms.

    >>> by_delay((1 - sympy.exp(-2 * s)) / s)
    {0: 1/s, 2: -1/s}
    """
    F = sympy.sympify(F)
    # Each exponential becomes a letter, so that F is a rational function of s and these letters.
    letters = {e: sympy.Dummy() for e in sorted(F.atoms(sympy.exp), key=str) if e.has(s)}
    delays = [sympy.expand(-e.exp / s) for e in letters]
    rational = F.xreplace(letters)
    if not rational.is_rational_function(s, *letters.values()) or any(delay.has(s) for delay in delays):
        raise ValueError(f"{F} is not a rational function of s and dead times exp(-delay*s)")
    if not letters:
        return {sympy.S.Zero: F} if F != 0 else {}
    numerator, denominator = sympy.together(rational).as_numer_denom()
    if denominator.has(*letters.values()):
        numerator, denominator = sympy.cancel(numerator / denominator).as_numer_denom()
    (lowest, divisor), *more = sympy.Poly(denominator, *letters.values()).terms()
    if more:
        raise ValueError(f"{F} has a dead time in its denominator: its response is no finite sum of terms")
    parts = {}
    for powers, part in sympy.Poly(numerator, *letters.values()).terms():
        delay = sympy.Add(*((n - m) * delay for n, m, delay in zip(powers, lowest, delays, strict=True)))
        if delay.is_negative:
            raise ValueError(f"{F} contains exp({-delay * s}): a dead time cannot be negative")
        parts[delay] = parts.get(delay, 0) + part / divisor
    return {delay: part for delay, part in sorted(parts.items(), key=sympy.default_sort_key) if part != 0}


def _factored(F):
    """F with each rational part factored, as books write transfer functions; F itself if it is something else."""
    try:
        parts = by_delay(F)
    except ValueError:
        return F
    return sympy.Add(*(sympy.factor(sympy.cancel(part)) * sympy.exp(-delay * s) for delay, part in parts.items()))


def partial_fractions(F):
    """Return F(s) as a sum of partial fractions, one group for each dead time.

    >>> partial_fractions(1 / (s * (s + 2)))
    -1/(2*(s + 2)) + 1/(2*s)
    """
    return sympy.Add(
        *(fraction * sympy.exp(-delay * s) for delay, part in by_delay(F).items() for fraction in _fractions(part))
    )


def _fractions(rational):
    return sympy.Add.make_args(sympy.apart(sympy.cancel(sympy.nsimplify(rational, rational=True)), s))


def inverse(F):
    """Return the time function f(t), t >= 0, whose Laplace transform is F(s): partial fractions, then one pair each.

    Poles may be real, complex, repeated, numbers or letters, and a dead time ``exp(-tau*s)`` may stand on any term.
    A denominator that does not factor into linear and quadratic parts over the rational numbers is factored
    numerically, to about 15 digits; with letters in it that is not possible. Decimal numbers are taken as exact.

    Arguments:
        F: expression in `s`: a sum of rational functions, each times ``exp(-delay*s)`` or not.
    Returns:
        Expression in `t`. What comes late carries ``Heaviside(t - delay)``.
    Raises:
        ValueError: if F is no such sum, or a denominator with letters cannot be factored.
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
    """The time function of one partial fraction: numerator/(linear or quadratic in s)**n, or a power of s."""
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
    if letters := base.free_symbols_in_domain:
        raise ValueError(f"cannot factor {base.as_expr()}: give numbers for {', '.join(sorted(map(str, letters)))}")
    return _inverse_numerically(numerator, base, n)


def _residue(rest, p, n):
    """The residue of rest/(s - p)**n * exp(s*t) at the pole p, without the factor exp(p*t)."""
    taylor = (rest.diff(s, n - 1 - k).subs(s, p) / sympy.factorial(n - 1 - k) for k in range(n))
    return sympy.Add(*(c * t**k / sympy.factorial(k) for k, c in enumerate(taylor)))


def _inverse_quadratic(numerator, base, n):
    """numerator/(a s**2 + b s + c)**n: a damped oscillation, or two exponentials where the roots are surely real."""
    a, b, c = base.all_coeffs()
    decay = b / (2 * a)
    square = sympy.factor(c / a - decay**2)
    frequency = sympy.sqrt(square)
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
    """numerator/base**n for a base of third or higher degree, at its roots."""
    found, f = base.nroots(n=15, maxsteps=200), sympy.S.Zero
    for p in found:
        others = sympy.Mul(base.LC(), *(s - q for q in found if q != p))
        real, imaginary = sympy.N(_residue(numerator / others**n, p, n), 15).expand().as_real_imag()
        decay, w = p.as_real_imag()
        if w == 0:
            f += real * sympy.exp(decay * t)
        elif w > 0:  # with its conjugate, twice the real part
            f += 2 * sympy.exp(decay * t) * (real * sympy.cos(w * t) - imaginary * sympy.sin(w * t))
    return f


# ------------------------------------------------------------------------------------------------ what they serve


def solve_ode(equations, initial=None):
    """Solve linear differential equations with constant coefficients by the Laplace transform.

    Arguments:
        equations: one equation, or a list of them, in unknown functions of `t`; inputs stand in it as known functions.
        initial: the initial values as in SymPy's dsolve, ``{y(0): 4, y(t).diff(t).subs(t, 0): 1}``. What is not
            given stays in the answer as a letter.
    Returns:
        y(t) for one equation; a dictionary {y(t): expression} for a list.
    Raises:
        ValueError: if the equations are not linear, or not as many as the unknown functions.
    Source: Haugen, Example 4.2.

    >>> y = sympy.Function("y")
    >>> solve_ode(sympy.Eq(y(t).diff(t), -2 * y(t)), {y(0): 4})
    4*exp(-2*t)
    """
    several = isinstance(equations, (list, tuple))
    equations = list(equations) if several else [equations]
    unknowns = sorted({f for e in equations for f in e.atoms(AppliedUndef) if f.args == (t,)}, key=str)
    if len(unknowns) != len(equations):
        names = ", ".join(map(str, unknowns)) or "no unknown function of t"
        raise ValueError(f"{len(equations)} equation(s) cannot determine {names}: give one equation for each unknown")
    solution = solve_transformed(equations, unknowns)
    at_start = {sympy.sympify(key): value for key, value in (initial or {}).items()}
    responses = {y: inverse(Y.subs(at_start)) for y, Y in zip(unknowns, solution, strict=True)}
    return responses if several else responses[unknowns[0]]


def solve_transformed(equations, unknowns):
    """Return the transforms of the unknown functions of t, solved from the transformed equations.

    >>> y, u = sympy.Function("y"), sympy.Function("u")
    >>> solve_transformed([sympy.Eq(y(t).diff(t) + y(t), u(t))], [y(t)])
    [(U(s) + y(0))/(s + 1)]
    """
    images = [transform(y) for y in unknowns]
    residuals = [transform(e.lhs) - transform(e.rhs) for e in equations]
    try:
        matrix, right = sympy.linear_eq_to_matrix(residuals, images)
    except sympy.solvers.solveset.NonlinearError:
        raise ValueError(f"the equations are not linear in {', '.join(map(str, unknowns))}") from None
    if matrix.shape[0] != matrix.shape[1] or sympy.cancel(matrix.det()) == 0:
        raise ValueError(f"the equations do not determine {', '.join(map(str, unknowns))}")
    return [sympy.factor(Y) for Y in matrix.LUsolve(right)]


def initial_value(F):
    """Return f(0+), the limit of s F(s) for s to infinity (the Initial Value Theorem).

    >>> initial_value(4 / (s + 2))
    4
    """
    return sympy.limit(s * F, s, sympy.oo)


def final_value(F):
    """Return what f(t) tends to as t grows, the limit of s F(s) for s to zero (the Final Value Theorem).

    The theorem holds only where f(t) settles: every pole of s F(s) must lie strictly left of the imaginary axis. The
    limit alone gives plausible numbers for functions that grow or swing for ever; this function does not.

    Raises ValueError when a pole lies elsewhere, or when that cannot be decided because a letter has no known sign.
    Source: Haugen, equation (4.22), with the condition that it needs.

    >>> final_value(12 / (s * (2 * s + 1)))
    12
    >>> final_value(1 / (s - 2))
    Traceback (most recent call last):
    ValueError: f(t) does not settle: s*F(s) has a pole at 2
    """
    sF = sympy.expand(s * F)
    for part in by_delay(sF).values():
        for pole in roots(sympy.cancel(sympy.together(part)).as_numer_denom()[1]):
            side = sympy.re(pole).is_negative
            if side is None:
                raise ValueError(f"cannot tell whether f(t) settles: the sign of the pole {pole} is not known")
            if not side and pole != 0:
                raise ValueError(f"f(t) does not settle: s*F(s) has a pole at {pole}")
    value = sympy.limit(sF, s, 0)
    if not value.is_finite:  # at s = 0 itself, dead times may cancel the pole of their parts
        raise ValueError("f(t) does not settle: s*F(s) has a pole at 0")
    return value


def roots(polynomial):
    """Return the roots of a polynomial in `s` as a sorted list, each as often as it occurs.

    Exact where linear and quadratic factors are enough; numbers to 15 digits where they are not.

    Raises ValueError for letters in a factor of third or higher degree.

    >>> roots((s + 1) ** 2 * (s**2 + 4))
    [-1, -1, -2*I, 2*I]
    """
    found = []
    for factor, n in sympy.factor_list(sympy.nsimplify(polynomial, rational=True), s)[1]:
        factor = sympy.Poly(factor, s)
        letters = factor.free_symbols_in_domain
        if factor.degree() <= 2:
            found += n * [root for root, times in sympy.roots(factor).items() for _ in range(times)]
        elif letters:
            names = ", ".join(sorted(map(str, letters)))
            raise ValueError(f"cannot factor {factor.as_expr()}: give numbers for {names}")
        else:
            found += n * factor.nroots(n=15, maxsteps=200)
    if any(root.free_symbols for root in found):
        return sorted(found, key=sympy.default_sort_key)
    return sorted(found, key=lambda root: tuple(float(x) for x in root.as_real_imag()))


def evaluate(f, times):
    """Return the values of f(t) at the given times as a NumPy array; a step has its new value at the step itself.

    Raises ValueError where f is no function of time alone: another letter is left, or an impulse, which has no value.

    >>> evaluate(sympy.exp(-t), [0, 1]).round(3)
    array([1.   , 0.368])
    """
    import numpy

    f, times = sympy.sympify(f), numpy.asarray(times, dtype=float)
    letters = sorted(map(str, f.free_symbols - {t}))
    if letters:
        raise ValueError(f"cannot evaluate {f}: give a number for {', '.join(letters)}")
    if f.has(sympy.DiracDelta):
        raise ValueError(f"cannot evaluate {f}: an impulse has an area but no value")
    function = sympy.lambdify(t, f, [{"Heaviside": lambda x, _=None: numpy.heaviside(x, 1.0)}, "numpy"])
    return numpy.broadcast_to(numpy.asarray(function(times), dtype=float), times.shape).copy()
