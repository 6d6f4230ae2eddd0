"""A PI controller on a lag with dead time: what its gain and its integral time do."""

import numpy as np
import sympy

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider, figures, overshoot, stepped
from loopbook.deadtime import Loop
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.stability import margins, unstable_poles
from loopbook.transfer import first_order

K, T, DELAY = 1, 10, 4
LOAD_AT = 60
TIMES = np.linspace(0, 120, 241)
GAINS = tuple(sympy.Rational(n, 4) for n in (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16))
LABELS = (
    "overshoot", "gain margin", "phase margin", "<i>M</i><sub>s</sub>", "∫<i>e</i>²d<i>t</i> after the setpoint",
    "∫<i>e</i>²d<i>t</i> after the load",
)  # fmt: skip
INTEGRAL_TIMES = (2, 3, 4, 6, 8, 10, 12, 15, 20, 30, 50)


def respond(Kp, Ti):
    """Answer for one gain and one integral time."""
    process, controller = first_order(K, T, DELAY), PID(Kp, Ti=Ti)
    loop = Loop(process, controller)
    servo = loop.servo.step(TIMES)
    # what a load makes the controller do is, except for the sign, what a step of the setpoint makes of the output
    later = (TIMES >= LOAD_AT) * np.interp(np.maximum(TIMES - LOAD_AT, 0), TIMES, servo)
    signals = {
        "y": stepped(TIMES, loop.servo, loop.regulator, LOAD_AT),
        "u": loop.setpoint_to_control.step(TIMES) - later,
        "setpoint": np.ones_like(TIMES),
    }
    results = dict.fromkeys(LABELS, "–")
    if unstable_poles(loop):
        return Answer("Unstable", results, signals)
    margin = margins(loop.open)
    squares = (pi_first_order(K, T, DELAY, float(Kp), float(Ti), mode) for mode in ("servo", "regulator"))
    texts = (
        overshoot(servo), figures(margin.gain_margin), figures(margin.phase_margin, 2, "°"), figures(margin.Ms),
        *(figures(square, unit="s") for square in squares),
    )  # fmt: skip
    verdict = "Stable" if margin.Ms < 2 else "Stable, with little to spare"
    return Answer(verdict, dict(zip(results, texts, strict=True)), signals)


LESSON = Lesson(
    title="Live: gain and integral time",
    about=(
        "A PI controller on the process $e^{-4s}/(10s+1)$, times in seconds. The setpoint steps at 0 s, a load of 1 "
        "comes after 60 s. $M_s$ is the largest sensitivity, $e$ the control error."
    ),
    questions=(
        "Raise the gain until the loop is unstable. Which of the margins tells you beforehand, and how far ahead?",
        "Leave the gain where it is and make $T_i$ 2 s, then 50 s. Which of the two errors is felt after the setpoint, "
        "and which after the load?",
        "Skogestad's rule says $K_p$ = 1.25 and $T_i$ = 10 s. Can you halve $\\int e^2dt$ after the load, and what "
        "does it cost?",
    ),
    sliders=(
        Slider("Kp", "Gain <i>K</i><sub>p</sub>", GAINS, sympy.Rational(5, 4)),
        Slider("Ti", "Integral time <i>T</i><sub>i</sub>", INTEGRAL_TIMES, 10, "s"),
    ),
    panels=(Panel("output y", -0.25, 2.25), Panel("control signal u", -2, 5)),
    curves=(
        Curve("setpoint", "setpoint", 0, "setpoint"),
        Curve("y", "output <i>y</i>", 0, "measurement"),
        Curve("u", "control signal <i>u</i>", 1, "control signal"),
    ),
    times=TIMES,
    respond=respond,
)
