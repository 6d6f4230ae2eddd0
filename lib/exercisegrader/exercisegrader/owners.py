"""Whose a submission is, from the name under which it lies; nothing is guessed.

`lms` says which names which system gives. What a student chooses, the file's own name, stands last in all of them and
cannot stand for somebody else.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisegrader import lms

if TYPE_CHECKING:
    from exercisegrader.student import Student


@dataclass(frozen=True)
class Owner:
    """Whose a file or folder is, and what its name says besides.

    Attributes:
        student: whose it is; None where that is not clear.
        reason: where it is not, why.
        late: whether the name says that it came late; None where it says nothing.
        upload: a number that is larger for what the same student handed in later; None where it does not say.
    """

    student: Student | None
    reason: str = ""
    late: bool | None = None
    upload: int | None = None


class Owners:
    """The students of a roster, found by the names that the systems give to their submissions.

    >>> from exercisegrader.student import Student
    >>> owners = Owners([Student("s1001", "Jane Doe", canvas_id="123"), Student("s1002", "John Roe")])
    >>> found = owners.of("doejane_LATE_123_456_heater-1.ipynb")
    >>> found.student.id, found.late, found.upload
    ('s1001', True, 456)
    >>> owners.of("John Roe_7_assignsubmission_file").student.id
    's1002'
    >>> owners.of("s1003").reason
    'is named after no student of the roster'
    """

    def __init__(self, students: Iterable[Student]):
        """Take the students of the roster."""
        self._known, self._systems = lms.Known(students), lms.registered()

    def of(self, name: str) -> Owner:
        """Return whose the submission with this name at the top is."""
        claims = [claim for one in self._systems if (claim := one.claim(name, self._known))]
        found = list({student.id: student for claim in claims for student in claim.students}.values())
        if len(found) > 1:
            return Owner(None, f"may be that of {found[0].id} or of {found[1].id}")
        if not found:
            reasons = [claim.reason for claim in claims if claim.reason]
            return Owner(None, reasons[0] if reasons else "is named after no student of the roster")
        claim = next(claim for claim in claims if claim.students)
        return Owner(found[0], "", claim.late, claim.upload)


def stem(name: str) -> str:
    """The name of a notebook without its ending, any other name as it is.

    >>> stem("s1001.ipynb"), stem("s.1001")
    ('s1001', 's.1001')
    """
    return name[: -len(".ipynb")] if is_notebook(name) else name


def is_notebook(name: str) -> bool:
    """Whether a file of this name is a notebook.

    >>> is_notebook("heater.ipynb"), is_notebook("heater.ipynb.txt")
    (True, False)
    """
    return name.lower().endswith(".ipynb")
