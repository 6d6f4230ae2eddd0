"""Stability with dead time, against known results, the argument principle and simulation."""

import math
from itertools import pairwise

import numpy as np
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from draws import draws
from loopbook import s
from loopbook.deadtime import System
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.stability import (
    StabilityLimitError,
    UndecidedError,
    boundary_pi,
    boundary_pi_approximate,
    boundary_pid,
    delay_margin,
    is_closed_loop_stable,
    margins,
    robust_in_window,
    robustness,
    robustness_pi_first_order,
    shinskey_window,
    stability_map,
    ultimate,
    unstable_closed_loop_poles,
    unstable_poles,
    unstable_roots,
)

DELAY = sympy.exp(-s)


COEFFICIENTS = st.fractions(-3, 3, max_denominator=4).map(sympy.Rational)


def test_an_integrator_with_dead_time():
    assert ultimate(DELAY / s) == pytest.approx((math.pi / 2, 4), rel=1e-12)
    assert delay_margin(1 / s) == pytest.approx(math.pi / 2, rel=1e-12)
    # with each half turn more of the phase another pair of poles has crossed
    for k in range(4):
        crossing = sympy.pi / 2 + 2 * sympy.pi * k
        assert unstable_closed_loop_poles(sympy.Rational(str(float(crossing) + 0.01)) * DELAY / s) == 2 * (k + 1)
        assert unstable_closed_loop_poles(sympy.Rational(str(float(crossing) - 0.01)) * DELAY / s) == 2 * k


def test_three_equal_lags():
    # Routh: 1 + K < 9 for (s + 1)^3 + K
    assert ultimate(1 / (s + 1) ** 3) == pytest.approx((8, 2 * math.pi / math.sqrt(3)), rel=1e-12)
    assert (unstable_closed_loop_poles(9 / (s + 1) ** 3), unstable_closed_loop_poles(7 / (s + 1) ** 3)) == (2, 0)


def test_an_unstable_process_has_a_lowest_gain():
    assert [unstable_closed_loop_poles(gain / (s - 1)) for gain in (2, sympy.Rational(1, 2))] == [0, 1]
    assert ultimate(1 / (s - 1)) == (math.inf, 0)
    Ku, Pu = ultimate(sympy.exp(-s / 2) / (s - 1))
    w = 2 * math.pi / Pu
    assert (math.tan(w / 2), Ku) == pytest.approx((w, math.sqrt(1 + w**2)))
    with pytest.raises(ValueError, match=r"no positive gain .* stable$"):
        ultimate(sympy.exp(-2 * s) / (s - 1))


def test_a_double_integrator_needs_derivative_action():
    with pytest.raises(ValueError, match=r"no positive gain .* stable$"):
        ultimate(1 / s**2)
    assert is_closed_loop_stable((s + 1) / s**2)
    assert not is_closed_loop_stable(1 / s**2)


def test_a_process_with_the_wrong_sign():
    """With a negative gain these loops are stable up to a static gain of one, or not at all with a positive gain."""
    assert ultimate(-1 / (s + 1)) == ultimate((s - 1) / (s + 1) ** 2) == (1, math.inf)
    with pytest.raises(ValueError, match=r"no positive gain .* but a negative one does"):
        ultimate(-DELAY / s)


def test_narrow_resonances_are_not_stepped_over():
    # between pole pair and zero pair the phase turns by half a turn within a ten-thousandth of the frequency
    damping, apart = sympy.Rational(1, 10**5), sympy.Rational(10001, 10**4)
    resonance = (s**2 + damping * s + apart) / (s**2 + damping * s + 1) / (s + 1) ** 3
    Ku, _ = ultimate(resonance)
    assert is_closed_loop_stable(sympy.Rational(0.9999 * Ku) * resonance)
    assert not is_closed_loop_stable(sympy.Rational(1.0001 * Ku) * resonance)


def test_a_triple_crossing_and_multiple_poles():
    loop = (5 * s + sympy.Rational(5, 3)) / (s**3 + 3 * s**2 + 6 * s + sympy.Rational(4, 3))
    assert unstable_closed_loop_poles(loop * sympy.exp(-sympy.Rational(11, 4) * s)) == 2
    assert is_closed_loop_stable(1 / (s * (s**2 + 3 * s + 3)))  # (s + 1)^3
    assert unstable_closed_loop_poles(1 / (s - 1) ** 2) == 2


def test_coefficients_need_not_be_fractions():
    assert unstable_closed_loop_poles(sympy.pi / s / (s + 1) ** 2) == 2
    assert is_closed_loop_stable(sympy.sqrt(2) * DELAY / (s + sympy.sqrt(3)))
    assert is_closed_loop_stable(1 / (10**17 * s + 1) ** 3)


def test_the_limit_itself_is_neither():
    for limit in (1 / s**2, -1 / (s + 1), 8 / (s + 1) ** 3):
        with pytest.raises(StabilityLimitError, match="imaginary axis"):
            unstable_closed_loop_poles(limit)
        assert not is_closed_loop_stable(limit)


@pytest.mark.parametrize("digits", [15, 20, 60])
def test_a_resonance_however_little_damped_is_stable_and_proved(digits):
    for damping, count in ((sympy.Rational(1, 10**digits), 0), (-sympy.Rational(1, 10**digits), 2)):
        resonance = s**2 + damping * s + 1
        assert unstable_poles(1 / resonance) == count
        assert unstable_poles(1 / sympy.expand(resonance * (s + 2 * DELAY))) == count + 2


def test_what_is_not_told_is_no_answer():
    for share, stable in ((-1, True), (1, False)):
        gain = sympy.Rational(str(sympy.N(sympy.pi / 2, 40))) * (1 + share * sympy.Rational(1, 10**20))
        assert Loop(DELAY / s, gain).is_stable is stable
    for question in (is_closed_loop_stable, unstable_closed_loop_poles):
        with pytest.raises(UndecidedError, match=r"between the frequencies 1\.5707"):
            question(sympy.pi / 2 * DELAY / s)
    # on the limit but for the thirtieth digit of a root
    with pytest.raises(UndecidedError):
        unstable_closed_loop_poles((2 + sympy.sqrt(2)) / (s * (s + 1) * (s + sympy.sqrt(2))))
    for share in (-1, 1):
        row = 1 + share * sympy.Rational(1, 10**18)
        with pytest.raises(UndecidedError, match="inf"):
            roots_of(s + 1 + s * row * DELAY)


def test_roots_on_the_axis_that_all_parts_have_in_common_are_proved():
    for D in ((s**2 + 1) * (s + DELAY), s**4 + 2 * s**2 + 1, (s**2 + 3) * (s**2 - 1)):
        with pytest.raises(StabilityLimitError):
            roots_of(sympy.expand(D))
    assert roots_of(sympy.expand((s**2 - 1) * (s**2 + s / 10**30 + 1))) == 1


def test_a_loop_that_returns_to_stability_with_more_delay():
    # s^2 + 0.1 s + 1 + 0.5 exp(-delay*s): stable, unstable, stable again
    loop = sympy.Rational(1, 2) / (s**2 + s / 10 + 1)
    pattern = [is_closed_loop_stable(loop * sympy.exp(-sympy.Rational(n, 4) * s)) for n in range(40)]
    changes = sum(one != other for one, other in pairwise(pattern))
    assert pattern[0]
    assert changes >= 3


@pytest.mark.parametrize(
    ("loop", "message"),
    [
        (sympy.Symbol("K") / s, "a number for K"),
        (s, "s is improper"),
        ((s + 1) ** 2 * DELAY / (s + 2), r"improper: it has s\*\*2 over s\*\*1"),
        ((1 + sympy.I) / (s + 1), "complex"),
        ("1/s", "'1/s'"),
    ],
)
def test_what_is_not_known(loop, message):
    for question in (is_closed_loop_stable, unstable_closed_loop_poles, ultimate, delay_margin, margins):
        with pytest.raises(ValueError, match=message):
            question(loop)


def test_an_unstable_loop_has_no_margin():
    for question in (delay_margin, margins):
        with pytest.raises(ValueError, match="not stable"):
            question(2 * DELAY / s)


# ------------------------------------------------------------------------------------------------ several dead times


def late(delay):
    return sympy.exp(-sympy.nsimplify(delay) * s)


def roots_of(D):
    return unstable_poles(1 / D)


def turns_around(D, radius=60.0):
    """The roots in a half-disc, by the turns of D along its boundary; None where it passes too close to a root."""
    around = sympy.lambdify(s, D, "numpy")
    up = np.linspace(-radius, radius, 400_001) * 1j
    arc = radius * np.exp(1j * np.linspace(math.pi / 2, -math.pi / 2, 200_001))
    values = np.concatenate([around(up), around(arc)])
    return None if abs(values).min() < 1e-3 else -round(np.angle(values[1:] / values[:-1]).sum() / (2 * math.pi))


DELAYS = st.fractions(0, 8, max_denominator=5).map(sympy.Rational)


@settings(deadline=None, max_examples=draws(60))
@given(st.lists(COEFFICIENTS, min_size=2, max_size=3), st.lists(COEFFICIENTS, min_size=1, max_size=2), DELAYS)
def test_poles_are_counted_as_the_argument_principle_does(below, above, delay):
    D = s ** len(below) + sum(c * s**n for n, c in enumerate(below))
    N = sum(c * s**n for n, c in enumerate(above))
    assume(N != 0)
    numerator, denominator = sympy.cancel(N / D).as_numer_denom()
    expected = turns_around(denominator + numerator * sympy.exp(-delay * s))
    assume(expected is not None)
    assert unstable_closed_loop_poles(N / D * sympy.exp(-delay * s)) == expected


@settings(deadline=None, max_examples=draws(40))
@given(
    st.lists(COEFFICIENTS, min_size=1, max_size=3), st.lists(st.tuples(COEFFICIENTS, COEFFICIENTS, DELAYS), max_size=3)
)
def test_roots_with_several_dead_times_are_counted_as_by_turns(below, others):
    D = s ** (len(below) + 1) + sum(c * s**n for n, c in enumerate(below))
    D += sum((a + b * s) * sympy.exp(-(delay + sympy.sqrt(n) / 3) * s) for n, (a, b, delay) in enumerate(others))
    assume(D.subs(s, 0) != 0)
    expected = turns_around(D)
    assume(expected is not None)
    assert roots_of(D) == expected


def test_the_roots_of_a_product_are_those_of_its_factors():
    """Three dead times, that are not multiples of one, and five with a third factor: s + a exp(-delay*s) is known."""
    draw = np.random.default_rng(7)
    for _ in range(draws(60)):
        factors, expected = [], 0
        for delay in (1, sympy.sqrt(2), sympy.Rational(3, 4)):
            a = sympy.Rational(round(draw.uniform(0.1, 12), 2))
            factors.append(s + a * sympy.exp(-delay * s))
            # pairs cross at a*delay = pi/2, pi/2 + 2 pi ...
            expected += 2 * math.floor((float(a * delay) - math.pi / 2) / (2 * math.pi) + 1)
        assert roots_of(sympy.expand(factors[0] * factors[1])) + roots_of(factors[2]) == expected
        assert roots_of(sympy.expand(math.prod(factors))) == expected


@pytest.mark.parametrize(("factor", "count"), [("0.999999", 0), ("1.000001", 2)])
def test_two_dead_times_in_closed_form(factor, count):
    # s + a (exp(-s) + exp(-2s)): 2 a cos(w/2) exp(-1.5 s), so that w = pi/3 and a = pi/(3 sqrt(3)) on the limit
    a = sympy.nsimplify(factor) * sympy.Rational(str((sympy.pi / (3 * sympy.sqrt(3))).evalf(30)))
    assert roots_of(s + a * late(1) + a * late(2)) == count


@settings(deadline=None, max_examples=draws(40))
@given(st.lists(st.tuples(COEFFICIENTS, DELAYS), min_size=1, max_size=4), st.booleans())
def test_dead_times_that_cannot_matter(others, stable):
    # abs(s + a) on the axis is at least a, and that is more than all others together
    a = (1 if stable else -1) * (sum(abs(c) for c, _ in others) + sympy.Rational(1, 100))
    D = s + a + sum(c * sympy.exp(-delay * sympy.sqrt(2) * s) for c, delay in others)
    assert roots_of(D) == (0 if stable else 1)


def test_roots_close_to_the_axis_and_on_it():
    for shift in (sympy.Rational(1, 10**10), -sympy.Rational(1, 10**10)):
        # the roots j and -j of s^2 + 1, and what a term that vanishes there adds
        D = s**2 + shift * s + 1 + (s**2 + 1) * late("1.5") / (4 * s + 8)
        assert roots_of(sympy.cancel(D * (4 * s + 8))) == (0 if shift > 0 else 2)
    for D in (
        s**2 + 1 + (s**2 + 1) * late("1.5") / 3,
        s + late(1) - late(2),
        (s**2 + 2) * (s + 3 * late(1)),
        s - 1 + late(2) * (s / 5 + 1),
    ):
        with pytest.raises(StabilityLimitError):
            roots_of(sympy.expand(D))


@pytest.mark.parametrize("unit", [sympy.Rational(1, 10**9), 1, 10**9])
def test_the_unit_of_time_does_not_matter(unit):
    D = s**3 + 2 * s**2 + (s + 7) * late(1) + 3 * s * late("0.3") - 5
    assert roots_of(D.subs(s, unit * s)) == turns_around(D)


def test_neutral_sums():
    half, D = sympy.Rational(1, 2), s**2 + s / 5 + 1
    for around, count in ((D, 0), (D * (s - 2), 1), (D.subs(s, -s), 2)):
        assert roots_of(sympy.expand(around * (1 + half * late(1)))) == count
        assert roots_of(sympy.expand(around * (1 - half * late(1)) * (1 + half * late("0.7") / 2))) == count
        assert roots_of(sympy.expand(around * (1 + 2 * late(1)))) == math.inf
        assert roots_of(sympy.expand(around * (1 + 2 * late(1)) * (1 + late(2) / 9))) == math.inf
    for gain in (-4, 2, 5):
        mixed = sympy.expand(D * (s - 2) * (1 + half * late(1)) + gain * late(1))
        assert turns_around(mixed) == roots_of(mixed)
    with pytest.raises(StabilityLimitError, match="approaches"):
        roots_of(D + D * late(1) + 1)
    with pytest.raises(ValueError, match=r"not decided.*0\.7.*1 or more"):
        roots_of(sympy.expand(D * (1 + 7 * late(1) / 10) * (1 + 7 * late(sympy.sqrt(2)) / 10)))
    assert roots_of(1 + s * late(1)) == math.inf  # what comes back is differentiated


def test_what_is_no_sum():
    for parts in ({}, {1: (0, 1)}):
        with pytest.raises(ValueError, match="expected a part without dead time"):
            unstable_roots(parts)


def test_responses_grow_where_roots_are_unstable():
    """Three dead times in the loop of a lag with two ways, one longer than the other, on either side of the limit."""
    process = late(1) / (3 * s + 1) + late("2.3") / (s + 1)
    Ku, Pu = ultimate(process)
    for factor in (sympy.Rational(97, 100), sympy.Rational(103, 100)):
        loop = sympy.Rational(Ku) * factor * process
        assert unstable_closed_loop_poles(loop) == (0 if factor < 1 else 2)
        y = System(1 / (1 + loop)).step_until(40 * Pu)
        swings = [np.ptp(y(np.linspace(n * Pu, (n + 1) * Pu, 200))) for n in (15, 38)]
        assert (swings[1] > swings[0]) == (factor > 1)


def test_every_form_of_a_loop():
    loop = Loop(2 * DELAY / (4 * s + 1), PID(1, Ti=4))
    assert {is_closed_loop_stable(x) for x in (loop, loop.open, System(loop.open))} == {True}
    assert delay_margin(loop) == delay_margin(loop.open) == pytest.approx(math.pi - 1)
    # derivative action without filter: exp(-s) returns with Kp Td, and 1 is the limit for the lag 1
    for Kp, count in ((0.9, 0), (1.1, math.inf)):
        assert unstable_closed_loop_poles(Loop(DELAY / (s + 1), PID(Kp, Ti=5, Td=1))) == count
    with pytest.raises(ValueError, match="no solution"):
        unstable_closed_loop_poles(-s / (s + 1))


# ------------------------------------------------------------------------------------------------ margins


@pytest.mark.parametrize("k", ["0.1", "0.5", "1", "1.5"])
def test_margins_of_an_integrator_with_dead_time(k):
    k = sympy.Rational(k)
    found = margins(k * DELAY / s)
    k = float(k)
    assert found.gain_margin == pytest.approx(math.pi / 2 / k, rel=1e-12)
    assert found.phase_margin == pytest.approx(90 - math.degrees(k), rel=1e-12)
    assert found.delay_margin == pytest.approx((math.pi / 2 - k) / k, rel=1e-12)
    assert (found.omega_180, found.omega_c) == pytest.approx((math.pi / 2, k), rel=1e-12)
    assert found.gain_reduction == 0
    # abs(1 + L)^2 = 1 - 2 k sin(w)/w + (k/w)^2 is stationary
    w = found.omega_ms
    assert found.Ms == pytest.approx((1 - 2 * k * math.sin(w) / w + (k / w) ** 2) ** -0.5, rel=1e-12)
    assert k / w + w * math.cos(w) - math.sin(w) == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(
    "loop",
    [4 / (s + 1) ** 3, 3 * (s + 2) / (s * (s + 1) * (s + 5)), (s + 1) ** 2 * 20 / s**3, 8 / ((s - 1) * (s + 5)),
     (s**2 + s / 50 + 1) / (s * (s + 1) * (s**2 / 4 + s / 90 + 1) * 3)],
)  # fmt: skip
def test_margins_without_dead_time_are_those_of_python_control(loop):
    import control

    numerator, denominator = (
        np.array(sympy.Poly(x, s).all_coeffs(), float) for x in sympy.cancel(loop).as_numer_denom()
    )
    gains, phases, _, omega_180, omega_c, _ = control.stability_margins(
        control.tf(numerator, denominator), returnall=True
    )
    found = margins(loop)
    assert found.gain_margin == pytest.approx(min((g for g in gains if g > 1), default=math.inf))
    assert found.gain_reduction == pytest.approx(max((g for g in gains if g < 1), default=0))
    assert found.phase_margin == pytest.approx(min(abs(phases), default=math.inf))
    assert found.omega_c in (pytest.approx(w) for w in omega_c)
    assert math.isnan(found.omega_180) or found.omega_180 in (pytest.approx(w) for w in omega_180)
    grid = np.geomspace(1e-3, 1e3, 1_000_001)
    dense = abs(1 / (1 + np.polyval(numerator, 1j * grid) / np.polyval(denominator, 1j * grid))).max()
    assert 1 - 1e-9 < found.Ms / max(dense, 1) < 1 + 1e-6  # 1 is that of ever higher frequencies


def predictor(process, controller, model):
    """The controller with a Smith predictor: the model without its dead time stands in for the process."""
    undelayed = model.replace(sympy.exp, lambda _: 1)
    return controller / (1 + controller * (undelayed - model))


LAG = 2 / (sympy.Rational(7, 10) * s + 1)
MODEL = LAG * late("1.4")
PREDICTOR = predictor(MODEL, PID(1.5, Ti=0.7).expr, MODEL)


def test_a_narrow_peak_of_the_sensitivity_is_found():
    zeta = sympy.Rational(1, 10**6)
    loop = (1 + zeta / 100) * DELAY / (s + 1) / 3 + zeta * s / (s**2 + zeta * s + 2) * late("0.5") / 10
    found = margins(loop)
    near = math.sqrt(2) + np.linspace(-1, 1, 400_001) * 1e-5
    S = abs(1 / (1 + System(loop).frequency(near)))
    assert found.Ms == pytest.approx(max(S.max(), margins(DELAY / (s + 1) / 3).Ms), rel=1e-4)
    resonance = 1 + zeta * 5 * s / (s**2 + zeta * s + 2)
    found = margins(resonance * DELAY / (s + 1) / 10)
    S = abs(1 / (1 + System(resonance * DELAY / (s + 1) / 10).frequency(near)))
    assert found.Ms == pytest.approx(S.max(), rel=1e-6)
    assert abs(found.omega_ms - math.sqrt(2)) < 1e-5


def test_margins_that_have_no_end():
    found = margins(1 / (s + 1))
    assert found[:5] == (math.inf, 0, math.inf, math.inf, 1)
    assert found.omega_ms == math.inf
    assert ultimate(1 / (s + 1)) == (math.inf, 0)
    assert math.isnan(found.omega_180)
    assert math.isnan(found.omega_c)
    # the gain is 2 at high frequencies: without dead time that is well, with any it is not
    assert delay_margin((4 * s + 1) / (2 * s + 1)) == 0
    assert margins(sympy.Rational(1, 2) * (4 * s + 1) / (4 * s + 3) * DELAY).gain_margin == pytest.approx(2)


def test_ultimate_gains_with_several_dead_times():
    # s + K exp(-s) + K exp(-2s), as above
    assert ultimate((late(1) + late(2)) / s) == pytest.approx((math.pi / (3 * math.sqrt(3)), 6), rel=1e-12)
    assert ultimate((1 + late(2) / 2) / s) == (math.inf, 0)
    assert ultimate(DELAY) == (1, 0)
    assert ultimate((1 - s) / (1 + s)) == (1, 0)
    # a predictor for PD control without filter: the highest powers are 1 + k + (gain - 1)*k*exp(-s), and k = 0.3
    process = DELAY / (s + 1)
    controller = predictor(process, PID(0.3, Td=1).expr, process)
    assert ultimate(controller * process) == (pytest.approx(2 + 1 / 0.3), 0)
    assert unstable_closed_loop_poles(sympy.Rational(533, 100) * controller * process) == 0
    assert unstable_closed_loop_poles(sympy.Rational(534, 100) * controller * process) == math.inf
    with pytest.raises(ValueError, match="still stable"):
        ultimate((1 + DELAY) / s)  # the poles approach the axis, but no gain brings them there


# ------------------------------------------------------------------------------------------------ boundaries


@pytest.mark.parametrize(("K", "T", "delay"), [(2, 0.7, 1.4), (1, 1, 0.01), (0.5, 3, 100), (1.75, 8, 12)])
def test_the_boundary_solves_the_equations_of_the_paper(K, T, delay):
    Ti = np.geomspace(0.02 * T, 50 * T, 40)
    Kp = boundary_pi(System(K / (T * s + 1)).expr * late(str(delay)), Ti)
    for I, gain in zip(Ti, Kp, strict=True):

        def phase(w, I=I):  # (5)
            return math.atan(w * I) - w * delay - math.atan(w * T) + math.pi / 2

        # the phase may begin to rise, but it is first zero below pi/delay
        grid = np.linspace(0, math.pi / delay, 5001)[1:]
        first = next(b for b in grid if phase(b) <= 0)
        w = brentq(phase, max(first - grid[0], 1e-12), first, xtol=1e-16, rtol=1e-15)
        assert gain == pytest.approx(I * w / K * math.sqrt((1 + (w * T) ** 2) / (1 + (w * I) ** 2)), rel=1e-11)  # (4)


@pytest.mark.parametrize(
    "process",
    [
        2 * late("1.4") / (sympy.Rational(7, 10) * s + 1),
        DELAY / s,
        late(1) / (3 * s + 1) + late(sympy.sqrt(5)) / (s + 1) / 2,
        late("0.2") / (s - 1),
        late("0.5") * (1 - s / 3) / (s**2 + s / 5 + 1),
        1 / (s + 1) ** 3,
    ],
)
def test_loops_are_stable_on_one_side_of_the_boundary(process):
    for Ti, Td, Tf in ((3, 0, 0), (6, 0.4, 0.05), (0.01, 0, 0)):
        Kp = boundary_pid(process, Ti, Td, Tf)
        if math.isnan(Kp):
            gains = np.geomspace(1e-4, 1e3, 60)
            assert not any(
                is_closed_loop_stable(process * PID(sympy.Rational(gain), Ti, Td, Tf).expr) for gain in gains
            )
        else:
            assert is_closed_loop_stable(process * PID(sympy.Rational(Kp * 0.99999), Ti, Td, Tf).expr)
            assert not is_closed_loop_stable(process * PID(sympy.Rational(Kp * 1.00001), Ti, Td, Tf).expr)


def test_the_boundary_without_filter():
    process = DELAY / (s + 1)
    Td = np.array([0, 0.1, 0.5, 0.7, 1, 2])
    Kp = boundary_pid(process, 2, Td)
    assert Kp[-3:] == pytest.approx(1 / Td[-3:], rel=1e-12)  # where exp(-s) returns with Kp Td = 1
    assert (Kp[:-3] < 1 / np.maximum(Td[:-3], 1e-9)).all()
    for d, gain in zip(Td, Kp, strict=True):
        counts = [
            unstable_closed_loop_poles(PID(sympy.Rational(f * gain), 2, sympy.Rational(d)).expr * process)
            for f in (0.999, 1.001)
        ]
        assert counts[0] == 0
        assert counts[1] == (math.inf if d >= 0.7 else 2)
    assert boundary_pid(process, [[1], [2]], [0, 0.5, 1], 0.1).shape == (2, 3)
    assert boundary_pid(process, [[1], [2]], [0, 0.5, 1], 0.1)[1, 1] == pytest.approx(
        boundary_pid(process, 2, 0.5, 0.1), rel=1e-14
    )
    late = DELAY**2 / (10 * s + 1)
    assert boundary_pid(late, [4, 8, 20], 1) == pytest.approx(
        [boundary_pid(late, Ti, 1) for Ti in (4, 8, 20)], rel=1e-12
    )


@pytest.mark.parametrize(("T", "delay", "K"), [(0.7, 1.4, 2), (1, 0.2, 1), (3, 1, 0.5)])
def test_the_approximate_boundary_solves_the_equations_with_its_branches(T, delay, K):
    Ti = np.geomspace(0.02 * T, 60 * T, 80)
    w = np.linspace(1e-6, 1.6 * math.pi / delay, 20_001)
    for I, gain in zip(Ti, boundary_pi_approximate(T, delay, Ti, K), strict=True):
        x = w * (I - T) / (1 + w**2 * I * T)
        angle = np.where(abs(x) <= 1, math.pi / 4 * x, math.pi / 2 - math.pi / 4 / np.where(x == 0, 1, x))
        phase = math.pi / 2 + angle - w * delay  # (5), with the two branches
        solutions = np.flatnonzero((phase[:-1] > 0) & (phase[1:] <= 0) & (x[:-1] >= -1) & (x[1:] >= -1))
        if len(solutions):
            n = solutions[0]
            between = w[n] + (w[n + 1] - w[n]) * phase[n] / (phase[n] - phase[n + 1])
            assert gain == pytest.approx(
                I * between / K * math.sqrt((1 + (between * T) ** 2) / (1 + (between * I) ** 2))
            )
        else:
            assert math.isnan(gain)


def test_the_approximate_boundary_is_exact_where_the_lag_is_cancelled():
    Kp = boundary_pi_approximate(0.7, 1.4, 0.7, K=2)
    assert Kp == pytest.approx(math.pi / 2 * 0.7 / 1.4 / 2, rel=1e-12)
    assert boundary_pi(MODEL, 0.7) == pytest.approx(Kp, rel=1e-12)


@pytest.mark.parametrize(
    ("question", "message"),
    [
        (lambda: boundary_pi(MODEL, 0), "values of Ti contain 0: expected positive"),
        (lambda: boundary_pi(MODEL, [1, math.inf]), "values of Ti contain inf"),
        (lambda: boundary_pi(MODEL, np.array([1j])), "expected real numbers"),
        (lambda: boundary_pid(MODEL, 1, -1), "values of Td contain -1"),
        (lambda: boundary_pid(MODEL, [1, 2], [1, 2, 3]), "arrays that fit"),
        (lambda: boundary_pid((s + 1) / (s + 2), 1, 1), "improper"),
        (lambda: boundary_pi_approximate(0, 1, 1), "T is 0"),
        (lambda: boundary_pi_approximate(1, 1, np.array([1j])), "expected real numbers"),
        (lambda: robustness(LAG, PID(1), 1), "one dead time"),
        (lambda: robustness(LAG * (1 + DELAY), PID(1), 1), "one dead time"),
        (lambda: robustness(MODEL, PID(1), [1, 0]), "gain ratios contain 0"),
        (lambda: robustness(MODEL, PID(1), "a"), "gain ratios are 'a'"),
        (lambda: shinskey_window(1), "points is 1"),
    ],
)
def test_boundaries_without_meaning(question, message):
    with pytest.raises(ValueError, match=message):
        question()


# ------------------------------------------------------------------------------------------------ robustness


@pytest.mark.parametrize(
    ("K", "T", "delay", "Kp", "Ti"), [(2, 0.7, 1.4, 0.4, 1), (1.75, 8, 12, 0.4, 30), (1, 5, 0.1, 9, 0.3)]
)
def test_the_robustness_of_pi_control_is_the_closed_form(K, T, delay, Kp, Ti):
    ratios = np.geomspace(0.05, 20, 60)
    K, T, delay, Kp, Ti = (sympy.nsimplify(str(x)) for x in (K, T, delay, Kp, Ti))
    found = robustness(K * sympy.exp(-delay * s) / (T * s + 1), PID(Kp, Ti), ratios)
    closed = robustness_pi_first_order(K, T, delay, Kp, Ti, ratios)
    assert found.upper == pytest.approx(closed, rel=1e-11)
    assert (found.lower == 0).all()
    # (8) and (9) as they are printed
    k = float(K * Kp) * ratios
    T, delay, Ti = float(T), float(delay), float(Ti)
    w = np.sqrt((-(1 - k**2) * Ti + np.sqrt((1 - k**2) ** 2 * Ti**2 + 4 * k**2 * T**2)) / (2 * Ti * T**2))
    printed = (math.pi / 2 + np.arctan(w * (Ti - T) / (1 + w**2 * Ti * T))) / w / delay
    assert closed == pytest.approx(printed, rel=1e-6)


def test_the_limit_of_a_third_order_process_under_pid_control():
    process = 2 * DELAY / (1 + sympy.Rational(17, 2) * s + sympy.Rational(45, 2) * s**2 + 18 * s**3)
    controller = PID(2, 9, 1.5, 0.15)
    ratios = robustness(process, controller, np.array([0.5, 1, 2]))
    for gain, low, high in zip((0.5, 1, 2), ratios.lower, ratios.upper, strict=True):
        assert low == 0
        for factor, stable in ((0.9999, True), (1.0001, False)):
            changed = sympy.Rational(gain) * process.subs(DELAY, sympy.exp(-sympy.Rational(factor * high) * s))
            assert is_closed_loop_stable(changed * controller.expr) == stable
    assert robustness(process, controller, 1).upper == pytest.approx(1 + delay_margin(process * controller.expr))
    assert math.isnan(robustness(process, controller, 50).upper)
    assert robustness(process, PID(0.4), 1) == (0, math.inf, [(0, math.inf)])  # abs(L) is below 1


def test_a_predictor_has_limits_on_both_sides():
    gains = np.array([0.3, 0.5, 1, 1.2, 1.5, 2.1, 2.5])
    ratios = robustness(MODEL, PREDICTOR, gains)
    assert ratios.upper[2] == pytest.approx(1 + margins(PREDICTOR * MODEL).delay_margin / 1.4, rel=1e-9)
    assert 0 < ratios.lower[2] < 1 < ratios.upper[2]
    assert ratios.upper[-1] < 1  # too much gain for the nominal dead time, and not for a short one
    for gain, regions in zip(gains, ratios.regions, strict=True):
        edges = np.array([0, *(x for region in regions for x in region if x > 0)])
        between = [*((edges[1:] + edges[:-1]) / 2), edges[-1] + 0.01]
        for delay in between:
            loop = sympy.Rational(gain) * PREDICTOR * LAG * sympy.exp(-sympy.Rational(1.4 * delay) * s)
            assert is_closed_loop_stable(loop) == any(low < delay < high for low, high in regions)


def test_the_window_of_shinskey():
    gains, delays = shinskey_window()
    product, quotient = gains * delays, gains / delays
    assert np.maximum(abs(np.log2(product)), abs(np.log2(quotient))) == pytest.approx(1)
    assert (gains[0], delays[0]) == (gains[-1], delays[-1]) == (2, 1)
    for corner in ((2, 1), (1, 2), (0.5, 1), (1, 0.5)):
        assert np.hypot(gains - corner[0], delays - corner[1]).min() == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(("T", "delay", "Ti"), [("0.7", "1.4", 1), (8, 12, 30), (5, "0.2", 2)])
def test_robust_is_what_stays_out_of_the_window(T, delay, Ti):
    T, delay = sympy.Rational(T), sympy.Rational(delay)
    process = sympy.exp(-delay * s) / (T * s + 1)
    gains = np.geomspace(0.5, 2, 20_001)
    highest = np.minimum(2 / gains, 2 * gains)

    def clearance(Kp):
        return (robustness_pi_first_order(1, T, delay, Kp, Ti, gains) / highest).min() - 1

    limit = brentq(clearance, 1e-3, 20)
    assert robust_in_window(process, PID(sympy.Rational(0.9999 * limit), Ti))
    assert not robust_in_window(process, PID(sympy.Rational(1.0001 * limit), Ti))


def test_a_predictor_is_robust_only_if_it_is_gentle():
    for Kp, Ti, robust in ((1.5, 0.7, False), (0.7, 0.7, False), (0.6, 0.7, True)):
        controller = predictor(MODEL, PID(Kp, Ti).expr, MODEL)
        assert robust_in_window(MODEL, controller) == robust
        g, d = sympy.symbols("g d")
        gains, delays = np.linspace(0.5, 2, 61), np.linspace(0.5, 2, 61)
        counts = stability_map(g * controller * LAG * sympy.exp(-d * sympy.Rational(7, 5) * s), g=gains, d=delays)
        x, y = np.meshgrid(gains, delays)
        window = (abs(np.log2(x * y)) <= 1) & (abs(np.log2(x / y)) <= 1)
        assert (counts[window] == 0).all() == robust
    assert not robust_in_window(MODEL, PID(3, 1))
    assert not robust_in_window(DELAY / (s + 1), PID(0.6, 9, 1))  # twice the gain returns forever


# ------------------------------------------------------------------------------------------------ maps


@pytest.mark.parametrize(
    ("loop", "a", "b"), [("PI", (0.01, 3), (0.1, 5)), ("predictor", (0.3, 3), (0, 3)), ("two ways", (0.1, 10), (0, 8))]
)
def test_a_map_counts_as_single_loops_do(loop, a, b):
    x, y = sympy.symbols("x y")
    loop = {
        "PI": x * (1 + 1 / (y * s)) * MODEL,
        "predictor": x * PREDICTOR * LAG * sympy.exp(-sympy.Rational(7, 5) * y * s),
        "two ways": x * DELAY / s + y * sympy.exp(-sympy.sqrt(2) * s) / (s + 1),
    }[loop]
    across, up = np.linspace(*a, 90), np.linspace(*b, 70)
    counts = stability_map(loop, x=across, y=up)
    assert counts.shape == (70, 90)
    assert len(np.unique(counts)) > 2
    draw = np.random.default_rng(3)
    for _ in range(15):
        i, j = draw.integers(90), draw.integers(70)
        assert counts[j, i] == unstable_closed_loop_poles(
            loop.subs({x: sympy.Rational(across[i]), y: sympy.Rational(up[j])})
        )


def test_a_map_ends_at_the_boundary_and_at_the_regions():
    x, y = sympy.symbols("x y")
    gains, times = np.linspace(0.01, 3, 61), np.linspace(0.1, 5, 51)
    counts = stability_map(x * (1 + 1 / (y * s)) * MODEL, x=gains, y=times)
    assert ((counts == 0) == (gains < boundary_pi(MODEL, times)[:, None])).all()
    delays, regions = np.linspace(0.01, 3, 100), robustness(MODEL, PREDICTOR, gains).regions
    counts = stability_map(x * PREDICTOR * LAG * sympy.exp(-sympy.Rational(7, 5) * y * s), x=gains, y=delays)
    stable = [[any(low < d < high for low, high in each) for each in regions] for d in delays]
    assert ((counts == 0) == np.array(stable)).all()


def test_marks_in_a_map():
    K, d = sympy.symbols("K d")
    assert stability_map(K / (s + d) ** 3, K=[7, 8, 9], d=[1, 2]).tolist() == [[0, -1, 2], [0, 0, 0]]
    neutral = stability_map(K * (s + 2) / (s + 1) * sympy.exp(-d * s), K=[0.4, 1, 3], d=[0, 1])
    assert neutral.tolist() == [[0, 0, 0], [0, -1, 10**9]]
    assert stability_map(K / (d * s - 1) ** 3, K=[2, -2], d=[1, 0]).tolist() == [[2, 3], [0, 0]]  # of order 3 and 0


@pytest.mark.parametrize(
    ("loop", "values", "message"),
    [
        ("K/s", {"K": [1]}, "expected two symbols"),
        ("K/(s + a)", {"K": [1], "b": [1]}, "has the symbols K, a, and there are values for K, b"),
        ("K/(s + a)", {"K": 1, "a": [1]}, "one-dimensional"),
        ("K/(s + a)", {"K": [1j], "a": [1]}, "expected real numbers"),
        ("K*exp(-a*s)/s", {"K": [1], "a": [-1, 1]}, "dead time -1"),
        ("K*s**2/(s + a)", {"K": [1], "a": [1]}, "improper"),
    ],
)
def test_maps_without_meaning(loop, values, message):
    with pytest.raises(ValueError, match=message):
        stability_map(sympy.sympify(loop, locals={"s": s}), **values)
