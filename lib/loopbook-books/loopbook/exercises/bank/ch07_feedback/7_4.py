"""Python beside the page of exercise 7.4."""

from loopbook import diagrams


def picture(K, T):
    """The loop: the P controller, and the process, at whose input the loss $W$ is subtracted."""
    lag = diagrams.block(rf"\frac{{{float(K):g}}}{{{T}\,s+1}}")
    forward = ["e", diagrams.gain("K_p"), "u", diagrams.disturbance("W", sign="-"), lag]
    return diagrams.block_diagram("T_SP", diagrams.feedback_loop(forward), "T")
