"""Margins and limits that are proved: issue's cases, and each number held against the others on loops of all kinds."""

import math
import resource
import sys

import numpy as np
import pytest
import sympy
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from draws import draws
from loopbook import s
from loopbook.deadtime import System
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.quasipolynomials import read
from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability import (
    StabilityLimitError,
    delay_margin,
    is_closed_loop_stable,
    is_stable,
    margins,
    robustness,
    ultimate,
    unstable_closed_loop_poles,
    unstable_poles,
)
from loopbook.stability.counting import count_roots
from loopbook.stability.sensitivity import largest_sensitivities
from loopbook.transfer import dead_time, first_order

R = sympy.Rational


def rational(x):
    return R(float(x))


def late(delay):
    return sympy.exp(-R(str(delay)) * s)


# ------------------------------------------------------------------------------------------------ kinds of loops


def numbers(low, high):
    """Positive numbers with two digits, even on a scale of powers."""
    return st.floats(math.log(low), math.log(high)).map(lambda x: R(f"{math.exp(x):.2g}"))


@st.composite
def loops(draw):
    """Stable loops: lags, integrators, resonances, unstable plants, several dead times, gain at infinite frequency."""
    kind = draw(st.sampled_from(("lags", "integrator", "resonance", "unstable", "neutral", "several", "predictor")))
    delay, T, k = draw(numbers(0.05, 10)), draw(numbers(0.3, 10)), draw(numbers(0.02, 5))
    if kind == "lags":
        L = k * sympy.exp(-delay * s) / ((T * s + 1) * (draw(numbers(0.01, 100)) * s + 1))
    elif kind == "integrator":
        L = k * sympy.exp(-delay * s) / s * (1 + 1 / (20 * T * s))
    elif kind == "resonance":
        z = draw(numbers(1e-4, 0.5))
        L = k * z * sympy.exp(-delay * s) / (s**2 + 2 * z * s + 1) ** draw(st.sampled_from((1, 2)))
    elif kind == "unstable":
        L = (1 + k) * sympy.exp(-delay / 20 * s) / (T * s - 1)
    elif kind == "neutral":
        L = sympy.exp(-delay * s) / (T * s + 1) * PID(k, Ti=2 * T, Td=draw(numbers(0.05, 2))).expr
    elif kind == "several":
        L = k * (sympy.exp(-delay * s) / (T * s + 1) - late("0.7") / (s + 2) + sympy.exp(-sympy.sqrt(2) * s) / (s + 1))
    else:
        model, C = 1 / (T * s + 1), k * (1 + 1 / (T * s))
        L = C / (1 + C * model * (1 - sympy.exp(-delay * s))) * model * sympy.exp(-delay * s * R("1.1"))
    L = read(L)
    assume(is_closed_loop_stable(L))
    return L


few = settings(
    max_examples=draws(25), deadline=None, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow]
)


@few
@given(loops())
def test_poles_are_counted_on_both_sides_of_each_margin(L):
    found = margins(L)
    for limit, change in (
        (found.gain_margin, lambda x: x * L),
        (found.delay_margin, lambda x: read(sympy.exp(-x * s)) * L),
    ):
        if 0 < limit < math.inf:
            share = R(1, 10**5)
            assert is_closed_loop_stable(change(rational(limit) * (1 - share)))
            assert unstable_closed_loop_poles(change(rational(limit) * (1 + share))) > 0
    if found.gain_reduction:
        assert is_closed_loop_stable(rational(found.gain_reduction * (1 + 1e-5)) * L)
        assert not is_closed_loop_stable(rational(found.gain_reduction * (1 - 1e-5)) * L)
    assert delay_margin(L) == pytest.approx(found.delay_margin, rel=1e-10)


@few
@given(loops())
def test_margins_are_where_they_are_said_to_be(L):
    found = margins(L)
    if math.isfinite(found.omega_180):
        assert L(1j * found.omega_180) == pytest.approx(-1 / found.gain_margin, rel=1e-7)
    if math.isfinite(found.omega_c):
        value = L(1j * found.omega_c)
        assert abs(value) == pytest.approx(1, rel=1e-7)
        assert abs(np.degrees(np.angle(-value))) == pytest.approx(found.phase_margin, abs=1e-5)
    if math.isfinite(found.omega_ms):
        assert abs(1 / (1 + L(1j * found.omega_ms))) == pytest.approx(found.Ms, rel=1e-7)
    w = np.geomspace(1e-3, 300, 20_001)
    assert abs(1 / (1 + L(1j * w))).max() <= found.Ms * (1 + 1e-8)


@few
@given(loops())
def test_ms_bounds_the_other_margins(L):
    found = margins(L)
    assume(found.Ms > 1 + 1e-9)
    # L stays out of a circle with the radius 1/Ms around -1
    least = found.Ms / (found.Ms - 1)
    assert found.gain_margin >= least * (1 - 1e-7)
    assert found.gain_reduction <= found.Ms / (found.Ms + 1) * (1 + 1e-7)
    assert found.phase_margin >= math.degrees(2 * math.asin(min(1, 1 / (2 * found.Ms)))) * (1 - 1e-7)


@few
@given(loops(), st.sampled_from([R(1, 10**6), R(3, 7), 10**5]))
def test_time_and_gain_may_have_any_unit(L, unit):
    found = margins(L)
    slow = margins(read(L.expr.subs(s, s * unit)))
    unit = float(unit)
    times = np.array([slow.omega_180, slow.omega_c, 1 / slow.delay_margin if slow.delay_margin else math.inf]) * unit
    expected = [found.omega_180, found.omega_c, 1 / found.delay_margin if found.delay_margin else math.inf]
    assert np.allclose(times, expected, rtol=1e-6, equal_nan=True)
    one, other = ([x.gain_margin, x.gain_reduction, x.phase_margin, x.Ms] for x in (found, slow))
    assert other == pytest.approx(one, rel=1e-8)
    if 1 < found.gain_margin < math.inf:
        half = rational((1 + found.gain_margin) / 2)
        assert margins(half * L).gain_margin == pytest.approx(found.gain_margin / float(half), rel=1e-7)


def test_equivalent_inputs():
    P, C = first_order(2, 5, delay=4), PID(R(1, 2), Ti=5)
    forms = [P * C.expr, System(P) * System(C.expr), read(P * C.expr), Loop(P, C)]
    found = [margins(form) for form in forms]
    assert len(set(found)) == 1
    assert len({ultimate(form) for form in forms}) == 1
    assert {is_closed_loop_stable(form) for form in forms} == {True}


# ------------------------------------------------------------------------------------------------ infinite frequency


def test_the_gain_at_endless_frequency():
    L = first_order(1, 10, delay=2) * PID(1.68, Ti=20, Td=5.7).expr
    found = margins(L)
    # where the phase is -180 degrees for the second time, abs(L) is above its limit 0.9576
    assert found.gain_margin == pytest.approx(1.0435677145433825, rel=1e-12)
    assert found.gain_margin < 1 / 0.9576 < R("1.06")
    assert unstable_closed_loop_poles(R(106, 100) * L) == math.inf
    assert found.Ms == pytest.approx(23.952778478977, rel=1e-9)


@pytest.mark.parametrize(("Td", "Ku"), [(4, 2.499665236497732), (1, 9.541488798179186)])
def test_ultimate_gains_without_filter(Td, Ku):
    L = first_order(1, 10, delay=1) * PID(1, 10, Td).expr
    assert ultimate(L)[0] == pytest.approx(Ku, rel=1e-12)
    assert margins(L).gain_margin == pytest.approx(Ku, rel=1e-12)


@pytest.mark.parametrize("fast", [True, False])
def test_crossings_accumulate_on_one_side_of_the_limiting_gain(fast):
    """abs(L)**2 = k*k*(1 + (w*a)**2)/(1 + w*w)/4 rises or falls towards its limit."""
    a = R(9, 10) if fast else R(11, 10)
    L = late(1) * (a * s + 1) / (s + 1) / (2 * a)
    gain = margins(L).gain_margin
    w = np.linspace(1e-3, 2000, 2_000_001)
    values = (float(a) * 1j * w + 1) / (1j * w + 1) / float(2 * a) * np.exp(-1j * w)
    crossing = np.flatnonzero((values.imag[1:] * values.imag[:-1] < 0) & (values.real[1:] < 0))
    nearest = (1 / abs(values[crossing])).min()
    assert gain == pytest.approx(min(nearest, 2), rel=1e-3)
    assert (gain < 2 * (1 - 1e-6)) == fast


def test_a_predictor_without_filter():
    process, C = late("0.5") / (3 * s + 1), PID(R(3, 10), Ti=4, Td=1).expr
    model = 1 / (3 * s + 1)
    L = read(C / (1 + C * model * (1 - late("0.5"))) * process)
    found = margins(L)
    assert is_closed_loop_stable(rational(found.gain_margin * (1 - 1e-4)) * L)
    assert not is_closed_loop_stable(rational(found.gain_margin * (1 + 1e-4)) * L)
    # the dead time of the process is the model's, so that 1 + L has the factor of the undelayed loop
    w = np.linspace(0, 500, 500_001)[1:]
    assert abs(1 / (1 + L(1j * w))).max() <= found.Ms * (1 + 1e-9)


def smith(k, wrong):
    """The loop of a Smith predictor without filter, with a wrong dead time: three terms with the highest power."""
    controller, model = PID(R(k), Ti=4, Td=1).expr, 1 / (3 * s + 1)
    return controller / (1 + controller * model * (1 - late("0.5"))) * model * late(wrong)


def test_several_dead_times_in_the_highest_powers():
    """Sizes add up to a bound, which leaves open what comes close to it."""
    loop = 3 * late("1.1") / (s + 3) * (1 + s / 30) + late("0.4") * s / (20 * (s + 1))
    found = margins(loop)
    assert ultimate(loop)[0] == pytest.approx(found.gain_margin, rel=1e-12)
    assert found.gain_margin < 1 / (R(1, 10) + R(1, 20))
    w = np.linspace(1e-3, 500, 500_001)
    assert abs(1 / (1 + read(loop)(1j * w))).max() == pytest.approx(found.Ms, rel=1e-6)
    wrong = smith("0.3", "0.6")
    assert delay_margin(wrong) > 0
    with pytest.raises(ValueError, match=r"several dead times; the gain margin is between .* and 10\.12.*; Ms is 1\.1"):
        margins(wrong)
    with pytest.raises(ValueError, match="still stable, and what is beyond the frequency"):
        ultimate(wrong)


def test_gains_at_ever_higher_frequencies_with_one_dead_time():
    """Both highest powers return with it, so that abs(L) runs between two values for ever."""
    loops = [(4 + R(4, 5) * late(1)) * (s + 1) / ((2 + k * late(1)) * (5 * s + 1)) for k in (R(3, 5), -R(3, 5))]
    w = np.linspace(1e-3, 500, 500_001)
    for loop in loops:
        found = margins(loop / 2)
        assert found.gain_margin == math.inf
        assert found.delay_margin > 0
        assert abs(1 / (1 + read(loop / 2)(1j * w))).max() == pytest.approx(found.Ms, rel=1e-6)
        assert delay_margin(4 * loop) == 0


# ------------------------------------------------------------------------------------------------ sharp resonances


def squared_resonance(z, peak):
    return 4 * z**2 * peak * late("0.7") / (s**2 + 2 * z * s + 1) ** 2


@pytest.mark.parametrize("z", [R(5, 1000), R(1, 10**4), R(1, 10**5)])
def test_no_crossing_is_seen_where_there_is_none(z):
    found = margins(squared_resonance(z, R(3, 10)))
    assert found.phase_margin == found.delay_margin == math.inf
    assert math.isfinite(found.gain_margin)


def test_what_only_just_reaches_one_and_what_does_not():
    z = R(1, 100)
    # the largest abs(L) is peak/(1 - z**2)
    top = 1 - z**2
    assert margins(squared_resonance(z, top * (1 - R(1, 10**9)))).phase_margin == math.inf
    found = margins(squared_resonance(z, top * (1 + R(1, 10**7))))
    assert found.phase_margin < 180
    assert found.omega_c == pytest.approx(1, rel=1e-3)


def test_bounded_memory_and_work():
    if sys.platform != "win32":
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found = robustness(squared_resonance(R(5, 1000), R(3, 10)), 1, [1])
    assert found.regions == [[(0, math.inf)]]
    if sys.platform != "win32":
        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 300_000  # kilobytes


def test_a_gain_that_touches_one_is_an_error_with_its_frequency():
    # abs(L) is 1 at w = 1 and nowhere above
    L = 2 * s / (s**2 + 2 * s + 1) * late(1)
    with pytest.raises(ValueError, match=r"not decided between the frequencies (0\.99999|1\.0000)"):
        margins(L)


# ------------------------------------------------------------------------------------------------ what is asked


def test_a_system_and_a_closed_loop_are_told_apart():
    assert not is_stable(1 / (s - R(1, 2)))
    assert is_closed_loop_stable(1 / (s - R(1, 2)))
    loop = Loop(late(1) / (s - 1), R(3, 10) * (s - 1) / (s * (s + 1)))
    assert is_closed_loop_stable(loop)
    assert not is_stable(loop)
    assert unstable_poles(loop) == 1
    assert unstable_poles(loop.servo) == 0
    assert unstable_poles(Loop(1 / (s + 1), 2, 1 / (s - 1))) == 1  # the block from the setpoint is unstable
    assert is_stable(Loop(1 / (s + 1), 1 + 1 / s, 1 / s))  # and here it has the controller's integrator


def test_a_removable_pole_at_zero_is_none():
    held = (1 - late(1)) / s
    assert is_stable(held)
    assert is_stable(Loop(held, 1 / s))
    assert unstable_closed_loop_poles(held) == 0
    with pytest.raises(StabilityLimitError):
        unstable_poles(held / s)
    # L is real and negative where w = pi/2, ... for held/s = (1 - exp(-s))/s**2: there, sin(w/2) = 2*(w/2)**2/k
    found = margins(held / s)
    assert not is_closed_loop_stable(rational(found.gain_margin * (1 + 1e-6)) * held / s)
    assert is_closed_loop_stable(rational(found.gain_margin * (1 - 1e-6)) * held / s)


def test_nothing_in_the_loop():
    for nothing in (0, sympy.S.Zero, Loop(1 / (s + 1), 0)):
        found = margins(nothing)
        assert found[:5] == (math.inf, 0, math.inf, math.inf, 1)
        assert delay_margin(nothing) == math.inf
        assert is_closed_loop_stable(nothing)
    with pytest.raises(ValueError, match="is 0"):
        ultimate(0)
    with pytest.raises(ValueError, match="cancel an unstable pole"):
        margins(Loop(1 / (s - 1), 0))


# ------------------------------------------------------------------------------------------------ families


def test_many_loops_at_once_are_each_as_alone():
    T, delay, Ti = 5.0, 4.0, np.array([2.0, 5.0, 9.0, 20.0])
    Kp = np.linspace(0.05, 0.9, 4)
    A = Quasipolynomials(np.array([[2 * Kp / (Ti * T), 2 * Kp / T, 0 * Kp]]), np.full((1, 1), delay))
    B = Quasipolynomials(np.array([[[0.0], [1 / T], [1.0]]]), np.zeros((1, 1)))
    found, counts = largest_sensitivities(A, B), count_roots(B + A)
    for k in range(4):
        L = 2 * dead_time(4) / (5 * s + 1) * PID(R(Kp[k]), R(Ti[k])).expr
        assert counts[k] == unstable_closed_loop_poles(L)
        if counts[k] == 0:
            assert found[k] == pytest.approx(margins(L).Ms, rel=1e-9)
        else:
            assert found[k] == math.inf


@pytest.mark.parametrize("n", [30, 40])
def test_a_high_order_whose_numbers_are_small(n):
    """In the unit of the fastest motion all values are about 1e-80 where L is negative."""
    T, d, K, Ti = 3.3, 89.0, 0.048, 457.0
    process = sympy.exp(-89 * s) / (R(33, 10) * s + 1) ** n
    found = margins(Loop(process, PID(R(48, 1000), Ti=457)))
    w = brentq(lambda w: math.pi / 2 + math.atan(w * Ti) - n * math.atan(w * T) - w * d, 1e-3, 0.04, xtol=1e-17)
    size = K * math.hypot(1, 1 / (w * Ti)) / math.hypot(1, w * T) ** n
    assert found.gain_margin == pytest.approx(1 / size, rel=1e-12)
