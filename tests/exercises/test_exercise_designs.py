"""Answers for which a design is asked: whatever meets the criteria is right."""

from exercisebook.judging import RIGHT, UNJUDGED, WRONG, judge
from judged import assert_judged
from loopbook.exercises.authoring import criterion, design, number, settings
from loopbook.pid import PID

OFFSET = design(number(2, what="a gain"), criterion("the offset", lambda K: 1 / (1 + K), below=0.4))
DAMPER = design(number(2000, "g", "the mass"), criterion("the mass", lambda m: m, above=1500, below=2500, unit="g"))
STABLE_MINUTES = design(
    settings(PID(1, Ti=120)), criterion("the integral time", lambda pid: pid.Ti, above=100, below=130)
)
STABLE = design(
    settings(PID(1)),
    criterion("the loop is stable", lambda pid: pid.Kp < 3),
    criterion("the gain", lambda pid: pid.Kp, above=0.5),
)

JUDGED = [
    (OFFSET, 5, RIGHT, "right"),
    (OFFSET, 1, WRONG, "the offset is 0.5; asked is at most 0.4"),
    (OFFSET, 1.499, RIGHT, "right"),
    (STABLE_MINUTES, PID(1, Ti=2), WRONG, "that would be right in min"),
    (OFFSET, 1.49, WRONG, "the offset is 0.4016; asked is at most 0.4"),
    (DAMPER, 2, WRONG, "that would be right in kg; asked: the mass, in g"),
    (STABLE, PID(2), RIGHT, "right"),
    (STABLE, PID(9), WRONG, "asked is that the loop is stable"),
    (STABLE, PID(0.1), WRONG, "the gain is 0.1; asked is at least 0.5"),
    (OFFSET, 1.5, RIGHT, "right"),
]


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)


def test_a_design_that_takes_too_long_is_not_judged(monkeypatch):
    def slow(_):
        while True:
            pass

    monkeypatch.setattr("exercisebook.kinds.design.SECONDS", 0.1)

    verdict = judge("x", design(number(1), criterion("the overshoot", slow, below=1)), 2)
    assert verdict.status == UNJUDGED
    assert "too long" in verdict.says


def test_of_a_design_that_fails_a_condition_nothing_else_is_said():
    unstable = criterion("the loop is stable", lambda pid: pid.Kp < 3)
    asked = design(settings(PID(1)), unstable, criterion("the gain", lambda pid: pid.Kp, below=5))
    assert judge("x", asked, PID(9)).says == "asked is that the loop is stable, and it is not so"
