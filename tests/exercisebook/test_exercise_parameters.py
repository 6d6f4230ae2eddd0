"""The parameters of an exercise: values that a person would choose, drawn alike on every machine."""

import subprocess
import sys

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from exercisebook.authoring import answers, between, choice, design, exercise, number
from exercisebook.parameters import as_text, of_text


def test_the_draws_are_the_same_on_every_machine():
    one = between(2, 6, "s")
    assert [str(one.draw(text)) for text in ("a", "b", "c", "d")] == DRAWN
    program = "from exercisebook.authoring import between; print([str(between(2, 6).draw(x)) for x in 'abcd'])"
    result = subprocess.run([sys.executable, "-R", "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.strip() == str(DRAWN)


@pytest.mark.parametrize(
    "value",
    [sympy.Rational(-5, 2), sympy.Integer(3), sympy.sqrt(2) * sympy.pi, sympy.Symbol("K", positive=True), "5/2"],
)
def test_a_value_is_a_text_and_comes_back(value):
    again = of_text(as_text(value))
    assert again == value
    assert type(again) is type(value)


def test_a_text_is_read_and_never_run():
    with pytest.raises(ValueError, match="not a number, a name or a known operation"):
        of_text("__import__('os').getpid()")
    with pytest.raises(ValueError, match="not the same when it is read again"):
        as_text(sympy.Symbol("x"))


def test_values_of_before_hold_and_others_are_drawn_for_them():
    @exercise("1", title="Dead time", where=lambda T, delay: delay < T)
    def lag(T=between(2, 9, "s"), delay=between(1, 9, "s")):
        "It is {T} and {delay}."
        return answers(y=T + delay)

    before = {"T": sympy.Integer(12), "delay": sympy.Integer(20), "gone": sympy.Integer(1)}
    assert lag.question_with("Ada", before).values == {"T": 12, "delay": 20}
    assert {lag.question_with(f"s{k}", {"T": sympy.Integer(3)}).values["delay"] < 3 for k in range(20)} == {True}
    with pytest.raises(ValueError, match="has no variant in 1000 draws: in 1000 of them its condition does not hold"):
        lag.question_with("Ada", {"delay": sympy.Integer(20)})


DRAWN = ["11/2", "11/2", "3", "3"]


def test_over_decades_the_values_grow_by_a_ratio():
    grown = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40]
    assert [float(value) for value in between(1, 40).values] == grown


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
