"""What grading leaves behind: grades, a page for each student, and a summary for the instructor.

Each output is a text made of results alone, so that it is the same whenever and wherever it is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loopbook.grading import files
from loopbook.grading.reports.outputs import Output, output, registered

if TYPE_CHECKING:
    from loopbook.grading.roster import Student

__all__ = ["Output", "output", "registered", "write_all"]


def write_all(
    folder: str | Path,
    title: str,
    students: Sequence[Student],
    results: Iterable[Mapping[str, Any]],
    complaints: Sequence[str] = (),
    reveal: bool = False,
) -> None:
    """Write all that is `registered` into a folder; nothing is deleted, and what is the same is not written again.

    Arguments:
        folder: where to write.
        title: of the assignment.
        students: the roster; outputs keep its order, and a result of nobody in it is left out.
        results: of submissions, as data, in any order.
        complaints: sentences on what was handed in and could not be assigned to a student.
        reveal: whether students see the keys.
    Raises:
        GradingError: where a file cannot be written.
    """
    by_student = {result["student"]: result for result in results}
    results = [by_student[student.id] for student in students if student.id in by_student]
    for one in registered():
        for file, text in one.files(title, students, results, complaints, reveal):
            files.write(Path(folder, file), text)
