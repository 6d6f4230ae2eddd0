"""Python beside the page of exercise 9.3."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(R_load, inputs, R_in, wire):
    """The loop: an output for a load of at most {R_load}, a wire of {wire}, {receivers} an input of {R_in},
    and a wire back."""
    output = f"$4$ to $20$ mA\nup to ${written(R_load)}$ Ω"
    return draw.current_loop([f"${written(R_in)}$ Ω"] * int(inputs), f"${written(wire)}$ Ω/km", output)
