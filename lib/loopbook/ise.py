"""Integral criteria of control loops with exact dead time: the integral of the squared error, and its relatives.

The integral of e(t)^2 is, by Parseval's theorem, 1/(2 pi j) times that of E(s) E(-s) along the imaginary axis. With one
dead time it is a sum of residues (Marshall, Gorecki, Korytowski and Walton, 1992), which gives closed formulas; with
dead times that are multiples of one it follows from a boundary value problem of linear differential equations; and it
can always be integrated numerically. All of this holds for stable loops only, and is plausible but wrong for others.
"""

import functools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import sympy

from loopbook.deadtime import Loop, System, normal_form
from loopbook.expressions import function_of, s
from loopbook.stability import StabilityLimitError, unstable_roots

__all__ = [
    "Criteria", "ResidueMethod", "UnstableLoopError", "criteria", "integral_of_square", "ise", "pi_first_order",
    "residue_method", "symbolic_pi_first_order",
]  # fmt: skip

MOST_STATES = 80  # of a boundary value problem
MOST_DIGITS_LOST = 1e-10  # the relative error that residues may have before another method is chosen
QUADRATURE_ERROR = 1e-9
NEGLIGIBLE = 1e-12  # the share of the integral that may be left when a response is cut off
MODES = ("servo", "regulator")


class UnstableLoopError(ValueError):
    """The loop is not stable, so that the integral of the squared error is infinite."""


def _mode(mode):
    if mode not in MODES:
        raise ValueError(f"the mode is {mode!r}: expected 'servo' or 'regulator'")
    return mode


# ------------------------------------------------------------------------------------------------ one dead time


@dataclass(frozen=True)
class ResidueMethod:
    """The residue method for one dead time, step by step: what `residue_method` returns.

    E(s) = (B + D z)/(A + C z) with z = exp(-delay*s). Where A + C z = 0, z is -A/C, and E(-s) is the rational function
    G(s) = (A B* - C D*)/(A A* - C C*), a star meaning -s for s. So E(s) (E(-s) - G(s)) has no poles there, and the
    integral of e(t)^2 is minus the sum of the residues of E(s) G(s) at the zeros of Delta = A A* - C C*.

    Attributes:
        A, B, C, D: polynomials, expressions in `s`.
        delay: the dead time.
    """

    A: sympy.Expr
    B: sympy.Expr
    C: sympy.Expr
    D: sympy.Expr
    delay: sympy.Expr

    @property
    def E(self):
        """The transform of the error, without a dead time that all of it has."""
        z = sympy.exp(-self.delay * s)
        return (self.B + self.D * z) / (self.A + self.C * z)

    @property
    def Delta(self):
        """A(s) A(-s) - C(s) C(-s), a polynomial in s^2."""
        return sympy.expand(self.A * _mirrored(self.A) - self.C * _mirrored(self.C))

    @property
    def G(self):
        """The rational function that E(-s) equals at the poles of E(s)."""
        return sympy.expand(self.A * _mirrored(self.B) - self.C * _mirrored(self.D)) / self.Delta

    @property
    def integrand(self):
        """E(s) G(s)."""
        return self.E * self.G

    @property
    def poles(self):
        """The zeros of Delta, a list in which each one is followed by its negative."""
        return [sign * sympy.sqrt(x) for x, _ in _squares(self.Delta) for sign in (1, -1)]

    @property
    def expr(self):
        """The integral of e(t)^2 as an expression, if the loop is stable, which is not examined.

        A zero p of Delta in the right half-plane is taken together with -p: the two residues have the sum F(p), in
        which no exponential grows, and which remains valid if A and C have a common zero at -p (as in regulator mode
        if Ti is equal to the lag), where the residue itself is not defined. A pair on the axis gives Re F(j omega).
        """
        formula, zeros = self.formula
        return formula.subs(zeros)

    @property
    def formula(self):
        """The same with letters for the zeros of Delta, and what they stand for: an expression and a dictionary.

        The letters are sigma for a pair on the real axis and omega for one on the imaginary axis, numbered if there are
        several.
        """
        total, zeros = sympy.S.Zero, {}
        squares = _squares(self.Delta)
        for number, (x, sign) in enumerate(squares, start=1):
            if sign is None:
                total -= self._plain_share(x)
                continue
            name = "sigma" if sign > 0 else "omega"
            if [other for _, other in squares].count(sign) > 1:
                name += f"_{number}"
            p = sympy.Symbol(name, positive=True)
            zeros[p] = sympy.sqrt(sign * x)
            total -= self._share(p, sign)
        return total, zeros

    def _plain_share(self, x):
        """The residues of E G at a zero and its negative, where letters leave open where they lie."""
        z = sympy.exp(-self.delay * s)
        above = (self.B + self.D * z) * sympy.expand(self.A * _mirrored(self.B) - self.C * _mirrored(self.D))
        residue = above / ((self.A + self.C * z) * self.Delta.diff(s))
        return residue.subs(s, sympy.sqrt(x)) + residue.subs(s, -sympy.sqrt(x))

    def _share(self, p, sign):
        """The same at p and -p with sign 1, or at j p and -j p with sign -1, p being positive."""
        parts = self.A, self.B, self.C, self.D
        A, B, C, D, slope, *mirrored = (
            sympy.expand(part.subs(s, p if sign > 0 else sympy.I * p))
            for part in (*parts, self.Delta.diff(s), *map(_mirrored, parts))
        )
        if sign > 0:
            z = sympy.Dummy("z")
            above, below = _both(A, B, C, D, mirrored[1], mirrored[3], z), (A + C * z) * slope
            return (sympy.factor(above) / sympy.factor(below)).subs(z, sympy.exp(-p * self.delay))
        above, below = _on_axis(A, B, C, D, *mirrored, p * self.delay)
        return sympy.factor(above) / sympy.factor(sympy.expand(below * slope / sympy.I))


def _both(A, B, C, D, B_mirrored, D_mirrored, z):
    """Delta' times (A + C z) times the sum of the residues of E G at p and -p, all functions taken at p.

    At -p take that of E (E* - G) instead, which is (B + D z)(A* D* - B* C*)/((A* z + C*) Delta): the same but for its
    sign, and its denominator has no zero there if the loop is stable.
    """
    return (B * B_mirrored + D * D_mirrored) * (A - C * z) + 2 * (A * D * B_mirrored * z - B * C * D_mirrored)


def _on_axis(A, B, C, D, A_mirrored, B_mirrored, C_mirrored, D_mirrored, angle):
    """The same at p = j omega, with (A* + C* / z) put on top and below and A A* = C C* used, so that it is real."""
    z = sympy.cos(angle) - sympy.I * sympy.sin(angle)
    one, other = sympy.expand(A * C_mirrored), sympy.expand(D * B_mirrored)
    real, imaginary = sympy.expand(one * z.conjugate()).as_real_imag()
    size = sympy.expand(A * A_mirrored)
    above = sympy.expand(B * B_mirrored + D * D_mirrored) * imaginary
    above += 2 * size * sympy.im(sympy.expand(other * z)) + 2 * sympy.im(sympy.expand(one * other))
    return above, size + real


def _mirrored(part):
    return part.subs(s, -s)


def _squares(Delta):
    """The zeros of a polynomial in s^2, as pairs (s^2, its sign or None where that is open or it is complex)."""
    x = sympy.Symbol("x")
    even = sympy.Poly(Delta, s)
    if even.is_zero:
        raise ValueError("A A* and C C* are equal, so that the residue method does not apply")
    found = []
    for factor, n in sympy.factor_list(sympy.Poly({(k // 2,): c for (k,), c in even.terms()}, x).as_expr(), x)[1]:
        polynomial = sympy.Poly(factor, x)
        c, *higher = reversed(polynomial.all_coeffs())
        if n > 1 or c == 0:
            raise ValueError(f"{Delta} has a repeated zero: expected simple ones; `ise` integrates by another method")
        if len(higher) == 1:
            roots = [sympy.factor(-c / higher[0])]
            found += [(roots[0], _sign(roots[0]))]
        elif len(higher) == 2:
            b, a = higher
            root = sympy.sqrt(sympy.factor(b**2 - 4 * a * c))
            if _sign(sympy.factor(c / a)) == -1:  # one on either side of zero
                a, b = (a, b) if _sign(a) == 1 else (-a, -b) if _sign(a) == -1 else (a, b)
            roots = [(-b + root) / (2 * a), (-b - root) / (2 * a)]
            apart = _sign(sympy.factor(c / a)) == -1 and _sign(a) == 1
            found += [(roots[0], 1), (roots[1], -1)] if apart else [(root, _sign(root)) for root in roots]
        else:
            raise ValueError(f"the zeros of {Delta} are not known in radicals; `ise` finds them in numbers")
    return found


def _sign(value):
    return 1 if value.is_positive else -1 if value.is_negative else None


def residue_method(E):
    """Return the pieces of the residue method for an error with one dead time, letters allowed.

    Arguments:
        E: expression in `s`, a fraction of polynomials with dead time, all dead times the same apart from one that the
            whole numerator has.
    Returns:
        A `ResidueMethod`.
    Raises:
        ValueError: for different dead times.
    Source: O'Dwyer and Ringwood, "A comparison of performance and robustness of time delay compensation techniques",
        equations (2) and (3).

    >>> k, delay = sympy.symbols("k delay", positive=True)
    >>> method = residue_method(1 / (s + k * sympy.exp(-delay * s)))
    >>> method.Delta, method.G, method.poles
    (-k**2 - s**2, s/(-k**2 - s**2), [I*k, -I*k])
    >>> method.expr
    -cos(delay*k)/(2*(k*sin(delay*k) - k))
    """
    above, below = normal_form(E)
    common = next((d for d in above if all((other - d).is_nonnegative for other in above)), 0)
    later = {d for d in (*above, *below) if d != 0}
    if len(later) > 1:
        above = {sympy.expand(d - common): part for d, part in above.items()}
        later = {d for d in (*above, *below) if d != 0}
    if len(later) > 1:
        raise ValueError(f"{E} has the dead times {', '.join(sorted(map(str, later)))}: expected one")
    delay = next(iter(later), sympy.S.Zero)
    parts = {"A": (below, 0), "B": (above, 0)} | ({"C": (below, delay), "D": (above, delay)} if delay != 0 else {})
    expressions = {name: source[d].as_expr() if d in source else sympy.S.Zero for name, (source, d) in parts.items()}
    return ResidueMethod(**({"C": sympy.S.Zero, "D": sympy.S.Zero} | expressions), delay=delay)


@functools.cache
def symbolic_pi_first_order(mode="servo"):
    """Return the integral of the squared error of a PI loop around a lag with dead time, as an expression.

    The process is K/(T*s + 1)*exp(-delay*s), the controller Kp*(1 + 1/(Ti*s)), the setpoint or the load a unit step. It
    is derived by `residue_method`, and valid for stable loops only.

    Arguments:
        mode: "servo" or "regulator".
    Returns:
        An expression in K, T, delay, Kp and Ti, positive symbols as ``sympy.symbols("K T delay Kp Ti", positive=True)``
        makes them.
    Raises:
        ValueError: for another mode.

    >>> K, T, delay, Kp, Ti = sympy.symbols("K T delay Kp Ti", positive=True)
    >>> formula = symbolic_pi_first_order("servo")
    >>> round(formula.subs({K: 1, T: 1, delay: 0.5, Kp: 1, Ti: 1}).evalf(), 6)
    0.842898
    """
    K, T, delay, Kp, Ti = sympy.symbols("K T delay Kp Ti", positive=True)
    process, controller = K * sympy.exp(-delay * s) / (T * s + 1), Kp * (1 + 1 / (Ti * s))
    forward = 1 if _mode(mode) == "servo" else -process
    return residue_method(forward / (1 + controller * process) / s).expr


def pi_first_order(K, T, delay, Kp, Ti, mode="servo", unstable=None):
    """Return the integral of the squared error of a PI loop around a lag with dead time, by its closed formula.

    The process is K/(T*s + 1)*exp(-delay*s), the controller Kp*(1 + 1/(Ti*s)), the setpoint or the load a unit step.
    With the zeros of Delta in the right half-plane and on the axis, sigma and j omega,

        ISE = Ti/(2 r) (P tan(x)/omega - Q y/sigma),
        x = (omega delay + atan(omega T) + atan(1/(omega Ti)))/2,  y = (1 - L(sigma))/(1 + L(sigma)),
        r = sqrt(Ti^2 (k^2 - 1)^2 + 4 k^2 T^2),  k = K Kp,

    with P = 1 + omega^2 T^2 and Q = 1 - sigma^2 T^2 for the setpoint, P = Q = K^2 for the load. The loop is stable
    where 2 x < pi. The relative error is about 1e-14, and larger only very near to that limit.

    Arguments:
        K, Kp: gains of process and controller.
        T, delay, Ti: lag, dead time (0 is allowed) and integral time, in one unit of time.
        mode: "servo" or "regulator".
        unstable: the value to return for unstable settings, as ``math.inf``; without it they are an error.
        Each number may be an array; arrays are broadcast.
    Returns:
        A float, or an array: the setpoint's unit squared, or the load's with K squared, times the unit of time.
    Raises:
        UnstableLoopError: for settings that are not stable, unless `unstable` is given.
        ValueError: for times that are not positive and finite, or another mode.

    >>> round(pi_first_order(K=1, T=1, delay=0.5, Kp=1, Ti=1), 6)
    0.842898
    >>> pi_first_order(1, 1, 0.5, Kp=[1, 9], Ti=1, unstable=math.inf).round(6)
    array([0.842898,      inf])
    """
    _mode(mode)
    given = (K, T, delay, Kp, Ti)
    if all(isinstance(x, (float, int)) for x in given):
        if not (0 < T < math.inf and 0 <= delay < math.inf and 0 < Ti < math.inf and math.isfinite(K * Kp)):
            raise _wrong(*given)
        if K * Kp > 0:
            x, value = _pi_first_order(math, lambda condition, one, other: one if condition else other, *given, mode)
            if x < math.pi / 2:
                return value
        if unstable is None:
            raise _unstable(*given)
        return unstable

    import numpy

    given = numpy.broadcast_arrays(*(numpy.asarray(x, dtype=float) for x in given))
    K, T, delay, Kp, Ti = given
    with numpy.errstate(over="ignore", invalid="ignore"):
        right = (T > 0) & (delay >= 0) & (Ti > 0) & numpy.isfinite(K * Kp) & numpy.isfinite(T + delay + Ti)
    if not right.all():
        raise _wrong(*(float(x[~right][0]) for x in given))
    with numpy.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x, value = _pi_first_order(numpy, numpy.where, *given, mode)
        stable = (x < math.pi / 2) & (K * Kp > 0)
    if not stable.all():
        if unstable is None:
            raise _unstable(*(float(x[~stable][0]) for x in given))
        value = numpy.where(stable, value, unstable)
    return value[()]


def _pi_first_order(m, where, K, T, delay, Kp, Ti, mode):
    """The angle x and the integral; `m` is math or numpy."""
    k = K * Kp
    # k^2 - 1 is small where k is about 1, and then the rounding of the product K Kp counts
    b = Ti * ((k - 1) + _rounded_off(K, Kp, k)) * (k + 1)
    r = m.hypot(b, 2 * k * T)
    larger = (abs(b) + r) / 2
    # sigma and omega: the larger from the sum, which does not cancel, and the smaller from the product of both
    fast, slow = m.sqrt(larger / Ti) / T, k / m.sqrt(Ti * larger)
    omega, sigma = where(b >= 0, fast, slow), where(b >= 0, slow, fast)
    x = (omega * delay + m.atan(omega * T) + m.atan2(1, omega * Ti)) / 2
    L = k * (1 + Ti * sigma) / (Ti * sigma * (1 + T * sigma)) * m.exp(-sigma * delay)
    y = (1 - L) / (1 + L)
    P, Q = (1 + (omega * T) ** 2, (1 - T * sigma) * (1 + T * sigma)) if mode == "servo" else (K**2, K**2)
    return x, Ti / (2 * r) * (P * m.tan(x) / omega - Q * y / sigma)


def _rounded_off(a, b, product):
    """What floating point left out of the product of a and b. (T. J. Dekker, Numerische Mathematik 18, 1971)"""
    split = 134217729.0  # 2^27 + 1
    a_high, b_high = split * a - (split * a - a), split * b - (split * b - b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _settings(K, T, delay, Kp, Ti):
    return f"K = {K:g}, T = {T:g}, delay = {delay:g}, Kp = {Kp:g}, Ti = {Ti:g}"


def _wrong(*given):
    expected = "finite numbers, T and Ti positive, delay not negative"
    return ValueError(f"the settings are {_settings(*given)}: expected {expected}")


def _unstable(*given):
    return UnstableLoopError(f"the loop is not stable for {_settings(*given)}: its error has no integral")


# ------------------------------------------------------------------------------------------------ any loop


def ise(process, controller=None, mode="servo", from_setpoint=None, method=None):
    """Return the integral of the squared control error after a unit step, with exact dead time.

    Arguments:
        process, controller, from_setpoint: as for `deadtime.Loop`; or a loop alone in place of the process.
        mode: "servo" for a step of the setpoint, "regulator" for one of the load at the process input.
        method: as for `integral_of_square`.
    Returns:
        A float: the output's unit squared, times the unit of time.
    Raises:
        UnstableLoopError: if the loop is not stable.
        ValueError: for an error that does not vanish, as under proportional control, or as `integral_of_square`.

    >>> from loopbook.pid import PID
    >>> round(ise(sympy.exp(-s / 2) / (s + 1), PID(1, Ti=1)), 6)
    0.842898
    """
    return integral_of_square(_error(process, controller, mode, from_setpoint), method)


def _error(process, controller, mode, from_setpoint):
    if isinstance(process, Loop):
        if controller is not None or from_setpoint is not None:
            raise ValueError("a loop has its controller already: expected no other one")
        return process.error(_mode(mode))
    if controller is None:
        raise ValueError("the controller is missing: expected one, or a loop in place of the process")
    return Loop(process, controller, from_setpoint).error(_mode(mode))


def integral_of_square(E, method=None):
    """Return the integral of e(t)^2 from zero to infinity, for the transform E(s) of e(t).

    The methods, of which the first that can be applied is taken unless one is named:

    - "residues": one dead time, or none; the formula of `residue_method` in floating point, with a bound of the digits
      that it loses where zeros lie close together.
    - "boundary value": all dead times multiples of one. The autocorrelation of the response of 1/D, D being the
      denominator, fulfils linear differential equations with conditions at both ends. They are solved in two units of
      time, and the results have to agree to 1e-10.
    - "quadrature": any dead times. Parseval's integral along the frequencies, in intervals in which no pole is near;
      relative error below 1e-9.
    - "response": from the exact step response, followed until the rest is negligible; relative error about 1e-10.

    The second and the third need a retarded system, in which the highest derivative has no dead time.

    Arguments:
        E: expression in `s` with numbers, or a `System`.
        method: one of the names, or None.
    Returns:
        A float.
    Raises:
        UnstableLoopError: for poles of E in the right half-plane or on the imaginary axis.
        ValueError: if e(t) does not vanish, contains an impulse, or the method cannot be applied to it.

    >>> integral_of_square(1 / (s + 1))
    0.5
    >>> E = 1 / (s + sympy.exp(-s) + sympy.exp(-2 * s) / 5)
    >>> [round(integral_of_square(E, method), 8) for method in ("boundary value", "quadrature", "response")]
    [2.5688072, 2.5688072, 2.5688072]
    """
    if method is not None and method not in METHODS:
        raise ValueError(f"the method is {method!r}: expected one of {', '.join(METHODS)}")
    fraction = _Fraction.of(E)
    if fraction is None:
        return 0.0
    names = METHODS if method is None else [method]
    reasons = []
    for name in names:
        try:
            return METHODS[name](fraction)
        except _NotApplicableError as reason:
            reasons.append(f"{name}: {reason}")
    raise ValueError(f"the integral cannot be found by {'; '.join(reasons)}")


def _fraction(number):
    return Fraction(int(number.p), int(number.q))


def _taylor_coefficient(parts, k):
    """The coefficient of s^k of a sum of polynomials with dead times, exact."""
    return sum(
        c * (-delay) ** (k - i) / math.factorial(k - i)
        for delay, part in parts.items()
        for i, c in enumerate(part[: k + 1])
    )


class _NotApplicableError(Exception):
    """Why a method is not the one for this error."""


@dataclass(frozen=True)
class _Fraction:
    """An error that has an integral: E = N/(s^pole D), all poles of 1/D in the left half-plane.

    The step of the input makes a pole at zero, which N cancels. A Smith predictor does that by its dead times, as in
    (1 - exp(-s))/s, and no common factor can be taken out.
    """

    system: System
    N: dict  # {delay: coefficients, lowest power first}, exact
    D: dict
    pole: int

    @classmethod
    def of(cls, E):
        system = E if isinstance(E, System) else System(function_of(s, E))
        if not system.numerator:
            return None
        order = system.denominator[0].degree()
        if any(part.degree() >= order for part in system.numerator.values()):
            raise ValueError(f"{system.expr} is not strictly proper: e(t) contains an impulse")
        N, D = (
            {_fraction(delay): [_fraction(c) for c in reversed(part.all_coeffs())] for delay, part in parts.items()}
            for parts in (system.numerator, system.denominator)
        )
        first = min(N)
        N = {delay - first: part for delay, part in N.items()}  # later by a dead time, the integral is the same
        pole = min(next(k for k, c in enumerate(part) if c) for part in D.values())
        D = {delay: part[pole:] for delay, part in D.items()}
        try:
            factor = sympy.Poly(s**pole, s, domain="QQ")
            unstable = unstable_roots({delay: part.quo(factor) for delay, part in system.denominator.items()})
        except StabilityLimitError:
            raise UnstableLoopError(f"E(s) = {system.expr} is not stable: it has poles on the imaginary axis") from None
        if unstable:
            raise UnstableLoopError(f"E(s) = {system.expr} is not stable: {unstable} poles in the right half-plane")
        for k in range(pole):
            if _taylor_coefficient(N, k):
                raise ValueError(f"the error does not vanish: E(s) = {system.expr} has a pole at zero")
        return cls(system, N, D, pole)

    @property
    def order(self):
        """The degree of D."""
        return len(self.D[0]) - 1

    @property
    def speed(self):
        """A frequency beside which no pole without dead time is large."""
        leading = abs(float(self.D[0][-1]))
        sizes = [sum(abs(float(part[k])) for part in self.D.values() if k < len(part)) for k in range(self.order)]
        found = [(size / leading) ** (1 / (self.order - k)) for k, size in enumerate(sizes)]
        return max(found, default=self._of_dead_times)

    @property
    def mean_speed(self):
        """The geometric mean of the poles, the dead times left out of account."""
        lowest = abs(float(sum(part[0] for part in self.D.values()) / self.D[0][-1]))
        return lowest ** (1 / self.order) if self.order else self._of_dead_times

    @property
    def _of_dead_times(self):
        longest = float(max((*self.N, *self.D)))
        return 1 / longest if longest else 1.0

    def arrays(self, speed):
        """Coefficients of N and D in s/speed, a row for each dead time, and the dead times, as arrays of floats."""
        import numpy

        leading = float(self.D[0][-1]) * speed ** (self.order + self.pole)

        def rows(parts, columns, factor):
            table = numpy.zeros((len(parts), columns))
            for row, part in zip(table, parts.values(), strict=True):
                row[: len(part)] = [float(c) * speed**k * factor / leading for k, c in enumerate(part)]
            return table, numpy.array([float(delay) * speed for delay in parts])

        return *rows(self.N, self.order + self.pole, 1), *rows(self.D, self.order + 1, speed**self.pole)

    def need_retarded(self):
        if self.system.is_neutral:
            raise _NotApplicableError("the highest derivative has a dead time")


# ------------------------------------------------------------------------------------------------ residues


def _by_residues(fraction):
    """One dead time: minus the sum of Re F(p) over the zeros p of Delta, one of each p and -p (see `ResidueMethod`)."""
    import numpy

    later = {delay for delay in (*fraction.N, *fraction.D) if delay}
    if len(later) > 1:
        raise _NotApplicableError("there are different dead times")
    if fraction.pole:
        raise _NotApplicableError("Delta has a zero at zero")
    delay = next(iter(later), 0)
    A, B = (parts.get(0, []) for parts in (fraction.D, fraction.N))
    C, D = (parts.get(delay, []) if delay else [] for parts in (fraction.D, fraction.N))
    Delta = [a - c for a, c in zip(_squared(A, len(A)), _squared(C, len(A)), strict=True)]
    lowest, highest = Delta[0], Delta[-1]
    if not lowest or not highest:
        raise _NotApplicableError("Delta has a zero at zero or at infinity")
    n = len(Delta) - 1
    # in a unit of time in which the product of the zeros is 1
    square = abs(float(lowest / highest)) ** (1 / n)
    scaled = numpy.array([float(c / lowest) * square**k for k, c in enumerate(Delta)])
    x = numpy.roots(scaled[::-1])
    with numpy.errstate(all="ignore"):
        slope = numpy.polyval(numpy.polyder(scaled[::-1]), x)
        sensitivity = numpy.polyval(abs(scaled[::-1]), abs(x)) / abs(x * slope)
        p = numpy.sqrt(x.astype(complex)) * math.sqrt(square)
        A, B, C, D, B_mirrored, D_mirrored = (
            numpy.polyval([float(c) for c in part[::-1]], point)
            for part, point in ((A, p), (B, p), (C, p), (D, p), (B, -p), (D, -p))
        )
        z = numpy.exp(-float(delay) * p)
        # dDelta/ds = 2 s dDelta/d(s^2)
        shares = _both(A, B, C, D, B_mirrored, D_mirrored, z) / ((A + C * z) * 2 * p * slope * float(lowest) / square)
        total = -float(shares.real.sum())
        near = (abs(A) + abs(C * z)) * (1 + abs(p) * float(delay)) / abs(A + C * z)
        lost = 4e-16 * float((abs(shares) * ((1 + sensitivity) ** 2 + near)).sum())
    if not lost <= MOST_DIGITS_LOST * total:
        raise _NotApplicableError("zeros of Delta lie too close together")
    return total


def _squared(part, length):
    """The coefficients of part(s) part(-s) in s^2, exact."""
    coefficients = [Fraction(0)] * length
    for i, a in enumerate(part):
        for j, b in enumerate(part):
            if (i + j) % 2 == 0:
                coefficients[(i + j) // 2] += a * b * (-1) ** j
    return coefficients


# ------------------------------------------------------------------------------------------------ boundary values


def _by_boundary_values(fraction):
    """Dead times h, 2h ... m h: the autocorrelation of the response of 1/D from a boundary value problem.

    R(theta), the integral of x(t) x(t + theta) where D x = delta, is even, and D R = 0 for theta > 0, because x is zero
    before t = 0. On an interval of length h the functions phi_j(theta) = R(j h + theta) and
    psi_j(theta) = R((j + 1) h - theta), j < m, fulfil ordinary differential equations. At zero the odd derivatives of
    R vanish, but that of order 2n - 1 jumps to (-1)^n/2; the pieces are joined; in the middle phi_j is psi_j, mirrored.
    The integral of e^2 is N(s, z) N(-s, 1/z) applied to R at zero, s being the derivative and z the shift.

    A pole at zero that N cancels makes W in place of R, with R as its second derivative (but for the sign): that is D
    with two more powers of s, and values that are zero at zero.
    """
    fraction.need_retarded()
    # rounding comes out otherwise in another unit of time
    one, other = (_from_autocorrelation(fraction, factor * fraction.mean_speed) for factor in (1.0, 1.6))
    if not abs(one - other) <= MOST_DIGITS_LOST * one:
        raise _NotApplicableError(f"rounding leaves {one:.12g} or {other:.12g}")
    return one


def _from_autocorrelation(fraction, speed):
    """The integral from the boundary value problem, solved with 1/speed as the unit of time."""
    import numpy
    from scipy.linalg import expm

    delays = [d for d in (*fraction.N, *fraction.D) if d]
    unit = Fraction(math.gcd(*(d.numerator for d in delays)) or 1, math.lcm(*(d.denominator for d in delays)))
    m = int(max(delays, default=1) / unit)
    twice = 2 * fraction.pole
    order = fraction.order + twice
    states = 2 * m * order
    if states > MOST_STATES:
        raise _NotApplicableError(f"it has {states} states, more than {MOST_STATES}")
    h = float(unit) * speed
    above, above_delays, below, below_delays = fraction.arrays(speed)
    N, D = numpy.zeros((m + 1, above.shape[1])), numpy.zeros((m + 1, order))
    N[numpy.rint(above_delays / h).astype(int)] = above
    D[numpy.rint(below_delays / h).astype(int), twice:] = below[:, :-1]

    def place(j):  # of phi_j, and of psi_j m places later
        return slice(j * order, (j + 1) * order)

    M = numpy.kron(numpy.eye(2 * m), numpy.diag(numpy.ones(order - 1), 1))
    mirror = (-1.0) ** numpy.arange(order)
    for j in range(m):
        for i in range(m + 1):
            forward, back = (j - i, m + j - i) if i <= j else (m + i - j - 1, i - j - 1)
            M[(j + 1) * order - 1, place(forward)] -= D[i]
            M[(m + j + 1) * order - 1, place(back)] -= D[i] * mirror * (-1) ** order

    # the derivatives at zero, as rows that multiply the state
    highest = twice + 2 * fraction.order - 1
    derivatives = [numpy.eye(1, states)]
    for _ in range(highest):
        derivatives.append(derivatives[-1] @ M)
    at_zero = [*range(twice), *range(twice + 1, highest + 1, 2)]
    start = numpy.vstack([derivatives[k] for k in at_zero])
    value = numpy.zeros(states)
    value[len(at_zero) - 1] = (-1) ** (fraction.pole + fraction.order) / 2
    joined = numpy.zeros(((m - 1) * order, states))
    for j in range(m - 1):
        joined[place(j), place(m + j)] = numpy.diag(mirror)
        joined[place(j), place(j + 1)] = -numpy.eye(order)
    middle = numpy.hstack([numpy.eye(m * order), -numpy.kron(numpy.eye(m), numpy.diag(mirror))])

    # left @ Y(0) + right @ Y(h/2) = 0, from short steps, which are joined without forming a large exponential
    doublings = max(0, math.ceil(math.log2(abs(M).sum(axis=1).max() * h / 2)))
    left, right = -expm(M * (h / 2 / 2**doublings)), numpy.eye(states)
    for _ in range(doublings):
        combination = numpy.linalg.qr(numpy.vstack([right, left]), mode="complete")[0][:, states:].T
        left, right = combination[:, :states] @ left, combination[:, states:] @ right
    nothing = numpy.zeros((m * order, states))
    system = numpy.block([[numpy.vstack([start, joined]), nothing], [left, right], [nothing, middle]])
    Y = numpy.linalg.solve(system, numpy.concatenate([value, numpy.zeros(states)]))[:states]

    mirrored, total = N * (-1.0) ** numpy.arange(N.shape[1]), 0.0
    for shift in range(m + 1):
        product = sum(numpy.convolve(N[q + shift], mirrored[q]) for q in range(m + 1 - shift))
        if not product.any():
            continue
        # R at shift*h: the beginning of phi, or the one of the last psi, where the direction is the other one
        row = numpy.zeros(states)
        row[(shift if shift < m else 2 * m - 1) * order] = 1
        direction = -1.0 if shift < m else 1.0
        for k, c in enumerate(product):
            total += (1 if shift == 0 else 2) * c * direction**k * (row @ Y)
            row = row @ M
    return float(total) * speed


# ------------------------------------------------------------------------------------------------ quadrature


def _by_quadrature(fraction):
    """Parseval's integral, after what E is for large s has been taken out and integrated by a formula."""
    import numpy

    fraction.need_retarded()
    speed = fraction.speed
    above, above_delays, below, below_delays = fraction.arrays(speed)
    longest = below_delays.max()
    size, powers = abs(below), numpy.arange(below.shape[1])

    def D(w):
        return _sum(below, below_delays, w)

    expansion, rest = _for_large_s(above, above_delays, below, below_delays, fraction.pole)

    def integrand(w):
        asymptotic = sum(c * (1j * w + 1) ** -k * numpy.exp(-1j * w * delay) for (delay, k), c in expansion.items())
        E = _sum(above, above_delays, w) / D(w) / (1j * w) ** fraction.pole
        return abs(E) ** 2 - abs(asymptotic) ** 2

    def near(center, radius):  # whether a pole may lie within two radii
        far = center + 2 * radius
        growth = numpy.exp(2 * radius[:, None] * below_delays)
        terms = size[:, 1:] * powers[1:]
        slope = numpy.stack([numpy.polyval(row[::-1], far) for row in terms], axis=1)
        slope = slope + below_delays * numpy.stack([numpy.polyval(row[::-1], far) for row in size], axis=1)
        return (abs(D(center)) <= 2 * radius * (growth * slope).sum(axis=1)) | (2 * radius > numpy.hypot(center, 1))

    nodes, weights = numpy.polynomial.legendre.leggauss(16)
    fewer, their_weights = numpy.polynomial.legendre.leggauss(12)
    # of a unit of time in which the speed is 1; the integrand turns with twice the longest dead time
    longest = max(longest, above_delays.max())
    total, error, begin, end = _square_of_expansion(expansion), 0.0, 0.0, 8.0
    for _ in range(12):
        ends = numpy.linspace(begin, end, 1 + math.ceil((end - begin) * max(longest, 1)))
        a, b = ends[:-1], ends[1:]
        while len(a):
            center, radius = (a + b) / 2, (b - a) / 2
            split = near(center, radius)
            if split.any() and radius[split].min() < 1e-13 * end:
                raise _NotApplicableError("a pole lies too near to the imaginary axis")
            c, r = center[~split, None], radius[~split, None]
            one, other = (integrand(c + r * x) @ w * r[:, 0] for x, w in ((nodes, weights), (fewer, their_weights)))
            total += one.sum() / math.pi
            error += abs(one - other).sum() / math.pi
            a, b = numpy.concatenate([a[split], center[split]]), numpy.concatenate([center[split], b[split]])
        left = rest(end) / math.pi
        if error + left <= QUADRATURE_ERROR * abs(total) / 10:
            return float(total) * speed
        begin, end = end, 2 * end
    raise _NotApplicableError(f"an error of {(error + left) / abs(total):.0e} was left")


def _sum(coefficients, delays, w):
    """The value of a sum of polynomials with dead times at s = j w."""
    import numpy

    return sum(
        numpy.polyval(row[::-1] * 1j ** numpy.arange(len(row))[::-1], w) * numpy.exp(-1j * w * delay)
        for row, delay in zip(coefficients, delays, strict=True)
    )


TERMS = 3  # of the expansion for large s


def _for_large_s(above, above_delays, below, below_delays, pole):
    """E for large s as the sum of c exp(-delay*s)/(s + 1)^k, {(delay, k): c}, and a bound of what that leaves out."""
    import numpy

    def in_powers(row, order):  # the polynomial divided by (s + 1)^order, in powers of u = 1/(s + 1)
        shifted = numpy.polynomial.Polynomial(row)(numpy.polynomial.Polynomial([-1, 1])).coef  # in powers of s + 1
        found = numpy.zeros(TERMS + 2)
        for k, c in enumerate(shifted):
            if order - k < len(found):
                found[order - k] += c
        return found

    order = below.shape[1] - 1 + pole
    below = numpy.hstack([numpy.zeros((len(below), pole)), below])
    numerator, denominator = (
        [(round(delay, 12), in_powers(row, order)) for delay, row in zip(delays, rows, strict=True)]
        for delays, rows in ((above_delays, above), (below_delays, below))
    )
    levels = []  # the coefficients of u^k, by their dead times
    for k in range(TERMS + 2):
        level = {}
        for delay, row in numerator:
            level[delay] = level.get(delay, 0.0) + row[k]
        for delay, row in denominator:
            for q in range(1, k + 1):
                for earlier, c in levels[k - q].items():
                    later = round(delay + earlier, 12)
                    level[later] = level.get(later, 0.0) - row[q] * c
        levels.append({delay: c for delay, c in level.items() if c})
    sizes = [sum(map(abs, level.values())) for level in levels]

    def rest(w):
        asymptotic = sum(size / w**k for k, size in enumerate(sizes[:-1]) if k)
        return 4 * asymptotic * sizes[-1] * w**-TERMS / TERMS

    return {(delay, k): c for k, level in enumerate(levels[:-1]) for delay, c in level.items()}, rest


def _square_of_expansion(expansion):
    """The integral of the square of the sum of c t^(k-1)/(k-1)! exp(-t), each beginning at its dead time."""
    total = 0.0
    for (one, k), c in expansion.items():
        for (other, n), d in expansion.items():
            (p, q), apart = ((k - 1, n - 1) if one >= other else (n - 1, k - 1)), abs(one - other)
            # the integral of t^p/p! (t + apart)^q/q! exp(-2 t - apart)
            total += c * d * math.exp(-apart) * sum(
                apart ** (q - r) / math.factorial(q - r) * math.comb(p + r, p) / 2 ** (p + r + 1) for r in range(q + 1)
            )  # fmt: skip
    return total


# ------------------------------------------------------------------------------------------------ responses


class Criteria(NamedTuple):
    """Integrals of the error e(t), or of its size, with and without the time as a weight: what `criteria` returns."""

    ISE: float
    IAE: float
    ITAE: float
    ITSE: float


def criteria(process, controller=None, mode="servo", from_setpoint=None, tolerance=1e-9):
    """Return four integral criteria of the control error after a unit step, from the exact response.

    The response is a polynomial in each of its segments. The integrals of abs(e) are those between its zeros, so that
    nothing is approximated but the rest beyond a time after which it does not matter.

    Arguments:
        process, controller, mode, from_setpoint: as for `ise`.
        tolerance: the share of each integral that may be left out.
    Returns:
        `Criteria`: the integrals of e^2, abs(e), t abs(e) and t e^2.
    Raises:
        UnstableLoopError, ValueError: as `ise`; or where the response lasts too long to be followed.

    >>> [round(value, 6) for value in criteria(1 / s, 1)]
    [0.5, 1.0, 1.0, 0.25]
    """
    fraction = _Fraction.of(_error(process, controller, mode, from_setpoint))
    if fraction is None:
        return Criteria(0.0, 0.0, 0.0, 0.0)
    return Criteria(*map(float, _followed(fraction, _four_integrals, tolerance)))


def _four_integrals(response):
    """The integrals over each segment of e^2, abs(e), t abs(e) and t e^2."""
    import numpy
    from numpy.polynomial import legendre

    times, weights = response.quadrature()
    e = response(times)
    table = numpy.stack([e**2, abs(e), times * abs(e), times * e**2])
    table = (table * weights).sum(axis=2).T
    nodes, their_weights = legendre.leggauss(e.shape[1])
    coefficients = response.coefficients
    # only where the mean is not larger than all the rest can there be a zero
    for k in numpy.flatnonzero(abs(coefficients[:, 0]) <= abs(coefficients[:, 1:]).sum(axis=1)):
        row = numpy.trim_zeros(coefficients[k], "b")
        zeros = legendre.legroots(row) if len(row) > 1 else numpy.array([])
        zeros = numpy.sort(zeros.real[(abs(zeros.imag) < 1e-6) & (abs(zeros.real) < 1)])
        if not len(zeros):
            continue
        edges = numpy.r_[-1, zeros, 1]
        half = numpy.diff(edges)[:, None] / 2
        local = edges[:-1, None] + half * (nodes + 1)
        length = response.edges[k + 1] - response.edges[k]
        size = abs(legendre.legval(local, row)) * half * their_weights * length / 2
        table[k, 1:3] = size.sum(), (size * (response.edges[k] + length / 2 * (local + 1))).sum()
    return table


def _by_response(fraction):
    def squares(response):
        times, weights = response.quadrature()
        return (weights * response(times) ** 2).sum(axis=1, keepdims=True)

    return float(_followed(fraction, squares, NEGLIGIBLE)[0])


def _followed(fraction, integrals, tolerance):
    """Integrals over the response, followed twice as far until the later half adds nothing that matters."""
    e = System(s * fraction.system.expr)
    end = 4 * float(sum(fraction.system.delays)) + 16 / fraction.speed
    while True:
        response = e.step_until(end)
        table = integrals(response)
        total, later = table.sum(axis=0), table[response.edges[1:] > end / 2].sum(axis=0)
        if (later <= tolerance * total).all():
            return total
        end *= 2


METHODS = {
    "residues": _by_residues,
    "boundary value": _by_boundary_values,
    "quadrature": _by_quadrature,
    "response": _by_response,
}
