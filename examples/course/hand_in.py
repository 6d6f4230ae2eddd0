"""Hand in what a class might: right, wrong, odd and hostile notebooks, in time and late.

    python hand_in.py air_heater
    python hand_in.py closed_loop

fill in the notebooks in `released`, in the folder in which this runs, and put them into `collected`. The first ones are
collected in folders, with a roster that says when each student handed in; the second ones come from Moodle.
"""

import csv
import json
import os
import re
import shutil
import sys
import zipfile
from datetime import datetime
from pathlib import Path

from exercisegrader.assignment import load
from exercisegrader.release import answer_call
from exercisegrader.released import Released
from exercisegrader.roster import read_roster

_ANSWERS = re.compile(r'sheet\.answer\(\s*"([^"]+)"')


COLLECTED = Path("collected")


def notebook_of(student, assignment):
    """The notebook that a student was given, and a function that returns the question of an exercise."""
    text = Path("released", student, f"{assignment.name}.ipynb").read_text(encoding="utf-8")
    return json.loads(text), lambda number: question_of(student, assignment, number)


def question_of(student, assignment, number):
    """A question with the numbers that were released to a student."""
    return assignment.question(student, number, Released.of(assignment).values(student, number))


def as_text(notebook):
    """A notebook as it is handed in."""
    return json.dumps(notebook, ensure_ascii=False, indent=1) + "\n"


def write_table(path, head, rows):
    """Write a table as CSV."""
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([head, *rows])


# The cells of a notebook.


def cells(notebook):
    """The cells with answers: {number of the exercise: cell}."""
    found = {}
    for cell in notebook["cells"]:
        match = _ANSWERS.search("".join(cell["source"]))
        if cell["cell_type"] == "code" and match:
            found[match[1]] = cell
    return found


def fill(notebook, number, answers):
    """Put answers, as code, into the cell of an exercise."""
    cells(notebook)[number]["source"] = answer_call(number, answers)


def insert(notebook, before, source):
    """Put a new code cell before that of an exercise."""
    cell = {"cell_type": "code", "execution_count": None, "metadata": {}, "outputs": [], "source": source}
    notebook["cells"].insert(notebook["cells"].index(cells(notebook)[before]), cell | {"id": f"own-{before}"})


# Answers as code.


def right(question):
    """The right answers to a question, as code."""
    return {name: kind.as_code() for name, kind in question.key.items()}


def mistaken(question):
    """The first known mistake in each quantity, and half of the key where there is none."""
    found = {}
    for name, kind in question.key.items():
        values = [value for _, value in question.mistakes[name]]
        found[name] = kind.as_code(kind.read(values[0])[0]) if values else f"{kind.as_code()} / 2"
    return found


def fill_in_all(notebook, ask, numbers="12345"):
    """Answer exercises rightly."""
    for number in numbers:
        fill(notebook, number, right(ask(number)))


# The first assignment, in folders. A function changes the notebook, and the place in which it belongs if it is another.

IMPORTS = """
import control
import numpy as np
from sympy import Rational, exp, symbols

from loopbook import s
from loopbook.pid import PID
""".strip()
REDEFINITIONS = """
import builtins
import json

from exercisebook import judging
from loopbook.exercises import kinds

judging.judge = lambda *given: judging.Verdict("K", "right", "right")
kinds.Number.agrees = kinds.Settings.agrees = lambda self, answer: True
json.dumps = lambda *given, **named: '{"earned": 15}'
builtins.abs = builtins.float = lambda x: 0
""".strip()


def all_right(notebook, ask, assignment):
    """Everything is right."""
    fill_in_all(notebook, ask)


def all_wrong(notebook, ask, assignment):
    """In every exercise the mistakes that the assignment knows."""
    for number in assignment.exercises:
        fill(notebook, number, mistaken(ask(number)))


def half(notebook, ask, assignment):
    """Two exercises, a part of a third, and two as they were."""
    fill_in_all(notebook, ask, "12")
    _, *others = ask("4").key
    fill(notebook, "4", {"poles": "...", others[0]: right(ask("4"))[others[0]]})


def other_forms(notebook, ask, assignment):
    """Right answers as they come: other units, texts, SymPy, python-control, the library's own objects."""
    fill_in_all(notebook, ask)
    insert(notebook, "1", IMPORTS)
    first, second, fourth = (ask(number).given for number in "124")
    _, T, tau = ask("1").key.values()
    rational = {name: f'Rational("{first(name)}")' for name in ("rise", "step")}
    minutes, tau = f'"{T.key / 60:.6g} min"', f"np.float64({tau.as_code()})"
    fill(notebook, "1", {"K": f"{rational['rise']} / {rational['step']}", "T": minutes, "tau": tau})
    insert(notebook, "2", f"K, K_p = symbols('K K_p')\nlag = control.tf([{second('K')}], [{second('T')}, 1])")
    H = f'Rational("{second("K")}") / ({second("T")} * s + 1) * exp(-{second("delay")} * s)'
    e_s_1 = f"lag.dcgain() / (1 + lag.dcgain() * {second('K_p')})"
    fill(notebook, "2", {"H": H, "e_s": "1 / (1 / K + K_p)", "e_s_1": e_s_1})
    key = ask("3").key["pid"].key
    fill(notebook, "3", {"pid": f"PID({float(key.Kp):.5g}, Ti={float(key.Ti):.5g})"})
    process = f"control.tf([{fourth('K')}], [{fourth('T')}, 1])"
    controller = f"control.tf([{fourth('K_p')} * {fourth('T_i')}, {fourth('K_p')}], [{fourth('T_i')}, 0])"
    insert(notebook, "4", f"P = {process}\nC = {controller}\nloop = control.feedback(P * C)")
    fill(notebook, "4", {"poles": "loop.poles()", "swings": "bool(abs(loop.poles().imag).max() > 0)"})


def raises(notebook, ask, assignment):
    """A cell fails before the third exercise; what is before and after it counts."""
    fill_in_all(notebook, ask, "1245")
    insert(notebook, "3", "K_p = T / (2 * K * tau)")
    fill(notebook, "3", {"pid": "[K_p, T]"})


def endless(notebook, ask, assignment):
    """A loop that forgets to count comes before the fourth exercise."""
    fill_in_all(notebook, ask)
    insert(notebook, "4", "t = 0\nwhile t < 10:\n    y = 1 - 2.718 ** (-t)")


def without_set_up(notebook, ask, assignment):
    """The first code cell is deleted."""
    fill_in_all(notebook, ask)
    notebook["cells"].remove(next(cell for cell in notebook["cells"] if cell["cell_type"] == "code"))


def first_attempt(notebook, ask, assignment):
    """Two exercises; another attempt will come."""
    fill_in_all(notebook, ask, "12")


def in_disorder(notebook, ask, assignment):
    """Exercises in the opposite order, and the first one twice: the second time it is right."""
    fill_in_all(notebook, ask)
    found = cells(notebook)
    copy = found["1"] | {"id": "copy", "source": found["1"]["source"]}
    fill(notebook, "1", mistaken(ask("1")))
    for cell in found.values():
        notebook["cells"].remove(cell)
    notebook["cells"] += [*reversed(found.values()), copy]
    return "s1008/air_heater-1.ipynb"


def copied(notebook, ask, assignment):
    """The answers of another student, whose numbers are others."""
    for number in assignment.exercises:
        fill(notebook, number, right(question_of("s1001", assignment, number)))


def hostile(notebook, ask, assignment):
    """Redefines whatever might judge, and answers nothing that is right."""
    insert(notebook, "1", REDEFINITIONS)
    for number in assignment.exercises:
        fill(notebook, number, dict.fromkeys(ask(number).key, "1"))


def misnamed(notebook, ask, assignment):
    """All is right, in a file of which nobody can say whose it is."""
    fill_in_all(notebook, ask)
    return "homework final (2).ipynb"


IN_TIME = "2026-11-20 21:40"
AIR_HEATER = [
    ("s1001", all_right, IN_TIME),
    ("s1002", all_wrong, IN_TIME),
    ("s1003", half, "2026-11-22 11:15"),
    ("s1004", other_forms, IN_TIME),
    ("s1005", raises, "2026-11-21 20:05"),
    ("s1006", endless, IN_TIME),
    ("s1007", without_set_up, IN_TIME),
    ("s1008", first_attempt, IN_TIME),
    ("s1008", in_disorder, "2026-11-20 23:10"),
    ("s1009", copied, IN_TIME),
    ("s1010", hostile, IN_TIME),
    ("s1012", misnamed, IN_TIME),
    ("s1013", all_right, IN_TIME),
]


def air_heater(assignment):
    """Hand in the first assignment: a folder for each student, and the roster with times."""
    folder = COLLECTED / "air_heater"
    shutil.rmtree(folder, ignore_errors=True)
    for student, work, time in AIR_HEATER:
        notebook, ask = notebook_of(student, assignment)
        path = folder / (work(notebook, ask, assignment) or f"{student}/air_heater.ipynb")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(as_text(notebook), encoding="utf-8", newline="\n")
        moment = datetime.fromisoformat(time).timestamp()
        os.utime(path, (moment, moment))
    times = {student: time for student, _, time in AIR_HEATER}
    rows = [[one.id, one.name, one.email, one.section, times.get(one.id, "")] for one in read_roster("roster.csv")]
    write_table(Path("handed_in.csv"), ["id", "name", "email", "section", "handed in"], rows)


# The second assignment, from Moodle.

PLOT = """
import matplotlib.pyplot as plt
import numpy as np


def response(K_p, steps=3000, h=0.1):
    y, total, late = [0.0], 0.0, round({delay} / h)
    u = [0.0] * late
    for _ in range(steps):
        error = 1 - y[-1]
        total += error * h
        u.append(K_p * (error + total / {T}))
        y.append(y[-1] + h * ({K} * u[-1 - late] - y[-1]) / {T})
    return np.arange(steps + 1) * h, np.array(y)
""".strip()
DRAW = """
K_p = {T} / ({K} * 2 * {delay})
drawing, axes = plt.subplots()
for gain in (K_p, 2 * K_p):
    axes.plot(*response(gain), label=f"Kp = {{gain:.3g}} %/K")
axes.set_xlabel("time (s)")
axes.set_ylabel("temperature (K)")
axes.legend()
""".strip()
WHY = "With the larger gain the temperature rises earlier, and it overshoots and oscillates: the margin is smaller."
CLOSED_LOOP = [
    ("s1001", {"zeta": "right", "why": WHY}, datetime(2026, 12, 11, 18, 30)),
    ("s1002", {"zeta": "wrong", "why": "It is better."}, datetime(2026, 12, 11, 23, 58)),
    ("s1004", {"zeta": "right"}, datetime(2026, 12, 10, 9, 5)),
    ("s1005", {"zeta": "right", "why": WHY}, datetime(2026, 12, 13, 22, 10)),
    ("s1007", {"zeta": "right", "why": f"{WHY} " * 4}, datetime(2026, 12, 11, 12, 0)),
    ("s1013", {"zeta": "wrong", "why": WHY}, datetime(2026, 12, 9, 16, 45)),
]


def answered(notebook, ask, does):
    """The table is read, rightly or not; both responses are drawn, and explained if there is something to say."""
    fill(notebook, "1", right(ask("1")) if does["zeta"] == "right" else mistaken(ask("1")))
    given = {name: f"{float(value):g}" for name, value in ask("2").values.items()}
    for source in (PLOT, DRAW):
        insert(notebook, "2", source.format(**given))
    Kp = ask("2").key["Kp"].as_code()
    fill(notebook, "2", {"Kp": Kp, "plot": "drawing", "why": repr(does["why"]) if "why" in does else "..."})


def closed_loop(assignment):
    """Hand in the second assignment: Moodle's zip file of submissions, and its grading worksheet."""
    COLLECTED.mkdir(exist_ok=True)
    numbers = {one.id: 77000 + count for count, one in enumerate(read_roster("roster.csv"), start=1)}
    times = {student: time for student, _, time in CLOSED_LOOP}
    names = {one.id: one.name for one in read_roster("roster.csv")}
    with zipfile.ZipFile(COLLECTED / "closed_loop.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for student, does, _ in CLOSED_LOOP:
            notebook, ask = notebook_of(student, assignment)
            answered(notebook, ask, does)
            folder = f"{names[student]}_{numbers[student]}_assignsubmission_file"
            archive.writestr(f"{folder}/closed_loop.ipynb", as_text(notebook))
    rows = []
    for one in read_roster("roster.csv"):
        time = f"{times[one.id]:%A, %-d %B %Y, %-I:%M %p}" if one.id in times else "-"
        status = "Submitted for grading" if one.id in times else "No submission"
        row = [f"Participant {numbers[one.id]}", one.name, one.id, one.email, status, "", f"{assignment.points:.2f}"]
        rows.append([*row, "Yes", time, "-", "", one.section])
    head = "Identifier,Full name,ID number,Email address,Status,Grade,Maximum grade,Grade can be changed"
    last = ["Last modified (submission)", "Last modified (grade)", "Feedback comments", "section"]
    write_table(Path("worksheet.csv"), [*head.split(","), *last], rows)


if __name__ == "__main__":
    {"air_heater": air_heater, "closed_loop": closed_loop}[sys.argv[1]](load(f"{sys.argv[1]}.py"))
