"""The diagnoses of wrong numbers, as the exercises of the chapters meet them: hardly any is taken for a mistake."""

import contextlib
import itertools
import math
import random
import re

import pytest

from draws import STUDENTS, THOROUGH, of_the_day
from exercisebook.diagnoses import explained
from exercisebook.diagnoses import numbers as in_numbers
from exercisebook.diagnoses.numbers import FACTORS, GIVENS, MORE, TABLE, found_in, is_recognised
from exercisebook.grammar import Unreadable
from loopbook.exercises import bank
from loopbook.exercises.kinds import Expression, Number


def test_no_diagnosis_stumbles():
    bank_ = [one for chapter in bank.chapters() for one in bank.exercises(chapter).values()]
    for one in of_the_day(bank_, len(bank_) // 6):
        question = one.question()
        for name, kind in question.key.items():
            if isinstance(kind, Expression):
                wrong = [2.5 * kind.expr, (kind.expr + 7) * 5, kind.expr**2, kind.expr - 1 / (kind.expr + 2)]
            else:
                wrong = [value for _, value in (*question.mistakes[name], *kind.mistakes())]
            for answer in (kind.read(value)[0] for value in of_the_day(wrong, 2, f"{one.number} {name}")):
                if not kind.agrees(answer):
                    with contextlib.suppress(Unreadable):  # a list of another length
                        explained(kind, answer, question.background.of(name, {name: answer}))


# The table of mistakes in numbers.


def cases(students):
    """The numbers that are asked for in all exercises, in some variants."""
    for chapter in bank.chapters():
        for one in bank.exercises(chapter).values():
            for student in students:
                question = one.question.__wrapped__(one, student)
                for name, kind in question.key.items():
                    if isinstance(kind, Number):
                        yield question, name, kind


def case_of(question, name, kind, monkeypatch=None):
    """The case that the diagnosis of a number looks at."""
    seen = []
    monkeypatch.setattr(in_numbers, "found_in", lambda answer, case, agrees: seen.append(case))
    explained(kind, math.pi, question.background.of(name, {}))
    monkeypatch.undo()
    return seen[0]


@pytest.mark.parametrize("part", range(4))
def test_each_mistake_is_answered_by_its_own_sentence(part, monkeypatch):
    """Or by that of another mistake with the same value in this variant, one that comes before it."""
    many = [*itertools.islice(cases(STUDENTS if THOROUGH else STUDENTS[:1]), part, None, 4)]
    for place, (question, name, kind) in enumerate(of_the_day(many, len(many) // 6, part)):
        case = case_of(question, name, kind, monkeypatch)
        before = []
        for mistake in (
            (*TABLE, *GIVENS, *FACTORS, *MORE) if THOROUGH or place % 5 == 0 else (*TABLE, *GIVENS, *FACTORS)
        ):  # keys with other givens take time
            for wrong, says in mistake.wrongs(case):
                if not math.isfinite(wrong) or wrong == 0 or kind.agrees(wrong):
                    continue
                before.append((wrong, says))
                if (mistake.is_rarest and not is_recognised(wrong, wrong, is_rarest=True)) or case.is_count(wrong):
                    continue
                found = found_in(wrong, case, kind.agrees)
                alike = {one for value, one in before if is_recognised(wrong, value)}
                assert found is not None, f"{question.exercise.number} {name} = {wrong}: {says}"
                alike |= {
                    one
                    for other in TABLE
                    for value, one in (other.wrongs(case) if other.is_plain else ())
                    if abs(wrong - value) <= case.within * abs(value)
                }
                is_other = found.says.endswith("which factor belongs there?") or found.says.startswith(
                    "that is rounded"
                )
                alike |= {found.says} if is_other else set()
                assert found.says == says or found.says in alike, f"{question.exercise.number} {name} = {wrong}: {says}"


def test_hardly_any_other_number_is_taken_for_a_mistake():
    dice = random.Random(22)
    taken, count = 0, 0
    many = [*cases([None])]
    for question, name, kind in many if THOROUGH else many[::3]:
        for _ in range(6 if THOROUGH else 2):
            answer = kind.key * math.exp(dice.uniform(-2, 2))
            answer = float(f"{answer:.{dice.choice((2, 3))}e}")
            if kind.key and not kind.agrees(answer):
                found = explained(kind, answer, question.background.of(name, {}))
                count += 1
                taken += found.is_mistake
    assert count > 150
    assert taken <= 0.04 * count


def test_no_sentence_tells_the_key(monkeypatch):
    many = [*cases([None])]
    for question, name, kind in of_the_day(many, len(many) // 6, "key"):
        case = case_of(question, name, kind, monkeypatch)
        known = {amount.value for amount in case.givens} | {0, 1, 2, 4, 10, 60, 90, 100, 180, 360, 1000, 3600, 0.632}
        if any(is_recognised(kind.key, value) for value in known if value):
            continue
        answers_ = [wrong for mistake in (*TABLE, *GIVENS, *FACTORS) for wrong, _ in mistake.wrongs(case)]
        for answer in (*answers_[::3], 1.3 * kind.key, 4.7 * kind.key, 1.04 * kind.key):
            if math.isfinite(answer) and not kind.agrees(answer):
                says = explained(kind, answer, question.background.of(name, {})).says.replace(kind.asked, "")
                told = [float(text) for text in re.findall(r"\d+\.?\d*", says)]
                near = [value for value in told if abs(value - abs(kind.key)) <= 1e-3 * abs(kind.key)]
                assert not near, f"{kind.key}: {says}"
