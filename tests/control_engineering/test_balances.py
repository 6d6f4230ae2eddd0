"""What flows in and does not flow out is in the plant: by the equations, and by what the simulation does with them."""

import functools
import inspect
import types

import numpy as np
import pytest
import sympy

from loopbook import plants
from loopbook.plants import Balance, Plant, name_of, signal
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
@pytest.mark.daily(8)
def test_the_equations_say_so(cls, name):
    balance = cls.balances[name]
    assert sympy.simplify(rate_of_change(cls(), balance.content) - balance.inflow) == 0


def with_totals(cls):
    """The plant with one more state for each of its balances: what has flowed in since the beginning."""

    def body(declared):
        for n, balance in enumerate(cls.balances.values()):
            declared[f"total_{n}"] = signal(0, "1", "what has flowed in")
            declared[f"sum_{n}"] = Balance(declared[f"total_{n}"], balance.inflow)

    return types.new_class(cls.__name__, (cls,), exec_body=body)


@functools.cache
def contents(plant):
    """The names of the states, and for each balance the content as a program."""
    states = [x for x in plant.states if not name_of(x).startswith("total")]
    balances = [balance for name, balance in plant.balances.items() if not name.startswith("sum ")]
    programs = [sympy.lambdify(states, plant.numbers(balance.content), "numpy") for balance in balances]
    return [name_of(x) for x in states], programs


def stored(run):
    """For each balance what the plant holds, at each sample."""
    names, programs = contents(run.plant)
    return [program(*(run[name] for name in names)) for program in programs]


def imbalances(run):
    """For each balance the largest difference between content and inflow, as a part of the content."""
    return [abs(held - held[0] - run[f"total_{n}"]).max() / abs(held).max() for n, held in enumerate(stored(run))]


@pytest.mark.parametrize("cls", BALANCED, ids=lambda cls: cls.__name__)
@pytest.mark.daily(4)
def test_a_run_gains_and_loses_nothing(cls):
    """All inputs jump at random every 20 s."""
    plant = with_totals(cls)(**{name_of(x): value for x, value in cls.at_work.items()})
    dice = np.random.default_rng(7)
    jumps = {
        name_of(x): float(plant.values[x]) * (1 + 0.1 * np.repeat(dice.uniform(-1, 1, 31), 4)[:121])
        for x in plant.inputs
    }
    run = simulate(plant, until=600, step=5, **jumps)
    assert min(np.ptp(held) / abs(held).max() for held in stored(run)) > 1e-4, "something happens"
    assert max(imbalances(run)) < 1e-9
