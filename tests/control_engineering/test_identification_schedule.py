"""Gain schedules: settings that go with a signal, without a bump."""

import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.identification import GainSchedule, ScheduledController
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.signals import stepwise
from loopbook.simulation import simulate

E = sympy.exp


TABLE = {12: PID(4, Ti=7, Td=2), 16: PID(5, Ti=6, Td=1), 20: PID(7, Ti=4, Td=1)}


def gains(schedule, signal):
    return [int(schedule.settings(x).Kp) for x in signal]


def test_the_settings_of_a_row_hold_up_to_the_next():
    signal = (8, 12, 15.9, 16, 19.9, 20, 30)
    assert gains(GainSchedule(TABLE), signal) == [4, 4, 4, 5, 5, 7, 7]
    assert gains(GainSchedule(TABLE, safe="high"), signal) == [4, 4, 5, 5, 7, 7, 7]


def test_a_hysteresis_keeps_noise_from_changing_the_settings():
    signal = (15.8, 16.1, 15.9, 16.4, 16.6, 16.1, 15.6, 15.4, 16.3)
    assert gains(GainSchedule(TABLE), signal) == [4, 5, 4, 5, 5, 5, 4, 4, 5]
    schedule = GainSchedule(TABLE, hysteresis=1)
    assert gains(schedule, signal) == [4, 4, 4, 4, 5, 5, 5, 4, 4]
    assert gains(schedule, (30, 21, 12)) == [7, 7, 4]
    schedule.reset()
    assert gains(schedule, (16.1,)) == [5]


def test_a_linear_schedule_lies_on_straight_lines():
    a, b, GS = sympy.symbols("a b GS")
    line = sympy.solve([a * 16 + b - 5, a * 20 + b - 7], [a, b])
    schedule = GainSchedule(TABLE, "linear")
    for value in (16, sympy.Rational(35, 2), 20):
        assert schedule.settings(value).Kp == (a * GS + b).subs(line).subs(GS, value)
    assert schedule.settings(14) == PID(4.5, Ti=6.5, Td=1.5)
    assert (schedule.settings(0), schedule.settings(99)) == (TABLE[12], TABLE[20])


def test_a_schedule_that_makes_no_sense_is_refused():
    for wrong, message in [
        (lambda: GainSchedule({12: PID(4)}), "two rows or more"),
        (lambda: GainSchedule({12: PID(4), 16: PID(2, Ti=3, form="serial")}), "different forms"),
        (lambda: GainSchedule(TABLE, "cubic"), "the way is 'cubic'"),
        (lambda: GainSchedule(TABLE, hysteresis=5), "hysteresis is 5"),
        (lambda: GainSchedule(TABLE, "linear", hysteresis=1), "none for a linear"),
        (lambda: GainSchedule(TABLE, safe="left"), "safe end is 'left'"),
        (lambda: GainSchedule({0.1: PID(1), sympy.Rational(1, 10): PID(2)}), "different values of GS"),
        (lambda: GainSchedule({1: PID(1), sympy.Symbol("a"): PID(2)}), "GS is a: expected a finite real number"),
        (lambda: GainSchedule({1: PID(1), 2: PID(2, Ti=5)}, "linear"), "only some rows have an integral term"),
        (lambda: GainSchedule(TABLE).settings("w"), "GS is .w.: expected a number"),
        (lambda: ScheduledController(TABLE, step=1), "expected a GainSchedule"),
        (lambda: ScheduledController(GainSchedule(TABLE), step=1).update(0, 0), "value of GS is missing"),
    ]:
        with pytest.raises(ValueError, match=message):
            wrong()


def test_a_scheduled_controller_changes_its_settings_without_a_bump_at_rest():
    schedule = GainSchedule({1: PID(2, Ti=10), 2: PID(1, Ti=20)}, hysteresis=0.2)
    controller = ScheduledController(schedule, step=1)
    GS = stepwise(1, {200: 3})
    run = simulate(Process(2 * E(-2 * s) / (10 * s + 1)), controller, until=300, setpoint=1, scheduling=GS)
    assert (run["Kp"][199], run["Kp"][200], run["Ti"][200]) == (2, 1, 20)
    assert np.abs(np.diff(run["u"][190:])).max() < 1e-6
    assert run["scheduling"][[0, -1]].tolist() == [1, 3]


def test_a_scheduled_controller_does_not_know_what_the_schedule_was_asked_before():
    schedule = GainSchedule(TABLE, hysteresis=4)
    schedule.settings(30)
    assert ScheduledController(schedule, step=1).update(1, 0, scheduling=18.5) == 10  # P, and D over the first sample


def test_a_scheduled_run_goes_on_after_a_change_of_the_plant():
    schedule = GainSchedule({1: PID(1, Ti=10), 2: PID(0.5, Ti=10)}, hysteresis=1)
    controller, process = ScheduledController(schedule, step=1), 2 * E(-2 * s) / (10 * s + 1)
    run = simulate(Process(process), controller, until=100, setpoint=1, scheduling=2.2)
    assert run["Kp"][-1] == 0.5
    run = simulate(Process(2 * process), controller, until=200, setpoint=1, scheduling=1.8, after=run)
    assert run["Kp"][-1] == 0.5  # it remembers from which side it came
    with pytest.raises(ValueError, match="has no gain schedule"):
        simulate(Process(process), Controller(PID(1), step=1), until=10, setpoint=1, scheduling=1)
    with pytest.raises(ValueError, match="scheduling is given, but no controller"):
        simulate(Process(process), until=10, step=1, scheduling=1)
