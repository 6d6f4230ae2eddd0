"""A small course to grade: an assignment of two exercises, and a class that has handed in."""

import contextlib
import sys

import nbformat

from exercisegrader.assignment import load
from exercisegrader.grade import grade
from exercisegrader.release import release
from exercisegrader.results import Results
from exercisegrader.roster import read_roster

ASSIGNMENT = '''"""A lag

Two questions.
"""

from exercisebook.authoring import answers, between, exercise, number

SECRET = "a secret of the tests"


@exercise("1", title="The response", points=2)
def response(K=between(2, 6, "K/%"), T=between(15, 40, "s")):
    """A process has the gain {K} and the time constant {T}."""
    return answers(y=number(2 * K, "K", "the response to 2 %"), p=number(-1 / T, "rad/s", "the pole"))


@response.mistake("That is the gain.")
def _(K):
    return {"y": K}


@exercise("2", title="Settings", points=3)
def tuned(K=between(2, 6, "K/%"), T=between(15, 40, "s"), delay=between(2, 6, "s")):
    """A lag has the gain {K}, the time constant {T} and the dead time {delay}."""
    return answers(Ti=number(min(T, 4 * delay), "s", "the integral time"))
'''
SOLUTION = {
    "1": 'sheet.answer("1", y={K} * 2, p=-1 / {T})',
    "2": 'sheet.answer("2", Ti=min({T}, 4 * {delay}))',
}


class Course:
    """A class of a few students, in a folder: who has solved all of it, one who stopped halfway, one who is missing."""

    def __init__(self, folder, students=5):
        self.folder = folder
        self.path = folder / "lag.py"
        self.path.write_text(ASSIGNMENT, encoding="utf-8")
        rows = [f"s{number},Student {number}\n" for number in range(students)]
        (folder / "roster.csv").write_text("id,name\n" + "".join(rows), encoding="utf-8")
        self.assignment = load(self.path)
        self.students = read_roster(folder / "roster.csv")
        self.submissions = folder / "submissions"
        release(self.assignment, self.students[:-1], self.submissions)
        for student in self.students[:-1]:
            halfway = {"1": 'sheet.answer("1", y={K})', "2": "1 / 0"}
            self.fill_in(student.id, halfway if student.id == "s1" else SOLUTION)

    def fill_in(self, student, cells):
        path = self.submissions / student / "lag.ipynb"
        notebook = nbformat.read(path, as_version=4)
        for cell in notebook.cells:
            for number, source in cells.items():
                if cell.source.startswith(f'sheet.answer("{number}"'):
                    values = self.assignment.question(student, number).values
                    cell.source = source.format(**{name: float(value) for name, value in values.items()})
        nbformat.write(notebook, path)

    @contextlib.contextmanager
    def mended(self, path, old, new):
        """The course while a file has another text in a place."""
        before = path.read_bytes()
        assert old.encode() in before
        path.write_bytes(before.replace(old.encode(), new.encode()))
        try:
            yield
        finally:
            path.write_bytes(before)

    def another_answer(self):
        """The course while s2 has answered something else."""
        return self.mended(self.submissions / "s2" / "lag.ipynb", "* 2,", "* 3,")

    def grade(self, to, submissions=None, **options):
        options.setdefault("place", self.place())
        return grade(self.assignment, self.students, submissions or self.submissions, self.folder / to, **options)

    def results(self, to):
        return Results(self.folder / to / "results", self.assignment.secret)

    def handed_in(self, student):
        """The bytes of what a student has handed in."""
        return (self.submissions / student / "lag.ipynb").read_bytes()

    def command(self, to, program="exercisegrader"):
        return [
            sys.executable, "-m", program, "grade", str(self.path), str(self.submissions),
            "--to", str(self.folder / to), "--workers", "1",
        ]  # fmt: skip
