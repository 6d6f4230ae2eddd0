"""Released notebooks: answers as plain data, the sheet, assignments, what is written and what is not, nbgrader."""

import ast
import hashlib
import json
import os
import re
from fractions import Fraction
from types import SimpleNamespace

import control
import nbformat
import numpy as np
import pint
import pytest
import scipy.signal
import sympy
from hypothesis import example, given
from hypothesis import strategies as st

import test_exercises as bank_forms
from loopbook import notebooks, s, t
from loopbook.deadtime import System
from loopbook.exercises import authoring, bank, kinds
from loopbook.exercises.authoring import (
    criterion,
    design,
    expression,
    number,
    numbers,
    poles,
    settings,
    time_function,
    transfer_function,
    word,
    words,
)
from loopbook.exercises.formulas import Formula
from loopbook.exercises.judging import OPEN, RIGHT, UNJUDGED, judge
from loopbook.exercises.reading import Unreadable
from loopbook.grading import GradingError, answer_sheet, nbgrader
from loopbook.grading.assignment import Assignment, load
from loopbook.grading.plain import LONGEST_TEXT, MOST_VALUES, plain, unreadable
from loopbook.grading.release import as_markdown, checked, notebook, release, wrapped
from loopbook.pid import PID

X, K = sympy.symbols("x K")
PINT = pint.UnitRegistry(cache_folder=None)

# Answers as plain data.


class Odd:
    """An answer whose methods fail."""

    def __getattr__(self, name):
        raise RuntimeError("no")


PLAIN = [
    (None, None),
    (..., None),
    (True, True),
    (np.False_, False),
    (sympy.true, True),
    (7, 7),
    (10**299, 10**299),
    (np.int8(7), 7),
    (sympy.Integer(7), 7),
    (2.5, 2.5),
    (np.float32(2.5), 2.5),
    (np.longdouble(2.5), 2.5),
    (sympy.Float(1 / 3), 1 / 3),
    (float("nan"), "nan"),
    (-np.inf, "-inf"),
    (sympy.oo, "inf"),
    (1 + 2j, "(1+2j)"),
    (3 + 0j, 3.0),
    (np.complex64(2j), "2j"),
    (sympy.Rational(5, 2), 2.5),
    (sympy.Rational(1, 3), "1/3"),
    (Fraction(-2, 7), "-2/7"),
    (sympy.sqrt(2) / 2, "sqrt(2)/2"),
    (sympy.pi, "pi"),
    (2 * sympy.I - 1, "-1 + 2*I"),
    (sympy.LambertW(1), float(sympy.LambertW(1).n())),
    ("2 min", "2 min"),
    (np.str_("2 min"), "2 min"),
    ((1, "a", [None, ...]), [1, "a", [None, None]]),
    (range(3), [0, 1, 2]),
    (iter([1, 2]), [1, 2]),
    ({"a": 1}.keys(), ["a"]),
    (np.array([[1, 2], [3, 4]]), [[1, 2], [3, 4]]),
    (np.array(5.0), 5.0),
    (np.array([1j, "x"], object), ["1j", "x"]),
    (sympy.Matrix([[1, X]]), [[1, "x"]]),
    (sympy.Tuple(1, X), [1, "x"]),
    ({3, 1, 10, 2}, [1, 2, 3, 10]),
    ({"b", "a"}, ["a", "b"]),
    (sympy.FiniteSet(2, 1), [1, 2]),
    (sympy.Eq(X, 3), 3),
    (sympy.Eq(sympy.Function("y")(t), t), "t"),
    ({X: 3}, 3),
    ([{X: 3}, {X: 4}], [3, 4]),
    ({-1: 2, -2 + 1j: 1, sympy.Rational(1, 3): 1}, {"-1": 2, "(-2+1j)": 1, "1/3": 1}),
    (2 * sympy.exp(-s) / (X * s + 1), "2*exp(-s)/(s*x + 1)"),
    (System(2 * sympy.exp(-s) / (5 * s + 1)), "2*exp(-s)/(5*s + 1)"),
    (control.tf([3], [5, 1]), "3.0/(5.0*s + 1.0)"),
    (scipy.signal.TransferFunction([3.0], [5.0, 1.0]), "0.6/(1.0*s + 0.2)"),
    (PID(sympy.Rational(1, 3), Ti=10), {"Kp": "1/3", "Ti": 10, "Td": 0, "Tf": 0, "form": "parallel"}),
    (PID(2, form="serial"), {"Kp": 2, "Ti": "inf", "Td": 0, "Tf": 0, "form": "serial"}),
    (PID(K, Ti=10), "K*(1 + 1/(10*s))"),
    (PINT.Quantity(2.5, "min"), "2.5 min"),
    (PINT.Quantity(np.array([1.0, 2.0]), "s"), ["1.0 s", "2.0 s"]),
    (PINT.Quantity(0.25, ""), "0.25 dimensionless"),
    (np.ma.masked, "nan"),
]


@pytest.mark.parametrize(("answer", "data"), PLAIN, ids=range(len(PLAIN)))
def test_an_answer_as_plain_data(answer, data):
    found = plain(answer)
    assert found == data
    assert type(found) is type(data)
    assert json.loads(json.dumps(found, allow_nan=False)) == data


def nested(depth):
    return [nested(depth - 1)] if depth else 1


CIRCLE = []
CIRCLE.append(CIRCLE)


NOT_PLAIN = [
    (lambda times: times, "a function cannot be handed in"),
    (np.sin, "a function cannot be handed in"),
    (object(), "of type object"),
    (b"1", "of type bytes"),
    (dict, "of type type"),
    (os, "of type module"),
    (10**300 * 10, "more than 300 digits"),
    (sympy.Rational(10**400, 7), "more than 300 digits"),
    ("x" * (LONGEST_TEXT + 1), "5001 characters"),
    (["x" * 5000] * 11, "characters"),
    (nested(9), "more than 8 lists in one another"),
    (CIRCLE, "more than 8 lists in one another"),
    (range(MOST_VALUES), "more than 2000 values"),
    (np.zeros(10**6), "more than 2000 values"),
    ([[1, 2, object()]], "of type object"),
    ({1: 2, "1": 3}, "two keys 1"),
    (control.tf([3], [5, 1], 0.1), "of type TransferFunction"),
    (sympy.MatrixSymbol("M", 2, 2), "neither an expression"),
]


@pytest.mark.parametrize(("answer", "says"), NOT_PLAIN, ids=range(len(NOT_PLAIN)))
def test_what_has_no_plain_form_is_said(answer, says):
    found = unreadable(plain(answer))
    assert says in found
    assert "\n" not in found


def test_an_object_that_fails_is_said():
    assert unreadable(plain([Odd()])) == "this fails when it is read, with RuntimeError"


def read(kind, given):
    try:
        return kind.read(given)
    except Unreadable:
        return None


def alike(one, other):
    """Whether two answers, as a kind read them, are the same, so that every verdict on them is."""
    if one is None or other is None or one[1] != other[1]:
        return False
    one, other = one[0], other[0]
    if isinstance(one, Formula):
        return isinstance(other, Formula) and one.text == other.text
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else type(one) is type(other) and one == other


@pytest.mark.parametrize("chapter", bank.chapters())
def test_plain_data_is_judged_as_the_answer_itself(chapter):
    for exercise in bank.exercises(chapter).values():
        for student in (None, "Ada", "Norbert"):
            question = exercise.question(student)
            for name, kind in question.key.items():
                form = eval(kind.asking, vars(answer_sheet))
                right = [bank_forms.key_as_given(kind), *bank_forms.other_forms(kind)]
                wrong = [*bank_forms.wrong_answers(kind), *(value for _, value in question.mistakes[name])]
                for answer in [*right, *wrong] if student is None else right:
                    data = plain(answer)
                    json.dumps(data, allow_nan=False)
                    assert form.written(form.read(data)[0]), f"{name} = {data}"
                    if not alike(read(kind, answer), read(kind, data)):
                        verdicts = [judge(name, kind, one, question.mistakes[name]).status for one in (answer, data)]
                        assert verdicts[0] == verdicts[1], f"{name} = {answer!r}, {data!r}"


@pytest.mark.parametrize("label", bank_forms.NOT_TO_BE_JUDGED)
def test_plain_data_of_what_cannot_be_judged_is_not_judged(label):
    answer = bank_forms.NOT_TO_BE_JUDGED[label]
    for kind in (number(1, "s"), transfer_function(1 / s), settings(PID(1)), word("a", ["a", "b"]), poles([-1])):
        if label != "empty list" or not isinstance(kind, kinds.Poles):
            assert judge("x", kind, plain(answer)).status in (UNJUDGED, OPEN)


def test_a_controller_as_plain_data_is_a_transfer_function_too():
    kind = transfer_function(PID(2, Ti=10).expr)
    assert judge("C", kind, plain(PID(2, Ti=10))).status == RIGHT
    assert judge("C", kind, {"Kp": "?", "form": "serial"}).status == UNJUDGED


@pytest.mark.parametrize("form", ["cascade", None, ["serial"], 3])
def test_a_form_of_controllers_that_there_is_not(form):
    assert judge("C", settings(PID(2, Ti=10)), {"Kp": 2, "Ti": 10, "form": form}).status == UNJUDGED


@pytest.mark.parametrize("text", ["50/pi", "50/π", "pi*50/pi**2", "50/pi s"])
def test_pi_is_a_number_and_no_unit(text):
    assert judge("x", number(50 / np.pi, "s"), text).status == RIGHT


leaves = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.complex_numbers(), st.text(max_size=20), st.binary(),
    st.fractions(), st.decimals(), st.just(...), st.just(object()), st.just(len), st.just(X), st.just(1 / s),
    st.just(PID(2)), st.just(sympy.zoo), st.just(np.array([[1, np.nan]])), st.just(np.datetime64("2020")),
    st.just(PINT.Quantity(1, "m")), st.builds(Odd), st.just(sympy.Eq(X, X + 1)), st.just(sympy.S.Reals),
    st.integers(10**290, 10**310), st.text("s0123456789.+-*/^()exp", max_size=200),
)  # fmt: skip
hashable = st.one_of(st.integers(), st.text(max_size=5), st.complex_numbers(), st.just(X), st.booleans())
anything = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.lists(inner), st.lists(inner).map(tuple), st.lists(inner).map(iter), st.dictionaries(hashable, inner),
        st.sets(hashable), st.lists(st.floats()).map(np.array),
    ),
    max_leaves=30,
)  # fmt: skip


@given(anything)
@example([[]] * 3000)
@example("\ud800")
def test_plain_data_of_anything_is_bounded_json(answer):
    text = json.dumps(plain(answer), allow_nan=False)
    assert len(text) < 10**6
    assert plain(json.loads(text)) == json.loads(text)


# Forms without a key.


@pytest.mark.parametrize("text", ["0,5", "0,5 %/K"])
def test_a_decimal_comma_is_named(text):
    with pytest.raises(Unreadable, match="write the decimal comma as a point"):
        number(0.5, "%/K").read(text)


EVERY_KIND = {
    'number("K/%")': number(2.5, "K/%", "the gain", within=0.02),
    "number()": number(2),
    'numbers("s")': numbers([[1, 2], [3, 4]], "s", "the matrix"),
    "poles()": poles([-1, -2]),
    'poles("1/min")': poles([-1, -2], "1/min"),
    'expression("m³")': expression(X**2 * K, "the volume", unit="m³"),
    'expression("m³", letters="K x y")': expression(X**2 * K, "the volume", letters="K x y", unit="m³"),
    'transfer_function(letters="K T")': transfer_function(K / (5 * s + 1), letters="K T"),
    "transfer_function()": transfer_function(K / (X * s + 1)),
    'time_function("°C")': time_function(1 - sympy.exp(-t / 7), 35, "°C", "the response"),
    "settings()": settings(PID(2, Ti=10)),
    'settings("%/K", time="min", form="serial")': settings(PID(2, Ti=10), "%/K", "min", form="serial"),
    'word(["direct", "reverse"])': word("reverse", ["direct", "reverse"]),
    'words(["a", "b"])': words(["b"], "ab"),
    'words(["a", "b"], ordered=True)': words(["b", "a"], "ab", ordered=True),
    'settings("%")': design(settings(PID(2), "%"), criterion("the gain", lambda pid: pid.Kp, below=3)),
}


@pytest.mark.parametrize("code", EVERY_KIND)
def test_a_form_is_made_again_from_its_code_and_knows_no_key(code):
    kind = EVERY_KIND[code]
    assert kind.asking == code
    form = eval(code, vars(answer_sheet))
    assert form.key is None
    assert form.asking == code
    assert set(vars(form)) <= {"unit", "gain", "time", "form", "among", "ordered", "letters", "_told"}
    assert form.expected


def test_letters_that_the_author_tells_are_demanded_before_the_grader_does():
    told = transfer_function(K / (X * s + 1), letters="K x y")
    with pytest.raises(Unreadable, match="'k' is no letter of this answer: did you mean 'K'"):
        eval(told.asking, vars(answer_sheet)).read("k/(x*s + 1)")
    with pytest.raises(ValueError, match="the key has the letter x: expected only K and s"):
        transfer_function(K / (X * s + 1), letters="K")


@pytest.mark.parametrize(
    ("kind", "solution"),
    [
        (number(8 / 3, "%/K"), "2.6666667 %/K"),
        (numbers([1, 2.5], "s"), "[1, 2.5] s"),
        (numbers([[0, 1], [-2, -3]]), "[[0, 1], [-2, -3]]"),
        (poles([-1 + 2j, -1 - 2j, -3]), "[-1 + 2j, -1 - 2j, -3] rad/s"),
        (transfer_function(2 * sympy.exp(-3 * s) / (10 * s + 1)), "2*exp(-3*s)/(10*s + 1)"),
        (expression(sympy.Rational(12345, 1000003) * X, unit="m"), "0.012344963*x m"),
        (settings(PID(2, Ti=8, Td=2, form="serial"), "%/K"), "Kp = 2 %/K, Ti = 8 s, Td = 2 s, serial form"),
        (settings(PID(2), "%/K"), "Kp = 2 %/K"),
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


def test_what_says_nothing_about_a_form():
    for wrong in (
        lambda: answer_sheet.number("s", 2),
        lambda: answer_sheet.number(within=0.01),
        lambda: answer_sheet.word(key="a"),
    ):
        with pytest.raises(ValueError, match="says nothing about a form"):
            wrong()


@pytest.mark.parametrize("function", [lambda times: 0 * times, np.sin], ids=range(2))
def test_without_a_key_a_function_of_time_is_not_called(function):
    with pytest.raises(Unreadable, match="neither an expression"):
        answer_sheet.time_function().read(function)


# The sheet.


@pytest.fixture
def asked():
    made = answer_sheet.AnswerSheet("Tuning", student="s1001")
    made.asks("1", K=answer_sheet.number("K/%"), T=answer_sheet.number("s"), H=answer_sheet.transfer_function())
    made.asks("2", action=answer_sheet.word(["direct", "reverse"]))
    return made


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"T": "2.5 min"}, "· T: 150 s, converted from min"),
        ({"T": "150"}, "· T: 150 s"),
        ({"T": "two"}, "? T: 'two' is a text that is no number: expected a number, in s"),
        ({"T": ...}, "… T: not answered yet"),
        ({"T": lambda t: t}, "? T: a function cannot be handed in"),
        ({"H": "K*exp(-2*s)/(T*s + 1)"}, "· H: K*exp(-2*s)/(T*s + 1), an expression in K, T and s"),
        ({"H": 2 / (s + X)}, "· H: 2/(s + x), an expression in s and x"),
        ({"H": "y(t)*K_p/(s + 1)"}, "· H: y(t)*K_p/(s + 1), an expression in K_p, s and y"),
        ({"H": "K(s + 1)"}, "? H: K stands before a bracket: a product needs its *"),
        ({"H": "2/(s"}, "? H: 2/(s cannot be read: expected an expression in s, with * for every product"),
        ({"H": PID(2, Ti=10)}, "· H: 2 + 1/(5*s), an expression in s"),
        ({"k": 2}, "? k: this is not asked here: did you mean 'K'?"),
        ({"zzz": 2}, "? zzz: this is not asked here"),
        ({"self": 2, "exercise": 1}, "? self: this is not asked here"),
    ],
)
def test_the_sheet_shows_how_an_answer_is_read(asked, given, says):
    shown = repr(asked.answer("1", **given)).replace("\N{NO-BREAK SPACE}", " ")
    assert says in shown
    assert shown.endswith("This says nothing about right or wrong.")


def test_the_last_answer_counts(asked):
    asked.answer("1", K=1, T=2)
    asked.answer("1", K=..., T="3 min")
    asked.answer(1, H=None)
    assert asked.taken("1") == {"K": 1, "T": "3 min"}
    overview = repr(asked)
    assert "· 1  K: 1" in overview
    assert "… 2  action: not answered yet" in overview
    assert "2 of 4 not answered yet" in overview


def test_only_what_is_asked_is_counted(asked):
    asked.answer("1", K=1, zzz=2, T="two")
    asked.answer("77", Z=1)
    assert repr(asked).endswith("2 of 4 not answered yet, 1 cannot be read")
    asked.answer("1", T=3, H=1)
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
    assert found[0][:2] == ("s1001", "1")
    assert found[0][2] == {"K": "1/3", "odd": plain(Odd()), "open": None}
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


# Assignments.

SOURCE = '''"""Tuning $K$

An introduction.
"""
from loopbook import s, t
from loopbook.exercises.authoring import *
from loopbook.pid import PID
import sympy

SECRET = "a secret of many letters"
z = sympy.Symbol("z")

@exercise("1", title="Gain", points=4)
def first(K=between(2, 6, "K/%"), T=between(15, 40, "s")):
    """It is {K} and {T}."""
    return answers(
        Kp=number(<gain> * K * T, "%/K", "the gain"<within>),
        H=transfer_function(<gain> * K * s / (T + <letter>), letters="q z"),
        y=time_function(<gain> * sympy.exp(-t / T), <gain> * T, "K"),
        A=numbers([<gain> * K, T], what="the matrix"),
        p=poles([-<gain>, -T]),
    )

@first.mistake("That is wrong.")
def _(K, T):
    return {"Kp": <gain> + 1000}

@exercise("2", title="Settings", points=3)
def second(K=between(1, 9), action=choice("heating", "cooling")):
    """K is {K}, {action}."""
    return answers(
        C=design(settings(PID(<gain>, Ti=10), gain="%/K"), criterion("the gain", lambda pid: pid.Kp, above=-10)),
        w=word("<word>", ["direct", "reverse"], "the action"),
        W=words(["<word>", "other"], ["direct", "reverse", "other"], "the steps", ordered=True),
    )
'''


def written(gain="7.125", within="", letter="z", word="direct", text=SOURCE):
    for name, value in {"gain": gain, "within": within, "letter": letter, "word": word}.items():
        text = text.replace(f"<{name}>", value)
    return text


def students(*names):
    return [SimpleNamespace(id=f"s{1001 + k}", name=name) for k, name in enumerate(names)]


@pytest.fixture
def tuning():
    return Assignment.of(written(), "tuning")


def test_an_assignment(tuning):
    assert (tuning.title, tuning.introduction) == ("Tuning $K$", "An introduction.")
    assert list(tuning.exercises) == ["1", "2"]
    assert (tuning.points, tuning.name, tuning.path) == (7, "tuning", None)
    assert tuning.fingerprint == Assignment.of(written(), "other").fingerprint
    assert tuning.fingerprint != Assignment.of(written() + "\n", "tuning").fingerprint


def test_variants_come_from_the_secret_the_student_and_the_exercise(tuning):
    drawn = hashlib.new("sha256")
    for student in ("s1001", "s1002"):
        drawn.update(str(tuning.question(student, "1").values).encode())
    # the same on every machine
    assert drawn.hexdigest()[:12] == "7dfe031acf82"
    other = Assignment.of(written().replace("a secret", "another secret"), "tuning")
    values = [[one.question(f"s{k}", "1").values for k in range(8)] for one in (tuning, other)]
    assert values[0] != values[1]
    assert len({str(one) for one in values[0]}) > 4
    with pytest.raises(GradingError, match="no exercise '9'"):
        tuning.question("s1001", "9")


SECRET = 'SECRET = "a secret of many letters"'
HEAD = f'"Title"\nfrom loopbook.exercises.authoring import *\n{SECRET}\n'
ONE = '@exercise({}, title="A", points={})\ndef first(x=between(1, 9)):\n    "x is {{x}}"\n    return answers({})\n'


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("x = (", "tuning.py, line 1: '(' was never closed"),
        ("\n1/0", "tuning.py, line 2: ZeroDivisionError: division by zero"),
        ("\n\nraise SystemExit", "tuning.py, line 3: SystemExit"),
        ("import nothing_of_this_name", "line 1: ModuleNotFoundError"),
        ("x = 1", "has no docstring"),
        ('"Title"\n', "has no SECRET of at least 16 characters"),
        ('"Title"\nSECRET = "short"', 'write SECRET = "'),
        (HEAD, "has no exercise"),
        (
            HEAD + ONE.format('"1"', 1, "y=x") + ONE.replace("first", "second").format('"1"', 1, "y=x"),
            "two exercises 1",
        ),
        (HEAD + ONE.format("1", 1, "y=x"), "number of an exercise is 1: expected a text"),
        (HEAD + ONE.format('"a b"', 1, "y=x"), "number of an exercise is 'a b'"),
        (HEAD + ONE.format('"1"', 0, "y=x"), "has 0 points"),
        (HEAD + ONE.format('"1"', '"4"', "y=x"), "has '4' points"),
    ],
)
def test_an_error_of_the_author_is_one_sentence(source, says):
    with pytest.raises(GradingError) as error:
        Assignment.of(source, "tuning")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_is_loaded_with_the_modules_beside_it(tmp_path):
    (tmp_path / "heater_constants.py").write_text("GAIN = '7.125'\n")
    path = tmp_path / "tuning.py"
    path.write_text(
        "\N{ZERO WIDTH NO-BREAK SPACE}" + written().replace("import sympy\n", "import sympy, heater_constants\n")
    )
    found = load(path)
    assert (found.name, found.path, found.title) == ("tuning", path, "Tuning $K$")
    with pytest.raises(ModuleNotFoundError):
        __import__("heater_constants_2")
    assert str(tmp_path) not in os.sys.path


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [("a.py", None, "cannot be read"), ("a.txt", b"", "expected a Python module"), ("a.py", b"\xff\xfe", "UTF-8")],
)
def test_what_is_no_assignment(tmp_path, name, content, says):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(GradingError, match=says):
        load(tmp_path / name)


# Releasing.


def code(made):
    return [cell.source for cell in made.cells if cell.cell_type == "code"]


def test_a_released_notebook(tuning):
    made = notebook(tuning, *students("Zoë *Ng*"))
    nbformat.validate(made)
    texts = [cell.source for cell in made.cells if cell.cell_type == "markdown"]
    assert texts[0].startswith("# Tuning $K$\n\n**Zoë \\*Ng\\*** (`s1001`)\n\nAn introduction.\n\n")
    assert texts[1:] == [tuning.question("s1001", one).statement for one in "12"]
    assert code(made)[-3:] == [
        'sheet.answer("1", Kp=..., H=..., y=..., A=..., p=...)', 'sheet.answer("2", C=..., w=..., W=...)', "sheet"
    ]  # fmt: skip
    assert made.metadata.loopbook["student"] == "s1001"
    assert all(cell.execution_count is None and not cell.outputs for cell in made.cells if cell.cell_type == "code")
    names = {}
    for cell in code(made):
        exec(cell, names)
    assert "8 of 8 not answered yet" in repr(names["sheet"])


def test_cells_are_short(tuning):
    for chapter in bank.chapters():
        text = f'"Title"\nfrom loopbook.exercises.bank.{bank.chapters()[chapter]} import *\n{SECRET}\n'
        for cell in code(notebook(Assignment.of(text, "chapter"), *students("Ada"))):
            lines = cell.split("\n")
            assert max(map(len, lines)) <= 88
            assert len(lines) <= 12
            ast.parse(cell)
            _says_nothing(cell)


def _says_nothing(cell):
    """No number stands in the code of a notebook."""
    values = [node.value for node in ast.walk(ast.parse(cell)) if isinstance(node, ast.Constant)]
    assert {type(value) for value in values} <= {str, bool, type(...)}, values


def test_a_notebook_reveals_nothing_of_the_key(tuning):
    for student in students(*["Ada"] * 20):
        made = notebook(tuning, student)
        forms = {"1", "2", "K", "%", "%/K", "q z", "direct", "reverse", "other", tuning.title, student.id}
        for cell in code(made):
            _says_nothing(cell)
            assert {n.value for n in ast.walk(ast.parse(cell)) if isinstance(n, ast.Constant)} - {..., True} <= forms
        stored = notebooks.as_text(made)
        assert "within" not in stored
        assert "7.125" not in stored
        assert tuning.secret not in stored
        for place in tuning.exercises:
            for name, kind in tuning.question(student.id, place).key.items():
                if name not in ("w", "W"):  # their words are those that are offered
                    assert kind.solution not in stored


@pytest.mark.parametrize(
    "other", [{"gain": "-3"}, {"within": ", within=0.2"}, {"letter": "sympy.Symbol('q')"}, {"word": "reverse"}]
)
def test_another_key_gives_the_same_code(tuning, other):
    (student,) = students("Ada")
    assert code(notebook(Assignment.of(written(**other), "tuning"), student)) == code(notebook(tuning, student))


def test_releasing_twice_writes_the_same_bytes(tuning, tmp_path):
    class_list = students("Ada", "Norbert")
    paths = release(tuning, class_list, tmp_path)
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == ["s1001/tuning.ipynb", "s1002/tuning.ipynb"]
    before = [(path.read_bytes(), path.stat().st_mtime_ns) for path in paths]
    assert release(tuning, class_list, tmp_path) == paths
    assert [(path.read_bytes(), path.stat().st_mtime_ns) for path in paths] == before
    assert not notebooks.unfit(notebooks.read(paths[0]))
    # an assignment that was mended takes the place of its former notebooks
    changed = Assignment.of(written().replace("An introduction.", "Another one."), "tuning")
    release(changed, class_list, tmp_path)
    assert "Another one." in paths[0].read_text(encoding="utf-8")


@pytest.mark.parametrize("content", ["work", "edited", "no notebook", "{}"])
def test_work_of_a_student_is_not_overwritten(tuning, tmp_path, content):
    path = release(tuning, students("Ada"), tmp_path)[0]
    if content == "edited":
        content = path.read_text(encoding="utf-8").replace("Kp=...", "Kp=2")
    elif content == "work":
        content = notebooks.as_text(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1")]))
    path.write_text(content, encoding="utf-8")
    with pytest.raises(GradingError, match=r"tuning\.ipynb is in the way and not as it was released"):
        release(tuning, students("Ada", "Norbert"), tmp_path)
    assert path.read_text(encoding="utf-8") == content
    assert not (tmp_path / "s1002").exists()


@pytest.mark.parametrize(
    ("key", "says"),
    [
        ("y=1/(x - x)", "exercise 1 of tuning for student s1001: "),
        ("**{'a b': x}", "asks for 'a b': expected a name"),
        ("**{'if': x}", "asks for 'if': expected a name"),
    ],
)
def test_nothing_is_written_where_a_variant_fails(tmp_path, key, says):
    assignment = Assignment.of(HEAD + ONE.format('"1"', 1, key), "tuning")
    with pytest.raises(GradingError, match=says):
        release(assignment, students("Ada"), tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "{K} and",
            "{Kp} and",
            "exercise 1 has {Kp} in a text: expected one of K, T, or {{Kp}} for the braces themselves",
        ),
        ("is wrong.", "is wrong: {x}.", "exercise 1 has {x} in a text"),
        (
            '{"Kp": 7',
            '{"Kp": "much" or 7',
            'the mistake "That is wrong." of Kp in exercise 1 is no possible answer for K = ',
        ),
        ("above=-10)", "above=8)", "the key of C in exercise 2 would not be right for K = "),
    ],
)
def test_what_an_author_overlooks_is_said_before_anything_is_written(tmp_path, old, new, says):
    text = written()
    assert old in text
    for make in (release, lambda given, *_: nbgrader.source(given)):
        with pytest.raises(GradingError, match=re.escape(says)):
            make(Assignment.of(text.replace(old, new), "tuning"), students("Ada"), tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", [r"$\frac{a}{b} {c}$", r"$${c}$$", "`{c}`", r"\begin{align}", "{{c}}", "{1}", "x_{c}"])
def test_braces_of_formulas_and_code_stay(text):
    def twice(x=authoring.between(1, 9)):
        return authoring.answers(y=2 * x)

    twice.__doc__ = text
    question = checked(authoring.exercise("1", title="Twice")(twice).question, "exercise 1")
    assert text.replace("{{c}}", "{c}") in question.statement


@pytest.mark.parametrize(
    "name",
    [
        "O'Brien, José-Luis (Pepe)",
        "*a* _b_ `c` [d](http://e.example) <b>f</b> &amp; \\g $h$ #i\n# j ![k](l) {m} ~~n~~ @o",
    ],
)
def test_a_name_is_data(name):
    found = as_markdown(name)
    assert "\n" not in found
    assert not re.search(r"(?<!\\)[*_`\[\]{}~!:.@]|<(?!/?span>)|\$|&amp; ", found)
    assert as_markdown("O'Brien, José-Luis (Pepe)") == "O'Brien, José-Luis (Pepe)"


@given(st.lists(st.text("abc, ()\"'[]", min_size=0, max_size=60), max_size=12))
def test_wrapped_code_is_the_same_code(words):
    call = f"sheet.asks({', '.join(['1', *(f'{chr(97 + k)}=word([{w!r}, {w!r}])' for k, w in enumerate(words))])})"
    assert ast.dump(ast.parse(wrapped(call))) == ast.dump(ast.parse(call))


# nbgrader.


def test_a_source_notebook_for_nbgrader(tuning):
    made = nbgrader.source(tuning)
    nbformat.validate(made)
    marks = [cell.metadata.nbgrader for cell in made.cells]
    assert len({one.grade_id for one in marks}) == len(marks)
    for cell, one in zip(made.cells, marks, strict=True):
        assert set(one) - {"points"} == {"schema_version", "grade", "solution", "locked", "task", "grade_id"}
        assert ("points" in one) == one.grade
        assert one.schema_version == 3
        assert cell.cell_type == "code" or (one.locked and not one.grade and not one.solution)
    assert sum(one.get("points", 0) for one in marks) == tuning.points
    by_hand = [one for one in marks if one.grade and one.solution]
    assert [(one.grade_id, one.points) for one in by_hand] == [("exercise-2-by-hand", 1)]


def test_the_hidden_tests_give_all_points_to_the_solution_and_none_to_an_empty_sheet(tuning, capsys):
    for solved in (True, False):
        names, points = {}, 0
        for cell in nbgrader.source(tuning, "s1001").cells:
            marks = cell.metadata.nbgrader
            source = cell.source
            if marks.solution and not solved:
                begin, end = source.index("### BEGIN"), source.index("### END")
                source = source[:begin] + source[end:]
            if cell.cell_type == "code":
                *body, last = ast.parse(source).body
                exec(compile(ast.Module(body, []), "cell", "exec"), names)
                is_value = isinstance(last, ast.Expr)
                value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if is_value else None
                points += value if marks.grade and not marks.solution else 0
        assert points == (6 if solved else 0)
    assert "Kp: right" in capsys.readouterr().out


def test_what_is_graded_by_hand_for_nbgrader():
    by_hand = []
    for chapter in bank.chapters():
        for exercise in bank.exercises(chapter).values():
            for name, kind in exercise.question().key.items():
                if not kind.making and not isinstance(kind, kinds.Design):
                    by_hand.append(f"{exercise.number} {name}")
    assert by_hand == ["9.5 y"]  # it has pieces
