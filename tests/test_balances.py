"""What flows in and does not flow out is in the plant: by the equations, and by what the simulation does with them."""

import functools
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


def with_totals(cls):
    """The plant with one more state for each of its balances: what has flowed in since the beginning."""
    body = {"model": cls.model, "quantities": dict(cls.quantities)}
    for n, (_, inflow) in enumerate(cls.balances.values()):
        total = sympy.Function(f"total_{n}")(t)
        body["model"] = (*body["model"], sympy.Eq(total.diff(t), inflow))
        body["quantities"][total] = (0, "1", "what has flowed in")
    return type(cls.__name__, (cls,), body)


@functools.cache
def contents(plant):
    """The names of the states, and for each balance the content as a program."""
    states = [x for x in plant.states if not (x.is_Derivative or name_of(x).startswith("total"))]
    programs = [sympy.lambdify(states, plant.numbers(content), "numpy") for content, _ in plant.balances.values()]
    return [name_of(x) for x in states], programs


def stored(run):
    """For each balance what the plant holds, at each sample."""
    names, programs = contents(run.plant)
    return [program(*(run[name] for name in names)) for program in programs]


def imbalances(run):
    """For each balance the largest difference between content and inflow, as a part of the content."""
    return [abs(held - held[0] - run[f"total_{n}"]).max() / abs(held).max() for n, held in enumerate(stored(run))]


# Plants without any flow at their own operating point.
FLOWS = {
    plants.LiquidTank: {"q_i": 0.001, "q_o": 0.001},
    plants.BufferTank: {"F_in": 3, "F_out": 3},
    plants.BatchTank: {"h": 0.9, "u_valve_in": 1, "u_valve_out": 0.5, "u_heat": 50, "u_motor": 1},
}


@pytest.mark.parametrize("cls", BALANCED, ids=lambda cls: cls.__name__)
def test_a_run_gains_and_loses_nothing(cls):
    """All inputs jump at random every 20 s."""
    plant = with_totals(cls)(**FLOWS.get(cls, {}))
    dice = np.random.default_rng(7)
    jumps = {
        name_of(x): float(plant.values[x]) * (1 + 0.1 * np.repeat(dice.uniform(-1, 1, 31), 4)[:121])
        for x in plant.inputs
    }
    run = simulate(plant, until=600, step=5, **jumps)
    assert min(np.ptp(held) / abs(held).max() for held in stored(run)) > 1e-4, "something happens"
    assert max(imbalances(run)) < 1e-9
