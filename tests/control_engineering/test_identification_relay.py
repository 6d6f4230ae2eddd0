"""The relay experiment: its cycle, what it tells, and how near that comes."""

import math

import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.deadtime import System
from loopbook.identification import Relay, limit_cycle, relay_experiment
from loopbook.plants import Process
from loopbook.simulation import simulate
from loopbook.stability import ultimate
from test_identification_fitting import PLANT

E = sympy.exp


def test_the_relay_makes_the_cycle_that_can_be_computed_by_hand():
    cycle = relay_experiment(E(-s) / (s + 1), amplitude=3)
    assert cycle.amplitude == pytest.approx(3 * (1 - math.exp(-1)), rel=1e-9)
    assert cycle.Pu == pytest.approx(2 * math.log(2 * math.e - 1), rel=1e-9)
    assert cycle.Ku == pytest.approx(4 * 3 / (math.pi * cycle.amplitude))
    assert cycle.phase == -180


@pytest.mark.parametrize(
    ("K", "T", "delay", "d", "h"),
    [(2, 10, 0.1, 1, 0.3), (1, 1, 30, 1, 0.2), (1, 1e-6, 0, 1, 0.5), (1, 3.6e6, 1e5, 2, 0.1), (1e6, 10, 0, 1, 9e5)],
)
def test_a_lag_under_a_relay_with_hysteresis(K, T, delay, d, h):
    """In whatever unit: from h on it rises for one dead time more, and then falls to -h."""
    a = K * d - (K * d - h) * math.exp(-delay / T)
    Pu = 2 * (delay + T * math.log((a + K * d) / (K * d - h)))
    cycle = relay_experiment(K * E(-delay * s) / (T * s + 1), d, h)
    assert (cycle.amplitude, cycle.Pu) == pytest.approx((a, Pu), rel=1e-9)


def test_two_lags_under_a_relay():
    """By the sum of the lags' own periodic responses, at the moment of a switch (Tsypkin)."""
    K, T1, T2, delay, d, h = 1, 5, 2, 0.3, 2, 0.1
    cycle = relay_experiment(K * E(-delay * s) / ((T1 * s + 1) * (T2 * s + 1)), d, h)
    half = cycle.Pu / 2
    parts = [(K * T1 / (T1 - T2), T1), (-K * T2 / (T1 - T2), T2)]
    at_switch = sum(k * d * (1 - 2 * math.exp(-(half - delay) / T) / (1 + math.exp(-half / T))) for k, T in parts)
    assert at_switch == pytest.approx(h, rel=1e-9)


def test_the_first_switch_is_at_the_end_of_the_dead_time():
    assert relay_experiment(E(-0.337 * s) / (3 * s + 1)).switches[0] == pytest.approx(0.337, rel=1e-6)


def test_a_long_record_of_a_limit_cycle():
    cycle = relay_experiment(E(-s) / s, periods=15)
    assert cycle.times[-1] >= 15 * cycle.Pu
    assert cycle.Pu == pytest.approx(4)


def test_a_hysteresis_makes_the_cycle_longer():
    # from h on it rises for one dead time more, and then falls the same way: a = h + 1, Pu = 4*(1 + h)
    cycle = relay_experiment(E(-s) / s, hysteresis=0.5)
    assert (cycle.amplitude, cycle.Pu) == pytest.approx((1.5, 6))
    assert cycle.phase == pytest.approx(-180 + math.degrees(math.asin(1 / 3)))


@pytest.mark.parametrize("n", [3, 5, 8])
def test_the_estimate_is_the_better_the_more_the_process_is_a_lowpass(n):
    process = 1 / (s + 1) ** n
    cycle, (Ku, Pu) = relay_experiment(process), ultimate(process)
    assert cycle.Ku == pytest.approx(Ku, rel=0.04)
    assert cycle.Pu == pytest.approx(Pu, rel=0.03)


def test_the_record_is_the_response_to_its_own_input():
    process = 2 * E(-2 * s) / ((8 * s + 1) * (s + 1))
    cycle = relay_experiment(process, amplitude=0.5)
    rebuilt = 0.5 * System(process).step(cycle.times)
    for n, moment in enumerate(cycle.switches):
        late = np.maximum(cycle.times - moment, 0)
        rebuilt += (-1) ** (n + 1) * np.where(cycle.times >= moment, System(process).step(late), 0)
    assert cycle.y == pytest.approx(rebuilt, abs=1e-9)
    assert set(np.unique(cycle.u)) == {-0.5, 0.5}
    at_switches = np.interp(cycle.switches, cycle.times, cycle.y)
    assert at_switches[1:] == pytest.approx(0, abs=1e-9)


def test_a_relay_in_a_sampled_loop_with_noise_finds_nearly_the_same():
    process = 2 * E(-2 * s) / ((8 * s + 1) * (s + 1))
    exact = relay_experiment(process, hysteresis=0.1)
    run = simulate(
        Process(process), Relay(1, step=0.1, hysteresis=0.1), until=80, setpoint=0, noise=0.02, seed=4
    )  # fmt: skip
    found = limit_cycle(run.times, run["u"], run["measurement"], hysteresis=0.1)
    assert found.Ku == pytest.approx(exact.Ku, rel=0.05)
    assert found.Pu == pytest.approx(exact.Pu, rel=0.05)
    assert found.phase == pytest.approx(exact.phase, abs=1)


def test_a_relay_that_makes_no_oscillation_is_refused():
    for process in (1 / (s + 1), 1 / s, 1 / (s * (s + 1)), -E(-s) / (3 * s + 1)):
        with pytest.raises(ValueError, match="no positive gain makes"):
            relay_experiment(process)
    with pytest.raises(ValueError, match="answers at once"):
        relay_experiment((s + 2) * E(-s) / (s + 1))
    with pytest.raises(ValueError, match="amplitude of the relay is 0"):
        relay_experiment(1 / (s + 1) ** 3, amplitude=0)
    with pytest.raises(ValueError, match="amplitude of the relay is '1'"):
        relay_experiment(1 / (s + 1) ** 3, amplitude="1")
    with pytest.raises(ValueError, match="hysteresis is -1"):
        relay_experiment(1 / (s + 1) ** 3, hysteresis=-1)
    with pytest.raises(ValueError, match="does not reach the hysteresis 3"):
        relay_experiment(2 / (s + 1), hysteresis=3)
    with pytest.raises(ValueError, match="a hysteresis that it reaches"):
        relay_experiment(2 * E(-s) / (s + 1), hysteresis=3)
    run = simulate(Process(PLANT), Relay(1, step=0.1), until=80, setpoint=0, noise=0.05, seed=4)
    with pytest.raises(ValueError, match="a hysteresis above the noise"):
        limit_cycle(run.times, run["u"], run["measurement"])
    with pytest.raises(ValueError, match="measurement is 0 all the time"):
        limit_cycle(run.times, np.sign(np.sin(run.times)), 0 * run.times)
    with pytest.raises(ValueError, match="switched on 0 times"):
        limit_cycle([0, 1, 2, 3], [1, 1, 1, 1], [0, 1, 2, 3])
