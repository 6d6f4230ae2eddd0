"""The registry of the kinds of answers: who has them from it, and that a kind says all that is asked of it."""

import re
from unittest import mock

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

import contributing
from exercisebook import authoring
from exercisebook.grammar import Unreadable
from exercisebook.kinds import MAKERS, Kind
from exercisebook.kinds.words import bare
from judged import EVERY_KIND, assert_is_made_again, assert_is_tried_in_its_forms, assert_reads_back


@pytest.mark.parametrize("name", [name for name, kind in MAKERS.items() if kind.__module__.startswith("exercisebook.")])
def test_a_kind_is_there_for_authors(name):
    assert getattr(authoring, name) is MAKERS[name]
    assert name in authoring.__all__
    assert MAKERS[name].maker == name


@pytest.fixture
def registry():
    """The registry, from which goes again what a test puts there."""
    with mock.patch.dict(MAKERS):
        yield MAKERS


def as_given(self, given):
    return given, ""


def is_the_key(self, answer):
    return answer == self.key


@pytest.mark.parametrize(
    ("name", "body", "message"),
    [
        ("Color", {"agrees": is_the_key}, "the kind Color has no read: expected a method that returns an answer"),
        ("Color", {"read": as_given}, "the kind Color has no agrees: expected a method that says whether one"),
        (
            "Color",
            {"read": as_given, "agrees": is_the_key, "FORM": ("units",)},
            "FORM of the kind Color names 'units', which is not its argument: did you mean 'unit'?",
        ),
        (
            "Number",
            {"read": as_given, "agrees": is_the_key},
            "the kind Number is in exercisebook.kinds.numeric already: expected another name",
        ),
    ],
)
def test_what_a_kind_forgets_is_said(registry, name, body, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        type(name, (Kind,), body)


def test_a_kind_registers_by_being_written(registry):
    color = type("Color", (Kind,), {"read": as_given, "agrees": is_the_key})
    assert registry["color"] is color
    assert color("red").asking == "color()"
    assert color("red").making == 'color("red")'
    assert color("red").as_code() == '"red"'
    assert color("red").as_given == "red"


def test_the_kind_that_contributors_are_shown_is_one():
    kind = contributing.kind()((4, 20), "mA", "the range of the signal")
    assert kind.asking == 'span("mA")'
    assert kind.making == 'span([4, 20], unit="mA", what="the range of the signal")'
    right = [4, 20], np.array([4, 20.1]), "4, 20", "[0.004 A, 20 mA]", {sympy.Symbol("x"): (4, 20)}
    for ends in (*right, (0, 20), *(wrong for _, wrong in kind.mistakes())):
        answer = kind.read(ends)[0]
        assert kind.agrees(answer) is any(ends is one for one in right)
        assert_reads_back(kind, answer)
    for ends in (4, [20, 4], [4, 20, 5], [[4, 20], [4, 20]], "4 to 20", [4, "x"]):
        with pytest.raises(Unreadable, match=r"expected (two numbers|a list of numbers)"):
            kind.read(ends)


# Answers as code.


@pytest.mark.parametrize("code", EVERY_KIND)
def test_the_code_of_a_form_of_its_answers_and_of_itself(code):
    kind = EVERY_KIND[code]
    assert kind.asking == code
    assert_is_tried_in_its_forms(kind)
    for answer in (kind.key, *(kind.read(wrong)[0] for _, wrong in kind.mistakes())):
        assert_reads_back(kind, answer)
    if kind.making:  # of a design the criteria are functions
        assert_is_made_again(kind, vars(authoring))


finite = st.floats(allow_nan=False, allow_infinity=False)
complex_numbers = st.complex_numbers(max_magnitude=1e300, allow_nan=False, allow_infinity=False)


@given(finite, st.lists(finite, min_size=1), st.lists(complex_numbers, min_size=1))
def test_numbers_as_code_read_back(x, row, values):
    for kind in (authoring.number(x), authoring.numbers(row), authoring.poles(values)):
        assert_reads_back(kind, kind.key)


letters = st.text("abcäß'\"\\ _-", min_size=1, max_size=8).filter(lambda word: word.strip(" '\"._-"))


@given(st.lists(letters, min_size=2, max_size=5, unique_by=bare))
def test_words_as_code_read_back(among):
    for kind in (authoring.word(among[0], among), authoring.words(among[:2], among)):
        assert_reads_back(kind, kind.key)


def test_a_function_of_the_readers_own_has_no_code():
    kind = authoring.time_function("1 - exp(-t/5)", until=25)
    answer, _ = kind.read(lambda t: 1 - np.exp(-t / 5))
    assert kind.agrees(answer)
    with pytest.raises(ValueError, match="is a function of the reader's: expected an expression"):
        kind.as_code(answer)
