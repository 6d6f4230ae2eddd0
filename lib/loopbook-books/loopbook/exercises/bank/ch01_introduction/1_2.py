"""Python beside the page of exercise 1.2."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(low, high, I, p_SP):
    """The loop: transmitter PT, {low} to {high}, sends {I} to controller PC, which moves the compressor."""
    layout = """
        .    .           setpoint  .  range    .
        .    1           PC        I  PT       .
        air  compressor  .         .  network  consumers"""
    parts = {"compressor": draw.compressor(), "network": draw.vessel()}
    names = {"setpoint": f"${written(p_SP)}$ bar", "I": f"${written(I)}$ mA"}
    names["range"] = f"${written(low)}$ to ${written(high)}$ bar"
    pipes, signals = "air compressor network consumers", "network PT I PC 1 compressor, setpoint PC"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)
