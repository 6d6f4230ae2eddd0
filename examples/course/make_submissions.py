"""Release the example assignment, and hand in a dozen notebooks as a class might: right, wrong, odd and hostile.

    python examples/course/make_submissions.py [FOLDER]

writes FOLDER/released and FOLDER/submissions (FOLDER is `build` beside this file if not given). The submissions are
made from the released notebooks: the numbers in them are the students' own, and the same each time.
"""

import json
import re
import shutil
import sys
from pathlib import Path

from loopbook.grading.assignment import load
from loopbook.grading.release import answer_call, release
from loopbook.grading.roster import read_roster

HERE = Path(__file__).parent
_ANSWERS = re.compile(r'sheet\.answer\(\s*"([^"]+)"')


def main(folder):
    """Write the released notebooks and the submissions; what an earlier call has written there is replaced."""
    assignment, students = load(HERE / "air_heater.py"), read_roster(HERE / "roster.csv")
    for name in ("released", "submissions"):
        shutil.rmtree(folder / name, ignore_errors=True)
    names = [student.id for student in students]
    released = dict(zip(names, release(assignment, students, folder / "released").paths, strict=True))
    for name, make in zip(names, SUBMISSIONS, strict=True):
        notebook = json.loads(released[name].read_text(encoding="utf-8"))
        path = make(notebook, lambda number, name=name: assignment.question(name, number), assignment)
        if path:
            path = folder / "submissions" / path.format(id=name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(notebook, ensure_ascii=False, indent=1) + "\n", encoding="utf-8", newline="\n")


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


# What the students hand in, in the order of the roster.

OWN = "{id}/air_heater.ipynb"
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

from loopbook.exercises import judging, kinds

judging.judge = lambda *given: judging.Verdict("K", "right", "right")
kinds.Number.agrees = kinds.Settings.agrees = lambda self, answer: True
json.dumps = lambda *given, **named: '{"earned": 15}'
builtins.abs = builtins.float = lambda x: 0
""".strip()


def all_right(notebook, ask, assignment):
    """Everything is right."""
    fill_in_all(notebook, ask)
    return OWN


def all_wrong(notebook, ask, assignment):
    """In every exercise the mistakes that the assignment knows."""
    for number in assignment.exercises:
        fill(notebook, number, mistaken(ask(number)))
    return OWN


def half(notebook, ask, assignment):
    """Two exercises, a part of a third, and two as they were."""
    fill_in_all(notebook, ask, "12")
    _, *others = ask("4").key
    fill(notebook, "4", {"poles": "...", others[0]: right(ask("4"))[others[0]]})
    return OWN


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
    return OWN


def raises(notebook, ask, assignment):
    """A cell fails before the third exercise; what is before and after it counts."""
    fill_in_all(notebook, ask, "1245")
    insert(notebook, "3", "K_p = T / (2 * K * tau)")
    fill(notebook, "3", {"pid": "[K_p, T]"})
    return OWN


def endless(notebook, ask, assignment):
    """A loop that forgets to count comes before the fourth exercise."""
    fill_in_all(notebook, ask)
    insert(notebook, "4", "t = 0\nwhile t < 10:\n    y = 1 - 2.718 ** (-t)")
    return OWN


def without_set_up(notebook, ask, assignment):
    """The first code cell is deleted."""
    fill_in_all(notebook, ask)
    notebook["cells"].remove(next(cell for cell in notebook["cells"] if cell["cell_type"] == "code"))
    return OWN


def in_disorder(notebook, ask, assignment):
    """Exercises in the opposite order, and the first one twice: the second time it is right."""
    fill_in_all(notebook, ask)
    found = cells(notebook)
    copy = found["1"] | {"id": "copy", "source": found["1"]["source"]}
    fill(notebook, "1", mistaken(ask("1")))
    for cell in found.values():
        notebook["cells"].remove(cell)
    notebook["cells"] += [*reversed(found.values()), copy]
    return OWN


def copied(notebook, ask, assignment):
    """The answers of another student, whose numbers are others."""
    for number in assignment.exercises:
        fill(notebook, number, right(assignment.question("s1001", number)))
    return OWN


def hostile(notebook, ask, assignment):
    """Redefines whatever might judge, and answers nothing that is right."""
    insert(notebook, "1", REDEFINITIONS)
    for number in assignment.exercises:
        fill(notebook, number, dict.fromkeys(ask(number).key, "1"))
    return OWN


def missing(notebook, ask, assignment):
    """Nothing is handed in."""


def misnamed(notebook, ask, assignment):
    """All is right, in a file of which nobody can say whose it is."""
    fill_in_all(notebook, ask)
    return "homework final (2).ipynb"


SUBMISSIONS = (
    all_right, all_wrong, half, other_forms, raises, endless, without_set_up, in_disorder, copied, hostile, missing,
    misnamed,
)  # fmt: skip

if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else HERE / "build")
