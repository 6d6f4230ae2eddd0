"""One answer of each kind, and what tests ask of a verdict."""

import sympy

from exercisebook.judging import judge
from loopbook import s, t
from loopbook.exercises.authoring import (
    criterion,
    design,
    expression,
    number,
    numbers,
    poles,
    settings,
    time_function,
    transfer_function,
    word,
    words,
)
from loopbook.pid import PID

X, K = sympy.symbols("x K")
#: By the code of their forms.
EVERY_KIND = {
    'number("K/%")': number(2.5, "K/%", "the gain", within=0.02),
    "number()": number(2),
    'numbers("s")': numbers([[1, 2], [3, 4]], "s", "the matrix"),
    "poles()": poles([-1, -2]),
    'poles("1/min")': poles([-1, -2], "1/min"),
    'expression("m³")': expression(X**2 * K, "the volume", unit="m³"),
    'expression("m³", symbols="K x y")': expression(X**2 * K, "the volume", symbols="K x y", unit="m³"),
    'transfer_function(symbols="K T")': transfer_function(K / (5 * s + 1), symbols="K T"),
    "transfer_function()": transfer_function(K / (X * s + 1)),
    'time_function("°C")': time_function(1 - sympy.exp(-t / 7), 35, "°C", "the response"),
    "settings()": settings(PID(2, Ti=10)),
    'settings("%/K", time="min", form="serial")': settings(PID(2, Ti=10), "%/K", "min", form="serial"),
    'word(["direct", "reverse"])': word("reverse", ["direct", "reverse"]),
    'words(["a", "b"])': words(["b"], "ab"),
    'words(["a", "b"], ordered=True)': words(["b", "a"], "ab", ordered=True),
    'settings("%")': design(settings(PID(2), "%"), criterion("the gain", lambda pid: pid.Kp, below=3)),
}


def assert_judged(kind, given, status, says):
    """The verdict on an answer of a kind has this status, and its sentence holds these words."""
    verdict = judge("x", kind, given)
    assert verdict.status == status, verdict
    assert says in verdict.says, verdict
