"""The half rule: four lags and an inverse response, the models of first and second order, and the loop they lead to."""

import functools

import numpy as np
import sympy

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider, figures, overshoot, stepped
from loopbook import approximation, s
from loopbook.deadtime import Loop, System
from loopbook.stability import margins, unstable_poles
from loopbook.tuning import simc

LARGEST = 8
LOAD_AT = 100
TIMES = np.linspace(0, 200, 251)
RATIOS = tuple(sympy.Rational(n, 10) for n in (2, 3, 5, 7, 10))
ZEROS = (0, 2, 4)
MS, DISTANCE = "<i>M</i><sub>s</sub> of the loop", "largest distances from the process"
SHARES = tuple(sympy.Rational(n, 4) for n in range(5))


def lags_of(ratio):
    """Four lags, each smaller than the one before."""
    return [LARGEST * ratio**n for n in range(4)]


def process_of(ratio, zero):
    """The process, its inverse response with it."""
    return (1 - zero * s) / sympy.Mul(*(T * s + 1 for T in lags_of(ratio)))


def shared_model(ratio, zero, share):
    """The model with one lag, with any share of the second lag as dead time; Skogestad's is one half."""
    T1, T2, *smaller = lags_of(ratio)
    return approximation.SOPDT(1, T1=T1 + (1 - share) * T2, delay=share * T2 + sum(smaller) + zero)


@functools.cache
def of_process(ratio, zero):
    """The responses of the process, and of its model of second order, to a step; and that model."""
    process = process_of(ratio, zero)
    model = approximation.half_rule(process, order=2)
    return System(process).step(TIMES), System(model.expr).step(TIMES), model


def respond(ratio, zero, share):
    """Answer for one ratio of the lags, one inverse response and one share of the second lag."""
    process, model = process_of(ratio, zero), shared_model(ratio, zero, share)
    exact, second, second_model = of_process(ratio, zero)
    loop = Loop(process, simc(model))
    signals = {
        "process": exact, "first": System(model.expr).step(TIMES), "second": second,
        "setpoint": np.ones_like(TIMES), "loop": stepped(TIMES, loop.servo, loop.regulator, LOAD_AT),
    }  # fmt: skip
    results = {
        "model with one lag": f"lag {figures(model.T1, unit='s')}, dead time {figures(model.delay, unit='s')}",
        "with two": f"lags {figures(second_model.T1)} and {figures(second_model.T2, unit='s')}, "
        f"dead time {figures(second_model.delay, unit='s')}",
        DISTANCE: "–", "overshoot of the loop": "–", MS: "–",
    }  # fmt: skip
    results[DISTANCE] = " and ".join(f"{abs(exact - signals[name]).max():.3f}" for name in ("first", "second"))
    if unstable_poles(loop):
        return Answer("The loop is unstable", results, signals)
    Ms = margins(loop.open).Ms
    results |= {"overshoot of the loop": overshoot(loop.servo.step(TIMES)), MS: figures(Ms)}
    verdict = "A robust loop" if Ms < 1.9 else "A loop with little margin" if Ms < 2.5 else "A nervous loop"
    return Answer(verdict, results, signals)


LESSON = Lesson(
    title="Live: the half rule",
    about=(
        "Four lags, the largest of 8 s and each of the others a fixed share of the one before, and an inverse response "
        "$1 - T_0s$. Above, the step response of the process beside its models with one lag and with two. Below, the "
        "process under Skogestad's PI controller for the model with one lag, $T_C$ being the model's dead time; a load "
        "of 1 comes after 100 s."
    ),
    questions=(
        "Make the lags equal. How far is the model with one lag from the process, and how much of that does the second "
        "lag mend?",
        "Half of the second lag becomes dead time: is half the best share? Look at the response, then at $M_s$, "
        "for a ratio of 0.3 and of 1.",
        "Add the inverse response. The models know it as dead time only: what do they miss?",
    ),
    sliders=(
        Slider("ratio", "Each lag, as a share of the one before", RATIOS, sympy.Rational(1, 2)),
        Slider("zero", "Inverse response <i>T</i><sub>0</sub>", ZEROS, 0, "s"),
        Slider("share", "Share of the second lag that becomes dead time", SHARES, sympy.Rational(1, 2)),
    ),
    panels=(Panel("y, a step of u", -0.4, 1.2), Panel("y, under PI control", -0.5, 2.1)),
    curves=(
        Curve("process", "process", 0, "measurement"),
        Curve("first", "model with one lag", 0, 1),
        Curve("second", "model with two", 0, 0),
        Curve("setpoint", "setpoint", 1, "setpoint"),
        Curve("loop", "process under control", 1, "measurement"),
    ),
    times=TIMES,
    respond=respond,
)
