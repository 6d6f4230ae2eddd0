"""Stability with dead time, against known results, the argument principle and simulation."""

import math
from itertools import pairwise

import numpy as np
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loopbook import s
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.simulation import simulate
from loopbook.stability import StabilityLimitError, delay_margin, is_stable, ultimate, unstable_poles

DELAY = sympy.exp(-s)


COEFFICIENTS = st.fractions(-3, 3, max_denominator=4).map(sympy.Rational)


@settings(deadline=None, max_examples=60)
@given(st.lists(COEFFICIENTS, min_size=2, max_size=3), st.lists(COEFFICIENTS, min_size=1, max_size=2),
       st.fractions(0, 8, max_denominator=5).map(sympy.Rational))  # fmt: skip
def test_poles_are_counted_as_the_argument_principle_does(below, above, delay):
    D = s ** len(below) + sum(c * s**n for n, c in enumerate(below))
    N = sum(c * s**n for n, c in enumerate(above))
    assume(N != 0)
    loop = N / D * sympy.exp(-delay * s)
    numerator, denominator = sympy.cancel(N / D).as_numer_denom()
    around = sympy.lambdify(s, denominator + numerator * sympy.exp(-delay * s), "numpy")
    radius = 60.0  # along the boundary of a half-disc that holds all poles of the right half-plane
    up = np.linspace(-radius, radius, 400_001) * 1j
    arc = radius * np.exp(1j * np.linspace(math.pi / 2, -math.pi / 2, 200_001))
    values = np.concatenate([around(up), around(arc)])
    assume(abs(values).min() > 1e-3)  # too close to the limit for the counting by turns
    assert unstable_poles(loop) == -round(np.angle(values[1:] / values[:-1]).sum() / (2 * math.pi))


def test_an_integrator_with_dead_time():
    assert ultimate(DELAY / s) == pytest.approx((math.pi / 2, 4), rel=1e-12)
    assert delay_margin(1 / s) == pytest.approx(math.pi / 2, rel=1e-12)
    # with each half turn more of the phase another pair of poles has crossed
    for k in range(4):
        crossing = sympy.pi / 2 + 2 * sympy.pi * k
        assert unstable_poles(sympy.Rational(str(float(crossing) + 0.01)) * DELAY / s) == 2 * (k + 1)
        assert unstable_poles(sympy.Rational(str(float(crossing) - 0.01)) * DELAY / s) == 2 * k


def test_three_equal_lags():
    # Routh: 1 + K < 9 for (s + 1)^3 + K
    assert ultimate(1 / (s + 1) ** 3) == pytest.approx((8, 2 * math.pi / math.sqrt(3)), rel=1e-12)
    assert (unstable_poles(9 / (s + 1) ** 3), unstable_poles(7 / (s + 1) ** 3)) == (2, 0)


def test_loops_that_no_gain_or_no_delay_makes_unstable():
    assert ultimate(1 / (s + 1)) == (math.inf, 0)
    assert delay_margin(sympy.Rational(1, 2) / (s + 1)) == math.inf


def test_an_unstable_process_has_a_lowest_gain():
    assert (unstable_poles(2 / (s - 1)), unstable_poles(sympy.Rational(1, 2) / (s - 1))) == (0, 1)
    assert ultimate(1 / (s - 1)) == (math.inf, 0)
    Ku, Pu = ultimate(sympy.exp(-s / 2) / (s - 1))
    w = 2 * math.pi / Pu
    assert (math.tan(w / 2), Ku) == pytest.approx((w, math.sqrt(1 + w**2)))
    with pytest.raises(ValueError, match=r"no positive gain .* stable$"):
        ultimate(sympy.exp(-2 * s) / (s - 1))


def test_a_double_integrator_needs_derivative_action():
    with pytest.raises(ValueError, match=r"no positive gain .* stable$"):
        ultimate(1 / s**2)
    assert is_stable((s + 1) / s**2)
    assert not is_stable(1 / s**2)


def test_a_process_with_the_wrong_sign():
    """With a negative gain these loops are stable up to a static gain of one, or not at all with a positive gain."""
    assert ultimate(-1 / (s + 1)) == ultimate((s - 1) / (s + 1) ** 2) == (1, math.inf)
    with pytest.raises(ValueError, match=r"no positive gain .* but a negative one does"):
        ultimate(-DELAY / s)


def test_narrow_resonances_are_not_stepped_over():
    # between pole pair and zero pair the phase turns by half a turn within a ten-thousandth of the frequency
    damping, apart = sympy.Rational(1, 10**5), sympy.Rational(10001, 10**4)
    resonance = (s**2 + damping * s + apart) / (s**2 + damping * s + 1) / (s + 1) ** 3
    Ku, _ = ultimate(resonance)
    assert is_stable(sympy.Rational(0.9999 * Ku) * resonance)
    assert not is_stable(sympy.Rational(1.0001 * Ku) * resonance)


def test_a_triple_crossing_and_multiple_poles():
    loop = (5 * s + sympy.Rational(5, 3)) / (s**3 + 3 * s**2 + 6 * s + sympy.Rational(4, 3))
    assert unstable_poles(loop * sympy.exp(-sympy.Rational(11, 4) * s)) == 2
    assert is_stable(1 / (s * (s**2 + 3 * s + 3)))  # (s + 1)^3
    assert unstable_poles(1 / (s - 1) ** 2) == 2


def test_coefficients_need_not_be_fractions():
    assert unstable_poles(sympy.pi / s / (s + 1) ** 2) == 2
    assert is_stable(sympy.sqrt(2) * DELAY / (s + sympy.sqrt(3)))
    assert is_stable(1 / (10**17 * s + 1) ** 3)


def test_the_limit_itself_is_neither():
    for limit in (1 / s**2, -1 / (s + 1), 8 / (s + 1) ** 3):
        with pytest.raises(StabilityLimitError, match="imaginary axis"):
            unstable_poles(limit)
        assert not is_stable(limit)


def test_a_loop_that_returns_to_stability_with_more_delay():
    # s^2 + 0.1 s + 1 + 0.5 exp(-delay*s): stable, unstable, stable again
    loop = sympy.Rational(1, 2) / (s**2 + s / 10 + 1)
    pattern = [is_stable(loop * sympy.exp(-sympy.Rational(n, 4) * s)) for n in range(40)]
    changes = sum(one != other for one, other in pairwise(pattern))
    assert pattern[0]
    assert changes >= 3


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_the_simulated_loop_agrees(factor):
    process = 2 * sympy.exp(-s) / ((4 * s + 1) * (s + 1))
    _, Pu = ultimate(process)
    step = 0.002
    # the held control signal acts as half a step of dead time more
    Ku_sampled, _ = ultimate(process * sympy.exp(-sympy.Rational(1, 1000) * s))
    run = simulate(Process(process), Controller(PID(factor * Ku_sampled), step), until=60, setpoint=1)
    swing = [np.ptp(run["y"][(run.times >= a) & (run.times <= a + Pu)]) for a in (20, 60 - Pu)]
    assert (swing[1] > swing[0]) == (factor > 1)


@pytest.mark.parametrize(
    ("loop", "message"),
    [
        (sympy.Symbol("K") / s, "a number for K"),
        ((s + 1) / (s + 2), "not strictly proper"),
        (DELAY, "not strictly proper"),
        (1 / s + DELAY / s, "different dead times"),
        ((1 + sympy.I) / (s + 1), "complex"),
        (sympy.S.Zero, "is 0"),
        ("1/s", "'1/s'"),
    ],
)
def test_what_is_not_known(loop, message):
    for question in (is_stable, unstable_poles, ultimate, delay_margin):
        with pytest.raises(ValueError, match=message):
            question(loop)


def test_an_unstable_loop_has_no_margin():
    with pytest.raises(ValueError, match="not stable"):
        delay_margin(2 * DELAY / s)
