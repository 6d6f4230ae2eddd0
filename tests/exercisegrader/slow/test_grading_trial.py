"""Trying an assignment: each fault of small faulty assignments is found, and nothing in a good one."""

import re

import pytest
from typer.testing import CliRunner

from exercisebook.kinds import MAKERS, Kind
from exercisegrader import trial
from exercisegrader.__main__ import app
from exercisegrader.assignment import Assignment
from exercisegrader.trial import NOTE, ODD, WRONG

HEAD = '''"""An assignment that is tried"""

import time

from sympy import exp, symbols

from exercisebook.authoring import *
from plainmath.expressions import s

SECRET = "a secret of the tests"


'''
GOOD = '''
@exercise("1", title="The response")
def response(K=between(2, 6, "K/%"), T=between(15, 40, "s")):
    """A lag has the gain {K} and the time constant {T}. It sees a step of 3 %."""
    return answers(
        y=number(3 * K, "K", "the rise"),
        kind=word("slow" if T > 27 else "quick", ["slow", "quick"], "what it is, slow above 27 s"),
    )


@response.mistake("That is the rise for one percent.")
def _(K):
    return {"y": K}
'''
STUDENTS = [f"s{number:03}" for number in range(40)]


@pytest.mark.parametrize("name", [name for name, kind in MAKERS.items() if not kind.by_hand])
def test_a_kind_is_tried_in_the_forms_in_which_people_write_it(name):
    known = MAKERS[name].right_forms is not Kind.right_forms
    assert known, f"{name} is tried with its key alone: expected its right_forms"


def tried(text, students=STUDENTS, **options):
    """The surprises in an assignment with one exercise: (level, sentence)."""
    (found,) = trial.try_all(Assignment.of(HEAD + text, "tried"), students, **options)
    return found


def test_a_good_exercise_surprises_nobody():
    found = tried(GOOD)
    assert found.surprises == ()
    assert found.level == ""
    assert (found.variants, found.lacks) == (40, ("hints", "a solution"))


def asks(key, more="", parameters='K=between(2, 6, "K/%"), T=between(15, 40, "s")', statement="{K}, {T}.", shown=""):
    """An exercise with this key."""
    return f'''
@exercise("1", title="A fault")
def fault({parameters}):
    """A lag has {statement}"""
    {shown}return answers({key})

{more}
'''


def mistake(body, sentence="That is another one."):
    return f'@fault.mistake("{sentence}")\ndef _(K):\n    {body}\n'


Y = 'y=number(3 * K, "K", "it")'
TOLD = 'y: the mistake "That is another one." '
#: Faulty exercises by the sentences that name what is wrong in them.
WRONG_ONES = {
    "the key of exercise 1 fails: not answered yet, in 2 of 40 variants":
        asks('y=number(1 / (K - 3), "s", "it") if K != 3 else None'),
    "the key of exercise 1 fails: this is ": asks('y=number(5 / (K - 3), "s", "it")'),
    "the key of exercise 1 fails: this is infinite: expected a number, in s, in all 40 variants":
        asks('y=number(float("inf"), "s", "it")'),
    "g: the key is not right, in":
        asks('g=design(number(K, "", "the gain"), criterion("the gain", lambda g: g, below=5))'),
    "y: the key is not right with eight digits, in ": asks('y=number(K / 7, "s", "it", within=0)'),
    f"{TOLD}is right, in all 40 variants": asks(Y, mistake('return {"y": 3.01 * K}')),
    f"{TOLD}is right, in ": asks('y=number(min(K, 4), "K", "it")', mistake('return {"y": K}')),
    f"{TOLD}cannot be judged": asks(Y, mistake('return {"y": "K times three"}')),
    f"{TOLD}cannot be judged, in all": asks(Y, mistake('return {"y": K / 0}')),
    "a mistake of exercise 1 is in 'x': expected 'y'": asks(Y, mistake('return {"x": K}')),
    "y: the key, with the other sign, is right, too, in all 40 variants":
        asks('y=number(3 * K, "K", "it", within=2.5)'),
    'y: the word "Lag" is read as "lag"': asks('y=word("Lag" if K > 4 else "lag", ["lag", "Lag"], "it")'),
    "the statement does not show T, of which the key may depend":
        asks('y=number(3 * K + T, "K", "it")', statement="the gain {K}."),
    "a place of the statement has no value, in all 40 variants":
        asks('y=number(3 * K + T, "K", "it")', statement="the gain {K}, {T} and {gain}."),
    "a place of the statement has no value": asks(Y, '@fault.shows\ndef _(T):\n    return {"T": str(None)}\n'),
    "the statement has a $ without another one": asks(Y, statement="$K = {K}, {T}."),
    "the picture fails, in": asks(Y, '@fault.picture\ndef _(K):\n    """It."""\n    return 1 / 0\n'),
}  # fmt: skip
#: And by those that name what is odd.
ODD_ONES = {
    "g: the key is not right rounded to three digits":
        asks('g=design(number(1 / (7 * K), "", "it"), criterion("K g", lambda g: g * K, below=1/7, above=1/7))'),
    'y: the mistake "The second." gets that of "The first.", in all 40 variants':
        asks(Y, mistake('return {"y": 9 * K}', "The first.") + mistake('return {"y": 9 * K}', "The second.")),
    'y: 2 mistakes have the same sentence, "That is another one.", in all 40 variants': asks(
        'y=word("a" if K > 4 else "b", ["a", "b", "c", "d"], "it")',
        mistake('return {"y": "c"}') + mistake('return {"y": "d"}'),
    ),
    'the mistake "That is another one." occurs in none of 40 variants':
        asks(Y, mistake('return {"y": K} if K > 100 else {}')),
    f"{TOLD}is right when it is rounded": asks('y=number(10, "K", "it")', mistake('return {"y": 10.104}')),
    "g: the example, ten times as much, meets the criteria, too":
        asks('g=design(number(K, "", "the gain"), criterion("the gain", lambda g: abs(g), above=0.01))'),
    "y: the answer is the same in ": asks('y=word("no" if K == 4 else "yes", ["no", "yes"], "it")'),
    "y: the answer is the same for all, 3": asks('y=number(3, "K", "it"), x=number(K, "", "x")'),
    "the answers of one student are right for another one, ":
        asks('y=word("yes" if K > 3 else "no", ["no", "yes"], "it")'),
    "there are only 3 different variants": asks(Y, parameters='K=choice(1, 2, 3, unit="K/%")', statement="{K}."),
    "y: the keys are between ": asks('y=number(K * exp(T), "K", "it")'),
    "y: the key is 0 in ": asks('y=number(K - 4, "K", "it")'),
    "y: a key is 2e-07: another unit makes a number that people write": asks('y=number(K / 10**7, "m", "it")'),
    "y: T rounded to four digits makes it wrong": asks('y=number(T / (T - 15.8), "K", "it")'),
    "y and x have the same answer, in all 40 variants": asks(f'{Y}, x=number(3 * K, "K", "x")'),
    "y: the answer is the given K, in all 40 variants": asks('y=number(K, "K/%", "it")'),
    "the statement has a number of many digits":
        asks(Y, '@fault.shows\ndef _(T):\n    return {"T": f"{float(T) / 7} s"}\n'),
    "a place of the solution has no value": asks(Y, '@fault.solution\ndef _(K):\n    """It is {gain}."""\n'),
    "the key takes 0.": asks(Y, shown="sum(range(10**8 // 5))\n    "),
}  # fmt: skip


@pytest.mark.parametrize("sentence", [*WRONG_ONES, *ODD_ONES])
def test_a_fault_is_found(sentence):
    level, text = (WRONG, WRONG_ONES[sentence]) if sentence in WRONG_ONES else (ODD, ODD_ONES[sentence])
    found = tried(text, STUDENTS[:3] if sentence == "the key takes 0." else STUDENTS)
    said = [(one.level, one.says) for one in found.surprises]
    assert any(one == level and says.startswith(sentence) for one, says in said), said


def test_the_worst_is_said_first_with_a_student_and_an_answer():
    text = asks('y=number(min(K, 4), "K", "it")', mistake('return {"y": K}') + mistake('return {"y": 0}'))
    found = tried(text)
    assert [one.level for one in found.surprises] == sorted((one.level for one in found.surprises), reverse=True)
    first = found.surprises[0]
    question = Assignment.of(HEAD + text, "tried").question(first.student, "1")
    assert question.values["K"] <= 4
    assert first.example == f"{question.values['K']!r}, the key is {question.key['y'].solution}"
    assert f"wrong       {first.says}\n{'':14}{first.student}: {first.example}" in trial.as_text(found)


def test_what_a_person_marks_is_named():
    found = tried(asks(f'{Y}, plot=figure("it"), why=text("why")'))
    assert [(one.level, one.says) for one in found.surprises] == [(NOTE, "a person marks plot and why")]
    alone = tried(asks('why=text("why")', parameters="K=choice(1, 2)", statement="{K}."))
    assert [(one.level, one.says) for one in alone.surprises] == [(NOTE, "a person marks why")]
    assert trial.report([alone]).splitlines()[2] == "nothing surprising"


def test_the_time_is_bounded_and_it_says_how_far_it_came():
    found = tried(asks(Y, shown="time.sleep(0.2)\n    "), seconds=0.5)
    assert 1 <= found.variants < 8
    (note,) = [one for one in found.surprises if one.level == NOTE]
    assert note.says == f"only {found.variants} of 40 variants were tried in 0.5 s: --seconds allows more"


def test_a_key_that_does_not_end(monkeypatch):
    monkeypatch.setattr(trial, "PATIENCE_WITH_KEY", 0.3)
    found = tried(asks(Y, shown="while True: pass\n    "), STUDENTS[:2])
    assert [one.says for one in found.surprises] == ["the key takes longer than 0.3 s, in all 2 variants"]


def test_what_is_done_is_told():
    done = []
    both = HEAD + GOOD + GOOD.replace('"1"', '"2"').replace("response", "second")
    trials = list(trial.try_all(Assignment.of(both, "tried"), STUDENTS[:3], follow=done.append))
    assert done == [1, 2, 3, 3, 4, 5, 6, 6]
    assert trial.report(trials).splitlines() == [
        "nothing surprising",
        "without hints and a solution: 1 and 2",
        "3 variants of each exercise were tried",
    ]


# The command.


@pytest.fixture
def command(tmp_path):
    def run(text, *options):
        (tmp_path / "tried.py").write_text(HEAD + text, encoding="utf-8")
        return CliRunner().invoke(app, ["try", str(tmp_path / "tried.py"), "--variants", "20", *options])

    return run


def test_the_command_ends_well_where_nothing_surprises(command):
    result = command(GOOD)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("nothing surprising\n")


def test_the_command_fails_where_something_is_wrong(command):
    result = command(asks(Y, mistake('return {"y": 3 * K}')))
    assert result.exit_code == 1
    assert result.stdout.startswith("Exercise 1 · A fault\n  wrong       y: the mistake")
    assert re.search(r"exercisegrader try \S+tried.py --student ID --exercise N shows a variant", result.stderr)


def test_the_command_takes_the_class_first(command, tmp_path):
    (tmp_path / "roster.csv").write_text("id,name\nada,Ada\n", encoding="utf-8")
    result = command(asks(Y, mistake('return {"y": 3 * K}')))
    assert "\n              ada: " in result.stdout


def test_the_command_shows_a_student(command):
    result = command(GOOD, "--student", "s0007")
    assert result.exit_code == 0
    values = Assignment.of(HEAD + GOOD, "tried").question("s0007", "1").values
    assert f"s0007: K = {float(values['K']):g} K/%" in result.stdout
    assert re.search(r"\n  right +[\d.]+ \(as it is\)", result.stdout)
    assert "\n              That is the rise for one percent." in result.stdout
    assert "(zero)" in result.stdout


def test_the_command_tries_one_exercise(command):
    both = GOOD + asks(Y, mistake('return {"y": 3 * K}')).replace('"1"', '"2"')
    assert command(both, "--exercise", "1").exit_code == 0
    result = command(both, "--exercise", "3")
    assert (result.exit_code, result.stderr) == (1, "there is no exercise '3' in tried: expected one of 1, 2\n")


def test_an_assignment_that_fails_is_said(command):
    result = command("1 / 0")
    assert result.exit_code == 1
    assert "ZeroDivisionError" in result.stderr
