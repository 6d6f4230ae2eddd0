"""A class of four with two exercises, for the tests of the reports: right, mistaken, stopped, missing."""

import base64
from dataclasses import replace

from exercisebook import png
from exercisebook.authoring import answers, between, choice, exercise, expression, number, word
from exercisebook.judging import WAITING
from exercisegrader.marking import Marked
from exercisegrader.reports.outputs import Grades
from exercisegrader.results import CellError, JudgedAnswer, JudgedExercise, Look, Result
from exercisegrader.student import Student
from plainmath.expressions import s

TITLE = "Tuning the air heater"
ADA, BOB, EVE, ZOE = CLASS = (
    Student("s1001", "Ada Lovelace", canvas_id="17", sis_id="900", login="ada", section="A"),
    Student("s1002", "Bob Bode"),
    Student("s1003", "=HYPERLINK(1)", canvas_id="19"),
    Student("s1004", "Zoë Ångström", login="zoe"),
)
HOSTILE = "</code><script>alert(1)</script> `*|* $x$ [a](javascript:b) \x1b[31m \u202e \ud800 \x00"


@exercise("1", title="Gain below $K_u$", points=4)
def gain(K=between(1.05, 9.95, step=0.05, reference=2), T=between(11, 99, "s", reference=20)):
    """A lag of {T} with the gain {K}."""
    return answers(
        K=number(2 * K, "K/%", "twice the gain"),
        T=number(T, "s", "the time constant"),
        H=expression(K / (T * s + 1), what="the transfer function"),
    )


@gain.mistake("The {T} are not in hours.")
def _(T):
    return {"T": T / 3600}


@gain.mistake(r"That is the gain itself, $\frac{{K}}{{1}}$, not twice of it.")
def _(K):
    return {"K": K}


@exercise("2", title="Action", points=1)
def action(way=choice("heating", "cooling")):
    """What action does a controller for {way} need?"""
    key = "reverse" if way == "heating" else "direct"
    return answers(action=word(key, ["reverse", "direct"], "the action"))


PICTURE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="
)


def key_in_words(kind):
    return f"{getattr(kind, 'expr', kind.key)} {kind.unit}".strip()


def result_of(student, given, course=(gain, action), **more):
    """A marked result, made by the exercises themselves: their judging of the answers of a student."""
    done = []
    for one in course:
        question = one.question(student.id)
        mine = given(question) if callable(given) else given.get(one.number, {})
        answers_ = tuple(
            JudgedAnswer(v.name, v.status, v.says, mine.get(v.name), key_in_words(question.key[v.name]))
            for v in question.check(**mine).verdicts
        )
        done.append(JudgedExercise(one.number, one.title, one.points, question.statement.below_heading, (), answers_))
    file = f"{student.id}/heater.ipynb"
    usual = Result("heater", student.id, file, True, "0" * 64, "complete", "", (), (), tuple(done))
    return Marked.of(replace(usual, **more))


def changed(mark, **fields):
    """The same with other fields of its result."""
    return Marked.of(replace(mark.result, **fields))


def right(question):
    """All answers right, as plain data."""
    return {name: str(kind.expr) if hasattr(kind, "expr") else kind.key for name, kind in question.key.items()}


def own_mistake(question):
    return right(question) | ({"K": float(question.values["K"])} if "K" in question.values else {})


RIGHT_ALL = result_of(ADA, right)
NAMED = result_of(BOB, own_mistake)
STOPPED = result_of(
    EVE,
    {"1": {"K": HOSTILE.replace("\ud800", ""), "T": 1.234}},
    status="stopped",
    says="stopped in cell 4: it took longer than 60 s",
    errors=(CellError(3, f"NameError: {HOSTILE}"),),
    looks=(Look("odd lines", "wrote to the answers' stream"),),
)
MISSING = result_of(ZOE, {}, status="missing", file="")
RESULTS = [RIGHT_ALL, NAMED, STOPPED, MISSING]


def grades(marks=RESULTS, complaints=(), students=CLASS, **more):
    """What outputs are made of, for these marks."""
    return Grades(TITLE, students, marks, complaints, **more)


def by_hand(marks=None, key="it begins after the dead time", **more):
    """A result with a figure and a text that a person marks, with these marks by hand."""
    sketch = JudgedAnswer("sketch", WAITING, "a person marks this", png.as_data(PICTURE), key, 3)
    long = f"the dead time is long\n\n<b>so</b> {'it oscillates ' * 40}!"
    why = JudgedAnswer("why", WAITING, "a person marks this · 9 words, where at most 5 are asked for", long, "")
    one = JudgedExercise("3", "A sketch", 4, "Sketch it.", (), (sketch, why))
    return Marked.of(replace(RIGHT_ALL.result, exercises=(*RIGHT_ALL.result.exercises, one)), marks, **more)
