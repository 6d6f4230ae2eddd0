"""Python beside the page of exercise 13.4."""

from loopbook import diagrams
from loopbook.exercises.bank.ch13_poles_and_zeros.shared import factor


def picture(k, tau_1, tau_2):
    """A loop of the controller with the gain K_c and a process of two lags."""
    lags = "".join(f"({factor(x)}s + 1)" for x in (tau_1, tau_2))
    process = diagrams.block(rf"\frac{{{float(k):g}}}{{{lags}}}")
    return diagrams.block_diagram("y_s", diagrams.feedback_loop([diagrams.block("K_c"), "u", process]), "y")
