"""Signals in time."""

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from loopbook import t
from loopbook.laplace import evaluate
from loopbook.signals import noise, pulse_width_modulation, stepwise


def test_a_stepwise_signal_has_its_new_value_at_the_step_itself():
    signal = stepwise(10, {600: 9, 300: 11})
    assert evaluate(signal, [0, 299.9, 300, 599, 600, 1000]).tolist() == [10, 10, 11, 11, 9, 9]
    assert stepwise(3, {}) == 3


@pytest.mark.parametrize("changes", [{"soon": 1}, {1: t}, {sympy.Symbol("T"): 2}])
def test_a_step_is_two_numbers(changes):
    with pytest.raises(ValueError, match="expected"):
        stepwise(0, changes)


def test_the_changes_of_a_stepwise_signal_are_a_table():
    with pytest.raises(ValueError, match="changes are 5"):
        stepwise(0, 5)


def test_noise_is_the_same_for_the_same_seed():
    times = np.arange(50_000)
    first, again, other = noise(times, 2, seed=1), noise(times, 2, seed=1), noise(times, 2, seed=2)
    assert (first == again).all()
    assert not (first == other).any()
    assert first.std() == pytest.approx(2, rel=0.02)
    assert first.mean() == pytest.approx(0, abs=0.05)
    assert not noise(times, 0, seed=1).any()


@pytest.mark.parametrize("deviation", [-1, float("nan"), float("inf")])
def test_a_deviation_is_a_number_that_is_not_negative(deviation):
    with pytest.raises(ValueError, match="deviation"):
        noise([0, 1], deviation, seed=1)


@pytest.mark.parametrize("seed", [None, 0.5, -1, "x"])
def test_a_seed_is_an_integer(seed):
    with pytest.raises(ValueError, match="seed is"):
        noise([0, 1], 1, seed)


@given(st.integers(0, 100), st.integers(1, 40))
def test_a_pulse_is_on_for_its_share_of_the_cycle(duty, cycles):
    times = np.arange(100 * cycles) / 10
    pulses = pulse_width_modulation(duty, times, period=10)
    assert pulses.mean() == pytest.approx(duty / 100)
    assert (pulses.reshape(cycles, 100) == (np.arange(100) < duty)).all()


def test_the_duty_cycle_of_the_beginning_holds_for_the_whole_cycle():
    times = np.arange(20)
    duty = np.where(times < 3, 50, 20)
    assert pulse_width_modulation(duty, times, period=10).tolist() == 5 * [1] + 5 * [0] + 2 * [1] + 8 * [0]


@pytest.mark.parametrize(
    ("duty", "period", "message"),
    [
        (101, 1, "101 %"),
        (-1, 1, "-1 %"),
        (float("nan"), 1, "the duty cycles contain nan: expected finite numbers"),
        (50, 0, "period is 0"),
        ([50], 1, "1 values for 2"),
    ],
)
def test_a_pulse_needs_a_share_and_a_period(duty, period, message):
    with pytest.raises(ValueError, match=message):
        pulse_width_modulation(duty, [0, 1], period)
