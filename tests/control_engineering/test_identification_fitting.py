"""Models by least squares from records, in open and closed loop: what comes out is what was put in, with its errors."""

import functools
import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from draws import THOROUGH, draws
from loopbook import s
from loopbook.deadtime import System
from loopbook.identification import fit
from loopbook.identification.zero_order_hold import HOLDS, KINDS, DrivenChain
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.signals import noise, stepwise
from loopbook.simulation import simulate
from loopbook.tuning import simc
from test_fit_statistics import responses
from test_identification_steps import values

E = sympy.exp


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


@functools.cache
def without_noise(H, count):
    u = stepwise(40, {10: 45, 70: 38, 110: 42, 200: 40})
    return simulate(Process(H), until=count - 1, step=1, u=u - 40)


def experiment(H, deviation, seed=1, count=300):
    """An open loop experiment: the control signal goes up and down a few times."""
    run = without_noise(H, count)
    return run.times, run["u"] + 40, run["y"] + 25 + noise(run.times, deviation, seed)


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
    fits = [fit(*experiment(H, deviation=0.1, seed=seed, count=150)) for seed in range(40 if THOROUGH else 25)]
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
    assert found.errors["K"] < 0.05
    assert "correlated (Ljung-Box p = " in repr(found)
    assert "not where something unmeasured acts" in repr(found)


def test_a_drifting_measurement_makes_the_feedback_look_like_the_process():
    rng, drift = np.random.default_rng(1), [0.0]
    for _ in range(400):
        drift.append(0.95 * drift[-1] + 0.1 * rng.normal())
    found = fit(*closed_loop(drift, 0))
    assert found.parameters["K"] < 0  # near minus one over the controller
    assert fit(*closed_loop(drift, EXCITED)).parameters["K"] == pytest.approx(2, rel=0.06)
