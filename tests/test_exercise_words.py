"""Answers that are words, one or several, in any spelling and where asked in their order."""

import numpy as np
import pytest
import sympy

from judged import assert_judged
from loopbook.exercises.authoring import word, words
from loopbook.exercises.judging import MISTAKE, RIGHT, UNJUDGED, WRONG

STEPS = words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
ROUTE = words(["fill", "heat", "empty"], ["fill", "heat", "empty", "wait"], "the steps", ordered=True)
ACTION = word("reverse", ["reverse", "direct"], "the action")
TRUE = word("yes", ["yes", "no"], "whether it is stable")

JUDGED = [
    (ACTION, " REVERSE", RIGHT, "right"),
    (ACTION, "direct", WRONG, "which way must the control signal go"),
    (ACTION, "backwards", UNJUDGED, "reverse or direct"),
    (ACTION, 1, UNJUDGED, "not text"),
    (TRUE, True, RIGHT, "right"),
    (STEPS, {"s2", "s4"}, RIGHT, "right"),
    (STEPS, "S2", WRONG, "missing"),
    (STEPS, ["S2", "S4", "S1"], WRONG, "but also more"),
    (STEPS, [], WRONG, "empty"),
    (STEPS, ["S2", "S9"], UNJUDGED, "none of the words"),
    (ROUTE, ["empty", "heat", "fill"], MISTAKE, "opposite order"),
    (ROUTE, ["heat", "fill", "empty"], WRONG, "order"),
    (ROUTE, {"heat", "fill", "empty"}, UNJUDGED, "a set has no order"),
    (ACTION, True, UNJUDGED, "True is a truth value: expected reverse or direct"),
    (STEPS, "S2 and S4", RIGHT, "right"),
    (STEPS, "S2 S4", RIGHT, "right"),
    (STEPS, ["S4", "S2", "S2"], RIGHT, "right"),
    # in other forms and spellings
    *(
        (ACTION, one, RIGHT, "right")
        for one in ("reverse.", "'Reverse'", ["reverse"], {"reverse"}, np.array("reverse"))
    ),
    *((TRUE, one, RIGHT, "right") for one in (np.True_, sympy.true)),
    (ACTION, "-", UNJUDGED, "none of the words"),
    (word("cascade control", ["cascade control", "feedforward"]), "cascade-control", RIGHT, "right"),
    (word("2", ["1", "2"]), 2, RIGHT, "right"),
    (word("+", ["+", "-"]), "-", WRONG, "not right"),
    *(
        (STEPS, one, RIGHT, "right")
        for one in ("S2; S4", "{S2, S4}", np.array(["S2", "S4"]), {"S2": 1, "S4": 1}.keys())
    ),
    (ROUTE, "fill -> heat → empty", RIGHT, "right"),
]


@pytest.mark.parametrize(("kind", "given", "status", "says"), JUDGED, ids=range(len(JUDGED)))
def test_judging(kind, given, status, says):
    assert_judged(kind, given, status, says)
