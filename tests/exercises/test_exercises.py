"""The exercise bank: every exercise, in the reference variant and in others.

Of each exercise three variants are proved, other ones each day, and by ``make test-all`` 200. Rare mistakes are looked
for in 200.
"""

import inspect
import re

import numpy as np
import pytest
import sympy

import contributing
from draws import STUDENTS, of_the_day
from exercisebook import filling
from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WRONG, judge
from exercisebook.pages.page import Page
from exercisebook.parameters import call
from judged import NOT_TO_BE_JUDGED
from loopbook.exercises import bank, kinds
from loopbook.pid import PID

#: The tests of all exercises, each of a claim.
CLAIMS = []
#: All exercises.
NUMBERS = [number for chapter in bank.chapters() for number in bank.exercises(chapter)]


def each_exercise(claim, numbers=NUMBERS):
    """Make a test of each chapter of a claim about an exercise; the bank is loaded when the test is run."""

    @pytest.mark.parametrize("chapter", bank.chapters())
    def test(chapter, subtests):
        for exercise in bank.exercises(chapter).values():
            if exercise.number in numbers:
                with subtests.test(exercise.number):
                    claim(exercise)

    test.__name__, test.__doc__ = claim.__name__, claim.__doc__
    CLAIMS.append(test)
    return test


def some_exercises(claim):
    """The same for a claim about kinds of answers, of which the bank has many each: a third of them a day."""
    return each_exercise(claim, of_the_day(NUMBERS, len(NUMBERS) // 3, claim.__name__))


# Answers of every kind: the key in many forms, and wrong answers.


def forms(kind):
    """The key as an assignment is tried with it, and in more forms; of a design those that are good enough."""
    if isinstance(kind, kinds.Design):
        return [form for form in forms(kind.example) if kind.agrees(kind.read(form)[0])]
    # a decimal comma may be asked about, as in 1,500
    found = [form for how, form in kind.right_forms() if how != "with a decimal comma"]
    return [*found, *other_forms(kind)]


def other_forms(kind):
    key = kind.key
    match kind:
        case kinds.Number():
            return [np.float64(key), [sympy.Float(key, 17)], f"{key!r} {kind.unit}"]
        case kinds.Numbers():
            return [key * (1 + kind.within / 2)]
        case kinds.Poles():
            values = key.tolist()
            return [np.array(values), {value: values.count(value) for value in values}]
        case kinds.Expression():
            return [f"({kind.expr})*(1 + 2/3) - 2*({kind.expr})/3"]
        case kinds.Settings():
            return [PID(key.Kp * (1 + kind.within / 2), key.Ti, key.Td, key.Tf, key.form)]
        case kinds.Word():
            return [key.capitalize()]
        case kinds.Words():
            return [tuple(key), [word.upper() for word in key]]
        case kinds.SequentialChart():
            return [key.replace("->", "→").replace(">=", "≥").upper(), key.replace("\n", "; ")]
        case kinds.InstrumentDiagram():
            return [key.lower().replace(" ->", " →"), "\n".join(reversed(key.split("; ")))]


def wrong_answers(kind):
    """Those with which an assignment is tried, and of words and lines each that is nearly right."""
    key = kind.key
    match kind:
        case kinds.Design():
            return [form for form in wrong_answers(kind.example) if not kind.agrees(kind.read(form)[0])]
        case kinds.Settings():
            more = [
                PID(key.Kp, 77 if key.Ti == sympy.oo else 1.5 * key.Ti, key.Td, key.Tf, key.form),
                PID(key.Kp, key.Ti, key.Td + 5, key.Tf, key.form),
            ]
        case kinds.Word():
            more = [word for word in kind.among if word != key]
        case kinds.Words():
            more = [[word for word in kind.among if word not in key], key[1:]]
        case kinds.SequentialChart() | kinds.InstrumentDiagram():
            lines = re.split("\n|; ", key)
            return [lines[:n] + lines[n + 1 :] for n in range(len(lines)) if not lines[n].endswith(": none")]
        case _:
            more = []
    return [*(form for _, form in kind.wrong_forms()), *more]


# The reference variant.


@some_exercises
def test_the_key_is_right_in_every_form(exercise):
    question = exercise.question()
    given = {name: kind.as_given for name, kind in question.key.items()}
    assert question.check(**given).is_right, question.check(**given)
    for name, kind in question.key.items():
        assert len(forms(kind)) >= (1 if isinstance(kind, kinds.Design) else 3)
        for form in forms(kind):
            verdict = _verdict(question, name, form)
            assert verdict.status == RIGHT, f"{form!r}: {verdict}"


@some_exercises
def test_wrong_answers_are_wrong(exercise):
    for name, kind in exercise.question().key.items():
        answers = wrong_answers(kind)
        assert len(answers) >= 3 or isinstance(kind, kinds.Word) or kind.key == 0
        for answer in answers:
            assert judge(name, kind, answer).status in (WRONG, MISTAKE), f"{name} = {answer!r}"


@some_exercises
def test_an_answer_that_cannot_be_judged_says_what_is_expected(exercise):
    question = exercise.question()
    for label, answer in of_the_day([*NOT_TO_BE_JUDGED.items()], 5, exercise.number):
        response = question.check(**dict.fromkeys(question.key, answer))
        for verdict in response.verdicts:
            kind = question.key[verdict.name]
            # a truth value answers a question of yes or no, and an empty list may be one of no words or poles
            may_be_judged = (label == "truth" and "yes" in getattr(kind, "among", ())) or (
                label == "empty list" and isinstance(kind, kinds.Words | kinds.Poles) and len(kind.key)
            )
            assert verdict.status in (UNJUDGED, OPEN, *((WRONG, MISTAKE, RIGHT) if may_be_judged else ())), (
                f"{label}: {verdict}"
            )
            assert label != "empty list" or not verdict.is_right
            assert verdict.says
            assert "\n" not in verdict.says
        assert repr(response)
        assert response._repr_html_()


@each_exercise
def test_each_mistake_is_named(exercise):
    """In the reference variant, or where it does not occur there in one of the others."""
    sentences, functions = zip(*exercise.mistakes, strict=True)
    if isinstance(exercise, Page):  # what follows in other quantities is told after all that is wrong at once
        half = len(functions) // 2
        unseen = dict(zip(zip(functions[:half], functions[half:], strict=True), sentences, strict=False))
    else:
        unseen = {(function,): sentence for sentence, function in exercise.mistakes}
    for student in (None, *STUDENTS):
        question = exercise.question.__wrapped__(exercise, student)
        for mistake, sentence in list(unseen.items()):
            found = [item for function in mistake for item in (call(function, question.values) or {}).items()]
            for name, wrong in found:
                verdict = _verdict(question, name, wrong)
                assert verdict.status == MISTAKE, f"{name} = {wrong}: {verdict}"
                if verdict.says.startswith(question.filled_in(sentence)):
                    unseen.pop(mistake, None)
        if not unseen:
            return
    assert not unseen, f"a mistake is never named: {next(iter(unseen.values()))}"


@each_exercise
def test_the_statement_reads_well(exercise):
    text = str(exercise.question().statement)
    assert text.count("$") % 2 == 0
    shows = filter(None, (exercise.shown, exercise.drawn))
    used = {name for function in shows for name in inspect.signature(function).parameters}
    for name in exercise.parameters:
        assert "{" + name + "}" in exercise.statement or name in used, f"{name} is never shown"
    letters = set(re.findall(r"\{\{(\w+)\}\}", exercise.statement))
    for name in re.findall(r"(?<!\{)\{(\w+)\}(?!\})", exercise.statement):
        is_place = name in exercise.parameters or name in call(exercise.shown, exercise.question().values)
        assert is_place or re.search(r"[\\_^\w}]\{" + name + r"\}", exercise.statement), f"nothing fills {{{name}}}"
        assert not is_place or name in letters or "{" + name + "}" not in text
    for name, kind in exercise.question().key.items():
        what = kind.example.what if isinstance(kind, kinds.Design) else kind.what
        assert what not in ("the value", name), f"{name} needs words for what it is"


def _verdict(question, name, answer):
    (verdict,) = [one for one in question.check(**{name: answer}).verdicts if one.name == name]
    return verdict


# What an exercise offers besides its statement.


@each_exercise
def test_hints_and_the_solution_are_complete(exercise):
    assert len(exercise.rungs) >= 3
    assert exercise.insight
    first_of_chapter = exercise.number.endswith(".1")
    for student in (None, "Ada", "Norbert", "Zoe"):
        question = exercise.question.__wrapped__(exercise, student)
        rungs = question.rungs
        assert len(rungs) > len(exercise.rungs) or not first_of_chapter, "the first one fades: a line of three stars"
        question._answered = 1  # the attempt before the solution
        solution = question.solution().text
        for text in (*rungs, solution, question.filled_in(exercise.insight, also={})):
            assert text.count("$") % 2 == 0
            assert not re.search(r"(?<![\\\w}_^{])\{[a-z]\w+\}", re.sub(r"\$\$?.*?\$\$?", "", text, flags=re.S)), text
            assert not re.search(r"\bnan\b|\bNone\b|<function", text)
            assert not re.search(r"\\(d?frac|sqrt|mathrm|text)\s?[0-9.]", text), (
                "a brace of LaTeX was taken for a place"
            )
        for name, kind in question.key.items():
            value = filling.shown(kind.shown).inside
            if len(re.sub(r"\D", "", value)) > 2 and value not in repr(question):  # a small number may be any
                told = [
                    rung for rung in rungs[: len(exercise.rungs)] if re.search(rf"(?<![\d.]){re.escape(value)}", rung)
                ]
                assert not told, f"a hint tells {name}"
            if isinstance(kind, kinds.Number):
                assert filling.shown(kind.key).inside in solution, f"{name} is not in the solution"
            if isinstance(kind, kinds.Word):
                assert kind.key.casefold() in solution.casefold(), f"{name} is not in the solution"


#: Each picture of the reference is drawn in its chapter; those of students, here, of a sixth of the exercises a day.
PICTURED = {*of_the_day(NUMBERS, len(NUMBERS) // 6, "pictures")}


@each_exercise
def test_pictures_are_drawn_from_the_numbers_of_the_student(exercise):
    for function in filter(None, (exercise.drawn, exercise.drawn_in_solution)):
        assert inspect.getdoc(function), "its docstring describes the picture"
    if exercise.drawn is None or exercise.number not in PICTURED:
        return
    images = set()
    for student in (None, *of_the_day(STUDENTS, 4, exercise.number)[:4]):
        picture = exercise.question.__wrapped__(exercise, student).picture
        images.add(picture.png())
        assert picture.alt
        if len(images) == 2:  # some differ in few variants only
            break
    assert len(images) == 2, "the numbers of the student are not in it"
    assert max(map(len, images)) < 100_000


@each_exercise
def test_an_exercise_has_three_mistakes_or_more(exercise):
    assert len(exercise.mistakes) >= 3


def test_there_are_exercises_for_all_that_is_taught():
    assert sum(len(bank.exercises(chapter)) for chapter in bank.chapters()) >= 160


@each_exercise
def test_variants_differ(exercise):
    drawn = set()
    for student in STUDENTS[:20]:
        drawn.add(tuple(map(str, exercise.question.__wrapped__(exercise, student).values.values())))
        if len(drawn) == 8:
            return
    raise AssertionError(f"20 students have {len(drawn)} variants")


@each_exercise
def test_no_word_is_right_in_nearly_every_variant(exercise):
    words = [name for name, kind in exercise.question().key.items() if isinstance(kind, kinds.Word | kinds.Words)]
    answers = {name: [] for name in words}
    for student in STUDENTS[: 40 if words else 0]:
        key = exercise.question.__wrapped__(exercise, student).key
        for name in words:
            answers[name].append(str(key[name].key))
        if all(len(found) - max(map(found.count, found)) >= 4 for found in answers.values()):
            return  # whatever the others have
    for name, found in answers.items():
        most = max(map(found.count, found))
        assert most <= 36, f"{name} is {max(found, key=found.count)} in {most} of 40 variants"


# Many variants.


@each_exercise
def test_variants(exercise):
    for student in of_the_day(STUDENTS, 3, exercise.number):
        question = exercise.question.__wrapped__(exercise, student)
        for name, kind in question.key.items():
            assert _finite(kind), f"the key of {name} is {kind.key} for {question.values}"
            answer, _ = kind.read(kind.as_given)
            assert kind.agrees(answer), f"the key of {name} fails for {question.values}"
            for sentence, wrong in question.mistakes[name]:
                answer, _ = kind.read(wrong)
                assert not kind.agrees(answer), f"{name} = {wrong} passes for {question.values}: {sentence}"


@each_exercise
def test_the_key_of_a_page_has_a_second_way(exercise):
    if not isinstance(exercise, Page):
        return
    for student in of_the_day(STUDENTS, 3, exercise.number):
        question = exercise.question.__wrapped__(exercise, student)
        ways = list(exercise.second_ways(question.values))
        for text, holds, _ in ways:
            assert holds, f"{text} does not hold for {question.values}"
    for name, kind in exercise.question().key.items():
        if isinstance(kind, kinds.Number | kinds.Numbers | kinds.Poles | kinds.Expression | kinds.Settings):
            assert any(re.search(rf"\b{name}\b", text) for text, *_ in ways), f"nothing below Check is about {name}"


def _finite(kind):
    match kind:
        case kinds.Design():
            return _finite(kind.example)
        case kinds.Number() | kinds.Numbers() | kinds.Poles():
            return bool(np.all(np.isfinite(kind.key)))
        case kinds.Settings():
            return kind.key.Kp.is_finite
        case kinds.Expression():
            # a dead time leaves the range of decimal numbers where s is large
            return bool(np.mean(np.isfinite(kind.key(**kind.points()))) > 0.3)
    return True


# The exercise that contributors are shown.

HEATER = contributing.exercise()


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.__name__)
def test_the_exercise_that_contributors_are_shown_is_as_those_of_the_bank(claim, monkeypatch, subtests):
    monkeypatch.setattr(bank, "exercises", lambda chapter: {HEATER.number: HEATER})
    claim("10", subtests)


def test_the_exercise_that_contributors_are_shown_is_one():
    question = HEATER.question()
    assert "a gain of 3\N{NO-BREAK SPACE}K/%, a time constant of 25\N{NO-BREAK SPACE}s" in question.statement.body
    assert [one.status for one in question.check(Kp=25 / 24, Ti=16).verdicts] == [RIGHT, RIGHT]
    assert question.rungs[2] == "With $T_c = \\tau$ there is $K_p = 25/(3 \\cdot 2 \\cdot 4)$."
    assert "$T_i$ = 16\N{NO-BREAK SPACE}s." in question.solution().text
    assert question.picture.alt.endswith("it rises by 3 K/%.")
    wrong = question.check(Kp=25 / 24, Ti=25).verdicts[1]
    assert (wrong.status, wrong.says) == (MISTAKE, "That is the integral time for $c = 4$; here $c = 2$ is asked.")
