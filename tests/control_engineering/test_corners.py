"""Corners of the normal form that every question has to know: removable zeros at the origin, constants, zero lags."""

import math
import warnings

import numpy as np
import pytest
import sympy
from sympy import Rational, exp

import loopbook as lb
from loopbook import s

AVERAGE = (1 - exp(-s)) / s
K, delay, width = sympy.symbols("K delay width")


@pytest.mark.parametrize(
    ("system", "first"),
    [
        (lb.Loop(AVERAGE / (s + 1), lb.PID(0.5, Ti=1)).T, -0.740850430),
        (lb.System(AVERAGE).feedback(0.5), -2.233382441 + 4.331746520j),
        (lb.System(AVERAGE**2).feedback(0.5), -1.139141468 + 2.599806053j),
        (lb.Loop(AVERAGE**2 * exp(-s) / (s + 1), lb.PID(0.1, Ti=1)).T, -0.129831538),
    ],
)
def test_a_removable_zero_is_no_pole_of_a_system(system, first):
    found = system.poles(2)[0]
    assert found == pytest.approx(first, abs=1e-8)
    below = sum(np.polyval(part[::-1], found) * np.exp(-float(d) * found) for d, part in system.denominator.items())
    assert abs(below) < 1e-12 * max(max(map(abs, part)) for part in system.denominator.values())


def test_a_moving_average_alone_has_no_poles():
    assert lb.System(AVERAGE).poles() == []


@pytest.mark.parametrize("process", [1 / (s + 1), AVERAGE / (s + 1)])
def test_an_error_that_does_not_vanish_is_not_an_unstable_loop(process):
    with pytest.raises(ValueError, match="the error does not vanish"):
        lb.Loop(process, Rational(1, 20)).ise()
    with pytest.raises(ValueError, match="the error does not vanish"):
        lb.Family(process, K, K=[0.05, 0.1]).ise()


def test_a_closed_loop_pole_at_zero_is_no_error_that_does_not_vanish():
    with pytest.raises(ValueError, match="not stable: it has poles on the imaginary axis"):
        lb.Loop(1 / (s + 1), -1).ise()


@pytest.mark.parametrize(
    ("family", "settings"),
    [
        (lb.Family(exp(-delay * s), lb.PID(K, Ti=2), delay=[0, 1], K=0.2), [(0, 0.2), (1, 0.2)]),
        (lb.Family((2 * s + 1) / (3 * s + 1) * exp(-delay * s), K, delay=[0.4, 0], K=[0.5, 1]), [(0.4, 0.5), (0, 1)]),
    ],
)
def test_a_doubt_about_one_loop_does_not_take_the_family(family, settings):
    assert len(settings) == family.loops.size
    assert family.Ms() == pytest.approx([loop.Ms for loop in family.loops.ravel()], rel=1e-9)


def test_margins_close_to_the_limit_are_not_zero():
    gain = Rational("1.570796326")
    found = lb.margins(gain * exp(-s) / s)
    assert found.phase_margin == pytest.approx(math.degrees(math.pi / 2 - float(gain)), rel=1e-5)
    assert found.delay_margin == pytest.approx((math.pi / 2 - float(gain)) / float(gain), rel=1e-5)


@pytest.mark.parametrize(
    "asked",
    [
        lambda: lb.stability_map(K * (1 - exp(-width * s)) / (width * s) / (s + 1), K=[0.5], width=[0]),
        lambda: lb.Family(1 / (width * s), K, K=[0.5, 0.5], width=[1, 0]).is_stable,
    ],
)
def test_a_denominator_that_vanishes_is_refused(asked):
    with pytest.raises(ValueError, match=r"vanishes at K = 0\.5, width = 0"):
        asked()


def test_the_margins_of_constants():
    assert lb.margins(Rational(-1, 2))[:5] == (2, 0, math.inf, math.inf, 2)
    assert lb.margins(sympy.Integer(3))[:5] == (math.inf, 0, math.inf, 0, 0.25)
    assert lb.margins(sympy.Integer(-4))[:5] == (math.inf, 0.25, math.inf, 0, pytest.approx(1 / 3))


def test_a_loop_on_its_limit_is_refused_without_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match="is not stable"):
            lb.margins(-(s + 2) / (2 * (s + 1)))
