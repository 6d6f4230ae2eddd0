"""Python beside the page of exercise 10.7."""

from functools import lru_cache

import numpy as np
from sympy import exp

from loopbook.exercises.authoring import criterion, design, pi_controller, settings, stable
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.signals import stepwise
from loopbook.stability import is_closed_loop_stable

_INTEGRATOR = exp(-s) / s  # with the dead time as the unit of time and the slope 1


def both_demands(pid, K, delay, limit):
    """A design that meets both demands."""
    return design(
        settings(pid, "", "min", "the settings"),
        pi_controller(),
        stable(by=lambda pid: pid.Kp != 0 and is_closed_loop_stable(K * exp(-delay * s) / s * pid.expr)),
        criterion("the overshoot", lambda pid: overshoot_of(K * delay * pid.Kp, pid.Ti / delay), below=40, unit="%"),
        criterion("the integral of the error", lambda pid: pid.Ti / pid.Kp, below=limit, unit="% min"),
        draws=lambda pid: _level(K, delay, pid),
    )


@lru_cache
def overshoot_of(Kp, Ti):
    """Overshoot of the loop after a setpoint step, in percent of the step."""
    y = Loop(_INTEGRATOR, PID(Kp, Ti)).servo.step(np.linspace(0, 25, 201))
    return 100 * (float(y.max()) - 1)


def _level(K, delay, pid):
    """The level after a setpoint step of 1 % and, later, a load step of 1 %, beside the highest level allowed."""
    load_at, times = 25 * delay, np.linspace(0, 50 * float(delay), 401)
    run = Loop(K * exp(-delay * s) / s, pid).run(times, setpoint=1, load=stepwise(0, {load_at: 1}))
    curves = {"setpoint": (1, "setpoint"), "level": (run["y"], "measurement")}
    plot = time_plot(curves, times, xlabel="$t$ [min]", ylabel="level [%]", ylim=(-0.5, 2.5))
    return plot.level(1.4, "highest after the setpoint step", "level").event(load_at, "load of 1 %")


def picture(K, delay):
    """What the level does after the valve has opened by 1 % at time zero: a dead time, and then a ramp."""
    rise = {"rise of the level [%]": (np.array([0, 0, 4 * K * delay], float), "measurement")}
    return time_plot(rise, [0, delay, 5 * delay], xlabel="$t$ [min]", low=True)
