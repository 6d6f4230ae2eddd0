"""Python beside the page of exercise 3.2."""

import sympy

from loopbook import diagrams as draw

#: With which power of the height each of the vessels becomes wider, and half of its width at the rim.
SECTIONS = {"funnel": (1, "R"), "trough": (1, "W/2"), "bowl": (0.5, "R"), "pit": (1, "L/2"), "goblet": (2, "R")}


def circle(radius):
    """The area of a circle, exact."""
    return sympy.pi * radius**2


def picture(shape, lost):
    """The tank in section, with its level h: q_i flows in above; {loses}."""
    return draw.widening_tank(*SECTIONS[shape], outflow=lost)
