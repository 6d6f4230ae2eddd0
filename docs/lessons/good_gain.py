"""The Good Gain experiment by hand: a P controller, its overshoot and undershoot, and the PI controller for them."""

import math

import numpy as np
import sympy

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider, figures, percent, stepped
from loopbook import s
from loopbook.deadtime import Loop
from loopbook.identification import swing
from loopbook.pid import PID
from loopbook.stability import margins, unstable_poles
from loopbook.transfer import dead_time
from loopbook.tuning import good_gain

LAGS = 4, 2, 1
LOAD_AT = 60
TIMES = np.linspace(0, 120, 301)
FINE = np.linspace(0, 120, 4801)  # on which the swing is read off
GAINS = tuple(sympy.Rational(n, 10) for n in (*range(4, 20, 2), *range(20, 50, 3), 50, 55, 60, 70, 80))
DELAYS = tuple(map(sympy.Integer, (0, 1, 2, 4)))
TOU, KP, TI = "<i>T</i><sub>ou</sub>", "<i>K</i><sub>p</sub>", "<i>T</i><sub>i</sub>"
MS = "<i>M</i><sub>s</sub> of the PI loop"
BARELY = 0.03, 0.07  # around the 5 % that the library's own experiment looks for


def process_with(delay):
    """Three lags with dead time."""
    return dead_time(delay) / sympy.Mul(*(T * s + 1 for T in LAGS))


def in_words(undershoot):
    """What an operator would say."""
    if undershoot < 0.002:
        return "No undershoot: more gain"
    if undershoot < BARELY[0]:
        return "An undershoot that nobody sees: a little more gain"
    if undershoot <= BARELY[1]:
        return "Barely observable: this is the good gain"
    return "Plain to see: less gain"


def respond(gain, delay):
    """Answer for one gain of the P controller, and one dead time."""
    process = process_with(delay)
    experiment = Loop(process, PID(gain))
    y, final = experiment.servo.step(FINE), float(gain / (1 + gain))
    signals = {
        "y": y[:: (len(FINE) - 1) // (len(TIMES) - 1)],
        "final value": np.full_like(TIMES, final),
        "setpoint": np.ones_like(TIMES),
    }
    results = dict.fromkeys(("overshoot", "undershoot", TOU, KP, TI, MS), "–")
    if unstable_poles(experiment):
        return Answer("Unstable: less gain", results, signals)
    over, under, Tou = swing(FINE, y, final)
    results |= {"overshoot": percent(over), "undershoot": f"{under:.1%}".replace("%", "\u202f%")}
    if math.isnan(Tou) or under < 0.002:
        return Answer(in_words(0), results, signals)
    top = FINE[y.argmax()]
    marks = (0, top, final * (1 + over), "overshoot"), (0, top + Tou, final * (1 - under), "undershoot")
    settings = good_gain(float(gain), Tou)
    loop = Loop(process, PID(*(float(f"{float(x):.3g}") for x in (settings.Kp, settings.Ti))))
    signals["PI"] = stepped(TIMES, loop.servo, loop.regulator, LOAD_AT)
    unstable = unstable_poles(loop)
    results |= {
        TOU: figures(Tou, unit="s"), KP: figures(settings.Kp), TI: figures(settings.Ti, unit="s"),
        MS: "unstable" if unstable else figures(margins(loop.open).Ms),
    }  # fmt: skip
    return Answer(in_words(under), results, signals, marks)


LESSON = Lesson(
    title="Live: the Good Gain experiment",
    about=(
        "Above, the experiment: a P controller on three lags of 4, 2 and 1 s with a dead time, after a step of the "
        "setpoint. Below, what it leads to: the PI controller with $K_p = 0.8\\,K_{pGG}$ and $T_i = 1.5\\,T_{ou}$, "
        "with a load of 1 after 60 s."
    ),
    questions=(
        "Raise the gain until you see an undershoot that is barely there. What overshoot comes with it?",
        "Take too much gain on purpose. How much of this error does the PI controller tolerate?",
        "Make the dead time longer. How do the good gain and $T_{ou}$ move?",
    ),
    sliders=(
        Slider("gain", "Gain of the P controller", GAINS, sympy.Rational(1)),
        Slider("delay", "Dead time", DELAYS, sympy.Rational(1), "s"),
    ),
    panels=(Panel("y, with P", 0, 1.6), Panel("y, with PI", 0, 2)),
    curves=(
        Curve("setpoint", "setpoint", 0, "setpoint"),
        Curve("final value", "final value", 0, 3),
        Curve("y", "with the P controller", 0, "measurement"),
        Curve("setpoint", "setpoint", 1, "setpoint"),
        Curve("PI", "with the PI controller", 1, 0),
    ),
    times=TIMES,
    respond=respond,
)
