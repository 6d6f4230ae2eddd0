"""Experiments on processes that are known, so that what comes out can be compared with what was put in."""

import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook import s
from loopbook.approximation import SOPDT
from loopbook.deadtime import System
from loopbook.identification import (
    AdaptiveController,
    GainSchedule,
    RecursiveLeastSquares,
    Relay,
    ScheduledController,
    first_order_from_step,
    first_order_of,
    fit,
    good_gain_experiment,
    integrator_from_step,
    limit_cycle,
    relay_experiment,
    swing,
)
from loopbook.identification.zero_order_hold import HOLDS, KINDS, DrivenChain, responses
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.signals import noise, stepwise
from loopbook.simulation import simulate
from loopbook.stability import ultimate
from loopbook.tuning import simc

E = sympy.exp


def values(model, *names):
    return [float(getattr(model, name)) for name in names]


# ---------------------------------------------------------------------------- step responses, by the ruler


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


# ---------------------------------------------------------------------------- least squares


PROCESSES = {
    "first order": (E(-s * sympy.Rational(33, 10)) * 2 / (10 * s + 1), {"K": 2, "T1": 10, "delay": 3.3}),
    "second order": (3 * E(-2.6 * s) / ((12 * s + 1) * (5 * s + 1)), {"K": 3, "T1": 12, "T2": 5, "delay": 2.6}),
    "integrator": (-0.2 * E(-4.25 * s) / s, {"K": -0.2, "delay": 4.25}),
    "integrator with lag": (0.5 * E(-1.5 * s) / (s * (6 * s + 1)), {"K": 0.5, "T2": 6, "delay": 1.5}),
}


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("even", [True, False])
def test_the_response_to_samples_is_that_of_the_exact_solver(hold, even):
    rng = np.random.default_rng(3)
    times, u = np.arange(40.0) if even else np.cumsum(rng.uniform(0.1, 2, 40)), rng.normal(size=40)
    times -= times[0]
    for kind, (H, parameters) in PROCESSES.items():
        lags = [parameters[name] for name in ("T1", "T2") if name in parameters]
        forced, _ = responses(kind, lags, parameters["delay"], times, u, hold)
        if hold == "zero order":
            moves, one = np.diff(u, prepend=0), System(sympy.nsimplify(H)).step_until(times[-1])
        else:
            moves, one = np.diff(np.diff(u) / np.diff(times), prepend=0), System(sympy.nsimplify(H) / s).step_until(80)
        exact = sum(
            move * np.where(times >= begin, one(np.maximum(times - begin, 0)), 0)
            for move, begin in zip(moves, times, strict=False)
        )
        if hold == "first order":
            exact = exact + u[0] * System(sympy.nsimplify(H)).step(times)
        assert forced * parameters["K"] == pytest.approx(exact, abs=1e-9 * abs(exact).max()), kind


@given(st.floats(0.01, 1e4), st.floats(0, 1), st.floats(0, 5), st.sampled_from(HOLDS))
@settings(max_examples=draws(50), deadline=None)
def test_even_samples_and_nearly_equal_lags_need_no_way_of_their_own(T, alike, delay, hold):
    times, u = np.arange(60.0), np.random.default_rng(1).normal(size=60)
    lags, late = np.array([[T], [T * max(alike, 1e-3)]]), np.array([delay])
    even = DrivenChain("second order", times, u, hold, step=1.0).forced(lags, late)
    assert even == pytest.approx(DrivenChain("second order", times, u, hold).forced(lags, late), abs=1e-11)
    nearly = DrivenChain("second order", times, u, hold).forced(lags * [[1 + 1e-9], [1]], late)
    assert even == pytest.approx(nearly, abs=1e-7)


def test_many_sets_of_lags_at_once_are_each_one_alone():
    times, u = np.cumsum(np.random.default_rng(1).uniform(0.5, 1.5, 30)), np.random.default_rng(2).normal(size=30)
    lags, delays = np.array([[5.0, 9.0, 2.0], [1.0, 9.0, 0.5]]), np.array([0.0, 1.3, 7.7])
    chain = DrivenChain("second order", times, u, "first order")
    together = chain.forced(lags, delays)
    for k in range(3):
        assert together[:, k] == pytest.approx(chain.forced(lags[:, [k]], delays[[k]])[:, 0], abs=1e-14)
        alike = chain.forced(lags[:, [k]], delays)  # one set for all dead times
        assert alike[:, k] == pytest.approx(together[:, k], abs=1e-14)


def test_the_free_responses_are_those_of_the_states():
    for kind, (lags, integrators) in KINDS.items():
        T, times = [8.0, 3.0][:lags], np.arange(30) * 0.5
        _, free = responses(kind, T, 2.5, times, np.zeros(30))
        assert free.shape == (30, lags + integrators + 1)
        if integrators:
            assert free[:, -2] == pytest.approx(np.ones(30))
        else:
            assert free[:, -2] == pytest.approx(np.exp(-times / T[-1]))
        assert free[:, -1] == pytest.approx(responses(kind, T, 0, times, np.ones(30))[0])


def experiment(H, deviation, seed=1, count=300):
    """An open loop experiment: the control signal goes up and down a few times."""
    u = stepwise(40, {10: 45, 70: 38, 110: 42, 200: 40})
    times = np.arange(float(count))
    run = simulate(Process(H), until=count - 1, step=1, u=u - 40)
    return times, run["u"] + 40, run["y"] + 25 + noise(times, deviation, seed)


@pytest.mark.parametrize("kind", KINDS)
def test_a_fit_recovers_the_parameters(kind):
    H, parameters = PROCESSES[kind]
    found = fit(*experiment(H, deviation=0), kind)
    assert found.parameters == pytest.approx(parameters, rel=1e-5)
    assert found.residual < 1e-6
    assert found.model.expr.equals(found.expr)
    assert found.model.is_integrating == kind.startswith("integrator")


@pytest.mark.parametrize("kind", KINDS)
def test_with_noise_the_errors_are_as_large_as_it_says(kind):
    H, parameters = PROCESSES[kind]
    for seed in (1, 2, 3):
        found = fit(*experiment(H, deviation=0.1, seed=seed), kind)
        assert found.residual == pytest.approx(0.1, rel=0.15)
        for name, true in parameters.items():
            assert abs(found.parameters[name] - true) < 4 * found.errors[name]
            assert found.errors[name] < 0.1 * abs(true) + 0.1


def test_the_standard_errors_are_the_scatter_of_repeated_experiments():
    H, _ = PROCESSES["first order"]
    fits = [fit(*experiment(H, deviation=0.1, seed=seed, count=150)) for seed in range(40)]
    for name in ("K", "T1", "delay"):
        scatter = np.std([found.parameters[name] for found in fits])
        assert scatter == pytest.approx(np.mean([found.errors[name] for found in fits]), rel=0.4), name


@pytest.mark.parametrize("kind", ["first order", "integrator with lag"])
@pytest.mark.parametrize(
    ("unit_t", "unit_u", "unit_y"), [(3.6e6, 1, 1), (1e-9, 1e3, 1), (1 / 3600, 1e-6, 1e6), (1, 1, 1e-9)]
)
def test_a_fit_does_not_depend_on_units(kind, unit_t, unit_u, unit_y):
    times, u, y = experiment(PROCESSES[kind][0], deviation=0.1, count=150)
    found, other = fit(times, u, y, kind), fit(times * unit_t, u * unit_u, y * unit_y, kind)
    units = {"K": unit_y / unit_u / unit_t**found.model.is_integrating, "T1": unit_t, "T2": unit_t, "delay": unit_t}
    assert other.residual == pytest.approx(found.residual * unit_y, rel=1e-6)
    for name in found.parameters:
        assert other.parameters[name] == pytest.approx(found.parameters[name] * units[name], rel=1e-5)
        assert other.errors[name] == pytest.approx(found.errors[name] * units[name], rel=1e-3)


def test_a_clock_that_counts_from_1970_is_even_enough():
    times, u, y = experiment(PROCESSES["first order"][0], deviation=0)
    assert fit(1.7e9 + times / 10, u, y).parameters["T1"] == pytest.approx(1, rel=1e-4)


def test_a_lag_that_is_hardly_seen_has_a_large_error():
    found = fit(*experiment(0.2 * E(-4 * s) / s, deviation=0.05), "first order")
    assert found.parameters["K"] / found.parameters["T1"] == pytest.approx(0.2, rel=0.02)
    assert found.errors["K"] > 0.01 * found.parameters["K"]
    assert found.errors["T1"] > 0.01 * found.parameters["T1"]


def test_no_dead_time_is_zero():
    times, u, y = experiment(2 / (10 * s + 1), deviation=0)
    found = fit(times, u, y).model
    assert found.delay == 0
    assert values(found, "K", "T1") == pytest.approx([2, 10], rel=1e-6)


def test_an_unknown_start_needs_no_rest_before_the_record():
    H, parameters = PROCESSES["second order"]
    times, u, y = experiment(H, deviation=0)
    late = slice(80, None)  # in the middle of a transient
    assert fit(times[late], u[late], y[late], "second order").residual > 0.1
    found = fit(times[late], u[late], y[late], "second order", start="unknown")
    assert found.parameters == pytest.approx(parameters, rel=1e-4)


def test_equal_lags_are_no_difficulty():
    times, u, y = experiment(2 * E(-2 * s) / (6 * s + 1) ** 2, deviation=0)
    found = fit(times, u, y, "second order")
    assert found.parameters == pytest.approx({"K": 2, "T1": 6, "T2": 6, "delay": 2}, rel=1e-2)


def test_a_delay_of_many_samples_is_found():
    times, u, y = experiment(E(-31.4 * s) / (5 * s + 1), deviation=0.02)
    assert fit(times, u, y).parameters["delay"] == pytest.approx(31.4, abs=0.2)


def procest_record():
    """The record of the slides: a step after ten samples of one second, 110 samples in all."""
    G = System(3 * (1 - s / 10) / ((10 * s + 1) * (3 * s + 1) * (s + 1) ** 3))
    times = np.arange(110.0)
    u = np.where(times < 10, 0, 1)
    return times, u, np.where(times >= 10, G.step(np.maximum(times - 10, 0)), 0)


def test_the_example_of_procest_comes_out_to_all_digits_with_an_estimated_initial_state():
    found = fit(*procest_record(), "second order", start="unknown", level=0).parameters
    assert round(found["K"], 4) == 2.9986
    assert round(found["T1"], 4) == 9.6838
    assert round(found["T2"], 4) == 3.9211
    assert round(found["delay"], 3) == 2.478
    at_rest = fit(*procest_record(), "second order", level=0).parameters
    assert [round(x, 3) for x in at_rest.values()] == [2.999, 9.674, 3.944, 2.454]


def test_a_record_that_does_not_fit_is_refused():
    times, u, y = experiment(PROCESSES["first order"][0], deviation=0)
    for wrong, message in [
        (lambda: fit(times, u, y, "third order"), "the kind is 'third order'"),
        (lambda: fit(times, u, y, longest_delay="long"), "longest dead time is 'long'"),
        (lambda: fit(times, u, y, longest_delay=2), "dead time would be 2 or longer"),  # it is 3.3
        (lambda: fit(times, u, y, start="warm"), "the start is 'warm'"),
        (lambda: fit(times, u, y, hold="second order"), "the hold is 'second order'"),
        (lambda: fit(times, 0 * u, y), "control signal is 0 all the time"),
        (lambda: fit(times, np.where(times < 299, 0, 1), y), "control signal is 0 all the time"),  # moves too late
        (lambda: fit(times, u, 0 * y + 3), "measurement is 3 all the time"),
        (lambda: fit(times - 2 * times.clip(0, 9), u, y), "increasing numbers"),
        (lambda: fit(times, u, y[1:]), "y has 299 values"),
        (lambda: fit(times, u, y, longest_delay=1000), "longest dead time is 1000"),
        (lambda: fit(times, u, np.where(times == 5, math.nan, y)), "contain nan"),
    ]:
        with pytest.raises(ValueError, match=message):
            wrong()


# ---------------------------------------------------------------------------- auto-tuning in open and closed loop


PLANT = 2 * E(-3 * s) / (12 * s + 1)


def closed_loop(deviation, setpoint, seed=1, until=400, load=0):
    run = simulate(
        Process(PLANT), Controller(PID(1.5, Ti=15), step=1), until=until, setpoint=setpoint, noise=deviation, seed=seed,
        d=load,
    )  # fmt: skip
    return run.times, run["u"], run["measurement"]


EXCITED = stepwise(0, {20: 5, 120: 0, 220: 5, 320: 0})


def test_a_setpoint_that_moves_makes_a_closed_loop_tell_the_model():
    found = fit(*closed_loop(0.1, EXCITED))
    for name, true in {"K": 2, "T1": 12, "delay": 3}.items():
        assert abs(found.parameters[name] - true) < 4 * found.errors[name]
    assert found.errors["K"] < 0.05
    proper, own = simc(PLANT), simc(found.model)
    assert float(own.Kp) == pytest.approx(float(proper.Kp), rel=0.1)
    assert float(own.Ti) == pytest.approx(float(proper.Ti), rel=0.1)


def test_a_closed_loop_at_rest_tells_next_to_nothing():
    excited, at_rest = fit(*closed_loop(0.1, EXCITED)), fit(*closed_loop(0.1, 0))
    assert at_rest.errors["K"] > 10 * excited.errors["K"]


def test_what_an_unmeasured_load_moves_tells_a_wrong_model_with_small_errors():
    found = fit(*closed_loop(0.1, 0, load=stepwise(0, {50: 2})))
    assert found.parameters["K"] < 0.2  # the true one is 2
    assert found.errors["K"] < 0.02


def test_a_drifting_measurement_makes_the_feedback_look_like_the_process():
    rng, drift = np.random.default_rng(1), [0.0]
    for _ in range(400):
        drift.append(0.95 * drift[-1] + 0.1 * rng.normal())
    found = fit(*closed_loop(drift, 0))
    assert found.parameters["K"] < 0  # near minus one over the controller
    assert fit(*closed_loop(drift, EXCITED)).parameters["K"] == pytest.approx(2, rel=0.06)


# ---------------------------------------------------------------------------- the relay


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


# ---------------------------------------------------------------------------- Good Gain


def second_order_response(zeta):
    t = np.linspace(0, 40, 8001)
    w = math.sqrt(1 - zeta**2)
    return t, 1 - np.exp(-zeta * t) * (np.cos(w * t) + zeta / w * np.sin(w * t))


@pytest.mark.parametrize("zeta", [0.3, 0.43, 0.6])
def test_the_undershoot_is_the_square_of_the_overshoot_of_two_poles(zeta):
    overshoot, undershoot, between = swing(*second_order_response(zeta), final=1)
    assert overshoot == pytest.approx(math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), rel=1e-4)
    assert undershoot == pytest.approx(overshoot**2, rel=1e-3)
    assert between == pytest.approx(math.pi / math.sqrt(1 - zeta**2), rel=1e-2)


def test_a_response_without_overshoot_has_no_swing():
    t = np.linspace(0, 10, 101)
    assert swing(t, 1 - np.exp(-t), final=1)[:2] == (0, 0)
    assert swing(t, np.exp(-t) - 1, final=-1)[:2] == (0, 0)


@pytest.mark.parametrize("share", [0.01, 0.05, 0.2])
def test_the_good_gain_gives_the_undershoot_that_was_asked_for(share):
    found = good_gain_experiment(E(-s) / (4 * s + 1), undershoot=share)
    assert found.undershoot == pytest.approx(share, rel=1e-3)
    assert swing(found.times, found.y, final=found.KpGG / (1 + found.KpGG))[2] == found.Tou


def test_the_good_gain_of_a_simulator_is_that_of_its_transfer_function():
    exact = good_gain_experiment(PLANT)

    def experiment(Kp):
        run = simulate(Process(PLANT), Controller(PID(Kp), step=0.05), until=100, setpoint=1)
        return run.times, run["y"], 2 * Kp / (1 + 2 * Kp)

    found = good_gain_experiment(experiment, highest=3)
    assert found.KpGG == pytest.approx(exact.KpGG, rel=0.02)
    assert found.Tou == pytest.approx(exact.Tou, rel=0.02)


def test_a_good_gain_experiment_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="between 0 and 1"):
        good_gain_experiment(PLANT, undershoot=2)
    for process in (1 / (s + 1), -PLANT, E(-s)):
        with pytest.raises(ValueError, match="no positive gain makes"):
            good_gain_experiment(process)
    with pytest.raises(ValueError, match="highest gain to try is missing"):
        good_gain_experiment(lambda Kp: ([0, 1, 2, 3], [0, 1, 1, 1]))
    with pytest.raises(ValueError, match="expected a higher gain"):
        good_gain_experiment(PLANT, highest=0.1)
    with pytest.raises(ValueError, match="expected one below the ultimate gain, 3"):
        good_gain_experiment(PLANT, highest=100)  # the loop would be unstable
    with pytest.raises(ValueError, match="highest gain is -1"):
        good_gain_experiment(PLANT, highest=-1)
    with pytest.raises(ValueError, match="does not oscillate without control"):
        good_gain_experiment(E(-s) / (s**2 + sympy.Rational(1, 5) * s + 1))


# ---------------------------------------------------------------------------- as the data come


def test_without_forgetting_it_is_the_least_squares_solution():
    rng = np.random.default_rng(5)
    X, true = rng.normal(size=(50, 3)), np.array([2.0, -1.0, 0.5])
    y = X @ true + 0.1 * rng.normal(size=50)
    estimator = RecursiveLeastSquares(3, uncertainty=1e9)
    for x, value in zip(X, y, strict=True):
        estimator.update(x, value)
    assert estimator.parameters == pytest.approx(np.linalg.lstsq(X, y, rcond=None)[0], rel=1e-6)
    assert estimator.covariance == pytest.approx(np.linalg.inv(X.T @ X), rel=1e-5)


def test_with_forgetting_it_is_the_weighted_solution():
    rng, factor = np.random.default_rng(6), 0.9
    X = rng.normal(size=(80, 2))
    y = X @ [1.0, 3.0] + 0.2 * rng.normal(size=80)
    estimator = RecursiveLeastSquares(2, forgetting=factor, uncertainty=1e9)
    for x, value in zip(X, y, strict=True):
        estimator.update(x, value)
    root = np.sqrt(factor ** np.arange(79, -1, -1))
    weighted = np.linalg.lstsq(X * root[:, None], y * root, rcond=None)[0]
    assert estimator.parameters == pytest.approx(weighted, rel=1e-5)


def test_it_follows_a_parameter_that_changes():
    estimator, rng = RecursiveLeastSquares(1, forgetting=0.9), np.random.default_rng(7)
    for k in range(200):
        x = rng.normal()
        estimator.update([x], (2 if k < 100 else 5) * x)
    assert estimator.parameters == pytest.approx([5], abs=1e-3)


def test_a_loop_at_rest_does_not_make_the_uncertainty_grow_without_end():
    estimator = RecursiveLeastSquares(2, forgetting=0.9, uncertainty=100)
    for _ in range(2000):
        estimator.update([0, 1], 3)
    assert np.isfinite(estimator.covariance).all()
    assert estimator.covariance.trace() < 100 / 0.9 * 2.1


@given(st.floats(0.2, 9), st.floats(2, 60), st.floats(0, 6))
@settings(max_examples=draws(30), deadline=None)
def test_the_difference_equation_gives_back_the_continuous_model(K, T, delay):
    whole, late = math.floor(delay), delay - math.floor(delay)
    a, newer = math.exp(-1 / T), -K * math.expm1(-(1 - late) / T)
    older = K * (1 - a) - newer
    model = first_order_of(a, (newer, max(older, 0)), step=1, whole_delay=whole)
    assert values(model, "K", "T1", "delay") == pytest.approx([K, T, delay], rel=1e-6, abs=1e-6)


def test_an_integrator_has_the_coefficient_one():
    assert first_order_of(1, (0.3, 0.1), step=2, whole_delay=1) == SOPDT(0.2, T1=sympy.oo, delay=2.5)


def test_an_estimator_refuses_what_makes_no_sense():
    for wrong, message in [
        (lambda: RecursiveLeastSquares(0), "number of parameters is 0"),
        (lambda: RecursiveLeastSquares(2, forgetting=1.1), "forgetting factor is 1.1"),
        (lambda: RecursiveLeastSquares(2, initial=[1]), "1 initial parameters"),
        (lambda: RecursiveLeastSquares(2).update([1], 2), "1 regressors for 2"),
        (lambda: RecursiveLeastSquares(2, uncertainty=0), "uncertainty is 0"),
        (lambda: RecursiveLeastSquares(2).update([1, 2], math.nan), "y is nan"),
        (lambda: first_order_of(0.9, (0.1, 0.1, 0.5), step=1), "expected .b0, b1., or b0 alone"),
        (lambda: first_order_of(0.9, 0.1, step=1, whole_delay=2.5), "whole delay is 2.5"),
        (lambda: first_order_of(1.2, 1, step=1), "coefficient a is 1.2"),
        (lambda: first_order_of(0.9, (1, -0.1), step=1), "same sign"),
    ]:
        with pytest.raises(ValueError, match=message):
            wrong()


SETPOINT = stepwise(0, {5: 1, 60: 0, 120: 1, 180: 0, 240: 1, 300: 0, 360: 1})


def test_an_adaptive_controller_finds_the_settings_and_follows_a_gain_that_doubles():
    process = 2 * E(-2 * s) / (10 * s + 1)
    controller = AdaptiveController(PID(0.5, 10), step=1, delay=2, Tc=2, c=2, forgetting=0.97)
    run = simulate(Process(process), controller, until=200, setpoint=SETPOINT)
    settings = simc(process, Tc=2, c=2)
    assert (run["Kp"][-1], run["Ti"][-1]) == pytest.approx((float(settings.Kp), float(settings.Ti)), rel=1e-6)
    run = simulate(Process(2 * process), controller, until=400, setpoint=SETPOINT, after=run)
    assert run["Kp"][-1] == pytest.approx(float(settings.Kp) / 2, rel=0.05)
    assert run["Ti"][-1] == pytest.approx(float(settings.Ti), rel=0.05)


@pytest.mark.parametrize(
    "options",
    [{"measurement_range": (-20, 80)}, {"control_range": (-20, 20), "u0": 50}, {"measurement_range": (0, 50)}],
)
def test_an_adaptive_controller_with_ranges_adapts_its_settings_in_percent(options):
    process = 2 * E(-2 * s) / (10 * s + 1)
    controller = AdaptiveController(PID(0.5, 10), step=1, delay=2, Tc=2, c=2, forgetting=0.97, **options)
    run = simulate(Process(process), controller, until=200, setpoint=SETPOINT)
    low, high = options.get("measurement_range", (0, 100))
    bottom, top = options.get("control_range", (0, 100))
    expected = float(simc(process, Tc=2, c=2).Kp) * (high - low) / (top - bottom)
    assert run["Kp"][-1] == pytest.approx(expected, rel=1e-4)


def test_an_adaptive_controller_with_direct_action():
    process = -2 * E(-2 * s) / (10 * s + 1)
    controller = AdaptiveController(PID(0.5, 10), step=1, delay=2, Tc=2, c=2, forgetting=0.97, action="direct")
    run = simulate(Process(process), controller, until=200, setpoint=SETPOINT)
    assert run["Kp"][-1] == pytest.approx(float(simc(process, Tc=2, c=2).Kp), rel=1e-6)


def test_an_adaptive_controller_that_cannot_work_says_so_at_once():
    for options, message in [
        ({"delay": 0}, "less than a step, and Tc is None"),
        ({"delay": math.inf}, "dead time is inf"),
        ({"delay": 2, "Tc": -1}, "Tc is -1"),
        ({"delay": 2, "c": 0}, "factor c is 0"),
    ]:
        with pytest.raises(ValueError, match=message):
            AdaptiveController(PID(1, 10), step=1, **options)


def test_noise_makes_the_lag_of_the_adaptive_controller_too_short():
    process = 2 * E(-2 * s) / (10 * s + 1)
    controller = AdaptiveController(PID(0.5, 10), step=1, delay=2, forgetting=1)
    run = simulate(Process(process), controller, until=400, setpoint=SETPOINT, noise=0.1)
    X = np.column_stack([run["measurement"][2:-1], run["u"][:-3], np.ones(len(run.times) - 3)])
    a, b, _ = np.linalg.lstsq(X, run["measurement"][3:], rcond=None)[0]
    assert first_order_of(a, b, 1, 2).T1 < 9
    assert fit(run.times, run["u"], run["measurement"]).parameters["T1"] == pytest.approx(10, abs=1)


# ---------------------------------------------------------------------------- gain schedules


TABLE = {12: PID(4, Ti=7, Td=2), 16: PID(5, Ti=6, Td=1), 20: PID(7, Ti=4, Td=1)}


def gains(schedule, signal):
    return [int(schedule.settings(x).Kp) for x in signal]


def test_the_settings_of_a_row_hold_up_to_the_next():
    signal = (8, 12, 15.9, 16, 19.9, 20, 30)
    assert gains(GainSchedule(TABLE), signal) == [4, 4, 4, 5, 5, 7, 7]
    assert gains(GainSchedule(TABLE, safe="high"), signal) == [4, 4, 5, 5, 7, 7, 7]


def test_a_hysteresis_keeps_noise_from_changing_the_settings():
    signal = (15.8, 16.1, 15.9, 16.4, 16.6, 16.1, 15.6, 15.4, 16.3)
    assert gains(GainSchedule(TABLE), signal) == [4, 5, 4, 5, 5, 5, 4, 4, 5]
    schedule = GainSchedule(TABLE, hysteresis=1)
    assert gains(schedule, signal) == [4, 4, 4, 4, 5, 5, 5, 4, 4]
    assert gains(schedule, (30, 21, 12)) == [7, 7, 4]
    schedule.reset()
    assert gains(schedule, (16.1,)) == [5]


def test_a_linear_schedule_lies_on_straight_lines():
    a, b, GS = sympy.symbols("a b GS")
    line = sympy.solve([a * 16 + b - 5, a * 20 + b - 7], [a, b])
    schedule = GainSchedule(TABLE, "linear")
    for value in (16, sympy.Rational(35, 2), 20):
        assert schedule.settings(value).Kp == (a * GS + b).subs(line).subs(GS, value)
    assert schedule.settings(14) == PID(4.5, Ti=6.5, Td=1.5)
    assert (schedule.settings(0), schedule.settings(99)) == (TABLE[12], TABLE[20])


def test_a_schedule_that_makes_no_sense_is_refused():
    for wrong, message in [
        (lambda: GainSchedule({12: PID(4)}), "two rows or more"),
        (lambda: GainSchedule({12: PID(4), 16: PID(2, Ti=3, form="serial")}), "different forms"),
        (lambda: GainSchedule(TABLE, "cubic"), "the way is 'cubic'"),
        (lambda: GainSchedule(TABLE, hysteresis=5), "hysteresis is 5"),
        (lambda: GainSchedule(TABLE, "linear", hysteresis=1), "none for a linear"),
        (lambda: GainSchedule(TABLE, safe="left"), "safe end is 'left'"),
        (lambda: GainSchedule({0.1: PID(1), sympy.Rational(1, 10): PID(2)}), "different values of GS"),
        (lambda: GainSchedule({1: PID(1), sympy.Symbol("a"): PID(2)}), "GS is a: expected a finite real number"),
        (lambda: GainSchedule({1: PID(1), 2: PID(2, Ti=5)}, "linear"), "only some rows have an integral term"),
        (lambda: GainSchedule(TABLE).settings("w"), "GS is .w.: expected a number"),
        (lambda: ScheduledController(TABLE, step=1), "expected a GainSchedule"),
        (lambda: ScheduledController(GainSchedule(TABLE), step=1).update(0, 0), "value of GS is missing"),
    ]:
        with pytest.raises(ValueError, match=message):
            wrong()


def test_a_scheduled_controller_changes_its_settings_without_a_bump_at_rest():
    schedule = GainSchedule({1: PID(2, Ti=10), 2: PID(1, Ti=20)}, hysteresis=0.2)
    controller = ScheduledController(schedule, step=1)
    GS = stepwise(1, {200: 3})
    run = simulate(Process(2 * E(-2 * s) / (10 * s + 1)), controller, until=300, setpoint=1, scheduling=GS)
    assert (run["Kp"][199], run["Kp"][200], run["Ti"][200]) == (2, 1, 20)
    assert np.abs(np.diff(run["u"][190:])).max() < 1e-6
    assert run["scheduling"][[0, -1]].tolist() == [1, 3]


def test_a_scheduled_controller_does_not_know_what_the_schedule_was_asked_before():
    schedule = GainSchedule(TABLE, hysteresis=4)
    schedule.settings(30)
    assert ScheduledController(schedule, step=1).update(1, 0, scheduling=18.5) == 10  # P, and D over the first sample


def test_a_scheduled_run_goes_on_after_a_change_of_the_plant():
    schedule = GainSchedule({1: PID(1, Ti=10), 2: PID(0.5, Ti=10)}, hysteresis=1)
    controller, process = ScheduledController(schedule, step=1), 2 * E(-2 * s) / (10 * s + 1)
    run = simulate(Process(process), controller, until=100, setpoint=1, scheduling=2.2)
    assert run["Kp"][-1] == 0.5
    run = simulate(Process(2 * process), controller, until=200, setpoint=1, scheduling=1.8, after=run)
    assert run["Kp"][-1] == 0.5  # it remembers from which side it came
    with pytest.raises(ValueError, match="has no gain schedule"):
        simulate(Process(process), Controller(PID(1), step=1), until=10, setpoint=1, scheduling=1)
    with pytest.raises(ValueError, match="scheduling is given, but no controller"):
        simulate(Process(process), until=10, step=1, scheduling=1)


def test_the_adaptive_controller_learns_alike_in_all_units():
    def gains(unit):
        process = Process(2 * unit * sympy.exp(-2 * s) / (10 * s + 1))
        controller = AdaptiveController(PID(0.3 / unit, Ti=10), step=1, delay=2)
        run = simulate(process, controller, until=120, setpoint=stepwise(0, {5: unit, 60: 2 * unit}))
        return run["Kp"] * unit

    assert gains(1e-4) == pytest.approx(gains(1.0), rel=1e-3)
