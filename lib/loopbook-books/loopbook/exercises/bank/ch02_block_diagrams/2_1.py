"""Python beside the page of exercise 2.1."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(K, y_0):
    """Meter A: from u through a gain of {K} into an integrator that begins at {y_0}, whose output is y_A. Meter B: from
    u into such an integrator, and then through the gain to y_B."""
    layout = """
        A    u_A  K_A  I_A  y_A
        B    u_B  I_B  K_B  y_B"""
    gain, sum_up = draw.gain(written(K)), draw.integrator(written(y_0))
    blocks = {"K_A": gain, "I_A": sum_up, "I_B": sum_up, "K_B": gain}
    names = {"A": "Meter A", "B": "Meter B", "u_A": "u", "u_B": "u"}
    return draw.grid_diagram(layout, "u_A K_A I_A y_A, u_B I_B K_B y_B", blocks, names)
