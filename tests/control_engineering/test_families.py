"""Families of loops beside single loops, for settings and processes that are drawn anew each time."""

import math

import numpy as np
import pytest
import sympy

from loopbook import s
from loopbook.families import Family
from loopbook.integrals import ise, pi_first_order
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.transfer import first_order

Kp, Ti, Td, K, T, delay = sympy.symbols("Kp Ti Td K T delay", positive=True)
TIMES = np.linspace(0, 25, 51)
FAMILIES = {
    "PI settings": (first_order(2, 5, delay=4), PID(Kp, Ti), {"Kp": (0.05, 0.6), "Ti": (2, 12)}),
    "PID settings": (first_order(1, 3, delay=1) / (s + 1), PID(Kp, Ti, Td, Td / 10), {
        "Kp": (0.2, 4), "Ti": (1, 9), "Td": (0.1, 2)}),
    "processes": (K * sympy.exp(-delay * s) / (T * s + 1), PID(0.5, 4), {
        "K": (0.5, 3), "T": (2, 9), "delay": (0.1, 4)}),
    "without dead time": (1 / ((T * s + 1) * (s + 1) * (2 * s + 1)), PID(Kp, 5), {"T": (0.1, 4), "Kp": (0.1, 9)}),
    "several dead times": (sympy.exp(-s) / (s + 1) + K * sympy.exp(-3 * s) / (2 * s + 1), PID(Kp, 3), {
        "K": (-0.5, 0.5), "Kp": (0.1, 1)}),
}  # fmt: skip


def drawn(name, count=5):
    draw = np.random.default_rng(sorted(FAMILIES).index(name))
    process, controller, spans = FAMILIES[name]
    values = {letter: draw.uniform(*span, count).round(3) for letter, span in spans.items()}
    family = Family(process, controller, **values)
    numbers = [
        {sympy.Symbol(x, positive=True): sympy.Rational(str(v[k])) for x, v in values.items()} for k in range(count)
    ]
    return family, [Loop(process.subs(each), controller.expr.subs(each)) for each in numbers]


@pytest.mark.parametrize("name", FAMILIES)
def test_each_member_is_the_loop_that_it_stands_for(name):
    family, loops = drawn(name)
    assert family.is_stable.tolist() == [loop.is_stable for loop in loops]
    stable = [k for k, loop in enumerate(loops) if loop.is_stable]
    assert stable
    for found, of_one in (
        (family.Ms(), lambda loop: loop.margins().Ms),
        (family.ise(), ise),
        (family.ise("regulator"), lambda loop: ise(loop, mode="regulator")),
    ):
        assert found[stable] == pytest.approx([of_one(loops[k]) for k in stable], rel=1e-8)
        assert all(math.isinf(x) for k, x in enumerate(found) if k not in stable)
    for signal in ("T", "S", "PS", "CS"):
        expected = np.array([getattr(loop, signal).step(TIMES) for loop in loops])
        assert family.step(TIMES, signal) == pytest.approx(expected, rel=1e-8, abs=1e-8 * abs(expected).max())


@pytest.mark.parametrize("mode", ["servo", "regulator"])
def test_a_thousand_integrals_are_the_closed_form(mode):
    dice = np.random.default_rng(5)
    settings = {"Kp": 10 ** dice.uniform(-2, 0.5, 1000), "Ti": 10 ** dice.uniform(-0.5, 1.5, 1000)}
    values = Family(first_order(2, 5, delay=4), PID(Kp, Ti), **settings).ise(mode)
    known = pi_first_order(2, 5, 4, **settings, mode=mode, unstable=math.inf)
    assert (np.isinf(values) == np.isinf(known)).all()
    stable = np.isfinite(known)
    assert 300 < stable.sum() < 900
    assert values[stable] == pytest.approx(known[stable], rel=1e-11)


def test_integrals_that_residues_do_not_give():
    """Critically damped loops, whose zeros of Delta coincide; an error with a pole at zero that a dead time cancels."""
    assert Family(1 / s, PID(Kp, Ti), Kp=[4, 2], Ti=[1, 2]).ise() == pytest.approx([1 / 8, 1 / 4], rel=1e-9)
    lag, late = first_order(2, 5), sympy.exp(-3 * s)
    predictor = Kp * (1 + 1 / (5 * s)) / (1 + Kp * (1 + 1 / (5 * s)) * lag * (1 - late))
    assert Family(lag * late, predictor, Kp=[0.5, 1]).ise() == pytest.approx([3 + 2.5, 3 + 1.25], rel=1e-9)


def test_results_have_the_shape_of_the_values():
    family = Family(first_order(2, 5, delay=4), PID(Kp, Ti), Kp=[[0.1], [0.2], [0.9]], Ti=[3, 5])
    assert family.shape == family.is_stable.shape == family.Ms().shape == family.ise().shape == (3, 2)
    assert family.step([1, 2, 9]).shape == (3, 2, 3)
    alone = Family(first_order(2, 5, delay=4), PID(Kp, 5), Kp=0.2)
    assert alone.Ms() == pytest.approx(family.Ms()[1, 1])
    assert alone.step([9]) == pytest.approx(family.step([9])[1, 1])


def test_margins_and_criteria_are_those_of_the_members():
    family = Family(first_order(2, 5, delay=4), PID(Kp, Ti), Kp=[[0.1], [0.3], [5]], Ti=[3, 6])
    loops, margins, criteria = family.loops, family.margins(), family.criteria(mode="regulator")
    assert loops[1, 1] == Loop(first_order(2, 5, delay=4), PID(0.3, 6))
    assert loops[1, 1].controller == PID(0.3, 6)
    assert margins.gain_margin.shape == criteria.IAE.shape == family.shape
    assert np.isnan(margins.phase_margin[2]).all()
    assert np.isinf([margins.Ms[2], criteria.IAE[2]]).all()
    for point in ((0, 0), (1, 1)):
        assert [x[point] for x in margins] == pytest.approx(loops[point].margins(), nan_ok=True)
        assert [x[point] for x in criteria] == pytest.approx(loops[point].criteria("regulator"))


@pytest.mark.parametrize("by", ["IAE", "ise", "ITAE"])
def test_the_best_setting_is_the_least_within_the_limit(by):
    family = Family(first_order(2, 5, delay=4), PID(Kp, Ti), Kp=np.linspace(0.1, 0.7, 4)[:, None], Ti=[4, 6, 9])
    best = family.best(by, Ms=1.7, mode="regulator")
    values = np.where(family.Ms() <= 1.7, getattr(family.criteria("regulator"), by.upper()), math.inf)
    place = np.unravel_index(values.argmin(), values.shape)
    assert best == {"Kp": pytest.approx(np.linspace(0.1, 0.7, 4)[place[0]]), "Ti": [4, 6, 9][place[1]]}
    assert Loop(first_order(2, 5, delay=4), PID(**best)).Ms <= 1.7


@pytest.mark.parametrize(
    ("question", "message"),
    [
        (lambda: Family(1 / s, Kp), "the loop has the symbols Kp, and there are values for none"),
        (lambda: Family(1 / s, 2, Kp=[1]), "the loop has the symbols none, and there are values for Kp"),
        (lambda: Family(1 / s, Kp / (Ti * s), Kp=[1, 2], Ti=[1, 2, 3]), "expected shapes that fit"),
        (lambda: Family(sympy.exp(-delay * s) / s, 1, delay=[-1]).Ms(), "dead time -1"),
        (lambda: Family(1 / s, Kp, Kp=[1]).ise("load"), "the mode is 'load'"),
        (lambda: Family(1 / s, Kp, Kp=[1]).criteria("load"), "the mode is 'load'"),
        (lambda: Family(1 / s, Kp, Kp=[1]).best("IEA"), "by is 'IEA': expected one of ISE, IAE, ITAE, ITSE"),
        (
            lambda: Family(sympy.exp(-s) / s, Kp, Kp=[1]).best(Ms=1.2),
            "no loop has an Ms of at most 1.2: the smallest is",
        ),
        (lambda: Family(1 / s, Kp, Kp=[1]).step([1], "L"), "the signal is 'L'"),
        (lambda: Family(1 / s, Kp, Kp=[1]).step([-1]), "the times contain -1"),
        (lambda: Family(s, Kp, Kp=[1]).Ms(), "is improper"),
        (lambda: Family(1 / (s + 1), Kp, Kp=[1]).ise(), "does not vanish"),
    ],
)
def test_questions_without_an_answer(question, message):
    with pytest.raises(ValueError, match=message):
        question()
