"""Python beside the pages: kinds of answers that are judged by criteria, or by a person."""

from sympy import exp

from loopbook.exercises.authoring import criterion, design, figure, largest_sensitivity, pi_controller, settings, stable
from loopbook.exercises.authoring import text as words
from loopbook.expressions import s


def quickest_first(a, b, c):
    """Return the names of the lags, the quickest one first."""
    return [name for _, name in sorted([(a, "A"), (b, "B"), (c, "C")])]


def own_design(pid, K, T, delay, limit):
    """Return a design, with one that meets the criteria as its example."""
    process = K * exp(-delay * s) / (T * s + 1)
    return design(
        settings(pid, "%/K", "s", "the settings"),
        pi_controller(),
        stable(process),
        largest_sensitivity(process, until=30 / delay, below=1.7),
        criterion("$T_i/K_p$", lambda pid: pid.Ti / pid.Kp, below=float(limit), unit="K s/%"),
    )


def a_sketch():
    """Return a figure, for whose marker there is a note."""
    return figure("the sketch", "it comes back to zero without much oscillation")


def a_reason():
    """Return a text, for whose marker there is a note."""
    return words("what was given up", 30, "speed for calm")
