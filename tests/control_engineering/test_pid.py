"""The settings of a PID controller in their forms, and the practical controller feature by feature."""

import math
from itertools import pairwise

import numpy as np
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loopbook import s, t
from loopbook.laplace import evaluate
from loopbook.pid import HOLD, PID, Controller, LowpassFilter
from loopbook.transfer import first_order, response

TIMES = st.fractions(0, 50, max_denominator=20).map(sympy.Rational)
LAGS = st.fractions(1, 50, max_denominator=20).map(sympy.Rational)
SHARES = st.fractions(0, 1, max_denominator=20).map(sympy.Rational)
GAINS = st.fractions(-20, 20, max_denominator=20).map(sympy.Rational)


# Forms.


def same(one, other):
    return sympy.simplify(one.expr - other.expr) == 0


@given(GAINS, LAGS, TIMES, TIMES)
def test_the_parallel_form_is_the_same_controller(Kp, Ti, Td, Tf):
    assume(Ti + Td > Tf and Ti * Td / (Ti + Td - Tf) >= Tf)
    serial = PID(Kp, Ti, Td, Tf, form="serial")
    assert same(serial, serial.parallel())


@settings(deadline=None)
@given(GAINS, LAGS, SHARES, SHARES)
def test_the_serial_form_is_the_same_controller_and_goes_back(Kp, Ti, share, filtered):
    Tf = filtered * Ti
    parallel = PID(Kp, Ti, share * (Ti - Tf) ** 2 / (4 * Ti), Tf)
    serial = parallel.serial()
    assert same(parallel, serial)
    assert all(
        sympy.simplify(getattr(serial.parallel(), x) - getattr(parallel, x)) == 0 for x in ("Kp", "Ti", "Td", "Tf")
    )


@pytest.mark.parametrize("pid", [PID(3, Td=2, Tf=0.5), PID(3, Td=2), PID(3)])
def test_forms_of_a_controller_without_integral_term(pid):
    assert same(pid, pid.serial())
    assert pid.serial().parallel() == pid


def test_letters_convert_as_the_book_says():
    Kp, Ti, Td = sympy.symbols("Kp Ti Td", positive=True)
    parallel = PID(Kp, Ti, Td, form="serial").parallel()
    ratio = 1 + Td / Ti  # equations (10.24) to (10.26)
    factors = (parallel.Kp / Kp / ratio, parallel.Ti / Ti / ratio, parallel.Td / Td * ratio)
    assert [sympy.simplify(factor) for factor in factors] == [1, 1, 1]


def test_complex_zeros_have_no_serial_form():
    with pytest.raises(ValueError, match="complex zeros"):
        PID(1, Ti=4, Td=1.01).serial()
    assert PID(1, Ti=4, Td=1).serial().Ti == 2


@given(GAINS.filter(bool), st.fractions(0, 100, max_denominator=10).map(sympy.Rational))
def test_the_panel_goes_there_and_back(Kp, repeats):
    pid = PID.from_panel(100 / Kp, repeats)
    assert (pid.Kp, pid.proportional_band, pid.repeats_per_minute()) == (Kp, 100 / Kp, repeats)
    assert pid.repeats_per_minute(1) == repeats / 60  # Ti in minutes, as many as there were seconds


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"Kp": "2"}, "Kp is '2'"),
        ({"Kp": sympy.oo}, "Kp is oo"),
        ({"Kp": sympy.I}, "Kp is I"),
        ({"Kp": 1, "Ti": 0}, "Ti is 0"),
        ({"Kp": 1, "Ti": -3}, "Ti is -3"),
        ({"Kp": 1, "Td": -1}, "Td is -1"),
        ({"Kp": 1, "Td": sympy.oo}, "Td is oo"),
        ({"Kp": 1, "Tf": float("nan")}, "Tf is nan"),
        ({"Kp": 1, "form": "cascade"}, "form is 'cascade'"),
    ],
)
def test_settings_that_are_none(wrong, message):
    with pytest.raises(ValueError, match=message):
        PID(**wrong)


def test_how_settings_are_shown():
    assert repr(PID(2, 10, 2.5, form="serial")) == "PID(Kp=2, Ti=10, Td=5/2, form='serial')"
    assert eval(repr(PID(2, 10))) == PID(2, 10)


def test_the_filter_of_the_derivative_is_a_share_of_its_time():
    assert PID(6, Ti=3, Td=1).with_filter(5) == PID(6, Ti=3, Td=1, Tf=sympy.Rational(1, 5))
    for wrong in (0, -2):
        with pytest.raises(ValueError, match=f"N is {wrong}: expected a positive number"):
            PID(6, Ti=3, Td=1).with_filter(wrong)


# The filter.


@pytest.mark.parametrize("step", [0.1, 1.0, 7.0])
def test_the_filter_is_exact_for_straight_lines_between_the_samples(step):
    T, levels = 3, [0, 0, 2, 2, -1, 5, 5]
    h = sympy.Rational(step)
    slopes = [0, *((new - old) / h for old, new in pairwise(levels))]
    line = sum((b - a) * (t - k * h) * sympy.Heaviside(t - k * h) for k, (a, b) in enumerate(pairwise(slopes)))
    smooth = LowpassFilter(T, step)
    exact = evaluate(response(first_order(1, T), line), step * np.arange(len(levels)))
    assert [smooth.update(x) for x in levels] == pytest.approx(exact.tolist(), abs=1e-12)


def test_a_filter_becomes_none_as_its_lag_vanishes():
    for T in (0, 1e-12):
        smooth = LowpassFilter(T, step=1)
        assert [smooth.update(x) for x in (0, 1, 5, -2)] == pytest.approx([0, 1, 5, -2])


def test_a_filter_without_lag_lets_everything_through():
    smooth = LowpassFilter(0, 1)
    assert [smooth.update(x) for x in (1, 5, -2)] == [1, 5, -2]


@pytest.mark.parametrize(("T", "step"), [(-1, 1), (1, 0), (1, -1), (1, float("inf")), (sympy.Symbol("T"), 1)])
def test_a_filter_needs_a_lag_and_a_step(T, step):
    with pytest.raises(ValueError, match="expected a"):
        LowpassFilter(T, step)


# The controller, one feature after the other. It runs in the open: the measurements are given.


def run(controller, measurements, setpoint=0.0, **signals):
    return [controller.update(setpoint, y, **signals) for y in measurements]


def held(levels, step):
    """A signal that is held between samples, as an expression in t, at rest before."""
    pairs = zip([0, *levels], levels, strict=False)
    return sum((new - old) * sympy.Heaviside(t - k * step) for k, (old, new) in enumerate(pairs))


@pytest.mark.parametrize("pid", [PID(2, 5), PID(2, 5, 1, 0.25), PID(2, 5, 1, 0.25, form="serial"), PID(3)])
@pytest.mark.parametrize("action", ["reverse", "direct"])
def test_the_control_signal_is_that_of_the_continuous_controller_for_held_errors(pid, action):
    step, errors = sympy.Rational(1, 2), [1, 1, 3, -2, 0, 0, 4]
    parallel, times = pid.parallel(), [float(k * step) for k in range(len(errors) + 1)]
    without, derivative = (PID(parallel.Kp, parallel.Ti).expr, parallel.expr - PID(parallel.Kp, parallel.Ti).expr)
    exact = evaluate(response(sympy.expand(without), held(errors, step)), times)[:-1]
    exact += np.diff(evaluate(response(derivative / s, held(errors, step)), times)) / float(step)  # its means
    controller = Controller(pid, step, action=action)
    computed = [controller.update(setpoint=e, measurement=0.0) for e in errors]
    assert computed == pytest.approx((exact * (1 if action == "reverse" else -1)).tolist(), abs=1e-12)


def test_a_derivative_without_filter_is_a_difference():
    controller = Controller(PID(2, Td=3), step=0.5)
    assert run(controller, [0, 1, 1]) == pytest.approx([0, -2 - 2 * 3 * 1 / 0.5, -2])


def test_weights_remove_the_kicks_and_nothing_else():
    pid, step = PID(3.6, 2, 0.5, 0.05), 0.1
    kicks = {}
    for w_p, w_d in [(1, 1), (0.3, 0), (0, 0)]:
        controller = Controller(pid, step, u0=20, w_p=w_p, w_d=w_d)
        before = [controller.update(5.0, 5.0) for _ in range(3)]
        assert before == pytest.approx(3 * [20])  # at rest, whatever the weights are
        kicks[w_p, w_d] = controller.update(6.0, 5.0) - 20
    derivative = 0.5 / 0.1 * (1 - math.exp(-0.1 / 0.05))
    assert kicks == pytest.approx({(1, 1): 3.6 * (1 + derivative), (0.3, 0): 3.6 * 0.3, (0, 0): 0})


@pytest.mark.parametrize("Tf", [0, 0.1, 1, 30])
def test_the_derivative_of_a_ramp_is_its_slope(Tf):
    controller = Controller(PID(2, Td=10, Tf=Tf), step=1)
    for time in range(1000):
        controller.update(0.0, -0.3 * time)
    assert controller.terms[2] == pytest.approx(2 * 10 * 0.3)


def test_the_setpoint_moves_no_faster_than_its_ramp():
    controller = Controller(PID(1), step=2, ramp=0.5)
    assert run(controller, 4 * [0.0], setpoint=2.5) == pytest.approx([1, 2, 2.5, 2.5])
    assert run(controller, 3 * [0.0], setpoint=1) == pytest.approx([1.5, 1, 1])


def test_the_integral_halts_at_the_limits_and_comes_back_at_once():
    wound, halted = (
        Controller(PID(1, 10), step=1, limits=(0, 10), u0=5, anti_windup=anti_windup) for anti_windup in (False, True)
    )
    for controller in (wound, halted):
        assert max(run(controller, 1000 * [-20.0])) == 10
    assert wound.integral == pytest.approx(2000)
    assert halted.integral <= 2 * 10
    assert run(halted, 10 * [10.0])[-1] == 0
    assert run(wound, 10 * [10.0])[-1] == 10


def test_the_integral_may_go_back_while_the_signal_is_at_its_limit():
    controller = Controller(PID(1, 10), step=1, limits=(0, 10))
    # the feedforward alone saturates the signal; a negative error still reduces the integral term
    outputs = [controller.update(0.0, 1.0, feedforward=25.0) for _ in range(200)]
    assert outputs[0] == 10
    assert outputs[-1] == pytest.approx(25 - 1 - 199 * 0.1)


def test_the_range_of_the_feedback_alone():
    controller = Controller(PID(1), step=1, pid_limits=(-5, 5), limits=(0, 5))
    assert run(controller, [-20, 20, 2], feedforward=3.0) == [5, 0, 1]


@pytest.mark.parametrize("pid", [PID(2, 10), PID(2, 10, 3, 0.3), PID(2)])
def test_no_bump_between_the_modes(pid):
    controller = Controller(pid, step=1, u0=30, limits=(0, 100))
    last = run(controller, [1.0, 0.5, 0.5], setpoint=1)[-1]
    assert run(controller, [0.4, 0.3], setpoint=1, manual=HOLD) == [last, last]
    assert run(controller, [0.4, 0.3], setpoint=1, manual=55.0) == [55, 55]
    assert run(controller, [0.3], setpoint=1) == pytest.approx([55])
    following = run(controller, [0.3, 0.3], setpoint=1)
    growth = 2 * 0.7 / 10 if pid.Ti != sympy.oo else 0
    assert following[-1] - following[-2] == pytest.approx(growth, abs=0.05 if pid.Td else 1e-12)


def test_without_bumpless_transfer_there_is_a_bump():
    controller = Controller(PID(2, 10), step=1, u0=30, bumpless=False)
    assert run(controller, [0.0], manual=55.0) == [55]
    assert run(controller, [0.0]) == [30]


def test_manual_mode_from_the_beginning_starts_at_the_nominal_control_signal():
    assert run(Controller(PID(2, 10), step=1, u0=30), [5.0], manual=HOLD) == [30]


def test_percent_inside_engineering_units_outside():
    percent = Controller(PID(1.35, 900), 1, u0=45, measurement_range=(0, 15), control_range=(0, 50))
    # 1 m is 100/15 %, and 1 % of the control signal is 0.5 kg/s: Haugen, Sections 7.2.3 and 7.2.4
    engineering = Controller(PID(1.35 * 100 / 15 * 0.5, 900), 1, u0=45 * 0.5, limits=(0, 50))
    levels = [10, 9.5, 9, 8, 12, 14]
    assert run(percent, levels, setpoint=10) == pytest.approx(run(engineering, levels, setpoint=10))
    assert run(percent, 1000 * [0], setpoint=10)[-1] == 50


def test_the_measurement_filter_is_in_the_loop():
    controller, smooth = Controller(PID(1), step=1, T_filter=2), LowpassFilter(2, step=1)
    for y in (0, 1, 1, 3):
        assert controller.update(0, y) == -smooth.update(y) == -controller.filtered


def test_the_terms_add_up_to_the_control_signal():
    controller = Controller(PID(2, 5, 1, 0.1), step=0.5, u0=7)
    for y in (0.0, 1.0, 4.0, -2.0):
        assert controller.update(1.0, y) == pytest.approx(7 + sum(controller.terms))


NEW = [
    {"settings": PID(5, 10)},
    {"settings": PID(5, 10), "w_p": 0.3},
    {"w_p": 0.3},
    {"settings": PID(1, 10, 4, 0.4), "w_d": 0},
    {"settings": PID(1, 10, 4, 0.4)},
    {"u0": 12},
    {"T_filter": 5},
]


@pytest.mark.parametrize("new", NEW)
@pytest.mark.parametrize("old", NEW)
def test_new_settings_do_not_move_a_loop_at_rest(old, new):
    old, new = (Controller(**({"settings": PID(1, 10), "step": 1, "u0": 40} | given)) for given in (old, new))
    for _ in range(20):
        old.update(7, 6.5)
    last = [old.update(7, 7) for _ in range(200)][-1]
    new.take_over(old)
    assert [new.update(7, 7) for _ in range(3)] == pytest.approx(3 * [last], abs=1e-6)


def test_a_controller_may_begin_from_a_control_signal():
    controller = Controller(PID(2, 10), step=1, u0=30)
    controller.start_from(55)
    assert controller.update(1, 0.7) == pytest.approx(55)
    scaled = Controller(PID(2, 10), step=1, u0=30, control_range=(0, 2000))
    scaled.start_from(1100)
    assert scaled.update(1, 0.7) == pytest.approx(1100)


@pytest.mark.parametrize("pid", [PID(2, 10, 3, 0.3), PID(2, 10)])
def test_no_derivative_of_what_happened_in_manual_mode(pid):
    controller = Controller(pid, step=0.1, u0=50)
    for k in range(50):
        controller.update(1, 1 + 0.05 * k, manual=50.0)
    # the setpoint jumps at the moment at which the controller is switched on
    signals = [controller.update(3.5, 3.5) for _ in range(5)]
    assert signals == pytest.approx(5 * [50])


def test_bumpless_transfer_winds_nothing_up_beyond_the_range_of_the_feedback():
    controller = Controller(PID(1, 10), 1, limits=(0, 100), pid_limits=(-5, 5))
    controller.update(0, 0, manual=40, feedforward=10)
    signals = [controller.update(0, 1, feedforward=10) for _ in range(40)]
    assert signals[0] == 15
    assert signals[5] < 15


@pytest.mark.parametrize("signals", [("a", 1), (1, None), (1, 1, "x"), (1, 1, 0, "manual"), (sympy.Symbol("r"), 1)])
def test_signals_that_are_no_numbers(signals):
    with pytest.raises(ValueError, match="expected numbers"):
        Controller(PID(1), step=1).update(*signals)


def test_a_filter_slower_than_the_derivative_action_has_no_parallel_form():
    with pytest.raises(ValueError, match="no parallel form"):
        PID(1, 10, 0, 1, form="serial").parallel()
    with pytest.raises(ValueError, match="proportional_band is 0: expected a number other than zero"):
        PID.from_panel(0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"step": 0}, "step is 0"),
        ({"step": float("nan")}, "step is nan"),
        ({"action": "backwards"}, "action is 'backwards'"),
        ({"settings": PID(-2), "action": "direct"}, "Kp is -2"),
        ({"settings": 2}, "settings is 2"),
        ({"settings": PID(sympy.Symbol("Kp"))}, "Kp is Kp"),
        ({"limits": (5, 0)}, r"limits are \(5, 0\): expected the lower one first"),
        ({"limits": (float("nan"), 1)}, "limits are"),
        ({"limits": 5}, "limits are 5"),
        ({"pid_limits": (1, 1)}, "pid_limits are"),
        ({"T_filter": -1}, "T is -1"),
        ({"ramp": 0}, "ramp is 0"),
        ({"ramp": -1}, "ramp is -1"),
        ({"u0": "much"}, "u0 is 'much'"),
        ({"w_p": float("inf")}, "w_p is inf"),
        ({"measurement_range": (3, 3)}, "range is"),
    ],
)
def test_what_makes_no_controller(arguments, message):
    with pytest.raises(ValueError, match=message):
        Controller(**({"settings": PID(1), "step": 1} | arguments))


def test_settings_are_shown_as_formulas_and_name_the_form_where_it_matters():
    assert PID(sympy.Symbol("K"), Ti=3)._repr_latex_() == r"$\displaystyle K_p = K, \quad T_i = 3$"
    assert PID(2, Ti=3, form="serial")._repr_latex_() == r"$\displaystyle K_p = 2, \quad T_i = 3$"
    assert PID(2, Ti=3, Td=1, form="serial")._repr_latex_().endswith(r"T_d = 1$ (serial form)")
    assert "2.99852" in PID(sympy.Rational(299855, 100001))._repr_latex_()
