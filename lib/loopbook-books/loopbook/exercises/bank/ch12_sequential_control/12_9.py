"""Python beside the page of exercise 12.9."""

from loopbook.diagrams import control_valve, instrumentation_diagram, tank
from loopbook.exercises.bank.ch12_sequential_control.shared import PRESSED, tank_chart

SCENARIOS_OF_BATCH = [
    ("", 2, {"start": PRESSED}),
    ("if the supply fails for a while", 1, {
        "start": PRESSED,
        "no_supply": "Fill.X AND Fill.T >= 60 AND Fill.T < 1000",
    }),
    ("if somebody presses start during the batch", 1, {
        "start": f"{PRESSED} OR Fill.X AND Fill.T >= 60 AND Fill.T < 64 "
        "OR Heat.X AND Heat.T >= 60 AND Heat.T < 64 OR Hold.X AND Hold.T >= 30 AND Hold.T < 34 "
        "OR Empty.X AND Empty.T >= 30 AND Empty.T < 34",
    }),
]  # fmt: skip


def _demands_on_batch(full, T_SP, hold, low):
    """What must not happen, the worst first."""
    full, T_SP, hold, low = (f"{float(x):g}" for x in (full, T_SP, hold, low))
    return [
        ("the tank runs over", "overflow > 0.1"),
        ("the heater is on while the level is still below 0.4 m", "heater AND level < 0.4"),
        ("inlet and outlet are open together", "inlet AND outlet"),
        (f"the inlet is closed, although start was pressed and the level is below {full} m", "NOT inlet", "Fill"),
        ("the inlet opens, although nobody has pressed start", "inlet", "Wait"),
        (f"the inlet is still open, although the level has reached {full} m", "inlet", "Heat Hold Empty"),
        (f"the heater is on before the level has reached {full} m", "heater", "Fill"),
        (f"the heater stays off, although the full tank is colder than {T_SP} °C", "NOT heater", "Heat"),
        (f"the heater is still on, although the water has reached {T_SP} °C", "heater", "Hold Empty"),
        ("the heater is on, although nobody has pressed start", "heater", "Wait"),
        (f"the outlet opens before the water has been held for {hold} s", "outlet", "Hold"),
        (f"the outlet opens before the water has reached {T_SP} °C", "outlet", "Fill Heat"),
        (f"the outlet stays closed, although the water has been held for {hold} s", "NOT outlet", "Empty"),
        (f"the outlet is open, although the level has fallen to {low} m", "outlet", "Wait"),
    ]


def asked_chart(key, *givens):
    """A chart that does on the tank what is demanded."""
    inputs, outputs = {"start": "", "level": "m", "temperature": "°C"}, ["inlet", "heater", "outlet"]
    return tank_chart(key, inputs, outputs, _demands_on_batch(*givens), SCENARIOS_OF_BATCH)


def complaint(chart, *givens):
    """What is wrong when a chart runs on the tank."""
    return asked_chart(chart, *givens).hint(chart)


def solution_picture(chart, full, T_SP, hold, low):
    """Two batches with this chart, and the chart itself: level, temperature, what is on, and the active step."""
    return asked_chart(chart, full, T_SP, hold, low).drawn(chart)


def picture(full):
    """The tank with its transmitters of level and temperature, its inlet, outlet and heater, and between them your
    chart, which reads the button start; the level of the full tank, {full}, is marked."""
    layout = """
        .      5     .     .     .     .    3    .
        water  V1    1     .     .     .    .    .
        .      .     tank  tank  tank  LT1  seq  start
        .      .     tank  tank  tank  TT1  seq  .
        .      .     tank  tank  tank  4    seq  .
        .      .     tank  tank  tank  .    seq  .
        .      .     9     .     .     .    .    .
        out    V2    2     .     .     .    .    .
        .      8     .     .     .     .    7    ."""
    parts = {"V1": control_valve("inlet", "solenoid"), "V2": control_valve("outlet", "solenoid")}
    parts |= {"tank": tank(level=f"${float(full):g}$ m", heater=True), "seq": "Your\nchart"}
    lines = "LT1 seq, TT1 seq, start seq, seq 4 tank, seq 3 5 V1, seq 7 8 V2"
    measured = {"measuring line": "tank LT1, tank TT1"}
    return instrumentation_diagram(layout, "water V1 1 tank 9 2 V2 out", lines, parts, lines=measured)
