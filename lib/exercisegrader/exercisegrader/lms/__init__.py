"""Learning management systems: what their rosters and downloads say, and the files that they take.

Each module of this folder is one: a class with ``@system``, and functions with ``@output`` for the files in its form. A
new one is a new module here and nothing else: rosters are then recognised, the names in its downloads are read, and its
files are written and listed in the summary.
"""

from __future__ import annotations

import importlib
import io
import pkgutil
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, TypeVar

from exercisegrader import GradingError
from exercisegrader.student import in_short
from exercisegrader.tables import letters

if TYPE_CHECKING:
    from pathlib import Path

    from exercisegrader.student import Student

__all__ = [
    "Claim",
    "Known",
    "Packed",
    "System",
    "demand_place",
    "of",
    "packed",
    "registered",
    "remarks",
    "system",
    "zipped",
]

#: The name of the system that is none: rosters of one's own.
OWN = "own"

_REGISTERED: dict[str, System] = {}
_Class = TypeVar("_Class", bound="type[System]")


class Known:
    """The students of a roster, found by what they are known by; nothing is guessed.

    >>> from exercisegrader.student import Student
    >>> known = Known([Student("s1", "Jané Doe", canvas_id="7"), Student("s2", "John Roe")])
    >>> known.by("canvas_id", "7")[0].id, known.named("Jane  Doe")[0].id, known.by("login", "")
    ('s1', 's1', [])
    >>> found = known.owner("janedoe_LATE_7_456_heater-1.ipynb")
    >>> found.student.id, found.late, found.upload
    ('s1', True, 456)
    >>> known.owner("John Roe_7_assignsubmission_file").student.id, known.owner("s3").reason
    ('s2', 'is named after no student of the roster')
    """

    def __init__(self, students: Iterable[Student]):
        """Take the students of the roster."""
        self._students = tuple(students)
        self._by: dict[str, dict[str, list[Student]]] = {}
        self._names: dict[str, list[Student]] = defaultdict(list)
        for student in self._students:
            for name in {letters(student.name), letters(student.sortable)} - {""}:
                self._names[name].append(student)

    def by(self, field: str, value: str) -> list[Student]:
        """The students of whom a field of `Student` has this value; what is not known of a student finds nobody."""
        if field not in self._by:
            self._by[field] = defaultdict(list)
            for student in self._students:
                self._by[field][getattr(student, field)].append(student)
        return self._by[field].get(value, []) if value else []

    def named(self, name: str) -> list[Student]:
        """The students whose name, or name to sort by, has the same letters."""
        return self._names.get(letters(name), [])

    def owner(self, name: str) -> Claim:
        """Return whose the submission with this name at the top of a download is, by the systems together.

        What a student chooses, the file's own name, stands last in all of them and cannot stand for somebody else.
        """
        claims = [claim for one in registered() if (claim := one.claim(name, self))]
        found = list({student.id: student for claim in claims for student in claim.students}.values())
        if len(found) > 1:
            return Claim(reason=f"may be that of {found[0].id} or of {found[1].id}")
        if not found:
            reasons = [claim.reason for claim in claims if claim.reason]
            return Claim(reason=reasons[0] if reasons else "is named after no student of the roster")
        return replace(next(claim for claim in claims if claim.students), reason="")


@dataclass(frozen=True)
class Claim:
    """What a system reads from the name of a file or folder in a download.

    Attributes:
        students: who may be meant; of the systems together, one at most.
        reason: where nobody is, why.
        late: whether it says that the file came late; None where it says nothing.
        upload: a number that is larger for what the same student handed in later; None where it does not say.
    """

    students: tuple[Student, ...] = ()
    reason: str = ""
    late: bool | None = None
    upload: int | None = None

    @property
    def student(self) -> Student | None:
        """The first of the students; None where nobody is meant."""
        return self.students[0] if self.students else None


@dataclass(frozen=True)
class Packed:
    """Released notebooks in the form in which a system gives each student their own.

    Attributes:
        files: what is to be written, as places and contents.
        says: what to do with it, in sentences.
    """

    files: Mapping[str, bytes]
    says: str


class System:
    """A learning management system. What it does not say is what it cannot do.

    Attributes:
        name: by which the system is told.
        title: as people call it.
        roster: what its rosters are, in some words.
        ids: the fields of `Student` that may give an id, the best first, each with the column as people call it; in
            each row the first that is full is the student's id.
        place: where it hands out notebooks, as ``exercisegrader release --for`` takes it; empty where it cannot.
    """

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    roster: ClassVar[str] = ""
    ids: ClassVar[Mapping[str, str]] = {}
    place: ClassVar[str] = ""

    def columns(self, header: Sequence[str]) -> Mapping[str, int] | None:
        """Return where in a roster with this header which field is; None where it is none of this system.

        The fields are those of `Student`, and whatever else `student` looks at.
        """
        return None

    def student(self, cells: Mapping[str, str]) -> Mapping[str, str] | None:
        """Return what a row says, as fields of `Student`; None where the row is no student's.

        Arguments:
            cells: of the `columns`, by their fields.
        """
        return cells

    def claim(self, name: str, known: Known) -> Claim | None:
        """Return whose a file or folder with this name at the top of a download is; None for a name of another form.

        Arguments:
            name: of the file or folder.
            known: the students.
        """
        return None

    def remarks(self, students: Sequence[Student], title: str, points: float) -> Sequence[str]:
        """Return what an instructor should know before the grades go there, in sentences.

        Arguments:
            students: of a roster of this system.
            title, points: of the assignment.
        """
        return ()

    def pack(self, notebooks: Mapping[Student, Mapping[str, bytes]], assignment: str, secret: str) -> Packed:
        """Return released notebooks as this system hands them out, if it has a `place`.

        Arguments:
            notebooks: names and contents of each student's files.
            assignment: its name.
            secret: of the assignment.
        """
        raise NotImplementedError


def system(kind: _Class) -> _Class:
    """Register a class as a learning management system.

    Raises GradingError where it has no name, or one that is taken.
    """
    if not kind.name or kind.name in _REGISTERED:
        raise GradingError(f"a system has the name {kind.name!r}: expected one that no other has")
    _REGISTERED[kind.name] = kind()
    return kind


def registered() -> tuple[System, ...]:
    """Return the systems, in the order of their names.

    Raises GradingError for a module of this folder that registers none.

    >>> {"canvas", "gradescope", "moodle", "own"} <= {one.name for one in registered()}
    True
    """
    for module in pkgutil.iter_modules(__path__, f"{__name__}."):
        importlib.import_module(module.name)
        if not any(type(one).__module__ == module.name for one in _REGISTERED.values()):
            raise GradingError(f"{module.name} registers no system: expected a class with @system")
    return tuple(sorted(_REGISTERED.values(), key=lambda one: one.name))


def of(students: Iterable[Student]) -> System | None:
    """Return the system whose roster the students are of; None where it is none, or not one alone."""
    names = {student.system for student in students}
    return next((one for one in registered() if {one.name} == names), None)


def remarks(students: Sequence[Student], title: str = "", points: float | None = None) -> tuple[str, ...]:
    """Return what an instructor should know of a roster, in sentences, as where ids come from different columns.

    Arguments:
        students: the roster.
        title, points: of an assignment; with them also what matters before its grades go to the system.
    """
    said: list[str] = []
    by_column: dict[str, list[str]] = defaultdict(list)
    for student in students:
        by_column[student.id_from].append(student.id)
    if len(by_column) > 1:
        (usual, most), *others = sorted(by_column.items(), key=lambda one: -len(one[1]))
        for column, ids in others:
            said.append(
                f"the ids of {len(most)} student{'s' * (len(most) > 1)} come from {usual}, and "
                f"{'those' if len(ids) > 1 else 'that'} of {len(ids)} from {column}: {in_short(ids)}"
            )
    if points is not None and (found := of(students)):
        said += found.remarks(students, title, points)
    return tuple(said)


def demand_place(place: str) -> System:
    """Return the system that hands out notebooks at a place. Raises GradingError where there is none.

    >>> demand_place("moodle").title
    'Moodle'
    """
    places = {one.place: one for one in registered() if one.place}
    if place not in places:
        raise GradingError(f"notebooks cannot be packed for {place!r}: expected one of {', '.join(sorted(places))}")
    return places[place]


def packed(place: str, released: Path, students: Sequence[Student], assignment: str = "", secret: str = "") -> Packed:
    """Return released notebooks in the form in which a system gives each student their own.

    Arguments:
        place: of a `System`, "canvas", "drive" or "moodle".
        released: folder of ``exercisegrader release``, with a folder for each student.
        students: the roster.
        assignment: its name; if not given, the name of the notebooks.
        secret: of the assignment, from which names are drawn that nobody can guess.
    Raises:
        GradingError: for another place, a student without a notebook, and one whom the system could not find.

    >>> import pathlib, tempfile
    >>> from exercisegrader.student import Student
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "s1", "heater.ipynb")
    ...     path.parent.mkdir()
    ...     _ = path.write_text("{}")
    ...     sorted(packed("drive", pathlib.Path(folder), [Student("s1", "Jane Doe")]).files)
    ['Jane Doe (s1)/heater.ipynb', 'folders.csv']
    """
    system_there = demand_place(place)
    notebooks, missing = {}, []
    for student in students:
        found = _files(released / student.id)
        if not found:
            missing.append(student.id)
        notebooks[student] = found
    if missing:
        raise GradingError(
            f"{released} has no notebook of {in_short(missing)}: expected a folder for each student of the roster, as "
            "released"
        )
    names = {name.removesuffix(".ipynb") for found in notebooks.values() for name in found}
    return system_there.pack(notebooks, assignment or min(names, default="notebook"), secret)


def _files(folder):
    """Names and contents of the notebooks in a student's folder."""
    try:
        return {path.name: path.read_bytes() for path in sorted(folder.glob("*.ipynb"))}
    except OSError as problem:
        raise GradingError(f"{folder} cannot be read: {problem.strerror}") from None


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return files as a zip file, which for the same files has the same bytes.

    >>> zipped({"a.txt": b"1"}) == zipped({"a.txt": b"1"})
    True
    """
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            member = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            member.compress_type, member.external_attr, member.create_system = zipfile.ZIP_DEFLATED, 0o644 << 16, 3
            archive.writestr(member, content)
    return memory.getvalue()
