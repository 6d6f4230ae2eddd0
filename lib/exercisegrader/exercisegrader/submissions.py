"""Submissions: the notebooks in a folder or in the zip file of a learning management system, each with its student.

What is not clearly one student's one notebook is left alone and said.
"""

from __future__ import annotations

import datetime
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from exercisegrader import GradingError, sources
from exercisegrader.entries import FAILURES, Entry, entries, shown, why
from exercisegrader.lms import Claim, Known
from exercisegrader.student import Student, in_short

#: The most complaints about what lies in one folder.
MOST_COMPLAINTS = 10

#: The words after the fault of a file, and before the notebook of the same student.
BESIDE = ", beside "
#: How a problem begins that is the fault of one file.
FILE = "the file "
#: Zip files tell times in steps of two seconds.
_SAME_TIME = datetime.timedelta(seconds=2)


@dataclass(frozen=True)
class Submission:
    """What one student handed in.

    Attributes:
        student: whose it is.
        label: its name in the folder or zip file, with slashes; signs that cannot be shown are spelled out.
        problem: "", or a sentence why it cannot be run.
        handed_in: when, as the roster says; None where it does not. The time of a file is no such time: it is that of
            a download, of unpacking, or what the student's machine said.
        late: whether its name says that it came late; None where it says nothing.
        chosen: "", or a sentence where it was chosen from several notebooks.
        answers: {exercise: {name: text}} where they were typed from paper; None for a notebook.
    """

    student: Student
    label: str
    problem: str = ""
    handed_in: datetime.datetime | None = None
    late: bool | None = None
    chosen: str = ""
    answers: Mapping[str, Mapping[str, str]] | None = None
    _open: Callable[[], IO[bytes]] | None = field(default=None, repr=False, compare=False)

    def read(self) -> bytes:
        """The notebook without its outputs, as `sources.sources` returns it; of answers on paper, nothing.

        Raises GradingError where there is a problem, and where it is not a notebook or can no longer be read.
        """
        if self.problem:
            raise GradingError(self.problem)
        if self.answers is not None:
            return b""
        try:
            with self._open() as stream:
                return sources.sources(stream)
        except FAILURES as problem:
            raise GradingError(f"the file cannot be read: {why(problem)}") from None


@dataclass(frozen=True)
class Collection:
    """What was found.

    Attributes:
        submissions: in the order of the roster, at most one a student.
        complaints: sentences on what was left alone, and on what was chosen, each with the name of the file.
    """

    submissions: tuple[Submission, ...]
    complaints: tuple[str, ...]


def collect(path: str | Path, students: Sequence[Student], assignment_name: str, latest: bool = False) -> Collection:
    """The submissions of the students in a folder or a zip file, and complaints about what is none.

    A student's notebook lies in the folder named by the id, or is named by it, or has the name that Canvas or Moodle
    gave it. Where all lies in one folder named like the folder or zip file itself or like the assignment, that one is
    meant. Jupyter's and the system's own files are skipped: names that begin with a dot, and __MACOSX.

    Arguments:
        path: of the folder or zip file.
        students: the roster.
        assignment_name: by which its notebooks were released.
        latest: of several notebooks of a student the latest counts: by the number that Canvas gives to each file, else
            by the times of the files. If not given, or where these do not decide, none of them counts.

    Raises GradingError where there is neither a folder nor a whole zip file.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "s1001.ipynb").write_text("{}"), Path(folder, "s10002.ipynb").write_text("{}")
    ...     found = collect(folder, [Student("s1001", "Jane Doe")], "heater")
    ...     [submission.label for submission in found.submissions], found.complaints
    (['s1001.ipynb'], ('s10002.ipynb: is named after no student of the roster',))
    """
    lying = entries(Path(path), assignment_name, [student.id for student in students])
    known, complaints = Known(students), defaultdict(list)
    notebooks, others = defaultdict(list), defaultdict(list)
    for entry in lying:
        owner = known.owner(entry.parts[0])
        fault = entry.fault or ("" if entry.parts[-1].lower().endswith(".ipynb") else "is not a notebook (.ipynb)")
        if owner.student is None:
            complaints[entry.parts[0]].append(f"{entry.label}: {fault or owner.reason}")
        elif fault:
            others[owner.student.id].append((_Notebook(entry, owner), fault))
        else:
            notebooks[owner.student.id].append(_Notebook(entry, owner))
    submissions = []
    for student in students:
        if found := notebooks[student.id]:
            submission = _submission(student, found, latest)
            rest = others[student.id]
        elif others[student.id]:
            (one, fault), *rest = others[student.id]
            complaints[student.id].append(f"{one.entry.label}: {fault}")
            problem = f"{FILE}{fault}"
            submission = Submission(student, one.entry.label, problem, student.handed_in, one.owner.late)
        else:
            continue
        submissions.append(submission)
        says = submission.problem or submission.chosen
        if says and notebooks[student.id]:
            complaints[student.id].append(f"{submission.label}: {says}")
        for one, fault in rest:
            complaints[student.id].append(f"{one.entry.label}: {fault}{BESIDE}{submission.label}")
    return Collection(tuple(submissions), tuple(_told(complaints)))


@dataclass(frozen=True)
class _Notebook:
    """A notebook of a student, as it lies there, and what its name says."""

    entry: Entry
    owner: Claim


def _submission(student, notebooks, latest):
    """The submission of a student with at least one notebook."""
    one, chosen = notebooks[0], ""
    problem = "" if len(notebooks) == 1 else f"{_several(notebooks)}; keep one"
    if problem and latest:
        last, why = _latest(notebooks)
        if last:
            one, problem = last, ""
            chosen = f"counts as the latest, by {why}, of {_several(notebooks)}"
        else:
            problem = f"{_several(notebooks)}; {why}; keep one"
    entry = one.entry
    if not problem and entry.size > sources.LARGEST:
        problem = sources.TOO_LARGE
    opens = None if problem else entry.open
    return Submission(student, entry.label, problem, student.handed_in, one.owner.late, chosen, _open=opens)


def _several(notebooks):
    """That there are several, in words."""
    number = {2: "two"}.get(len(notebooks), len(notebooks))
    return f"{number} notebooks: {in_short([one.entry.label for one in notebooks])}"


def _latest(notebooks):
    """The latest of several notebooks and what tells that; or None, and why nothing tells it."""
    uploads = {one.owner.upload: one for one in notebooks}
    if None not in uploads and len(uploads) == len(notebooks):
        return uploads[max(uploads)], "the numbers of the files in Canvas"
    if any(one.entry.changed is None for one in notebooks):
        return None, "which is the latest is not known, because a file has no time"
    *_, last_but_one, last = sorted(notebooks, key=lambda one: one.entry.changed)
    if last.entry.changed - last_but_one.entry.changed <= _SAME_TIME:
        return None, "which is the latest is not known, because their times are the same"
    return last, "the times of the files"


def _told(complaints):
    """The sentences, of which not too many are about what lies in one folder."""
    for top, said in complaints.items():
        yield from said[:MOST_COMPLAINTS]
        if said[MOST_COMPLAINTS:]:
            yield f"{shown(top)}: has {len(said) - MOST_COMPLAINTS} more that cannot be used"
