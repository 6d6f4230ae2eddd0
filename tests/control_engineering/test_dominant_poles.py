"""The dominant poles of loops with dead time, against Lambert's function, polynomials, and the argument principle."""

import cmath
import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import lambertw

from draws import draws
from loopbook import s
from loopbook.deadtime import normal_form
from loopbook.pid import PID
from loopbook.stability import dominant_poles, ultimate, unstable_closed_loop_poles
from loopbook.transfer import dead_time, first_order, second_order


def rest(L, p):
    """The characteristic sum at a point, as a share of its terms."""
    terms = [
        complex(part.eval(p)) * cmath.exp(-float(delay) * p)
        for parts in normal_form(L)
        for delay, part in parts.items()
    ]
    return abs(sum(terms)) / sum(map(abs, terms))


@pytest.mark.parametrize("K", [0.1, 0.5, 1, 1.7, 4])
def test_the_integrator_with_dead_time_has_the_branches_of_lamberts_function(K):
    # s + K exp(-s) = 0, so s exp(s) = -K
    expected = sorted((lambertw(-K, k) for k in range(-4, 4)), key=lambda p: (-p.real, -p.imag))
    found = dominant_poles(K * dead_time(1) / s, count=6)
    assert np.allclose(found[:6], expected[:6], atol=1e-12)


def test_a_double_pole_stands_twice():
    L = sympy.Rational(1) * sympy.exp(-1) * dead_time(1) / s
    assert np.allclose(dominant_poles(L, count=2), [-1, -1], atol=1e-6)


@pytest.mark.parametrize("share", [1e-2, 1e-6, 1e-10])
def test_a_pair_beside_the_real_axis_is_no_double_pole(share):
    K = math.exp(-1) * (1 + share)
    expected = lambertw(-K, 0)
    first, second = dominant_poles(K * dead_time(1) / s)
    assert first == second.conjugate()
    assert (first.real, first.imag) == pytest.approx((expected.real, abs(expected.imag)), rel=1e-5)


def test_triple_poles_with_and_without_dead_time():
    assert np.allclose(dominant_poles(1 / (s * (s**2 + 3 * s + 3)), count=3), [-1] * 3, atol=1e-12)
    # the integrator with dead time under PI control, as fast as without oscillation: s**2*exp(s) + a*s + b
    p = -2 + math.sqrt(2)
    a = -(p**2 + 2 * p) * math.exp(p)
    b = -(p**2) * math.exp(p) - a * p
    assert np.allclose(dominant_poles(dead_time(1) * PID(a, a / b).expr / s, count=3), [p] * 3, atol=1e-4)


@pytest.mark.parametrize("unit", [1e-9, 3.6e6])
def test_the_unit_of_time_does_not_matter(unit):
    L = 1.3 * dead_time(1) / (s * (3 * s + 1))
    found = dominant_poles(L.subs(s, s * sympy.nsimplify(unit)), count=6)
    assert np.allclose(np.array(found) * unit, dominant_poles(L, count=6), rtol=1e-9)


@pytest.mark.parametrize("ratio", [1e4, 1e8])
def test_a_dead_time_that_is_nothing_beside_the_lags(ratio):
    found = dominant_poles(2 * dead_time(1) / (sympy.Integer(ratio) * s + 1) ** 2)
    assert np.array(found) * ratio == pytest.approx(
        [-1 + math.sqrt(2) * 1j, -1 - math.sqrt(2) * 1j], rel=3 / ratio + 1e-6
    )


def test_a_count_from_numpy_or_sympy():
    for two in (np.int64(2), sympy.Integer(2)):
        assert len(dominant_poles(dead_time(1) / s, two)) == 2


def test_without_dead_time_they_are_the_roots_of_the_polynomial():
    L = 2 / ((s + 1) * (3 * s + 1) * (5 * s + 1))
    expected = sorted(np.roots([15, 23, 9, 3]), key=lambda p: (-p.real, -p.imag))
    assert np.allclose(dominant_poles(L, count=9), expected)
    assert dominant_poles(sympy.Integer(2)) == []


def test_a_pair_is_not_divided():
    assert len(dominant_poles(dead_time(1) / s, count=1)) == 2
    assert len(dominant_poles(dead_time(1) / s, count=3)) == 4


def test_at_the_ultimate_gain_they_lie_on_the_axis():
    process = second_order(2, 5, 3, delay=1)
    Ku, Pu = ultimate(process)
    first, _ = dominant_poles(Ku * process)
    assert abs(first.real) < 1e-9
    assert first.imag == pytest.approx(2 * math.pi / Pu)


@settings(max_examples=draws(25), deadline=None)
@given(
    K=st.floats(0.2, 3), T=st.floats(0.2, 20), delay=st.floats(0.1, 5),
    share=st.floats(0.1, 2), Ti=st.floats(0.3, 30),
)  # fmt: skip
def test_each_is_a_root_and_as_many_are_unstable_as_the_argument_principle_says(K, T, delay, share, Ti):
    process = first_order(K, T, delay)
    L = process * PID(share * T / (K * delay), Ti).expr
    found = dominant_poles(L, count=5)
    assert max(rest(L, p) for p in found) < 1e-9
    assert [p.real for p in found] == sorted((p.real for p in found), reverse=True)
    if not any(abs(p.real) < 1e-6 for p in found):
        assert min(unstable_closed_loop_poles(L), 5) <= sum(p.real > 0 for p in found)


def test_a_pole_that_is_met_exactly():
    found = dominant_poles((412 * s + 412) * dead_time(sympy.Rational(1, 8)) / (103 * s**2 + 512 * s), count=5)
    assert len(found) == 5
    assert found[0] == pytest.approx(-0.486642583628604)


def test_what_has_no_answer_is_refused():
    with pytest.raises(ValueError, match="count is 0: expected a whole number, at least 1"):
        dominant_poles(1 / s, count=0)
    with pytest.raises(ValueError, match="an infinite row of poles"):
        dominant_poles(3 * dead_time(1) * (s + 1) / (s + 2))
    with pytest.raises(ValueError, match="give a number for K"):
        dominant_poles(sympy.Symbol("K") / s)


def test_poles_that_come_just_before_an_endless_row():
    process = first_order(10, 10, delay=1)
    L = process * PID(sympy.Rational(6, 5), Ti=2, Td=sympy.Rational(1, 2)).expr  # the row is at log(0.6)
    found = dominant_poles(L, count=3)
    assert len(found) == 4
    assert max(rest(L, p) for p in found) < 1e-9
    assert found[0].real > found[2].real > math.log(0.6)
