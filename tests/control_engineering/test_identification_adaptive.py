"""Parameters as the data come, and a controller that adapts to them."""

import math

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook import s
from loopbook.approximation import SOPDT
from loopbook.identification import AdaptiveController, RecursiveLeastSquares, first_order_of, fit
from loopbook.pid import PID
from loopbook.plants import Process
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.tuning import simc
from test_identification_steps import values

E = sympy.exp


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
@pytest.mark.daily(1)
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


def test_the_adaptive_controller_learns_alike_in_all_units():
    def gains(unit):
        process = Process(2 * unit * sympy.exp(-2 * s) / (10 * s + 1))
        controller = AdaptiveController(PID(0.3 / unit, Ti=10), step=1, delay=2)
        run = simulate(process, controller, until=120, setpoint=stepwise(0, {5: unit, 60: 2 * unit}))
        return run["Kp"] * unit

    assert gains(1e-4) == pytest.approx(gains(1.0), rel=1e-3)
