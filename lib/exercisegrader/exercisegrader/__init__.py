"""Assignments: one notebook per student, and a grader that lets no submission near the key.

Answers come out of the student's process as plain data; judging happens in another process. ``exercisegrader release``
and ``exercisegrader grade`` are the commands.
"""

__all__ = ["GradingError", "NoJail"]


class GradingError(Exception):
    """A wrong use of the grader, or something it cannot work with, in one sentence."""


class NoJail(GradingError):  # noqa: N818 - it says what is the matter
    """Submissions cannot be run here as they should."""
