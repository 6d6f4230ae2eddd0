"""The names under which answers are given, matched with those that are asked."""

import pytest

from loopbook.exercises import bank
from loopbook.exercises.asked_names import matched


@pytest.mark.parametrize(
    ("given", "asked", "found"),
    [
        ("Kp Ti", "Kp Ti", "Kp Ti"),
        ("K_p T_i", "Kp Ti", "Kp Ti"),
        ("Kc tau_I", "Kp Ti", "Kp Ti"),
        ("kp ti", "Kp Ti", "Kp Ti"),
        ("K_C tauI", "Kp Ti", "Kp Ti"),
        ("K T theta", "K T tau", "K T tau"),
        ("K T τ", "K T tau", "K T tau"),
        ("K T delay", "K T tau", "K T tau"),
        ("Kp T", "K T tau", "K T"),
        ("K_cu", "a P Kcu share", "Kcu"),
        ("t1 theta", "tau_1 theta", "tau_1 theta"),
        ("PM", "ISE phase_margin", "phase_margin"),
        ("phasemargin", "ISE phase_margin", "phase_margin"),
        ("pole", "poles zeros", "poles"),
        ("w", "omega gain delay", "omega"),
        ("K", "omega gain delay", "gain"),
        ("zeta", "damping K_c offset", "damping"),
        ("Y y", "Y y t_near", "Y y"),
        ("G", "H t_half t_slow", "H"),
    ],
)
def test_a_name_that_can_mean_one_thing_means_it(given, asked, found):
    assert list(matched(given.split(), asked.split()).values()) == found.split()


@pytest.mark.parametrize(
    ("given", "asked"),
    [
        ("tau", "tau_1 theta"),  # the lag of some books, the dead time of others
        ("Kc K_c", "Kp Ti"),  # two for one
        ("k_p", "K_p Kp"),  # one for two
        ("K", "K_u Pu"),
        ("kp", "K_p1 K_p2"),
        ("y0", "y y_s"),
        ("xyzzy", "Kp Ti"),
        ("", "Kp Ti"),
    ],
)
def test_a_name_that_may_mean_several_things_or_none_is_left_out(given, asked):
    assert matched(given.split(), asked.split()) == {}


def test_a_name_that_is_asked_means_itself_and_nothing_is_meant_twice():
    assert matched(["Kp", "Kc"], ["Kp", "Ti"]) == {"Kp": "Kp"}
    assert matched(["tau", "theta"], ["theta", "tau_1"]) == {"theta": "theta", "tau": "tau_1"}


def test_in_the_bank_each_name_means_itself_in_other_spellings_too():
    for chapter in bank.chapters():
        for exercise in bank.exercises(chapter).values():
            asked = list(exercise.question().key)
            assert matched(asked, asked) == {name: name for name in asked}
            plain = [name.replace("_", "") for name in asked]
            assert list(matched(plain, asked).values()) == asked, exercise.number
