"""The engine of responses in time, against Taylor series in exact cells, poles, closed forms, and sums one by one."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook.deadtime import ChannelModel, Response, collocation
from loopbook.deadtime.superposition import response_to_samples


def model(A=(), B1=(), B2=(), C1=(), C2=(), D11=0.0, D12=(), D21=(), D22=(), delays=()):
    """A model from rows, empty parts and zeros left out."""
    A = np.array(A, float)
    n, q = len(A), len(delays)

    def full(part, *shape):
        return np.array(part, float).reshape(shape) if np.size(part) else np.zeros(shape)

    return ChannelModel(
        full(A, n, n), full(B1, n, 1), full(B2, n, q), full(C1, 1, n), full(C2, q, n), full(D11, 1, 1), full(D12, 1, q),
        full(D21, q, 1), full(D22, q, q), [Fraction(delay) for delay in delays],
    )  # fmt: skip


def feedback(K, T, delay):
    """K/(T s + 1 + K exp(-delay s)), a lag with delayed feedback."""
    return model([[-1 / T]], [[1 / T]], [[-1 / T]], [[K]], [[K]], delays=[delay])


def pi_loop(K, T, delay, Kp, Ti):
    """From the setpoint to y: a lag with dead time and a PI controller; states y before the dead time, integral."""
    return model(
        [[-1 / T, K * Kp / Ti / T], [0, 0]], [[K * Kp / T], [1]], [[-K * Kp / T], [-1]],
        D12=[[1]], C2=[[1, 0]], delays=[delay],
    )  # fmt: skip


def pid_loop(K, T, delay, Kp, Ti, Td, Tf):
    """The same with a filtered derivative: states are the lag, the integral and the filter."""
    # u = Kp (e + x_i/Ti + Td/Tf (e - x_f)),  x_i' = e,  Tf x_f' = e - x_f,  e = 1 - y(t - delay)
    gain = Kp * (1 + Td / Tf)
    to_u = np.array([0, Kp / Ti, -Kp * Td / Tf])
    A = np.array([[-1 / T, 0, 0], [0, 0, 0], [0, 0, -1 / Tf]])
    A[0] += K / T * to_u
    into = np.array([[K / T * gain], [1], [1 / Tf]])
    return model(A, into, -into, D12=[[1]], C2=[[1, 0, 0]], delays=[delay])


def by_taylor(system, times, scale=1.0):
    """Values by Taylor series in cells of which all delays are multiples, in long double."""
    A, B1, B2, C1, C2, D11, D12, D21, D22, delays = system
    A, B1, B2, C1, C2, D11, D12, D21, D22 = (
        part.astype(np.longdouble) for part in (A, B1, B2, C1, C2, D11, D12, D21, D22)
    )
    times = [Fraction(moment) for moment in times]
    below = math.lcm(*(delay.denominator for delay in delays))
    cell = Fraction(math.gcd(*(int(delay * below) for delay in delays)), below) if delays else max(times)
    size = sum(np.linalg.norm(part.astype(float)) for part in (A, B2 @ C2)) if len(A) else 0.0
    cell /= max(1, math.ceil(float(cell) * size / scale))
    h = np.longdouble(cell.numerator) / cell.denominator
    back = [int(delay / cell) for delay in delays]
    terms = 30
    x, past, values = np.zeros(len(A), np.longdouble), [], np.zeros(len(times))
    wanted = {}
    for number, moment in enumerate(times):
        wanted.setdefault(int(moment / cell), []).append((number, moment / cell - int(moment / cell)))
    for place in range(max(wanted) + 1):
        w = np.zeros((terms, len(delays)), np.longdouble)
        for k, steps in enumerate(back):
            if place >= steps:
                w[:, k] = past[place - steps][:, k]
        series = [x]
        for m in range(terms):
            series.append((A @ series[m] + B2 @ w[m] + (B1[:, 0] if m == 0 else 0)) * h / (m + 1))
        states = np.array(series[:terms]).reshape(terms, len(A))
        z, y = states @ C2.T + w @ D22.T, states @ C1[0] + w @ D12[0]
        z[0] += D21[:, 0]
        y[0] += D11[0, 0]
        past.append(z)
        x = np.array(series).sum(axis=0)
        for number, local in wanted.get(place, []):
            local = np.longdouble(local.numerator) / local.denominator
            values[number] = float(sum(c * local**m for m, c in enumerate(y)))
    return values


def assert_close(found, expected, share=1e-12):
    largest = np.maximum.accumulate(abs(expected))
    assert (abs(found - expected) <= share * largest + 1e-300).all(), (abs(found - expected) / largest).max()


def moments(end, count=60):
    """Times as fractions that are no sums of simple delays."""
    return [Fraction(k * 997, count * 1000) * Fraction(end) for k in range(1, count + 1)]


# ------------------------------------------------------------------------------------------------ short dead times


def poles_of_feedback(K, T, delay, count):
    """Poles and residues of K/(T s + 1 + K exp(-delay s))/s, by the branches of Lambert's function."""
    K, T, delay = mpmath.mpf(K), mpmath.mpf(T), mpmath.mpf(delay)
    for k in range(-count, count + 1):
        p = mpmath.lambertw(-K * delay / T * mpmath.exp(delay / T), k) / delay - 1 / T
        yield p, K / (T - K * delay * mpmath.exp(-delay * p)) / p


@pytest.mark.parametrize("delay", ["1/1000", "1/10000"])
def test_a_dead_time_much_shorter_than_the_lag(delay):
    delay = Fraction(delay)
    response = Response(feedback(3, 10, delay), 100)
    assert len(response.edges) < 60
    with mpmath.workdps(30):
        number = mpmath.mpf(delay.numerator) / delay.denominator
        known = list(poles_of_feedback(3, 10, number, 8))
        times = [float(delay) * 40, 0.1, 1.0, 3.7, 20.0, 100.0]
        expected = [
            float(mpmath.re(mpmath.mpf(3) / 4 + sum(c * mpmath.exp(p * mpmath.mpf(moment)) for p, c in known)))
            for moment in times
        ]
    assert_close(response(times), np.array(expected), 2e-13)
    early = [Fraction(k, 7) * delay for k in range(1, 100)]
    assert_close(response([float(x) for x in early]), by_taylor(feedback(3, 10, delay), [float(x) for x in early]))


def test_the_response_goes_from_short_segments_to_long_ones():
    edges = Response(pi_loop(2, 10, Fraction(1, 1000), 1, 5), 100).edges
    lengths = np.diff(edges)
    assert lengths[:3] == pytest.approx([1e-3] * 3, rel=1e-9)  # each sum of dead times is an edge
    assert lengths.max() > 1000 * lengths[0]
    assert edges[-1] >= 100


def test_short_and_long_dead_times_together():
    system = model(
        [[-0.5, 0.2], [0, -1]], [[1], [2]], [[-0.3, 0.4], [-0.2, -0.1]], [[1, 0.5]], [[1, 0], [0.5, 1]],
        delays=["1/50", "7/2"],
    )  # fmt: skip
    times = moments(20)
    response = Response(system, 20)
    assert_close(response([float(x) for x in times]), by_taylor(system, [float(x) for x in times]))
    assert len(response.edges) < 150


# ------------------------------------------------------------------------------------------------ many dead times


@pytest.mark.parametrize("count", [3, 4])
def test_dead_times_without_a_common_base(count):
    late = [Fraction(math.sqrt(p)) for p in (2, 3, 5, 7)][:count]
    near = [Fraction(round(x * 64), 64) for x in late]
    gains = np.array([[0.5, 0.3, 0.2, 0.1][:count]])

    def system(delays):
        return model([[-1]], [[1]], -gains, [[1]], np.ones((count, 1)), D11=0, D12=gains / 3, delays=delays)

    times = moments(12, 40)
    assert_close(
        Response(system(near), 12)([float(x) for x in times]), by_taylor(system(near), [float(x) for x in times])
    )
    response = Response(system(late), 30)
    assert response(30.0) == pytest.approx((1 + gains.sum() / 3) / (1 + gains.sum()), rel=0.2)


def test_very_many_sums_are_refused_in_words(monkeypatch):
    monkeypatch.setattr(collocation, "MOST_SECONDS", 0.1)
    late = [Fraction(math.sqrt(p)) for p in (2, 3, 5, 7, 11, 13)]
    system = model(D21=np.ones((6, 1)), D12=np.ones((1, 6)), D22=np.full((6, 6), 0.2), delays=late)
    with pytest.raises(ValueError, match=r"more than 30000 sums before t = 1000|needs too many segments"):
        Response(system, 1000)


# ------------------------------------------------------------------------------------------------ stiff and resonant


def test_lags_of_eight_decades():
    system = model([[-1e4, 0], [1e-4, -1e-4]], [[1e4], [0]], C1=[[0, 1]])
    times = np.array([1e-6, 1e-5, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e5])
    with mpmath.workdps(40):
        fast, slow = mpmath.mpf(1e4), mpmath.mpf(1e-4)
        exact = [
            float(1 - (fast * mpmath.exp(-slow * t) - slow * mpmath.exp(-fast * t)) / (fast - slow))
            for t in map(mpmath.mpf, times)
        ]
    response = Response(system, 1e5)
    assert_close(response(times[2:]), np.array(exact[2:]))
    assert response(times[:2]) == pytest.approx(exact[:2], abs=1e-13 * exact[2])  # of what it is a lag later
    assert len(response.edges) < 80


def test_a_derivative_with_a_filter_ten_thousand_times_faster():
    loop = pid_loop(1.0, 10.0, 1, 3.0, 10.0, 0.4, 0.4e-4)
    response = Response(loop, 100)
    assert len(response.edges) < 600
    mild = pid_loop(1.0, 10.0, 1, 3.0, 10.0, 0.4, 0.4e-2)
    times = [float(x) for x in moments(4, 30)]
    assert_close(Response(mild, 4)(times), by_taylor(mild, times, 4.0))
    # the fast filter: the first two passes by their closed form, y = x(t - 1), x' = -x/10 + u/10
    since = np.array([1e-5, 1e-4, 0.1, 0.5, 0.999])
    integral = 10 * (1 - np.exp(-since / 10))
    Tf, Td = 0.4e-4, 0.4
    ramp = since - integral
    pulse = Td / Tf * (np.exp(-since / Tf) - np.exp(-since / 10)) / (1 / 10 - 1 / Tf) / 10
    expected = 3 * (integral / 10 + ramp / 10 + pulse)
    assert response(1 + since) == pytest.approx(expected, rel=1e-11)


def test_thousands_of_periods():
    zeta, end = 1e-3, 2e4
    system = model([[0, 1], [-1, -2 * zeta]], [[0], [1]], C1=[[1, 0]])
    response = Response(system, end)
    assert len(response.edges) < 5000
    w = math.sqrt(1 - zeta**2)
    times = np.linspace(0, end, 2001)
    exact = 1 - np.exp(-zeta * times) * (np.cos(w * times) + zeta / w * np.sin(w * times))
    assert abs(response(times) - exact).max() < 1e-11  # the phase is w*t, of which 2e-12 is rounding


def test_a_fast_unstable_mode_that_is_small_at_first_is_not_lost():
    # a slow lag, and beside it a fast loop that grows from a part of 1e-9
    system = model(
        [[-0.01, 0], [0, -1]], [[0.01], [1e-9]], [[0], [-6]], [[1, 1]], [[0, 1]], delays=["1/2"],
    )  # fmt: skip
    times = [float(x) for x in moments(30, 30)]
    assert_close(Response(system, 30)(times), by_taylor(system, times))


# ------------------------------------------------------------------------------------------------ neutral


def test_jumps_that_return_for_ever():
    ring = model(D12=[[1]], D21=[[1]], D22=[[-0.9]], delays=["1/3"])
    times = np.arange(1, 200) / 3 - 1 / 6
    expected = np.r_[0, np.cumsum((-0.9) ** np.arange(198))]
    assert Response(ring, 70)(times) == pytest.approx(expected, abs=1e-13)
    undamped = model(D12=[[1]], D21=[[1]], D22=[[1]], delays=["1/3"])
    assert Response(undamped, 70)(times) == pytest.approx(np.arange(199), rel=1e-13)
    two = model(D12=[[1, 0]], D21=[[1], [0.3]], D22=[[0.2, -0.4], [0.3, 0.3]], delays=["2/5", "9/7"])
    moments_of = [float(x) for x in moments(12)]
    assert_close(Response(two, 12)(moments_of), by_taylor(two, moments_of))


@pytest.mark.parametrize("share", [0.4, 0.9, -0.9])
def test_what_goes_round_in_a_short_dead_time_is_not_forgotten(share):
    # the jumps die out, and something smooth that no state knows of goes on
    system = model([[-2]], [[1]], [[0.01]], [[1]], [[2]], D22=[[share]], delays=["1/64"])
    times = [float(x) for x in moments(20)]
    response = Response(system, 20)
    assert_close(response(times), by_taylor(system, times))
    assert len(response.edges) < 800


# ------------------------------------------------------------------------------------------------ all kinds

NUMBERS = st.floats(-2, 2).map(lambda x: round(x, 3))
DELAYS = st.fractions("1/8", 3, max_denominator=8)


@st.composite
def systems(draw):
    n, q = draw(st.integers(0, 4)), draw(st.integers(0, 3))
    assume(n + q)
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    kind = draw(st.sampled_from(["lags", "chain", "swings", "unstable", "neutral"]))
    A = rng.normal(size=(n, n)) - 1.5 * np.eye(n)
    if kind == "chain":
        A = np.diag(np.ones(max(n - 1, 0)), 1)[:n, :n]
    if kind == "swings" and n > 1:
        A[:2], A[:, :2] = 0, 0
        A[:2, :2] = [[0, 3], [-3, -0.002]]
    if kind == "unstable":
        A += 1.7 * np.eye(n)
    feed = rng.normal(size=(q, q)) * (0.6 / max(q, 1) if kind == "neutral" else 0)
    shapes = [(n, 1), (n, q), (1, n), (q, n), (1, 1), (1, q), (q, 1)]
    parts = [rng.normal(size=shape) * (rng.random() < 0.8) for shape in shapes]
    return ChannelModel(A, *parts, feed, [draw(DELAYS) for _ in range(q)])


@settings(deadline=None, max_examples=draws(40))
@given(systems(), st.integers(2, 12))
def test_random_systems(system, end):
    times = [float(x) for x in moments(end, 40)]
    expected = by_taylor(system, times)
    assume(abs(expected).max() < 1e100)
    found = Response(system, end)(times)
    # of what comes a lag later, too, since powers of the time are small at first
    largest = np.maximum.accumulate(abs(expected))
    later = np.r_[largest[8:], [largest[-1]] * 8]
    assert (abs(found - expected) <= 1e-12 * later + 1e-300).all()


# ------------------------------------------------------------------------------------------------ the object


def test_edges_quadrature_and_coefficients():
    response = Response(pi_loop(2, 5, 4, 0.5, 5), 50)
    assert response.edges[0] == 0
    assert (np.diff(response.edges) > 0).all()
    assert response.coefficients.shape == (len(response.edges) - 1, 20)
    times, weights = response.quadrature()
    assert weights.sum() == pytest.approx(response.edges[-1])
    middles = (response.edges[1:] + response.edges[:-1]) / 2
    halves = np.polynomial.legendre.legval(0.0, response.coefficients.T)
    assert response(middles) == pytest.approx(halves, abs=1e-13)
    assert (weights * response(times)).sum() == pytest.approx(
        (response.coefficients[:, 0] * np.diff(response.edges)).sum()
    )


def test_ends_that_are_none():
    for end in ("late", None, [1, 2], -1, math.inf, math.nan):
        with pytest.raises(ValueError, match="expected a number that is not negative"):
            Response(feedback(1, 1, 1), end)
    assert Response(model(D11=2.0), 0)([0.0]) == pytest.approx([2])
    with pytest.raises(ValueError, match="later than"):
        Response(feedback(1, 1, 1), 2)([30])


def test_what_cannot_be_followed(monkeypatch):
    monkeypatch.setattr(collocation, "MOST_SECONDS", 0.1)
    with pytest.raises(ValueError, match="grows beyond all numbers before t = 10"):
        Response(model([[400]], [[1]], C1=[[1]]), 10)
    with pytest.raises(ValueError, match="too short beside the end"):
        Response(model([[0, 1e6], [-1e6, 0]], [[0], [1]], C1=[[1, 0]]), 1000)
    with pytest.raises(ValueError, match="expected positive ones"):
        Response(feedback(1, 1, 0), 1)


# ------------------------------------------------------------------------------------------------ samples


def one_by_one(system, times, u, hold):
    """The sum of steps, or of the means of the step response between samples."""
    since = times - times[0]
    response = Response(system, since[-1])
    nodes, weights = np.polynomial.legendre.leggauss(12)
    values = np.zeros(len(times))
    for i, moment in enumerate(since):
        if hold == "zero order":
            values[i] = np.diff(u[: i + 1], prepend=0) @ response(np.maximum(moment - since[: i + 1], 0))
            continue
        values[i] = u[0] * response(moment)
        ago = moment - since[: i + 1]
        points = np.union1d(ago, response.edges[response.edges < ago[0]])
        lengths = np.diff(points)
        inner = points[:-1, None] + lengths[:, None] * (nodes + 1) / 2
        middle = np.interp(moment - points[:-1] - lengths / 2, since, np.arange(len(times))).astype(int)
        slopes = (np.diff(u) / np.diff(since))[middle] if i else np.zeros(0)
        values[i] += slopes @ ((response(inner.ravel()).reshape(inner.shape) @ weights) * lengths / 2)
    return values


SYSTEMS = {
    "loop": pi_loop(2, 5, 4, 0.5, 5),
    "short dead time": feedback(3, 10, "1/1000"),
    "jumps": model([[-1]], [[1]], [[-0.5]], [[1]], [[-1]], 0.5, [[0.3]], [[1]], [[-0.5]], ["7/10"]),
    "integrator": model([[0]], [[1]], C1=[[1]]),
    "unstable": feedback(-3, 10, "1/2"),
    "swings": model([[0, 1], [-1, -0.01]], [[0], [1]], C1=[[1, 0]]),
}


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("hold", ["zero order", "first order"])
@pytest.mark.parametrize("spacing", ["even", "jitter", "growing", "from another time"])
@pytest.mark.daily(10)
def test_samples_are_summed_exactly(name, hold, spacing):
    rng = np.random.default_rng(7)
    times = np.linspace(0, 40, 257)
    if spacing == "jitter":
        times[1:] += rng.uniform(-0.05, 0.05, 256)
    if spacing == "growing":
        times = times**2 / 40
    if spacing == "from another time":
        times -= 3.25
    u = rng.normal(size=257)
    found = response_to_samples(SYSTEMS[name], times, u, hold)
    expected = one_by_one(SYSTEMS[name], times, u, hold)
    assert abs(found - expected).max() <= 2e-11 * abs(expected).max()
    assert response_to_samples(model(D11=2.0), [3.0], [5.0]) == pytest.approx([10])


def test_a_kept_value_that_comes_through_a_dead_time():
    late = model(D12=[[1]], D21=[[1]], delays=["3/10"])
    u = np.arange(1.0, 101)
    expected = np.r_[0, 0, 0, u[:-3]]
    assert response_to_samples(late, np.arange(100) / 10, u) == pytest.approx(expected, abs=1e-12)
    assert response_to_samples(late, 5 + np.arange(100) * 0.1, u) == pytest.approx(expected, abs=1e-12)
    uneven = np.r_[np.arange(99) / 10, 12.0]
    assert response_to_samples(late, uneven, u)[:99] == pytest.approx(expected[:99], abs=1e-12)


@pytest.mark.parametrize("hold", ["zero order", "first order"])
@pytest.mark.parametrize(("count", "jitter"), [(20_000, 0), (3_000, 0.4)])
@pytest.mark.daily(2)
def test_long_records(hold, count, jitter):
    rng = np.random.default_rng(3)
    times = (np.arange(count) + jitter * rng.uniform(-1, 1, count)) * 0.1
    u = np.sin(0.05 * times) + rng.normal(size=count)
    found = response_to_samples(SYSTEMS["loop"], times, u, hold)
    # what a record does is the sum of what its halves do
    half = np.where(np.arange(count) < count // 2, u, 0)
    parts = [response_to_samples(SYSTEMS["loop"], times, part, hold) for part in (half, u - half)]
    assert found == pytest.approx(sum(parts), abs=1e-11 * abs(found).max())
    assert abs(parts[1][: count // 2 - 1]).max() < 1e-13 * abs(found).max()


def test_samples_that_do_not_fit():
    lag = feedback(1, 1, 1)
    for times, u, message in (
        ([0, 1], [1, 2, 3], "u has 3 values for 2 times"),
        ([0, 2, 1], [0, 0, 0], "the times go from 2 to 1: expected increasing numbers"),
        (1.0, [0, 1], "expected a row of numbers"),
        ([], [], "expected a row of numbers"),
        (np.arange(9000) ** 1.1, np.zeros(9000), "9000 at uneven distances: expected even ones, or 6324 at the most"),
    ):
        with pytest.raises(ValueError, match=message):
            response_to_samples(lag, times, u)
    with pytest.raises(ValueError, match="the hold is 'linear'"):
        response_to_samples(lag, [0, 1], [1, 2], "linear")


# ------------------------------------------------------------------------------------------------ horizons
