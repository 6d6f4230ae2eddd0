"""Python beside the page of exercise 5.1."""

from loopbook import diagrams
from loopbook.transfer import poles  # noqa: F401


def solution_picture(J, k, b):
    """The diagram: the voltage times the gain, minus the torque, through one lag to the speed."""
    lag = diagrams.block(rf"\frac{{1}}{{{float(J):g} s + {float(b):g}}}")
    return diagrams.block_diagram(
        "u", diagrams.gain(f"{float(k):g}"), diagrams.disturbance("M", sign="-"), lag, r"\omega"
    )
