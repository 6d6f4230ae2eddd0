"""Python beside the page of exercise 15.6."""

from loopbook import diagrams
from loopbook.deadtime import Loop  # noqa: F401
from loopbook.stability import margins  # noqa: F401
from loopbook.synthesis import imc  # noqa: F401
from loopbook.transfer import second_order


def picture(K, T1, T2, delay):
    """Block diagram: setpoint, PID controller, the two lags with the dead time, and the temperature fed back."""
    loop = diagrams.feedback_loop(["e", diagrams.block("PID"), "u", second_order(K, T1, T2, delay)])
    return diagrams.block_diagram("y_{SP}", loop, "y")
