"""Models read off a step response, as with a ruler, of processes that are known."""

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook import s
from loopbook.deadtime import System
from loopbook.identification import first_order_from_step, integrator_from_step

E = sympy.exp


def values(model, *names):
    return [float(getattr(model, name)) for name in names]


def first_order_record(K, T, delay, U=1.0, begin=5.0, level=3.0, end=200.0, step=0.05):
    times = np.arange(0, end, step)
    elapsed = np.maximum(times - begin - delay, 0)
    return times, level + K * U * (1 - np.exp(-elapsed / T))


@pytest.mark.parametrize("delay_by", ["tangent", "two points"])
@pytest.mark.parametrize(("K", "T", "delay", "U"), [(2, 8, 3, 1), (-0.5, 20, 1, -4), (3, 10, 0.07, 2)])
def test_a_lag_with_dead_time_is_read_off_its_step_response(K, T, delay, U, delay_by):
    model = first_order_from_step(*first_order_record(K, T, delay, U), U=U, at=5, delay_by=delay_by)
    assert values(model, "K", "T1", "delay") == pytest.approx([K, T, delay], rel=0.01, abs=0.06)


@given(st.floats(0.5, 50), st.floats(0, 10), st.floats(0.1, 9))
@settings(max_examples=draws(20), deadline=None)
def test_an_integrator_with_dead_time_is_read_off_its_asymptote(K, delay, U):
    times = np.linspace(0, 40, 81)
    model = integrator_from_step(times, 7 + K * U * np.maximum(times - delay, 0), U=U)
    assert model.is_integrating
    assert values(model, "K", "delay") == pytest.approx([K, delay], rel=1e-6, abs=1e-6)


def test_the_asymptote_of_an_integrator_with_lag_leaves_the_level_a_lag_later():
    times = np.linspace(0, 100, 1001)
    model = integrator_from_step(times, System(2 * E(-3 * s) / (s * (4 * s + 1))).step(times))
    assert values(model, "K", "delay") == pytest.approx([2, 3 + 4], rel=1e-4)
    late = integrator_from_step(times, 3 * np.maximum(times - 75, 0), part=0.2)
    assert values(late, "K", "delay") == pytest.approx([3, 75], rel=1e-9)


def test_the_tangent_of_a_chain_of_lags_puts_the_smaller_ones_into_the_dead_time():
    times = np.linspace(0, 60, 601)
    model = first_order_from_step(times, System(1 / ((5 * s + 1) * (s + 1) ** 2)).step(times))
    assert 1 < model.delay < 2
    assert 5 < model.T1 < 6


def test_a_step_response_that_does_not_fit_is_refused():
    times = np.linspace(0, 10, 101)
    with pytest.raises(ValueError, match="not come to rest"):
        first_order_from_step(times, times)
    with pytest.raises(ValueError, match="not come to rest"):
        first_order_from_step(times, 0 * times)
    with pytest.raises(ValueError, match="step U is 0"):
        first_order_from_step(times, times, U=0)
    with pytest.raises(ValueError, match="ends at rest"):
        integrator_from_step(times, np.minimum(times, 1))
    with pytest.raises(ValueError, match="time of the step is 11"):
        integrator_from_step(times, times, at=11)
    with pytest.raises(ValueError, match="y has 100 values"):
        integrator_from_step(times, times[1:])
    with pytest.raises(ValueError, match="delay_by is 'eye'"):
        first_order_from_step(times, times, delay_by="eye")
    with pytest.raises(ValueError, match="step U is 'one'"):
        first_order_from_step(times, times, U="one")
    with pytest.raises(ValueError, match="before the step: expected the response of an integrator"):
        integrator_from_step(times, 1 - np.exp(-times / 3))  # a lag, still on its way
    times, y = first_order_record(1, 5, 3)
    with pytest.raises(ValueError, match="hides a change of"):
        first_order_from_step(times, y + np.random.default_rng(0).normal(size=len(y)), at=5)
