"""Answers that nobody can read."""


class Odd:
    """An answer whose methods fail."""

    def __getattr__(self, name):
        raise RuntimeError("no")


CIRCLE = []
CIRCLE.append(CIRCLE)
