"""Submissions: the notebooks in a folder or in the zip file of a learning management system, each with its student.

What is not clearly one student's one notebook is left alone and said.
"""

from __future__ import annotations

import io
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.grading import GradingError
from loopbook.grading.entries import FAILURES, entries, shown, why
from loopbook.grading.owners import Owners, is_notebook
from loopbook.grading.roster import Student
from loopbook.grading.sources import sources

#: The largest file that is read, in bytes; most of a notebook is pictures, which are passed over.
LARGEST = 200 * 2**20
#: The most complaints about what lies in one folder.
MOST_COMPLAINTS = 10


class _Limited(io.RawIOBase):
    """A file of which at most LARGEST bytes are read, whatever was announced."""

    def __init__(self, stream):
        self._stream, self._left = stream, LARGEST

    def read(self, size=-1):
        piece = self._stream.read(size)
        self._left -= len(piece)
        if self._left < 0:
            raise GradingError(_too_large())
        return piece


@dataclass(frozen=True)
class Submission:
    """What one student handed in.

    Attributes:
        student: whose it is.
        label: its name in the folder or zip file, with slashes; signs that cannot be shown are spelled out.
        problem: "", or a sentence why it cannot be run.
    """

    student: Student
    label: str
    problem: str = ""
    _source: Any = field(default=None, repr=False)

    def read(self) -> bytes:
        """The notebook without its outputs, as `sources.sources` returns it.

        Raises GradingError where there is a problem, and where it is not a notebook or can no longer be read.
        """
        if self.problem:
            raise GradingError(self.problem)
        try:
            with self._source.open() as stream:
                return sources(_Limited(stream))
        except FAILURES as problem:
            raise GradingError(f"the file cannot be read: {why(problem)}") from None


@dataclass(frozen=True)
class Collection:
    """What was found.

    Attributes:
        submissions: in the order of the roster, at most one a student.
        complaints: sentences on what was left alone, each with the name of the file.
    """

    submissions: tuple[Submission, ...]
    complaints: tuple[str, ...]


def collect(path: str | Path, students: Sequence[Student], assignment_name: str) -> Collection:
    """The submissions of the students in a folder or a zip file, and complaints about what is none.

    A student's notebook lies in the folder named by the id, or is named by it, or has the name that Canvas or Moodle
    gave it. Where all lies in one folder named like the folder or zip file itself or like the assignment, that one is
    meant. Jupyter's and the system's own files are skipped: names that begin with a dot, and __MACOSX.

    Raises GradingError where there is neither a folder nor a whole zip file.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "s1001.ipynb").write_text("{}"), Path(folder, "s10002.ipynb").write_text("{}")
    ...     found = collect(folder, [Student("s1001", "Jane Doe")], "heater")
    ...     [submission.label for submission in found.submissions], found.complaints
    (['s1001.ipynb'], ('s10002.ipynb: is named after no student of the roster',))
    """
    lying = entries(Path(path), assignment_name, [student.id for student in students])
    owners, complaints, notebooks = Owners(students, assignment_name), _Complaints(), defaultdict(list)
    for entry in lying:
        student, fault = None, entry.fault or ("" if is_notebook(entry.parts[-1]) else "is not a notebook (.ipynb)")
        if not fault:
            found = owners.of(entry.parts[0])
            student, fault = found.student, found.reason
        if fault:
            complaints.add(entry.parts[0], entry.label, fault)
        else:
            notebooks[student.id].append(entry)
    submissions = tuple(_submission(student, notebooks[student.id]) for student in students if notebooks[student.id])
    for submission in submissions:
        if submission.problem:
            complaints.add(submission.student.id, submission.label, submission.problem)
    return Collection(submissions, complaints.all())


def _submission(student, notebooks):
    """The submission of a student with at least one notebook."""
    first = notebooks[0]
    if len(notebooks) > 1:
        names = [entry.label for entry in notebooks[:3]] + [f"{len(notebooks) - 3} more"] * (len(notebooks) > 3)
        number = {2: "two"}.get(len(notebooks), len(notebooks))
        return Submission(
            student, first.label, f"{number} notebooks: {', '.join(names[:-1])} and {names[-1]}; keep one"
        )
    if first.size > LARGEST:
        return Submission(student, first.label, _too_large())
    return Submission(student, first.label, "", first.source)


def _too_large():
    return f"the file is larger than {LARGEST // 2**20} MiB"


class _Complaints:
    """Sentences, of which not too many are about what lies in one folder."""

    def __init__(self):
        self._said = defaultdict(list)
        self._unsaid = defaultdict(int)

    def add(self, top, label, fault):
        if len(self._said[top]) < MOST_COMPLAINTS:
            self._said[top].append(f"{label}: {fault}")
        else:
            self._unsaid[top] += 1

    def all(self):
        for top, number in self._unsaid.items():
            self._said[top].append(f"{shown(top)}: has {number} more that cannot be used")
        return tuple(sentence for sentences in self._said.values() for sentence in sentences)
