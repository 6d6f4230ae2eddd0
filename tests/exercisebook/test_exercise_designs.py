"""Answers for which a design is asked: whatever meets the criteria is right."""

import pytest

from exercisebook.authoring import criterion, design, number
from exercisebook.judging import RIGHT, UNJUDGED, WRONG, judge
from judged import assert_judged

LAYERS = design(number(2, what="the layers"), criterion("the light", lambda n: 1 / (1 + n), below=0.4))
WEIGHT = design(number(2000, "g", "the mass"), criterion("the mass", lambda m: m, above=1500, below=2500, unit="g"))
BEAM = design(
    number(2),
    criterion("the beam holds", lambda width: width < 3),
    criterion("the width", float, above=0.5, below=2.5),
)


@pytest.mark.parametrize(
    ("kind", "given", "status", "says"),
    [
        (LAYERS, 5, RIGHT, "right"),
        (LAYERS, 1.5, RIGHT, "right"),
        (LAYERS, 1.499, RIGHT, "right"),
        (LAYERS, 1.49, WRONG, "the light is 0.4016; asked is at most 0.4"),
        (LAYERS, 1, WRONG, "the light is 0.5; asked is at most 0.4"),
        (LAYERS, -1, WRONG, "the light has no value (float division by zero)"),
        (WEIGHT, 2, WRONG, "the mass is 2\xa0g; asked is at least 1500\xa0g and at most 2500\xa0g"),
        (BEAM, 2, RIGHT, "right"),
        (BEAM, 0.1, WRONG, "the width is 0.1; asked is at least 0.5"),
        (BEAM, 2.9, WRONG, "the width is 2.9; asked is at least 0.5 and at most 2.5"),
    ],
)
def test_judging(kind, given, status, says):
    assert_judged(kind, given, status, says)


def test_of_a_design_that_fails_a_condition_nothing_else_is_said():
    assert judge("x", BEAM, 9).says == "asked is that the beam holds, and it is not so"


def test_a_design_that_takes_too_long_is_not_judged(monkeypatch):
    def slow(_):
        while True:
            pass

    monkeypatch.setattr("exercisebook.kinds.design.SECONDS", 0.1)
    verdict = judge("x", design(number(1), criterion("the width", slow, below=1)), 2)
    assert verdict.status == UNJUDGED
    assert "too long" in verdict.says
