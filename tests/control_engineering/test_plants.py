"""The plants: what is derived from a balance law is checked by a second derivation."""

import functools
import importlib
import inspect
import shutil
import types
from pathlib import Path

import numpy as np
import pytest
import sympy
from sympy.core.function import AppliedUndef

import contributing
from loopbook import plants, s, t
from loopbook.plants import (
    Balance,
    BlendingTank,
    HeatedTank,
    HeatedTankWithElement,
    HeatedTankWithTransport,
    JacketedTank,
    LiquidTank,
    MassSpringDamper,
    Plant,
    Process,
    RCCircuit,
    WoodChipTank,
    capacitor,
    delayed,
    inductor,
    measured,
    parameter,
    parameters,
    resistor,
    resistors_in_parallel,
    resistors_in_series,
    signal,
    signals,
)
from loopbook.plants.plant import _symbol
from loopbook.transfer import static_gain, transfer_functions
from plainmath.expressions import agreement

SHOWN = contributing.run("Add a plant", {name: getattr(plants, name) for name in plants.__all__})["Separator"]
PLANTS = [cls for _, cls in inspect.getmembers(plants, inspect.isclass) if issubclass(cls, Plant) and cls.quantities]
PLANTS.append(SHOWN)
named = pytest.mark.parametrize("cls", PLANTS, ids=lambda cls: cls.__name__)
made = functools.cache(lambda cls: cls())
regulates_itself = functools.cache(lambda cls: made(cls).is_self_regulating)


@named
@pytest.mark.daily(7)
def test_the_operating_point_is_a_steady_state(cls):
    plant = made(cls)
    rest = [plant.numbers(plant._in_constants(rate)) for rate in plant.state_equations().values()]
    assert rest == [0] * len(rest)
    outputs = {plants.name_of(x): plant.numbers(plant._in_constants(f)) for x, f in plant.measured.items()}
    assert outputs == {name: getattr(plant, name) for name in outputs}


@named
@pytest.mark.daily(9)
def test_where_a_plant_is_linear_its_transfer_functions_are_those_of_its_equations(cls):
    plant = made(cls)
    if not plant.is_linear():
        return
    directly = transfer_functions(list(plant.model), plant.output, plant.inputs)
    for x, H in zip(plant.inputs, directly, strict=True):
        assert agreement(plant.transfer_function(x), H) == "proved"


@named
@pytest.mark.daily(7)
def test_where_a_plant_regulates_itself_a_static_gain_is_the_slope_of_the_static_response(cls):
    plant = made(cls)
    if not regulates_itself(cls):
        return
    static = plant.static_response()
    output = plant._in_constants(plant.measured.get(plant.output, plant.output)).subs(static)
    for x in plant.inputs:
        slope = output.diff(_symbol(x)).subs(static)
        gain = static_gain(plant.numbers(plant.transfer_function(x)))
        assert sympy.simplify(plant.numbers(slope) - gain) == 0


@named
@pytest.mark.daily(5)
def test_a_plant_regulates_itself_if_all_its_modes_die_out(cls):
    """By the eigenvalues of the linear model, which are numbers; a level has one at zero."""
    plant = made(cls)
    if recycles(plant):
        return
    A = plant.numbers(plant.linear_model(plants.name_of(plant.states[0]))[0])
    assert regulates_itself(cls) is bool(max(np.linalg.eigvals(np.array(A, dtype=float)).real) < -1e-9)


def recycles(plant):
    """Whether a rate depends on a delayed state, of which no matrix says all."""
    return any(delayed_states(plant, rate) for rate in plant.state_equations().values())


def delayed_states(plant, formula):
    return {x for x in formula.atoms(AppliedUndef) if x.func(t) in plant.states and plant.numbers(t - x.args[0])}


@named
@pytest.mark.daily(3)
def test_the_linear_model_is_that_of_small_changes(cls):
    """Rates with one signal changed a little, numerically, against the matrices."""
    plant = made(cls)
    states, equations = plant.states, plant.state_equations()
    if late := delayed_states(plant, plant.measured.get(plant.output, plant.output)):
        with pytest.raises(ValueError, match="has the delayed state"):
            plant.linear_model()
    if recycles(plant):
        return
    output = plants.name_of(late.pop().func(t)) if late else None
    A, B, C, D = (np.array(plant.numbers(matrix), dtype=float) for matrix in plant.linear_model(output))
    at_rest = {x: sympy.Float(0 if x.is_Derivative else plant.values[x], 30) for x in [*states, *plant.inputs]}

    def rates(changed, change):
        values = at_rest | {changed: at_rest[changed] + change}
        for rate in equations.values():
            rate = plant.numbers(rate)
            late = {f: values[f.func(t)] for f in rate.atoms(AppliedUndef) if f not in values}
            yield rate.xreplace(values | late).evalf(30)  # two flows of 25 kg/s differ by little

    for column, among in ((A, states), (B, plant.inputs)):
        for n, x in enumerate(among):
            change = max(abs(at_rest[x]), 1) / 10**8  # of 30 digits, so that neither curvature nor rounding counts
            above, below = rates(x, change), rates(x, -change)
            slope = np.array([float((up - down) / (2 * change)) for up, down in zip(above, below, strict=True)])
            said = f"the linear model of {type(plant).__name__} by {x} is not its response to a small change"
            assert slope == pytest.approx(column[:, n], rel=1e-6, abs=1e-12), said
    assert (C.shape, D.shape) == ((1, len(states)), (1, len(plant.inputs)))


def test_no_matrices_describe_a_delayed_state():
    recycle = Process(1 / (s + 2 - sympy.exp(-s)))
    with pytest.raises(ValueError, match=r"Process has the delayed state x_1\(t - 1\): no matrices A, B describe it"):
        recycle.linear_model()
    assert Process(sympy.exp(-s) / (s + 2)).linear_model()[:2] == (sympy.Matrix([[-2]]), sympy.Matrix([[1, 1]]))
    assert HeatedTankWithTransport(tau=0).linear_model()[2] == sympy.Matrix([[1]])
    with pytest.raises(ValueError, match=r"has the delayed state T_1\(t - tau\): no matrix C .* or another output"):
        HeatedTankWithTransport().linear_model()
    assert HeatedTankWithTransport().linear_model("T_1")[0] == HeatedTankWithTransport(tau=0).linear_model()[0]


def test_two_balances_solved_by_hand():
    tank = JacketedTank()
    T_p, T_h, T_hin = (sympy.Function(name)(t) for name in ("T_p", "T_h", "T_hin"))
    in_numbers = [tank.numbers(equation) for equation in tank.model[:2]]
    constant = {x.func(t): value for x, value in tank.values.items() if not x.is_Symbol and x not in (T_p, T_h, T_hin)}
    balances = [sympy.Eq(equation.lhs, equation.rhs.subs(constant)) for equation in in_numbers]
    (H,) = transfer_functions(balances, T_p, [T_hin])
    assert agreement(tank.numbers(tank.transfer_function("T_hin")), H * sympy.exp(-10 * s)) == "proved"


def test_the_heating_element_puts_a_lag_in_front():
    with_element, without = HeatedTankWithElement(), HeatedTank()
    ratio = with_element.transfer_function("P") / without.transfer_function("P")
    assert sympy.simplify(ratio - 1 / (HeatedTankWithElement.T_h * s + 1)) == 0
    assert with_element.transfer_function("T_i") == without.transfer_function("T_i")


def test_an_insulated_tank_is_the_one_without_heat_loss():
    F, c, m = sympy.Symbol("F", real=True), HeatedTank.c, HeatedTank.m
    H = HeatedTank().transfer_function("P").subs(HeatedTank.U_h, 0)
    assert sympy.simplify(H - 1 / (c * F) / (m / F * s + 1)) == 0  # Haugen, equation (6.26)


def test_transport_delays_the_measurement_whatever_drives_it():
    tank = HeatedTankWithTransport()
    for x in tank.inputs:
        direct = tank.transfer_function(x, output="T_1")
        assert sympy.simplify(tank.transfer_function(x) - direct * sympy.exp(-tank.__class__.tau * s)) == 0


def test_the_blending_tank_is_linearised_at_its_operating_point():
    tank = BlendingTank(c_A=4, w_A=0.04)
    assert tank.numbers(tank.transfer_function("q")) == -4 / (2 * s + sympy.Rational(1, 100))


def test_a_scale_on_the_belt_changes_nothing_for_the_level():
    with_scale, without = plants.WoodChipTankWithScale(), WoodChipTank()
    for x in ("u", "w_out"):
        assert with_scale.numbers(with_scale.transfer_function(x)) == without.numbers(without.transfer_function(x))
    passing = with_scale.numbers(with_scale.transfer_function("d", "w_m"))
    assert sympy.simplify(passing - sympy.exp(-10 * s) / (5 * s + 1)) == 0


def test_a_heat_exchanger_at_rest_gives_one_side_what_it_takes_from_the_other():
    exchanger = plants.HeatExchanger()
    rest = {str(x): value for x, value in exchanger.static_response("T_p", "T_h", "u").items()}
    F_h, F_p, T_hin, T_pin = (sympy.Symbol(name, real=True) for name in ("F_h", "F_p", "T_hin", "T_pin"))
    assert sympy.simplify(F_p * (rest["T_p"] - T_pin) - F_h * (T_hin - rest["T_h"])) == 0
    a_quarter_of_the_pressure = plants.HeatExchanger(p=0.5, F_h=0.25)
    assert sympy.simplify(a_quarter_of_the_pressure.numbers(rest["u"])) == 50


def test_values_are_letters_of_the_class_and_numbers_of_the_object():
    tank = LiquidTank(A=2.5)
    assert (LiquidTank.A, tank.A, tank.h_max) == (sympy.Symbol("A", positive=True), sympy.Rational(5, 2), 1)
    assert repr(tank) == "LiquidTank(A=2.5, h_min=0, h_max=1, q_i=0, q_o=0, h=0.5)"
    assert "cross-sectional area" in tank._repr_html_()
    Process(1 / (s + 1))
    assert (Process.model, Process.quantities) == ((), {})  # of the class


def test_the_docstring_has_a_table_of_the_quantities():
    assert "    U_h: heat transfer coefficient to the environment, 160 W/K\n" in HeatedTank.__doc__
    assert "    T: temperature at the sensor, measured in °C\n" in HeatedTankWithTransport.__doc__
    assert "    R: rangeability of the valve, its largest flow over its smallest, 49\n" in plants.HeatExchanger.__doc__


def test_what_kind_of_plant_it_is_follows_from_its_laws():
    names = {cls.__name__ for cls in PLANTS if made(cls).is_linear()}
    assert names >= {"AirHeater", "BufferTank", "LiquidTank", "MassSpringDamper", "MotorWithLoad", "RCCircuit"}
    assert not names & {"BatchTank", "BlendingTank", "HeatExchanger", "HeatedTank", "FlashPlant"}
    levels = {cls.__name__ for cls in PLANTS if not regulates_itself(cls)}
    assert levels >= {
        "AmmoniaEvaporator", "BatchTank", "BufferTank", "FlashPlant", "LiquidTank", "MotorWithLoad",
        "TwoStageSeparator", "WoodChipTank", "WoodChipTankWithScale",
    }  # fmt: skip
    assert not levels & {"AirHeater", "BlendingTank", "HeatExchanger", "HeatedTank", "MassSpringDamper", "RCCircuit"}
    assert not MassSpringDamper(D=0).is_self_regulating
    assert HeatedTank().is_linear("P")
    assert not HeatedTank().is_linear("F")
    assert plants.HeatExchanger().is_linear("T_hin")
    assert not plants.HeatExchanger().is_linear("u")
    assert not plants.BatchTank().is_linear("u_valve_in")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"B": 1}, "has no 'B'"),
        ({"A": -1}, "A is -1"),
        ({"A": sympy.oo}, "A is oo"),
        ({"A": "1"}, "A is '1': expected a number"),
        ({"h": 5}, "h is 5: expected a value from 0 to 1"),
        ({"h_max": 0}, "h is 0.5: expected a value from 0 to 0"),
    ],
)
def test_values_that_are_none(wrong, message):
    with pytest.raises(ValueError, match=message):
        LiquidTank(**wrong)


def test_a_measured_signal_follows_from_the_others():
    assert HeatedTankWithTransport(T_1=35).T == 35
    assert float(plants.AirHeater(T_rise=7, u=2).T) == 21.5 + 7
    with pytest.raises(ValueError, match="T is not given but measured: it is T_1"):
        HeatedTankWithTransport(T=10)


def test_a_plant_does_not_change():
    tank = HeatedTank()
    with pytest.raises(ValueError, match=r"make another plant, HeatedTank\(P=5000\)"):
        tank.P = 5000
    assert tank.P == 10000


def test_questions_that_a_plant_cannot_answer():
    tank = LiquidTank()
    with pytest.raises(ValueError, match="do not determine h"):
        tank.static_response()
    with pytest.raises(ValueError, match="is not an input: expected one of q_i, q_o"):
        tank.transfer_function("h")
    with pytest.raises(ValueError, match="'x' is not a signal"):
        tank.transfer_function("x")
    with pytest.raises(ValueError, match="is an input"):
        tank.transfer_function("q_i", output="q_o")
    for name in ("A", LiquidTank.A):
        with pytest.raises(ValueError, match="is not a signal of LiquidTank"):
            tank.signal(name)


# What is forgotten in a class.


def declared(**body):
    """A class with these attributes, declared one after the other; functions are called with what is there."""

    def fill(names):
        for name, value in body.items():
            names[name] = value(types.SimpleNamespace(**names)) if inspect.isfunction(value) else value

    return types.new_class("Tank", (Plant,), exec_body=fill)


TANK = {
    "A": parameter(2, "m²", "area"),
    "q": signal(0.1, "m³/s", "inflow"),
    "h": signal(1, "m", "level"),
    "volume": lambda tank: Balance(tank.A * tank.h, tank.q),
    "output": lambda tank: tank.h,
    "manipulated": lambda tank: tank.q,
}
FORGOTTEN = {
    "nothing": ({}, None),
    "a unit": ({"h": signal(1, "", "level")}, r"Tank.h has the unit '' and the meaning 'level': expected both"),
    "all laws": ({"volume": 3}, "Tank has no law: expected a Balance or a Lag for each state"),
    "an operating point": ({"h": signal(None, "m", "level")}, r"Tank.h has no value: .* at the operating point"),
    "a value that is none": ({"A": parameter("2", "m²", "area")}, "Tank.A: '2' is of type str"),
    "a parameter": (
        {"volume": lambda tank: Balance(tank.A * tank.h, sympy.Symbol("K") * tank.q)},
        r"Tank: volume contains K, which is not declared: expected K = parameter\(...\)",
    ),
    "a signal": (
        {"volume": lambda tank: Balance(tank.A * tank.h, tank.q - sympy.Function("q_o")(t))},
        r"Tank: volume contains q_o\(t\), which is not declared: expected q_o = signal\(...\)",
    ),
    "what it is for": ({"B": parameter(1, "m", "width")}, "Tank declares B, which no law contains"),
    "a law": (
        {"c": signal(1, "1", "share"), "volume": lambda tank: Balance(tank.A * tank.h * tank.c, tank.q)},
        "Tank has 1 laws for the states h, c: expected one for each",
    ),
    "that all instances have values": ({"values": signal(1, "1", "ratio")}, "every plant has a 'values'"),
    "the output": ({"output": None}, "Tank names no output: expected output = h"),
    "what is manipulated": ({"manipulated": lambda tank: tank.h}, r"Tank has h\(t\) for manipulated: .* one of q"),
    "that a measured signal is none of the laws'": (
        {
            "L": lambda tank: measured(50 * tank.h, "%", "level"),
            "volume": lambda tank: Balance(tank.A * tank.h, tank.q - tank.L),
        },
        r"Tank: volume contains L, which is measured: expected 50\*h",
    ),
    "that a content is one of now": (
        {"volume": lambda tank: Balance(tank.A * (tank.h + delayed(tank.h, 2)), tank.q)},
        "Tank: volume has a delayed rate of change",
    ),
    "what a measured signal was when it is delayed": (
        {
            "h_m": lambda tank: measured(delayed(tank.h, 2), "m", "measured level"),
            "volume": lambda tank: Balance(tank.A * tank.h, tank.q - delayed(tank.h_m, 5)),
        },
        r"Tank: volume contains delayed\(h_m, 5\), which is measured: expected delayed\(h, 7\)$",
    ),
    "that the output is not a text": ({"output": "h"}, "Tank: output is the text 'h': expected the signal h"),
    "that the text is not a name": ({"manipulated": "u"}, "Tank: manipulated is the text 'u': expected one of q"),
    "any quantity": (
        dict.fromkeys("Aqh", None) | {"volume": Balance(*signals("h q"))},
        r"Tank: volume contains h\(t\), which is not declared: expected h = signal\(...\)",
    ),
    "an input": (
        {"q": parameter(0, "m³/s", "inflow"), "manipulated": lambda tank: tank.q},
        "Tank has q for manipulated: no signal of its laws could be one",
    ),
    "the order of limits": (
        {"h": signal(2, "m", "level", limits=(3, 1))},
        r"Tank: the limits of h are \(3, 1\): expected the lower one first",
    ),
    "what is at work": (
        {"at_work": lambda tank: {tank.A: 3}},
        "Tank is at work by A, which is neither an input nor a state: expected one of q, h",
    ),
    "that a limit is one of a state": (
        {"q": signal(0.1, "m³/s", "inflow", limits=(0, 1))},
        r"Tank has limits for q\(t\), which is not a state: expected one of h",
    ),
}


@pytest.mark.parametrize("what", FORGOTTEN)
def test_what_is_forgotten_is_said_in_one_sentence_at_once(what):
    changes, message = FORGOTTEN[what]
    body = {name: changes.pop(name, value) for name, value in TANK.items()}
    names = list(body)
    order = [*names[:3], *changes, *names[3:]]
    body = {name: (body | changes)[name] for name in order}
    if message is None:
        assert declared(**body)().transfer_function() == 1 / (declared(**body).A * s)
        return
    with pytest.raises(ValueError, match=message) as caught:
        declared(**body)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (lambda h, q: Balance("A*h", q), r"the content of a balance is 'A\*h': expected a formula of signals"),
        (lambda h, q: Balance(h, lambda: q), "the inflow of a balance is <function .*: expected a formula of signals"),
        (lambda h, q: types.SimpleNamespace(of=measured("2*h")), r"what is measured is '2\*h': expected a formula"),
        (lambda h, q: delayed("h", 5), "what is delayed is 'h': expected a formula of signals"),
        (lambda h, q: delayed(h, "5"), "the delay is '5': expected a number or an expression"),
    ],
)
def test_a_law_is_a_formula(law, message):
    with pytest.raises(ValueError, match=message):
        law(*signals("h q"))


def test_laws_of_another_sort_do_not_add_up():
    x, u = signals("x u")
    with pytest.raises(TypeError, match=r"unsupported operand .* 'Balance' and 'Lag'"):
        Balance(x, u) + plants.Lag(x, u, 2)
    assert (Balance(x, 0) + Balance(u, 1)).inflow == 1


def test_a_new_module_with_a_plant_is_found(tmp_path, monkeypatch):
    """In a copy of the package, since modules that are imported stay."""
    shutil.copytree(Path(plants.__file__).parent, tmp_path / "copied", ignore=shutil.ignore_patterns("__pycache__"))
    new = Path(plants.__file__).with_name("separators.py").read_text(encoding="utf-8").replace("TwoStage", "ThirdStage")
    (tmp_path / "copied" / "third.py").write_text(new, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    copied = importlib.import_module("copied")
    assert issubclass(copied.ThirdStageSeparator, Plant)
    assert sorted(copied.__all__) == sorted([*plants.__all__, "ThirdStageSeparator"])


def test_the_plant_that_contributors_are_shown_is_one():
    separator = SHOWN()
    assert separator.numbers(separator.transfer_function("q_i", "h")) == sympy.exp(-20 * s) / (2 * s)
    assert separator.p == sympy.Rational("9.81")
    assert "    gamma: weight of the water, 9.81 kN/m³\n" in separator.__doc__


def test_a_name_is_declared_once_and_in_a_class_statement():
    with pytest.raises(ValueError, match=r"Twice\.A is declared twice"):

        class Twice(Plant):
            A = parameter(2, "m²", "area")
            A = parameter(3, "m²", "area")

    with pytest.raises(ValueError, match=r"Tank is made by type\(\): expected a class statement"):
        type("Tank", (Plant,), {})


def test_a_class_may_declare_again_what_it_extends():
    class Wide(LiquidTank):
        A = parameter(7, "m²", "cross-sectional area")

    assert list(Wide.quantities) == list(LiquidTank.quantities)
    assert (Wide().A, Wide.volume, Wide().h_max) == (7, LiquidTank.volume, 1)
    with pytest.raises(ValueError, match="WoodChipTank has no 'B': expected one of rho, A"):
        WoodChipTank.declared("rho B")


def test_a_sum_of_balances_is_no_law_of_its_own():
    tank = plants.WoodChipTankWithScale
    assert set(tank.balances) == {"mass", "mass in the tank", "mass on the belt"}
    assert tank.mass.parts == (tank.mass_in_the_tank, tank.mass_on_the_belt)
    assert len(tank.model) == 3
    w_in = tank.K_s * tank.u + tank.d
    assert sympy.expand(tank.mass.inflow - (w_in - tank.w_out)) == 0
    assert plants.JacketedTank.energy.inflow.has(plants.JacketedTank.U_hp) is False


# A given transfer function.


@pytest.mark.parametrize(
    "H",
    [
        1 / s,
        (2 * s + 1) / (s**2 + 3 * s + 2),
        -5 * (s - 1) * sympy.exp(-s / 2) / ((s + 1) * (s + 2) * (s + 3)),
        1 / s + sympy.exp(-s) / s,
        (2 + 3 * s * sympy.exp(-s) - 5 * sympy.exp(-2 * s)) / (s**2 + 3 * s + 2),
        (s + 1) / (s * (s + 2) - (s + 1) * sympy.exp(-sympy.Rational(3, 2) * s) / 2),
        sympy.exp(-s) * (1 + sympy.exp(-s / 3)) / (4 * s + 1 - sympy.exp(-2 * s) / 4 + sympy.exp(-5 * s) / 8) ** 2,
    ],
)
def test_a_process_has_the_transfer_function_that_it_was_given(H):
    process = Process(H)
    for x in ("u", "d"):
        assert agreement(process.transfer_function(x), sympy.sympify(H)) == "proved"


@pytest.mark.parametrize(
    ("H", "message"),
    [
        (sympy.Symbol("K") / s, "a number for K"),
        (s / (s + 1), "not strictly proper"),
        (1 / (s + 1 + s * sympy.exp(-s) / 2), "delays the highest power of s in its denominator"),
        ("1/s", "expected"),
        (sympy.S.Zero, "is 0"),
        (1 / (s + sympy.I), "complex"),
    ],
)
def test_what_cannot_be_simulated(H, message):
    with pytest.raises(ValueError, match=message):
        Process(H)


# Circuits.


def test_resistors_from_kirchhoffs_laws():
    R_1, R_2, I = parameters("R_1 R_2 I")
    v, i_1, i_2 = signals("v i_1 i_2")
    one_after_the_other = resistor(v, I, R_1).rhs + resistor(v, I, R_2).rhs
    assert sympy.simplify(one_after_the_other / I - resistors_in_series(R_1, R_2)) == 0
    side_by_side = sympy.solve([resistor(v, i_1, R_1), resistor(v, i_2, R_2), sympy.Eq(i_1 + i_2, I)], [v, i_1, i_2])
    assert sympy.simplify(side_by_side[v] / I - resistors_in_parallel(R_1, R_2)) == 0
    assert resistors_in_parallel(R_1, R_2) == R_1 * R_2 / (R_1 + R_2)  # equation (3.37)
    assert resistors_in_parallel(3, 6, 2) == 1


def test_the_circuit_follows_from_its_components():
    v_R, i = signals("v_R i")
    R, C, v_in, v_out = RCCircuit.R, RCCircuit.C, RCCircuit.v_in, RCCircuit.v_out
    loop = sympy.Eq(-v_in + v_R + v_out, 0)  # equation (3.43)
    (H,) = transfer_functions([loop, resistor(v_R, i, R), capacitor(v_out, i, C)], v_out, [v_in])
    assert agreement(H, RCCircuit().transfer_function()) == "proved"


def test_an_inductor_and_a_resistor_make_a_lag():
    v, v_L, i = signals("v v_L i")
    R, L = parameters("R L")
    equations = [sympy.Eq(v, v_L + resistor(v, i, R).rhs), inductor(v_L, i, L)]
    (H,) = transfer_functions(equations, i, [v])
    assert agreement(H, 1 / (R * (L / R * s + 1))) == "proved"
