"""Systems with exact dead time, against series that end, hand-derived responses and other libraries."""

import math
from fractions import Fraction
from itertools import pairwise

import control
import numpy as np
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.special import gammainc

from draws import draws
from loopbook import s, t
from loopbook.deadtime import System, closed_loop, normal_form
from loopbook.laplace import evaluate, inverse, transform
from loopbook.loops import Loop
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.simulation import simulate
from loopbook.transfer import first_order, second_order, step_response

DELAY = sympy.exp(-s)
TIMES = np.linspace(0, 7, 211)
PARTS = st.fractions(-2, 2, max_denominator=6).map(sympy.Rational)
LAGS = st.fractions("1/4", 3, max_denominator=6).map(sympy.Rational)
DEAD_TIMES = st.fractions(2, 3, max_denominator=7).map(sympy.Rational)


def series(L, H, end):
    """The step response of H/(1 + L): the geometric series, of which only finitely many terms come before the end."""
    delay = min(normal_form(L)[0])  # of one pass through the loop
    return sympy.Add(*(inverse(H / s * (-L) ** n) for n in range(int(end / delay) + 1)))


# ------------------------------------------------------------------------------------------------ responses in time


@pytest.mark.parametrize("k", [Fraction(1, 3), Fraction(1), Fraction(3, 2), Fraction(2)])
def test_an_integrator_with_delay_follows_its_series(k):
    """With a gain of 2 it is unstable."""

    def exact(x):
        return float(sum((-1) ** (n + 1) * k**n * (x - n) ** n / math.factorial(n) for n in range(1, int(x) + 1)))

    times = [Fraction(n, 25) for n in range(501)]
    loop = closed_loop(sympy.Rational(k.numerator, k.denominator) * DELAY / s)
    expected = np.array([exact(x) for x in times])
    assert loop.step([float(x) for x in times]) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@settings(deadline=None, max_examples=draws(6))
@given(K=PARTS, T=LAGS, Ti=LAGS, delay=DEAD_TIMES)
def test_a_pi_loop_follows_its_series(K, T, Ti, delay):
    assume(K != 0)
    loop = Loop(first_order(K, T, delay), PID(sympy.Rational(1, 2), Ti))
    for system, forward in ((loop.servo, loop.open), (loop.regulator, loop.process)):
        expected = evaluate(series(loop.open, forward, 7), TIMES)
        assert system.step(TIMES) == pytest.approx(expected, rel=1e-11, abs=1e-12 * max(1, abs(expected).max()))


@pytest.mark.parametrize("n", [18, 40, 60])
def test_high_orders(n):
    """(s + 1)^-n answers a step with the lower gamma function; around it, by a series in the loop."""
    times = np.array([0.2, 0.5, 1, 1.5, 2]) * n
    process = DELAY / (s + 1) ** n
    assert System(process).step(times) == pytest.approx(gammainc(n, times - 1), abs=1e-13)
    half = sympy.Rational(1, 2)
    expected = sum((-1) ** k / 2 ** (k + 1) * gammainc(n * (k + 1), np.maximum(times - k - 1, 0)) for k in range(8))
    assert Loop(process, half).servo.step(times) == pytest.approx(expected, abs=1e-13)


def test_lags_of_all_sizes_and_roots_at_zero_and_beyond():
    lags = [sympy.Rational(round(10 ** (4 - k / 6)), 10**4) for k in range(24)]
    many, times = sympy.prod([1 / (T * s + 1) for T in lags]), np.array([0.3, 1, 3, 10])
    shares = [sympy.prod([T / (T - other) for other in lags if other != T]).evalf(60) for T in lags]
    expected = [
        1 - sum(share * sympy.exp(-x / T).evalf(60) for share, T in zip(shares, lags, strict=True))
        for x in map(sympy.Rational, map(str, times))
    ]
    assert System(many).step(times) == pytest.approx(np.array(expected, float), rel=1e-12)
    assert System(many / s**3).step(times) == pytest.approx(System(many).response(times, t**3 / 6), rel=1e-12)
    beyond = System(1 / (s + 1) ** 20 / (s - 1))  # times s - 1 it is the lags
    assert beyond.impulse(times) - beyond.step(times) == pytest.approx(gammainc(20, times), abs=1e-12)


def test_dead_times_without_a_common_base():
    # 99/70 and 1 have the common base 1/70; exp(-sqrt(2) s) has none
    for late in (sympy.Rational(99, 70), sympy.sqrt(2)):
        denominator = s + 1 + DELAY + sympy.exp(-late * s) / 2
        expected = sum(  # 1/(s + 1)^(n + 1) answers a step with the lower gamma function
            (-1) ** n * math.comb(n, k) / 2**k * gammainc(n + 1, np.maximum(TIMES - (n - k) - k * float(late), 0))
            for n in range(8)
            for k in range(n + 1)
        )
        assert System(1 / denominator).step(TIMES) == pytest.approx(expected, abs=1e-11)


def test_a_neutral_loop_repeats_its_jumps():
    # s + 1 + s exp(-s)/2, the derivative itself comes back
    L = s * DELAY / (2 * (s + 1))
    system = System(1 / (s + 1 + s * DELAY / 2))
    assert system.step(TIMES) == pytest.approx(evaluate(series(L, 1 / (s + 1), 7), TIMES), abs=1e-12)
    # and an output that jumps: unit gain, half of it comes back with the other sign
    jumps = closed_loop(sympy.Rational(1, 2) * DELAY)
    assert jumps.step([0.5, 1, 1.5, 2, 3, 4]) == pytest.approx([0, 0.5, 0.5, 0.25, 0.375, 0.3125])


@settings(deadline=None, max_examples=draws(25))
@given(st.lists(LAGS, min_size=1, max_size=4), PARTS, PARTS)
def test_without_dead_time_it_is_the_response_of_transfer(lags, zero, K):
    H = sympy.Integer(K.q) * (zero * s + 1) / math.prod((T * s + 1 for T in lags), start=sympy.S.One)
    expected = evaluate(step_response(H), TIMES)
    assert System(H).step(TIMES) == pytest.approx(expected, rel=1e-9, abs=1e-11 * max(1, abs(expected).max()))


def test_a_jump_has_the_value_after_it():
    H = System((s + 2) * sympy.exp(-sympy.Rational(1, 10) * s) / (s + 1))
    assert H.step([0.1, 0.3]) == pytest.approx([1, 2 - math.exp(-0.2)])
    # three tenths, added in floating point, are a little more than 0.3
    assert System(DELAY**3).step([3 - 1e-9, 3.0]) == pytest.approx([0, 1])
    assert System(sympy.exp(-0.3 * s)).step([0.1 + 0.1 + 0.1, 0.3]) == pytest.approx([1, 1])


def test_the_sampled_controller_tends_to_it():
    process = second_order(2, 4, 1, delay=1)
    exact = Loop(process, PID(1, Ti=4)).run(np.arange(0, 20, 0.5), setpoint=1)["y"]
    errors = []
    for step in (0.1, 0.05):
        run = simulate(Process(process), Controller(PID(1, Ti=4), step), until=20, setpoint=1)
        errors.append(abs(run["y"][:: round(0.5 / step)][:40] - exact).max())
    assert errors[1] < 0.02
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)  # the held control signal is late by half a step


def test_the_end_is_a_moment_like_any_other():
    """One that is a multiple of the dead time but for rounding, of an irrational one, or just beyond a round number."""
    for late in (sympy.sqrt(2), sympy.pi, sympy.Rational(1, 3), sympy.Rational(3, 10)):
        moment = float(late)
        for end in (moment, np.nextafter(moment, 0), np.nextafter(moment, 9)):
            assert System(sympy.exp(-late * s)).step([end]) == pytest.approx([1])
        assert System(sympy.exp(-late * s)).step([moment * (1 - 1e-12)]) == pytest.approx([0])
    for end in (0.1 * 3, 1 + 2**-52, 1 + 5e-13, 1.9800000000000002, np.cumsum([0.1] * 30)[-1]):
        assert System(1 / (s + 1)).step([end]) == pytest.approx([1 - math.exp(-end)], rel=1e-12)


def test_sums_of_irrational_dead_times_that_are_one_but_for_rounding():
    one, other = sympy.sqrt(2), sympy.sqrt(3)
    together = sympy.exp(-one * s) * sympy.exp(-other * s)  # SymPy writes it as one
    loop = closed_loop((sympy.exp(-one * s) + sympy.exp(-other * s)) / (s + 1), together)
    close = closed_loop((sympy.exp(-1.41421356237310 * s) + sympy.exp(-1.73205080756888 * s)) / (s + 1), together)
    assert loop.step(TIMES) == pytest.approx(close.step(TIMES), abs=1e-12)
    assert np.isfinite(loop.step([2**0.5 + 3**0.5])).all()


@pytest.mark.parametrize("unit", [1e-20, 1e-12, 1e-9, 1e-3, 3600, 1e9])
def test_the_unit_of_time_does_not_matter(unit):
    def loop(unit):
        unit = sympy.Rational(str(unit))
        return Loop(first_order(2, 3 * unit, unit), PID(sympy.Rational(1, 2), 2 * unit)).servo

    times = np.array([0.5, 1, 2.3456789, 7.123456789])
    assert loop(unit).step(times * unit) == pytest.approx(loop(1).step(times), rel=1e-12, abs=1e-13)
    # nor for the time that it takes
    here, there = (loop(x).step_until(7 * x).edges for x in (unit, 1))
    assert here == pytest.approx(there * unit, rel=1e-12)


# ------------------------------------------------------------------------------------------------ other inputs


@pytest.mark.parametrize("u", [t, sympy.sin(2 * t), sympy.exp(-t), t * sympy.Heaviside(t - 2), 3])
def test_any_input_with_a_transform(u):
    H = first_order(2, 3, delay=1)
    expected = evaluate(inverse(H * transform(sympy.sympify(u))), TIMES)
    assert System(H).response(TIMES, u) == pytest.approx(expected, abs=1e-12)


def test_samples_that_are_joined_by_straight_lines():
    loop = Loop(first_order(2, 3, delay=1), PID(1, Ti=2)).servo
    corners = [0, 1.5, 2.25, 7]
    u = t - sympy.Heaviside(t - 1.5) * 3 * (t - 1.5) + sympy.Heaviside(t - 2.25) * 2 * (t - 2.25)
    times = np.union1d(TIMES, corners)
    by_samples = loop.response(times, evaluate(u, times), hold="first order")
    assert by_samples == pytest.approx(loop.response(times, u), abs=1e-10)
    many = np.linspace(0, 20, 3000) ** 1.01  # none of the differences occurs twice
    by_samples = System(1 / (s + 1)).response(many, np.sin(many), hold="first order")
    assert by_samples == pytest.approx(System(1 / (s + 1)).response(many, sympy.sin(t)), abs=1e-5)
    start = 1 - np.minimum(times, 1)  # begins with a jump
    assert loop.response(times, start, hold="first order") == pytest.approx(
        loop.response(times, 1 - t + sympy.Heaviside(t - 1) * (t - 1)), abs=1e-10
    )


def test_an_impulse():
    H = first_order(2, 4, delay=1)
    assert System(H).impulse(TIMES) == pytest.approx(evaluate(inverse(H), TIMES), abs=1e-12)
    with pytest.raises(ValueError, match="not strictly proper"):
        System((s + 2) / (s + 1)).impulse([1])
    with pytest.raises(ValueError, match="not strictly proper"):
        System((s + 2) / (s + 1)).response([1], sympy.DiracDelta(t))


# ------------------------------------------------------------------------------------------------ algebra


def test_the_code_is_the_block_diagram():
    C, P = System(PID(2, Ti=3).expr), System(first_order(1, 2, delay=1))
    assert closed_loop(C * P) == C * P / (1 + C * P) == Loop(P, C).servo
    assert closed_loop(P, C) == P / (1 + C * P) == Loop(P, C).regulator
    assert P - P == 0 * P == System(0)
    assert 1 - P == -(P - 1)
    assert 2 / (s * P + 1) == System(2 / (s * P.expr + 1))
    assert hash(P + P) == hash(2 * P)


def test_a_smith_predictor_with_the_right_model_takes_the_delay_out_of_the_loop():
    C, G = PID(3, Ti=5).expr, first_order(2, 5)
    smith = closed_loop(C, G - G * sympy.exp(-4 * s))
    loop = Loop(G * sympy.exp(-4 * s), smith)
    assert loop.servo == closed_loop(C * G) * sympy.exp(-4 * s)
    assert set(loop.servo.denominator) == {0}
    wrong = Loop(G * sympy.exp(-5 * s), smith)
    assert wrong.servo.delays == [4, 5]


def test_dead_times_that_are_near_each_other_cancel():
    """Dead times 1.4 and 1.5 have the common base 0.1; (1 + 2 exp(-1.5 s)) has no end of unstable zeros."""
    P, factor = System(sympy.exp(-1.4 * s) / s), System(1 + 2 * sympy.exp(-1.5 * s))
    assert P * factor / factor == P
    assert System((1 - DELAY**7) / (1 - DELAY)).delays == [1, 2, 3, 4, 5, 6]


def test_setpoint_weights():
    Kp, Ti, Td, Tf, b = 2, 3, sympy.Rational(1, 2), sympy.Rational(1, 20), sympy.Rational(3, 10)
    P, controller = first_order(1, 2, delay=1), PID(Kp, Ti, Td, Tf).expr
    loop = Loop(P, controller, from_setpoint=PID(Kp, Ti).expr - Kp + b * Kp)
    assert loop.setpoint_to_control.step([0]) == pytest.approx([float(b * Kp)])
    assert System(P) * loop.setpoint_to_control == loop.servo
    assert loop.regulator == Loop(P, controller).regulator
    assert loop.servo.frequency(0.0) == pytest.approx(1)


def test_signals_of_a_loop_agree_with_each_other():
    P, C = first_order(2, 3, delay=1), PID(1, Ti=2)
    d = sympy.Heaviside(t - 3) / 2
    run = Loop(P, C).run(TIMES, setpoint=1, load=d)
    u = Loop(P, C)
    total = u.setpoint_to_control + u.load_to_control * System(sympy.Rational(1, 2) * sympy.exp(-3 * s))
    assert run["u"] == pytest.approx(total.step(TIMES), abs=1e-11)
    through = System(P) * (total + sympy.exp(-3 * s) / 2)
    assert run["y"] == pytest.approx(through.step(TIMES), abs=1e-11)
    with pytest.raises(ValueError, match="has no signal 'x'"):
        run["x"]


def test_the_error_of_a_loop():
    loop = Loop(first_order(2, 3, delay=1), PID(1, Ti=3))
    for mode, end in (("servo", 1 - loop.servo.step(TIMES)), ("regulator", -loop.regulator.step(TIMES))):
        assert loop.error(mode).impulse(TIMES) == pytest.approx(end, abs=1e-11)
    with pytest.raises(ValueError, match="the mode is 'both'"):
        loop.error("both")


def test_the_normal_form_with_letters():
    K, T, tau = sympy.symbols("K T tau", positive=True)
    above, below = normal_form(K * sympy.exp(-tau * s) / (T * s + 1 + K * sympy.exp(-tau * s)))
    assert {delay: part.as_expr() for delay, part in above.items()} == {tau: K}
    assert {delay: part.as_expr() for delay, part in below.items()} == {0: T * s + 1, tau: K}
    # a common factor with dead times in it
    above, below = normal_form((1 - DELAY**2) / ((1 - DELAY) * s))
    assert {delay: part.as_expr() for delay, part in above.items()} == {0: 1, 1: 1}
    with pytest.raises(ValueError, match="cannot be ordered"):
        normal_form(1 / (sympy.exp(-K * s) + s * sympy.exp(-T * s)))


# ------------------------------------------------------------------------------------------------ other models


@pytest.mark.parametrize(
    "H",
    [
        DELAY / s,
        (1 - DELAY) / (s * (s + 1 + DELAY)),
        (s**2 + sympy.exp(-2 * s)) / (s**2 + s / 2 + 3 + s * DELAY),
        (s + DELAY) / (s + 1 + s * DELAY / 3),
        sympy.S(3) / 2,
    ],
)
def test_frequency_response_and_state_space_model(H):
    omega = np.array([0.1, 0.7, 3.0, 20.0])
    expected = np.array([complex(H.subs(s, sympy.I * w).evalf(20)) for w in (sympy.Rational(str(w)) for w in omega)])
    assert System(H).frequency(omega) == pytest.approx(expected, rel=1e-13)
    A, B1, B2, C1, C2, D11, D12, D21, D22, delays = System(H).state_space()
    for w, value in zip(omega, expected, strict=True):
        late = np.diag([np.exp(-1j * w * float(delay)) for delay in delays])
        to_state = np.linalg.solve(1j * w * np.eye(len(A)) - A, np.hstack([B1, B2]))
        (direct, from_w), (to_z, around) = ((D11, D12), (D21, D22))
        G = np.vstack([C1, C2]) @ to_state + np.block([[direct, from_w], [to_z, around]])
        channel = np.linalg.solve(np.eye(len(delays)) - late @ G[1:, 1:], late @ G[1:, :1])
        assert (G[:1, :1] + G[:1, 1:] @ channel)[0, 0] == pytest.approx(value, rel=1e-10)


def test_pade_in_python_control_tends_to_it():
    loop = Loop(first_order(2, 3, delay=1), PID(1, Ti=3)).servo
    omega = np.array([0.1, 0.5, 1.0, 2.0])
    errors = [abs(loop.to_control(order)(1j * omega) - loop.frequency(omega)).max() for order in (1, 2, 4, 8)]
    assert all(later < earlier / 10 for earlier, later in pairwise(errors) if earlier > 1e-8)
    assert errors[-1] < 1e-8
    # in time, too, apart from the jump of the slope
    _, y = control.forced_response(loop.to_control(8), TIMES, np.ones_like(TIMES))
    assert y == pytest.approx(loop.step(TIMES), abs=2e-2)
    with pytest.raises(ValueError, match="order is 0: expected a whole number, at least 1"):
        loop.to_control(0)
    assert System(1 / (s + 1)).to_control(3).nstates == 1


def test_from_python_control():
    assert System(control.tf([0.1, 2], [1, 0.3, 5])) == System((s / 10 + 2) / (s**2 + 3 * s / 10 + 5))
    model = control.ss([[0, 1], [-2, -0.3]], [[0], [1]], [[1, 0.5]], [[0.25]])
    assert System(model) == System((s / 2 + 1) / (s**2 + 3 * s / 10 + 2) + sympy.Rational(1, 4))
    assert System(control.ss([], [], [], [[3]])) == System(3)
    assert Loop(control.tf([2], [3, 1]), PID(1, Ti=3)).servo == Loop(first_order(2, 3), PID(1, Ti=3)).servo
    with pytest.raises(ValueError, match="2 inputs and 1 outputs"):
        System(control.ss([[-1]], [[1, 1]], [[1]], [[0, 0]]))
    with pytest.raises(ValueError, match=r"discrete time, with the period 0\.1"):
        System(control.tf([1], [1, 0.5], 0.1))


# ------------------------------------------------------------------------------------------------ what cannot be


@pytest.mark.parametrize(
    ("H", "message"),
    [
        (sympy.Symbol("K") / s, "a number for K"),
        (PID(1, Ti=2, Td=1).expr, r"improper: it has s\*\*2 over s\*\*1"),
        (s * DELAY / 2, r"improper: it has s\*\*1 with the dead time 1"),
        (1 / (1 + s * DELAY), r"improper: it has s\*\*1 with the dead time 1 over s\*\*0"),
        (1 / DELAY, "a dead time cannot be negative"),
        ("1/s", "'1/s'"),
    ],
)
def test_what_is_no_system(H, message):
    with pytest.raises(ValueError, match=message):
        System(H)


def test_algebraic_loops():
    for G, H in ((-1, 1), (-s / (s + 1), 1), ((1 - s) / (s + 1), 1), (-1 + DELAY / s, 1)):
        with pytest.raises(ValueError, match="algebraic loop"):
            closed_loop(sympy.sympify(G), H)
    with pytest.raises(ValueError, match="algebraic loop"):
        Loop((1 - s) / (1 + s), PID(1))
    assert closed_loop(1, 1) == System(sympy.Rational(1, 2))  # a loop of gains that has one
    with pytest.raises(ValueError, match="divided by 0"):
        System(1) / 0


def test_letters_and_words_in_a_loop():
    with pytest.raises(ValueError, match="give a number for K, T in the loop"):
        Loop(first_order(sympy.Symbol("K"), 1), PID(1, Ti=sympy.Symbol("T")))
    with pytest.raises(ValueError, match="'PI' is of type str"):
        Loop(1 / s, "PI")
    with pytest.raises(ValueError, match="the frequencies are 'high': expected real numbers"):
        System(1 / s).frequency("high")
    for u in ("step", sympy.log(t + 1), sympy.Symbol("q") * t):
        with pytest.raises(ValueError, match=r"step|transform|give a number for q"):
            System(1 / s).response(TIMES, u)


@pytest.mark.parametrize("times", [[-1], [math.nan], [math.inf], ["soon"]])
def test_times_that_are_none(times):
    with pytest.raises(ValueError, match="times"):
        System(1 / s).step(times)


def test_complex_numbers_are_not_cut_down():
    for values in (np.array([1 + 2j]), [1j], 1j):
        with pytest.raises(ValueError, match="expected real numbers"):
            System(1 / s).step(values)
        with pytest.raises(ValueError, match="expected real numbers"):
            System(1 / s).frequency(values)
    model = control.ss([[-1.0]], [[1.0]], [[1.0]], [[0.0]])
    model.A = np.array([[-1 + 1j]])
    with pytest.raises(ValueError, match="A of the system is complex"):
        System(model)


def test_a_run_at_no_time_and_at_one():
    loop = Loop(1 / s, PID(1))
    assert "at no time" in repr(loop.run([]))
    assert "t = 3 to 3" in repr(loop.run(3))
