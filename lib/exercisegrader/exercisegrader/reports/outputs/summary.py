"""The summary for the instructor: what to look at first, and then how the class did."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisegrader.reports.concerns import ADVICE, concerns
from exercisegrader.reports.findings import Findings
from exercisegrader.reports.outputs import output, registered
from exercisegrader.reports.pages import page
from exercisegrader.reports.wording import in_text

if TYPE_CHECKING:
    from exercisegrader.reports.outputs import Grades

#: The file of this summary.
OWN = "summary.html"


@output(OWN, "the summary for the instructor")
def summary(grades: Grades) -> str:
    """Return the summary; where the folder is known, files that are not there are not told."""
    found, there = Findings(grades), grades.folder
    return page(
        "summary.html",
        f"{in_text(grades.title)}: summary",
        grades=grades,
        found=found,
        graded={mark.result.student for mark in grades.marks},
        names={student.id: student.name for student in grades.students},
        costly=concerns(grades.marks, grades.complaints),
        advice=ADVICE,
        files=[
            one
            for one in registered()
            if one.file != OWN and (there is None or "{" in one.file or (there / one.file).exists())
        ],
    )
