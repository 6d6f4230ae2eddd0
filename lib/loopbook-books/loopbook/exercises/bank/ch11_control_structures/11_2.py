"""Python beside the page of exercise 11.2."""

import numpy as np

from loopbook import diagrams


def openings(u, split, action):
    """The openings of the vent and of the inlet, in %."""
    u, split = float(u), float(split)
    falling, rising = np.interp(u, [0, split], [100, 0]), np.interp(u, [split, 100], [0, 100])
    return [falling, rising] if action == "reverse" else [rising, falling]


def picture(action, u):
    """The flow diagram: one pressure controller in {action} action moves the inlet for nitrogen and the vent."""
    layout = """
        .         .      mode  .     .
        .         4      PC    5     .
        .         .      PT    .     .
        nitrogen  inlet  3     vent  outside
        .         .      tank  .     ."""
    parts = {"inlet": diagrams.control_valve("inlet"), "vent": diagrams.control_valve("vent")}
    parts["tank"] = diagrams.vessel(filled=0.6)
    names = {"mode": f"{action} action, $u$ = {u} $\\%$"}
    pipes, signals = "nitrogen inlet 3 vent outside, 3 tank", "3 PT PC 4 inlet, PC 5 vent"
    return diagrams.instrumentation_diagram(layout, pipes, signals, parts, names)
