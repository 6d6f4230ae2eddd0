"""What noise does to what is read off a record: intervals that hold the true value as often as they say, and rulers."""

import itertools
import math
import pickle

import numpy as np
import pytest
import sympy
from scipy.special import stdtrit
from scipy.stats import binom

from draws import draws
from loopbook import s
from loopbook.deadtime import System
from loopbook.identification import first_order_from_step, fit
from loopbook.identification.zero_order_hold import HOLDS, DrivenChain, responses


def record(kind, lags, delay, noise, seed, *, count=60, hold="zero order", jitter=0.0, gain=2.0):
    """Steps up and down, and noise as a share of what the measurement does."""
    rng = np.random.default_rng(seed)
    times = np.arange(float(count)) + jitter * rng.uniform(-0.5, 0.5, count)
    moves = np.arange(count) / count
    u = 1.0 * (moves > 0.1) - 1.5 * (moves > 0.5) + 1.0 * (moves > 0.75)
    y = gain * responses(kind, lags, delay, times, u, hold)[0]
    return times, u, y + noise * np.ptp(y) * rng.normal(size=count)


# ---------------------------------------------------------------------------- samples


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize(
    ("kind", "H"),
    [
        ("first order", 2 * sympy.exp(-4 * s) / (10 * s + 1)),
        ("second order", sympy.exp(-4 * s) / ((9 * s + 1) * (3 * s + 1))),
    ],
)
def test_a_fit_finds_the_dead_time_of_the_response_that_is_held_alike(kind, H, hold):
    rng = np.random.default_rng(1)
    times, u = np.arange(80.0), np.cumsum(rng.normal(size=80) * (rng.random(80) < 0.2))
    u -= u[0]
    y = System(H).response(times, u, hold=hold)
    assert fit(times, u, y, kind, hold=hold).parameters["delay"] == pytest.approx(4, abs=1e-7)
    other = next(way for way in HOLDS if way != hold)
    assert abs(fit(times, u, y, kind, hold=other).parameters["delay"] - 4) > 0.2  # half a sample is what it costs


@pytest.mark.parametrize("kind", ["first order", "second order", "integrator with lag"])
@pytest.mark.parametrize("jitter", [2e-6, 1e-3, 0.5, 0.99])
def test_samples_need_not_come_evenly(kind, jitter):
    lags = [9.0, 4.0][: 2 if kind == "second order" else 1]
    for hold in HOLDS:
        times, u, y = record(kind, lags, 4.3, 0, seed=1, hold=hold, jitter=jitter)
        found = fit(times, u, y, kind, hold=hold)
        assert found.parameters["delay"] == pytest.approx(4.3, abs=1e-6)
        assert found.parameters["K"] == pytest.approx(2, rel=1e-6)
        lag = found.parameters["T2" if kind == "integrator with lag" else "T1"]
        assert lag == pytest.approx(9, rel=1e-6)


def test_logged_when_something_changed():
    times = np.unique(np.concatenate([np.arange(0, 200, 10.0), np.geomspace(1e-3, 40, 60) + 50]))
    u = 1.0 * (times >= 50)
    y = 5 + 3 * responses("second order", [6, 2], 1.7, times, u)[0]
    assert fit(times, u, y, "second order").parameters == pytest.approx(
        {"K": 3, "T1": 6, "T2": 2, "delay": 1.7}, rel=1e-5
    )


# ---------------------------------------------------------------------------- intervals

CASES = {  # kind, lags, dead time, noise; the lags are equal or one is hardly seen in some
    "a lag in much noise": ("first order", [8.0], 0.4, 0.2),
    "two lags": ("second order", [9.0, 3.0], 2.6, 0.02),
    "two lags in much noise": ("second order", [9.0, 5.0], 2.6, 0.15),
    "equal lags in much noise": ("second order", [6.0, 6.0], 3.0, 0.15),
    "a lag that is not seen": ("second order", [9.0, 0.1], 1.0, 0.1),
    "an integrator with lag": ("integrator with lag", [6.0], 1.5, 0.05),
}
RECORDS = draws(30)


def test_intervals_hold_the_true_values_as_often_as_they_say():
    """Over 237 records of second order it was 92 % for the gain and 96 % for lags and dead time; here are some."""
    told, outside, linear = (dict.fromkeys(("K", "T1", "T2", "delay"), 0) for _ in range(3))
    for kind, lags, delay, noise in CASES.values():
        names = ["T2"] if kind == "integrator with lag" else ["T1", "T2"][: len(lags)]
        true = {"K": 2.0, **dict(zip(names, lags, strict=True)), "delay": delay}
        for seed in range(RECORDS):
            found = fit(*record(kind, lags, delay, noise, seed), kind)
            for name, (low, high) in found.intervals().items():
                assert low <= found.parameters[name] <= high
                told[name] += 1
                outside[name] += not low <= true[name] <= high
                linear[name] += not abs(found.parameters[name] - true[name]) <= 2 * found.errors[name]
    for name, count in told.items():  # what happens once in a thousand runs if one in twenty is outside
        assert outside[name] <= binom.ppf(0.999, count, 0.05), (name, outside, linear, told)


def test_a_profile_is_the_least_sum_of_squares_that_a_search_of_another_kind_finds():
    times, u, y = record("second order", [6.0, 6.0], 3.0, 0.15, seed=4)
    found = fit(times, u, y, "second order")
    left = ((found.y - found.fitted) ** 2).sum()
    limit = left * (1 + stdtrit(55, 0.975) ** 2 / 55)
    low, high = found.intervals()["T1"]
    chain, delays = DrivenChain("second order", times, u, "zero order"), np.linspace(0, 20, 201)

    def least(T1):  # over a grid, so that it cannot miss a valley
        sums = []
        for T2 in np.linspace(0.05, T1, 60):
            forced = chain.forced(np.array([[T1], [T2]]), delays)
            forced, target = forced - forced.mean(axis=0), y - y.mean()
            sums.append(target @ target - ((target @ forced) ** 2 / (forced**2).sum(axis=0)).max())
        return min(sums)

    for end, beyond in ((low, 0.97), (high, 1.03)):
        assert least(end) == pytest.approx(limit, rel=5e-3)
        assert least(end * beyond) > limit


def test_where_the_response_is_nearly_linear_intervals_are_those_of_the_standard_errors():
    found = fit(*record("second order", [9.0, 3.0], 2.6, 0.001, seed=1, count=120), "second order")
    for name, (low, high) in found.intervals().items():
        reach = stdtrit(120 - 5, 0.975) * found.errors[name]
        assert (low, high) == pytest.approx(
            (found.parameters[name] - reach, found.parameters[name] + reach), abs=0.15 * reach
        )
    assert repr(found).count("±") == 4


def test_a_larger_level_has_a_longer_interval():
    found = fit(*record("first order", [8.0], 3.3, 0.1, seed=1))
    ends = [found.intervals(level)["T1"] for level in (0.5, 0.9, 0.95, 0.99)]
    assert all(b[0] < a[0] < a[1] < b[1] for a, b in itertools.pairwise(ends))


def test_what_a_record_does_not_limit_ends_at_zero_or_at_infinity():
    times, u, y = record("integrator", [], 2.0, 0.05, seed=1, gain=0.1)
    as_lag = fit(times, u, y).intervals()
    assert as_lag["T1"][1] == math.inf
    assert math.isfinite(as_lag["T1"][0])
    unseen = fit(*record("second order", [9.0, 0.1], 1.0, 0.1, seed=1), "second order")
    assert unseen.intervals()["T2"][0] == 0
    assert unseen.intervals()["delay"][0] == 0
    assert "(0 to " in repr(unseen)  # and no standard error as if it were right


def test_equal_lags_have_no_standard_error():
    found = fit(*record("second order", [6.0, 6.0], 2.0, 0.05, seed=2), "second order")
    shown = repr(found)
    assert "T1 = " in shown
    for name in ("T1", "T2"):
        low, high = found.intervals()[name]
        assert low < 6 < high
        assert f"{name} = {found.parameters[name]:.4g} ({low:.3g} to {high:.3g})" in shown


@pytest.mark.parametrize(("unit_t", "unit_u", "unit_y"), [(3.6e6, 1e-3, 1e5), (1e-9, 1e3, 1e-7)])
def test_intervals_do_not_depend_on_units(unit_t, unit_u, unit_y):
    times, u, y = record("second order", [9.0, 5.0], 2.6, 0.1, seed=3)
    one = fit(times, u, y, "second order").intervals()
    other = fit(times * unit_t, u * unit_u, y * unit_y, "second order").intervals()
    for name, ends in one.items():
        unit = unit_y / unit_u if name == "K" else unit_t
        assert other[name] == pytest.approx([end * unit for end in ends], rel=1e-3)


def test_a_fit_goes_through_a_pickle_with_its_intervals():
    found = fit(*record("first order", [8.0], 3.3, 0.1, seed=1))
    assert pickle.loads(pickle.dumps(found)).intervals() == found.intervals()


def test_intervals_that_cannot_be_are_refused():
    found = fit(*record("first order", [8.0], 3.3, 0.1, seed=1))
    for level in (0, 1, "high"):
        with pytest.raises(ValueError, match="a probability between 0 and 1"):
            found.intervals(level)
    few = fit([0, 1, 2, 3], [0, 1, 1, 1], [0, 0, 1, 1.5])
    assert all(error == math.inf for error in few.errors.values())
    with pytest.raises(ValueError, match="4 samples tell no noise from a model of 4 numbers"):
        few.intervals()


# ---------------------------------------------------------------------------- the ruler


def step_records(noise, count=60):
    """Step responses of random lags with dead time: without noise, and with it."""
    rng = np.random.default_rng(8)
    for _ in range(count):
        K, T1, share, delay = rng.uniform(0.5, 4), rng.uniform(3, 20), rng.uniform(0, 1), rng.uniform(0.1, 1)
        T = [T1, share * T1] if rng.random() < 0.5 else [T1]
        delay *= T1
        times = np.linspace(0, 1.1 * (5 * sum(T) + delay + 10), int(rng.choice([100, 300, 1000])))
        at = times[len(times) // 10]
        u = 1.0 * (times >= at)
        kind = "first order" if len(T) == 1 else "second order"
        y = 3 + K * responses(kind, T, delay, times, u)[0]
        yield times, at, y, y + noise * K * rng.normal(size=len(times))


@pytest.mark.parametrize("delay_by", ["tangent", "two points"])
@pytest.mark.parametrize(
    ("noise", "bias", "spread"), [(0.001, 0.5, 1), (0.01, 1.5, 3), (0.03, 2.5, 6.5), (0.05, 4, 10)]
)
@pytest.mark.daily(3)
def test_noise_does_little_to_what_is_read_off(delay_by, noise, bias, spread):
    """Bias and spread of lag and dead time in per cent of lag and sum; of the tangent these were 31 and 34 at 0.03."""
    found = []
    for times, at, smooth, noisy in step_records(noise):
        calm, model = (first_order_from_step(times, y, at=at, delay_by=delay_by) for y in (smooth, noisy))
        found.append([model.T1 / calm.T1 - 1, (model.delay - calm.delay) / (calm.T1 + calm.delay)])
    found = 100 * np.array(found, dtype=float)
    assert abs(found.mean(axis=0)).max() < bias
    assert found.std(axis=0).max() < spread


def test_without_noise_the_ruler_lies_on_the_samples():
    for times, at, smooth, _ in step_records(0, count=20):
        K = smooth[-len(smooth) // 10 :].mean() - 3
        rise, elapsed = (smooth - 3) / K, times - at
        slopes = np.diff(rise) / np.diff(times)
        k = slopes.argmax()
        delay = elapsed[k] - rise[k] / slopes[k]
        t_63 = np.interp(0.6321205588285577, rise, elapsed)
        model = first_order_from_step(times, smooth, at=at)
        assert float(model.delay) == pytest.approx(delay, abs=2e-3 * t_63)
        assert float(model.T1) == pytest.approx(t_63 - delay, rel=5e-3)


def test_a_converter_with_coarse_steps_is_noise():
    times = np.linspace(-10, 80, 901)
    y = 2 * -np.expm1(-np.maximum(times - 4, 0) / 10)
    for delay_by in ("tangent", "two points"):
        model = first_order_from_step(times, np.round(y / 0.02) * 0.02, at=0, delay_by=delay_by)
        assert [float(x) for x in (model.K, model.T1, model.delay)] == pytest.approx([2, 10, 4], rel=0.04)
