"""The Good Gain experiment."""

import math

import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.identification import good_gain_experiment, swing
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.simulation import simulate
from test_identification_fitting import PLANT

E = sympy.exp


def second_order_response(zeta):
    t = np.linspace(0, 40, 8001)
    w = math.sqrt(1 - zeta**2)
    return t, 1 - np.exp(-zeta * t) * (np.cos(w * t) + zeta / w * np.sin(w * t))


@pytest.mark.parametrize("zeta", [0.3, 0.43, 0.6])
def test_the_undershoot_is_the_square_of_the_overshoot_of_two_poles(zeta):
    overshoot, undershoot, between = swing(*second_order_response(zeta), final=1)
    assert overshoot == pytest.approx(math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), rel=1e-4)
    assert undershoot == pytest.approx(overshoot**2, rel=1e-3)
    assert between == pytest.approx(math.pi / math.sqrt(1 - zeta**2), rel=1e-2)


def test_a_response_without_overshoot_has_no_swing():
    t = np.linspace(0, 10, 101)
    assert swing(t, 1 - np.exp(-t), final=1)[:2] == (0, 0)
    assert swing(t, np.exp(-t) - 1, final=-1)[:2] == (0, 0)


@pytest.mark.parametrize("share", [0.01, 0.05, 0.2])
def test_the_good_gain_gives_the_undershoot_that_was_asked_for(share):
    found = good_gain_experiment(E(-s) / (4 * s + 1), undershoot=share)
    assert found.undershoot == pytest.approx(share, rel=1e-3)
    assert swing(found.times, found.y, final=found.KpGG / (1 + found.KpGG))[2] == found.Tou


def test_the_good_gain_of_a_simulator_is_that_of_its_transfer_function():
    exact = good_gain_experiment(PLANT)

    def experiment(Kp):
        run = simulate(Process(PLANT), Controller(PID(Kp), step=0.05), until=50, setpoint=1)
        return run.times, run["y"], 2 * Kp / (1 + 2 * Kp)

    found = good_gain_experiment(experiment, highest=3)
    assert found.KpGG == pytest.approx(exact.KpGG, rel=0.02)
    assert found.Tou == pytest.approx(exact.Tou, rel=0.02)


def test_a_good_gain_experiment_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="between 0 and 1"):
        good_gain_experiment(PLANT, undershoot=2)
    for process in (1 / (s + 1), -PLANT, E(-s)):
        with pytest.raises(ValueError, match="no positive gain makes"):
            good_gain_experiment(process)
    with pytest.raises(ValueError, match="highest gain to try is missing"):
        good_gain_experiment(lambda Kp: ([0, 1, 2, 3], [0, 1, 1, 1]))
    with pytest.raises(ValueError, match="expected a higher gain"):
        good_gain_experiment(PLANT, highest=0.1)
    with pytest.raises(ValueError, match="expected one below the ultimate gain, 3"):
        good_gain_experiment(PLANT, highest=100)  # the loop would be unstable
    with pytest.raises(ValueError, match="highest gain is -1"):
        good_gain_experiment(PLANT, highest=-1)
    with pytest.raises(ValueError, match="does not oscillate without control"):
        good_gain_experiment(E(-s) / (s**2 + sympy.Rational(1, 5) * s + 1))
