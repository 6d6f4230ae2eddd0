"""The solutions hold for every variant: their cells, run with another student's numbers, give answers that are right.

This confirms the keys too: a solution derives its answers a second time, from the givens alone.
"""

import json
from pathlib import Path

import matplotlib.pyplot
import pytest

from draws import THOROUGH
from loopbook.exercises import exercise
from loopbook.exercises.question import Question

SOLUTIONS = sorted((Path(__file__).parents[2] / "solutions").glob("*.ipynb"))
#: Its parts are told from the story of one plant, not computed.
ONLY_FOR_THE_REFERENCE = {"1.1"}


@pytest.fixture(autouse=True)
def _no_windows():
    backend = matplotlib.get_backend()
    matplotlib.use("agg")
    yield
    matplotlib.pyplot.close("all")
    matplotlib.use(backend)


@pytest.mark.parametrize("student", ["Ada", "Norbert"] if THOROUGH else ["Ada"])
@pytest.mark.parametrize("path", SOLUTIONS, ids=lambda path: path.stem)
def test_a_solution_is_right_for_another_student(path, student, monkeypatch):
    responses = []
    check = Question.check
    monkeypatch.setattr(Question, "check", lambda *args, **named: responses.append(check(*args, **named)))
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    names = {"__name__": path.stem}
    for source in ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"):
        exec(compile(source, path.name, "exec"), names)
        names["exercise"] = lambda number: exercise(number, None if number in ONLY_FOR_THE_REFERENCE else student)
    assert responses
    for response in responses:
        assert response.is_right, response
