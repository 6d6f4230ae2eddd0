"""Damping, overshoot, decay ratio and period, against the step response itself."""

import math

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from loopbook import s
from loopbook.deadtime import System
from loopbook.oscillation import Oscillation, oscillation, oscillation_of_pole
from loopbook.transfer import dead_time, initial_slope, poles

LETTERS = sympy.symbols("K T zeta", positive=True)


def test_letters_come_back():
    K, T, zeta = LETTERS
    assert oscillation(K * dead_time(3) / (T**2 * s**2 + 2 * zeta * T * s + 1)) == Oscillation(T, zeta)
    assert oscillation(K * (1 - s) / (T**2 * s**2 + s + 1)) == Oscillation(T, 1 / (2 * T))


@pytest.mark.parametrize("zeta", [0.1, 0.5, 0.9])
def test_the_formulas_describe_the_step_response(zeta):
    found = Oscillation(T=2, zeta=zeta)
    response = System(1 / (4 * s**2 + 4 * zeta * s + 1))
    peak, period = float(found.peak_time), float(found.period)
    top, bottom, second = response.step([peak, peak + period / 2, peak + period]) - 1
    assert top == pytest.approx(float(found.overshoot), rel=1e-9)
    assert second / top == pytest.approx(float(found.decay_ratio), abs=1e-9)
    assert bottom / top == pytest.approx(-float(found.overshoot), abs=1e-9)
    around = response.step(peak + np.linspace(-0.1, 0.1, 201)) - 1
    assert abs(around.argmax() - 100) <= 1


@given(st.floats(0.05, 20), st.floats(-0.95, 0.95))
def test_a_pole_tells_the_same_as_its_polynomial(T, zeta):
    pole = max((complex(p) for p in poles(1 / (T**2 * s**2 + 2 * T * zeta * s + 1))), key=lambda p: p.imag)
    found = oscillation_of_pole(pole)
    assert float(found.T) == pytest.approx(T, rel=1e-9)
    assert float(found.zeta) == pytest.approx(zeta, abs=1e-9)


def test_quarter_decay():
    pole = complex(math.log(1 / 4) / (2 * math.pi), 1)
    assert float(oscillation_of_pole(pole).decay_ratio) == pytest.approx(1 / 4)


@pytest.mark.parametrize("what", ["peak_time", "overshoot", "decay_ratio", "period"])
@pytest.mark.parametrize("zeta", [1, 1.5, -1])
def test_what_does_not_oscillate_has_no_period(what, zeta):
    with pytest.raises(ValueError, match="do not oscillate"):
        getattr(Oscillation(1, zeta), what)


def test_what_is_no_finite_number_is_refused():
    with pytest.raises(ValueError, match="zeta is I: expected a finite real number"):
        Oscillation(1, sympy.I)
    with pytest.raises(ValueError, match="pole is oo: expected a finite one"):
        oscillation_of_pole(math.inf)


@pytest.mark.parametrize("H", [1 / (s + 1), 1 / (s * (s + 1)), 1 / (s**2 - 1), 1 / (s + 1) ** 3])
def test_other_denominators_are_refused(H):
    with pytest.raises(ValueError, match="two poles of one sign"):
        oscillation(H)


def test_values_without_meaning_are_refused():
    with pytest.raises(ValueError, match="T is -1: expected a positive number"):
        Oscillation(-1, 0.5)
    with pytest.raises(ValueError, match="the pole is 0"):
        oscillation_of_pole(0)
    with pytest.raises(ValueError, match="adds several dead times"):
        oscillation(1 / (s**2 + s + 1) + dead_time(1))


# ---- the slope with which a step response begins


@pytest.mark.parametrize(
    ("H", "slope"),
    [
        (2 / (10 * s + 1), sympy.Rational(1, 5)),
        ((2 * s + 1) / (s + 1), -1),
        (4 * (2 * s + 1) / ((10 * s + 1) * (s + 1)), sympy.Rational(4, 5)),
        (1 / (s + 1) ** 2, 0),
        (dead_time(1) / (s + 1), 0),
        (3 / s, 3),
    ],
)
def test_initial_slope(H, slope):
    assert initial_slope(H) == slope
    early = np.array([1e-6, 2e-6])
    first, second = System(H).step(early)
    assert (second - first) / 1e-6 == pytest.approx(float(slope), abs=1e-4)


@pytest.mark.parametrize("H", [s + 1, s * dead_time(1)])
def test_an_improper_transfer_function_has_no_initial_slope(H):
    with pytest.raises(ValueError, match="improper"):
        initial_slope(H)
