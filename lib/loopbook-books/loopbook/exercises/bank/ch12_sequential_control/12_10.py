"""Python beside the page of exercise 12.10."""

from loopbook.exercises.bank.ch12_sequential_control.shared import PRESSED, tank_chart

SCENARIOS_OF_ALARM = [
    ("", 2, {"start": PRESSED, "reset": "FALSE"}),
    ("if the level transmitter gets stuck", 2, {
        "start": PRESSED,
        "reset": "Alarm.X AND Alarm.T >= 60 AND Alarm.T < 64",
        "level_stuck": "Fill.X AND Fill.T >= 40 OR Alarm.X",
    }),
    ("if somebody presses reset while the tank is filled", 1, {
        "start": PRESSED,
        "reset": "Fill.X AND Fill.T >= 30 AND Fill.T < 34",
    }),
    ("if somebody presses a button at the wrong time", 1, {
        "start": f"{PRESSED} OR Empty.X AND Empty.T >= 20 AND Empty.T < 24",
        "reset": "Wait.X AND Wait.T >= 8 AND Wait.T < 12 OR Empty.X AND Empty.T >= 10 AND Empty.T < 14",
    }),
    ("if somebody presses start during the alarm", 1, {
        "start": f"{PRESSED} OR Alarm.X AND Alarm.T >= 30 AND Alarm.T < 34",
        "reset": "Alarm.X AND Alarm.T >= 60 AND Alarm.T < 64",
        "level_stuck": "Fill.X AND Fill.T >= 40 OR Alarm.X",
    }),
]  # fmt: skip


def _demands_on_alarm(full, limit):
    """What must not happen, the worst first."""
    full, limit = (f"{float(x):g}" for x in (full, limit))
    return [
        ("the tank runs over", "overflow > 0.1"),
        ("inlet and outlet are open together", "inlet AND outlet"),
        (f"the inlet is still open, although filling has taken {limit} s", "inlet", "Alarm"),
        (f"the horn is silent, although filling has taken {limit} s", "NOT horn", "Alarm"),
        ("the outlet is open, although filling has failed", "outlet", "Alarm"),
        (f"the horn sounds, although filling has not taken {limit} s", "horn", "Fill"),
        ("the horn sounds, although the tank was filled in time", "horn", "Empty"),
        ("the horn sounds, although nothing is wrong any more", "horn", "Wait"),
        (f"the inlet is closed, although start was pressed and the level is below {full} m", "NOT inlet", "Fill"),
        ("the inlet opens, although nobody has pressed start", "inlet", "Wait"),
        (f"the inlet is open, although the level has reached {full} m", "inlet", "Empty"),
        (f"the outlet is closed, although the level has reached {full} m", "NOT outlet", "Empty"),
        (f"the outlet opens before the level has reached {full} m", "outlet", "Fill"),
        ("the outlet is open, although nobody has pressed start", "outlet", "Wait"),
    ]


def asked_chart(key, *givens):
    """A chart that does on the tank what is demanded."""
    inputs, outputs = {"start": "", "reset": "", "level": "m"}, ["inlet", "outlet", "horn"]
    return tank_chart(key, inputs, outputs, _demands_on_alarm(*givens), SCENARIOS_OF_ALARM)


def complaint(chart, *givens):
    """What is wrong when a chart runs on the tank."""
    return asked_chart(chart, *givens).hint(chart)


def solution_picture(chart, full, limit):
    """Two batches with this chart, and the chart itself, with the two branches that leave the step Fill."""
    return asked_chart(chart, full, limit).drawn(chart)
