"""Python beside the page of exercise 7.7."""

import numpy as np
from sympy import Rational

from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.stability import delay_margin, ultimate
from loopbook.transfer import first_order


def _or_zero(measure, loop):
    try:
        return measure(loop)
    except ValueError:  # no gain makes it stable, or it is unstable as it is
        return 0.0


def robust_and_strong(key, K, T, delay, area):
    """Settings that bear 2.5 times the gain and 2.5 times the dead time, and are strong enough against loads."""
    more, process = Rational(5, 2), first_order(K, T, delay)

    def gain_factor(pid):
        return _or_zero(lambda loop: ultimate(loop)[0], process * pid.expr)

    def delay_factor(pid):
        return _or_zero(lambda loop: 1 + delay_margin(loop) / float(delay), process * pid.expr)

    def three_responses(pid):
        processes = {
            "as it is": process,
            "gain 2.5 times": more * process,
            "dead time 2.5 times": first_order(K, T, more * delay),
        }
        times = np.linspace(0, 4 * float(T), 301)
        curves = {name: Loop(one, pid).regulator.step(times) for name, one in processes.items()}
        limits = -float(K), float(K)  # without a controller it would end at K
        return time_plot(curves, times, "After a load step of 1 %", ylabel="deviation [%]", ylim=limits)

    return design(
        settings(key, gain="%/%", time="s"),
        pi_controller(),
        stable(process),
        criterion("the factor by which the gain may grow", gain_factor, above=2.5),
        criterion("the factor by which the dead time may grow", delay_factor, above=2.5),
        criterion("the integral of the error", lambda pid: abs(float(pid.Ti / pid.Kp)), below=float(area), unit="% s"),
        draws=three_responses,
    )
