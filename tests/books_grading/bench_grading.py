"""What grading costs: `make bench` runs this too.

A class of 100 on one worker, one of 1000 on two with its memory, and the grader killed at twenty random moments.
"""

import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from statistics import median
from time import perf_counter

from rich.console import Console
from rich.table import Table

from exercisegrader.assignment import load
from exercisegrader.grade import grade, here
from exercisegrader.jail import Jail
from exercisegrader.judge import Judge
from exercisegrader.release import release
from exercisegrader.student import Student

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "examples" / "course"))
from hand_in import fill_in_all, insert  # noqa: E402 - it lies beside the course that it belongs to

IMPORTS = "import control\nimport matplotlib.pyplot as plt\nimport numpy as np\nimport sympy"
STEPS = "times = np.linspace(0, 200, 401)\nresponse = control.step_response(control.tf([2], [30, 1]), times)"
PLOT = "figure, axes = plt.subplots()\naxes.plot(*response)\naxes.set_xlabel('time (s)')\nplt.show()"
SYMBOLS = (
    "s, K, T = sympy.symbols('s K T', positive=True)\n"
    "loop = sympy.simplify(K / (T * s + 1) / (1 + K / (T * s + 1)))\n"
    "sympy.apart(loop.subs({K: 2, T: 30}) / s, s)"
)
#: The cells of an ordinary notebook, each before the exercise of this number.
ORDINARY = (("1", IMPORTS), ("2", STEPS), ("3", PLOT), ("4", SYMBOLS))


class Class:
    """A class of so many students, who all hand in such a notebook: five right answers and the way to them."""

    def __init__(self, folder, size):
        self.folder, self.path = folder, folder / "air_heater.py"
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "examples" / "course" / "air_heater.py", self.path)
        self.assignment = load(self.path)
        self.students = tuple(Student(f"s{number:04}", f"Student {number}") for number in range(size))
        self.submissions = folder / "submissions"
        rows = [f"{student.id},{student.name}\n" for student in self.students]
        (folder / "roster.csv").write_text("id,name\n" + "".join(rows), encoding="utf-8")
        released = release(self.assignment, self.students, self.submissions)
        for student, path in zip(self.students, released.paths, strict=True):
            notebook = json.loads(path.read_text(encoding="utf-8"))
            fill_in_all(notebook, lambda number, student=student: self.assignment.question(student.id, number))
            for number, source in ORDINARY:
                insert(notebook, number, source)
            path.write_text(json.dumps(notebook), encoding="utf-8")

    def grade(self, to, **options):
        grade(self.assignment, self.students, self.submissions, self.folder / to, **options)

    def command(self, to, workers):
        return [
            sys.executable, "-m", "loopbook", "grade", self.path, self.submissions,
            "--students", self.folder / "roster.csv", "--to", self.folder / to, "--workers", str(workers),
        ]  # fmt: skip


def stages(course):
    """Seconds for a notebook in the jail and before the judge, first use apart, and for their starts."""
    start = perf_counter()
    jail = Jail()
    started = perf_counter() - start
    run, judged = [], []
    start = perf_counter()
    with jail, Judge(course.assignment.name, course.assignment.source) as judge:
        judge.judge("nobody", {})
        judge_started = perf_counter() - start
        for student in course.students:
            content = (course.submissions / student.id / "air_heater.ipynb").read_bytes()
            start = perf_counter()
            outcome = jail.run(content)
            run.append(perf_counter() - start)
            start = perf_counter()
            exercises = judge.judge(student.id, outcome.answers)
            judged.append(perf_counter() - start)
            if sum(one.earned for one in exercises) != course.assignment.points:
                raise SystemExit(f"{student.id} has not all points: {exercises}")
    return {"jail, start": started, "judge, start": judge_started, "in the jail": run, "before the judge": judged}


def of_hundred(table, folder):
    """A class of 100 on one worker."""
    course = Class(folder, 100)
    measured = stages(course)
    start = perf_counter()
    course.grade("graded", place=here(1))
    all_of_it = perf_counter() - start
    for name in ("in the jail", "before the judge"):
        table.add_row(f"a notebook {name}", f"{median(measured[name]):.3f} s", f"longest {max(measured[name]):.3f} s")
    table.add_row("starts", f"{measured['jail, start']:.1f} s", f"judge {measured['judge, start']:.1f} s")
    table.add_row("class of 100, one worker", f"{all_of_it:.1f} s", f"{all_of_it / 100:.3f} s a notebook, with starts")
    return course


def of_thousand(table, folder):
    """A class of 1000 on two workers: the time, and the memory of the grader along the way."""
    course = Class(folder, 1000)
    sizes, done = [], threading.Event()

    def watch():
        while not done.wait(1):
            sizes.append(int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 2**20)

    watcher = threading.Thread(target=watch)
    watcher.start()
    start = perf_counter()
    course.grade("graded", place=here(2))
    seconds = perf_counter() - start
    done.set()
    watcher.join()
    quarter = len(sizes) // 4
    table.add_row("class of 1000, two workers", f"{seconds:.0f} s", f"{2 * seconds / 1000:.3f} s a core a notebook")
    memory = f"{median(sizes[quarter : 2 * quarter]):.0f} MB in the second quarter"
    table.add_row(
        "the grader's memory", memory, f"{median(sizes[-quarter:]):.0f} MB in the last, {max(sizes):.0f} at most"
    )


def killed(table, course, times=20):
    """The grader killed at random moments, each time resumed; at last the grades are those of an undisturbed run."""
    dice, kills = random.Random(20), 0
    while kills < times:
        process = subprocess.Popen(course.command("killed", 2), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(dice.uniform(1, 7))
        except subprocess.TimeoutExpired:
            os.kill(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
        else:
            shutil.rmtree(course.folder / "killed")
    subprocess.run(course.command("killed", 2), check=True, capture_output=True)
    same = all(
        (course.folder / "killed" / path.relative_to(course.folder / "graded")).read_bytes() == path.read_bytes()
        for path in (course.folder / "graded").rglob("*")
        if path.is_file()
    )
    table.add_row(
        f"killed at {times} moments, resumed", "the same bytes" if same else "OTHER GRADES", "all outputs compared"
    )


def main():
    """Print the table."""
    table = Table(
        "grading", "median", "", title="a notebook has five answers, NumPy, SymPy, python-control, Matplotlib"
    )
    with tempfile.TemporaryDirectory() as hundred, tempfile.TemporaryDirectory() as thousand:
        course = of_hundred(table, Path(hundred))
        killed(table, course)
        of_thousand(table, Path(thousand))
    Console().print(table)


if __name__ == "__main__":
    start = time.perf_counter()
    main()
    print(f"{time.perf_counter() - start:.0f} s")
