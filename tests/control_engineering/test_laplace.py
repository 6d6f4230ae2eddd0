"""The Laplace transform there and back, what solves differential equations with it, and its limits."""

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import (
    Derivative,
    DiracDelta,
    Eq,
    Function,
    Heaviside,
    I,
    Integral,
    Piecewise,
    Rational,
    cancel,
    cos,
    exp,
    expand,
    factorial,
    log,
    oo,
    pi,
    prod,
    sin,
    sinh,
    sqrt,
    symbols,
)

from draws import draws
from loopbook.laplace import (
    by_delay,
    definition,
    evaluate,
    final_value,
    initial_value,
    inverse,
    partial_fractions,
    roots,
    solve_ode,
    transform,
    zero_between,
)
from plainmath.expressions import agreement, s, t

k, k_1, k_2, K, T, T_1, T_2, T_3, tau, w, zeta, a = symbols("k k_1 k_2 K T T_1 T_2 T_3 tau omega zeta a", positive=True)
n = symbols("n", integer=True, positive=True)
f, g, y, x, u = (Function(name) for name in "fgyxu")
F, G, Y = Function("F"), Function("G"), Function("Y")
quick = settings(deadline=None, max_examples=draws(15))


def same(one, other):
    return agreement(one, other) == "proved"


def at_start(signal, order):
    return signal.diff(t, order).subs(t, 0)


# ------------------------------------------------------------------------------------------------ pairs


PAIRS = {
    "4.5": (1 / s, 1),
    "4.6": (k, k * DiracDelta(t)),
    "4.7": (k / s, k),
    "4.8": (k / s**2, k * t),
    "4.10": (k / (T * s + 1), k * exp(-t / T) / T),
    "4.11": (k / ((T * s + 1) * s), k * (1 - exp(-t / T))),
    "4.12": (k / ((T_1 * s + 1) * (T_2 * s + 1)), k / (T_1 - T_2) * (exp(-t / T_1) - exp(-t / T_2))),
    "4.13": (
        k / ((T_1 * s + 1) * (T_2 * s + 1) * s),
        k * (1 + (T_1 * exp(-t / T_1) - T_2 * exp(-t / T_2)) / (T_2 - T_1)),
    ),
}


@pytest.mark.parametrize("equation", PAIRS)
def test_equations_4_5_to_4_13_both_ways(equation):
    image, original = PAIRS[equation]
    assert same(transform(original), image)
    assert same(inverse(image), original)


def test_equation_4_9_power():
    assert same(transform(k * t**n), k * factorial(n) / s ** (n + 1))
    for order in range(6):
        assert transform(k * t**order) == k * factorial(order) / s ** (order + 1)
        assert inverse(k * factorial(order) / s ** (order + 1)) == k * t**order


@pytest.mark.parametrize(
    "signal",
    [
        sin(w * t), cos(w * t + 1), exp(-t) * sin(2 * t), t * exp(-t / T), t**3 * cos(t), sinh(t) * cos(t) ** 2,
        2 ** (-t), (1 + exp(-t)) ** 3, exp(-t) * Heaviside(t - 1), t**2 * Heaviside(t - tau),
        (t - 2) * Heaviside(t - 2),
    ],
)  # fmt: skip
def test_the_transform_is_the_defining_integral(signal):
    signal, s_value = signal.subs({w: 3, T: 2, tau: 1}), 2
    integrand = sympy.lambdify(t, signal * exp(-s_value * t), "mpmath")
    area = mpmath.quad(integrand, [0, 1, 2, 5, 10, 40, 100])
    assert float(transform(signal).subs(s, s_value)) == pytest.approx(float(area), rel=1e-10)


# ------------------------------------------------------------------------------------------------ properties


def test_equation_4_16_time_delay():
    assert transform(f(t - tau)) == F(s) * exp(-tau * s)
    late = (t - tau) ** 2 * exp(tau - t) * Heaviside(t - tau)
    assert same(transform(late), transform(t**2 * exp(-t)) * exp(-tau * s))
    assert agreement(inverse(transform(late)), late) != "different"


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_equation_4_17_derivatives_with_initial_values(order):
    boundary = sum(s ** (order - 1 - i) * at_start(f(t), i) for i in range(order))
    assert expand(transform(f(t).diff(t, order)) - s**order * F(s) + boundary) == 0


def test_equation_4_21_integral():
    theta = symbols("theta", positive=True)
    assert transform(Integral(f(theta), (theta, 0, t))) == F(s) / s
    assert transform(Integral(exp(-theta), (theta, 0, t))) == 1 / (s * (s + 1))


def test_initial_values_are_constants():
    assert transform(f(0) * t) == f(0) / s**2
    assert transform(at_start(f(t), 1)) == at_start(f(t), 1) / s
    assert inverse(at_start(f(t), 1) / (s + 1)) == at_start(f(t), 1) * exp(-t)


# ------------------------------------------------------------------------------------------------ refusals of transform


@pytest.mark.parametrize(
    "signal",
    [
        1 / t, exp(t**2), log(t), 1 / (t + 1), exp(exp(-t)), sin(t) / t, Piecewise((0, t < 1), (1, True)),
        Heaviside(1 - t), DiracDelta(t, 1), DiracDelta(2 * t), DiracDelta(t - 1) * Heaviside(t - 1), t * y(t),
        y(t) ** 2, y(t) * u(t),
        sin(y(t)), sqrt(y(t)), y(2 * t), y(t + 1), y(t) * Heaviside(t - 1), Integral(y(a), (a, 1, t)),
        Integral(y(t - a) * x(a), (a, 0, t)), y(t - 1).diff(t),
    ],
)  # fmt: skip
def test_transform_refuses_what_it_cannot_do(signal):
    with pytest.raises(ValueError, match=r"cannot transform .*: "):
        transform(signal)


@pytest.mark.parametrize("value", ["t", None, [t], True, sympy.Matrix([t]), t > 1, float("nan")])
def test_transform_refuses_what_is_no_expression(value):
    with pytest.raises(ValueError, match="expected a number or an expression"):
        transform(value)


@pytest.mark.parametrize("other", [symbols("t"), symbols("t", positive=True), symbols("t", real=True)])
def test_another_t_is_named(other):
    for use in (transform, definition, lambda signal: evaluate(signal, [1])):
        with pytest.raises(ValueError, match="another symbol than plainmath's"):
            use(exp(-other))
    with pytest.raises(ValueError, match="another symbol than plainmath's"):
        solve_ode(Eq(y(other).diff(other), -y(other)), {y(0): 1})


def test_each_direction_refuses_the_variable_of_the_other():
    for use in (transform, definition, lambda signal: evaluate(signal, [1])):
        with pytest.raises(ValueError, match="contains s: expected a function of t"):
            use(s * t)
    for use in (inverse, by_delay, partial_fractions, final_value, initial_value, roots):
        with pytest.raises(ValueError, match="contains t: expected a function of s"):
            use(s + t)


def test_decimals_are_exact():
    assert transform(0.1 * exp(-0.3 * t)) == 1 / (10 * s + 3)
    assert inverse(exp(-0.5 * s) / (s + 1)) == exp(Rational(1, 2) - t) * Heaviside(t - Rational(1, 2))
    # two lags that are nearly, but not quite, the same are not the same
    assert inverse(1 / ((s + 1) * (s + 1 + 1e-12))) != inverse(1 / (s + 1) ** 2)


# ------------------------------------------------------------------------------------------------ inverse


@pytest.mark.parametrize(
    "image",
    [
        1 / (s**2 + 2 * s + 5) ** 3,
        1 / (s**2 - 2),
        1 / (s**3 + s + 1),
        1 / (s**3 + s + 1) ** 2,
        (s + 1) / (s**4 + 1),
        1 / (s**4 + 4 * s**2 + 2),
        1 / (s**5 + 3 * s**4 + 2 * s**3 + 7 * s**2 + s + 1),
        1 / (1.2 * s**3 + 3.4 * s**2 + 2.1 * s + 1) / s,
        1 / (s**3 + pi * s + sqrt(2)),
        1 / expand((s + 1) ** 8 * (s + 0.1) * (s + 0.25) * (s**2 + s + 1)),
        (s**3 + 1) / (s + 2),
        s**2 + 3 * s,
        1 / (s + 1 + 2 * I),
        exp(-2 * s - 1) / (s + 1),
        (1 - exp(-s)) ** 2 / s**2,
        exp(-0.7 * s) * (s + 1) / (s**2 + 0.3 * s + 0.7),
    ],
    ids=str,
)
@pytest.mark.daily(8)
def test_inverse_and_transform_undo_each_other(image):
    signal = inverse(image)
    impulses = {DiracDelta(t): 1} | {DiracDelta(t, order): s**order for order in (1, 2)}
    back = transform(signal.subs(dict.fromkeys(impulses, 0))) + sum(signal.coeff(d) * impulses[d] for d in impulses)
    for point in (7 + I, Rational(17, 2) - 3 * I):
        assert complex(back.subs(s, point)) == pytest.approx(complex(image.subs(s, point)), rel=1e-9)
    late = inverse(exp(-3 * s) * image).replace(DiracDelta, lambda *_: 0)
    assert late.subs(t, 1) == 0, "nothing before the dead time is over"
    before = signal.replace(DiracDelta, lambda *_: 0)
    assert complex(late.subs(t, Rational(71, 10))) == pytest.approx(complex(before.subs(t, Rational(41, 10))), rel=1e-9)


def test_inverse_at_high_order_against_the_exact_sum_of_residues():
    poles = [Rational(-i * i - 1, 7) for i in range(12)]
    image = 1 / expand(prod([s - p for p in poles]))
    times = np.linspace(0, 20, 21)
    residues = [1 / prod([p - q for q in poles if q != p]) for p in poles]
    expected = [
        float(sympy.N(sum(r * exp(p * Rational(time)) for r, p in zip(residues, poles, strict=True)), 20))
        for time in times
    ]
    assert evaluate(inverse(image), times) == pytest.approx(expected, abs=1e-9 * max(expected))


def test_long_fractions_have_values():
    lags = [Rational(314159 + 7001 * i, 10**5) for i in range(9)]
    response = inverse(1 / (s * prod([lag * s + 1 for lag in lags])))
    assert evaluate(response, [1000.0]) == pytest.approx([1])


def test_inverse_with_letters():
    assert same(inverse(w**2 / (s * (s**2 + w**2))), 1 - cos(w * t))
    damped = exp(-zeta * w * t) * sin(w * sqrt(1 - zeta**2) * t) / (w * sqrt(1 - zeta**2))
    assert agreement(inverse(1 / (s**2 + 2 * zeta * w * s + w**2)), damped) != "different"
    m = symbols("m", negative=True)
    assert agreement(inverse(1 / (s**2 + m)), sinh(sqrt(-m) * t) / sqrt(-m)) != "different"
    plain = symbols("p q")
    assert same(inverse(plain[0] / (s + plain[1])), plain[0] * exp(-plain[1] * t))
    assert same(inverse(exp(-tau * s) / s), Heaviside(t - tau))


@pytest.mark.parametrize(
    ("image", "why"),
    [
        (1 / (s + exp(-s)), "dead time in its denominator"),
        (exp(s) / s, "a dead time cannot be negative"),
        (1 / sqrt(s), "not a rational function of s and dead times"),
        (Y(s), "not a rational function of s and dead times"),
        (oo, "not a rational function of s and dead times"),
        (1 / (s**3 + a * s + 1), "give numbers for a"),
        ("1/s", "expected a number or an expression"),
        (1 / (symbols("s", positive=True) + 1), "another symbol than plainmath's"),
    ],
)
def test_inverse_refuses_what_it_cannot_do(image, why):
    with pytest.raises(ValueError, match=why):
        inverse(image)


def test_by_delay():
    assert by_delay((1 - exp(-2 * s)) / s) == {0: 1 / s, 2: -1 / s}
    assert by_delay(exp(-tau * s - 1) / s) == {tau: exp(-1) / s}
    assert by_delay(exp(s) * exp(-3 * s) + 1) == {0: 1, 2: 1}
    assert by_delay(0) == {}


def test_partial_fractions_of_two_lags():
    parts = partial_fractions(K / ((T_1 * s + 1) * (T_2 * s + 1) * s))
    assert len(parts.args) == 3
    assert same(parts, K / ((T_1 * s + 1) * (T_2 * s + 1) * s))
    assert partial_fractions(0.2 * exp(-0.1 * s) / (s * (s + 0.2))) == exp(-s / 10) / s - 5 * exp(-s / 10) / (5 * s + 1)


# ------------------------------------------------------------------------------------------------ laws, at random

numbers = st.integers(-6, 6).filter(bool)
fractions = st.builds(Rational, numbers, st.integers(1, 4))
real_terms = st.builds(lambda c, p, m: c / (s - p) ** m, fractions, fractions, st.integers(1, 3))
pairs = st.builds(lambda b, c, p, q: (b * s + c) / ((s - p) ** 2 + q**2), fractions, fractions, fractions, fractions)
images = st.lists(st.one_of(real_terms, pairs), min_size=1, max_size=3).map(lambda terms: sympy.Add(*terms))
signals = st.lists(
    st.builds(
        lambda c, power, p, wave, q: c * t**power * exp(p * t) * wave(q * t),
        fractions, st.integers(0, 2), fractions, st.sampled_from([sin, cos, lambda _: 1]), fractions,
    ),
    min_size=1,
    max_size=2,
).map(lambda terms: sympy.Add(*terms))  # fmt: skip


@quick
@given(images)
def test_any_sum_of_fractions_comes_back(image):
    assert cancel(transform(inverse(image)) - image) == 0


@quick
@given(signals)
def test_any_signal_comes_back(signal):
    assert agreement(inverse(transform(signal)), signal) != "different"


@quick
@given(signals, signals, fractions, fractions)
def test_the_transform_is_linear(one, other, c, d):
    assert cancel(transform(c * one + d * other) - c * transform(one) - d * transform(other)) == 0


@quick
@given(signals, fractions.map(abs))
def test_the_transform_of_a_late_signal(signal, delay):
    late = transform(signal.subs(t, t - delay) * Heaviside(t - delay))
    assert cancel(by_delay(late)[delay] - transform(signal)) == 0


# ------------------------------------------------------------------------------------------------ equations


MODELS = {
    "lag with a step": (Eq(3 * y(t).diff(t) + y(t), 2), [Rational(1, 2)]),
    "decimals": (Eq(y(t).diff(t), -0.3 * y(t) + 0.5), [0.1]),
    "ramp input": (Eq(y(t).diff(t) + y(t), t), [1]),
    "resonance": (Eq(y(t).diff(t, 2) + y(t), sin(t)), [0, 1]),
    "oscillator": (Eq(y(t).diff(t, 2) + y(t).diff(t) + 4 * y(t), cos(3 * t)), [1, -2]),
    "critically damped": (Eq(y(t).diff(t, 2) + 2 * y(t).diff(t) + y(t), exp(-t)), [1, 0]),
    "unstable": (Eq(y(t).diff(t, 2), y(t) + 1), [0, 1]),
    "third order": (Eq(y(t).diff(t, 3) + 6 * y(t).diff(t, 2) + 11 * y(t).diff(t) + 6 * y(t), exp(-t)), [1, 2, 3]),
    "irrational poles": (Eq(y(t).diff(t, 3) + y(t).diff(t) + y(t), sin(t)), [1, 0, -1]),
}


def left(equation, responses, times):
    """What the responses leave of an equation, which is nothing."""
    return evaluate((equation.lhs - equation.rhs).subs(responses).doit(), times)


@pytest.mark.parametrize("model", MODELS)
def test_equations_of_first_to_third_order(model):
    equation, start = MODELS[model]
    response = solve_ode(equation, {at_start(y(t), i): value for i, value in enumerate(start)})
    assert left(equation, {y(t): response}, np.linspace(0, 3, 31)) == pytest.approx(0, abs=1e-9)
    for i, value in enumerate(start):
        assert evaluate(response.diff(t, i), 0) == pytest.approx(float(value), abs=1e-12)


def test_equation_with_letters():
    response = solve_ode(Eq(T * y(t).diff(t) + y(t), K * Heaviside(t - tau)), {y(0): a})
    assert same(response, a * exp(-t / T) + K * (1 - exp(-(t - tau) / T)) * Heaviside(t - tau))


def test_coupled_equations():
    equations = [Eq(y(t).diff(t), -y(t) + x(t)), Eq(x(t).diff(t), y(t) - 3 * x(t) + sin(t))]
    responses = solve_ode(equations, {y(0): 1, x(0): 0})
    assert set(responses) == {x(t), y(t)}
    for equation in equations:
        assert left(equation, responses, np.linspace(0, 4, 21)) == pytest.approx(0, abs=1e-9)
    assert evaluate(responses[y(t)], 0) == pytest.approx(1)
    assert evaluate(responses[x(t)], 0) == pytest.approx(0)


def test_a_differential_and_an_algebraic_equation():
    responses = solve_ode([Eq(T * x(t).diff(t), -x(t) + 1), Eq(y(t), K * x(t))], {x(0): 0})
    assert same(responses[y(t)], K - K * exp(-t / T))


def test_initial_values_that_are_not_given_stay():
    velocity = at_start(y(t), 1)
    assert solve_ode(Eq(y(t).diff(t, 2), -y(t)), {y(0): 1}) == cos(t) + velocity * sin(t)


@pytest.mark.parametrize(
    ("equations", "initial", "why"),
    [
        (Eq(y(t).diff(t), y(t) ** 2), None, "cannot transform"),
        (Eq(y(t).diff(t), t * y(t)), None, "cannot transform"),
        (Eq(y(t).diff(t), u(t)), None, "expected one equation for each"),
        ([Eq(y(t).diff(t), 1), Eq(y(t), 2)], None, "expected one equation for each"),
        ([Eq(y(t), x(t)), Eq(2 * y(t), 2 * x(t))], None, "do not determine"),
        (Eq(y(t).diff(t), -y(t - 1)), None, "dead time in its denominator"),
        (y(t).diff(t) + y(t), None, r"is not an equation: expected Eq\(left side, right side\)"),
        (None, None, "is not an equation"),
        (Eq(y(t).diff(t), -y(t)), {y(t): 4}, r"y\(t\) is not an initial value here: expected y\(0\)"),
        (Eq(y(t).diff(t), -y(t)), {x(0): 4}, r"x\(0\) is not an initial value here: expected y\(0\)"),
        (Eq(y(t).diff(t), -y(t)), {at_start(y(t), 1): 4}, "is not an initial value here"),
        (Eq(y(t).diff(t), -y(t)), [4], "expected a dictionary"),
        (Eq(y(t).diff(t), -y(t)), {y(0): "4"}, "expected a number or an expression"),
    ],
)
def test_solve_ode_refuses_what_it_cannot_solve(equations, initial, why):
    with pytest.raises(ValueError, match=why):
        solve_ode(equations, initial)


# ------------------------------------------------------------------------------------------------ limits


@pytest.mark.parametrize(
    ("image", "value"),
    [
        (12 / (s * (2 * s + 1)), 12),
        (K * exp(-tau * s) / (s * (T * s + 1)), K),
        (symbols("plain") / (s * (2 * s + 1)), symbols("plain")),
        (y(0) / (s * (s + 1)), y(0)),
        (w**2 / (s * (s**2 + 2 * zeta * w * s + w**2)), 1),
        ((1 - exp(-s)) / s**2, 1),
        (1 / (s * (s**5 + 5 * s**4 + 10 * s**3 + 10 * s**2 + 5 * s + 2)), Rational(1, 2)),
        (0.1 / (s * (s + 0.3)), Rational(1, 3)),
        (5, 0),
        (0, 0),
    ],
    ids=str,
)
def test_final_value(image, value):
    assert sympy.simplify(final_value(image) - value) == 0


@pytest.mark.parametrize(
    "image",
    [
        1 / (s - 2), 1 / s**2, 1 / (s**2 + 1), 1 / (s * (s**2 + 1)), 1 / (s * (s**2 - s + 1)),
        # pairs of irrational poles exactly on the axis, where rounding would tip them to either side
        1 / (s * (s**4 + 4 * s**2 + 2)), 1 / (s * (s**3 + s**2 + s + 2)), exp(-s) / s**2, K / (s * (s - a)),
    ],
    ids=str,
)  # fmt: skip
def test_final_value_refuses_what_does_not_settle(image):
    with pytest.raises(ValueError, match="does not settle: s\\*F\\(s\\) has a pole"):
        final_value(image)


@pytest.mark.parametrize(
    "image", [1 / (s * (symbols("b") * s + 1)), 1 / (s * (s + a - k)), 1 / (s * ((s + 1) ** 3 + K))], ids=str
)
def test_final_value_refuses_what_it_cannot_decide(image):
    with pytest.raises(ValueError, match="cannot tell whether f\\(t\\) settles"):
        final_value(image)


def test_initial_value():
    assert initial_value(4 / (s + 2)) == 4
    assert initial_value((3 * s + 1) / (s * (2 * s + 1))) == Rational(3, 2)
    assert initial_value(exp(-s) / s) == 0


def test_roots():
    assert roots((s + 1) ** 2 * (s - 0.5)) == [-1, -1, Rational(1, 2)]
    assert roots(s**2 + 4) == [-2 * I, 2 * I]
    assert roots(s**2 - a) in ([-sqrt(a), sqrt(a)], [sqrt(a), -sqrt(a)])
    assert [abs(complex(root)) for root in roots(s**5 + 32)] == pytest.approx([2] * 5)
    assert roots(7) == []
    for what in (1 / s, exp(s)):
        with pytest.raises(ValueError, match="expected a polynomial in s"):
            roots(what)


@pytest.mark.parametrize("rounding", [-1e-17, 0.0, 1e-17])
def test_a_zero_is_found_where_rounding_decides_about_the_sign_at_an_end(rounding):
    assert zero_between(lambda x: rounding if x == 1 else x, 1, 2, 1e-12) == pytest.approx(1, abs=1e-11)
    assert zero_between(lambda x: rounding if x == 2 else x - 3, 1, 2, 1e-12) == pytest.approx(2, abs=1e-11)


# ------------------------------------------------------------------------------------------------ values


def test_evaluate_steps_have_their_new_value_at_once():
    assert list(evaluate(Heaviside(t - 0.3), [0.1, 0.3, 0.4])) == [0, 1, 1]
    assert list(evaluate(Heaviside(1 - t), [0.5, 1, 2])) == [1, 0, 0]
    assert list(evaluate(3, [0, 1])) == [3, 3]
    assert evaluate(t**2, [[0, 1], [2, 3]]).tolist() == [[0, 1], [4, 9]]
    assert evaluate(exp(-t), 0).shape == ()


@pytest.mark.filterwarnings("error")
def test_evaluate_leaves_out_what_comes_late():
    late = (1 - exp(5000 - 5 * t)) * Heaviside(t - 1000) + (2 - exp(2000 - t)) * Heaviside(t - 2000)
    assert evaluate(late, [0, 999, 1000, 1001, 3000]) == pytest.approx([0, 0, 0, 1 - np.exp(-5), 3])


@pytest.mark.parametrize(
    ("signal", "why"),
    [
        (K * t, "give a number for K"),
        (DiracDelta(t), "an area but no value"),
        (exp(-I * t), "its values are not real numbers"),
        (y(t), "no such function"),
        (Derivative(y(t), t), "no such function"),
        (oo * t, "it is infinite"),
        ("t", "expected a number or an expression"),
    ],
)
def test_evaluate_refuses_what_has_no_values(signal, why):
    with pytest.raises(ValueError, match=why):
        evaluate(signal, [1.0, 2.0])
