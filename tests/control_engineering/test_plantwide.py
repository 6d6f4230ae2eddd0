"""The plant of Figure 11.17 with all its loops, and with one of them wrong; the ammonia evaporator of Example 11.6."""

import functools

import numpy as np
import pytest
import sympy

from draws import of_the_day
from loopbook import s
from loopbook.approximation import half_rule
from loopbook.laplace import evaluate
from loopbook.pid import PID, Controller
from loopbook.plants import AmmoniaEvaporator, Balance, FlashPlant, Plant, parameter, signal
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.structures import Calculation, ControlLoop, controller_action
from loopbook.transfer import step_response
from loopbook.tuning import simc
from test_balances import imbalances, with_totals

ENDS = {
    "FC1": ("u_A", "F_A"),
    "FC2": ("u_B", "F_B"),
    "LC1": ("u_1", "L_1"),
    "LC2": ("u_2", "L_2"),
    "LC3": ("u_3", "L_3"),
    "LC4": ("u_4", "L_4"),
    "PC1": ("u_V", "p_4"),
    "TC1": ("u_h", "T_x"),
}
ACTIONS = {tag: "direct" if tag in ("LC3", "LC4", "PC1") else "reverse" for tag in ENDS}
OTHER = {"direct": "reverse", "reverse": "direct"}
T_C = {"F": 10, "P": 15, "T": 30, "L": 60}
CALM = {"K": 0.6, "F_SP": 5, "T_SP": 155}


FLASH, EVAPORATOR = FlashPlant(), AmmoniaEvaporator()


@functools.cache
def transfer_function(tag):
    return FLASH.transfer_function(*ENDS[tag], numbers=True)


@functools.cache
def settings(tag):
    found = simc(half_rule(transfer_function(tag)), T_C[tag[0]], c=2)
    return PID(abs(found.Kp), found.Ti)


def loop(tag, action):
    u, y = ENDS[tag]
    controller = Controller(settings(tag), 5, u0=getattr(FLASH, u), limits=(0, 100), action=action)
    given = {"FC1": "F_SP", "FC2": "F_BSP", "TC1": "T_SP"}
    return ControlLoop(tag, controller, given.get(tag, float(getattr(FLASH, y))), y, u)


def structure(actions=ACTIONS):
    K, F_A = sympy.symbols("K F_A")
    return [Calculation("F_BSP", K * F_A), *(loop(tag, action) for tag, action in actions.items())]


@functools.cache
def balanced(cls):
    """The plant with the totals of its balances, compiled once."""
    return with_totals(cls)()


CONTENTS = ("m_1", "m_2", "m_3", "m_4", "m_V", "a_1", "a_3", "a_4", "E_3", "E_x", "E_4")


def physical(run):
    """Nothing is negative, no vessel holds more than fits, A is a part of the liquid, and no water freezes or melts."""
    assert all(run[name].min() >= 0 for name in CONTENTS)
    assert all(run[f"O_{n}"].min() >= 0 for n in (1, 2, 3, 4, "V"))
    assert all(run[f"L_{n}"].max() < 105 for n in (1, 2, 3, 4))
    for n in (1, 3, 4):
        assert np.all(run[f"a_{n}"] <= run[f"m_{n}"])
    assert run["T_3"].min() > 24.9
    assert max(run["T_x"].max(), run["T_4"].max()) < 185.001


@pytest.mark.parametrize("tag", ENDS)
def test_the_action_of_every_controller(tag):
    assert controller_action(transfer_function(tag)) == ACTIONS[tag]


def test_the_transfer_functions_of_the_levels_in_letters():
    tau, k_1, k_3, M_1, M_3 = (getattr(FlashPlant, name) for name in ("tau", "k_1", "k_3", "M_1", "M_3"))
    p_1 = sympy.Symbol("p_1", real=True)
    by_hand = 100 * k_1 * sympy.sqrt(p_1) / (M_1 * s * (tau * s + 1)), -100 * k_3 / (M_3 * s * (tau * s + 1))
    for (u, y), H in zip((ENDS["LC1"], ENDS["LC3"]), by_hand, strict=True):
        assert sympy.simplify(FLASH.transfer_function(u, y) - H) == 0


@pytest.mark.parametrize(
    ("plant", "source", "output", "change"),
    [
        (FLASH, "u_V", "p_4", 3e-3),
        (FLASH, "u_4", "L_4", 3e-3),
        (FLASH, "u_B", "x_4", 3e-3),
        (FLASH, "u_h", "T_x", 3e-3),
        (EVAPORATOR, "u_2", "p", 3e-3),
        (EVAPORATOR, "u_1", "L", 3e-3),
        (EVAPORATOR, "u_3", "F_G", 3e-3),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)
@pytest.mark.daily(2)
def test_a_small_step_is_the_one_of_the_transfer_function(plant, source, output, change):
    """A step small enough for the linear model, and large enough for the accuracy of the integration."""
    from scipy.signal import lti, step

    numerator, denominator = sympy.fraction(sympy.cancel(plant.transfer_function(source, output, numbers=True)))
    coefficients = [[float(c) for c in sympy.Poly(x, s).all_coeffs()] for x in (numerator, denominator)]
    times = np.arange(0, 151, 5.0)
    _, expected = step(lti(*coefficients), T=times)
    run = simulate(plant, until=150, step=5, **{source: getattr(plant, source) + change})
    moved = (run[output] - float(getattr(plant, output))) / change
    assert abs(moved - expected).max() < 1e-3 * abs(expected).max()


def test_all_loops_come_to_rest_after_every_excitation():
    """Production rate, ratio, strength and temperature of the feeds, pressure of the supply, temperature setpoint."""
    run = simulate(
        balanced(FlashPlant),
        structure(),
        until=2400,
        F_SP=stepwise(5, {60: 6}),
        K=stepwise(0.6, {180: 0.65}),
        x_A=stepwise(0.38, {300: 0.36}),
        T_B=stepwise(25, {420: 35}),
        p_1=stepwise(4, {540: 3.5}),
        T_SP=stepwise(155, {660: 158}),
    )
    physical(run)
    assert max(imbalances(run)) < 1e-9
    for tag in ENDS:
        seen = run.loop(tag)
        assert seen["measurement"][-1] == pytest.approx(seen["setpoint"][-1], rel=1e-5), tag
        u = run[ENDS[tag][0]]
        assert not {u.min(), u.max()} & {0.0, 100.0}, f"{tag} at a limit"
    assert abs(np.array([run[f"L_{n}"] for n in (1, 2, 3, 4)]) - 50).max() < 5
    assert run["x_4"][-1] < 24
    assert abs(run["F_B"][-1] - 0.65 * 6) < 1e-4


WRONG = {  # the loop, and what becomes of the plant
    ("LC1", 1): {"L_1": "empty"},
    ("LC1", -1): {"L_1": "full"},
    ("LC2", 1): {"L_2": "empty"},
    ("LC2", -1): {"L_2": "full"},
    ("LC3", 1): {"L_3": "full", "F_4": "none"},
    ("LC3", -1): {"L_3": "empty"},
    ("LC4", 1): {"L_4": "full", "F_4": "none"},
    ("LC4", -1): {"L_4": "empty"},
    ("PC1", 1): {"p_4": "relief"},
    ("PC1", -1): {"p_4": "low"},
    ("TC1", 1): {},
    ("TC1", -1): {},
    ("FC1", 1): {"F_A": "none", "F_4": "none"},
    ("FC1", -1): {"u_A": "open"},
    ("FC2", 1): {"F_B": "none"},
    ("FC2", -1): {"u_B": "open"},
}
SIGNS = {
    "empty": lambda x: x[-1] < 5,
    "full": lambda x: x[-1] > 100,
    "none": lambda x: x[-1] < 0.01,
    "relief": lambda x: x[-1] > 4,
    "low": lambda x: x[-1] < 2.3,
    "open": lambda x: x[-1] == 100,
}


@pytest.mark.parametrize(("tag", "nudge"), WRONG)
@pytest.mark.daily(2)
def test_one_wrong_sign_and_nothing_is_lost(tag, nudge):
    rate = stepwise(5, {60: 5 + 0.05 * nudge})
    blocks = structure(ACTIONS | {tag: OTHER[ACTIONS[tag]]})
    run = simulate(balanced(FlashPlant), blocks, until=2400, **(CALM | {"F_SP": rate}))
    physical(run)
    assert max(imbalances(run)) < 1e-9
    u = run[ENDS[tag][0]]
    assert {u.min(), u.max()} & {0.0, 100.0}, "the wrong controller drives its valve to a limit"
    for name, fate in WRONG[tag, nudge].items():
        assert SIGNS[fate](run[name]), (name, run[name][-1])


def test_with_no_control_at_all_vessels_run_dry_and_over():
    plant = balanced(FlashPlant)
    run = simulate(plant, until=7200, step=20, u_1=0, u_B=80, u_3=0, u_h=100, u_V=0)
    physical(run)
    assert run["L_1"][-1] == pytest.approx(100 / 3000 * 20, abs=1e-3), "what lies below the suction pipe stays"
    assert run["O_2"][-1] == 0
    assert run["O_3"].max() > 1
    assert run["F_A"][-1] < 1e-3
    assert max(imbalances(run)) < 1e-9


@pytest.mark.parametrize("valves", [{"u_1": 0}, {"u_1": 100}, {"u_2": 0}, {"u_2": 100, "u_3": 0}], ids=str)
def test_the_evaporator_loses_nothing_at_its_limits(valves):
    run = simulate(balanced(AmmoniaEvaporator), until=3600, step=10, **valves)
    assert max(imbalances(run)) < 1e-9
    assert min(run["m"].min(), run["m_G"].min()) > 0
    assert run["L"].max() < 105


def test_the_controllers_of_the_evaporator_act_in_reverse():
    for ends in (("u_1", "L"), ("u_2", "p"), ("u_3", "F_G")):
        assert controller_action(EVAPORATOR.transfer_function(*ends, numbers=True)) == "reverse"


# What such plants need of `Plant`.


class Overflowing(Plant):
    """A vessel with a rim."""

    k = parameter(0.5, "1/s", "overflow for each kilogram above the rim")
    M = parameter(10, "kg", "mass up to the rim")
    F = signal(0, "kg/s", "inflow")
    m = signal(5, "kg", "mass")
    mass = Balance(m, F - k * sympy.Max(0, m - M))
    output, manipulated = m, F


def test_a_limit_counts_where_the_plant_stands():
    k = Overflowing.k
    assert Overflowing().transfer_function() == 1 / s
    assert sympy.simplify(Overflowing(m=12, F=1).transfer_function() - 1 / (s + k)) == 0
    assert Overflowing(m=12, F=1).linear_model()[0] == sympy.Matrix([[-k]])
    run = simulate(Overflowing(m=12, F=1), until=10, step=1, F=2)
    assert abs(run["m"] - 12 - evaluate(step_response(1 / (s + sympy.Rational(1, 2))), run.times)).max() < 1e-6


def test_balances_with_a_limit_are_solved_for_their_rates():
    class Mixed(Plant):
        F = signal(0, "kg/s", "inflow")
        m, T = signal(5, "kg", "mass"), signal(20, "°C", "temperature")
        out = sympy.Max(0, m - 4)
        energy = Balance(2 * m * T, 3 * F - 2 * out * T)
        mass = Balance(m, F - out)
        output, manipulated = T, F

    m_rate, T_rate = Mixed().state_equations().values()
    assert m_rate == Mixed.F - Mixed.out
    assert sympy.simplify(T_rate - (3 * Mixed.F - 2 * Mixed.F * Mixed.T) / (2 * Mixed.m)) == 0

    class Coupled(Mixed):
        mass = Balance(Mixed.m + Mixed.T, Mixed.F - Mixed.out)

    with pytest.raises(ValueError, match="expected one rate alone on its left side"):
        Coupled().state_equations()


def test_numbers_first_is_the_same_as_numbers_afterwards():
    from loopbook.plants import HeatExchanger, JacketedTank, MassSpringDamper, WoodChipTank

    for plant in (HeatExchanger(), JacketedTank(), MassSpringDamper(), WoodChipTank()):
        for x in of_the_day([*plant.inputs], 1, type(plant)):
            afterwards = plant.numbers(plant.transfer_function(x))
            assert sympy.simplify(plant.transfer_function(x, numbers=True) - afterwards) == 0
