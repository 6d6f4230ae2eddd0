"""Whose a submission is, from the name under which it lies; nothing is guessed.

Our own: a folder or a notebook named after the student's id.

Canvas names the file of a download `doejane_123_456_heater.ipynb`, or `doejane_LATE_123_456_heater.ipynb`: the sortable
name in small letters without spaces and signs, the number of the student, the number of the file, and the file's own
name. From an anonymous assignment it is `anon_Ab3dE_456_heater.ipynb` (lib/content_zipper.rb in
https://github.com/instructure/canvas-lms).

Moodle names the folder of a download ``Jane Doe_12345_assignsubmission_file``, in older versions with one more
underscore at the end, and without folders the file ``Jane Doe_12345_assignsubmission_file_heater.ipynb``. The number is
that of the grading worksheet; an underscore in the name becomes a space, and of an anonymous submission the name is
Participant (mod/assign/classes/downloader.php in https://github.com/moodle/moodle).

What a student chooses, the file's own name, stands last in all of these and cannot stand for somebody else.
"""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from loopbook.grading.roster import Student

_CANVAS = re.compile(r"(?=_([0-9]+)_[0-9]+_)")
_CANVAS_ANONYMOUS = re.compile(r"(?:LATE_)?anon_[0-9A-Za-z]+_[0-9]+_")
_MOODLE = re.compile(r"([^_]*)_([0-9]+)_assignsubmission_[a-z]+(?:_.*)?", re.DOTALL)


class Owners:
    """The students of a roster, found by the names that the systems give to their submissions.

    >>> from loopbook.grading.roster import Student
    >>> owners = Owners([Student("s1001", "Jane Doe", canvas_id="123"), Student("s1002", "John Roe")])
    >>> owners.of("doejane_LATE_123_456_heater.ipynb")[0].id, owners.of("John Roe_7_assignsubmission_file")[0].id
    ('s1001', 's1002')
    >>> owners.of("s1003")
    (None, 'is named after no student of the roster')
    """

    def __init__(self, students: Iterable[Student]):
        """Take the students of the roster."""
        self._by_id, self._by_canvas, self._by_moodle = defaultdict(list), defaultdict(list), defaultdict(list)
        self._by_name = defaultdict(list)
        for student in students:
            self._by_id[student.id].append(student)
            self._by_canvas[student.canvas_id].append(student)
            self._by_moodle[student.moodle_id].append(student)
            for name in {letters(student.name), letters(student.sortable)}:
                self._by_name[name].append(student)
        for known in (self._by_canvas, self._by_moodle, self._by_name):
            known.pop("", None)  # what is not known of a student finds nobody

    def of(self, name: str) -> tuple[Student | None, str]:
        """The student whose submission has this name at the top, and a reason: a student and "", or None and why."""
        students = [*self._by_id.get(name, ()), *self._by_id.get(stem(name), ())]
        reason = "is named after no student of the roster"
        for others, why in (self._of_canvas(name), self._of_moodle(name)):
            students += others
            reason = why or reason
        found = list({student.id: student for student in students}.values())
        if len(found) > 1:
            return None, f"may be that of {found[0].id} or of {found[1].id}"
        return (found[0], "") if found else (None, reason)

    def _of_canvas(self, name):
        """The students whom a file's name of Canvas may mean, and why there is none.

        A number counts for a student only behind that student's name, where the roster tells how Canvas writes it.
        """
        if _CANVAS_ANONYMOUS.match(name):
            return [], "is from an anonymous download of Canvas, which does not say whose it is"
        numbers = list(_CANVAS.finditer(name))
        if not numbers:
            return [], ""
        found = [self._by_canvas.get(number[1], []) for number in numbers]
        fitting = [
            [student for student in students if _fits(student, name[: number.start()])]
            for number, students in zip(numbers, found, strict=True)
        ]
        if fitting[0]:
            return [student for students in fitting for student in students], ""
        written, number = name[: numbers[0].start()], numbers[0][1]
        if found[0]:
            return [], f"has Canvas's number of {found[0][0].id} and another name"
        named = [student for student in self._by_name.get(_on_time(written), ()) if not student.canvas_id]
        return named, f"has Canvas's number {number[:20]}, which the roster does not have"

    def _of_moodle(self, name):
        """The students whom a name of Moodle may mean, and why there is none."""
        parts = _MOODLE.fullmatch(name)
        if parts is None:
            return [], ""
        students = self._by_moodle.get(parts[2]) or self._by_name.get(letters(parts[1]), [])
        return students, "has a name and a number of Moodle that the roster does not have"


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


def letters(name: str) -> str:
    """Letters and digits of a name, without accents, as small letters: what no system leaves out or changes.

    >>> letters("Müller-Lüdenscheidt, Anne")
    'mullerludenscheidtanne'
    """
    plain = unicodedata.normalize("NFKD", unicodedata.normalize("NFKD", name).casefold())
    return "".join(sign for sign in plain if sign.isalnum())


def _on_time(written):
    """The name in front of Canvas's number, in letters, without the mark of what came late."""
    return letters(written.removesuffix("_LATE"))


def _fits(student, written):
    """Whether the student has the name in front of Canvas's number, as far as the roster tells."""
    return not student.sortable or letters(student.sortable) == _on_time(written)
