"""Python beside the page of exercise 11.1."""

from loopbook import diagrams


def picture(x_S, x_L):
    """The flow diagram: the measured flow of syrup times K is the setpoint of the flow controller of the water."""
    layout = """
        syrup  FT1  .   .   M   lemonade
        K      x    .   .   .   .
        .      FC2  2   .   .   .
        water  FT2  V2  .   3   ."""
    parts = {"V2": diagrams.control_valve(), "x": r"\times", "M": "Mixer"}
    names = {"syrup": f"syrup, {x_S} $\\%$ sugar", "lemonade": f"lemonade, {x_L} $\\%$ sugar"}
    pipes, signals = "syrup FT1 M lemonade, water FT2 V2 3 M", "FT1 x FC2 2 V2, K x, FT2 FC2"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)
