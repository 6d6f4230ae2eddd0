"""Control structures: several controllers on one plant, compared with the same algebra done by hand."""

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook import s, t
from loopbook.deadtime import System
from loopbook.figures import trends
from loopbook.identification import AdaptiveController, GainSchedule, Relay, ScheduledController
from loopbook.pid import PID, Controller
from loopbook.plants import (
    Balance,
    BufferTank,
    HeatedTank,
    JacketedTank,
    Lag,
    LiquidTank,
    Plant,
    parameter,
    signal,
)
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.structures import Calculation, ControlLoop, SplitRange, controller_action
from loopbook.transfer import feedback

TANK = JacketedTank()
FLOW = float(TANK.F_h)


def cascade(outer=None, inner=None, **more):
    """The temperature of the tank by that of the jacket."""
    outer = outer or Controller(PID(2, Ti=400), step=1, u0=46)
    inner = inner or Controller(PID(0.05, Ti=60), step=1, u0=FLOW, limits=(0, 1.5))
    return [
        ControlLoop("TC1", outer, setpoint="T_SP", measurement="T_pm", output="T_hSP"),
        ControlLoop("TC2", inner, setpoint="T_hSP", measurement="T_hm", output="F_h", **more),
    ]


def one_loop(**more):
    controller = Controller(PID(0.2, Ti=400), step=1, u0=FLOW, limits=(0, 1.5))
    return ControlLoop("TC1", controller, setpoint="T_SP", measurement="T_pm", output="F_h", **more)


# ------------------------------------------------------------------------------------------------ the action


@pytest.mark.parametrize(
    ("H", "action"),
    [
        (3 / (s + 1), "reverse"),
        (-3 / (s + 1), "direct"),
        (-2 / s, "direct"),
        (2 / s**2, "reverse"),
        (5, "reverse"),
        ((1 - 3 * s) / (s + 1) ** 2, "reverse"),  # the inverse response does not decide
        (-sympy.exp(-4 * s) / (s * (s + 1)), "direct"),
        ((1 - sympy.exp(-s)) / s, "reverse"),  # the mean over the last second
        (BufferTank().transfer_function("F_out"), "direct"),
        (HeatedTank().numbers(HeatedTank().transfer_function("P")), "reverse"),
    ],
)
def test_the_sign_of_the_process_gain_decides_the_action(H, action):
    assert controller_action(H) == action


@pytest.mark.parametrize(
    ("H", "why"),
    [
        (s / (s + 1), "no lasting effect"),
        (0, "no lasting effect"),
        (1 / (s - 1), "unstable"),
        (sympy.Symbol("K") / (s + 1), "sign of the process gain K"),
        (HeatedTank().transfer_function("P"), "expected numbers or positive symbols"),  # the flow F may be negative
        ("1/s", "type str"),
    ],
)
def test_where_no_sign_decides_it_is_said(H, why):
    with pytest.raises(ValueError, match=why):
        controller_action(H)


@settings(max_examples=draws(15), deadline=None)
@given(st.sampled_from(["F_in", "F_out"]), st.sampled_from(["reverse", "direct"]))
def test_the_loop_is_stable_with_the_computed_action_and_with_no_other(name, chosen):
    tank = BufferTank(h_max=50, h=25)
    right = controller_action(tank.transfer_function(name))
    controller = Controller(PID(10, Ti=100), step=1, u0=0, action=chosen)
    run = simulate(tank, [ControlLoop("LC1", controller, 25.1, "h", name)], until=300)
    assert (abs(run["h"][-1] - 25.1) < 0.01) == (chosen == right)


# ------------------------------------------------------------------------------------------------ one loop and two


def test_one_loop_in_a_list_is_the_single_controller():
    setpoint = stepwise(40, {100: 41})
    alone = simulate(TANK, one_loop().controller, until=600, setpoint=setpoint, T_hin=stepwise(60, {300: 58}))
    listed = simulate(TANK, [one_loop()], until=600, T_SP=setpoint, T_hin=stepwise(60, {300: 58})).loop("TC1")
    for name in ("T_pm", "F_h", "setpoint", "measurement", "u_p", "u_i", "ramped"):
        assert np.array_equal(alone[name], listed[name]), name
    assert (listed.output, listed.manipulated, listed.unit("F_h")) == ("T_pm", "F_h", "kg/s")


class LagAndIntegrator(Plant):
    """The least plant for a cascade: a lag, whose output is measured, before an integrator."""

    T = parameter(2, "s", "lag")
    u, d = signal(0, "1", "control signal"), signal(0, "1", "load")
    y_1, y_2 = signal(0, "1", "what is controlled"), signal(0, "1", "what is between")
    integrator = Balance(y_1, y_2)
    lag = Lag(y_2, u + d, T)
    output, manipulated = y_1, u


def test_a_cascade_is_the_algebra_of_its_two_loops():
    inside, outside = PID(3, Ti=4), PID(0.8)
    blocks = [
        ControlLoop("C1", Controller(outside, step=0.005), "r", "y_1", "w"),
        ControlLoop("C2", Controller(inside, step=0.005), "w", "y_2", "u"),
    ]
    run = simulate(LagAndIntegrator(), blocks, until=15, r=1, d=stepwise(0, {7.5: -2}))
    lag = 1 / (2 * s + 1)
    inner, load = feedback(inside.expr * lag), feedback(lag, inside.expr)
    servo = System(feedback(outside.expr * inner / s)).step(run.times)
    regulator = System(feedback(load / s, outside.expr * inner / load)).step(run.times)
    late = np.concatenate([np.zeros(1500), regulator[:-1500]])
    assert abs(run["y_1"] - servo + 2 * late).max() < 5e-3


def test_the_signals_of_a_cascade_fit_together():
    run = simulate(TANK, cascade(), until=900, T_SP=stepwise(40, {10: 41}), noise={"T_hm": 0.05})
    assert np.array_equal(run["T_hSP"], run["TC2.setpoint"])
    assert np.allclose(run["T_hSP"], 46 + run["TC1.u_p"] + run["TC1.u_i"])
    assert np.allclose(run["TC2.u_p"], 0.05 * (run["T_hSP"] - run["TC2.measurement"]))
    assert 0.03 < (run["TC2.measurement"] - run["T_hm"]).std() < 0.07
    assert run.loop("TC1").unit("T_hSP") == run.loop("TC2").unit("T_SP") == "°C"
    assert [run.unit(f"TC1.{name}") for name in ("measurement", "filtered", "u_p", "u_i")] == 4 * ["°C"]
    assert [run.unit(f"TC2.{name}") for name in ("setpoint", "u_p", "u_d")] == ["°C", "kg/s", "kg/s"]
    assert "T_hSP" in str(trends(run.loop("TC1")))


def test_a_run_goes_on_as_if_it_had_not_been_interrupted():
    steps = stepwise(60, {500: 55})
    first = simulate(TANK, cascade(), until=700, T_SP=41, T_hin=steps)
    second = simulate(TANK, cascade(), until=1500, T_SP=41, T_hin=55, after=first)
    whole = simulate(TANK, cascade(), until=1500, T_SP=41, T_hin=steps)
    assert second.signals.keys() == whole.signals.keys()
    for name in whole.signals:
        assert np.allclose(second[name], whole[name], rtol=0, atol=1e-12), name


@pytest.mark.parametrize("first_tag", ["TC1", "TC3"])
def test_a_run_that_goes_on_with_another_structure_begins_without_a_bump(first_tag):
    """Also where a loop of another kind had the same tag: what it remembers is a valve, not a temperature."""
    before = one_loop()
    before.tag = first_tag
    first = simulate(TANK, [before], until=500, T_SP=42)
    second = simulate(TANK, cascade(), until=1000, T_SP=42, after=first)
    assert abs(second["F_h"][500] - first["F_h"][500]) < 0.01
    assert second["T_hSP"][500] == first["T_hm"][500]
    assert abs(second["T_pm"][500:] - 42).max() < 0.5


def test_a_cascade_begins_without_a_bump_on_a_plant_that_ran_without_control():
    first = simulate(TANK, until=500, step=1, F_h=0.9)
    second = simulate(TANK, cascade(), until=600, T_SP=float(first["T_pm"][-1]), after=first)
    assert second["T_hSP"][500] == first["T_hm"][500]
    assert abs(np.diff(second["F_h"][495:])).max() < 0.01


def test_a_slow_block_that_is_new_runs_at_once():
    first = simulate(TANK, [one_loop()], until=440, T_SP=42)
    slow = Controller(PID(0.02, Ti=400), step=30, u0=46)
    second = simulate(TANK, cascade(outer=slow), until=500, T_SP=42, after=first)
    assert np.flatnonzero(np.diff(second["T_hSP"][440:])).tolist() == [9, 39]


def test_slow_blocks_keep_their_rhythm_when_the_shortest_step_changes():
    slow = Controller(PID(0.02, Ti=400), step=30, u0=46)
    fast = Controller(PID(0.05, Ti=60), step=0.5, u0=FLOW, limits=(0, 1.5))
    first = simulate(TANK, cascade(outer=slow), until=440, T_SP=42)
    second = simulate(TANK, cascade(outer=slow, inner=fast), until=600, T_SP=42, after=first)
    changes = second.times[1:][np.diff(second["T_hSP"]) != 0]
    assert (changes % 30 == 0).all()
    assert changes[-1] == 600


# ------------------------------------------------------------------------------------------------ modes and limits


class ThreeLags(Plant):
    """Three lags, all measured, for a cascade of three loops."""

    T = parameter(1, "s", "lag")
    u, d = signal(0, "1", "control signal"), signal(0, "1", "load")
    y_1, y_2, y_3 = (signal(0, "1", word) for word in ("primary", "secondary", "innermost"))
    outer, middle, inner = Lag(y_1, y_2, 10 * T), Lag(y_2, y_3, 3 * T), Lag(y_3, u + d, T)
    output, manipulated = y_1, u


@pytest.mark.parametrize("how", ["by hand", "by its mode"])
def test_all_loops_outside_one_in_manual_mode_follow(how):
    outer, middle, inner = (Controller(PID(K, Ti), step=0.1) for K, Ti in ((2, 10), (2, 3), (3, 1)))
    blocks = [
        ControlLoop("A", outer, "r", "y_1", "v"),
        ControlLoop("B", middle, "v", "y_2", "w"),
        ControlLoop("C", inner, "w", "y_3", "u", mode="auto", manual=0.2),
    ]
    by_mode = how == "by its mode"
    switch = {"auto": stepwise(1, {20: 0, 40: 1})} if by_mode else {"auto": 1, "manual": {"C": [(20, 40, 0.2)]}}
    run = simulate(ThreeLags(), blocks, until=80, r=1, **switch)
    by_hand = slice(200, 400)
    assert set(run["u"][by_hand]) == {0.2}
    assert np.array_equal(run["w"][by_hand], run["y_3"][by_hand])
    assert np.array_equal(run["v"][by_hand], run["y_2"][by_hand])
    assert run["u"][400] == pytest.approx(0.2), "back in automatic mode the control signal does not jump"
    assert run["y_1"][400:].max() < 1.1, "the primary loop has not wound up"


def test_of_two_loops_with_one_setpoint_neither_is_followed():
    tank = LiquidTank(h_max=10)
    blocks = [
        ControlLoop("LC1", Controller(PID(1, 50), step=1), "h_SP", "h", "w"),
        ControlLoop("FC1", Controller(PID(0.1), step=1), "w", "h", "q_i"),
        ControlLoop("FC2", Controller(PID(0.1), step=1), "w", "h", "q_o"),
    ]
    run = simulate(tank, blocks, until=20, h_SP=0.6, manual={"FC1": [(5, 15, 0)]})
    assert np.array_equal(run["w"], run["LC1.u_p"] + run["LC1.u_i"])


def test_the_mode_can_be_a_signal():
    blocks = [one_loop(mode="auto", manual=0.3)]
    run = simulate(TANK, blocks, until=300, T_SP=42, auto=stepwise(0, {100: 1, 200: 0}))
    assert set(run["F_h"][:100]) == set(run["F_h"][200:]) == {0.3}
    assert run["F_h"][150] != 0.3
    kept = simulate(TANK, [one_loop(mode="auto")], until=300, T_SP=42, auto=stepwise(1, {200: 0}))
    assert set(kept["F_h"][200:]) == {kept["F_h"][199]}


def test_the_outer_loop_stops_integrating_at_the_inner_ones_limit():
    """A setpoint that the valve cannot reach: the way back takes much longer with an integral term that wound up."""

    def back(**windup):
        outer = Controller(PID(2, Ti=100), step=1, u0=46, **windup)
        inner = Controller(PID(0.05, Ti=60), step=1, u0=FLOW, limits=(0, 0.8), **windup)
        run = simulate(TANK, cascade(outer, inner), until=8000, T_SP=stepwise(60, {4000: 40}))
        assert run["F_h"][2000:4000].min() == 0.8, "the valve is at its limit"
        return abs(run["T_pm"][4000:] - 40).sum()

    assert back() < 0.6 * back(anti_windup=False)


def test_at_limit_says_which_way_the_setpoint_has_no_effect():
    for action, sign in (("reverse", 1), ("direct", -1)):
        loop = ControlLoop("C", Controller(PID(1), step=1, action=action, limits=(0, 10)), "r", "y", "u")
        assert loop.at_limit() == 0
        for u, way in ((10, 1), (0, -1), (5, 0)):
            loop.controller.u = u
            assert loop.at_limit() == way * sign


# ------------------------------------------------------------------------------------------------ other blocks


def test_a_slow_block_keeps_its_output_between_its_samples():
    slow = Controller(PID(0.02, Ti=400), step=30, u0=46)
    run = simulate(TANK, cascade(outer=slow), until=900, T_SP=41)
    assert run.times[1] == 1
    held = run["T_hSP"][:900].reshape(-1, 30)
    assert (held == held[:, :1]).all()
    assert len(set(held[:, 0])) == 30
    first = simulate(TANK, cascade(outer=slow), until=440, T_SP=41)
    second = simulate(TANK, cascade(outer=slow), until=900, T_SP=41, after=first)
    assert np.allclose(second["T_hSP"], run["T_hSP"])


def test_a_calculation_is_its_formula():
    K, q = sympy.symbols("K q_i")
    tank = LiquidTank(h_max=100)
    run = simulate(tank, [Calculation("q_o", K * q + 0.1)], until=10, step=1, K=stepwise(0.5, {5: 0.25}), q_i=0.4)
    assert np.allclose(run["q_o"], np.where(run.times < 5, 0.3, 0.2))
    with pytest.raises(ValueError, match=r"q_o = 1/K has no value at t = 3"):
        simulate(tank, [Calculation("q_o", 1 / K)], until=10, step=1, K=stepwise(1, {3: 0}))


def test_a_formula_may_have_signals_of_the_plant_and_letters_with_assumptions():
    K, h = sympy.Symbol("K", positive=True), LiquidTank().signal("h")
    block = Calculation("q", 2 * K * h + sympy.Symbol("K"))
    assert (block.reads, block.update({"K": 3, "h": 5}, 0)) == (("K", "h"), {"q": 33.0})


@pytest.mark.parametrize(
    ("formula", "value", "why"),
    [
        (sympy.cbrt(sympy.Symbol("x")), -1, "has no value at t = 0"),
        (sympy.I * sympy.Symbol("x"), 1, "has no value at t = 0"),
        (sympy.DiracDelta(sympy.Symbol("x")), 1, "has no value at t = 0"),
        (sympy.Function("x")(t).diff(t), 1, "signals of one moment"),
        (sympy.Function("x")(t - 3), 1, "signals of one moment"),
        ("x", 1, "type str"),
    ],
)
def test_a_formula_without_a_value_is_refused(formula, value, why):
    with pytest.raises(ValueError, match=why):
        Calculation("q", formula).update({"x": value}, 0)


def test_split_range_shares_one_signal_out():
    valves = SplitRange("u", {"q_i": ((50, 100), (0, 1)), "q_o": ((0, 50), (1, 0))})
    u = np.array([-10, 0, 25, 50, 75, 100, 120])
    openings = valves.openings(u)
    assert np.allclose(openings["q_o"], [1, 1, 0.5, 0, 0, 0, 0])
    assert np.allclose(openings["q_i"], [0, 0, 0, 0, 0.5, 1, 1])
    for n, value in enumerate(u):
        assert valves.update({"u": value}, 0) == {name: x[n] for name, x in openings.items()}
    loop = ControlLoop("LC1", Controller(PID(30, Ti=50), step=1, u0=50, limits=(0, 100)), "h_SP", "h", "u")
    run = simulate(LiquidTank(h_max=10), [loop, valves], until=1000, h_SP=stepwise(0.6, {500: 0.4}))
    assert (run["q_i"] * run["q_o"] == 0).all(), "never both"
    assert run["q_i"].max() > 0.01 < run["q_o"].max()
    assert abs(run["h"][[499, 1000]] - [0.6, 0.4]).max() < 0.02
    assert run.loop("LC1").unit("u") == run.unit("LC1.u_p") == "%"
    assert run.unit("LC1.measurement") == "m"


# ------------------------------------------------------------------------------------------------ what is refused


def refused(blocks, why, plant=TANK, **given):
    with pytest.raises(ValueError, match=why):
        simulate(plant, blocks, until=10, **given)


def test_what_does_not_fit_together_is_refused():
    T_SP, T_hm = sympy.symbols("T_SP T_hm")
    refused(cascade(), "TC1 reads T_SP, which nobody gives")
    refused(cascade()[::-1], "TC2 reads T_hSP, which TC1 writes: put TC1 first", T_SP=40)
    refused([one_loop(), one_loop()], "two blocks are called TC1", T_SP=40)
    refused([one_loop(), Calculation("F_h", T_SP / 100)], "both TC1 and F_h write F_h", T_SP=40)
    refused([one_loop(), Calculation("T_p", T_hm + 1)], "F_h|it is the plant that says", T_SP=40)
    refused(cascade(), "F_h is given, but it is a block that sets it", T_SP=40, F_h=1)
    refused(cascade(), "T_X is given, but no block reads it", T_SP=40, T_X=1)
    refused(cascade(), "setpoint is given, but there are several", setpoint=40)
    refused(cascade(), "manipulated is given", T_SP=40, manipulated="F_h")
    refused(cascade(), "noise is 1: expected", T_SP=40, noise=1)
    refused(cascade(), "noise has 'F_p'", T_SP=40, noise={"F_p": 1})
    refused(cascade(), "manual is", T_SP=40, manual={"LC7": [(0, 1, 2)]})
    refused(cascade(), "manual has", T_SP=40, manual={"TC1": [(3, 1, 2)]})
    refused(cascade(Controller(PID(1), step=1.5)), "TC1 runs every 1.5: expected a whole multiple", T_SP=40)
    refused([Calculation("F_h", T_SP / 100)], "the step is missing", T_SP=40)
    refused([3], "the structure has 3")
    named = ControlLoop("TC1", one_loop().controller, "setpoint", "T_pm", "F_h")
    refused([named], "TC1 reads setpoint, which is an argument of simulate", setpoint=40)
    outer, inner = cascade(mode="auto")
    switch = ControlLoop("X", Controller(PID(1), step=1), 1, "T_p", "auto")
    refused([outer, switch, inner], "TC1 reads auto, which X writes: put X first", T_SP=40)


def test_a_loop_between_a_signal_and_itself_has_its_unit():
    run = simulate(TANK, [ControlLoop("TC1", Controller(PID(1), step=1, u0=FLOW), "T_p", "T_p", "F_h")], until=3)
    assert run.unit("T_p") == "°C"


def test_what_makes_no_block_is_refused():
    controller = Controller(PID(1), step=1)
    for arguments in (("", controller, 1, "y", "u"), ("C", controller, [], "y", "u"), ("C", controller, 1, "a b", "u")):
        with pytest.raises(ValueError, match="expected a name"):
            ControlLoop(*arguments)
    with pytest.raises(ValueError, match="the controller is 7"):
        ControlLoop("C", 7, 1, "y", "u")
    for actuators in ({}, {"u": 3}, {"u": ((0, 0), (0, 1))}, {"u": ((0, 1), (1, 1))}):
        with pytest.raises(ValueError, match="expected"):
            SplitRange("v", actuators)


def test_a_run_without_blocks_has_no_loops():
    run = simulate(TANK, until=10, step=1)
    with pytest.raises(ValueError, match="the run has no loop 'TC1'"):
        run.loop("TC1")


def test_controllers_of_other_kinds_take_part_too():
    schedule = GainSchedule({0.2: PID(0.3, Ti=500), 0.5: PID(0.2, Ti=400)})
    controller = ScheduledController(schedule, step=1, u0=FLOW)
    loop = ControlLoop("TC1", controller, "T_SP", "T_pm", "F_h", scheduling="F_p")
    flow = stepwise(0.4, {300: 0.6})
    listed = simulate(TANK, [loop], until=600, T_SP=41, F_p=flow).loop("TC1")
    alone = simulate(TANK, controller, until=600, setpoint=41, scheduling=flow, F_p=flow)
    assert np.array_equal(listed["F_h"], alone["F_h"])
    assert listed["Kp"][0] != listed["Kp"][-1]
    with pytest.raises(ValueError, match="expected a signal for a gain schedule"):
        ControlLoop("TC1", controller, "T_SP", "T_pm", "F_h")
    with pytest.raises(ValueError, match="expected a signal for a gain schedule"):
        one_loop(scheduling="F_p")
    relay = ControlLoop("TC1", Relay(0.1, step=1, u0=FLOW), 40.5, "T_pm", "F_h")
    run = simulate(TANK, [relay], until=100)
    assert len(set(run["F_h"].round(9))) <= 2


def test_an_adaptive_controller_may_be_the_outer_one():
    outer = AdaptiveController(PID(2, Ti=400), step=1, delay=20, Tc=100, u0=46, limits=(20, 60))
    run = simulate(TANK, cascade(outer), until=300, T_SP=40.5)
    assert abs(run["T_pm"][-1] - 40.5) < 0.5
