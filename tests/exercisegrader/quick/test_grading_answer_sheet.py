"""The answer sheet: it knows the form of an answer and no key, takes answers down and shows how each is read."""

import numpy as np
import pytest
import sympy

from exercisebook.authoring import criterion, design, expression, number, numbers, poles, word, words
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable
from exercisegrader.inside import answer_sheet
from exercisegrader.inside.plain import plain
from judged import EVERY_KIND
from odd_answers import CIRCLE, Odd
from plainmath.expressions import s

X, K = sympy.symbols("x K")


@pytest.mark.parametrize("code", EVERY_KIND)
def test_a_form_is_made_again_from_its_code_and_knows_no_key(code):
    assert EVERY_KIND[code].asking == code
    form = eval(code, vars(answer_sheet))
    assert form.key is None
    assert form.asking == code
    assert set(vars(form)) <= {"unit", "time", "among", "ordered", "symbols", "_told"}
    assert form.expected


def test_letters_that_the_author_tells_are_demanded_before_the_grader_does():
    told = expression(K / (X * s + 1), symbols="K s x y")
    with pytest.raises(Unreadable, match="'k' is not a symbol of this answer: did you mean 'K'"):
        eval(told.asking, vars(answer_sheet)).read("k/(x*s + 1)")
    with pytest.raises(ValueError, match="the key has the symbol x: expected only K and s"):
        expression(K / (X * s + 1), symbols="K s")


@pytest.mark.parametrize(
    ("kind", "solution"),
    [
        (number(8 / 3, "%/K"), "2.6666667 %/K"),
        (numbers([[0, 1], [-2, -3]], "s"), "[[0, 1], [-2, -3]] s"),
        (poles([-1 + 2j, -1 - 2j, -3]), "[-1 + 2j, -1 - 2j, -3] rad/s"),
        (expression(sympy.Rational(12345, 1000003) * X, unit="m"), "0.012344963*x m"),
        (word("direct", ["direct", "reverse"]), "direct"),
        (words([], "ab"), "none of them"),
        (words(["b", "a"], "ab", ordered=True), "b, a"),
        (design(number(2, "s"), criterion("it", abs, below=3)), "for example 2 s"),
        (number(2).like(3), "3"),
        (expression(X).like(Formula("x + 1", "x")), "x + 1"),
    ],
)
def test_the_solution_is_a_text_for_people(kind, solution):
    assert kind.solution.replace("\N{NO-BREAK SPACE}", " ") == solution


@pytest.mark.parametrize(("maker", "given"), [("number", {"within": 0.01}), ("word", {"key": "a"})])
def test_what_says_nothing_about_a_form(maker, given):
    with pytest.raises(ValueError, match="says nothing about a form"):
        getattr(answer_sheet, maker)(**given)


@pytest.mark.parametrize("function", [lambda times: 0 * times, np.sin], ids=range(2))
def test_without_a_key_a_function_of_time_is_not_called(function):
    with pytest.raises(Unreadable, match="neither an expression"):
        answer_sheet.time_function().read(function)


@pytest.fixture
def asked():
    made = answer_sheet.AnswerSheet("Tuning", student="s1001")
    made.asks("1", K=answer_sheet.number("K/%"), T=answer_sheet.number("s"), H=answer_sheet.expression())
    made.asks("2", action=answer_sheet.word(["direct", "reverse"]))
    return made


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"T": "2.5 min"}, "· T: 150 s, converted from min"),
        ({"T": "two"}, "· T: 2 s, read as 2"),
        ({"T": "long"}, "? T: 'long' is a text that is not a number: expected a number, in s"),
        ({"T": ...}, "… T: not answered yet: expected a number, in s"),
        ({"T": lambda t: t}, "? T: a function cannot be handed in"),
        ({"H": "K*exp(-2*s)/(T*s + 1)"}, "· H: K*exp(-2*s)/(T*s + 1), an expression in K, T and s"),
        ({"H": 2 / (s + X)}, "· H: 2/(s + x), an expression in s and x"),
        ({"H": "y(t)*K_p/(s + 1)"}, "· H: y*K_p/(s + 1), an expression in K_p, s and y"),
        ({"H": "K(s + 1)"}, "· H: K*(s + 1), an expression in K and s, read as K*(s + 1)"),
        ({"k": 2}, "? k: this is not asked here: did you mean 'K'?"),
        ({"self": 2, "exercise": 1}, "? self: this is not asked here"),
    ],
)
def test_the_sheet_shows_how_an_answer_is_read(asked, given, says):
    shown = repr(asked.answer("1", **given)).replace("\N{NO-BREAK SPACE}", " ")
    assert says in shown
    assert shown.endswith("This says nothing about right or wrong.")


def test_the_last_answer_counts_and_only_what_is_asked_is_counted(asked):
    asked.answer("1", K=1, T="long", zzz=2)
    asked.answer("77", Z=1)
    assert repr(asked).endswith("2 of 4 not answered yet, 1 cannot be read")
    asked.answer("1", K=..., T="3 min")
    asked.answer(1, H=None)
    assert asked.taken("1") == {"K": 1, "T": "3 min", "zzz": 2}
    overview = repr(asked)
    assert "· 1  K: 1" in overview
    assert "… 2  action: not answered yet: expected direct or reverse" in overview
    assert "2 of 4 not answered yet" in overview
    asked.answer("1", H=1)
    asked.answer("2", action="direct")
    assert repr(asked).endswith("An answer to all that is asked.")


@pytest.mark.parametrize(
    ("exercise", "alone", "given", "is_taken"),
    [("1", [], {"K": 1}, True), ("1", [], {"K": ...}, False), ("1", [2], {}, False), ("77", [], {"K": 1}, False)],
)
def test_it_says_that_answers_are_taken_down_where_they_are(asked, exercise, alone, given, is_taken):
    assert ("Taken down." in repr(asked.answer(exercise, *alone, **given))) == is_taken


def test_answers_are_delivered_whatever_they_are_of(asked, monkeypatch):
    found = []

    def deliver(*parts):
        found.append(parts)
        raise RuntimeError("nobody is there")

    monkeypatch.setattr(answer_sheet, "deliver", deliver)
    asked.answer("1", K=sympy.Rational(1, 3), odd=Odd(), open=...)
    asked.answer("77", Z=1)
    answer_sheet.AnswerSheet().answer("1", Z=1)
    assert found[0] == ("s1001", "1", {"K": "1/3", "odd": plain(Odd()), "open": None})
    assert found[1:] == [("s1001", "77", {"Z": 1}), ("", "1", {"Z": 1})]


@pytest.mark.parametrize(
    "exercise", [None, ..., 10**5000, float("nan"), len, [], "x" * 10**6, "$<b>\n", -1], ids=range(9)
)
def test_no_answer_fails(asked, exercise):
    for one in (asked, answer_sheet.AnswerSheet()):
        box = one.answer(exercise, 1, 2, **{"K": Odd(), "<i>\n$": 1, "a" * 10**5: CIRCLE})
        assert "Give each answer by its name" in repr(box)
        shown = box._repr_html_()
        assert "<i>" not in shown
        assert "<b>" not in shown
        assert len(shown) < 10**4
        assert one._repr_html_()
    if exercise == "$<b>\n":
        assert "This exercise is not asked here: expected one of 1, 2" in repr(asked.answer(exercise))


def test_an_edited_form_disturbs_nobody(asked):
    asked.asks("3", a=answer_sheet.number("apples"), b=7, c=answer_sheet.word(None))
    shown = repr(asked.answer("3", a="2 s", b=1, c="yes"))
    assert shown.count("? ") >= 3
