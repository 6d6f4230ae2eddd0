"""The names under which answers are given, matched with those that are asked."""

import pytest

from exercisebook.asked_names import as_asked, by_name, matched
from loopbook.exercises import bank
from loopbook.exercises.authoring import number, settings
from loopbook.pid import PID


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


CONTROLLER = {"K": number(3), "pid": settings(PID(2, Ti=10))}
ONE_BY_ONE = {"Ku": number(4), "Kp": number(2), "Ti": number(10, "s"), "Td": number(1, "s")}
TWO = {"inner": settings(PID(2, Ti=10)), "outer": settings(PID(2, Ti=10))}


@pytest.mark.parametrize(
    ("key", "given", "asked"),
    [
        (CONTROLLER, {"Kp": 2, "Ti": "10 s"}, {"pid": {"Kp": 2, "Ti": "10 s"}}),
        (CONTROLLER, {"K": 3, "Kc": 2, "tau_I": 10}, {"K": 3, "pid": {"Kp": 2, "Ti": 10}}),
        (CONTROLLER, {"K": 3, "gain": 2, "Ki": 0.2}, {"K": 3, "pid": {"Kp": 2, "Ki": 0.2}}),
        (CONTROLLER, {"Kp": 3}, {"K": 3}),  # the gain that is asked by itself
        (CONTROLLER, {"K": 3, "Kp": 2}, {"K": 3, "pid": {"Kp": 2}}),
        (CONTROLLER, {"Kp": 2, "Kc": 3, "Ti": 10}, {"Kp": 2, "Kc": 3, "Ti": 10}),
        (CONTROLLER, {"pid": PID(2), "Kp": 2, "Ti": 10}, {"pid": PID(2), "K": 2, "Ti": 10}),
        (TWO, {"Kp": 2, "Ti": 10}, {"Kp": 2, "Ti": 10}),
        (ONE_BY_ONE, {"pid": PID(2, 10)}, {"Kp": 2, "Ti": 10, "Td": 0}),
        (ONE_BY_ONE, {"Ku": 4, "settings": "Kc = 2, tau_I = 10 s"}, {"Ku": 4, "Kp": "2", "Ti": "10 s"}),
        (ONE_BY_ONE, {"controller": [2, 10, 1]}, {"Kp": 2, "Ti": 10, "Td": 1}),
        (ONE_BY_ONE, {"pid": PID(2, 10), "Kp": 3}, {"Kp": 3, "Ti": 10, "Td": 0}),
        (ONE_BY_ONE, {"pid": {"Kp": 2, "Kc": 3}}, {"pid": {"Kp": 2, "Kc": 3}}),
        (ONE_BY_ONE, {"pid": "whatever"}, {"pid": "whatever"}),
    ],
)
def test_settings_may_be_given_as_a_controller_and_one_by_one(key, given, asked):
    assert as_asked(given, key) == asked


@pytest.mark.parametrize(
    ("key", "alone", "asked"),
    [
        (ONE_BY_ONE, PID(2, 10), {"Kp": 2, "Ti": 10, "Td": 0}),
        (ONE_BY_ONE, "PID(2, 10 s, 1 s)", {"Kp": "2", "Ti": "10 s", "Td": "1 s"}),
        (ONE_BY_ONE, {"Kc": 2, "K_u": 4}, {"Kc": 2, "K_u": 4}),
        (ONE_BY_ONE, {"nothing": 2}, {}),
        (ONE_BY_ONE, [4, 2, 10, 1], {}),
        (ONE_BY_ONE, "4, 2, 10, 1", {}),
        (ONE_BY_ONE, 2, {}),
        ({"T": number(3)}, [3], {"T": [3]}),
    ],
)
def test_an_answer_without_a_name_is_taken_where_it_says_what_it_is(key, alone, asked):
    assert by_name(alone, key) == asked
