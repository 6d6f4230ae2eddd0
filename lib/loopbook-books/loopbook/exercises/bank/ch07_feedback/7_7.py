"""Python beside the page of exercise 7.7."""

import math

import numpy as np
from sympy import Rational

from loopbook.deadtime import Loop
from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.stability import delay_margin, ultimate
from loopbook.transfer import first_order


def _three_responses(K, T, delay, pid):
    """The response to the load step as it is, and at the two limits that the loop has to bear."""
    processes = {
        "as it is": first_order(K, T, delay),
        "gain 2.5 times": first_order(K * Rational(5, 2), T, delay),
        "dead time 2.5 times": first_order(K, T, delay * Rational(5, 2)),
    }
    times = np.linspace(0, 4 * float(T), 301)
    curves = {name: Loop(process, pid).regulator.step(times) for name, process in processes.items()}
    limits = -float(K), float(K)  # without a controller it would end at K
    return time_plot(curves, times, "After a load step of 1 %", ylabel="deviation [%]", ylim=limits)


def _gain_factor(process, pid):
    try:
        return ultimate(process * pid.expr)[0]
    except ValueError:  # no gain makes it stable
        return 0.0


def _delay_factor(process, delay, pid):
    try:
        return 1 + delay_margin(process * pid.expr) / float(delay)
    except ValueError:  # unstable as it is
        return 0.0


def _area(pid):
    return abs(float(pid.Ti / pid.Kp)) if pid.Kp else math.inf


def robust_and_strong(key, K, T, delay, area):
    """Settings that bear 2.5 times the gain and 2.5 times the dead time, and are strong enough against loads."""
    process = first_order(K, T, delay)
    return design(
        settings(key, gain="%/%", time="s"),
        pi_controller(),
        stable(process),
        criterion("the factor by which the gain may grow", lambda pid: _gain_factor(process, pid), above=2.5),
        criterion(
            "the factor by which the dead time may grow", lambda pid: _delay_factor(process, delay, pid), above=2.5
        ),
        criterion("the integral of the error", _area, below=float(area), unit="% s"),
        draws=lambda pid: _three_responses(K, T, delay, pid),
    )
