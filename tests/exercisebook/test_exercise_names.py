"""The names under which answers are given, matched with those that are asked."""

import pytest

from exercisebook.asked_names import as_asked, by_name, matched
from exercisebook.authoring import expression, number
from springs import Coil, Spring

pytestmark = pytest.mark.usefixtures("mechanics")


@pytest.mark.parametrize(
    ("given", "asked", "found"),
    [
        ("k l", "k l", "k l"),
        ("K_1 TAU", "k1 tau", "k1 tau"),
        ("κ_0 τ", "kappa0 tau", "kappa0 tau"),
        ("kappa mass", "k m", "k m"),
        ("stiffness x", "k m", "k"),
        ("omega w", "omega width", "omega width"),  # what is taken already is meant by no second name
        ("Y y", "Y y t_near", "Y y"),
    ],
)
def test_a_name_that_can_mean_one_thing_means_it(given, asked, found):
    assert list(matched(given.split(), asked.split()).values()) == found.split()


@pytest.mark.parametrize(
    ("given", "asked"),
    [
        ("w", "omega width"),  # the speed of some, the width of others
        ("kappa stiffness", "k m"),  # two for one
        ("k_P", "K_p Kp"),  # one for two
        ("y0", "y y_s"),
        ("xyzzy", "k l"),
        ("", "k l"),
    ],
)
def test_a_name_that_may_mean_several_things_or_none_is_left_out(given, asked):
    assert matched(given.split(), asked.split()) == {}


def test_a_name_that_is_asked_means_itself():
    assert matched(["k", "kappa"], ["k", "l"]) == {"k": "k"}


WHOLE = {"m": number(3), "spring": Spring(Coil(2, 0.5))}
TWO = {"inner": Spring(Coil(2, 0.5)), "outer": Spring(Coil(2, 0.5))}
ONE_BY_ONE = {"m": number(4), "k": number(2), "l": number(0.5, "m")}


@pytest.mark.parametrize(
    ("key", "given", "asked"),
    [
        (WHOLE, {"k": 2, "l": 0.5}, {"spring": {"k": 2, "l": 0.5}}),
        (WHOLE, {"mass": 3, "stiffness": 2, "length": 0.5}, {"m": 3, "spring": {"k": 2, "l": 0.5}}),
        (WHOLE, {"stiffness": 2}, {"spring": {"k": 2}}),
        (WHOLE, {"length": 0.5}, {"length": 0.5}),
        (WHOLE, {"k": 2, "stiffness": 3, "l": 0.5}, {"k": 2, "stiffness": 3, "l": 0.5}),
        (WHOLE, {"spring": Coil(2, 0.5), "k": 2}, {"spring": Coil(2, 0.5), "k": 2}),
        (TWO, {"k": 2, "l": 0.5}, {"k": 2, "l": 0.5}),
        (ONE_BY_ONE, {"spring": Coil(2, 0.5)}, {"k": 2, "l": 0.5}),
        (ONE_BY_ONE, {"m": 4, "coil": "Coil(2, 0.5)"}, {"m": 4, "k": "2", "l": "0.5"}),
        (ONE_BY_ONE, {"spring": Coil(2, 0.5), "k": 3}, {"k": 3, "l": 0.5}),
        (ONE_BY_ONE, {"spring": {"k": 2, "m": 3}}, {"spring": {"k": 2, "m": 3}}),
        (ONE_BY_ONE, {"spring": "whatever"}, {"spring": "whatever"}),
    ],
)
def test_parts_may_be_given_as_a_whole_and_a_whole_in_its_parts(key, given, asked):
    assert as_asked(given, key) == asked


@pytest.mark.parametrize(
    ("key", "alone", "asked"),
    [
        (ONE_BY_ONE, Coil(2, 0.5), {"k": 2, "l": 0.5}),
        (ONE_BY_ONE, "Coil(2, 0.5)", {"k": "2", "l": "0.5"}),
        (ONE_BY_ONE, "k = 2, l = 0.5", {"k": "2", "l": "0.5"}),
        (ONE_BY_ONE, {"kappa": 2, "M": 4}, {"kappa": 2, "M": 4}),
        (ONE_BY_ONE, {"nothing": 2}, {}),
        (ONE_BY_ONE, [4, 2, 0.5], {}),
        (ONE_BY_ONE, "4, 2, 0.5", {}),
        (ONE_BY_ONE, 2, {}),
        ({"T": number(3)}, [3], {"T": [3]}),
    ],
)
def test_an_answer_without_a_name_is_taken_where_it_says_what_it_is(key, alone, asked):
    assert by_name(alone, key) == asked


def test_the_data_of_something_whole_is_its_formula():
    kind = expression("2*x - 1")
    assert kind.agrees(kind.read({"k": 2, "l": 0.5})[0])
