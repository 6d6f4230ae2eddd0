"""What an exercise offers besides its statement: hints, its solution, pictures, data, and what follows an answer."""

import numpy as np
import pytest

from drawings import Drawing
from exercisebook import notes
from exercisebook.authoring import Exercise, answers, between, criterion, design, number, word
from exercisebook.errors import ExerciseError
from exercisebook.progress import is_answered, note, students


def heating(power=between(1, 9, "kW", reference=2), mass=between(10, 90, "kg", step=10, reference=20)):
    """How fast does {mass} of water warm up with {power}?"""
    return answers(
        rate=number(60 * power / (4.2 * mass), "K/min", "the rate"),
        energy=number(power, "kJ", "the energy of a second"),
        more=word("no", ["yes", "no"], "whether it boils"),
    )


@pytest.fixture
def exercise(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(notes.SWITCH, raising=False)
    one = Exercise("99.1", "Heating", 2, lambda: True, heating, insight="Twice the mass, half the rate: {rate}.")
    one.then = "Exercise 99.2 · Cooling"
    one.hints("The energy of {mass} of water.", "Set up $m c\\,dT/dt = P$.", "$\\frac{ {power} }{4.2 \\cdot {mass}}$")

    @one.solution
    def _(power, mass):
        """The water takes up {power}, $4.2 \\cdot {mass} =$ {capacity}.

        ***

        So it warms by {rate}.
        """
        return {"capacity": (4.2 * mass, "kJ/K")}

    return one


def texts(pages):
    return [repr(page) for page in pages]


def test_hints_go_one_step_further_each_time(exercise):
    question = exercise.question()
    first, second, third, last, again = texts(question.hint() for _ in range(5))
    assert first == "**Hint 1 of 4** · Exercise 99.1 · Heating\n\nThe energy of 20\N{NO-BREAK SPACE}kg of water."
    assert second.startswith("**Hint 2 of 4**")
    assert "$\\frac{ 2 }{4.2 \\cdot 20}$" in third
    assert "$4.2 \\cdot 20 =$ 84\N{NO-BREAK SPACE}kJ/K." in last
    assert last.endswith("The rest is yours.")
    assert "1.43" not in last
    assert again == last
    assert repr(question.hint(2)) == second
    with pytest.raises(ExerciseError, match="the hint is 5: expected one from 1 to 4"):
        question.hint(5)


def test_the_solution_comes_after_an_attempt(exercise):
    question = exercise.question("Ada")
    assert "after your first attempt" in repr(question.solution())
    question.check(rate=...)
    assert "after your first attempt" in repr(question.solution())
    question.check(rate=1)
    text = repr(question.solution())
    assert text.startswith("**Solution** · Exercise 99.1 · Heating")
    assert "***\n" not in text.partition("\n")[2]
    assert exercise.question.__wrapped__(exercise, "Ada").solution().text == text, "the attempt is kept in the file"


def test_after_two_bare_answers_a_hint_is_offered(exercise):
    question = exercise.question("Zoe")
    assert "hint()" not in repr(question.check(rate=1e5 + 1))
    assert "hint()" in repr(question.check(rate=2e5 + 7))


def test_after_a_right_answer_there_is_insight_and_the_next_exercise(exercise):
    response = exercise.question().check(rate=120 / 84, energy=2, more="no")
    assert repr(response).splitlines()[-2:] == [
        "  Twice the mass, half the rate: 1.429\N{NO-BREAK SPACE}K/min.",
        "  Next: Exercise 99.2 · Cooling",
    ]


def test_an_answer_to_another_variant_is_told_so(exercise):
    question, other = exercise.question("Emmy"), exercise.question("Norbert")
    assert "numbers of everybody" in repr(question.check(rate=120 / 84, energy=2, more="no"))
    assert "numbers of" not in repr(question.check(more="yes")), "every second variant has this word"
    assert "numbers of" not in repr(question.check(rate=120 / 84)), "one number may be a chance"
    other.check(rate=1)
    assert other.values["power"] != question.values["power"] != 2
    keys = {name: other.key[name].key for name in ("rate", "energy")}
    assert "numbers of Norbert" in repr(question.check(**keys))


def test_a_statement_has_a_picture_and_data(exercise, monkeypatch):
    exercise.shows(lambda power: {"t": np.arange(3.0), "y": np.arange(3.0) * float(power)})

    @exercise.picture
    def _(power):
        """The rise with {power}."""
        return Drawing()

    question = exercise.question()
    assert question.picture.alt == "The rise with 2 kW."
    assert question.picture.png()[:4] == b"\x89PNG"
    assert question.given("y").tolist() == [0, 2, 4]
    assert {*question.data} == {"t", "y"}
    shown = []
    monkeypatch.setattr("IPython.display.display", lambda value, **_: shown.append(value))
    question._ipython_display_()
    assert [type(one).__name__ for one in shown] == ["dict", "Drawing"]


def test_a_design_draws_its_own_response():
    def mass(limit=between(1, 9, reference=4)):
        """A mass below {limit}."""
        below = criterion("the mass", float, below=limit)
        return answers(m=design(number(1, what="a mass"), below, draws=lambda m: f"drawn for {m:g}"))

    question = Exercise("99.3", "A mass", 1, lambda: True, mass).question()
    assert question.check(3).pictures == ["drawn for 3"]
    assert question.check("as much as it takes").pictures == []
    assert question.check(...).pictures == []


def test_an_exercise_without_help_says_so():
    question = Exercise("99.1", "Heating", 2, lambda: True, heating).question()
    assert "no hints" in repr(question.hint())
    assert "no solution" in repr(question.solution())


def test_who_answered_is_read_from_the_file(exercise):
    note("99.1", "Ada Lovelace", False)
    note("99.12", "Zoe", True)
    assert students("99.1") == [None, "Ada Lovelace"]
    assert is_answered("99.12", "Zoe")
    assert not is_answered("99.1", None)


def test_names_in_other_spellings_are_understood(exercise):
    response = exercise.question().check(Rate=120 / 84, Energy="2 kJ", MORE="no")
    assert response.is_right
    assert "is not asked" not in repr(response)
