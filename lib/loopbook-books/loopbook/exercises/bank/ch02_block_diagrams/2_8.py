"""Python beside the page of exercise 2.8."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(m, of_v, of_y, plus_v, plus_y, done):
    """A block diagram: $F$ enters a sum with {plus_y} {of_y} times $y$ and {plus_v} {of_v} times $v$. The sum is {done}
    by {m}; then come an integrator to $v$ and an integrator to $y$."""
    block = draw.multiplication(written(m)) if done == "multiplied" else draw.division(written(m))
    inner, outer = draw.multiplication(written(of_v)), draw.multiplication(written(of_y))
    braked = draw.feedback_loop([block, draw.integrator("0")], inner, sign=plus_v)
    return draw.block_diagram("F", draw.feedback_loop([braked, "v", draw.integrator("0")], outer, sign=plus_y), "y")
