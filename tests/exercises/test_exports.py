"""Exports of the bank: what another system says of an answer is what our judge says of it."""

import html
import itertools
from pathlib import Path

import numpy as np
import pytest
import sympy
from typer.testing import CliRunner

from draws import of_the_day
from exercisebook.credit import worth
from exercisebook.export import moodle
from exercisebook.export.cells import CannotHoldError, cells
from exercisebook.export.stack import maxima, stack
from exercisebook.forms.text import sentence
from exercisebook.judging import MISTAKE, judge
from exercisebook.kinds import Expression, Number, Numbers, Poles, TimeFunction
from loopbook.__main__ import app
from loopbook.exercises import bank
from moodle_reader import has_maxima, places, read

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


def typed(value):
    """A list as it is typed for Maxima."""
    if isinstance(value, list):
        return f"[{', '.join(map(typed, value))}]"
    return f"({complex(value).real!r}) + ({complex(value).imag!r})*%i"


def listed_and_formulas(cell):
    """Pairs of an answer as Maxima and as our judge reads it: the right one in some forms, near it, and mistakes."""
    kind = cell.kind
    if isinstance(kind, Expression):
        forms = [kind.expr, sympy.expand(kind.expr), sympy.together(kind.expr), sympy.N(kind.expr, 7), 1.03 * kind.expr]
        forms += [sympy.S(0), sympy.S(1)] if isinstance(kind, TimeFunction) else []  # no mistake is a constant
        values = [kind.read(str(one))[0] for one in forms] + [one.value for one in cell.known[1:]]
        return [(maxima(one.tree), one) for one in values if not one.decides]
    values = [np.asarray(one.value) for one in cell.known]
    near = [values[0] * share for share in (1.004, 0.996, 1.02)]
    return [(typed(one.tolist()), one.tolist()) for one in (*values, *near)]


#: Here an own mistake is taken for it: the two differ only where the right answer is too large or small to compare.
ALIKE = {("8.3", sentence("its unit of time is not the one in the question"))}


@pytest.mark.skipif(not has_maxima(), reason="Maxima is not installed")
@pytest.mark.parametrize("number", of_the_day(list(EXERCISES), 20, "stack"))
def test_a_stack_question_finds_an_answer_where_our_judge_finds_it(number):
    question = EXERCISES[number].question(f"for {number}")
    try:
        (file,) = moodle.exported([[question]], "books", forms=[stack]).files or [None]
    except ValueError:
        return
    if file is None or not any(isinstance(kind, Expression | Numbers | Poles) for kind in question.key.values()):
        return
    (found,) = read(file)
    tried = {
        count: listed_and_formulas(cell)
        for count, cell in enumerate(cells(question), start=1)
        if isinstance(cell.kind, Expression | Numbers | Poles)
    }
    known = {
        count: [sentence(one.says).translate(moodle.IN_A_TEXT) for one in cell.known]
        for count, cell in enumerate(cells(question), start=1)
    }
    said = places(found.element, {count: [one for one, _ in pairs] for count, pairs in tried.items()})
    for count, (name, tree) in enumerate(zip(question.key, found.element.findall("prt"), strict=True), start=1):
        sentences = [one.text or "" for one in tree.findall("node/truefeedback/text")]
        for (_, answer), place in zip(tried.get(count, []), said.get(count, []), strict=True):
            share, says = expected(question, name, answer)
            says = sentence(says.partition(" \N{MIDDLE DOT} read as ")[0]).translate(moodle.IN_A_TEXT)
            assert (place == 1) == (share == 100), (name, str(answer))
            assert place < 2 or says == sentences[place - 1] or (number, says) in ALIKE, (name, str(answer))
            if place == 0 and says and says in sentences:  # one that this is said of has no values there
                assert sentences.count(says) < known[count].count(says), (name, str(answer))


def test_the_command_writes_files_and_names_what_it_leaves_out(tmp_path):
    def export(*words):
        return CliRunner().invoke(app, ["export", *map(str, words)])

    done = export("6.3", "10.1", "1.6", "--moodle", tmp_path / "two.xml", "--stack", "--variants", 2)
    assert done.stdout.startswith("4 questions, exercises in variants: 2; ")
    assert "1 left out, since they ask for what has no place there (design): 1.6" in done.stderr
    assert [one.type for one in read((tmp_path / "two.xml").read_bytes())] == ["stack", "stack", "cloze", "cloze"]
    assert "did you mean '10.9'" in export("10.99", "--moodle", tmp_path / "no.xml").stderr
    assert "expected --moodle FILE or --scorm FILE" in export("10").stderr
    heater = Path(__file__).parents[2] / "examples/course/air_heater.py"
    assert "the keys of an assignment would be in the page" in export(heater, "--scorm", tmp_path / "a.zip").stderr
