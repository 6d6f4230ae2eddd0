"""Python beside the page of exercise 6.4."""

from loopbook.exercises.bank.ch06_dynamics.shared import after  # noqa: F401
from loopbook.expressions import t
from loopbook.transfer import dead_time, integrator, series  # noqa: F401


def at(m, time):
    """The mass at a moment."""
    return m.subs(t, time)
