"""Integral criteria where a loop hardly settles: near the limit, light damping, slow modes."""

import math

import mpmath
import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.integrals import UnstableLoopError, criteria, integral_of_square, ise
from loopbook.integrals.error import ErrorFraction
from loopbook.integrals.modes import Modes, slow_modes
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.stability import ultimate
from test_ise import by_frequencies

DELAY = sympy.exp(-s)
ROOT_TWO = sympy.sqrt(2)


def to_limit(E, below):
    """The largest k for which the denominator of the loop of k/E is stable, less a share, as a fraction."""
    with mpmath.workdps(50):
        f = sympy.lambdify(s, E, "mpmath")
        omega = mpmath.findroot(lambda w: f(1j * w).imag, 0.7)
        return sympy.Rational(str(-1 / f(1j * omega).real)) * (1 - below)


# ------------------------------------------------------------------------------------------------ near the limit


@pytest.mark.parametrize("digits", [3, 5, 7, 9])
@pytest.mark.parametrize("method", [None, "response"])
def test_an_integrator_with_dead_time_near_the_limit(digits, method):
    k = to_limit(DELAY / s, sympy.Rational(1, 10**digits))
    with mpmath.workdps(40):
        x = mpmath.mpf(k.p) / k.q
        known = float(mpmath.cos(x) / (2 * x * (1 - mpmath.sin(x))))
    assert integral_of_square(1 / (s + k * DELAY), method) == pytest.approx(known, rel=2e-10)


@pytest.mark.parametrize("digits", [4, 7])
@pytest.mark.parametrize("late", [2, ROOT_TWO])
def test_an_integral_near_the_limit_with_several_dead_times(digits, late):
    L = (DELAY + sympy.exp(-late * s) / 2) / (s * (s + 1))
    loop = Loop(L, to_limit(L, sympy.Rational(1, 10**digits)))
    value = ise(loop)
    assert by_frequencies(loop.error("servo"), peak=2 * math.pi / ultimate(L)[1]) == pytest.approx(value, rel=1e-8)
    assert pytest.approx(value, rel=1e-9) == criteria(loop).ISE


def test_a_loop_beyond_the_limit_has_no_integral():
    k = to_limit(DELAY / s, -sympy.Rational(1, 10**9))
    for task in (ise, criteria):
        with pytest.raises(UnstableLoopError):
            task(DELAY / s, k)


@pytest.mark.parametrize("mode", ["servo", "regulator"])
def test_criteria_are_those_of_steps_and_half_periods_with_40_digits(mode):
    """An integrator with dead time: polynomials by the method of steps, then one pair of poles, half by half period."""
    process, k = DELAY / s, to_limit(DELAY / s, sympy.Rational(1, 10**4))
    found = criteria(process, PID(k, Ti=sympy.Integer(10**4)), mode, tolerance=1e-10)
    known = integral_of_square(Loop(process, PID(k, Ti=sympy.Integer(10**4))).error(mode))
    assert pytest.approx(known, rel=1e-9) == found.ISE
    if mode == "regulator":
        return
    found = criteria(process, k, tolerance=1e-10)
    with mpmath.workdps(40):
        assert found == pytest.approx([float(x) for x in steps_and_half_periods(mpmath.mpf(k.p) / k.q)], rel=2e-10)


def steps_and_half_periods(k, last=40):
    """The four criteria of e' = -k e(t - 1), e = 1 before t = 1."""
    pieces = [[mpmath.mpf(1)]]  # coefficients in t - n, the lowest first
    for n in range(1, last):
        integral = [mpmath.polyval(pieces[-1][::-1], 1), *(-k * c / (m + 1) for m, c in enumerate(pieces[-1]))]
        assert len(integral) == n + 1
        pieces.append(integral)
    total = [mpmath.mpf(0)] * 4
    for n, piece in enumerate(pieces):
        values = [mpmath.polyval(piece[::-1], mpmath.mpf(m) / 16) for m in range(17)]
        zeros = [
            mpmath.findroot(
                lambda x, piece=piece: mpmath.polyval(piece[::-1], x), (m / mpmath.mpf(16), (m + 1) / mpmath.mpf(16)),
                solver="anderson",
            )
            for m in range(16)
            if values[m] * values[m + 1] < 0
        ]  # fmt: skip
        for a, b in zip([0, *zeros], [*zeros, 1], strict=True):
            # Gauss-Legendre with 48 nodes would do; the antiderivatives are exact
            for weight, power in ((0, 2), (0, 1), (1, 1), (1, 2)):
                part = product(piece, piece) if power == 2 else piece
                part = product(part, [n, 1]) if weight else part
                value = antiderivative(part, b) - antiderivative(part, a)
                total[{(0, 2): 0, (0, 1): 1, (1, 1): 2, (1, 2): 3}[weight, power]] += abs(value)
    p = mpmath.findroot(lambda s: s + k * mpmath.exp(-s), mpmath.mpc(-0.0001, 1.57))
    residue = 1 / (1 - k * mpmath.exp(-p))

    def antiderivatives(time):
        wave = residue * mpmath.exp(p * time)
        square, mixed = wave**2, abs(wave) ** 2
        rate = 2 * p.real
        return (
            2 * (square / (2 * p)).real + 2 * mixed / rate,
            2 * (wave / p).real,
            2 * (wave * (time / p - 1 / p**2)).real,
            2 * (square * (time / (2 * p) - 1 / (2 * p) ** 2)).real + 2 * mixed * (time / rate - 1 / rate**2),
        )

    angle = mpmath.arg(residue)
    half = mpmath.pi / p.imag
    zero = (mpmath.pi / 2 - angle) / p.imag
    zero += mpmath.ceil((last - zero) / half) * half
    head = [abs(b - a) for a, b in zip(antiderivatives(mpmath.mpf(last)), antiderivatives(zero), strict=True)]
    q = mpmath.exp(p.real * half)
    one = [abs(b - a) for a, b in zip(antiderivatives(zero), antiderivatives(zero + half), strict=True)]
    squares, sizes = -antiderivatives(zero)[0], one[1] / (1 - q)
    # with u from the zero on: (zero + u) is the weight
    later = (one[2] - zero * one[1]) / (1 - q) + half * q * one[1] / (1 - q) ** 2
    tail = [squares, sizes, zero * sizes + later, -antiderivatives(zero)[3]]
    return [a + b + c for a, b, c in zip(total, head, tail, strict=True)]


def product(one, other):
    total = [mpmath.mpf(0)] * (len(one) + len(other) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(other):
            total[i + j] += a * b
    return total


def antiderivative(part, x):
    return sum(c * mpmath.mpf(x) ** (k + 1) / (k + 1) for k, c in enumerate(part))


# ------------------------------------------------------------------------------------------------ light damping


@pytest.mark.parametrize("damping", [1e-1, 1e-3, 1e-5, 1e-8])
def test_criteria_of_a_lightly_damped_oscillation(damping):
    """An error exp(-z t) cos(w t) + ..., of which each half period is the one before, smaller by one factor."""
    z = sympy.Rational(str(damping))
    found = criteria(1 / (s * (s + 2 * z)), 1)
    with mpmath.workdps(40):
        a = mpmath.mpf(z.p) / z.q
        w = mpmath.sqrt(1 - a**2)

        def e(t):
            return mpmath.exp(-a * t) * (mpmath.cos(w * t) + a / w * mpmath.sin(w * t))

        first = (mpmath.pi - mpmath.atan(w / a)) / w
        half = mpmath.pi / w
        q = mpmath.exp(-a * half)
        one = [abs(mpmath.quad(lambda t, n=n: t**n * e(t), [0, first])) for n in (0, 1)]
        other = [abs(mpmath.quad(lambda t, n=n: t**n * e(first + t), [0, half])) for n in (0, 1)]
        plain = other[0] / (1 - q)
        weighted = first * plain + other[1] / (1 - q) + half * q * other[0] / (1 - q) ** 2
        squares = 1 / (4 * a) + a
        # from the transform of e^2 and its slope at zero
        p = mpmath.mpc(-a, w)
        c = (1 - 1j * a / w) / 2
        time_squares = 2 * (c**2 / (2 * p) ** 2).real + 2 * abs(c) ** 2 / (2 * a) ** 2
    expected = [float(x) for x in (squares, one[0] + plain, one[1] + weighted, time_squares)]
    assert found == pytest.approx(expected, rel=2e-9)


def test_two_modes_that_last_long_together():
    """Against sums over a fine grid, until nothing is left."""
    z = sympy.Rational(1, 50)
    E = (s + z) / ((s + z) ** 2 + 1) + sympy.Rational(7, 10) * (s + z) / ((s + z) ** 2 + 3) + 1 / (s + z / 3) / 5
    fraction = ErrorFraction.of(E)
    modes = slow_modes(fraction, 1.0)
    assert len(modes.poles) == 3
    times = np.linspace(0, 4500, 1_500_001)
    e = np.exp(-times / 50) * (np.cos(times) + 0.7 * np.cos(math.sqrt(3) * times)) + np.exp(-times / 150) / 5
    plain, weighted = modes.sizes(0.0, (1e-9, 1e-6))
    assert plain == pytest.approx(np.trapezoid(abs(e), times), rel=1e-6)
    assert weighted == pytest.approx(np.trapezoid(times * abs(e), times), rel=1e-6)
    squares = modes.squares()
    assert squares[0] == pytest.approx(integral_of_square(E), rel=1e-11)
    assert squares[1] == pytest.approx(np.trapezoid(times * e**2, times), rel=1e-6)


def test_a_slow_mode_that_no_longer_changes_its_sign():
    modes = Modes(np.array([-1e-9 + 0j, -1e-5 + 1j]), np.array([1 + 0j, 3 + 0j]))
    plain, _ = modes.sizes(0.0, (1.0, 1e9))
    assert plain == pytest.approx(1e9, rel=1e-3)
    assert plain > 1e9


def test_resonances_beside_a_slow_pole():
    process = sympy.exp(-7 * s / 10) / (s**2 + s / 50_000 + 1)
    for controller in (PID(sympy.Rational(1, 10**6), 1000), sympy.Rational(1, 10**6) / s):
        found = criteria(process, controller, "regulator")
        error = Loop(process, controller).error("regulator")
        assert pytest.approx(by_frequencies(error), rel=1e-8) == found.ISE


def test_a_tail_much_slower_than_the_rest_is_not_overlooked():
    """1e-7 of the error that decays 1e6 times slower: it has a tenth of the integral of abs(e)."""
    E = 1 / (s + 1) + sympy.Rational(1, 10**7) / (s + sympy.Rational(1, 10**6))
    found = criteria(*as_loop(E))
    first = 1 + 1e-7
    assert pytest.approx(((1 + 0.1) / first, (1 + 1e5) / first), rel=1e-9) == (found.IAE, found.ITAE)
    assert integral_of_square(E, "response") == pytest.approx(0.5 + 2e-7 / (1 + 1e-6) + 5e-9, rel=1e-10)


def as_loop(E):
    """A process and a controller 1 for which the error is E times a factor that makes it begin with 1."""
    E = sympy.together(E / sympy.limit(s * E, s, sympy.oo))
    return sympy.cancel(1 / (s * E) - 1), 1
