"""What grading leaves behind: grades, a page for each student, and a summary for the instructor.

Each output is made of results alone, so that it is the same whenever and wherever it is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from exercisegrader import files
from exercisegrader.reports.outputs import Grades, Output, output, registered

if TYPE_CHECKING:
    from exercisegrader.marking import Marked
    from exercisegrader.student import Student

__all__ = ["Grades", "Output", "output", "registered", "write_all"]


def write_all(
    folder: str | Path,
    title: str,
    students: Sequence[Student],
    marks: Iterable[Marked],
    complaints: Sequence[str] = (),
    notes: Sequence[str] = (),
    reveal: bool = False,
) -> None:
    """Write all that is `registered` into a folder; nothing is deleted, and what is the same is not written again.

    Arguments:
        folder: where to write.
        title, students, complaints, notes, reveal: as `Grades` has them.
        marks: a `Marked` for each submission, in any order; what belongs to nobody on the roster is left out.
    Raises:
        GradingError: where a file cannot be written.
    """
    by_student = {mark.result.student: mark for mark in marks}
    marks = [by_student[student.id] for student in students if student.id in by_student]
    notebooks = {path.stem for path in Path(folder, "notebooks").glob("*.html")}
    grades = Grades(title, students, marks, complaints, notes, reveal, notebooks, Path(folder))
    for one in sorted(registered(), key=_turn):
        for file, content in one.files(grades):
            files.write(Path(folder, file), content)


def _turn(one):
    """The pages of the students first, which other files hold; the summary last, which tells what is there."""
    return 0 if one.is_for_each_student else 2 if one.file.startswith("summary.") else 1
