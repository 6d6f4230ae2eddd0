"""Python beside the page of exercise 8.3."""

from loopbook import diagrams


def picture(K, T, tau, K_d, T_d, tau_d):
    """Steam valve and milk flow act on the temperature, each through its own transfer function; the two are added."""
    G = diagrams.block(rf"\frac{{{float(K):g}}}{{{T}s+1}}e^{{-{tau}s}}")
    G_d = diagrams.block(rf"\frac{{-{K_d}}}{{{T_d}s+1}}e^{{-{tau_d}s}}")
    return diagrams.block_diagram("u", G, diagrams.disturbance("d", G_d), "y")
