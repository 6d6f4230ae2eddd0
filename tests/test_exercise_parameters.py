"""The parameters of an exercise: values that a person would choose, drawn alike on every machine."""

import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopbook.exercises.authoring import answers, between, choice, design, number, settings
from loopbook.pid import PID


def test_the_draws_are_the_same_on_every_machine():
    one = between(2, 6, "s")
    assert [str(one.draw(text)) for text in ("a", "b", "c", "d")] == DRAWN
    program = "from loopbook.exercises.authoring import between; print([str(between(2, 6).draw(x)) for x in 'abcd'])"
    result = subprocess.run([sys.executable, "-R", "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.strip() == str(DRAWN)


DRAWN = ["11/2", "11/2", "3", "3"]


def test_over_decades_the_values_grow_by_a_ratio():
    assert [float(value) for value in between(1, 40).values] == [
        1,
        1.2,
        1.5,
        2,
        2.5,
        3,
        4,
        5,
        6,
        8,
        10,
        12,
        15,
        20,
        25,
        30,
        40,
    ]


@given(st.floats(1e-3, 1e4), st.floats(1.2, 1e4))
def test_a_range_has_values_that_a_person_would_choose(low, ratio):
    parameter = between(low, low * ratio)
    assert len(parameter.values) >= 6
    for value in parameter.values:
        assert low * (1 - 1e-9) <= value <= low * ratio * (1 + 1e-9)
        assert len(f"{float(value):.10g}".replace(".", "").strip("0")) <= 6


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: between(6, 2), "the smaller one first"),
        (lambda: between(2, 6, "apples"), "not a unit"),
        (lambda: between(2, 6, step=10), "leaves no choice"),
        (lambda: between(2, 6, step=0), "step is 0: expected a positive number"),
        (lambda: between(2, 6, reference=7), "the reference is 7"),
        (lambda: between(2, 6, reference="many"), "the reference is many"),
        (lambda: choice("hot", "cold", reference="warm"), "the reference is warm"),
        (lambda: choice("one"), "at least two"),
        (lambda: answers(), "at least one quantity"),
        (lambda: number(2, "apples", "the gain"), "the unit of the gain"),
        (lambda: settings(PID(2), form="ideal"), "form is 'ideal'"),
        (lambda: design(number(2)), "no criteria"),
    ],
)
def test_what_an_author_writes_wrongly_is_said(make, says):
    with pytest.raises(ValueError, match="expected") as caught:
        make()
    assert says in str(caught.value)


def test_a_choice_of_words_and_numbers():
    assert choice("none", 3, reference=3).reference == 3
    assert choice("none", 3).reference == "none"
