"""The registry of the kinds of answers: who has them from it, and that a kind says all that is asked of it."""

import ast
import functools
import itertools
import math
import re

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

import contributing
from draws import THOROUGH, of_the_day
from exercisebook.formulas import Formula
from exercisebook.kinds.words import bare
from exercisebook.reading import Unreadable
from exercisegrader.student_side import answer_sheet
from loopbook.exercises import authoring, bank
from loopbook.exercises.kinds import MAKERS, Kind
from loopbook.pid import PID

# Who has them from it.


@pytest.mark.parametrize("name", MAKERS)
def test_a_kind_is_there_for_authors_and_on_the_answer_sheet(name):
    assert getattr(authoring, name) is MAKERS[name]
    assert name in authoring.__all__
    assert name in answer_sheet.__all__
    assert MAKERS[name].maker == name


@pytest.fixture
def registry():
    """The registry, from which goes again what a test puts there."""
    before = dict(MAKERS)
    yield MAKERS
    MAKERS.clear()
    MAKERS.update(before)


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


JUDGED = [name for name, kind in MAKERS.items() if not kind.by_hand]


@functools.cache
def questions(name):
    """Questions that ask for a kind: five others each day, and in a thorough run all, as three readers have them."""
    made = [one for chapter in bank.chapters() for one in bank.exercises(chapter).values()]
    asking = [one for one in made if any(kind.maker == name for kind in one.question().key.values())]
    readers = (None, "Ada", "Norbert") if THOROUGH else (None,)
    return [one.question(reader) for one in of_the_day(asking, 5, f"as code {name}") for reader in readers]


def alike(one, other):
    """Whether two answers, as they were read, are the same."""
    if isinstance(one, Formula):
        return isinstance(other, Formula) and one.text == other.text
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else type(one) is type(other) and one == other


def assert_reads_back(kind, answer):
    code = kind.as_code(answer)
    assert "\n" not in code
    assert alike(kind.read(ast.literal_eval(code))[0], answer), code


@pytest.mark.parametrize("name", JUDGED)
def test_answers_as_code_read_back_as_the_same_answers(name):
    """The key, the mistakes of the exercise, and those that the kind knows by itself."""
    count = 0
    for question in questions(name):
        for quantity, kind in question.key.items():
            if kind.maker == name:
                count += 1
                wrong = [value for _, value in (*question.mistakes[quantity], *kind.mistakes())]
                for answer in (kind.key, *(kind.read(value)[0] for value in wrong)):
                    assert_reads_back(kind, answer)
    assert count, f"no exercise asks for a {name}"


@pytest.mark.parametrize("name", JUDGED)
def test_a_kind_is_made_again_from_its_code(name):
    calls = set()
    for kind in itertools.chain.from_iterable(question.key.values() for question in questions(name)):
        if kind.maker == name and kind.making and kind.making not in calls:
            calls.add(kind.making)
            made = eval(kind.making, vars(authoring))
            assert made.agrees(kind.key)
            assert made.asked == kind.asked
            assert made.making == kind.making
    assert calls or name == "design"  # whose criteria are functions


finite = st.floats(allow_nan=False, allow_infinity=False)
moderate = st.floats(-1e12, 1e12).filter(lambda x: x == 0 or abs(x) > 1e-12)
complex_numbers = st.complex_numbers(max_magnitude=1e300, allow_nan=False, allow_infinity=False)


@given(finite, st.lists(finite, min_size=1), st.lists(complex_numbers, min_size=1))
def test_numbers_as_code_read_back(x, row, values):
    for kind in (authoring.number(x), authoring.numbers(row), authoring.poles(values)):
        assert_reads_back(kind, kind.key)


@given(
    moderate,
    moderate.map(abs).filter(bool) | st.just(math.inf),
    moderate.map(abs),
    moderate.map(abs),
    st.sampled_from(["serial", "parallel"]),
    st.sampled_from(["any", "serial", "parallel"]),
)
def test_settings_as_code_read_back(Kp, Ti, Td, Tf, form, asked):
    kind = authoring.settings(PID(1, 2), form=asked)
    assert_reads_back(kind, kind.read(PID(Kp, Ti, Td, Tf, form))[0])


letters = st.text("abcäß'\"\\ _-", min_size=1, max_size=8).filter(lambda word: word.strip(" '\"._-"))


@given(st.lists(letters, min_size=2, max_size=5, unique_by=bare))
def test_words_as_code_read_back(among):
    kind = authoring.word(among[0], among)
    assert_reads_back(kind, kind.key)
    kind = authoring.words(among[:2], among)
    assert_reads_back(kind, kind.key)


def test_a_function_of_the_readers_own_has_no_code():
    kind = authoring.time_function("1 - exp(-t/5)", until=25)
    answer, _ = kind.read(lambda t: 1 - np.exp(-t / 5))
    assert kind.agrees(answer)
    with pytest.raises(ValueError, match="is a function of the reader's: expected an expression"):
        kind.as_code(answer)
