"""Answers that are settings of a controller, in the form that is asked."""

import numpy as np
import pytest

from judged import assert_judged
from loopbook.exercises.authoring import settings
from loopbook.exercises.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from loopbook.pid import PID

PI = settings(PID(2, Ti=10), gain="%/K", what="the settings")
PARALLEL = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings", form="parallel")
ANY = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings")

JUDGED = [
    (PI, PID(2, Ti=10), RIGHT, "right"),
    (PI, PID(2, Ti=10, form="serial"), RIGHT, "right"),
    (PI, {"Kp": "2 %/K", "Ti": "10 s"}, RIGHT, "right"),
    (PI, {"Kp": 2, "Ti": "1 min"}, WRONG, "Kp is right; Ti is not: too large"),
    (PI, (2, 10), RIGHT, "right"),
    (PI, PID(-2, Ti=10), MISTAKE, "sign of Kp"),
    (PI, PID(0.5, Ti=10), MISTAKE, "inverted"),
    (PI, PID(50, Ti=10), MISTAKE, "proportional band"),
    (PI, PID(2, Ti=0.2), MISTAKE, "integral gain"),
    (PI, {"Kp": 2, "Ki": 3}, UNJUDGED, "Ki is not a setting"),
    (PI, 2, UNJUDGED, "no controller"),
    (PI, PID(2), MISTAKE, "Kp is right; Ti: the integral term is missing"),
    (ANY, PID(2, Ti=8, Td=2, form="serial"), RIGHT, "right"),
    (PARALLEL, PID(2, Ti=8, Td=2, form="serial"), MISTAKE, "asks for its parallel form"),
    (PARALLEL, PID(2, Ti=8, Td=2), MISTAKE, "numbers of the serial form"),
    (PARALLEL, PID(2.5, Ti=1.6, Td=10), MISTAKE, "exchanged"),
    (PARALLEL, PID(2.5, Ti=10, Td=1.6, form="serial"), WRONG, "not right"),
    # in other forms and spellings
    (PI, "2, 10", RIGHT, "right"),
    (PI, [[2, 10]], RIGHT, "right"),
    (PI, (2, np.array([10, 11])), UNJUDGED, "2 values"),
    (settings(PID(2)), (2, "inf"), RIGHT, "right"),
]


@pytest.mark.parametrize(("kind", "given", "status", "says"), JUDGED, ids=range(len(JUDGED)))
def test_judging(kind, given, status, says):
    assert_judged(kind, given, status, says)
