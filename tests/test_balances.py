"""What flows in and does not flow out is in the plant: by the equations, and by what the simulation does with them."""

import inspect

import numpy as np
import pytest
import sympy

from loopbook import plants, t
from loopbook.plants import Plant, name_of
from loopbook.simulation import simulate

BALANCED = [cls for _, cls in inspect.getmembers(plants, inspect.isclass) if issubclass(cls, Plant) and cls.balances]
EVERY = [(cls, name) for cls in BALANCED for name in cls.balances]
every = pytest.mark.parametrize(("cls", "name"), EVERY, ids=[f"{cls.__name__}-{name}" for cls, name in EVERY])


def test_the_plants_of_the_control_structures_have_balances():
    assert {"BufferTank", "JacketedTank", "LiquidTank", "HeatedTank"} <= {cls.__name__ for cls in BALANCED}


def rate_of_change(plant, content):
    equations = plant.state_equations()
    return sympy.Add(*(content.diff(x) * rate for x, rate in equations.items()))


@every
def test_the_equations_say_so(cls, name):
    content, inflow = cls.balances[name]
    assert sympy.simplify(rate_of_change(cls(), content) - inflow) == 0


def with_total(cls, inflow):
    """The plant with one more state: what has flowed in since the beginning."""
    total = sympy.Function("total")(t)
    quantities = cls.quantities | {total: (0, "1", "what has flowed in")}
    body = {"model": (*cls.model, sympy.Eq(total.diff(t), inflow)), "quantities": quantities}
    return type(cls.__name__, (cls,), body)


# Plants without any flow at their own operating point.
FLOWS = {
    plants.LiquidTank: {"q_i": 0.001, "q_o": 0.001},
    plants.BufferTank: {"F_in": 3, "F_out": 3},
    plants.BatchTank: {"h": 0.9, "u_valve_in": 1, "u_valve_out": 0.5, "u_heat": 50, "u_motor": 1},
}


@every
def test_a_run_gains_and_loses_nothing(cls, name):
    """All inputs jump at random every 20 s."""
    content, inflow = cls.balances[name]
    plant = with_total(cls, inflow)(**FLOWS.get(cls, {}))
    dice = np.random.default_rng(7)
    jumps = {
        name_of(x): float(plant.values[x]) * (1 + 0.1 * np.repeat(dice.uniform(-1, 1, 31), 4)[:121])
        for x in plant.inputs
    }
    run = simulate(plant, until=600, step=5, **jumps)
    states = [x for x in plant.states if not x.is_Derivative]
    stored = sympy.lambdify(states, plant.numbers(content), "numpy")(*(run[name_of(x)] for x in states))
    assert np.ptp(stored) > 1e-4 * abs(stored).max(), "something happens"
    assert abs(stored - stored[0] - run["total"]).max() < 1e-9 * abs(stored).max()
