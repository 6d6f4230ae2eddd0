"""A Smith predictor beside a PI controller, both made for a model that may be wrong."""

import functools

import numpy as np
from sympy import Rational as Q
from sympy import exp

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider, overshoot, stepped
from loopbook import s
from loopbook.deadtime import Loop, System
from loopbook.pid import PID
from loopbook.transfer import first_order

K, T, DELAY = 1, 4, 4
LOAD_AT = 60
TIMES = np.linspace(0, 120, 241)
DELAYS = tuple(Q(n, 10) for n in (0, 5, 8, 9, 10, 11, 12, 15, 20))
GAINS = (Q(6, 10), Q(8, 10), Q(1), Q(5, 4), Q(3, 2))
WANTED = (Q(1, 2), Q(1), Q(2), Q(4))


def predictor(delay, gain, Tc):
    """Setpoint and load to the output under a Smith predictor: two systems, and the characteristic sum.

    The predictor's PI controller cancels the lag, which model and process have in common. What is left of the loop:
    the wanted lag, less what the model says of the past, more what the process says.
    """
    past, present = exp(-DELAY * delay * s), exp(-DELAY * s) / gain
    characteristic = Tc * s + 1 - past + present
    servo = present / characteristic
    regulator = K * exp(-DELAY * s) / (T * s + 1) * (Tc * s + 1 - past) / characteristic
    return System(servo), System(regulator)


@functools.cache
def ordinary(delay, gain, Tc):
    """The response under the PI controller that the same model and the same wish lead to, and whether it is stable."""
    controller = PID(T / (K * gain * (Tc + DELAY * delay)), Ti=T)
    loop = Loop(first_order(K, T, DELAY), controller)
    return stepped(TIMES, loop.servo, loop.regulator, LOAD_AT), loop.servo.is_stable


def respond(delay, gain, Tc):
    """Answer for one ratio of dead times, one ratio of gains (model to process) and one wanted time constant."""
    servo, regulator = predictor(delay, gain, Tc)
    y, stable = stepped(TIMES, servo, regulator, LOAD_AT), servo.is_stable
    beside, beside_stable = ordinary(delay, gain, Tc)
    before = TIMES < LOAD_AT
    results = {}
    for name, response, settled in (("predictor", y, stable), ("PI", beside, beside_stable)):
        results[f"{name}: overshoot"] = overshoot(response[before]) if settled else "unstable"
        area = np.trapezoid(abs(1 - response), TIMES)
        results[f"{name}: ∫|<i>e</i>|d<i>t</i>"] = f"{area:.1f}\u202fs" if settled else "–"
    verdicts = {
        (True, True): "Both are stable", (True, False): "Only the predictor is stable",
        (False, True): "The predictor is unstable", (False, False): "Both are unstable",
    }  # fmt: skip
    return Answer(verdicts[stable, beside_stable], results, {"smith": y, "PI": beside, "setpoint": np.ones_like(TIMES)})


LESSON = Lesson(
    title="Live: a Smith predictor with a wrong model",
    about=(
        "The process is $e^{-4s}/(4s+1)$. Two controllers are made for the same model and the same closed loop, "
        "$e^{-\\theta s}/(T_Cs+1)$: a Smith predictor, and a PI controller without prediction. The model may be wrong. "
        "The setpoint steps at 0 s, a load of 1 comes after 60 s."
    ),
    questions=(
        "With the right model, how fast may you ask the predictor to be? And the PI controller?",
        "Ask for $T_C$ = 0.5 s. What does an error of 10 % in the dead time cost the predictor, and what one of 20 %? "
        "And with $T_C$ = 4 s?",
        "Is it better to overestimate the gain or to underestimate it? And the dead time?",
    ),
    sliders=(
        Slider("delay", "Dead time of the model, to that of the process", DELAYS, Q(1)),
        Slider("gain", "Gain of the model, to that of the process", GAINS, Q(1)),
        Slider("Tc", "Wanted time constant <i>T</i><sub>C</sub>", WANTED, Q(2), "s"),
    ),
    panels=(Panel("output y", -0.25, 2.25),),
    curves=(
        Curve("setpoint", "setpoint", 0, "setpoint"),
        Curve("smith", "with the Smith predictor", 0, "measurement"),
        Curve("PI", "with the PI controller", 0, 1),
    ),
    times=TIMES,
    respond=respond,
)
