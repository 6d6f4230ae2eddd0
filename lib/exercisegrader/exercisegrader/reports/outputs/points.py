"""The points of a class as a table: in sum, and of each exercise and quantity."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisegrader.reports.outputs import output
from exercisegrader.reports.wording import number
from exercisegrader.results import MISSING, NOT_RUN
from exercisegrader.tables import as_text

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades

#: The columns by which a gradebook of a term reads the table.
ID, NAME, SECTION, STATE, TOTAL, POSSIBLE = "id", "name", "section", "state", "total", "possible"
#: The head of a column that is there where a submission ran without a jail.
JAILLESS = "graded without a jail"


@output("points.csv", "who the students are, by code too, and the points of each exercise and quantity")
def points_csv(grades: Grades) -> str:
    """Return the points as CSV: id, name, section and code, a sum, and a column for each exercise and quantity.

    A cell is empty where somebody has nothing to judge, or where it waits for a mark; the column "state" says
    which. The total is that of ``grades.csv``: what is deducted for being late is gone from it.

    >>> from exercisegrader.marking import Marked
    >>> from exercisegrader.reports.outputs import Grades
    >>> from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
    >>> from exercisegrader.student import Student
    >>> answers = (JudgedAnswer("K", "right", "right", 2, "2"), JudgedAnswer("T", "wrong", "not right", 3, "4 s"))
    >>> exercise = JudgedExercise("1", "Gain", 3, "", (), answers)
    >>> result = Result("tuning", "s1", "s1.ipynb", True, "", "complete", "", (), (), (exercise,))
    >>> print(points_csv(Grades("Tuning", [Student("s1", "Ada", section="B")], [Marked.of(result)]))[1:])
    id,name,section,code,state,total,possible,deducted,1,1 K,1 T
    s1,Ada,B,,graded,1.5,3,0,1.5,1.5,0
    <BLANKLINE>
    """
    rows = []
    for one, mark in grades.graded:
        total = "" if mark.total is None else number(mark.total)
        who = {ID: one.id, NAME: one.name, SECTION: one.section, "code": mark.code, STATE: mark.state, TOTAL: total}
        judged = () if mark.state in (MISSING, NOT_RUN) else mark.exercises
        points = {place: points for each in judged for place, points in each.by_place()}
        rows.append(who | {POSSIBLE: number(mark.result.points), "deducted": number(mark.deduction)} | points)
    columns = [*dict.fromkeys(column for row in rows for column in row)] or [ID, TOTAL, POSSIBLE]
    head = [*columns, JAILLESS] if grades.without_jail else columns
    return as_text([head, *([row.get(column, "") for column in columns] for row in rows)], bom=True)
