"""Python beside the page of exercise 15.7."""

import numpy as np

from loopbook.deadtime import Loop
from loopbook.exercises import authoring
from loopbook.figures import time_plot
from loopbook.synthesis import imc  # noqa: F401
from loopbook.transfer import first_order


def _rise(times, T, delay):
    return np.where(times > delay, 1 - np.exp(-(times - delay) / T), 0)


def record_and_wish(step, K, T, delay, Tc, noise):
    """The times, the noisy record of the temperature, and the wish."""
    times = np.linspace(0, float(delay + 5 * max(T, Tc)), 251)
    clean = float(K * step) * _rise(times, float(T), float(delay))
    y = clean + np.random.default_rng(int(noise)).normal(0, 0.008 * float(K * step), len(times))
    return times, y, _rise(times, float(Tc), float(delay))


def read_off(key, unit, what, within):
    """A number that is given, and is asked where it is only seen in the picture."""
    return authoring.number(key, unit, what, within=float(within))


def reached(t, y, level):
    """When a curve is at a level for the first time."""
    return float(t[np.argmax(y >= float(level))])


def picture(t, y, wish):
    """Above the noisy record of the temperature after the step of the valve, below the desired response to 1 K."""
    panels = [{"record": (y, "measurement")}, {"wish": (wish, 0)}]
    return time_plot(panels, t, ylabel=["temperature rise [K]", "wish [K]"])


def solution_picture(K, T, delay, Tc, controller):
    """The loop with this controller beside the wish: although its dead time is exact, the two are close."""
    times = np.linspace(0, float(delay + 6 * Tc), 401)
    y = Loop(first_order(K, T, delay), controller).servo.step(times)
    curves = {"loop": (y, "measurement"), "wish": (_rise(times, float(Tc), float(delay)), "setpoint")}
    return time_plot(curves, times, "A step of the setpoint by 1 K", ylabel="temperature [K]")
