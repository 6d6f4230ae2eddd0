"""The kinds of answers, also those of control engineering: who has them, and that the answers of the bank are code."""

import functools
import subprocess
import sys

import pytest

from draws import THOROUGH, of_the_day
from exercisegrader.inside import answer_sheet
from judged import assert_is_made_again, assert_reads_back
from loopbook.exercises import authoring, bank
from loopbook.exercises.kinds import MAKERS

JUDGED = [name for name, kind in MAKERS.items() if not kind.by_hand]


@pytest.mark.parametrize("name", MAKERS)
def test_a_kind_is_there_for_authors_and_on_the_answer_sheet(name):
    assert getattr(authoring, name) is MAKERS[name]
    assert name in authoring.__all__
    assert name in answer_sheet.__all__


@pytest.mark.parametrize("first", ["exercisebook.bank", "exercisebook.authoring", "loopbook.exercises"])
def test_whatever_is_imported_first_the_answer_sheet_has_all_kinds(first):
    program = f"import {first}; from loopbook.grading import answer_sheet; print(*answer_sheet.__all__)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert {*result.stdout.split()} == {"AnswerSheet", *MAKERS}


@functools.cache
def questions(name):
    """Questions that ask for a kind: five others each day, and in a thorough run all, as three readers have them."""
    made = [one for chapter in bank.chapters() for one in bank.exercises(chapter).values()]
    asking = [one for one in made if any(kind.maker == name for kind in one.question().key.values())]
    readers = (None, "Ada", "Norbert") if THOROUGH else (None,)
    return [one.question(reader) for one in of_the_day(asking, 5, f"as code {name}") for reader in readers]


@pytest.mark.parametrize("name", JUDGED)
def test_answers_as_code_read_back_and_a_kind_is_made_again_from_its_code(name):
    """The key, the mistakes of the exercise, and those that the kind knows by itself."""
    asked = [
        (one, quantity, kind) for one in questions(name) for quantity, kind in one.key.items() if kind.maker == name
    ]
    assert asked, f"no exercise asks for a {name}: add one to a chapter of loopbook.exercises.bank"
    for question, quantity, kind in asked:
        wrong = [value for _, value in (*question.mistakes[quantity], *kind.mistakes())]
        for answer in (kind.key, *(kind.read(value)[0] for value in wrong)):
            assert_reads_back(kind, answer)
    makings = {kind.making: kind for _, _, kind in asked if kind.making}
    assert makings or name == "design", f"no exercise asks for a {name}"  # the criteria of a design are functions
    for kind in makings.values():
        assert_is_made_again(kind, vars(authoring))
