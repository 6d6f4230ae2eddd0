"""Integral criteria: each route against the others, residues with 90 digits, and results known otherwise."""

import math
import random

import control
import mpmath
import numpy as np
import pytest
import sympy

from draws import draws
from loopbook import s
from loopbook.deadtime import System, collocation
from loopbook.integrals import (
    UnstableLoopError,
    criteria,
    integral_of_square,
    ise,
    pi_first_order,
    residue_method,
)
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.stability import UndecidedError, is_closed_loop_stable
from loopbook.transfer import first_order
from loopbook.transfer import integrator as transfer_integrator
from plainmath.expressions import agreement

DELAY = sympy.exp(-s)
ROOT_TWO = sympy.sqrt(2)
MODES = ("servo", "regulator")
K, T, delay, Kp, Ti = LETTERS = sympy.symbols("K T delay Kp Ti", positive=True)
METHODS = ("residues", "response")


def loops(count, seed, closest=0.98):
    """Settings of stable PI loops of all kinds: (K, T, delay, Kp, Ti)."""
    dice = random.Random(seed)
    while count:
        lag = 10 ** dice.uniform(-2, 2)
        late = lag * 10 ** dice.uniform(-3, 3)
        other = 10 ** dice.uniform(-2, 2)
        integral = dice.choice([lag, lag * (1 + 1e-9), lag * other, (lag + late) * other])
        k = dice.choice([1.0, 1 + 1e-9, 1 - 1e-12, 10 ** dice.uniform(-3, 3), 10 ** dice.uniform(-1, 0)])
        gain = 10 ** dice.uniform(-1, 1)
        settings = (gain, lag, late, k / gain, integral)
        _, phase = crossover(*settings)
        if phase < closest * math.pi:
            count -= 1
            yield settings


def crossover(K, T, delay, Kp, Ti):
    """Where abs(L) = 1, and the phase lag there."""
    k = K * Kp
    omega = math.sqrt(((k**2 - 1) * Ti + math.hypot((k**2 - 1) * Ti, 2 * k * T)) / (2 * Ti * T**2))
    if omega == 0 or k < 1:  # without cancellation
        omega = math.sqrt(2 * k**2 / (Ti * ((1 - k**2) * Ti + math.hypot((k**2 - 1) * Ti, 2 * k * T))))
    return omega, omega * delay + math.atan(omega * T) + math.atan2(1, omega * Ti)


def pieces(mode, K, T, delay, Kp, Ti):
    """A, B, C, D of the PI loop as functions of complex numbers."""
    k = K * Kp
    A, C = (lambda p: Ti * p * (1 + T * p)), (lambda p: k * (1 + Ti * p))
    B = (lambda p: Ti * (1 + T * p)) if mode == "servo" else (lambda p: 0 * p)
    D = (lambda p: 0 * p) if mode == "servo" else (lambda p: -K * Ti + 0 * p)
    return A, B, C, D


# ------------------------------------------------------------------------------------------------ the closed form


def by_residues(mode, settings):
    """Minus the sum of the four residues of E G, as the paper has it, with many digits."""
    K, T, delay, Kp, Ti = (mpmath.mpf(x) for x in settings)
    if Ti == T:  # where A and C have a common zero the sum is defined as a limit only
        Ti *= 1 + mpmath.mpf(10) ** -30
    A, B, C, D = pieces(mode, K, T, delay, Kp, Ti)
    a, b, c = T**2 * Ti**2, Ti**2 * ((K * Kp) ** 2 - 1), -((K * Kp) ** 2)
    total = mpmath.mpf(0)
    for sign in (1, -1):
        root = mpmath.sqrt(mpmath.mpc((-b + sign * mpmath.sqrt(b**2 - 4 * a * c)) / (2 * a)))
        for p in (root, -root):
            z = mpmath.exp(-delay * p)
            E = (B(p) + D(p) * z) / (A(p) + C(p) * z)
            total -= E * (A(p) * B(-p) - C(p) * D(-p)) / (4 * a * p**3 + 2 * b * p)
    return total.real


@pytest.mark.parametrize("mode", MODES)
def test_the_closed_form_is_the_sum_of_residues_in_all_corners(mode):
    """Delays from 1e-3 to 1e3 lags, k at 1 or beside it, Ti equal to T or beside it."""
    settings = list(loops(draws(3000), seed=2, closest=0.999))
    together = pi_first_order(*np.array(settings).T, mode=mode)
    with mpmath.workdps(90):
        for one, value in zip(settings, together, strict=True):
            exact = by_residues(mode, one)
            assert abs(value / exact - 1) < 1e-12, one
            assert abs(pi_first_order(*one, mode=mode) / exact - 1) < 1e-12, one


@pytest.mark.parametrize("mode", MODES)
def test_without_dead_time_it_is_the_known_formula(mode):
    """A lag under PI control: E = (T s + 1)/(T s^2 + (1 + k) s + k/Ti), or K over that, of second order."""
    for gain, lag, _, controller, integral in loops(20, seed=3):
        k = gain * controller
        c0, c1, c2 = k / integral, 1 + k, lag
        b0, b1 = (1, lag) if mode == "servo" else (gain, 0)
        known = (b1**2 * c0 + b0**2 * c2) / (2 * c0 * c1 * c2)
        for late in (0, 1e-15 * lag / (1 + k)):
            assert pi_first_order(gain, lag, late, controller, integral, mode) == pytest.approx(known, rel=1e-12)


def test_stability_is_that_of_the_loop():
    dice = random.Random(4)
    judged = []
    for _ in range(60):
        settings = [sympy.Rational(round(100 * 10 ** dice.uniform(-0.5, 0.7)), 100) for _ in range(5)]
        gain, lag, late, controller, integral = settings
        value = pi_first_order(*map(float, settings), unstable=math.inf)
        judged.append(
            is_closed_loop_stable(Loop(first_order(gain, lag, late), PID(controller, integral)).open_fraction)
        )
        assert judged[-1] == (value < math.inf), settings
    assert 10 < sum(judged) < 50


def test_arrays_are_broadcast_and_settings_that_are_not_stable_are_named():
    gains, times = np.array([[0.1], [0.5], [9.0]]), np.array([0.5, 1, 2, 4])
    values = pi_first_order(1, 1, 0.5, gains, times, unstable=math.inf)
    assert values.shape == (3, 4)
    assert np.isinf(values[2]).all()
    assert values[1, 2] == pytest.approx(pi_first_order(1, 1, 0.5, 0.5, 2), rel=1e-14)
    assert np.isnan(pi_first_order(1, 1, 1, 9, 1, unstable=math.nan))
    assert pi_first_order(*map(sympy.Integer, (1, 1, 0, 1, 1))) == pi_first_order(1, 1, 0, 1, 1) == pytest.approx(0.5)
    with pytest.raises(UnstableLoopError, match=r"not stable for K = 1, T = 1, delay = 0\.5, Kp = 9, Ti = 0\.5"):
        pi_first_order(1, 1, 0.5, gains, times)
    for controller in (9, -1, 0, -0.1):
        with pytest.raises(UnstableLoopError, match=f"Kp = {controller}"):
            pi_first_order(1, 1, 0.5, controller, 1)
    assert pi_first_order(-1, 1, 0.5, -1, 1) == pi_first_order(1, 1, 0.5, 1, 1)


@pytest.mark.parametrize(
    "settings", [(1, 0, 1, 1, 1), (1, 1, -1, 1, 1), (1, 1, 1, 1, 0), (1, 1, 1, 1, math.inf), (math.nan, 1, 1, 1, 1)]
)
def test_settings_that_are_none(settings):
    for given in (settings, np.array(settings)[:, None]):
        with pytest.raises(ValueError, match="expected finite numbers"):
            pi_first_order(*given, unstable=math.inf)
    with pytest.raises(ValueError, match="'load'"):
        pi_first_order(1, 1, 1, 0.1, 1, mode="load")


@pytest.mark.parametrize("value", [True, "1", 1j, np.array([1 + 1j]), sympy.Symbol("K"), [[1], [1, 2]]])
def test_settings_that_are_no_numbers(value):
    for name in ("K", "T", "delay", "Kp", "Ti"):
        with pytest.raises(ValueError, match=f"{name} is .*: expected a number, or an array"):
            pi_first_order(**({"K": 1, "T": 1, "delay": 1, "Kp": 0.1, "Ti": 1} | {name: value}))


def test_settings_whose_shapes_do_not_fit():
    with pytest.raises(ValueError, match=r"shapes of the settings are K \(2,\), T \(3,\)"):
        pi_first_order([1, 2], [1, 2, 3], 1, 0.1, 1)


# ------------------------------------------------------------------------------------------------ letters


@pytest.mark.parametrize("mode", MODES)
def test_the_formula_in_letters_is_the_closed_form(mode):
    process, controller = K * sympy.exp(-delay * s) / (T * s + 1), Kp * (1 + 1 / (Ti * s))
    formula = residue_method((1 if mode == "servo" else -process) / (1 + controller * process) / s).expr
    assert formula.free_symbols == set(LETTERS)
    assert {f.func for f in formula.atoms(sympy.Function)} == {sympy.exp, sympy.sin, sympy.cos}
    assert not formula.has(sympy.I, sympy.RootSum)
    value = sympy.lambdify(LETTERS, formula, "mpmath")
    with mpmath.workdps(60):
        for settings in loops(draws(100), seed=5):
            assert abs(value(*map(mpmath.mpf, settings)) / pi_first_order(*settings, mode=mode) - 1) < 1e-12


def test_the_steps_of_the_paper():
    method = residue_method(1 / (1 + Kp * (1 + 1 / (Ti * s)) * K * sympy.exp(-delay * s) / (T * s + 1)) / s)
    k = K * Kp
    assert sympy.expand(method.Delta - (T**2 * Ti**2 * s**4 + Ti**2 * (k**2 - 1) * s**2 - k**2)) == 0
    # equation (3), where the paper prints Ti s (1 - T^2 s^3)
    assert sympy.simplify(method.G * method.Delta - Ti**2 * s * (1 - T**2 * s**2)) == 0
    assert sympy.simplify(method.integrand - method.E * method.G) == 0
    for p in method.poles:
        assert sympy.simplify(sympy.expand(method.Delta.subs(s, p))) == 0
    formula, zeros = method.formula
    assert {str(letter) for letter in zeros} == {"sigma", "omega"}
    assert formula.subs(zeros) == method.expr


def test_E_mirrored_is_rational_at_the_poles():
    """At a pole of E(s), found by iteration, G(s) is E(-s)."""
    numbers = {K: 1, T: 1, delay: sympy.Rational(1, 2), Kp: 1, Ti: sympy.Rational(3, 2)}
    L = Kp * (1 + 1 / (Ti * s)) * K * sympy.exp(-delay * s) / (T * s + 1)
    method = residue_method((1 / (1 + L) / s).subs(numbers))
    below = sympy.lambdify(s, sympy.denom(sympy.together(method.E)), "mpmath")
    E, G = (sympy.lambdify(s, part, "mpmath") for part in (method.E, method.G))
    for start in (-0.7 + 0.7j, -3 + 9j, -5 + 22j):
        pole = mpmath.findroot(below, start)
        assert abs(E(-pole) / G(pole) - 1) < 1e-10


def test_an_integrator_with_dead_time_in_letters():
    k = sympy.Symbol("k", positive=True)
    method = residue_method(1 / (s + k * sympy.exp(-delay * s)))
    assert agreement(method.expr, sympy.cos(k * delay) / (2 * k * (1 - sympy.sin(k * delay)))) != "different"


def test_letters_that_leave_the_zeros_open():
    a = sympy.Symbol("a", positive=True)
    E = (2 - DELAY / 3) / (s + 1 + a * DELAY)
    formula = residue_method(E).expr
    for number in (sympy.Rational(1, 2), sympy.Rational(5, 4)):  # real zeros of Delta, or imaginary ones
        value = complex(formula.subs(a, number).evalf(30))
        assert value == pytest.approx(integral_of_square(E.subs(a, number), "response"), rel=1e-11)


def test_complex_zeros_of_A_alone():
    """Where C is zero, A is zero at one zero of each pair, and no residue can be taken there."""
    a = sympy.Symbol("a", positive=True)
    E = (-(23 * s + 7) / 10 + (5 * s - 3) / 2 * DELAY) / (s**2 + a * s + sympy.Rational(11, 10))
    for number in (sympy.Rational(2, 5), sympy.Rational(5, 2)):
        known = integral_of_square(E.subs(a, number), "response")
        for formula in (residue_method(E).expr.subs(a, number), residue_method(E.subs(a, number)).expr):
            assert complex(formula.evalf(30)) == pytest.approx(known, rel=1e-11)


@pytest.mark.parametrize(("Kp", "Ti"), [(4, 1), (2, 2), (1, 4)])
def test_zeros_that_coincide_exactly(Kp, Ti):
    """A critically damped loop around an integrator: the error is (1 - Kp t/2) exp(-Kp t/2)."""
    assert ise(transfer_integrator(1), PID(Kp, Ti)) == pytest.approx(1 / (2 * Kp), rel=1e-9)


def test_what_the_residue_method_is_not_for():
    with pytest.raises(ValueError, match="dead times 1, 2: expected one"):
        residue_method(1 / (s + DELAY + DELAY**2))
    with pytest.raises(ValueError, match="repeated zero"):
        residue_method(1 / (s + 1) ** 2).expr  # noqa: B018
    with pytest.raises(ValueError, match="not known in radicals"):
        residue_method(1 / (s**3 + 2 * s**2 + 3 * s + 2 + DELAY)).expr  # noqa: B018


# ------------------------------------------------------------------------------------------------ any loop


def smith(controller, model, late):
    """The controller with a Smith predictor for a model with the given dead time."""
    return controller / (1 + controller * model * (1 - sympy.exp(-late * s)))


def random_errors(count, seed):
    """Errors of stable loops: PID with filter, or a Smith predictor whose dead time is wrong."""
    dice = random.Random(seed)

    def number(low, high):
        return sympy.Rational(round(10 * 10 ** dice.uniform(low, high)), 10)

    while count:
        model = sympy.S.One
        for _ in range(dice.choice([1, 2])):
            model /= number(-0.3, 0.7) * s + 1
        late, integral = number(-0.3, 0.5), number(0, 1)
        derivative = dice.choice([0, integral / 5])
        controller = PID(number(-1, 0), integral, derivative, derivative / 5).expr
        if dice.random() < 0.5:
            wrong = dice.choice([sympy.Rational(1, 2), 1, sympy.Rational(3, 2), 2])
            controller = smith(controller, model, wrong * late)
        loop = Loop(model * sympy.exp(-late * s), controller)
        if is_closed_loop_stable(loop.open_fraction):
            count -= 1
            yield System(loop.error(dice.choice(MODES)))


def by_frequencies(E, peak=1.0, end=2000.0):
    """Parseval's integral by Gauss' rule, on intervals that become short about zero and a peak, and what is beyond."""
    E = System(E)
    near = np.geomspace(1e-9, 0.5, 60)
    edges = np.unique(np.r_[np.linspace(0, end, int(end) + 1), near, peak * (1 - near), peak * (1 + near)])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    inside = (abs(E.frequency(edges[:-1, None] + half * (nodes + 1))) ** 2 * weights * half).sum()
    jump = abs(1e9 * E.frequency(1e9))  # with which the error begins
    return (inside + jump**2 / end) / math.pi


def test_both_methods_agree_on_random_loops():
    count = draws(120)
    several = 0
    for E in random_errors(count, seed=6):
        known = integral_of_square(E, "response")
        try:
            assert integral_of_square(E, "residues") == pytest.approx(known, rel=1e-11), E
        except ValueError as reason:
            assert "dead times" in str(reason)  # noqa: PT017
            several += 1
            if several <= draws(4):
                assert by_frequencies(E) == pytest.approx(known, rel=1e-7)
    assert count / 6 < several < 2 * count / 3


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    "settings", ["2 0.7 1.4 0.35 1.2", "2 0.7 1.4 0.3 0.7", "1 1 1000 0.3 400", "1 50 1 20 4", "1 1 0 2 1"]
)
@pytest.mark.daily(4)
def test_both_methods_find_the_closed_form(mode, settings):
    """Among them Ti = T, a delay of 1000 lags, and none."""
    exact = [sympy.Rational(x) for x in settings.split()]
    gain, lag, late, controller, integral = exact
    E = Loop(first_order(gain, lag, late), PID(controller, integral)).error(mode)
    for method in METHODS:
        value = pi_first_order(*map(float, exact), mode=mode)
        assert integral_of_square(E, method) == pytest.approx(value, rel=1e-10), method


@pytest.mark.parametrize("k", [0.1, 1, 1.5])
def test_an_integrator_with_dead_time_under_proportional_control(k):
    known = math.cos(k) / (2 * k * (1 - math.sin(k)))
    for method in METHODS:
        assert integral_of_square(1 / (s + sympy.Rational(str(k)) * DELAY), method) == pytest.approx(known, rel=1e-9)


def test_a_perfect_smith_predictor_waits_and_then_follows_like_a_lag():
    """With Ti = T the error is 1 during the dead time and then falls with the time constant T/k."""
    model, late = first_order(2, sympy.Rational(7, 10)), sympy.Rational(7, 5)
    for gain in (sympy.Rational(1, 2), 3):
        controller = smith(PID(gain, sympy.Rational(7, 10)).expr, model, late)
        known = 1.4 + 0.7 / (2 * 2 * float(gain))
        assert ise(model * sympy.exp(-late * s), controller) == pytest.approx(known, rel=1e-10)


@pytest.mark.parametrize(
    ("E", "known"),
    [
        (1 / (s + 1) ** 5, math.comb(8, 4) / 2**9),  # t^4/4! exp(-t)
        (1 / (s**2 + s / 1000 + 1), 500),
        ((1 - DELAY) / s, 1),
        ((1 - DELAY) ** 2 / s**2, sympy.Rational(2, 3)),
        (DELAY**3 * (1 - DELAY) ** 2 / s**2, sympy.Rational(2, 3)),
        ((1 - DELAY) / (s * (s + 1)), math.exp(-1)),  # 1 - exp(-t), from t = 1 falling
        ((1 + s) / (s**2 + 3 * s + 2), sympy.Rational(1, 4)),
        (sympy.S.Zero, 0),
    ],
)
def test_errors_whose_integral_is_known(E, known):
    """Repeated poles, light damping, and poles at zero that only dead times cancel."""
    for method in (None, "response"):
        assert integral_of_square(E, method) == pytest.approx(float(known), rel=1e-10), method


def test_common_stable_factors_and_equal_lags_do_no_harm():
    one, other = 1 / (s + DELAY / 2), (s + 2) / ((s + 2) * (s + DELAY / 2) + sympy.Rational(1, 10**9))
    for method in (None, "response"):
        assert integral_of_square(one, method) == pytest.approx(integral_of_square(other, method), rel=1e-7)
    triple = 1 / ((s + 1) ** 3 + DELAY / 2)
    assert integral_of_square(triple) == pytest.approx(by_frequencies(triple), rel=1e-9)


def test_a_neutral_system():
    for c in (sympy.Rational(1, 2), -sympy.Rational(4, 5)):
        E = 1 / (s + 1 + c * s * DELAY)
        assert integral_of_square(E) == pytest.approx(integral_of_square(E, "response"), rel=1e-10)


def test_dead_times_that_are_no_multiples_of_one():
    controller = smith(PID(sympy.Rational(1, 2), 1).expr, first_order(1, 2), sympy.Rational(7, 5))
    E = Loop(first_order(1, 2, sympy.sqrt(2)), controller).error("servo")
    assert integral_of_square(E) == pytest.approx(by_frequencies(E), rel=1e-8)
    with pytest.raises(ValueError, match="residues: there are different dead times"):
        integral_of_square(E, "residues")


def test_a_narrow_resonance_is_not_stepped_over():
    """A lightly damped mode of small amplitude beside a slow one: sum of two exponentials, integrated by hand."""
    damping = sympy.Rational(1, 10**5)
    E = 1 / (s + 1) + damping / ((s + damping) ** 2 + 100) * 10
    # exp(-t) + damping exp(-damping t) sin(10 t)
    a = float(damping)
    known = 0.5 + 2 * a * 10 / ((1 + a) ** 2 + 100) + a**2 * (1 / (4 * a) - a / (4 * (a**2 + 100)))
    for method in (None, "response"):
        assert integral_of_square(E, method) == pytest.approx(known, rel=1e-10)


@pytest.mark.parametrize(
    ("process", "settings", "known"),
    [
        (
            sympy.exp(-s / 10) / ((2.41 * s + 1) * (4.86 * s + 1) * (26.38 * s + 1)),
            "40780104236223397/100000000000000000 19/10",
            15707019.311864685,
        ),
        ((1 - 0.9 * s) / (58.26 * s + 1), "999999/1250000 2/5", 29744504.573322408),
    ],
)
def test_near_the_limit_residues_decline_or_are_right(process, settings, known):
    """Against the residues with 120 digits."""
    controller = PID(*map(sympy.Rational, settings.split()))
    for method in (None, *METHODS):
        try:
            assert ise(process, controller, method=method) == pytest.approx(known, rel=2e-10), method
        except ValueError as reason:
            assert method == "residues"
            assert "lose too many digits" in str(reason)  # noqa: PT017


def test_it_says_why_every_method_declines(monkeypatch):
    """An infinite row of poles comes near to the axis."""
    monkeypatch.setattr(collocation, "MOST_SECONDS", 0.1)
    E = 1 / (s + 1 + s * DELAY / 2 + sympy.Rational(4999, 10_000) * s * sympy.exp(-ROOT_TWO * s))
    with pytest.raises(ValueError, match=r"residues: there are different dead times; response: the response"):
        integral_of_square(E)


@pytest.mark.parametrize("n", [25, 40])
def test_a_high_order(n):
    loop = Loop(DELAY / (s + 1) ** n, PID(sympy.Rational(1, 5), Ti=20))

    def density(x):  # |E|^2 over half a circle, w = tan(x/2)
        p = 1j * np.tan(x / 2)
        L = np.exp(-p) / (p + 1) ** n * (1 + 20 * p) / 100  # times p
        return abs(1 / (p + L)) ** 2 / np.cos(x / 2) ** 2 / (2 * math.pi)

    middles = math.pi * (np.arange(2000) + 0.5) / 2000
    assert ise(loop) == pytest.approx(math.pi * density(middles).mean(), rel=1e-10)


# ------------------------------------------------------------------------------------------------ no integral


def test_what_has_no_integral():
    for E in (1 / (s + 2 * DELAY), 1 / (s - 1), (s + 1) / (s**3 + DELAY), 1 / (s + 2 * DELAY + DELAY**2 / 5)):
        with pytest.raises(UnstableLoopError, match="right half-plane"):
            integral_of_square(E)
    with pytest.raises(UnstableLoopError, match="imaginary axis"):
        integral_of_square(1 / (s**2 + 1))
    with pytest.raises(UndecidedError, match=r"not decided between the frequencies 1\.5707"):  # 30 digits of pi
        integral_of_square(1 / (s + sympy.pi / 2 * DELAY))
    for E in (1 / s, (1 - DELAY) / s**2, (s + 2) / (s * (s + 1))):
        with pytest.raises(ValueError, match="does not vanish"):
            integral_of_square(E)
    with pytest.raises(ValueError, match="impulse"):
        integral_of_square(s / (s + 1))
    with pytest.raises(ValueError, match="a number for K"):
        integral_of_square(K / (s + 1))


def test_loops_and_what_is_none():
    process, controller = first_order(1, 1, 0.5), PID(1, 1)
    assert ise(process, controller) == ise(Loop(process, controller)) == ise(process, controller.expr)
    for mode in MODES:
        known = pi_first_order(1, 1, 0.5, 1, 1, mode)
        assert ise(process, controller, mode) == pytest.approx(known, rel=1e-14)
    weighted = 1 / s + sympy.Rational(1, 2)
    by_response = ise(process, controller, from_setpoint=weighted, method="response")
    assert ise(process, controller, from_setpoint=weighted) == pytest.approx(by_response, rel=1e-11)
    for wrong in (
        lambda: ise(process),
        lambda: ise(Loop(process, controller), controller),
        lambda: ise(process, controller, "load"),
        lambda: ise(process, controller, method="simulation"),
        lambda: criteria(process),
    ):
        with pytest.raises(ValueError, match="expected"):
            wrong()
    with pytest.raises(UnstableLoopError):
        ise(process, PID(9, 1))
    with pytest.raises(UnstableLoopError):
        criteria(process, PID(9, 1))
    with pytest.raises(ValueError, match="does not vanish"):
        ise(process, PID(1))
    for method in (["residues"], 1):
        with pytest.raises(ValueError, match="method is"):
            ise(process, controller, method=method)
    assert integral_of_square(control.tf([1], [1, 1])) == pytest.approx(0.5)
    for tolerance in (0, -1, math.nan, "small", None, 1):
        with pytest.raises(ValueError, match="tolerance is"):
            criteria(process, controller, tolerance=tolerance)


# ------------------------------------------------------------------------------------------------ four criteria


def test_criteria_of_an_exponential():
    found = criteria(1 / s, 2)  # e = exp(-2 t)
    assert found == pytest.approx((1 / 4, 1 / 2, 1 / 4, 1 / 16), rel=1e-9)


def test_criteria_of_an_oscillation():
    """Against Gauss' rule from one zero of the error to the next."""
    found = criteria(1 / (s * (s + sympy.Rational(2, 5))), 1)
    omega = math.sqrt(0.96)
    ends = [0, *((math.pi - math.atan(5 * omega) + n * math.pi) / omega for n in range(60))]
    nodes, weights = np.polynomial.legendre.leggauss(20)
    halves = np.diff(ends)[:, None] / 2
    x, dx = ends[:-1] + halves.T * (nodes[:, None] + 1), halves.T * weights[:, None]
    e = np.exp(-x / 5) * (np.cos(omega * x) + np.sin(omega * x) / (5 * omega))
    known = [(f * dx).sum() for f in (e**2, abs(e), x * abs(e), x * e**2)]
    assert found == pytest.approx(known, rel=2e-9)


def test_criteria_with_dead_time():
    """The integral of the squared error is that of the closed form, and an error of one sign has its integral Ti/k."""
    process, controller = first_order(1, 1, 0.5), PID(0.4, 1)
    found = criteria(process, controller)
    assert math.isclose(found.ISE, pi_first_order(1, 1, 0.5, 0.4, 1), rel_tol=1e-8)
    slow = criteria(process, PID(0.3, 1.5))
    assert math.isclose(slow.IAE, 1.5 / 0.3, rel_tol=1e-8)
    times = np.linspace(0, 60, 600_001)
    e = 1 - Loop(process, controller).servo.step(times)
    sums = [np.trapezoid(f, times) for f in (e**2, abs(e), times * abs(e), times * e**2)]
    assert found == pytest.approx(sums, rel=1e-5)
