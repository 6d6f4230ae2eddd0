"""The responses of exercise 17.1."""

from scipy.integrate import quad

from loopbook.deadtime import System
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor, times_until
from loopbook.figures import time_plot
from loopbook.ise import ise
from loopbook.transfer import first_order

__all__ = ["first_order", "integral_of_square", "ise", "picture", "predictor", "solution_picture"]


def _response(K, T, delay, times):
    return System(first_order(K, T, delay)).step(times)


def integral_of_square(K, T, delay, until):
    """The integral of the square of the response to a unit step."""
    return quad(lambda time: _response(K, T, delay, [time])[0] ** 2, float(delay), float(until), epsrel=1e-8)[0]


def picture(K, T, delay):
    """The signal after a load step of 1 % without a controller: a dead time, and then a lag."""
    times = times_until(delay + 4 * T)
    curves = {"$y$": (_response(K, T, delay, times), "measurement")}
    return time_plot(curves, times, "A load of 1 %, nobody acts", ylabel="$y$ [%]")


def solution_picture(K, T, delay):
    """The response to the load without a controller until the first effect can be seen, with the error shaded."""
    times = times_until(2 * delay)
    curves = {"$y^2$": (_response(K, T, delay, times) ** 2, "measurement")}
    plot = time_plot(curves, times, "Nobody can avoid this", ylabel="$y^2$")
    return plot.area("$y^2$", label="the least ISE").event(delay, "seen")
