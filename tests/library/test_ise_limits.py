"""Integral criteria where a loop hardly settles: near the limit, light damping, slow modes; and families of loops."""

import math
import random
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.deadtime import Loop
from loopbook.ise import UnstableLoopError, criteria, integral_of_square, ise, ise_family, pi_first_order
from loopbook.ise.error import ErrorFraction
from loopbook.ise.modes import Modes, slow_modes
from loopbook.ise.one_delay import OneDelay, routh
from loopbook.pid import PID
from loopbook.stability import StabilityLimitError, unstable_roots

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
@pytest.mark.parametrize("method", [None, "residues", "quadrature", "response"])
def test_an_integrator_with_dead_time_near_the_limit(digits, method):
    k = to_limit(DELAY / s, sympy.Rational(1, 10**digits))
    with mpmath.workdps(40):
        x = mpmath.mpf(k.p) / k.q
        known = float(mpmath.cos(x) / (2 * x * (1 - mpmath.sin(x))))
    assert integral_of_square(1 / (s + k * DELAY), method) == pytest.approx(known, rel=2e-10)


@pytest.mark.parametrize("digits", [4, 7])
@pytest.mark.parametrize("late", [2, ROOT_TWO])
def test_methods_agree_near_the_limit_with_several_dead_times(digits, late):
    L = (DELAY + sympy.exp(-late * s) / 2) / (s * (s + 1))
    loop = Loop(L, to_limit(L, sympy.Rational(1, 10**digits)))
    by_response = integral_of_square(loop.error("servo"), "response")
    for method in (None, "quadrature"):
        value = integral_of_square(loop.error("servo"), method)
        assert value == pytest.approx(by_response, rel=1e-9)
    assert pytest.approx(by_response, rel=1e-9) == criteria(loop).ISE


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
    known = integral_of_square(Loop(process, PID(k, Ti=sympy.Integer(10**4))).error(mode), "residues")
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
        by_residues = ise(process, controller, "regulator", method="residues")
        by_quadrature = ise(process, controller, "regulator", method="quadrature")
        assert pytest.approx(by_residues, rel=1e-9) == found.ISE
        assert by_quadrature == pytest.approx(by_residues, rel=1e-9)


def test_a_tail_much_slower_than_the_rest_is_not_overlooked():
    """1e-7 of the error that decays 1e6 times slower: it has a tenth of the integral of abs(e)."""
    E = 1 / (s + 1) + sympy.Rational(1, 10**7) / (s + sympy.Rational(1, 10**6))
    found = criteria(*as_loop(E))
    first = 1 + 1e-7
    assert pytest.approx(((1 + 0.1) / first, (1 + 1e5) / first), rel=1e-9) == (found.IAE, found.ITAE)
    assert integral_of_square(E, "response") == pytest.approx(integral_of_square(E, "residues"), rel=1e-10)


def as_loop(E):
    """A process and a controller 1 for which the error is E times a factor that makes it begin with 1."""
    E = sympy.together(E / sympy.limit(s * E, s, sympy.oo))
    return sympy.cancel(1 / (s * E) - 1), 1


# ------------------------------------------------------------------------------------------------ many digits


@pytest.mark.parametrize(
    ("E", "known"),
    [
        (1 / (s + 1) ** 5, sympy.Rational(math.comb(8, 4), 2**9)),
        (1 / (s**2 + s / 1000 + 1), 500),
        ((1 - DELAY) / s, 1),
        ((1 - DELAY) / (s * (s + 1)), math.exp(-1)),
        ((1 - DELAY) / (s * (s + 1) ** 2), None),
        ((s + 2) / ((s + 2) * (s + DELAY / 2) + sympy.Rational(1, 10**9)), None),
        (1 / ((s + 1) ** 3 + DELAY / 2), None),
        (1 / (s + 1 + sympy.Rational(4, 5) * s * DELAY), None),
    ],
)
def test_residues_with_many_digits_where_zeros_coincide(E, known):
    value = integral_of_square(E, "residues")
    assert value == pytest.approx(float(integral_of_square(E, "response") if known is None else known), rel=2e-10)


# ------------------------------------------------------------------------------------------------ crossings


def test_the_count_by_crossings_is_that_of_the_argument_principle():
    dice, decided = random.Random(11), 0
    for _ in range(150):
        order = dice.choice([1, 2, 3, 4])
        A = (*(round(10 ** dice.uniform(0, 2)) * dice.choice([1, 1, 1, -1]) for _ in range(order)), 10)
        C = (*(round(10 ** dice.uniform(-1, 2)) * dice.choice([1, -1]) for _ in range(dice.randint(1, order))), 1)
        delay = Fraction(round(100 * 10 ** dice.uniform(-2, 1)), 100) or Fraction(1)
        number = OneDelay(A, C, delay).unstable
        if number is None:
            continue
        decided += 1
        assert number == unstable_roots({Fraction(0): A, delay: C}), (A, C, delay)
    assert decided > 140


def test_what_crossings_leave_open():
    assert routh([1, 0, 1]) is None
    assert routh([6, 11, 6, 1]) == 0
    assert routh([-6, 11, -6, 1]) == 3
    assert OneDelay((1, 1), (2, 3), Fraction(1)).unstable is None  # an infinite row
    assert OneDelay((0, 1), (0, 0, 1), Fraction(1)).unstable is None
    k = to_limit(DELAY / s, 0)
    near = OneDelay((0, int(k.q)), (int(k.p),), Fraction(1))
    assert near.unstable is None
    with pytest.raises(StabilityLimitError):
        unstable_roots({Fraction(0): (0, 1, 0, 1), Fraction(1): (0,)})


# ------------------------------------------------------------------------------------------------ families


def family(mode, K, T, delay, Kp, Ti):
    one, k = np.ones(len(Kp)), K * Kp
    below = np.array([[0 * one, Ti, T * Ti], [k, k * Ti, 0 * one]])
    above, late = ([[Ti, T * Ti]], [0.0]) if mode == "servo" else ([[-K * Ti]], [delay])
    return np.array(above), late, below, [0.0, delay]


@pytest.mark.parametrize("mode", ["servo", "regulator"])
def test_a_family_is_the_closed_form(mode):
    dice = np.random.default_rng(5)
    K, T, delay, Kp, Ti = 2.0, 5.0, 4.0, 10 ** dice.uniform(-2, 0.5, 1000), 10 ** dice.uniform(-0.5, 1.5, 1000)
    values = ise_family(*family(mode, K, T, delay, Kp, Ti))
    known = pi_first_order(K, T, delay, Kp, Ti, mode, unstable=math.inf)
    assert (np.isinf(values) == np.isinf(known)).all()
    stable = np.isfinite(known)
    assert 300 < stable.sum() < 900
    assert values[stable] == pytest.approx(known[stable], rel=1e-11)


def test_a_family_of_dead_times_and_none():
    delay = np.array([0, 0.1, 0.5, 1.0, 1.5, 2.0])
    one = np.ones(len(delay))
    values = ise_family([[one]], [0], [[0 * one, one], [one, 0 * one]], np.array([0 * one, delay]))
    known = np.cos(delay) / (2 * (1 - np.sin(delay)))
    assert values[:5] == pytest.approx(known[:5], rel=1e-11)
    assert np.isinf(values[5])


def test_members_that_fail_together_are_found_alone():
    """Coincident zeros, several dead times, a pole at zero that only dead times cancel."""
    one = np.ones(2)
    multiple = ise_family([[one]], [0], [[one, 3 * one, 3 * one, one]], [0])
    assert multiple == pytest.approx(integral_of_square(1 / (s + 1) ** 3), rel=1e-12)
    several = ise_family([[one]], [0], [[0 * one, one], [0.5 * one, 0 * one], [0.25 * one, 0 * one]], [0, 1, 2.5])
    expected = integral_of_square(1 / (s + DELAY / 2 + sympy.exp(-5 * s / 2) / 4))
    assert several == pytest.approx(expected, rel=1e-12)
    waiting = ise_family([[one], [-one]], [0, 1], [[0 * one, one]], [0])
    assert waiting == pytest.approx(1, rel=1e-12)


def test_families_of_higher_order_are_those_of_each():
    dice = np.random.default_rng(8)
    members, above, below = [], [], []
    for _ in range(40):
        T1, T2, k, Ti, Td = (round(float(x), 2) for x in 10 ** dice.uniform(-0.3, 0.8, 5))
        P = np.polynomial.Polynomial
        A = P([0, Ti]) * P([1, T1]) * P([1, T2]) * P([1, Td / 8])
        C = 2 * k * (P([1, Ti]) * P([1, Td / 8]) + P([0, 0, Ti * Td]))
        above.append((P([Ti]) * P([1, T1]) * P([1, T2]) * P([1, Td / 8])).coef)
        below.append([A.coef, np.r_[C.coef, np.zeros(len(A.coef) - len(C.coef))]])
        members.append((T1, T2, k, Ti, Td))
    values = ise_family(np.array(above).T[None], [0], np.array(below).transpose(1, 2, 0), [0, 0.5])
    assert 5 < np.isinf(values).sum() < 35
    for value, (T1, T2, k, Ti, Td) in zip(values, members, strict=True):
        T1, T2, k, Ti, Td = (sympy.Rational(str(x)) for x in (T1, T2, k, Ti, Td))
        controller = PID(2 * k, Ti, Td, Td / 8).expr
        try:
            known = ise(sympy.exp(-s / 2) / ((T1 * s + 1) * (T2 * s + 1)), controller)
        except UnstableLoopError:
            known = math.inf
        assert value == pytest.approx(known, rel=1e-9)


def test_families_that_are_none():
    one = np.ones(3)
    good = [[one]], [0], [[one, one]], [0]
    assert ise_family(*good) == pytest.approx(0.5)
    for place, wrong in (
        (0, [one]), (1, [0, 0]), (1, [-1]), (2, [[one, np.nan * one]]), (2, [[one[:2], one[:2]]]), (3, [[0, 1]]),
    ):  # fmt: skip
        given = list(good)
        given[place] = wrong
        with pytest.raises(ValueError, match="expected"):
            ise_family(*given)
    assert ise_family(np.zeros((1, 1, 0)), [0], np.ones((1, 2, 0)), [0]).shape == (0,)
