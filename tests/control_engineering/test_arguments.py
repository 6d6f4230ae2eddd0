"""Arguments: one fault has one sentence, whatever function it is made in."""

import math
import re

import pytest

from loopbook import pid, s, signals, stability, transfer, tuning
from loopbook.approximation import SOPDT, zero_rule
from loopbook.deadtime import System
from loopbook.figures import time_plot
from loopbook.identification.records import record
from loopbook.oscillation import Oscillation
from loopbook.stability import boundary_pi, boundary_pid


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        (lambda: tuning.simc(transfer.first_order(1, 1, 1), c=-1), "a positive number"),
        (lambda: pid.PID(1, 2).with_filter(-1), "a positive number"),
        (lambda: pid.LowpassFilter(1, step=-1), "a positive number"),
        (lambda: Oscillation(-1, 0.5), "a positive number"),
        (lambda: zero_rule(-1, 2, 1), "a positive number"),
        (lambda: signals.pulse_width_modulation(50, [0, 1], period=-1), "a positive number"),
        (lambda: transfer.first_order(1, -1), "a number that is not negative"),
        (lambda: pid.PID(1, Td=-1), "a number that is not negative"),
        (lambda: pid.LowpassFilter(-1, step=1), "a number that is not negative"),
        (lambda: SOPDT(1, -1), "a number that is not negative"),
        (lambda: tuning.simc(transfer.first_order(1, 1, 1), Tc=-1), "a number that is not negative"),
        (lambda: signals.noise([0, 1], deviation=-1, seed=1), "a number that is not negative"),
    ],
)
def test_one_fault_has_one_sentence_everywhere(fault, expected):
    with pytest.raises(ValueError, match=f"is -1: expected {expected}$"):
        fault()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: transfer.first_order(math.nan, 5), ValueError, "K is nan: expected a number"),
        (lambda: System(math.nan), ValueError, "nan is not a number: expected a number or an expression"),
        (
            lambda: transfer.first_order(2, 5, theta=4),
            TypeError,
            "first_order has no argument 'theta': expected one of K",
        ),
        (
            lambda: transfer.integrator(2, dealy=4),
            TypeError,
            "integrator has no argument 'dealy': did you mean 'delay'?",
        ),
        (lambda: pid.PID(2, Ki=4), TypeError, "PID has no argument 'Ki': expected one of Kp, Ti, Td, Tf, form"),
        (lambda: System(1 / s).bode(titel="L"), TypeError, "bode_plot has no argument 'titel': did you mean 'title'?"),
    ],
)
def test_what_is_no_number_and_no_argument_is_said(call, error, message):
    with pytest.raises(error, match=re.escape(message)):
        call()


def test_one_fault_in_an_array_has_one_sentence_everywhere():
    process = transfer.first_order(1, 1, 1)
    for fault in (lambda: boundary_pi(process, [-1, 1]), lambda: boundary_pid(process, [-1, 1], 0, 0)):
        with pytest.raises(ValueError, match="the values of Ti contain -1: expected positive numbers"):
            fault()
    with pytest.raises(ValueError, match="the gain ratios contain -1: expected positive numbers"):
        stability.robustness(process, pid.PID(0.5), [-1, 1])


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([0, 2, 1, 5], "the times go from 2 to 1: expected increasing numbers"),
        ([[0, 1], [2, 3]], "the times have the shape (2, 2): expected a row of numbers"),
        ([], "the times have the shape (0,): expected a row of numbers"),
        ([0, math.nan, 2, 3], "the times contain nan: expected finite numbers"),
        ("now", "the times are 'now': expected real numbers"),
    ],
)
@pytest.mark.parametrize(
    "use",
    [
        lambda times: record(times, y=[0, 0, 1, 1]),
        lambda times: signals.pulse_width_modulation(50, times, 2),
        lambda times: time_plot({"y": 1}, times),
        lambda times: System(1 / s).response(times, [0, 0, 1, 1]),
    ],
)
def test_times_that_do_not_increase_have_one_sentence_everywhere(use, values, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        use(values)
