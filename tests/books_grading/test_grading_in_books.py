"""What grading does with control engineering: controllers as answers, and the exercises of the chapters."""

import ast
import json
import re
import subprocess
import sys
from importlib import metadata

import nbformat
import pytest
import sympy

from assignments import SECRET, students
from exercisebook.judging import RIGHT, UNJUDGED, WAITING, judge
from exercisegrader.assignment import Assignment
from exercisegrader.inside import answer_sheet
from exercisegrader.inside.plain import plain
from exercisegrader.release import as_text, notebook
from exercisegrader.reports import pages
from exercisegrader.reports.wording import answer_in_words
from loopbook import notebooks, s
from loopbook.deadtime import System
from loopbook.exercises import bank
from loopbook.exercises.authoring import criterion, design, figure, settings, transfer_function
from loopbook.figures import stacked, time_plot
from loopbook.pid import PID

K = sympy.Symbol("K")
HEAD = f'"Tuning"\nfrom loopbook.exercises.authoring import *\nfrom loopbook.pid import PID\n{SECRET}\n'
TUNING = """
from plainmath.expressions import s

@exercise("1", title="Settings", points=6)
def lag(K=between(2, 6, "K/%"), T=between(15, 40, "s")):
    '''A lag has the gain {K} and the time constant {T}.'''
    return answers(
        H=transfer_function(7.125 * K / (T * s + 1), symbols="K T"),
        C=settings(PID(7.125, Ti=T), gain="%/K"),
        D=design(settings(PID(2), "%"), criterion("the gain", lambda pid: pid.Kp, above=1)),
    )
"""


@pytest.fixture(scope="module")
def tuning():
    return Assignment.of(HEAD + TUNING, "tuning")


def code(made):
    return [cell.source for cell in made.cells if cell.cell_type == "code"]


# Controllers.


@pytest.mark.parametrize(
    ("kind", "asking", "solution"),
    [
        (settings(PID(2, Ti=10)), "settings()", "Kp = 2, Ti = 10 s"),
        (
            settings(PID(2, Ti=8, Td=2, form="serial"), "%/K", "min", form="serial"),
            'settings("%/K", time="min", form="serial")',
            "Kp = 2 %/K, Ti = 8 min, Td = 2 min, serial form",
        ),
        (design(settings(PID(2), "%"), criterion("it", abs, above=1)), 'settings("%")', "for example Kp = 2 %"),
        (transfer_function(K / (5 * s + 1), symbols="K T"), 'transfer_function(symbols="K T")', "K/(5*s + 1)"),
    ],
)
def test_a_form_knows_no_key_and_a_solution_is_a_text_for_people(kind, asking, solution):
    form = eval(asking, vars(answer_sheet))
    assert (form.key, form.asking, kind.asking) == (None, asking, asking)
    assert kind.solution.replace("\N{NO-BREAK SPACE}", " ") == solution


@pytest.mark.parametrize(
    ("answer", "data"),
    [
        (PID(sympy.Rational(1, 3), Ti=10), {"Kp": "1/3", "Ti": 10, "Td": 0, "Tf": 0, "form": "parallel"}),
        (PID(2, form="serial"), {"Kp": 2, "Ti": "inf", "Td": 0, "Tf": 0, "form": "serial"}),
        (PID(K, Ti=10), "K*(1 + 1/(10*s))"),
        (System(2 * sympy.exp(-s) / (5 * s + 1)), "2*exp(-s)/(5*s + 1)"),
    ],
    ids=range(4),
)
def test_an_answer_as_plain_data(answer, data):
    assert plain(answer) == data
    assert json.loads(json.dumps(data)) == data


def test_a_controller_as_plain_data_is_a_transfer_function_too():
    kind = transfer_function(PID(2, Ti=10).expr)
    assert judge("C", kind, plain(PID(2, Ti=10))).status == RIGHT
    assert judge("C", kind, {"Kp": "?", "form": "serial"}).status == UNJUDGED


@pytest.mark.parametrize("form", ["cascade", None, ["serial"], 3])
def test_an_unknown_form_of_controllers(form):
    assert judge("C", settings(PID(2, Ti=10)), {"Kp": 2, "Ti": 10, "form": form}).status == UNJUDGED


def test_the_sheet_shows_how_a_controller_is_read():
    sheet = answer_sheet.AnswerSheet("Tuning", student="s1001")
    sheet.asks("1", H=answer_sheet.transfer_function())
    assert "· H: 2 + 1/(5*s), an expression in s" in repr(sheet.answer("1", H=PID(2, Ti=10)))


def test_a_figure_of_the_library_is_taken_down():
    output, control = (time_plot({name: [0, 1]}, [0, 1]) for name in "yu")
    for drawn in (output, stacked(output, control)):
        assert judge("y", figure("the response"), plain(drawn)).status == WAITING


# Released notebooks.


def test_a_released_notebook_runs_in_a_kernel_of_its_own_and_says_what_it_needs(tuning):
    made = notebook(tuning, *students("Ada"))
    nbformat.validate(made)
    assert not notebooks.unfit(made)
    introduction = made.cells[0].source
    assert f"released with loopbook {metadata.version('loopbook-books')}." in introduction
    assert code(made)[0].startswith("from loopbook.grading.answer_sheet import AnswerSheet, settings, transfer_")
    assert "7.125" not in as_text(made)
    program = "\n".join([*code(made), "print(sheet)"])
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8")
    assert done.stdout.endswith("3 of 3 not answered yet\n"), done.stderr


# The chapters.

each_chapter = pytest.mark.parametrize("chapter", bank.chapters())


def _is_data(cell):
    """Whether a cell does nothing but hand out what an exercise measured."""
    return all(isinstance(line, ast.Assign) and isinstance(line.value, ast.List) for line in ast.parse(cell).body)


@each_chapter
def test_released_cells_are_short_and_hold_no_number(chapter):
    chosen = f"globals().update(exercises({chapter!r}))"
    text = f'"Title"\nfrom loopbook.exercises.bank import exercises\n{chosen}\n{SECRET}\n'
    for cell in code(notebook(Assignment.of(text, "chapter"), *students("Ada"))):
        lines = cell.split("\n")
        assert max(map(len, lines)) <= 88
        if not _is_data(cell):
            assert len(lines) <= 12
            values = [node.value for node in ast.walk(ast.parse(cell)) if isinstance(node, ast.Constant)]
            assert {type(value) for value in values} <= {str, bool, type(...)}, values


@each_chapter
def test_plain_data_is_judged_as_the_answer_itself(chapter):
    for exercise in bank.exercises(chapter).values():
        question = exercise.question()
        for name, kind in question.key.items():
            form = eval(kind.asking, vars(answer_sheet))
            readable = [*kind.right_forms(), *question.mistakes[name]]
            for place, (_, answer) in enumerate([*readable, *kind.wrong_forms()]):
                data = plain(answer)
                assert place >= len(readable) or form.written(form.read(data)[0]), f"{name} = {data}"
                verdicts = {judge(name, kind, one, question.mistakes[name]).status for one in (answer, data)}
                assert len(verdicts) == 1, f"{name} = {answer!r}, {data!r}"


def test_every_formula_in_the_sentences_on_mistakes_is_mathml():
    exercises = [one for chapter in ("4", "5", "10", "18") for one in bank.exercises(chapter).values()]
    sentences = [text.replace("{{", "{").replace("}}", "}") for one in exercises for text, _ in one.mistakes]
    formulas = {formula for text in sentences for formula in re.findall(r"\$[^$]+\$", text)}
    assert len(formulas) > 20
    for formula in formulas:
        assert pages.sentence(formula).startswith("<math"), formula
        assert "\\" not in pages.sentence(formula), formula


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"Kp": 2, "Ti": "inf", "Td": 0, "Tf": 0, "form": "parallel"}, "Kp = 2"),
        ({"Kp": "1/3", "Ti": "2 min", "Td": 1, "form": "serial"}, "Kp = 0.33333333, Ti = 2 min, Td = 1, serial form"),
        ({"Kp": "1/0", "Ti": ["</cod"], "form": {}}, "Kp = 1/0, Ti = [</cod]"),
        ({"Kp": 2, "form": "parallel", "more": 1}, "{Kp: 2, form: parallel, more: 1}"),
        ({"Kp": "9" * 400 + "/7", "form": ""}, "Kp = 9999"),
    ],
)
def test_a_controller_in_words(given, says):
    assert answer_in_words(given).startswith(says)
