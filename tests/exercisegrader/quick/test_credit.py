"""What is worth something though it is not right, by the author's word."""

from pathlib import Path

import pytest

from exercisebook.credit import Credit
from exercisegrader import GradingError
from exercisegrader.assignment import Assignment
from exercisegrader.judge import judged
from exercisegrader.marking import Mark, Marked
from exercisegrader.release import notebook
from exercisegrader.results import Result
from exercisegrader.student import Student
from exercisegrader.trial import one_variant, report, try_all

TEXT = """# Springs

```toml
secret = "a secret of many letters"
credit = CREDIT
```

# 1 A spring (4 points)

A spring of {k} is {x} longer than at rest. How large are the force and the energy in it?

## Given
| name | values | unit | example |
|---|---|---|---|
| k | 300 … 900 by 100 | N/m | 400 |
| x | 3 … 9 by 1 | cm | 5 |

## Formulas
```
F = k*x      [N]
W = F*x/2    [J]
```

## Asked
- `F` the force
- `W` the energy

## Mistakes
- `W = 2*W` (30 %) The force was not as large from the beginning.
- `F = k/x` How does the force grow?
- `x = 2*x` That is for twice the way.
"""
SOME = "{unit = 50, follows = 40, mistake = 20}"


def assignment(credit=SOME):
    return Assignment.of(TEXT.replace("CREDIT", credit), "springs", Path("springs.md"))


def brought(F, W, credit=SOME):
    """What is brought by a force and an energy, as multiples of the right ones."""
    own = assignment(credit)
    question = own.question("s1", "1")
    found = judged(question, {"F": F * question.key["F"].key, "W": W * question.key["W"].key}, credit=own.credit)
    return found, {one.name: one.percent for one in found.answers}


@pytest.mark.parametrize(
    ("given", "percent"),
    [
        ((1, 1), {"F": 0, "W": 0}),
        ((0.001, 2), {"F": 50, "W": 30}),
        ((3.17, 3.17), {"F": 0, "W": 40}),
        ((2, 1), {"F": 20, "W": 0}),
        ((3.17, 7.3), {"F": 0, "W": 0}),
    ],
)
def test_a_unit_a_consequence_and_a_mistake_bring_what_the_author_says(given, percent):
    assert brought(*given)[1] == percent
    assert set(brought(*given, "{}")[1].values()) <= {0, 30}  # a mistake may have a word of its own


def test_what_they_bring_is_a_part_of_the_points():
    found, _ = brought(0.001, 2)
    assert found.earned == pytest.approx(2 * 0.5 + 2 * 0.3)
    result = Result("springs", "s1", "s1.ipynb", True, "", "complete", "", (), (), (found,))
    (exercise,) = Marked.of(result).exercises
    assert dict(exercise.by_place()) == {"1": "1.6", "1 F": "1", "1 W": "0.6"}
    (exercise,) = Marked.of(result, {("1", "W"): Mark(2, "")}).exercises
    assert dict(exercise.by_place()) == {"1": "3", "1 F": "1", "1 W": "2"}
    assert found.answers[0].says.endswith("50\N{NO-BREAK SPACE}% of its points")
    assert "(30 %)" not in found.answers[1].says


def test_the_author_and_the_students_are_told():
    own = assignment()
    assert "the right number in another unit brings 50 %" in own.credit.says
    assert own.credit.says in notebook(own, Student("s1", "Ada")).cells[0].source
    assert Credit().says == ""
    said = report(list(try_all(own, ["s1", "s2"])))
    assert 'W: the mistake "The force was not as large from the beginning." brings 30 % of the points' in said
    assert ", 20 % of the points" in one_variant(own, "s1", "1")


@pytest.mark.parametrize("credit", ["{unit = 100}", "{follows = -1}", "{mistake = true}"])
def test_a_credit_that_is_none_is_refused(credit):
    with pytest.raises(GradingError, match="expected percent of the points"):
        assignment(credit)
