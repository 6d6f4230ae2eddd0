"""An exercise as an author writes it and a reader meets it: statement, variants, response."""

import types

import pytest
import sympy

from exercisebook import authoring
from exercisebook.authoring import Exercise, answers, between, choice, exercise, expression, number, word
from exercisebook.judging import MISTAKE, RIGHT, WRONG, Verdict
from exercisebook.response import Response
from plainmath.expressions import s


@exercise("99.1", title="A tank", points=4, where=lambda A, q: q < A)
def tank(A=between(2, 8, "m²", reference=4), q=between(1, 5, "m³/s", reference=2), kind=choice("open", "closed")):
    r"""A tank that is {kind} has an area of {A}. An inflow of {q} begins; $\frac{{{q}}}{{{A}}}$ is {H}."""
    return answers(rate=number(q / A, "m/s", "the rate of the level"), H=expression(q / (A * s)))


@tank.shows
def _(A, q):
    return {"H": q / (A * s)}


@tank.mistake("Half of it is missing for an area of {A}.")
def _(A, q):
    return {"rate": q / A / 2}


def test_a_question():
    question = tank.question()
    assert question.given("A") == 4
    assert question.given("A", "q") == (4, 2)
    statement = question.statement
    assert (statement.heading, statement.points) == ("Exercise 99.1 · A tank", "4 points")
    assert "an area of 4\N{NO-BREAK SPACE}m². An inflow of 2\N{NO-BREAK SPACE}m³/s" in statement.body
    assert r"is $\frac{0.5}{s}$." in statement.body
    assert statement.asked[0] == "`rate`: the rate of the level, in m/s"
    assert str(statement).startswith(f"**{statement.heading}** (4 points)\n\n{statement.body}\n\n- `rate`: ")
    assert str(statement).endswith(f"\n\n*Accuracy: {statement.accuracy}*")
    with pytest.raises(ValueError, match="gives no 'V': expected 'A', 'q', 'kind', 'H'"):
        question.given("V")


def accuracies(x=between(1, 9)):
    """A statement about {x}."""
    return answers(a=number(x, within=0), b=number(x), c=number(x), d=word("yes", ["yes", "no"]))


def test_what_is_shown_has_decimals_where_few_digits_write_them():
    one = Exercise("99.2", "Decimals", 1, lambda: True, key_of_one)
    one.shows(lambda: {"x": sympy.Rational(5, 2) * s + sympy.Rational(1, 3)})
    assert r"$2.5 s + \frac{1}{3}$" in one.question().statement.body


def test_the_statement_says_the_accuracy():
    statement = Exercise("99.2", "Accuracies", 1, lambda: True, accuracies).question().statement
    assert statement.accuracy == "1\N{NO-BREAK SPACE}%; `a`: exact"


def test_a_response():
    question = tank.question()
    response = question.check(rate=0.25, H="0.5/s")
    assert [verdict.status for verdict in response.verdicts] == [MISTAKE, RIGHT]
    assert "an area of 4\N{NO-BREAK SPACE}m²" in response.verdicts[0].says
    assert (response.earned, response.is_right) == (2, False)
    assert repr(response).splitlines()[0] == "≈ Exercise 99.1 · A tank: 1 of 2 right"
    assert 'role="status"' in response._repr_html_()
    assert question.check(rate="0.5 m/s", H=1 / (2 * s)).is_right
    assert repr(question.check()).startswith("… Exercise 99.1 · A tank: not answered yet")
    assert "did you mean 'rate'?" in repr(question.check(rat=3))
    assert "by their names" in repr(question.check(3))


def test_html_of_a_reader_is_shown_and_not_run():
    text = tank.question().check(H="<script>alert(1)</script>")._repr_html_()
    assert "<script>" not in text


def test_signs_of_formulas_outside_of_formulas_are_none():
    response = Response("1.1", (Verdict("x", WRONG, r"of $\zeta$ and \(x\)"),), 1)
    assert r"of $\zeta$ and <span>\</span>(x<span>\</span>)" in response._repr_html_()
    response = Response("1.1", (Verdict("x", WRONG, "costs 3 $"),), 1)
    assert "costs 3 <span>$</span>" in response._repr_html_()


def test_any_name_can_be_given():
    response = tank.question().check(**{"self": 1, "alone": 2, "$x$": 3, "\ud800": 4})
    assert "self is not asked" in repr(response)
    assert "$" not in repr(response)
    assert repr(response).encode()


def test_a_student_has_one_name_in_any_spelling():
    assert tank.question("Zoe\u0308").values == tank.question("Zo\u00eb").values
    assert tank.question("\ud800").values
    with pytest.raises(ValueError, match="empty text: expected"):
        tank.question(" ")


def key_of_numbers(x=between(1, 9)):
    """A statement about {x}."""
    return {"y": x}


def key_of_apples(x=between(1, 9)):
    """A statement about {x}."""
    return answers(y="apples")


def key_of_nothing():
    """No number is given."""
    return answers(y=1 // 0)


def key_of_one(x=between(1, 9)):
    """A statement about {x}."""
    return answers(y=x)


def asking(key, where=lambda: True, mistake=None):
    one = Exercise("99.2", "A key", 1, where, key)
    if mistake:
        one.mistake("Wrong.")(mistake)
    return one


@pytest.mark.parametrize(
    ("one", "says"),
    [
        (asking(key_of_numbers), r"exercise 99\.2 returns .*: expected answers"),
        (asking(key_of_apples), r"the key of exercise 99\.2 fails for x = \d.*: 'apples' is a text"),
        (asking(key_of_nothing), r"^the key of exercise 99\.2 fails: integer division or modulo by zero"),
        (asking(key_of_one, mistake=lambda x: {"z": x + 1}), r"a mistake of exercise 99\.2 is in 'z': expected 'y'"),
        (asking(key_of_one, mistake=lambda T: {"y": T}), r"a mistake .* fails for x = \d.*: 'T' is not a parameter"),
        (asking(key_of_one, where=lambda T: T > 1), "'T' is not a parameter of the exercise: expected one of x"),
    ],
)
def test_what_an_author_gets_wrong_is_said(one, says):
    with pytest.raises(ValueError, match=says):
        one.question().check(y=3)


def test_variants_are_the_same_every_time_and_differ():
    one, other = (tank.question(name).values for name in ("Ada", "Norbert"))
    assert one == tank.question.__wrapped__(tank, "Ada").values
    assert one != other
    for k in range(100):
        values = tank.question(f"{k}").values
        assert values["q"] < values["A"]


def test_two_exercises_of_one_number():
    module = types.ModuleType("assignment")
    module.one, module.other = tank, Exercise("99.1", "Another", 1, lambda: True, tank.key)
    with pytest.raises(ValueError, match=r"two exercises 99\.1 in assignment"):
        authoring.collected(module)


@exercise("99.2", title="An action", points=1)
def action(K=between(1, 9)):
    "Which way is it turned, and what is done, and in which order?"
    return answers(
        action=word("clockwise", ["anticlockwise", "clockwise"], "the action"),
        steps=authoring.words(["fill", "heat", "drain"], ["drain", "stir", "fill", "heat"], "the steps", ordered=True),
        others=authoring.words(["heat", "drain"], ["drain", "stir", "fill", "heat"], "those with a valve"),
        valve=word("V2", ["V2", "V10", "V1"], "the valve"),
        stable=word("no", ["no", "yes"], "whether it is stable"),
    )


def test_the_place_of_a_word_says_nothing_about_it():
    questions = [action.question(f"s{k}") for k in range(200)]
    for name, orders in (("action", 2), ("steps", 24)):
        firsts = [one.key[name].among[0] for one in questions]
        expected = 200 / len(set(firsts))
        assert all(abs(firsts.count(one) - expected) < 40 for one in firsts)
        assert len({one.key[name].among for one in questions}) == orders
    for one in questions[:5]:
        among = one.key["action"].among
        assert f"the action: {among[0]} or {among[1]}" in one.statement.asked[0]
        assert one.key["action"].asking == f'word(["{among[0]}", "{among[1]}"])'
        assert one.key["action"].expected == f"{among[0]} or {among[1]}"
        assert one.key["valve"].among == ("V1", "V2", "V10")
        assert one.key["stable"].among == ("yes", "no")
        assert "`others`: those with a valve, out of the same list" in one.statement.asked
        right = {"action": "Clockwise", "steps": "fill, heat, drain", "others": ["drain", "heat"], "valve": "V2"}
        assert one.check(stable=False, **right).is_right


def test_the_order_is_that_of_the_variant():
    assert action.question("Ada").key["steps"].among == action.question_with("Ada", {}).key["steps"].among
    assert action.question("Ada").key["steps"].among == ORDER


ORDER = ("heat", "drain", "stir", "fill")
