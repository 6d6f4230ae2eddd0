"""What grading leaves behind: grades, a page for each student, and a summary for the instructor.

Each output is a text made of results alone, so that it is the same whenever and wherever it is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loopbook.grading import files
from loopbook.grading.reports.feedback import feedback_html, feedback_markdown
from loopbook.grading.reports.grades import grades_csv
from loopbook.grading.reports.gradescope import results_json
from loopbook.grading.reports.summary import summary_html, summary_markdown

if TYPE_CHECKING:
    from loopbook.grading.roster import Student

__all__ = [
    "feedback_html", "feedback_markdown", "grades_csv", "results_json", "summary_html", "summary_markdown", "write_all",
]  # fmt: skip


def write_all(
    folder: str | Path,
    title: str,
    students: Sequence[Student],
    results: Iterable[Mapping[str, Any]],
    complaints: Sequence[str] = (),
    reveal: bool = False,
) -> None:
    """Write all outputs into a folder; nothing is deleted, and what is the same already is not written again.

    The files are `grades.csv`, `summary.html` and `summary.md`, and in `feedback/<id>/` for each student
    `feedback.html`, `feedback.md` and `results.json`, Gradescope's format.

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
    folder = Path(folder)
    by_student = {result["student"]: result for result in results}
    results = [by_student[student.id] for student in students if student.id in by_student]
    files.write(folder / "grades.csv", grades_csv(title, students, results))
    files.write(folder / "summary.html", summary_html(title, students, results, complaints))
    files.write(folder / "summary.md", summary_markdown(title, students, results, complaints))
    for student in students:
        if student.id in by_student:
            result, own = by_student[student.id], folder / "feedback" / student.id
            files.write(own / "feedback.html", feedback_html(title, student, result, reveal))
            files.write(own / "feedback.md", feedback_markdown(title, student, result, reveal))
            files.write(own / "results.json", results_json(result, reveal))
