"""Python beside the page of exercise 15.5."""

import math

import numpy as np

from loopbook.deadtime import Loop, System
from loopbook.exercises.authoring import criterion, design, largest_sensitivity, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import first_order
from loopbook.tuning import simc  # noqa: F401


def _by_rule(K, T, delay):
    return PID(T / (2 * K * delay), 8 * delay)


def sensitivity(K, T, delay):
    """The largest sensitivity with Skogestad's settings, to three digits."""
    w = np.geomspace(1e-3, 20, 3000) / float(delay)
    L = System(first_order(K, T, delay) * _by_rule(K, T, delay).expr).frequency(w)
    return float(f"{max(1 / abs(1 + L)):.3g}")


def recovery(K, T, delay):
    """The time of recovery with Skogestad's settings, to three digits."""
    return float(f"{_recovery(float(K), float(T), float(delay), _by_rule(K, T, delay)):.3g}")


def late_share(K, T, delay, controller):
    """How much of the largest deviation is left after the time that is allowed."""
    times = np.linspace(0, float(60 * delay), 1201)
    y = abs(np.array(Loop(first_order(K, T, delay), controller).regulator.step(times), float))
    return max(y[times >= 25 * float(delay)]) / max(y)


def _is_stable(K, T, delay, controller):
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    return 0 < Ti < math.inf and math.isfinite(pi_first_order(K, T, delay, Kp, Ti, "regulator", math.inf))


def _recovery(K, T, delay, controller):
    """How long the deviation after a step of the load stays above 5 % of its largest value, up to 200 dead times.

    Segment by segment of one dead time: what the controller does in one is felt in the next.
    """
    Kp, Ti, n = float(controller.Kp), float(controller.Ti), 40
    h = delay / n
    fade = np.exp(-h / T * np.arange(1, n + 1))
    arriving, y, integral, deviation = np.zeros(n + 1), np.zeros(1), np.zeros(1), []
    for _ in range(200):
        driven = K * (1 - fade[0]) * (1 + (arriving[1:] + arriving[:-1]) / 2)
        y = np.append(y[-1], fade * (y[-1] + np.cumsum(driven / fade)))
        integral = np.append(integral[-1], integral[-1] + h * np.cumsum((y[1:] + y[:-1]) / 2))
        arriving = -Kp * (y + integral / Ti)
        deviation.append(abs(y[1:]))
    deviation = np.concatenate(deviation)
    return delay + h * float(np.flatnonzero(deviation > 0.05 * deviation.max())[-1] + 1)


def _after_a_load(K, T, delay, controller):
    times = np.linspace(0, 40 * delay, 401)
    y = Loop(first_order(K, T, delay), controller).regulator.step(times)
    plot = time_plot({"$y$": (y, "measurement")}, times, "Your loop after a load step of 1 %", "$t$ [min]", "$y$ [K]")
    return plot.level(0.05 * max(y), "5 % of the largest").event(25 * delay, "recovered?")


def robust_and_quick(controller, K, T, delay):
    """Settings with an Ms of at most 1.7, with which the oven recovers in 25 dead times."""
    process = float(K), float(T), float(delay)
    return design(
        settings(controller, gain="%/K", time="min", what="the settings of the PI controller"),
        pi_controller(),
        stable(by=lambda controller: _is_stable(*process, controller)),
        largest_sensitivity(first_order(K, T, delay), 20 / delay, below=1.7),
        criterion(
            "the time of recovery", lambda controller: _recovery(*process, controller), below=25 * delay, unit="min"
        ),
        draws=lambda controller: _after_a_load(*process, controller),
    )
