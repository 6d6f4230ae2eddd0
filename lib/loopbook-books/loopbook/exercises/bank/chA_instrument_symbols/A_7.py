"""The symbols of exercise A.7."""

from loopbook import diagrams as draw

#: Symbols by their names: how each is drawn, and how it looks.
VALVES = {
    "ball valve": (draw.valve(kind="ball"), "two triangles with a circle between them"),
    "butterfly valve": (draw.valve(kind="butterfly"), "a slanting line with a dot in its middle"),
    "check valve": (draw.valve(kind="check"), "a slanting line with an arrow at its end"),
    "hand valve": (draw.valve(kind="hand"), "two triangles with a T on top"),
    "pneumatic valve": (draw.control_valve(), "two triangles with half a circle on top"),
    "safety valve": (draw.valve(kind="safety"), "two triangles with a zigzag on top"),
    "solenoid valve": (draw.control_valve(actuator="solenoid"), "two triangles with a square on top, and an S in it"),
}
MACHINES = {
    "axial fan": (draw.fan(kind="axial"), "a circle with two blades, one above the other"),
    "centrifugal pump": (draw.pump(kind="centrifugal"), "a circle with a triangle, and a dot in it"),
    "compressor": (draw.compressor(), "a shape that becomes narrower to the right"),
    "gear pump": (draw.pump(kind="gear"), "a circle with a triangle, and two small circles in it"),
    "motor": (draw.motor(), "a circle with an M, where no pipe ends"),
    "radial fan": (draw.fan(kind="radial"), "a circle with a wheel of many blades"),
    "turbine": (draw.turbine(), "a shape that becomes wider to the right"),
}
APPARATUS = {
    "column with trays": (draw.vessel(trays=6), "an upright vessel with dashed lines all across"),
    "cyclone": (draw.cyclone(), "a funnel with two upright strokes in its top"),
    "packed column": (draw.vessel(packings=2), "an upright vessel with two crossed boxes"),
    "plate exchanger": (draw.heat_exchanger(kind="plate"), "a box with upright lines in it"),
    "reactor": (draw.vessel(stirrer=True, jacket=True, filled=0.6), "a vessel with a stirrer, and a motor above it"),
    "shell and tube exchanger": (
        draw.heat_exchanger(kind="shell and tube"),
        "a long box with lines along it, between two heads",
    ),
    "silo": (draw.silo(), "a funnel with a heap in it"),
}
CONDUCTORS = {
    "capillary": (draw.conductor("capillary"), "a line with small crosses"),
    "data link": (draw.conductor("data link"), "a line with small circles"),
    "electrical signal": (draw.conductor("electrical"), "a dashed line"),
    "hydraulic signal": (draw.conductor("hydraulic"), "a line with small Ls"),
    "pneumatic signal": (draw.conductor("pneumatic"), "a line with pairs of slanting strokes"),
    "process connection": (draw.conductor("measuring line"), "a thin line without marks"),
    "radio signal": (draw.conductor("radio"), "waves without a line"),
}
SYMBOLS = {"valve": VALVES, "machine": MACHINES, "apparatus": APPARATUS, "line": CONDUCTORS}


def names(kind):
    """The names of the symbols of a kind."""
    return list(SYMBOLS[kind])


def look(kind, name):
    """What is drawn."""
    return SYMBOLS[kind][name][1]


def looks_like(kind, seen):
    """The one symbol that looks so."""
    (name,) = (name for name, (_, what) in SYMBOLS[kind].items() if what == seen)
    return name


def picture(valve, machine, apparatus, line):
    """Four symbols with numbers: 1 is {look_1}, 2 is {look_2}, 3 is {look_3}, 4 is {look_4}."""
    right = zip(SYMBOLS.values(), (valve, machine, apparatus, line), strict=True)
    return draw.symbol_table({str(n): symbols[name][0] for n, (symbols, name) in enumerate(right, start=1)})
