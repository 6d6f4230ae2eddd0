"""From the desired loop to the controller: direct synthesis, PID settings read off, and the table of IMC settings."""

import functools

import control
import mpmath
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from sympy import Rational, exp, oo, pi, sqrt, symbols

from draws import draws
from loopbook import s
from loopbook.approximation import SOPDT, pade, taylor
from loopbook.deadtime import System
from loopbook.pid import PID
from loopbook.stability import is_closed_loop_stable
from loopbook.synthesis import IMC_TABLE, Match, as_pid, direct_synthesis, imc, imc_design
from loopbook.transfer import feedback, first_order, integrator, integrator_with_lag, poles, second_order
from plainmath.expressions import agreement

K, T, T1, T2, T3, zeta, delay, beta, Tc = symbols("K T T1 T2 T3 zeta delay beta Tc", positive=True)
x, plain = symbols("x", real=True), symbols("plain")

TIMES = st.fractions(Rational(1, 10), 20, max_denominator=10).map(Rational)
DELAYS = st.fractions(0, 10, max_denominator=4).map(Rational)
GAINS = st.fractions(-20, 20, max_denominator=10).filter(bool).map(Rational)


def equal(one, other):
    return one == other or agreement(one, other) == "proved"


def triple(pid):
    return pid.Kp, pid.Ti, pid.Td


# ------------------------------------------------------------------------------------------------ direct synthesis


def test_the_controllers_of_the_slides():
    """Seborg et al.: (12-5), (12-6) and the two after (12-30)."""
    assert direct_synthesis(K / (T * s + 1), 1 / (Tc * s + 1)) == (T * s + 1) / (K * Tc * s)
    ideal = direct_synthesis(first_order(K, T, delay), exp(-delay * s) / (Tc * s + 1))
    assert equal(ideal, (T * s + 1) / (K * (Tc * s + 1 - exp(-delay * s))))
    by_pade = direct_synthesis(pade(first_order(K, T, delay)), (1 - delay * s / 2) / (Tc * s + 1))
    assert equal(by_pade, (T * s + 1) * (1 + delay * s / 2) / (K * (delay / 2 + Tc) * s))


# Processes whose loop can respond like a lag after their dead time, and how the wish must be shaped for that.
LAGS = st.lists(TIMES, min_size=1, max_size=3)


@settings(deadline=None, max_examples=draws(15))
@given(GAINS, LAGS, TIMES, DELAYS, DELAYS, st.booleans())
def test_the_loop_with_the_controller_is_the_desired_one(gain, lags, slow, late, later, inverse):
    zero = 1 - lags[0] * s if inverse else 1 + lags[0] * s / 3
    process = gain * zero * exp(-late * s) / sympy.prod([T * s + 1 for T in lags])
    desired = (zero if inverse else 1) * exp(-(late + later) * s) / (slow * s + 1) ** len(lags)
    loop = feedback(direct_synthesis(process, desired) * process)
    for place in (0.3, 0.2 + 0.7j, 2j):
        with mpmath.workdps(30):
            values = [complex(sympy.N(H.subs(s, sympy.sympify(place)), 30)) for H in (loop, desired)]
        assert values[0] == pytest.approx(values[1], rel=1e-12)


@settings(deadline=None, max_examples=draws(30))
@given(GAINS, TIMES, TIMES)
def test_an_unstable_process_is_stabilised(gain, lag, slow):
    """The wish is 1 at the unstable pole, so that nothing unstable is cancelled."""
    lead = symbols("lead")
    desired = (lead * s + 1) / (slow * s + 1) ** 2
    (found,) = sympy.solve(desired.subs(s, 1 / lag) - 1, lead)
    process = gain / (lag * s - 1)
    controller = direct_synthesis(process, desired.subs(lead, found))
    assert sympy.cancel(feedback(controller * process) - desired.subs(lead, found)) == 0
    assert is_closed_loop_stable(sympy.cancel(controller) * process)


def test_whatever_stands_for_a_block_is_read():
    blocks = (
        (control.tf([1], [1, 1]), control.tf([1], [0.5, 1])),
        (control.tf2ss(control.tf([1], [1, 1])), 1 / (0.5 * s + 1)),
        (SOPDT(1, 1), System(1 / (0.5 * s + 1))),
        (10 / (10.0 * s + 10), 0.2 / (0.1 * s + 0.2)),
    )
    assert all(equal(direct_synthesis(*pair), 2 * (s + 1) / s) for pair in blocks)


def test_decimal_dead_times_cancel():
    controller = direct_synthesis(exp(-0.3 * s) / (s + 1), exp(-(0.1 + 0.2) * s) / (2 * s + 1))
    assert equal(controller, (s + 1) / (2 * s + 1 - exp(-3 * s / 10)))


def test_a_finite_impulse_response_may_be_wanted():
    """(1 - exp(-s))/s is 1 at s = 0 and has no pole there."""
    desired = (1 - exp(-s)) / s
    controller = direct_synthesis(1 / (s + 1), desired)
    assert equal(controller, (s + 1) * desired / (1 - desired))


@pytest.mark.parametrize(
    "process", [(exp(-s) + exp(-2 * s) / 2) / (s + 1), (2 - exp(-s)) * exp(-s) / (3 * s + 1)]
)  # several dead times: which zeros they have is not known, and not refused
def test_a_process_with_several_dead_times(process):
    desired = exp(-s) / (s + 1)
    loop = feedback(direct_synthesis(process, desired) * process)
    assert complex(loop.subs(s, 0.3 + 1j)) == pytest.approx(complex(desired.subs(s, 0.3 + 1j)), rel=1e-12)


@pytest.mark.parametrize(
    ("process", "desired"),
    [
        (K * exp(-delay * s) / (T * s + 1), exp(-2 * delay * s) / (Tc * s + 1)),  # later than needed
        (K * exp(-delay * s) / (T * s + 1), exp(-symbols("phi", positive=True) * s) / (Tc * s + 1)),  # left open
        (K * (1 - plain * s) / (T * s + 1), 1 / (Tc * s + 1)),  # the side of the zero is left open
        (K / s, 1 / (Tc * s + 1)),
        (exp(-s) / s, exp(-s) / (s + 1)),
    ],
)
def test_what_can_be_or_is_left_open_is_not_refused(process, desired):
    wrong = direct_synthesis(process, desired) * process * (1 - desired) - desired
    point = {symbol: Rational(k + 3, 7) for k, symbol in enumerate(sorted(wrong.free_symbols, key=str))}
    assert abs(complex(wrong.subs(point))) < 1e-12


@pytest.mark.parametrize(
    ("process", "desired", "message"),
    [
        (exp(-2 * s) / (s + 1), exp(-s) / (s + 1), "comes before the process"),
        (K * exp(-delay * s), 1 / (Tc * s + 1), "expected at least the dead time"),
        ((1 - s) / (s + 1) ** 2, 1 / (s + 1), "has a zero at 1: expected a desired response with that zero"),
        ((1 - s) ** 2 / (s + 1) ** 3, (1 - s) / (s + 1) ** 2, "has a zero at 1"),
        (K * (1 - T3 * s) / (T * s + 1), 1 / (Tc * s + 1), "has a zero at 1/T3"),
        (s / (s + 1) ** 2, 1 / (s + 1), "has a zero at 0"),
        ((s**2 + 1) / (s + 1) ** 3, 1 / (s + 1), "has a zero at -I"),
        (1 / (s - 1), 1 / (s + 1), "has a pole at 1: expected a desired response that is 1 there"),
        (1 / (s - 1) ** 2, (3 * s + 1) / (s + 1) ** 2, "flat up to its derivative 1"),
        (K / (T * s - 1), 1 / (Tc * s + 1), "has a pole at 1/T"),
        (K / s**2, 1 / (Tc * s + 1), "has a pole at 0"),
        (1 / s, 1 / (2 * s + 2), "has a pole at 0: expected a desired response that is 1 there"),
        (1 / (s**2 + 1), 1 / (s + 1), "has a pole at -I"),
        (1 / (s**3 - 3 * s**2 - 7), 1 / (s + 1), "has a pole at 3.5"),
        (1 / (s + 1), 1 / (1 - s), "has a pole at 1: expected a stable one"),
        (1 / (s + 1), 1 / s, "has a pole at 0: expected a stable one"),
        (1 / (s + 1), s + 1, "has more zeros than poles"),
        (1 / s, 1, "lags behind the setpoint"),
        (0, 1 / (s + 1), "the model is 0"),
        (1 / sqrt(s), 1 / (s + 1), "not a rational function"),
        (1 / (s + 1), 1 / (s + exp(-s)), "dead time in its denominator"),
        (exp(s) / (s + 1), 1 / (s + 1), "a dead time cannot be negative"),
        ("1/s", 1 / (s + 1), "of type str"),
    ],
)
def test_what_no_controller_can_do(process, desired, message):
    with pytest.raises(ValueError, match=message):
        direct_synthesis(process, desired)


def test_a_pole_that_only_numbers_know():
    """The roots of an irreducible cubic are known to 15 digits only; the wish that keeps them is not refused."""
    cubic = s**3 - s - 1  # one root in the right half-plane
    desired = 1 - cubic * s * (s + 9) / (s + 2) ** 5
    controller = direct_synthesis(1 / cubic, desired)
    assert sympy.cancel(feedback(controller / cubic) - desired) == 0


# ------------------------------------------------------------------------------------------------ PID settings


@pytest.mark.parametrize(
    ("controller", "pid"),
    [
        (2, PID(2)),
        (2 + 3 * s, PID(2, Td=1.5)),
        ((2 * s + 1) / (4 * s), PID(0.5, Ti=2)),
        (-(2 * s + 1) / (4 * s), PID(-0.5, Ti=2)),
        ((2 * s + 1) * (5 * s + 1) / (4 * s), PID(1.75, 7, Rational(10, 7))),
        ((2 * s + 1) / (s + 1), PID(1, Td=1, Tf=1)),
        ((s + 1) / (2 * s + 1), PID(1, Td=1, Tf=2, form="serial")),
        (3 / (s + 1), PID(3, Tf=1, form="serial")),
        ((2 * s + 1) / (s * (s + 1)), PID(2, 2, Tf=1, form="serial")),
        ((s + 1) * (2 * s + 1) / (s * (5 * s + 1)), PID(2, 2, 1, 5, form="serial")),
        ((s + 1) * (s + 2) / (s * (s + 1)), PID(1, 0.5)),
        (s * (s + 1) / s**2, PID(1, 1)),
        (exp(-s) * exp(s) * (s + 1) / s, PID(1, 1)),
        (sqrt(2) * (pi * s + 1) / s, PID(sqrt(2) * pi, pi)),
        (1 / (1 / (1 + 1 / s)), PID(1, 1)),
        (K * (T1 * s + 1) / s, PID(K * T1, T1)),
        (control.tf([6, 5, 1], [1, 0]), PID(5, 5, 1.2)),
        (control.tf2ss(control.tf([6, 5, 1], [1, 0.1, 0])), PID(30, 3, 2, 10, form="serial")),
    ],
)
def test_exact_settings(controller, pid):
    match = as_pid(controller)
    assert (match.settings, match.exact, match.rest) == (pid, True, 0)


@settings(deadline=None)
@given(GAINS, TIMES, DELAYS, DELAYS, st.sampled_from(["parallel", "serial"]))
def test_any_pid_controller_is_read_back(Kp, Ti, Td, Tf, form):
    pid = PID(Kp, Ti, Td, Tf, form)
    match = as_pid(sympy.expand(sympy.together(pid.expr)))
    assert (match.exact, match.rest) == (True, 0)
    assert sympy.cancel(match.settings.expr - pid.expr) == 0


@settings(deadline=None, max_examples=draws(40))
@given(GAINS, TIMES, TIMES, TIMES, TIMES)
def test_serial_and_parallel_settings_are_one_controller(Kp, T1, T2, Tf, lag):
    serial = as_pid(Kp * (T1 * s + 1) * (T2 * s + 1) / (s * (Tf * s + 1)))
    assert serial.exact
    if serial.settings.form == "parallel":
        assert sympy.cancel(serial.settings.serial().expr - serial.settings.expr) == 0
    else:  # only where there is no parallel one
        with pytest.raises(ValueError, match="no parallel form"):
            serial.settings.parallel()


# The series. Another route: Taylor coefficients by numerical differentiation, of a function that knows no SymPy.

SERIES = {
    "Smith predictor": ((2 * s + 1) / (s + 1 - exp(-s)), lambda z: (2 * z + 1) / (z + 1 - mpmath.exp(-z))),
    "predictor": ((4 * s + 1) / (3 * (2 * s + 1 - exp(-s))), lambda z: (4 * z + 1) / 3 / (2 * z + 1 - mpmath.exp(-z))),
    "two delays": (
        (9 * s + 1) / (s * (2 + exp(-s / 3) * exp(-s / 2))),
        lambda z: (9 * z + 1) / z / (2 + mpmath.exp(-5 * z / 6)),
    ),
    "late": (exp(-s / 5) * (9 * s + 1) * (2 * s + 1) / s, lambda z: mpmath.exp(-z / 5) * (9 * z + 1) * (2 * z + 1) / z),
    "memory": (1 / (1 - exp(-2 * s)), lambda z: 1 / (1 - mpmath.exp(-2 * z))),
    "third order": (
        (s + 1) * (2 * s + 1) * (3 * s + 1) / (s * (s / 2 + 1)),
        lambda z: (z + 1) * (2 * z + 1) * (3 * z + 1) / z / (z / 2 + 1),
    ),
    "unstable": ((2 * s + 1) * (3 * s + 1) / (s * (1 - s / 9)), lambda z: (2 * z + 1) * (3 * z + 1) / z / (1 - z / 9)),
    "four powers cancel": (
        (exp(-s) - 1 + s - s**2 / 2 + s**3 / 6) * (9 * s + 1) / s**5,
        lambda z: (mpmath.exp(-z) - 1 + z - z**2 / 2 + z**3 / 6) * (9 * z + 1) / z**5,
    ),
    "ten powers cancel": (
        (exp(-s) - sum((-s) ** k / sympy.factorial(k) for k in range(10))) * (9 * s + 1) / s**11,
        lambda z: (mpmath.exp(-z) - sum((-z) ** k / mpmath.factorial(k) for k in range(10))) * (9 * z + 1) / z**11,
    ),
}


def coefficients(function, n):
    """The first coefficients in the series of z*function(z), by integrals around a circle."""
    with mpmath.workdps(40):
        points = [mpmath.expjpi(mpmath.mpf(2 * k) / 64) / 4 for k in range(64)]
        values = [z * function(z) for z in points]
        return [(mpmath.fsum(f / z**k for f, z in zip(values, points, strict=True)) / 64).real for k in range(n)]


@pytest.mark.parametrize(("controller", "function"), SERIES.values(), ids=SERIES)
@pytest.mark.parametrize("kind", [None, "P", "PI", "PID"])
def test_the_series_beside_numerical_taylor_coefficients(controller, function, kind):
    integral, proportional, derivative = coefficients(function, 3)
    if kind == "PID" and derivative / proportional < 0:  # a derivative time is never negative
        with pytest.raises(ValueError, match="at low frequencies"):
            as_pid(controller, kind)
        return
    match = as_pid(controller, kind)
    pid = match.settings
    expected = integral if kind != "P" else 0, derivative if kind not in ("P", "PI") else 0
    assert not match.exact
    assert float(pid.Kp) == pytest.approx(float(proportional), rel=1e-9)
    assert float(pid.Kp / pid.Ti) == pytest.approx(float(expected[0]), rel=1e-9)
    assert float(pid.Kp * pid.Td) == pytest.approx(float(max(expected[1] / proportional, 0) * proportional), rel=1e-9)
    assert pid.Tf == 0 or kind is None


def test_the_filter_of_a_series_agrees_in_one_term_more():
    controller = (s + 1) * (2 * s + 1) / (s * (s / 10 + 1) * (s / 20 + 1))
    pid = as_pid(controller, "PID with filter").settings
    rest = [sympy.series(s * H, s, 0, 5).removeO() for H in (controller, pid.expr)]
    difference = sympy.Poly(rest[0] - rest[1], s)
    assert all(difference.coeff_monomial(s**k) == 0 for k in range(4))
    assert difference.coeff_monomial(s**4) != 0


@settings(deadline=None, max_examples=draws(30))
@given(GAINS, TIMES, TIMES, TIMES, TIMES)
def test_the_rest_is_what_the_settings_lack(Kp, T1, T2, one, other):
    assume(one != other)
    controller = Kp * (T1 * s + 1) * (T2 * s + 1) / (s * (one * s / 400 + 1) * (other * s / 400 + 1))
    match = as_pid(controller)
    assert match.exact is (match.rest == 0)
    assert sympy.cancel(match.rest + match.settings.expr - controller) == 0
    if not match.exact:  # nothing is missing at low frequencies
        assert sympy.cancel(match.rest).subs(s, 0) == 0


@pytest.mark.parametrize(
    ("controller", "kind", "message"),
    [
        (0, None, "no proportional part"),
        (1 / s, None, "no proportional part"),
        ((s + 1) / s**2, None, "at most one integrator"),
        (1 / (1 - exp(-s)) ** 2, None, "at most one integrator"),
        ((1 - 2 * s) / s, None, "Ti is -2"),
        (2 - 1 / s, "PI", "Ti is -2"),
        (1 / (s * (s + 1)), None, "Ti is -1"),
        (1 - s, "PID", "Td is -1"),
        (1 + (1 + sympy.I) / s, None, "finite real number"),
        (1, "PD", "kind is 'PD': expected one of P, PI, PID, PID with filter"),
        (sqrt(s), None, "not a rational function"),
        ("1/s", None, "of type str"),
        (control.tf([1], [1, 0], 0.1), None, "discrete time"),
    ],
)
def test_what_is_no_pid_controller(controller, kind, message):
    with pytest.raises(ValueError, match=message):
        as_pid(controller, kind)


def test_an_identity_in_disguise_is_zero():
    with pytest.raises(ValueError, match=r"no proportional part|powers of s cancel"):
        as_pid((exp(-s) + 1) ** 2 - exp(-2 * s) - 2 * exp(-s) - 1)


# ------------------------------------------------------------------------------------------- internal model control

A = T3 * delay / (Tc + T3 + delay)  # of the rows K and L

# Derived by hand: K*Kp, Ti, Td, and Tf where the row needs a filter.
BY_HAND = {
    "A": (T / Tc, T, 0),
    "B": ((T1 + T2) / Tc, T1 + T2, T1 * T2 / (T1 + T2)),
    "C": (2 * zeta * T / Tc, 2 * zeta * T, T / (2 * zeta)),
    "D": (2 * zeta * T / (Tc + beta), 2 * zeta * T, T / (2 * zeta)),
    "E": (2 / Tc, 2 * Tc, 0),
    "F": ((2 * Tc + T) / Tc**2, 2 * Tc + T, 2 * Tc * T / (2 * Tc + T)),
    "G": (T / (Tc + delay), T, 0),
    "H": ((T + delay / 2) / (Tc + delay / 2), T + delay / 2, T * delay / (2 * T + delay)),
    "I": ((T1 + T2 - T3) / (Tc + delay), T1 + T2 - T3, T1 * T2 / (T1 + T2 - T3) - T3, T3),
    "J": ((2 * zeta * T - T3) / (Tc + delay), 2 * zeta * T - T3, T**2 / (2 * zeta * T - T3) - T3, T3),
    "K": ((T1 + T2 + A) / (Tc + T3 + delay), T1 + T2 + A, A + T1 * T2 / (T1 + T2 + A)),
    "L": ((2 * zeta * T + A) / (Tc + T3 + delay), 2 * zeta * T + A, A + T**2 / (2 * zeta * T + A)),
    "M": ((2 * Tc + delay) / (Tc + delay) ** 2, 2 * Tc + delay, 0),
    "N": ((2 * Tc + delay) / (Tc + delay / 2) ** 2, 2 * Tc + delay, delay * (Tc + delay / 4) / (2 * Tc + delay)),
    "O": (
        (2 * Tc + T + delay) / (Tc + delay) ** 2,
        2 * Tc + T + delay,
        (2 * Tc + delay) * T / (2 * Tc + T + delay),
    ),
}


@functools.cache
def design(case):
    model, approximation = IMC_TABLE[case]
    return imc_design(model, Tc, *([approximation] if approximation else []))


def test_the_table_has_fifteen_rows():
    assert "".join(IMC_TABLE) == "ABCDEFGHIJKLMNO" == "".join(BY_HAND)


@pytest.mark.parametrize("case", BY_HAND)
def test_every_row_of_the_table(case):
    pid = design(case).match.settings
    *expected, Tf = BY_HAND[case] if len(BY_HAND[case]) == 4 else (*BY_HAND[case], 0)
    assert all(equal(a, b) for a, b in zip((K * pid.Kp, pid.Ti, pid.Td), expected, strict=True))
    assert (pid.Tf, pid.form) == (Tf, "parallel")


@pytest.mark.parametrize("case", BY_HAND)
def test_the_exact_controller_gives_the_loop_that_was_asked_for(case):
    made = design(case)
    asked = made.remaining * made.filter
    assert sympy.cancel(feedback(made.match.controller * made.model) - asked) == 0
    assert sympy.cancel(made.invertible * made.remaining - made.model) == 0
    # no offset, neither after a setpoint nor after a load
    assert asked.subs(s, 0) == 1
    assert sympy.limit(made.model * (1 - asked), s, 0) == 0


@pytest.mark.parametrize("case", BY_HAND)
def test_exact_rows_and_series(case):
    match = design(case).match
    assert match.exact is (case not in "KL")
    assert (match.rest == 0) is match.exact
    if not match.exact:  # the exact controller is unstable, and the settings leave out what is of order s**2
        assert any(sympy.re(p).is_positive for p in poles(match.controller))
        assert sympy.cancel(match.rest / s**2).subs(s, 0).is_finite


@pytest.mark.parametrize("case", BY_HAND)
@settings(deadline=None, max_examples=draws(6))
@given(data=st.data())
def test_numbers_agree_with_the_letters(case, data):
    model, approximation = IMC_TABLE[case]
    letters = sorted((model.free_symbols | {Tc}) - {s}, key=str)
    numbers = {letter: data.draw(TIMES, str(letter)) for letter in letters}
    if case == "I":  # a zero between the lags makes Td negative: the form is then another one
        numbers[T3] = min(numbers[T1], numbers[T2]) / 3
    if case == "J":
        numbers[T3] = numbers[T] * min(numbers[zeta], 1 / numbers[zeta]) / 3
    pid = imc(model.subs(numbers), numbers[Tc], *([approximation] if approximation else []))
    by_letters = design(case).match.settings
    assert triple(pid) == tuple(sympy.cancel(value.subs(numbers)) for value in triple(by_letters))


@settings(deadline=None, max_examples=draws(40))
@given(GAINS, TIMES, TIMES, TIMES, DELAYS, TIMES)
def test_a_zero_in_the_left_half_plane_is_cancelled_whatever_it_is(gain, T1, T2, T3, late, slow):
    """Also where row I of the table would have a negative derivative time."""
    model = second_order(gain, T1, T2, late) * (T3 * s + 1)
    match = imc_design(model, slow).match
    assert match.exact
    assert sympy.cancel(match.controller - match.settings.expr) == 0
    assert all(value >= 0 for value in (match.settings.Ti, match.settings.Td, match.settings.Tf))


@settings(deadline=None, max_examples=draws(25))
@given(GAINS, TIMES, TIMES, DELAYS, TIMES)
def test_the_settings_do_not_depend_on_how_the_model_is_written(gain, T1, T2, late, slow):
    numbers = imc(second_order(gain, T1, T2, late), slow)
    expanded = sympy.expand(1 / second_order(gain, T1, T2)) ** -1 * exp(-late * s)
    slow_first = SOPDT(gain, max(T1, T2), min(T1, T2), late)
    assert numbers == imc(expanded, slow) == imc(slow_first, slow) == imc(System(expanded), slow)
    with_common_factor = second_order(gain, T1, T2, late) * (s + 3) / (s + 3)
    assert numbers == imc(with_common_factor, slow)
    assert imc(control.tf([2], [50, 15, 1]), 1) == imc(second_order(2, 10, 5), 1)


@settings(deadline=None, max_examples=draws(10))
@given(GAINS, TIMES, DELAYS, TIMES, st.integers(1, 3))
def test_higher_orders_of_pade_keep_the_promise(gain, T, late, slow, order):
    made = imc_design(first_order(gain, T, late), slow, lambda H: pade(H, order))
    loop = feedback(made.match.controller * made.model)
    difference = loop - made.remaining * made.filter
    assert abs(complex(difference.subs(s, 0.4 + 0.3j))) < 1e-10
    assert not made.remaining.has(sympy.I)


def test_zeros_on_one_side_stay_exact():
    """Those of the Pade approximation of third order are no fractions, their product is one."""
    made = imc_design(first_order(1, 5, 2), 1, lambda H: pade(H, 3))
    assert sympy.expand(made.remaining) == 1 - s + 2 * s**2 / 5 - s**3 / 15


def test_both_roads_of_the_slides():
    """The dead time approximated in the controller, (12-11), or in model and wish alike, rows G and I."""
    for model in (first_order(K, T, delay), second_order(K, T1, T2, delay)):
        ideal = direct_synthesis(model, exp(-delay * s) / (Tc * s + 1))
        assert as_pid(taylor(ideal)).settings == imc(model, Tc)


@pytest.mark.parametrize(
    ("numerator", "remains"),
    [
        (s**2 - s - 1, 1 - 2 * s / (1 + sqrt(5))),
        ((1 + s - s**2) ** 2, (1 - 2 * s / (1 + sqrt(5))) ** 2),
        (s**3 - s - 1, 1 - s / sympy.CRootOf(s**3 - s - 1, 0)),
        ((s - 2) * (s + 1 / sympy.S(3)), 1 - s / 2),
        (s**2 - s + 1, s**2 - s + 1),
    ],
)
def test_zeros_that_are_no_fractions_are_kept_out_of_what_is_inverted(numerator, remains):
    made = imc_design(numerator / (s + 1) ** 5, 1)
    assert abs(complex(sympy.N((made.remaining - remains).subs(s, 0.3 + 1j)))) < 1e-12
    whole = (made.invertible * made.remaining - made.model).subs(s, 0.3 + 1j)
    assert abs(complex(sympy.N(whole))) < 1e-12
    above = sympy.Poly(sympy.fraction(sympy.together(made.invertible))[0], s)
    assert all(sympy.re(z) < 0 for z in above.nroots())


@pytest.mark.parametrize(
    ("model", "Tc", "message"),
    [
        (1 / (s - 1), 1, "has a pole at 1"),
        (1 / (s**2 + 1), 1, "has a pole at -I: expected a process that is stable"),
        (K / (T * s - 1), 1, "has a pole at 1/T"),
        (integrator_with_lag(K, T) / s, 1, "two integrators"),
        ((s**2 + 1) / (s + 1) ** 3, 1, "zero at -I: no rule is known"),
        (K * exp(-plain * s) / (T * s + 1), 1, "zero at 1/plain, on which side is not known: expected positive"),
        (K * (x * s + 1) / (T * s + 1) ** 2, 1, "zero at -1/x, on which side is not known"),
        (0, 1, "0 is zero"),
        ((exp(-s) + exp(-2 * s)) / (s + 1), 1, "adds several dead times"),
        (2, 1, "no proportional part"),
        (first_order(1, 2), 0, "Tc is 0: expected a positive"),
        (first_order(1, 2), oo, "Tc is oo"),
        (first_order(1, 2), "Tc", "Tc is 'Tc': expected a number or an expression"),
        (1 / sqrt(s), 1, "not a rational function"),
        (control.tf([1], [1, 1], 1), 1, "discrete time"),
    ],
)
def test_what_no_row_is_for(model, Tc, message):
    with pytest.raises(ValueError, match=message):
        imc_design(model, Tc)


def test_an_approximation_must_be_one():
    with pytest.raises(ValueError, match="approximation is 'taylor': expected taylor or pade"):
        imc(integrator(1, 1), 1, "taylor")
    with pytest.raises(ValueError, match="the approximation leaves"):
        imc(integrator(1, 1), 1, lambda H: H)


def test_letters_that_a_high_degree_hides():
    """A cubic with letters cannot be factored, but it need not be: it is inverted as a whole."""
    a, b = symbols("a b", positive=True)
    made = imc_design(K / (s**3 + a * s**2 + b * s + 1), Tc)
    assert triple(made.match.settings) == (b / (K * Tc), b, a / b)
    assert isinstance(made.match, Match)
    assert not made.match.exact


def test_a_design_and_a_match_are_shown_as_formulas():
    design = imc_design(integrator(2, delay=3), Tc=1)
    assert design._repr_html_().count("<tr>") == 6
    assert design.match._repr_latex_() == r"$\displaystyle K_p = \dfrac{5}{32}, \quad T_i = 5$, exact"
    assert as_pid(1 / (1 - sympy.exp(-2 * s)), "PI")._repr_latex_().endswith("$, the first terms of a series")
