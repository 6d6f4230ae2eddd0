"""The air heater in closed loop

The controller of the air heater is in automatic mode now. You read a response, draw one, and explain it.

The figure and the explanation are marked by a person. Everything else is judged as before.
"""

import numpy as np
from sympy import exp, log, pi, sqrt

from loopbook.exercises.authoring import Late, answers, between, exercise, figure, number, text

SECRET = "another-example-that-everybody-may-read"
DUE = "2026-12-11 23:59 Europe/Berlin"
LATE = Late(percent=10, per="day", grace_minutes=15, at_most=50)


@exercise("1", title="A response in a table", points=3, weights={"zeta": 2})
def response_in_a_table(
    zeta=between(0.3, 0.6, step=0.05, reference=0.4),
    period=between(20, 60, "s", step=4, reference=40),
    step=between(2, 8, "K", step=1, reference=5),
):
    """The setpoint was raised by {step}. The arrays `t`, in s, and `y`, in K, are how the temperature has risen since.

    Find the overshoot, in percent of the step, and from it the relative damping of a loop of second order.
    """
    return answers(
        overshoot=number(100 * _overshoot(zeta), "%", "the overshoot", within=0.03),
        zeta=number(zeta, "", "the relative damping", within=0.03),
    )


def _overshoot(zeta):
    return exp(-pi * zeta / sqrt(1 - zeta**2))


@response_in_a_table.shows
def _(zeta, period, step):
    damping, times = float(zeta / sqrt(1 - zeta**2)), np.linspace(0, 3 * float(period), 121)
    angle = 2 * np.pi * times / float(period)
    return {"t": times, "y": np.round(float(step) * (1 - np.exp(-damping * angle) * _wave(angle, damping)), 3)}


def _wave(angle, damping):
    return np.cos(angle) + damping * np.sin(angle)


@response_in_a_table.mistake("That is the highest value. The overshoot is what is above the step.")
def _(zeta):
    return {"overshoot": 100 + 100 * _overshoot(zeta)}


@response_in_a_table.mistake("The logarithm alone is not the damping: solve for it.")
def _(zeta):
    return {"zeta": -log(_overshoot(zeta)) / pi}


@exercise("2", title="Two controllers", points=4, weights={"Kp": 0.5})
def two_controllers(
    K=between(0.5, 2, "K/%", step=0.1, reference=1.2),
    T=between(20, 60, "s", step=5, reference=30),
    delay=between(3, 9, "s", step=1, reference=6),
):
    r"""A heater has the gain {K}, the time constant {T} and the dead time {delay}. Tune a PI controller by Skogestad's
    rule, with $T_C = \tau$ and $T_i = T$. Then draw the response of the loop to a step of the setpoint of 1 K with this
    gain, and with twice this gain, both in one figure with labelled axes. What is better, and what is worse with the
    larger gain?
    """
    return answers(
        Kp=number(T / (K * 2 * delay), "%/K", "the proportional gain"),
        plot=figure(
            "both responses", key="both begin after the dead time; the second one overshoots more; axes with units"
        ),
        why=text("what the larger gain does", words=60, key="quicker, with more overshoot, a smaller margin"),
    )


@two_controllers.mistake("The dead time counts twice in $K_p$: as itself, and as $T_C$.")
def _(K, T, delay):
    return {"Kp": T / (K * delay)}
