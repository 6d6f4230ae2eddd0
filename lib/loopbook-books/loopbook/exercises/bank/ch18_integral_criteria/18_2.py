"""The loop of exercise 18.2."""

from loopbook import diagrams, integrator


def picture(K):
    """Block diagram: setpoint, PI controller, the load d added to its signal, the tank, and the level fed back."""
    forward = ["e", diagrams.block("PI"), "u", diagrams.disturbance("d"), integrator(K)]
    return diagrams.block_diagram("y_{SP}", diagrams.feedback_loop(forward), "y")
