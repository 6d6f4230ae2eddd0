"""Transfer functions: from equations, their forms and characteristics, block algebra and responses."""

import control
import numpy as np
import pytest
import scipy.signal
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import DiracDelta, Eq, Function, Heaviside, I, Rational, cancel, exp, nan, oo, sin, sqrt, symbols

from draws import draws
from loopbook.laplace import evaluate
from loopbook.transfer import (
    characteristic_polynomial,
    dead_time,
    double_integrator,
    feedback,
    first_order,
    impulse_response,
    initial_gain,
    integrator,
    integrator_with_lag,
    order,
    parallel,
    poles,
    response,
    response_time,
    second_order,
    series,
    simplified,
    static_gain,
    step_response,
    time_constant_form,
    transfer_functions,
    zero_pole_form,
    zero_pole_gain,
    zeros,
)
from plainmath.expressions import agreement, exact, s, t

K, T, T_1, T_2, tau, a, U, w, zeta = symbols("K T T_1 T_2 tau a U omega zeta", positive=True)
y, x, u, v = (Function(name) for name in "yxuv")
quick = settings(deadline=None, max_examples=draws(20))


def same(one, other):
    return agreement(one, other) == "proved"


def numeric(H):
    """The python-control object for a rational transfer function with numbers."""
    above, below = cancel(exact(H)).as_numer_denom()
    return control.tf(*([float(c) for c in sympy.Poly(part, s).all_coeffs()] for part in (above, below)))


def sorted_roots(values):
    return sorted((complex(value) for value in values), key=lambda z: (round(z.real, 6), round(z.imag, 6)))


SYSTEMS = {
    "lag": 3 / (4 * s + 2),
    "two lags": second_order(2, 5, 3),
    "equal lags": second_order(2, 3, 3),
    "integrator": integrator(2),
    "integrator with lag": integrator_with_lag(1, 4),
    "right half-plane zero": (1 - 3 * s) / (s + 1) ** 2,
    "direct": (3 * s + 1) / (s + 2),
    "oscillator": 1 / (s**2 + 0.4 * s + 1),
    "undamped": 2 / (s**2 + 9),
    "equation 5.13": (4 * s - 4) / (s**2 + 5 * s + 6),
    "right half-plane pole": 1 / (s - 0.5),
    "real irrational poles": (s + 2) / (s**2 + 4 * s + 1),
    "third order": 1 / (s**3 + 2 * s**2 + 3 * s + 1),
    "repeated pair": 1 / (s**2 + s + 2) ** 2,
    "high order": (s + 0.3) / ((s + 1) ** 4 * (s**2 + 0.5 * s + 2) * (2.5 * s + 1)),
    "loop of third order": feedback(series(2 + 0.5 / s, second_order(1.3, 2.7, 0.9))),
}
by_name = pytest.mark.parametrize("name", SYSTEMS)


# ------------------------------------------------------------------------------------------------ from equations


def test_states_become_internal():
    model = [Eq(x(t).diff(t), -2 * x(t) + 3 * u(t)), Eq(y(t).diff(t), x(t) - 0.5 * y(t) + v(t)), Eq(v(t), 4 * u(t))]
    (H,) = transfer_functions(model, y(t), [u(t)])
    state_space = control.ss([[-2, 0], [1, -0.5]], [[3], [4]], [[0, 1]], [[0]])
    at = 0.7j
    assert complex(H.subs(s, at)) == pytest.approx(state_space(at))


def test_derivatives_of_inputs_delays_and_constants():
    model = Eq(y(t).diff(t, 2) + 3 * y(t).diff(t) + 2 * y(t), u(t).diff(t) + 5 * u(t) + v(t - 2) + 7)
    H, delayed = transfer_functions(model, y(t), [u(t), v(t)])
    assert same(H, (s + 5) / ((s + 1) * (s + 2)))
    assert same(delayed, exp(-2 * s) / ((s + 1) * (s + 2)))
    assert transfer_functions(Eq(y(t).diff(t), u(t) - y(t - 1)), y(t), u(t)) == (1 / (s + exp(-s)),)


@pytest.mark.parametrize(
    ("equations", "output", "inputs", "why"),
    [
        (Eq(y(t).diff(t), u(t)), y(t), [v(t)], r"v\(t\) does not occur .*: expected one of u\(t\), y\(t\)"),
        (Eq(y(t).diff(t), u(t) + v(t)), y(t), [u(t)], "expected one equation for each signal that is not an input"),
        (Eq(y(t).diff(t), u(t)), u(t), [u(t)], "both an output and an input"),
        (Eq(y(t).diff(t), u(t) * v(t)), y(t), [u(t), v(t)], "cannot transform"),
        (y(t).diff(t) + u(t), y(t), [u(t)], "is not an equation"),
        ([Eq(y(t), x(t) + u(t)), Eq(2 * y(t), 2 * x(t) + u(t))], y(t), [u(t)], "do not determine"),
        (Eq(y(symbols("t")), u(symbols("t"))), y(t), [u(t)], "another symbol than plainmath's"),
    ],
)
def test_transfer_functions_refuses(equations, output, inputs, why):
    with pytest.raises(ValueError, match=why):
        transfer_functions(equations, output, inputs)


# ------------------------------------------------------------------------------------------------ models


def test_standard_models():
    assert first_order(K, T, tau) == K * exp(-tau * s) / (T * s + 1)
    assert second_order(K, T_1, T_2) == K / ((T_1 * s + 1) * (T_2 * s + 1))
    assert integrator(K, tau) == K * exp(-tau * s) / s
    assert integrator_with_lag(K, T) == K / (s * (T * s + 1))
    assert double_integrator(K) == K / s**2
    assert first_order(np.float64(0.5), 0) == Rational(1, 2)
    assert first_order(2, 0.1 + 0.2) == 2 / (3 * s / 10 + 1)


@pytest.mark.parametrize("wrong", [-1, -0.5, symbols("m", negative=True), I, oo])
def test_a_time_is_not_negative(wrong):
    for model in (lambda: first_order(1, wrong), lambda: second_order(1, 1, wrong), lambda: dead_time(wrong)):
        with pytest.raises(
            ValueError, match=r"(T|T2|delay) is .*: expected a (finite real number|number that is not negative)"
        ):
            model()


@pytest.mark.parametrize("wrong", ["K", None, [1], True, nan, np.array([1, 2])])
def test_a_parameter_is_a_number_or_an_expression(wrong):
    for use in (integrator, dead_time, poles, static_gain, lambda K: first_order(1, K), lambda H: series(H, 1 / s)):
        with pytest.raises(ValueError, match="expected a number or an expression"):
            use(wrong)


def test_another_s_is_named():
    other = 1 / (symbols("s", real=True) + 1)
    for use in (poles, zeros, static_gain, initial_gain, order, step_response, series, feedback, zero_pole_form):
        with pytest.raises(ValueError, match="another symbol than plainmath's"):
            use(other)
    with pytest.raises(ValueError, match="contains t: expected a function of s"):
        series(t, 1 / s)


# ------------------------------------------------------------------------------------------------ characteristics


def test_equation_5_13():
    H = (4 * s - 4) / (s**2 + 5 * s + 6)
    assert (poles(H), zeros(H), zero_pole_gain(H), order(H)) == ([-3, -2], [1], 4, 2)
    assert str(zero_pole_form(H)) == "4*(s - 1)/((s + 2)*(s + 3))"
    assert characteristic_polynomial(H) == s**2 + 5 * s + 6
    assert poles((s**2 + 0.3 * s + 0.02) / ((s + 0.1) * (s + 3))) == [-3]  # what cancels is gone


@by_name
def test_poles_zeros_and_gains_are_those_of_python_control(name):
    H, reference = SYSTEMS[name], numeric(SYSTEMS[name])
    # a repeated root is the square or fourth root of the rounding that numerical roots suffer
    assert np.allclose(sorted_roots(poles(H)), sorted_roots(reference.poles()), atol=2e-3)
    assert np.allclose(sorted_roots(zeros(H)), sorted_roots(reference.zeros()), atol=1e-6)
    assert order(H) == len(reference.poles()) == sympy.degree(characteristic_polynomial(H), s)
    assert float(static_gain(H)) == pytest.approx(float(reference.dcgain()))
    assert float(initial_gain(H)) == pytest.approx(reference(1e12).real, abs=1e-9)


@by_name
def test_the_forms_are_the_transfer_function(name):
    H = SYSTEMS[name]
    for form in (zero_pole_form, time_constant_form, simplified):
        assert complex(form(H).subs(s, 0.3 + 0.7j)) == pytest.approx(complex(H.subs(s, 0.3 + 0.7j)), rel=1e-12)
        late = form(H * exp(-2 * s))
        assert complex(late.subs(s, 0.3j)) == pytest.approx(complex((H * exp(-2 * s)).subs(s, 0.3j)), rel=1e-12)


def test_forms_keep_together_what_may_not_be_real():
    H = w**2 / (s**2 + 2 * zeta * w * s + w**2)
    assert str(zero_pole_form(H)) == "omega**2/(omega**2 + 2*omega*s*zeta + s**2)"
    assert same(time_constant_form(H), 1 / (s**2 / w**2 + 2 * zeta * s / w + 1))
    assert len(time_constant_form(H).args) == 2
    assert zero_pole_form(1 / (s**2 - a)) == 1 / ((s - sqrt(a)) * (s + sqrt(a)))
    assert str(time_constant_form(K / (s * (s + a)))) == "K/(a*s*(1 + s/a))"
    assert zero_pole_form(1 / (s**3 + s + 1)).has(1.0) is False
    with pytest.raises(ValueError, match="expected real coefficients"):
        zero_pole_form(1 / (s + I))


def test_nothing_and_constants():
    assert (poles(0), zeros(0), order(0), zero_pole_form(0), time_constant_form(0)) == ([], [], 0, 0, 0)
    assert (poles(5), zeros(5), order(5), zero_pole_form(5), time_constant_form(5)) == ([], [], 0, 5, 5)
    assert (static_gain(0), initial_gain(5), step_response(0), series(), parallel()) == (0, 5, 0, 1, 0)


def test_gains_of_integrators_and_dead_times():
    assert (static_gain(1 / s), static_gain(-2 / s), static_gain(1 / s**2)) == (oo, -oo, oo)
    assert (initial_gain(s), initial_gain(exp(-s)), initial_gain(2 + exp(-s))) == (oo, 0, 2)
    assert initial_gain(K * (a * s + 1) / (T * s + 1)) == K * a / T
    assert static_gain(feedback(first_order(2, 3, 1))) == Rational(2, 3)
    assert static_gain((1 - exp(-s)) / s) == 1


def test_poles_are_refused_where_there_are_endlessly_many():
    with pytest.raises(ValueError, match="dead time in its denominator"):
        poles(feedback(first_order(2, 3, 1)))
    with pytest.raises(ValueError, match="adds terms of different dead times"):
        poles(1 / s + exp(-s))
    with pytest.raises(ValueError, match="give numbers for a"):
        poles(1 / (s**3 + a * s + 1))


# ------------------------------------------------------------------------------------------------ blocks


@pytest.mark.parametrize("pair", [("lag", "oscillator"), ("integrator", "two lags"), ("direct", "third order")])
def test_figure_5_2_blocks_are_those_of_python_control(pair):
    one, other = (SYSTEMS[name] for name in pair)
    reference = numeric(one), numeric(other)
    for ours, theirs in [
        (series(one, other), control.series(*reference)),
        (parallel(one, other), control.parallel(*reference)),
        (feedback(one), control.feedback(reference[0], 1)),
        (feedback(one, other), control.feedback(*reference)),
        (feedback(one, other, sign=1), control.feedback(*reference, sign=1)),
    ]:
        for point in (0.3j, 1 + 2j, -0.13 + 5j):
            assert complex(ours.subs(s, point)) == pytest.approx(theirs(point), rel=1e-10)


def test_blocks_with_dead_time():
    assert series(first_order(2, 3, 1), first_order(1, 2, 0.5)) == 2 * exp(-3 * s / 2) / ((2 * s + 1) * (3 * s + 1))
    assert same(parallel(1 / s, exp(-s) / s), (1 + exp(-s)) / s)
    assert str(feedback(first_order(2, 3, 1))) == "2*exp(-s)/(3*s + 1 + 2*exp(-s))"
    assert feedback(1 / s, exp(-s)) == 1 / (s + exp(-s))
    assert parallel(1 / s, -1 / s) == 0


def test_blocks_that_are_not_known():
    G, H = Function("G")(s), Function("H")(s)
    assert series(G, H) == G * H
    assert feedback(G, H) == G / (1 + G * H)


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((1 / s, 1, 0), "sign is 0: expected -1"),
        ((-1,), "has no solution"),
        ((oo,), "is infinite"),
    ],
)
def test_feedback_refuses(arguments, why):
    with pytest.raises(ValueError, match=why):
        feedback(*arguments)


# ------------------------------------------------------------------------------------------------ responses


@by_name
def test_step_responses_are_those_of_python_control(name):
    times = np.linspace(0, 12, 61)
    reference = control.step_response(numeric(SYSTEMS[name]), times).outputs
    assert evaluate(step_response(SYSTEMS[name]), times) == pytest.approx(reference, rel=1e-7, abs=1e-8)


@by_name
@pytest.mark.daily(8)
def test_impulse_responses_are_those_of_scipy(name):
    H, times = SYSTEMS[name], np.linspace(0, 8, 33)
    ours = impulse_response(H)
    direct = ours.coeff(DiracDelta(t))
    assert direct == initial_gain(H)
    reference = numeric(simplified(H - direct))
    expected = scipy.signal.impulse((reference.num[0][0], reference.den[0][0]), T=times)[1]
    assert evaluate(ours - direct * DiracDelta(t), times) == pytest.approx(expected, rel=1e-6, abs=1e-8)


@pytest.mark.parametrize(
    "signal", [t, sin(2 * t), exp(-0.3 * t), 5 * Heaviside(t - 1) - 3 * Heaviside(t - 4), t * Heaviside(t - 2)], ids=str
)
def test_responses_to_other_inputs(signal):
    H, times = SYSTEMS["third order"], np.linspace(0, 10, 10001)
    expected = control.forced_response(numeric(H), times, evaluate(signal, times)).outputs
    found = evaluate(response(H, signal), times[::50])
    assert found == pytest.approx(expected[::50], abs=1e-3)  # which joins the values by lines, jumps too


def test_dead_time_makes_a_response_late():
    times = np.linspace(0, 12, 121)
    for H in (SYSTEMS["oscillator"], SYSTEMS["direct"], (1 - exp(-2 * s)) * SYSTEMS["third order"]):
        late = evaluate(step_response(H * dead_time(2.5)), times)
        assert not late[times < 2.5].any()
        on_time = evaluate(step_response(H), times[times >= 2.5] - 2.5)
        assert late[times >= 2.5] == pytest.approx(on_time, rel=1e-9, abs=1e-12)
    assert same(step_response(first_order(K, T, tau)), K * (1 - exp(-(t - tau) / T)) * Heaviside(t - tau))


def test_responses_refuse_what_has_none():
    with pytest.raises(ValueError, match="dead time in its denominator"):
        step_response(feedback(first_order(2, 3, 1)))
    with pytest.raises(ValueError, match="not a rational function of s and dead times"):
        response(1 / (s + 1), u(t))
    with pytest.raises(ValueError, match="another symbol than plainmath's"):
        response(1 / (s + 1), symbols("t"))


# ------------------------------------------------------------------------------------------------ response time


def test_equation_6_34_response_time_of_one_lag():
    for lag in (1e-6, 0.3, 5, 1e6):
        assert response_time(first_order(-3, lag)) == pytest.approx(lag, rel=1e-12)
    assert response_time(first_order(2, 5, 2)) == pytest.approx(7, rel=1e-12)
    assert response_time(first_order(1, 1), share=0.99) == pytest.approx(np.log(100), rel=1e-12)


def test_equation_6_36_response_time_of_two_lags():
    found = response_time(second_order(1, 1, 1))
    assert (1 + found) * np.exp(-found) == pytest.approx(np.exp(-1), rel=1e-12)
    assert round(found) == 2


@pytest.mark.filterwarnings("error")
def test_response_time_finds_the_first_crossing_on_every_scale():
    # a long dead time before a short lag
    assert response_time(first_order(1, 1, 1000)) == pytest.approx(1001, rel=1e-12)
    # lags that differ by seven orders of magnitude
    assert response_time(second_order(1, 1e4, 1e-3)) == pytest.approx(1e4 + 1e-3, rel=1e-9)
    # a fast oscillation crosses 63 % many times before one unit of time is over; the first crossing counts
    fast, slow = (1 / (lag**2 * s**2 + 0.002 * lag * s + 1) for lag in (1e-4, 1))
    assert response_time(fast) == pytest.approx(1e-4 * response_time(slow), rel=1e-9)
    # jumps
    assert response_time((2 * s + 1) / (s + 1)) == 0
    assert response_time(dead_time(2)) == pytest.approx(2)
    assert response_time((1 + exp(-3 * s)) / 2) == pytest.approx(3)
    assert response_time(5) == 0


@pytest.mark.parametrize(
    ("H", "share", "why"),
    [
        (integrator(1), 0.5, "does not settle"),
        (1 / (s - 1), 0.5, "does not settle"),
        (s / (s + 1), 0.5, "settles at 0: expected a number other than zero"),
        (first_order(K, 5), 0.5, "give a number for K"),
        (first_order(1, 1), 1, "share is 1: expected a number between 0 and 1"),
        (first_order(1, 1), K, "share is K: expected a number between 0 and 1"),
        ((s**2 + 1) / (s + 1), 0.5, "an impulse has an area but no value"),
    ],
)
def test_response_time_refuses(H, share, why):
    with pytest.raises(ValueError, match=why):
        response_time(H, share)


# ------------------------------------------------------------------------------------------------ laws, at random

lags = st.builds(Rational, st.integers(1, 9), st.integers(1, 4))
blocks = st.builds(lambda K, z, T1, T2: K * (z * s + 1) / ((T1 * s + 1) * (T2 * s + 1)), lags, lags, lags, lags)


@quick
@given(blocks, blocks)
def test_series_and_parallel_commute_and_feedback_undoes_itself(G, H):
    assert series(G, H) == series(H, G)
    assert parallel(G, H) == parallel(H, G)
    assert feedback(feedback(G, H), H, sign=1) == simplified(G)


@quick
@given(blocks)
def test_gains_are_the_limits_of_the_step_response(H):
    response_to_step = step_response(H)
    assert response_to_step.subs(t, 0) == initial_gain(H)
    assert sympy.limit(response_to_step, t, oo) == static_gain(H)
    assert sympy.expand(3 * response_to_step.diff(t) - impulse_response(H, 3)) == 0


@quick
@given(blocks)
def test_the_forms_of_any_block_are_the_block(H):
    assert order(H) == len(poles(H)) >= len(zeros(H))
    assert same(zero_pole_form(H), H)
    assert same(time_constant_form(H), H)
