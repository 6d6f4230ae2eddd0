"""The solutions hold for every variant: their cells, run with another student's numbers, give answers that are right.

This confirms the keys too: a solution derives its answers a second time, from the givens alone.
"""

import json
from pathlib import Path

import matplotlib.pyplot
import pytest

from draws import STUDENTS, THOROUGH, of_the_day
from exercisebook.question import Question
from loopbook.exercises import exercise

SOLUTIONS = sorted((Path(__file__).parents[2] / "solutions").glob("*.ipynb"))
#: Its parts are told from the story of one plant, not computed.
ONLY_FOR_THE_REFERENCE = {"1.1"}


def unlike(number):
    """Of ten students of the day, the one whose variant has the fewest values of the reference, where faults hide."""
    reference = exercise(number).values
    return max(
        of_the_day(STUDENTS, 10, number),
        key=lambda name: sum(exercise(number, name).values[one] != value for one, value in reference.items()),
    )


@pytest.fixture(autouse=True)
def _no_windows():
    backend = matplotlib.get_backend()
    matplotlib.use("agg")
    yield
    matplotlib.pyplot.close("all")
    matplotlib.use(backend)


@pytest.mark.parametrize("path", SOLUTIONS, ids=lambda path: path.stem)
def test_a_solution_is_right_for_other_students(path, monkeypatch, subtests):
    responses = []
    check = Question.check
    monkeypatch.setattr(Question, "check", lambda *args, **named: responses.append(check(*args, **named)))
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    imports, *sources = ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    for student in STUDENTS if THOROUGH else [None]:
        with subtests.test(student):
            responses.clear()
            names = {"__name__": path.stem}
            exec(compile(imports, path.name, "exec"), names)
            names["exercise"] = lambda number, name=student: exercise(
                number, None if number in ONLY_FOR_THE_REFERENCE else name or unlike(number)
            )
            for source in sources:
                exec(compile(source, path.name, "exec"), names)
            assert responses
            for response in responses:
                assert response.is_right, response
