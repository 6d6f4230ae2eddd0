"""What users ask of a system and of a loop: operators, step information, the four sensitivities, copies."""

import copy
import math
import pickle
from concurrent.futures import ProcessPoolExecutor

import control
import numpy as np
import pytest
import sympy

import loopbook as lb
from loopbook import s, transfer
from loopbook.deadtime import System, closed_loop
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.transfer import first_order

DELAY = sympy.exp(-s)
LOOP = Loop(first_order(2, 5, delay=4), PID(0.4, Ti=5, Td=1, Tf=0.1))
TIMES = np.linspace(0, 30, 61)


def overshoot_of(loop):
    return loop.servo.step_info().overshoot


def test_systems_and_loops_can_be_sent_to_other_processes():
    for thing in (LOOP.servo, System(0), System(DELAY / (s + DELAY))):
        assert pickle.loads(pickle.dumps(thing)) == copy.deepcopy(thing) == thing
    again = copy.deepcopy(LOOP)
    assert (again, again.margins()) == (LOOP, LOOP.margins())
    with ProcessPoolExecutor(1) as pool:
        assert list(pool.map(overshoot_of, [LOOP])) == [overshoot_of(LOOP)]


def test_controllers_multiply_with_whatever_a_block_is():
    C, P = PID(1, Ti=5), first_order(2, 5, delay=4)
    assert System(C * P) == System(P * C) == C * System(P) == System(P) * C == System(P * C.expr)
    assert isinstance(C * System(P), System)
    assert C * PID(2) == 2 * C.expr == 2 * C
    with pytest.raises(TypeError):
        C * "P"


def test_a_system_is_called_powered_and_compared():
    H = System(first_order(2, 5, delay=4))
    assert H(0.3j) == pytest.approx(H.frequency(0.3)) == pytest.approx(2 * np.exp(-1.2j) / (1 + 1.5j))
    assert H**2 == H * H
    assert closed_loop(1, H) == (1 + H) ** -1
    with pytest.raises(ValueError, match="improper"):
        System(1 / (s + 1)) ** -1
    assert System(H) == H == System(H.expr)


def test_the_four_sensitivities_are_what_their_names_say():
    L, P, C = LOOP.open, LOOP.process, LOOP.controller.expr
    w = np.array([0.01, 0.1, 0.5, 2.0])
    at = {name: System(H).frequency(w) for name, H in (("L", L), ("P", P), ("C", C))}
    assert LOOP.S.frequency(w) == pytest.approx(1 / (1 + at["L"]))
    assert LOOP.T.frequency(w) == pytest.approx(at["L"] / (1 + at["L"]))
    assert LOOP.PS.frequency(w) == pytest.approx(at["P"] / (1 + at["L"]))
    assert LOOP.CS.frequency(w) == pytest.approx(at["C"] / (1 + at["L"]))
    assert System(1) == LOOP.S + LOOP.T
    assert (LOOP.servo, LOOP.regulator, LOOP.setpoint_to_control, LOOP.load_to_control) == (
        LOOP.T,
        LOOP.PS,
        LOOP.CS,
        -LOOP.T,
    )
    with pytest.raises(ValueError, match="improper"):
        Loop(first_order(1, 1) / s, PID(1, 5, 1)).CS  # noqa: B018


def test_a_loop_knows_its_controller():
    assert LOOP.controller is LOOP._given[1]
    assert repr(LOOP) == "Loop(2*exp(-4*s)/(5*s + 1), PID(Kp=2/5, Ti=5, Td=1, Tf=1/10))"
    assert Loop(1 / s, 2).controller == System(2)
    assert Loop(1 / s, 2 / (s + 1)).controller == System(2 / (s + 1))
    improper = Loop(1 / s**2, 1 + s)
    assert improper.controller.expr == s + 1
    assert repr(improper) == "Loop(s**(-2), s + 1)"
    assert repr(Loop(1 / s, PID(2), PID(1))) == "Loop(1/s, PID(Kp=2), PID(Kp=1))"


def test_loops_are_equal_where_their_blocks_are():
    same = Loop(2 * sympy.exp(-4 * s) / (1 + 5 * s), LOOP.controller.expr)
    assert same == LOOP
    assert hash(same) == hash(LOOP)
    assert len({LOOP, same, Loop(LOOP.process, 1)}) == 2
    assert Loop(1 / s, PID(2), PID(1)) != Loop(1 / s, PID(2))
    assert LOOP.servo != LOOP


def test_a_loop_answers_for_its_step_its_criteria_and_its_sensitivity():
    assert LOOP.step(TIMES) == pytest.approx(LOOP.servo.step(TIMES))
    assert LOOP.step(TIMES, mode="regulator") == pytest.approx(LOOP.regulator.step(TIMES))
    assert LOOP.step()(3.0) == LOOP.step(3.0)
    for mode in ("servo", "regulator"):
        assert LOOP.ise(mode) == lb.ise(LOOP.process, LOOP.controller, mode)
        assert LOOP.criteria(mode) == lb.criteria(LOOP, mode=mode)
        assert pytest.approx(LOOP.ise(mode), rel=1e-8) == LOOP.criteria(mode).ISE
    assert (lb.margins(LOOP.L), LOOP.Ms) == (LOOP.margins(), LOOP.margins().Ms)
    assert Loop(DELAY / s, 2).Ms == math.inf
    for ask in (LOOP.step, LOOP.criteria):
        with pytest.raises(ValueError, match="the mode is 'load': expected one of servo, regulator"):
            ask(mode="load") if ask == LOOP.criteria else ask(TIMES, mode="load")


def test_python_control_closes_a_loop_around_a_system():
    G, H = control.tf([2], [5, 1]), System(DELAY / (s + 1))
    assert control.feedback(H, 1) == closed_loop(H)
    assert control.feedback(H, G) == closed_loop(H, G)
    assert control.feedback(H, G, 1) == H.feedback(G, sign=1) == H / (1 - H * G)
    assert G * H == H * G == System(G) * H
    assert H + control.ss(G) == G + H
    assert System(G).feedback(H) == closed_loop(G, H)
    with pytest.raises(ValueError, match="the sign is 2: expected -1 or 1"):
        H.feedback(1, 2)


def test_the_package_shows_its_public_names_only():
    assert dir(lb) == sorted(lb.__all__)
    assert all(hasattr(lb, name) for name in lb.__all__)
    assert callable(lb.ise)


def test_stability_of_a_loop_is_internal():
    hidden = Loop(1 / (s - 1), 2 * (s - 1) / (s + 1))
    assert hidden.servo.is_stable
    assert not hidden.regulator.is_stable
    assert not hidden.is_stable
    assert not Loop(DELAY / (s - 1), sympy.Rational(3, 10) * (s - 1) / (s * (s + 1))).is_stable
    assert LOOP.is_stable
    assert not System(1 / (s - sympy.Rational(1, 2))).is_stable
    assert System((1 - DELAY) / s).is_stable
    assert not System(1 / s).is_stable
    assert System(0).is_stable


def test_static_gains_are_exact():
    assert LOOP.servo.static_gain == 1
    assert LOOP.regulator.static_gain == 0
    assert System((1 - DELAY) / s).static_gain == 1
    assert System(-1 / s).static_gain == -sympy.oo
    assert System(0).static_gain == 0
    assert closed_loop(3 * DELAY / (s + 1)).static_gain == sympy.Rational(3, 4)


# ------------------------------------------------------------------------------------------------ step information


@pytest.mark.parametrize("seed", range(6))
def test_step_information_is_that_of_python_control_without_dead_time(seed):
    draw = np.random.default_rng(seed)
    T, zeta, zero = (sympy.Rational(f"{draw.uniform(*span):.3g}") for span in ((0.2, 5), (0.05, 1.5), (-2, 2)))
    K = (-2, 3)[seed % 2]
    H = K * (zero * s + 1) / (T**2 * s**2 + 2 * zeta * T * s + 1)
    found = System(H).step_info()
    times = np.linspace(0, 2 * found.settling_time, 4_001)
    y, step = System(H).step(times) / K, times[1]
    expected = control.step_info(control.tf([float(K * zero), float(K)], [float(T**2), float(2 * zeta * T), 1]), times)
    assert found.overshoot == pytest.approx(expected["Overshoot"] / 100, abs=1e-4)
    assert found.undershoot == pytest.approx(expected["Undershoot"] / 100, abs=1e-4)
    assert found.rise_time == pytest.approx(times[(y >= 0.9).argmax()] - times[(y >= 0.1).argmax()], abs=2 * step)
    assert found.settling_time == pytest.approx(times[np.flatnonzero(abs(y - 1) > 0.02)[-1]], abs=2 * step)
    assert found.final_value == K
    if found.overshoot > 1e-3:
        assert abs(found.peak) == pytest.approx(abs(K) * y.max(), rel=1e-4)
        assert found.peak_time == pytest.approx(times[y.argmax()], abs=2 * step)


def test_step_information_of_an_oscillation_in_closed_form():
    zeta = 0.05
    info = System(1 / (s**2 + 2 * sympy.Rational("0.05") * s + 1)).step_info()
    wd = math.sqrt(1 - zeta**2)
    assert info.peak_time == pytest.approx(math.pi / wd, rel=1e-10)
    assert info.overshoot == pytest.approx(math.exp(-math.pi * zeta / wd), rel=1e-10)
    assert info.rise_time < info.peak_time < info.settling_time


def test_step_information_with_dead_time_and_jumps():
    info = closed_loop(DELAY / (2 * s)).step_info()
    y = closed_loop(DELAY / (2 * s)).step(np.linspace(0, 20, 20_001))
    assert info.overshoot == pytest.approx(y.max() - 1, abs=1e-7)
    jump = System(DELAY**3).step_info()
    assert (jump.rise_time, jump.settling_time, jump.overshoot) == (0, 3, 0)
    inverse = System((1 - 2 * s) * DELAY / (s + 1)).step_info()
    assert inverse.undershoot == pytest.approx(2)
    load = LOOP.regulator.step_info()
    assert load.final_value == 0
    assert math.isnan(load.rise_time)
    assert math.isnan(load.overshoot)
    assert load.peak == pytest.approx(LOOP.regulator.step(np.linspace(0, 40, 8001)).max(), rel=1e-6)
    assert System(1 / (s + 1)).step_info(settling=0.05, rise=(0, 0.5)).rise_time == pytest.approx(math.log(2))


@pytest.mark.parametrize("H", [1 / (s + 1), s * DELAY / (s + 1) ** 2, (1 - 2 * s) / (s**2 + s + 1)], ids=str)
def test_step_information_follows_the_sign_and_the_unit_of_time(H):
    info = System(H).step_info()
    values, times = ("peak", "final_value"), ("rise_time", "settling_time", "peak_time")
    turned = {name: -getattr(info, name) for name in values}
    slower = {name: 7 * getattr(info, name) for name in times}
    for other, changed in ((System(-H), turned), (System(H.subs(s, 7 * s)), slower)):
        expected = info._asdict() | changed
        assert other.step_info()._asdict() == pytest.approx(expected, rel=1e-9, nan_ok=True)


def test_the_response_time_of_any_system():
    assert System(1 / (5 * s + 1)).response_time() == pytest.approx(5)
    assert System(first_order(2, 5, 4)).response_time(0.9) == pytest.approx(4 + 5 * math.log(10))
    assert transfer.response_time(closed_loop(DELAY / (2 * s))) == pytest.approx(
        closed_loop(DELAY / (2 * s)).response_time()
    )
    y = LOOP.servo.step([LOOP.servo.response_time(0.5)])
    assert y == pytest.approx([0.5])


@pytest.mark.parametrize(
    ("question", "message"),
    [
        (lambda: System(1 / s).step_info(), r"1/s is not stable"),
        (lambda: System(1 / (s + 1)).step_info(settling=2), "the band for settling is 2"),
        (lambda: System(1 / (s + 1)).step_info(rise=(0.9, 0.1)), "from 0.9 to 0.1: expected increasing"),
        (lambda: System(1 / (s + 1)).response_time(1), "the share is 1"),
        (lambda: LOOP.regulator.response_time(), "settles at 0"),
        (lambda: LOOP.error("load"), "the mode is 'load'"),
    ],
)
def test_questions_without_an_answer(question, message):
    with pytest.raises(ValueError, match=message):
        question()


# ------------------------------------------------------------------------------------------------ the top


def test_the_functions_of_transfer_take_systems():
    H = System(first_order(2, 5))
    assert transfer.static_gain(H) == 2
    assert transfer.poles(H) == [-sympy.Rational(1, 5)]
    assert transfer.step_response(H) == transfer.step_response(first_order(2, 5))
    assert transfer.response_time(H) == pytest.approx(5)
    assert transfer.series(H, PID(2)) == 4 / (5 * s + 1)
    assert transfer.feedback(H, PID(1)) == 2 / (5 * s + 3)


def test_what_is_wanted_most_is_at_the_top():
    assert {"Loop", "System", "PID", "margins", "first_order"} <= set(dir(lb))
    for name in lb.__all__:
        assert getattr(lb, name) is not None
    loop = lb.Loop(lb.first_order(2, 5, delay=4), lb.PID(0.5, Ti=5))
    assert loop.margins() == lb.margins(loop.open) == lb.margins(lb.first_order(2, 5, delay=4) * lb.PID(0.5, Ti=5))
    with pytest.raises(AttributeError, match="no attribute 'loop'"):
        lb.loop  # noqa: B018
