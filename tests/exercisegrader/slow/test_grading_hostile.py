"""Every attack of the hostile corpus ends in a definite verdict, gains nothing, and touches nobody else.

All attacks are one class, with honest students among them; each archive is a class of its own, with the same ones.
"""

import os
import socket
import time
import zipfile
from pathlib import Path

import pytest

import hostile
from executors import lasting
from exercisegrader import GradingError, jail
from exercisegrader.assignment import load
from exercisegrader.grade import grade
from exercisegrader.jail import Limits
from exercisegrader.results import Results
from exercisegrader.student import Student
from hostile import ATTACKS, Target, canary, notebook
from needs import needs_jail

pytestmark = needs_jail

ASSIGNMENT = f'''"""A target"""

from exercisebook.authoring import answers, between, exercise, expression, number, word
from plainmath.expressions import s

SECRET = "{canary("secret")}"
#: {canary("source")}


@exercise("1", title="One", points=1)
def one(K=between(2, 6, step=0.01)):
    """{{K}}"""
    return answers(K=number(2 * K))


@exercise("2", title="Two", points=2)
def two(K=between(2, 6, step=0.01)):
    """{{K}}"""
    return answers(H=expression(K / (3 * s + 1)))


@exercise("3", title="Three", points=4)
def three(K=between(2, 6, step=0.01)):
    """{{K}}"""
    return answers(x=number(3 * K), H=expression(K / (7 * s + 1)))


@exercise("4", title="Four", points=8)
def four(K=between(2, 6, step=0.01)):
    """{{K}}"""
    return answers(becomes=word("a", ["a", "b"]))
'''
LIMITS = Limits(cell=1, total=2.5, cpu=3, memory=400 * jail.MEGA, processes=32)
NAME = "air_heater.ipynb"
#: Students who mean no harm; some attacks reach for the first one.
HONEST = ("s1002", "h0001", "h0002", "h0003")


class Siege:
    """The class of the attackers, what they are after, and what became of it."""

    def __init__(self, folder):
        self.folder, self.submissions = folder, folder / "submissions"
        self.path = folder / "target.py"
        self.path.write_text(ASSIGNMENT, encoding="utf-8")
        self.assignment = load(self.path)
        self.attacks = [attack for attack in ATTACKS if not attack.archive]
        step = len(self.attacks) // len(HONEST)
        names = [f"s{k:04}" for k in range(1, len(self.attacks) + 1)]
        self.attackers = dict(zip(names, self.attacks, strict=True))
        order = [name for k, one in enumerate(HONEST) for name in (*names[k * step : (k + 1) * step], one)]
        self.students = [Student(name, name) for name in [*order, *names[len(HONEST) * step :]]]
        self.valuables = folder / "valuables"
        self.valuables.mkdir()
        for name in ("grades.csv", "result.json", "other.ipynb"):
            (self.valuables / name).write_text(canary("valuables"), encoding="utf-8")
        (folder / "outside").write_text("", encoding="utf-8")
        self.kept = [canary("memory")]  # in this process
        self.open = open(self.valuables / "result.json")  # noqa: SIM115 - it is there to be found
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.unix = socket.socket(socket.AF_UNIX)
        self.unix.bind(str(folder / "s"))
        self.unix.listen()

    def close(self):
        for one in (self.open, self.listener, self.unix):
            one.close()

    def answers(self, student):
        """The cells that answer two exercises correctly."""
        one, two = (self.assignment.question(student, number).given("K") for number in "12")
        return {"1": f'sheet.answer("1", K={float(2 * one)})', "2": f'sheet.answer("2", H="{float(two)}/(3*s + 1)")'}

    def target(self, student):
        valuables = tuple(str(path) for path in sorted(self.valuables.iterdir()))
        return Target(
            answers=self.answers(student),
            leak=("4", "becomes"),
            names=("H",),
            other="s1002",
            reads=(str(self.path), str(self.submissions / "s1002" / NAME), *valuables),
            writes=(str(self.folder / "graded"), str(self.valuables), *valuables),
            outside=str(self.folder / "outside"),
            port=self.listener.getsockname()[1],
            socket=str(self.folder / "s"),
            megabytes=1000,
            processes=200,
        )

    def right(self, student):
        return notebook([Target.setup, *self.answers(student).values(), f'"{canary("submission")}"'])

    def lay(self):
        for student in HONEST:
            (self.submissions / student).mkdir(parents=True)
            (self.submissions / student / NAME).write_bytes(self.right(student))
        for student, attack in self.attackers.items():
            attack.submit(self.target(student), self.submissions, student, NAME)

    def grade(self, submissions, to, place, students=None):
        students = students or self.students
        grade(self.assignment, students, submissions, self.folder / to, place=place, limits=LIMITS)
        return Results(self.folder / to / "results", self.assignment.secret)


@pytest.fixture(scope="module")
def place():
    """Two workers for all classes."""
    with lasting(2) as place:
        yield place


@pytest.fixture(scope="module")
def siege(tmp_path_factory, place):
    made = Siege(tmp_path_factory.mktemp("siege"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(jail, "PATIENCE", 0.5)
        patch.setenv("LOOPBOOK_SECRET", canary("environment"))
        made.lay()
        made.undisturbed = made.grade(
            made.submissions, "quiet", place(), [one for one in made.students if one.id in HONEST]
        )
        made.results = made.grade(made.submissions, "graded", place())
        yield made
    made.close()


@pytest.mark.parametrize("attack", [one for one in ATTACKS if not one.archive], ids=lambda one: one.name)
def test_it_has_a_definite_verdict_and_gains_nothing(siege, attack):
    (student,) = (name for name, one in siege.attackers.items() if one is attack)
    assert attack.complaints(siege.results.of(student), siege.target(student)) == []


def test_everybody_else_is_graded_as_if_nothing_had_happened(siege):
    for student in HONEST:
        result = siege.results.of(student)
        assert (result.status, result.earned, result.looks) == ("complete", 3, ())
        assert result == siege.undisturbed.of(student)


def _files(path):
    """A file that was written, or those packed in it, as names and contents."""
    if path.suffix != ".zip":
        return [(path.name, path.read_bytes())]
    with zipfile.ZipFile(path) as archive:
        return [(f"{path.name}, {name}", archive.read(name)) for name in archive.namelist()]


def test_nothing_got_out(siege):
    for path in sorted((siege.folder / "graded").rglob("*")):
        for name, content in _files(path) if path.is_file() else ():
            assert hostile.leaks(content.decode("utf-8")) == [], name
    assert [path.name for path in siege.folder.glob("outside.*")] == []


def test_nothing_was_changed(siege):
    for path in siege.valuables.iterdir():
        assert path.read_text(encoding="utf-8") == canary("valuables")
    assert len(list(siege.valuables.iterdir())) == 3
    assert siege.path.read_text(encoding="utf-8") == ASSIGNMENT
    for student in HONEST:
        assert (siege.submissions / student / NAME).read_bytes() == siege.right(student)


def test_nobody_called(siege):
    for listener in (siege.listener, siege.unix):
        listener.settimeout(0)
        with pytest.raises(BlockingIOError):
            listener.accept()


def test_nothing_was_left_behind(siege):
    deadline = time.monotonic() + 10
    while hostile.survivors() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert hostile.survivors() == []
    assert not Path("/dev/shm").exists() or not [name for name in os.listdir("/dev/shm") if "loopbook" in name]


@pytest.mark.parametrize("attack", [one for one in ATTACKS if one.archive], ids=lambda one: one.name)
def test_an_archive_harms_nobody(siege, place, attack, tmp_path):
    path = tmp_path / "submissions.zip"
    path.write_bytes(attack.archive("s0001", siege.right("s0001")))
    students = [Student("s0001", "s0001"), Student("s1002", "s1002")]
    refused = ""
    try:
        results = siege.grade(path, tmp_path / "graded", place(), students)
    except GradingError as problem:
        refused = str(problem)
    if refused:
        assert str(path) in refused
    else:
        assert attack.complaints(results.of("s0001"), siege.target("s0001")) == []
        assert results.of("s1002").earned == 0
