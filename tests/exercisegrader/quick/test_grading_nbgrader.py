"""The source notebook for nbgrader."""

import nbformat
import pytest

import assignments
from exercisebook import kinds
from exercisegrader import nbgrader
from exercisegrader.assignment import Assignment


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
    made = nbgrader.source(tuning, "s1001")
    assert (assignments.nbgraded(made, solved=True), assignments.nbgraded(made, solved=False)) == (6, 0)
    assert "Kp: right" in capsys.readouterr().out


BY_HAND = '''
@exercise("1", title="A lag", points=6, weights={"T": 2})
def lag(T=between(15, 40, "s"), K=between(2, 6)):
    """It is {T} and {K}."""
    return answers(T=number(T, "s"), K=number(K), sketch=figure("a sketch"), why=text("why", key="one lag"))
'''


def test_figures_and_texts_are_graded_by_hand_and_weights_count_for_nbgrader(capsys):
    made = nbgrader.source(Assignment.of(assignments.HEAD + BY_HAND, "lag"))
    nbformat.validate(made)
    (test, by_hand) = [cell for cell in made.cells if cell.metadata.nbgrader.grade]
    assert (test.metadata.nbgrader.points, by_hand.metadata.nbgrader.points) == (pytest.approx(3.6), pytest.approx(2.4))
    assert (by_hand.metadata.nbgrader.solution, by_hand.metadata.nbgrader.locked) == (True, False)
    assert 'sketch = ...\nwhy = "one lag"\n' in by_hand.source
    assert '{"T": 2}' in test.source
    taken = {"T": 1, "K": 2}
    key = {"T": kinds.Number(1), "K": kinds.Number(3)}
    assert nbgrader.earned(taken, 3.6, {"T": 2}, **key) == pytest.approx(2.4)
    assert nbgrader.earned(taken, 3.6, **key) == pytest.approx(1.8)
    assert "T: right" in capsys.readouterr().out
