"""Python beside the page of exercise 9.6."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(K, T, tau, K_p):
    """The loop: a PI controller with the gain {K_p} and the integral time {T}, and a process with the gain {K}, the
    time constant {T} and the dead time {tau}."""
    controller = draw.block(rf"{written(K_p)}\left(1+\frac{{1}}{{{written(T)}\,s}}\right)")
    process = draw.block(rf"\frac{{{written(K)}\,e^{{-{written(tau)}s}}}}{{{written(T)}\,s+1}}")
    return draw.block_diagram("y_SP", draw.feedback_loop(["e", controller, "u", process]), "y")
