"""Exercises of chapter 10, tuning of PID controllers."""

from functools import lru_cache

import numpy as np
from sympy import Min, Rational, exp, pi, symbols

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    pi_controller,
    settings,
    stable,
    word,
)
from loopbook.expressions import s
from loopbook.pid import PID


@exercise(
    "10.1",
    title="A model by ruler",
    points=2,
    where=lambda t_28, t_63: 2 * t_28 <= t_63 <= Rational(5, 2) * t_28,
)
def ruler(
    step=between(4, 12, "%", reference=8),
    rise=between(6, 30, "K", step=1.5, reference=12),
    t_28=between(30, 80, "s", step=2, reference=40),
    t_63=between(70, 180, "s", step=5, reference=90),
):
    """The heater of a grain dryer is in manual mode and the outlet air is at rest. At time zero the control signal
    makes a step of {step}. In the end the air is {rise} warmer than before. It has covered 28 % of this rise after
    {t_28}, and 63 % after {t_63}.

    Take the dryer for a lag with dead time, and find its gain, its time constant and its dead time. A lag without dead
    time has covered 28 % after a third of its time constant, $1 - e^{-1/3} = 0.28$, and 63 % after one time constant.
    """
    T = Rational(3, 2) * (t_63 - t_28)
    return answers(
        K=number(rise / step, "K/%", "the gain of the process"),
        T=number(T, "s", "the time constant"),
        tau=number(t_63 - T, "s", "the dead time", within=0.05),  # exact logarithms for 28 % and 63 % do no harm
    )


@ruler.mistake("That is the whole rise. The gain is the rise for one percent of the control signal.")
def _(rise):
    return {"K": rise}


@ruler.mistake("The 63 % count from the moment when the response begins, and that is a dead time after the step.")
def _(t_63):
    return {"T": t_63}


@ruler.mistake("Between 28 % and 63 % there is less than a whole time constant: look at what each of them means.")
def _(t_28, t_63):
    return {"T": t_63 - t_28}


@ruler.mistake("At 28 % the response is well on its way: the dead time was over a part of the time constant before.")
def _(t_28):
    return {"tau": t_28}


@exercise(
    "10.2",
    title="An experiment with the Good Gain",
    points=2,
    where=lambda t_1, t_2: Rational(17, 10) * t_1 <= t_2 <= Rational(19, 10) * t_1,  # as responses with dead time are
)
def good_gain_experiment(
    K=between(2, 12, "%/bar", step=0.5, reference=5),
    t_1=between(30, 64, "s", step=2, reference=48),
    t_2=between(54, 120, "s", step=2, reference=88),
):
    """The pressure of a steam drum is under P control. With a gain of {K} the response to a setpoint step is what
    the Good Gain method looks for: it overshoots, and the undershoot that follows is barely observable. The overshoot
    has its top {t_1} after the step, and the undershoot its bottom {t_2} after the step.

    Find the settings of a **PID** controller in parallel form.
    """
    T_i = Rational(3, 2) * (t_2 - t_1)
    return answers(
        Kp=number(Rational(4, 5) * K, "%/bar", "the proportional gain"),
        Ti=number(T_i, "s", "the integral time"),
        Td=number(T_i / 4, "s", "the derivative time"),
    )


@good_gain_experiment.mistake("That is the gain of the experiment. With an integral term the loop needs a smaller one.")
def _(K):
    return {"Kp": K}


@good_gain_experiment.mistake(
    "The time that the method asks for does not begin at the setpoint step: see where it does."
)
def _(t_2):
    return {"Ti": Rational(3, 2) * t_2, "Td": Rational(3, 8) * t_2}


@good_gain_experiment.mistake("Here the time was taken as it was read off. The integral time is longer than that.")
def _(t_1, t_2):
    return {"Ti": t_2 - t_1, "Td": (t_2 - t_1) / 4}


@good_gain_experiment.mistake("The method reads off half a period, from the top to the bottom, and not a whole one.")
def _(t_1, t_2):
    return {"Ti": 3 * (t_2 - t_1), "Td": Rational(3, 4) * (t_2 - t_1)}


@exercise(
    "10.3",
    title="Serial settings for a parallel controller",
    points=3,
    where=lambda T_1, T_2, delay: max(3 * T_2, 5 * delay) <= T_1 and T_2 < 3 * delay,
)
def heat_exchanger(
    K=between(0.5, 2.5, "K/%", reference=0.8),
    T_1=between(60, 200, "s", step=10, reference=120),
    T_2=between(10, 40, "s", step=5, reference=20),
    delay=between(6, 20, "s", step=2, reference=10),
):
    r"""A heat exchanger and its sensor have been modelled by

    $$H_{{psf}}(s) = \frac{K\,e^{-\tau s}}{(T_1 s + 1)(T_2 s + 1)}$$

    with the gain $K$ = {K}, the lags $T_1$ = {T_1} and $T_2$ = {T_2}, and the dead time $\tau$ = {delay}. The loop
    should be as fast as the dead time allows, $T_C = \tau$, and recover quickly from loads, with the factor $c = 2$.

    Find Skogestad's settings. The controller at hand has the **parallel** form.
    """
    serial = PID(T_1 / (K * 2 * delay), Min(T_1, 4 * delay), T_2, form="serial")
    return answers(pid=settings(serial.parallel(), "%/K", "s", "the settings", form="parallel"))


@heat_exchanger.mistake("That is the integral time for $c = 4$. Look at the factor in the question.")
def _(K, T_1, T_2, delay):
    if 8 * delay < T_1:
        return {"pid": PID(T_1 / (K * 2 * delay), 8 * delay, T_2, form="serial").parallel()}


@heat_exchanger.mistake(
    "The integral time is the lag itself here. With the factor in the question, the other limit is shorter."
)
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), T_1, T_2, form="serial").parallel()}


@heat_exchanger.mistake("The gain is too high for this loop. Besides the dead time there is $T_C$ in the denominator.")
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * delay), Min(T_1, 4 * delay), T_2, form="serial").parallel()}


@heat_exchanger.mistake("The second lag is missing. A PI controller leaves it in the loop; what could cancel it?")
def _(K, T_1, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), Min(T_1, 4 * delay))}


_T, _T_C, _tau = symbols("T T_C tau", positive=True)


@exercise("10.4", title="How short may the integral time be?", points=4)
def integral_time(
    zeta=between(0.5, 1, step=0.05, reference=1),
    n=choice(3, 4, 5, 6, 8, 9, 10, 12, 15, reference=9),
):
    r"""For an integrator, the shortest integral time that does not make the loop oscillate slowly was found to be
    $4(T_C + \tau)$. What is it for a lag? The process is $\frac{K\,e^{-\tau s}}{Ts + 1}$, and the PI controller
    has Skogestad's gain $K_p = \frac{{T}}{K(T_C + \tau)}$ and an integral time $T_i$ that is still to be chosen.

    The slow motions do not feel the dead time: leave $e^{-\tau s}$ away. Which $T_i$ gives the two poles of the loop
    the damping $\zeta = {zeta}$? Put this number in for $\zeta$, and give $T_i$ in the symbols $T$, $T_C$ and $\tau$
    (type `T`, `T_C`, `tau`). Then let the lag be {n} times as long as $T_C + \tau$: how many times as long as
    $T_C + \tau$ is the integral time?
    """
    total = _T_C + _tau
    return answers(
        Ti=expression(
            4 * zeta**2 * total * _T**2 / (_T + total) ** 2, "the integral time in symbols", symbols="T T_C tau"
        ),
        factor=number(4 * zeta**2 * n**2 / (n + 1) ** 2, "", r"the integral time as a multiple of $T_C + \tau$"),
    )


@integral_time.mistake("That is the result for an integrator. The lag has a term of its own in the polynomial.")
def _(zeta):
    return {"Ti": 4 * zeta**2 * (_T_C + _tau), "factor": 4 * zeta**2}


@integral_time.mistake(
    "Compare once more with $s^2/\\omega^2 + 2\\zeta s/\\omega + 1$: the middle term has a factor 2."
)
def _(zeta, n):
    total = _T_C + _tau
    return {"Ti": zeta**2 * total * _T**2 / (_T + total) ** 2, "factor": zeta**2 * n**2 / (n + 1) ** 2}


@exercise("10.5", title="What the relay has found", points=3, where=lambda low, high, a: 10 <= high - low <= 30 * a)
def relay(
    low=between(20, 45, "%", step=5, reference=35),
    high=between(40, 70, "%", step=5, reference=55),
    middle=between(50, 90, "°C", step=5, reference=70),
    a=between(0.4, 3, "K", step=0.2, reference=1.6),
    period=between(4, 16, "min", step=1, reference=8),
):
    r"""An autotuner has let a relay switch the steam valve of a pasteuriser between {low} and {high}. Soon the
    temperature oscillates steadily between {coldest} and {hottest}, with a period of {period}.

    Estimate the ultimate gain, and find the PID settings of Ziegler and Nichols
    ($K_p = 0.6 K_u$, $T_i = P_u/2$, $T_d = P_u/8$).
    """
    K_u = 4 * (high - low) / 2 / (pi * a)
    return answers(
        Ku=number(K_u, "%/K", "the ultimate gain"),
        Kp=number(Rational(3, 5) * K_u, "%/K", "the proportional gain"),
        Ti=number(period / 2, "min", "the integral time"),
        Td=number(period / 8, "min", "the derivative time"),
    )


@relay.shows
def _(middle, a):
    return {"coldest": _degrees(middle - a), "hottest": _degrees(middle + a)}


def _degrees(value):
    return f"{float(value):.1f}\N{NO-BREAK SPACE}°C"


def _relay_gains(K_u):
    return {"Ku": K_u, "Kp": Rational(3, 5) * K_u}


@relay.mistake(
    "The amplitude counts from the middle of the swing; from the lowest to the highest value it is twice that."
)
def _(low, high, a):
    return _relay_gains((high - low) / (pi * a))


@relay.mistake("The height of the relay counts from the middle of its two positions, and not from one to the other.")
def _(low, high, a):
    return _relay_gains(4 * (high - low) / (pi * a))


@relay.mistake("That is height over amplitude. The sinusoid in a square wave is larger than the square wave itself.")
def _(low, high, a):
    return _relay_gains((high - low) / 2 / a)


@exercise(
    "10.6",
    title="Another flow through the tank",
    points=3,
    where=lambda w_1, w_2: 5 * min(w_1, w_2) <= 4 * max(w_1, w_2) and 3 * w_1 <= 5 * w_2,
)
def another_flow(
    K_p=between(2, 9, "%/K", step=0.5, reference=6),
    T_i=between(4, 12, "min", step=0.5, reference=5),
    w_1=choice(16, 20, 24, 30, unit="kg/min", reference=24),
    w_2=choice(10, 12, 15, 18, 32, 36, 40, unit="kg/min", reference=15),
):
    r"""The temperature of a stirred heating tank is under PI control. The process is a lag with dead time whose gain
    $K$, time constant $T$ and dead time $\tau$ are all proportional to $1/w$, where $w$ is the flow of liquid. At
    $w$ = {w_1} Skogestad's rule with $T_C = \tau$ gave the settings $K_p$ = {K_p} and $T_i$ = {T_i}, where $T_i = T$.

    The flow changes to {w_2}. Find the settings that the rule gives now. And what would become of the loop if the
    settings stayed as they are?
    """
    return answers(
        Kp=number(K_p * w_2 / w_1, "%/K", "the proportional gain"),
        Ti=number(T_i * w_1 / w_2, "min", "the integral time"),
        unchanged=word(
            "less stable" if w_2 < w_1 else "more sluggish",
            ["less stable", "as it was", "more sluggish"],
            "what becomes of the loop with the old settings",
        ),
    )


@another_flow.mistake(
    "Follow $T$ and $\\tau$ once more: does the time constant grow or shrink with this change of the flow?"
)
def _(T_i, w_1, w_2):
    return {"Ti": T_i * w_2 / w_1}


@another_flow.mistake("It is true that $T/\\tau$ stays as it was, but $K_p$ has the gain of the process in it, too.")
def _(K_p):
    return {"Kp": K_p}


@another_flow.mistake("If the gain of the process grows, should the gain of the controller grow or shrink?")
def _(K_p, w_1, w_2):
    return {"Kp": K_p * w_1 / w_2}


@another_flow.mistake(
    "Two of the three, $T$ and $\\tau$, cancel each other in $K_p$, so that the flow enters only once."
)
def _(K_p, w_1, w_2):
    return {"Kp": K_p * w_2**2 / w_1**2}


@another_flow.mistake("The rule makes the integral time equal to the time constant. Does that stay as it was?")
def _(T_i):
    return {"Ti": T_i}


@another_flow.mistake("Follow the gain of the process: does the loop gain grow or shrink with this flow?")
def _(w_1, w_2):
    return {"unchanged": "more sluggish" if w_2 < w_1 else "less stable"}


@another_flow.mistake("The settings are as they were, but the process is not. What is its gain now?")
def _():
    return {"unchanged": "as it was"}


@exercise("10.7", title="Between two and four", points=5)
def between_two_and_four(
    K=between(0.02, 0.1, "%/min", step=0.01, reference=0.05),
    delay=between(2, 8, "min", step=1, reference=4),
):
    r"""The level of a surge drum answers to the feed valve like an integrator with dead time: {delay} after the valve
    opens by 1 %, the level begins to rise by {K}, and it goes on rising. Level and valve opening are both in percent of
    their ranges, so that the gain of the controller has no unit.

    Find a PI controller that does both:

    - After a setpoint step, the overshoot is at most 40 % of the step.
    - After a load step of 1 % at the input of the process, the integral of the control error is at most {limit}. (It is
      $T_i/K_p$, as long as the loop is stable.)

    Any settings that meet both are right.
    """
    good = PID(1 / (2 * K * delay), 6 * delay)
    return answers(
        pid=design(
            settings(good, "", "min", "the settings"),
            pi_controller(),
            stable(by=lambda pid: _is_stable(K * delay * pid.Kp, pid.Ti / delay)),
            criterion("the overshoot", lambda pid: _overshoot(K * delay * pid.Kp, pid.Ti / delay), below=40, unit="%"),
            criterion("the integral of the error", lambda pid: pid.Ti / pid.Kp, below=_limit(K, delay), unit="% min"),
        )
    )


def _limit(K, delay):
    """What a factor c between two and four reaches: at c = 4 the integral is 16 K tau^2, at c = 3 it is 12."""
    value = float(14 * K * delay**2)
    return round(value, 1 if value < 10 else 0)


_INTEGRATOR = exp(-s) / s  # with the dead time as the unit of time and the slope 1


@lru_cache
def _is_stable(Kp, Ti):
    from loopbook.stability import is_closed_loop_stable

    return Kp != 0 and is_closed_loop_stable(PID(Kp, Ti).expr * _INTEGRATOR)


@lru_cache
def _overshoot(Kp, Ti):
    """Overshoot of the loop after a setpoint step, in percent of the step."""
    from loopbook.deadtime import Loop

    y = Loop(_INTEGRATOR, PID(Kp, Ti)).servo.step(np.linspace(0, 25, 201))
    return 100 * (float(y.max()) - 1)


@between_two_and_four.shows
def _(K, delay):
    return {"limit": f"{_limit(K, delay):g}\N{NO-BREAK SPACE}% min"}


@between_two_and_four.mistake(
    "With $c = 4$ the overshoot is small enough, but the loop recovers too slowly from the load."
)
def _(K, delay):
    return {"pid": PID(1 / (2 * K * delay), 8 * delay)}


@between_two_and_four.mistake("With $c = 2$ the loop recovers quickly, but it overshoots by nearly half of the step.")
def _(K, delay):
    return {"pid": PID(1 / (2 * K * delay), 4 * delay)}
