"""Exports of the bank: what another system says of an answer is what our judge says of it."""

import html
import itertools

import pytest

from draws import of_the_day
from exercisebook.credit import worth
from exercisebook.export import moodle
from exercisebook.export.cells import CannotHoldError
from exercisebook.forms.text import sentence
from exercisebook.judging import MISTAKE, judge
from exercisebook.kinds import Number
from loopbook.exercises import bank
from moodle_reader import read

EXERCISES = {number: one for chapter in bank.chapters() for number, one in bank.exercises(chapter).items()}


def answers(question, name):
    """Answers to try: words, or numbers at the right one, at the wrong ones, and around all of these."""
    kind = question.key[name]
    if type(kind) is not Number:
        return kind.among
    wrong = [kind.like(value).key for _, value in question.mistakes[name]]
    off = kind.within * (abs(kind.key) or 1)
    found = [kind.key + share * off for share in (-1.4, -1.02, -0.98, 0, 0.98, 1.02)]
    found += [one * factor for one in wrong for factor in (0.994, 0.996, 1, 1.004, 1.006)]
    found += [one + share * (two - one) for one, two in itertools.pairwise(sorted(wrong)) for share in (0.49, 0.51)]
    return [
        -kind.key,
        *(float(f"{one:.6g}") for one in found),
        *(float(f"{x:.{k}g}") for x in wrong for k in (1, 2, 3)),
    ]


def expected(question, name, answer):
    """The share that our judge gives to an answer, and its sentence where that is of a mistake."""
    known, around = question.mistakes[name], question.background.of(name, {name: answer})
    verdict = judge(name, question.key[name], answer, known, around)
    return 100 if verdict.is_right else verdict.percent, verdict.says if verdict.status == MISTAKE else ""


@pytest.mark.parametrize("number", of_the_day(list(EXERCISES), 40, "cloze"))
def test_a_cloze_question_says_of_an_answer_what_our_judge_says(number):
    question = EXERCISES[number].question(f"for {number}")
    try:
        moodle.cloze(question)
    except CannotHoldError:
        return
    (file,) = moodle.exported([[question]], "books").files
    (found,) = read(file)
    assert [cell.type for cell in found.cells] == [
        "NUMERICAL" if type(kind) is Number else "MULTICHOICE" for kind in question.key.values()
    ]
    for name, cell in zip(question.key, found.cells, strict=True):
        own = {worth(says)[1] for says, _ in question.mistakes[name]}
        for answer in answers(question, name):
            share, says = expected(question, name, answer)
            got, shown = cell.mark(html.escape(answer) if isinstance(answer, str) else f"{answer!r}")
            assert got == share, (name, answer)
            if shown or says in own:  # others are known within less than our judge knows them
                assert shown == sentence(says), (name, answer)
