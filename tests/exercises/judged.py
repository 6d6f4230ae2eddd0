"""What the tests of all kinds of answers ask of a verdict."""

from loopbook.exercises.judging import judge


def assert_judged(kind, given, status, says):
    """The verdict on an answer of a kind has this status, and its sentence holds these words."""
    verdict = judge("x", kind, given)
    assert verdict.status == status, verdict
    assert says in verdict.says, verdict
