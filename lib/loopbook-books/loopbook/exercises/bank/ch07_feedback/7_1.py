"""Python beside the page of exercise 7.1."""

from loopbook import diagrams


def picture(p_low, p_high, q_max):
    """From the pressure to the oil flow: sensor, current of 4 to 20 mA, percent, controller, percent, oil flow."""
    sensor = diagrams.block(f"Sensor\n${p_low}$ to ${p_high}$ bar")
    burner = diagrams.block(f"Burner\n$0$ to ${q_max}$ kg/h")
    current, controller = diagrams.block("$4$ to $20$ mA\nto percent"), diagrams.block("Controller\nin percent")
    return diagrams.block_diagram("p", sensor, "I", current, "y", controller, "u", burner, "q")
