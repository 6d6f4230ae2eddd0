"""Python beside the page of exercise 7.2."""

from loopbook import diagrams


def picture(medium, valve):
    """A stirred vessel with a jacket; the controller of its temperature acts on a valve in the supply of {medium}."""
    layout = """
        .       1  .     TC   T_SP
        .       .  tank  TT   .
        medium  V  tank  out  ."""
    parts = {"V": diagrams.control_valve(), "tank": diagrams.tank(jacket=True, stirrer=True)}
    names = {"medium": medium, "out": "out", "T_SP": "$T_{SP}$"}
    pipes, lines = "medium V tank out", "tank TT TC 1 V, T_SP TC"
    return diagrams.instrumentation_diagram(layout, pipes, lines, parts, names)
