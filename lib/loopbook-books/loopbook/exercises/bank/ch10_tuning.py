"""Exercises of chapter 10, tuning of PID controllers."""

from functools import lru_cache
from math import log, pi, sqrt

import numpy as np
from sympy import Min, Rational, exp, symbols

from exercisebook.parameters import written
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
from loopbook.expressions import exact, s
from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.signals import stepwise


@exercise(
    "10.1",
    title="A model by ruler",
    points=2,
    where=lambda t_28, t_63: 2 * t_28 <= t_63 <= Rational(5, 2) * t_28,
    insight="Two points of a step response are enough for a first model: their distance in time gives the time "
    "constant, and what is then left in front is the dead time.",
)
def ruler(
    step=between(4, 12, "%", reference=8),
    rise=between(6, 30, "K", step=1.5, reference=12),
    t_28=between(30, 80, "s", step=2, reference=40),
    t_63=between(70, 180, "s", step=5, reference=90),
):
    """The heater of a grain dryer is in manual mode and the temperature of the outlet air is constant. At time zero the
    control signal makes a step of {step}. In the end the air is {rise} warmer than before; 28 % of this rise are
    reached {t_28} after the step, and 63 % after {t_63}.

    Model the dryer as a lag with dead time, and find its gain, its time constant and its dead time. A lag without dead
    time reaches 28 % after a third of its time constant, $1 - e^{-1/3} = 0.28$, and 63 % after one time constant.
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


@ruler.mistake("That is how far the response has come at 63 %. The gain counts what one percent does in the end.")
def _(step, rise):
    return {"K": rise / step * (1 - exp(-1))}


@ruler.mistake("That is the rise for the whole range of the control signal. How much does one percent of it bring?")
def _(step, rise):
    return {"K": 100 * rise / step}


@ruler.mistake(
    "The distance of the two readings is a part of the time constant. So is the time constant shorter or longer?"
)
def _(t_28, t_63):
    T = Rational(2, 3) * (t_63 - t_28)
    return {"T": T, "tau": t_63 - T}


@ruler.mistake("This fits a time constant that is shorter than the distance of the two readings. Can it be?")
def _(t_28, t_63):
    return {"tau": t_28 - Rational(2, 9) * (t_63 - t_28)}


@ruler.mistake("That would be right without a dead time: then 28 % would be reached after a third of $T$.")
def _(t_28):
    return {"T": 3 * t_28}


@ruler.mistake("Here the whole {t_63} was taken for the time constant, but the dead time is in it. Find $T$ first.")
def _(t_28, t_63):
    return {"tau": t_28 - t_63 / 3}


@ruler.mistake(
    "Here the distance of the two readings was taken for a whole time constant. Which part of it lies between them?"
)
def _(t_28, t_63):
    return {"tau": t_28 - (t_63 - t_28) / 3}


ruler.hints(
    "The gain compares two changes that last. The two times tell how the response gets there: which part of each of "
    "them is dead time?",
    "With the dead time in front, the readings are $t_{28} = \\tau + T/3$ and $t_{63} = \\tau + T$: two equations for "
    "two unknowns.",
    "The gain is $K = \\frac{ {rise} }{ {step} }$. Subtract the first equation from the second, and the dead time is "
    "gone: ${t_63} - {t_28} = \\frac{2}{3} T$.",
)


@ruler.solution
def _():
    r"""The gain is what one percent of the control signal does in the end: $K = \frac{ {rise} }{ {step} }$, which is
    {K}.

    Nothing happens until the dead time is over; then the response is that of a lag. So the two readings are
    $t_{28} = \tau + T/3$ and $t_{63} = \tau + T$. In their difference the dead time cancels:
    ${t_63} - {t_28} = T - T/3$.

    ***

    Two thirds of the time constant are ${t_63} - {t_28}$, so $T = 1.5 \cdot ({t_63} - {t_28})$, which is {T}.

    The dead time is what is left of the second reading, $\tau = {t_63} - {T}$, which is {tau}. The first reading
    confirms it: $\tau + T/3 = {tau} + {T}/3 = {t_28}$.
    """
    return {}


@ruler.picture
def _(rise, t_28, t_63):
    """The rise of the temperature after the step, with the two moments at which 28 and 63 % of it are reached."""
    T = 1.5 * float(t_63 - t_28)
    tau = float(t_63) - T
    times = np.linspace(0, np.ceil((tau + 5 * T) / 50) * 50, 401)
    y = float(rise) * -np.expm1(-np.maximum(times - tau, 0) / T)
    plot = time_plot({"rise of the temperature [K]": (y, "measurement")}, times)
    return plot.level(rise, "in the end").mark(t_28, "28 %").mark(t_63, "63 %")


@exercise(
    "10.2",
    title="An experiment with the Good Gain",
    points=2,
    where=lambda t_1, t_2: Rational(17, 10) * t_1 <= t_2 <= Rational(19, 10) * t_1,  # as responses with dead time are
    insight="One experiment and two numbers, the gain and half a period, tune a loop without any model.",
)
def good_gain_experiment(
    K=between(2, 12, "%/bar", step=0.5, reference=5),
    t_1=between(30, 64, "s", step=2, reference=48),
    t_2=between(54, 120, "s", step=2, reference=88),
):
    """The pressure in a steam drum is under P control. With a gain of {K} the response to a setpoint step is the one
    that the Good Gain method looks for: it overshoots, and the undershoot that follows can barely be seen. The response
    is highest {t_1} after the step, and lowest, in the undershoot, {t_2} after the step.

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


@good_gain_experiment.mistake(
    "The time that the method asks for does not end at the top: which two points of the response are half a period "
    "apart?"
)
def _(t_1):
    return {"Ti": Rational(3, 2) * t_1, "Td": Rational(3, 8) * t_1}


@good_gain_experiment.mistake("Here the time was taken as it was read off. The integral time is longer than that.")
def _(t_1, t_2):
    return {"Ti": t_2 - t_1}


@good_gain_experiment.mistake("That is a quarter of the time that was read off. Of which time is it to be a quarter?")
def _(t_1, t_2):
    return {"Td": (t_2 - t_1) / 4}


@good_gain_experiment.mistake("The method reads off half a period, from the top to the bottom, and not a whole one.")
def _(t_1, t_2):
    return {"Ti": 3 * (t_2 - t_1), "Td": Rational(3, 4) * (t_2 - t_1)}


@good_gain_experiment.mistake(
    "Is this gain larger or smaller than that of the experiment? The integral term makes a loop less stable."
)
def _(K):
    return {"Kp": K / Rational(4, 5)}


@good_gain_experiment.mistake(
    "This factor belongs to the ultimate gain. In this experiment the loop was not yet at the limit of stability."
)
def _(K):
    return {"Kp": Rational(3, 5) * K}


@good_gain_experiment.mistake(
    "This factor belongs to the ultimate gain. In this experiment the loop was not yet at the limit of stability."
)
def _(K):
    return {"Kp": Rational(45, 100) * K}


@good_gain_experiment.mistake("That share of a period is the integral time of a PI controller by Ziegler and Nichols.")
def _(t_1, t_2):
    return {"Ti": Rational(5, 3) * (t_2 - t_1)}


@good_gain_experiment.mistake("Is the integral time longer or shorter than the time between top and bottom?")
def _(t_1, t_2):
    return {"Ti": (t_2 - t_1) / Rational(3, 2), "Td": (t_2 - t_1) / 6}


@good_gain_experiment.mistake("An eighth of the *period* is common. Which share of the integral time would that be?")
def _(t_1, t_2):
    return {"Td": Rational(3, 16) * (t_2 - t_1)}


@good_gain_experiment.mistake("That would be a PI controller. A PID controller is asked for.")
def _():
    return {"Td": 0}


@good_gain_experiment.mistake(
    "Half of a gain is tuned for a P controller at its ultimate gain. Neither is the case here."
)
def _(K):
    return {"Kp": K / 2}


@good_gain_experiment.mistake("Is the derivative time longer or shorter than the integral time?")
def _(t_1, t_2):
    return {"Td": 6 * (t_2 - t_1)}


good_gain_experiment.hints(
    "The Good Gain method takes two numbers from the experiment: the gain, and the time between two events of the "
    "response. Which two?",
    "With $T_{ou}$ from overshoot to undershoot: $K_p = 0.8\\,K_{pGG}$, $T_i = 1.5\\,T_{ou}$ and $T_d = T_i/4$.",
    "$T_{ou} = {t_2} - {t_1}$ in seconds: when the setpoint made its step does not matter.",
)


@good_gain_experiment.solution
def _(t_1, t_2):
    r"""The method reads two numbers off the experiment. The gain is $K_{pGG} = {K}$. The time $T_{ou}$ goes from the
    top of the overshoot to the bottom of the undershoot, ${t_2} - {t_1}$, which is {T_ou}. The moment of the setpoint
    step is in neither of them.

    The integral term will cost stability, and a smaller gain pays for it: $K_p = 0.8 \cdot {K}$, which is {Kp}.

    $T_{ou}$ is half a period of the oscillation, and the integral time is three quarters of a period:
    $T_i = 1.5 \cdot {T_ou}$, which is {Ti}. The derivative time is a quarter of that, {Td}, as with Ziegler and
    Nichols.
    """
    return {"T_ou": (t_2 - t_1, "s")}


@good_gain_experiment.picture
def _(t_1, t_2):
    """The response to a setpoint step with the gain of the experiment; its highest and its lowest point are marked."""
    half, after = float(t_2 - t_1), log(5)  # half a period, and the decay in it: an overshoot of 20 %
    start = float(t_1) - half
    times = np.linspace(0, float(t_1) + 3 * half, 601)
    x = np.maximum(times - start, 0) / half
    y = 1 - np.exp(-after * x) * (np.cos(pi * x) + after / pi * np.sin(pi * x))
    curves = {"setpoint": (1, "setpoint"), "pressure": (y, "measurement")}
    plot = time_plot(curves, times, ylabel="share of the step")
    return plot.mark(t_1, "top", "pressure").mark(t_2, "bottom", "pressure")


@exercise(
    "10.3",
    title="Serial settings for a parallel controller",
    points=3,
    where=lambda T_1, T_2, delay: max(3 * T_2, 5 * delay) <= T_1 and 3 * delay > T_2,
    insight="Settings belong to a form: typed into the other one, the same three numbers are another controller.",
)
def heat_exchanger(
    K=between(0.5, 2.5, "K/%", reference=0.8),
    T_1=between(60, 200, "s", step=10, reference=120),
    T_2=between(10, 40, "s", step=5, reference=20),
    delay=between(6, 20, "s", step=2, reference=10),
):
    r"""A heat exchanger and its sensor have been modelled by

    $$H_{{psf}}(s) = \frac{K\,e^{-\tau s}}{(T_1 s + 1)(T_2 s + 1)}$$

    with the gain $K$ = {K}, the time constants $T_1$ = {T_1} and $T_2$ = {T_2}, and the dead time $\tau$ = {delay}. The
    loop should be as fast as the dead time allows, $T_C = \tau$, and recover quickly from loads, with the factor
    $c = 2$.

    Find Skogestad's settings for the controller that is available: it has the **parallel** form.
    """
    serial = PID(T_1 / (K * 2 * delay), Min(T_1, 4 * delay), T_2, form="serial")
    return answers(pid=settings(serial.parallel(), "%/K", "s", "the settings", form="parallel"))


@heat_exchanger.mistake("That is the integral time for $c = 4$. Look at the factor in the question.")
def _(K, T_1, T_2, delay):
    if 8 * delay < T_1:
        return {"pid": PID(T_1 / (K * 2 * delay), 8 * delay, T_2, form="serial").parallel()}


@heat_exchanger.mistake(
    "Your serial integral time is $T_1$. With the factor in the question, the other limit is shorter."
)
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), T_1, T_2, form="serial").parallel()}


@heat_exchanger.mistake("The gain is too high for this loop. Besides the dead time there is $T_C$ in the denominator.")
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * delay), Min(T_1, 4 * delay), T_2, form="serial").parallel()}


@heat_exchanger.mistake(
    "The second time constant is missing. A PI controller leaves its lag in the loop; what could cancel it?"
)
def _(K, T_1, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), Min(T_1, 4 * delay))}


def _serial(K, T_1, T_2, delay):
    """The settings of Skogestad's table, and the factor between the forms."""
    K_p, T_i = T_1 / (K * 2 * delay), Min(T_1, 4 * delay)
    return K_p, T_i, T_2, 1 + T_2 / T_i


@heat_exchanger.mistake("The two times are converted. What about the gain? Multiply the serial form out.")
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p, T_i * factor, T_d / factor)}


@heat_exchanger.mistake("The gain is converted. What about the two times? Multiply the serial form out.")
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p * factor, T_i, T_d)}


@heat_exchanger.mistake(
    "Gain and integral time are converted. For the derivative time, compare the terms with $s$: $K_p T_d$ is the same "
    "in both forms."
)
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p * factor, T_i * factor, T_d * factor)}


@heat_exchanger.mistake("Gain and integral time are converted. What about the derivative time?")
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p * factor, T_i * factor, T_d)}


@heat_exchanger.mistake("The factor of the conversion is upside down: which of the two times is divided by the other?")
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p * (1 + T_i / T_d), T_i * factor, T_d / factor)}


@heat_exchanger.mistake("The conversion goes the other way round: is the gain of the parallel form larger or smaller?")
def _(K, T_1, T_2, delay):
    K_p, T_i, T_d, factor = _serial(K, T_1, T_2, delay)
    return {"pid": PID(K_p / factor, T_i / factor, T_d * factor)}


@heat_exchanger.mistake(
    "The two time constants are interchanged: which of them does the derivative term cancel, the larger or the "
    "smaller? And these settings are still those of the serial form."
)
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_2 / (K * 2 * delay), Min(T_2, 4 * delay), T_1)}


@heat_exchanger.mistake(
    "The integral time is $T_1$ here. Compare it with the other limit, $c\\,(T_C + \\tau)$; and these settings are "
    "still those of the serial form."
)
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), T_1, T_2)}


@heat_exchanger.mistake("The limit of the integral time contains $T_C$, too, and not only the dead time.")
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * 2 * delay), 2 * delay, T_2, form="serial").parallel()}


@heat_exchanger.mistake("$T_C$ is missing, in the gain and in the limit of the integral time.")
def _(K, T_1, T_2, delay):
    return {"pid": PID(T_1 / (K * delay), 2 * delay, T_2, form="serial").parallel()}


@heat_exchanger.mistake(
    "Here half of the second lag was counted as dead time, as one does for a PI controller. What can a PID controller "
    "do with this lag?"
)
def _(K, T_1, T_2, delay):
    late = delay + T_2 / 2
    return {"pid": PID((T_1 + T_2 / 2) / (K * 2 * late), Min(T_1 + T_2 / 2, 4 * late))}


heat_exchanger.hints(
    "Two lags and a dead time are a row of Skogestad's table. For which form of the controller is that table?",
    "Serial first: $K_p = \\frac{{T_1}}{K(T_C + \\tau)}$, $T_i = \\min(T_1,\\ c\\,(T_C + \\tau))$ and $T_d = T_2$. "
    "Then convert: a parallel controller has the gain of the serial one times $1 + T_d/T_i$.",
    "The serial gain is $\\frac{ {T_1} }{ {K} \\cdot 2 \\cdot {delay} }$, and $1 + T_d/T_i$ is the factor of the gain "
    "and of the integral time; the derivative time is divided by it.",
)


@heat_exchanger.solution
def _(K, T_1, T_2, delay):
    r"""Skogestad's table is for the serial form. With $T_C = \tau$ the gain is
    $K_{ps} = \frac{{T_1}}{K \cdot 2\tau} = \frac{ {T_1} }{ {K} \cdot 2 \cdot {delay} }$, which is {K_ps}.

    The integral time is the smaller one of $T_1$ = {T_1} and $c\,(T_C + \tau) = 2 \cdot 2 \cdot {delay}$, so
    $T_{is}$ = {T_is}. The derivative term cancels the smaller time constant, $T_{ds} = T_2$ = {T_2}.

    Multiplied out, the serial controller is
    $K_{ps}\left(1 + \frac{T_{ds} }{T_{is} } + \frac{1}{T_{is} s} + T_{ds} s\right)$. A parallel one must have the same
    three coefficients. So its gain and its integral time are larger by $1 + {T_2}/{T_is} = {factor}$, and its
    derivative time is smaller by the same factor: $K_p$ = {K_pp}, $T_i$ = {T_ip}, $T_d$ = {T_dp}.
    """
    K_ps, T_is = T_1 / (K * 2 * delay), min(T_1, 4 * delay)
    factor = 1 + T_2 / T_is
    return {"K_ps": (K_ps, "%/K"), "T_is": (T_is, "s"), "factor": factor} | {
        "K_pp": (K_ps * factor, "%/K"), "T_ip": (T_is * factor, "s"), "T_dp": (T_2 / factor, "s")
    }  # fmt: skip


@heat_exchanger.solution_picture
def _(K, T_1, T_2, delay):
    """The response to a setpoint step with the converted settings, and with the serial numbers typed as they are."""
    from loopbook.deadtime import Loop

    serial = PID(T_1 / (K * 2 * delay), Min(T_1, 4 * delay), T_2, form="serial")
    ways = {"converted": serial.parallel(), "typed as they are": PID(serial.Kp, serial.Ti, serial.Td)}
    process = K * exp(-delay * s) / ((T_1 * s + 1) * (T_2 * s + 1))
    times = np.linspace(0, 30 * float(delay), 301)
    curves = {name: Loop(process, pid).servo.step(times) for name, pid in ways.items()}
    return time_plot({"setpoint": (1, "setpoint")} | curves, times, ylabel="temperature [K]")


_T, _T_C, _tau = symbols("T T_C tau", positive=True)


@exercise(
    "10.4",
    title="How short may the integral time be?",
    points=4,
    insight="A lag has some damping of its own, so its integral time may be shorter than that of an integrator.",
)
def integral_time(
    zeta=between(0.5, 1, step=0.05, reference=1),
    n=choice(3, 4, 5, 6, 8, 9, 10, 12, 15, reference=9),
):
    r"""For an integrator, the shortest integral time that does not make the loop oscillate slowly was found to be
    $4(T_C + \tau)$. What is it for a lag? The process is $\frac{K\,e^{-\tau s}}{Ts + 1}$, and the PI controller
    has Skogestad's gain $K_p = \frac{{T}}{K(T_C + \tau)}$ and an integral time $T_i$ that is still to be chosen.

    The dead time hardly matters for slow motions, so neglect it: use the process without $e^{-\tau s}$. Which $T_i$
    gives the two poles of the loop the damping $\zeta = {zeta}$? Put this number in for $\zeta$, and give $T_i$ in the
    symbols $T$, $T_C$ and $\tau$ (type `T`, `T_C`, `tau`). Now let $T$ be {n} times as long as $T_C + \tau$: how many
    times as long as $T_C + \tau$ is the integral time?
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


@integral_time.mistake("Which of the two terms with $T$ is larger? The lag's own damping makes the time shorter.")
def _(zeta, n):
    total = _T_C + _tau
    return {"Ti": 4 * zeta**2 * total * (_T + total) ** 2 / _T**2, "factor": 4 * zeta**2 * (n + 1) ** 2 / n**2}


@integral_time.mistake(
    "The damping is in the coefficient of $s$. What happens to it when the coefficients are compared?"
)
def _(zeta, n):
    if zeta != 1:
        total = _T_C + _tau
        return {"Ti": 4 * zeta * total * _T**2 / (_T + total) ** 2, "factor": 4 * zeta * n**2 / (n + 1) ** 2}


@integral_time.mistake("The middle term is squared on the way. What becomes of the fraction with $T$ in it?")
def _(zeta, n):
    total = _T_C + _tau
    return {"Ti": 4 * zeta**2 * total * _T / (_T + total), "factor": 4 * zeta**2 * n / (n + 1)}


@integral_time.mistake("That holds for a damping of one. Which damping is asked for?")
def _(zeta, n):
    if zeta != 1:
        total = _T_C + _tau
        return {"Ti": 4 * total * _T**2 / (_T + total) ** 2, "factor": 4 * n**2 / (n + 1) ** 2}


@integral_time.mistake("That integral time cancels the lag. Here the damping of the two poles decides on it.")
def _(zeta, n):
    return {"Ti": _T} | ({} if abs(4 * zeta**2 / n - 1) < 0.05 else {"factor": n})


@integral_time.mistake("The lag's own damping adds to the damping by the controller. Look at the sign.")
def _(zeta, n):
    total = _T_C + _tau
    return {"Ti": 4 * zeta**2 * total * _T**2 / (_T - total) ** 2, "factor": 4 * zeta**2 * n**2 / (n - 1) ** 2}


@integral_time.mistake("That is the integral time as a multiple of $T$. It is to be compared with $T_C + \\tau$.")
def _(zeta, n):
    return {"factor": 4 * zeta**2 * n / (n + 1) ** 2} if n != 4 else {}


integral_time.hints(
    "The damping is a matter of the two poles, and these are the roots of the closed loop's polynomial. Write that "
    "first.",
    "Without the dead time, $1 + \\frac{K_p (T_i s + 1)}{T_i s} \\cdot \\frac{K}{Ts + 1} = 0$. Multiply by the "
    "denominators, and compare with $s^2/\\omega^2 + 2\\zeta s/\\omega + 1$.",
    "With $K K_p = \\frac{{T}}{T_C + \\tau}$ the polynomial becomes $(T_C + \\tau)\\,T_i\\,s^2 + \\frac{T + T_C + "
    "\\tau}{{T}}\\,T_i\\,s + 1$. From it, $\\omega$ and $\\zeta$ can be read.",
)


@integral_time.solution
def _(zeta, n):
    r"""The closed loop without the dead time has the polynomial $T_i s\,(Ts + 1) + K K_p\,(T_i s + 1)$. With
    $K K_p = \frac{{T}}{T_C + \tau}$, and divided by this, it is

    $$(T_C + \tau)\,T_i\,s^2 + \left(1 + \frac{T_C + \tau}{{T}}\right) T_i\,s + 1.$$

    Compare with $s^2/\omega^2 + 2\zeta s/\omega + 1$. The first term says $1/\omega^2 = (T_C + \tau)\,T_i$. The second
    one says $2\zeta/\omega = \frac{T + T_C + \tau}{{T}}\,T_i$. Square it, put $1/\omega^2$ in, and cancel one $T_i$:

    $$T_i = \frac{4\zeta^2\,(T_C + \tau)\,T^2}{(T + T_C + \tau)^2} \quad\text{with}\quad 4\zeta^2 = {four}.$$

    With $T = {n}\,(T_C + \tau)$ the integral time is $4\zeta^2 \frac{ {n}^2 }{({n} + 1)^2 }$ times $T_C + \tau$, which
    is {factor} times. An integrator is the limit of a long time constant: there it would be {four} times.
    """
    return {"four": 4 * zeta**2}


@exercise(
    "10.5",
    title="What the relay has found",
    points=3,
    where=lambda low, high, a: 10 <= high - low <= 30 * a,
    insight="A relay finds the limit of stability without going there: its height bounds the oscillation.",
)
def relay(
    low=between(20, 45, "%", step=5, reference=35),
    high=between(40, 70, "%", step=5, reference=55),
    middle=between(50, 90, "°C", step=5, reference=70),
    a=between(0.4, 3, "K", step=0.2, reference=1.6),
    period=between(4, 16, "min", step=1, reference=8),
):
    r"""For an autotuner, a relay switches the steam valve of a pasteuriser between {low} and {high}. Soon the
    temperature oscillates steadily between {coldest} and {hottest}, with a period of {period}.

    Estimate the ultimate gain, and find the PID settings of Ziegler and Nichols
    ($K_p = 0.6 K_u$, $T_i = P_u/2$, $T_d = P_u/8$).
    """
    K_u = 2 * (high - low) / (pi * a)
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
    "The amplitude counts from the middle of the oscillation; the distance of the extremes is twice the amplitude."
)
def _(low, high, a):
    return _relay_gains((high - low) / (pi * a))


@relay.mistake("The height of the relay counts from the middle of its two positions, and not from one to the other.")
def _(low, high, a):
    return _relay_gains(4 * (high - low) / (pi * a))


@relay.mistake("That is height over amplitude. The sinusoid in a square wave is larger than the square wave itself.")
def _(low, high, a):
    return _relay_gains((high - low) / 2 / a)


@relay.mistake("Is the sinusoid in a square wave larger or smaller than the wave? Look at the factor with $\\pi$.")
def _(low, high, a):
    return _relay_gains(pi * (high - low) / (8 * a))


@relay.mistake("A factor is missing: a square wave of height $d$ contains a sinusoid larger than $d$.")
def _(low, high, a):
    return _relay_gains((high - low) / (2 * pi * a))


@relay.mistake("A gain of a controller is control signal over temperature. Which amplitude is which?")
def _(low, high, a):
    return _relay_gains(8 * a / (pi * (high - low)))


@relay.mistake("Amplitudes count from the middle of the oscillation, and not from zero: both of them.")
def _(low, high, middle, a):
    K_u, right = 4 * high / (pi * (middle + a)), 2 * (high - low) / (pi * a)
    return _relay_gains(K_u) if abs(K_u / right - 1) > 0.05 else {}


@relay.mistake("That is the factor of a P controller. Look at the formulas of the statement: which controller is it?")
def _(low, high, a):
    return {"Kp": (high - low) / (pi * a)}


@relay.mistake("That belongs to a PI controller. Look at the formulas of the statement: which controller is it?")
def _(low, high, a, period):
    return {"Kp": Rational(9, 10) * (high - low) / (pi * a), "Ti": period / Rational(12, 10), "Td": 0}


@relay.mistake("From one switching of the relay to the next it is half a period only.")
def _(period):
    return {"Ti": period / 4}


@relay.mistake("An eighth of which time? The formula divides a whole period, from top to top.")
def _(period):
    return {"Td": period / 16}


@relay.mistake("At the ultimate gain the loop would oscillate forever. Which share of it does the controller get?")
def _(low, high, a):
    return {"Kp": 2 * (high - low) / (pi * a)}


relay.hints(
    "In the steady oscillation the relay acts like a gain: the one that keeps an oscillation going forever. Which two "
    "amplitudes does that gain relate?",
    "The estimate is $K_u = \\frac{4d}{\\pi a}$, with the amplitude $d$ of the relay and the amplitude $a$ of the "
    "temperature, both counted from the middle.",
    "$d = \\frac{ {high} - {low} }{2}$ in percent, and $a$ is half of the distance between {coldest} and {hottest}. "
    "The period of the oscillation is $P_u$.",
)


@relay.solution
def _(low, high):
    r"""Around its middle the relay switches by $d = \frac{ {high} - {low} }{2}$, which is {d}. Around its own middle
    the temperature oscillates by half of the distance from {coldest} to {hottest}, $a$ = {a}.

    The sinusoid that a square wave contains is larger than the square wave by the factor $4/\pi$. For this sinusoid the
    relay is the gain that keeps the oscillation up, and so
    $K_u = \frac{4d}{\pi a} = \frac{4 \cdot {d} }{\pi \cdot {a} }$, which is {Ku}.

    The period is read off: $P_u$ = {period}. The settings follow: $K_p = 0.6\,K_u$ is {Kp}, $T_i = P_u/2$ is {Ti}, and
    $T_d = P_u/8$ is {Td}.
    """
    return {"d": ((high - low) / 2, "%")}


@relay.picture
def _(low, high, middle, a, period):
    """Two and a half periods of the experiment: the temperature, and the relay that switches the valve."""
    times = np.linspace(0, 2.5 * float(period), 1001)
    wave = np.sin(2 * pi * times / float(period))
    upper = {"temperature [°C]": (float(middle) - float(a) * wave, "measurement")}
    lower = {"valve [%]": (np.where(wave >= 0, float(high), float(low)), "control signal")}
    return time_plot([upper, lower], times, xlabel="$t$ [min]")


@exercise(
    "10.6",
    title="Another flow through the tank",
    points=3,
    where=lambda w_1, w_2: 5 * min(w_1, w_2) <= 4 * max(w_1, w_2) and 3 * w_1 <= 5 * w_2,
    insight="Less flow is the dangerous direction: gain and dead time of the process grow together.",
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


@another_flow.mistake("Count once more: how often is $1/w$ above the fraction line of $K_p$, and how often below it?")
def _(K_p, w_1, w_2):
    return {"Kp": K_p * w_1**2 / w_2**2}


@another_flow.mistake("The integral time is the time constant alone. How often is the flow in it?")
def _(T_i, w_1, w_2):
    return {"Ti": T_i * w_1**2 / w_2**2}


another_flow.hints(
    "Skogestad's rule says how its settings depend on gain, time constant and dead time. How does each of these three "
    "depend on the flow?",
    "With $T_C = \\tau$: $K_p = \\frac{{T}}{2 K \\tau}$ and $T_i = T$. Put $T$, $\\tau$ and $K$ in as constants "
    "divided by $w$, and see what is left of $w$.",
    "$T$ and $\\tau$ cancel each other in $K_p$, so that it is proportional to $1/K$. All three parameters of the "
    "process change by the factor ${w_1}/{w_2}$.",
)


@another_flow.solution
def _(w_1, w_2):
    r"""All three parameters of the process are proportional to $1/w$. With the new flow they change by the factor
    ${w_1}/{w_2} = {ratio}$: each of them becomes {grows}.

    In $K_p = \frac{{T}}{2 K \tau}$ the factors of $T$ and $\tau$ cancel, that of $K$ remains in the denominator. So the
    gain becomes $K_p = {K_p} \cdot {w_2}/{w_1}$, which is {Kp}. The integral time is the time constant,
    $T_i = {T_i} \cdot {w_1}/{w_2}$, which is {Ti}.

    **With the old settings** the gain of the loop is {ratio} times what it was, and the dead time, too, has become
    {grows}. The loop is therefore {unchanged}.
    """
    return {"ratio": w_1 / w_2, "grows": "larger" if w_2 < w_1 else "smaller"}


@another_flow.solution_picture
def _(K_p, T_i, w_1, w_2):
    """Setpoint steps: at the first flow, and at the new flow with the old and with the new settings."""
    from loopbook.deadtime import Loop

    def step(flow, pid):
        stretch, T = w_1 / flow, T_i  # a dead time of a quarter of the time constant
        process = 2 / K_p * stretch * exp(-T / 4 * stretch * s) / (T * stretch * s + 1)
        return Loop(process, pid).servo.step(times)

    times, old, new = np.linspace(0, 8 * float(T_i), 301), PID(K_p, T_i), PID(K_p * w_2 / w_1, T_i * w_1 / w_2)
    curves = {"first flow": step(w_1, old), "new flow, old settings": step(w_2, old)}
    curves |= {"new flow, new settings": step(w_2, new), "setpoint": (1, "setpoint")}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]")


@exercise(
    "10.7",
    title="Between two and four",
    points=5,
    insight="Quick recovery from loads is paid for with overshoot after setpoint steps; the factor $c$ sets the price.",
)
def between_two_and_four(
    K=between(0.02, 0.1, "%/min", step=0.01, reference=0.05),
    delay=between(2, 8, "min", step=1, reference=4),
):
    r"""The level of a surge drum responds to the feed valve like an integrator with dead time: when the valve has
    opened by 1 %, nothing happens for {delay}; then the level rises by {K}, and goes on rising. Level and valve opening
    are both in percent of their ranges, so that the gain of the controller has no unit.

    Find a PI controller that meets both demands:

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
            draws=lambda pid: _surge(K, delay, pid),
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


def _surge(K, delay, pid):
    """The level after a setpoint step of 1 % and, later, a load step of 1 %, beside the highest level allowed."""
    from loopbook.deadtime import Loop

    load_at = 25 * delay
    times = np.linspace(0, 50 * float(delay), 401)
    run = Loop(K * exp(-delay * s) / s, pid).run(times, setpoint=1, load=stepwise(0, {load_at: 1}))
    curves = {"setpoint": (1, "setpoint"), "level": (run["y"], "measurement")}
    plot = time_plot(curves, times, xlabel="$t$ [min]", ylabel="level [%]", ylim=(-0.5, 2.5))
    return plot.level(1.4, "highest after the setpoint step", "level").event(load_at, "load of 1 %")


@between_two_and_four.shows
def _(K, delay):
    return {"limit": f"{_limit(K, delay):g}\N{NO-BREAK SPACE}% min"}


@between_two_and_four.picture
def _(K, delay):
    """What the level does after the valve has opened by 1 % at time zero: a dead time, and then a ramp."""
    times = np.linspace(0, 5 * float(delay), 201)
    rise = float(K) * np.maximum(times - float(delay), 0)
    return time_plot({"rise of the level [%]": (rise, "measurement")}, times, xlabel="$t$ [min]", low=True)


@between_two_and_four.mistake(
    "With $c = 4$ the overshoot is small enough, but the loop recovers too slowly from the load."
)
def _(K, delay):
    return {"pid": PID(1 / (2 * K * delay), 8 * delay)}


@between_two_and_four.mistake("With $c = 2$ the loop recovers quickly, but it overshoots by nearly half of the step.")
def _(K, delay):
    return {"pid": PID(1 / (2 * K * delay), 4 * delay)}


@between_two_and_four.mistake(
    "The gain is that for $T_C = 0$. An integrator with dead time takes $T_C + \\tau$ in the denominator; what is "
    "$T_C$?"
)
def _(K, delay):
    return {"pid": PID(1 / (K * delay), 6 * delay)}


@between_two_and_four.mistake(
    "The gain is that for $T_C = 0$. An integrator with dead time takes $T_C + \\tau$ in the denominator; what is "
    "$T_C$?"
)
def _(K, delay):
    return {"pid": PID(1 / (K * delay), 8 * delay)}


@between_two_and_four.mistake("The gain is upside down: the quicker the process rises, the less the controller may do.")
def _(K, delay):
    return {"pid": PID(2 * K * delay, 6 * delay)} if K * delay < 0.4 else {}


@between_two_and_four.mistake("The gain is upside down: the quicker the process rises, the less the controller may do.")
def _(K, delay):
    return {"pid": PID(2 * K * delay, 8 * delay)} if K * delay < 0.4 else {}


@between_two_and_four.mistake("The gain is that of a dead time of one minute. How long is it here?")
def _(K, delay):
    return {"pid": PID(1 / (2 * K), 6 * delay)}


@between_two_and_four.mistake("$T_C + \\tau$ is in the integral time, too: here it is the factor times $\\tau$ alone.")
def _(K, delay):
    return {"pid": PID(1 / (2 * K * delay), 3 * delay)}


between_two_and_four.hints(
    "Start from Skogestad's rule for an integrator with dead time. Which of the two demands does its factor $c$ serve "
    "when it is small, and which one when it is large?",
    "With $T_C = \\tau$: $K_p = \\frac{1}{2 K \\tau}$ and $T_i = 2c\\,\\tau$. The integral of the error is then "
    "$T_i/K_p = 4 c\\,K \\tau^2$.",
    "$K_p = \\frac{1}{2 \\cdot {K} \\cdot {delay} }$. The limit of {limit} says how large $c$ may be at most. The "
    "overshoot is 28 % with $c = 4$ and 49 % with $c = 2$, so look between the two.",
)


@between_two_and_four.solution
def _(K, delay):
    r"""Skogestad's settings with $T_C = \tau$ are $K_p = \frac{1}{2K\tau}$ and $T_i = 2c\,\tau$, so that the integral
    of the error is $T_i/K_p = 4c\,K\tau^2 = {each}\,c$, in % min.

    At most {limit} are allowed, which $c \le {largest}$ achieves. The overshoot depends on $c$ alone: it is 49 % of the
    step for $c = 2$, {overshoot} % for $c = 3$ and 28 % for $c = 4$. So $c = 3$ meets both demands:

    $K_p = \frac{1}{2 \cdot {K} \cdot {delay} }$, which is {K_p}, and $T_i = 6 \cdot {delay}$, which is {T_i}. The
    integral is {area} then.

    Other settings do it, too, such as a larger $T_C$ with a smaller $c$.
    """
    K_p, T_i = 1 / (2 * K * delay), 6 * delay
    shares = {"each": 4 * K * delay**2, "largest": _limit(K, delay) / (4 * K * delay**2)}
    overshoot = round(_overshoot(Rational(1, 2), Rational(6)))
    return shares | {"overshoot": overshoot, "K_p": K_p, "T_i": (T_i, "min"), "area": (T_i / K_p, "% min")}


@exercise(
    "10.8",
    title="A model from a record",
    points=3,
    where=lambda T, delay, start: (
        Rational(1, 5) * T <= delay <= Rational(3, 5) * T
        and abs(start - delay) >= Rational(3, 10) * delay  # the clock's time of the step is no dead time
    ),
    insight="A fit uses every sample: noise that spoils a reading by ruler hardly moves its result.",
)
def from_a_record(
    K=between(0.5, 2.5, "K/%", step=0.1, reference=1.2),
    T=between(40, 150, "s", step=10, reference=90),
    delay=between(10, 60, "s", step=5, reference=30),
    u_0=between(30, 60, "%", step=5, reference=40),
    step=choice(8, 10, 12, -8, -10, -12, unit="%", reference=10),
    y_0=between(45, 80, "°C", step=1, reference=62),
    start=between(30, 90, "s", step=10, reference=60),
    noise=between(1, 999, step=1, reference=7),
):
    """A plate heat exchanger was in manual mode when somebody moved its steam valve. The controller has recorded it
    every 5 s, with the noise of the thermometer. `t, u, y = exercise("10.8").given("t", "u", "y")` are the record: the
    times in seconds, the valve opening in percent and the temperature in °C, each as an array.

    Fit a lag with dead time to the record, by any method: give its gain, its time constant and its dead time. (With a
    ruler on the picture you come near; the arrays are for those who want to use all of the samples.)
    """
    return answers(
        K=number(K, "K/%", "the gain of the process", within=0.04),
        T=number(T, "s", "the time constant", within=0.1),
        tau=number(delay, "s", "the dead time", within=0.15),
    )


@from_a_record.shows
def _(K, T, delay, u_0, step, y_0, start, noise):
    t = np.arange(0, float(start + delay + 8 * T), 5.0)
    u = np.where(t < float(start), float(u_0), float(u_0 + step))
    since = np.maximum(t - float(start + delay), 0)
    rise = float(K * step) * -np.expm1(-since / float(T))
    dice = np.random.default_rng(int(noise))
    return {"t": t, "u": u, "y": (float(y_0) + rise + 0.015 * abs(float(K * step)) * dice.normal(size=t.size)).round(2)}


@from_a_record.mistake("That is temperature over opening. The gain compares their changes: from where to where?")
def _(K, u_0, step, y_0):
    quotient = (y_0 + K * step) / (u_0 + step)
    return {"K": quotient} if abs(quotient - K) > 0.15 * K else {}


@from_a_record.mistake(
    "That is the whole change of the temperature. How much of it does one percent of the valve make?"
)
def _(K, step):
    return {"K": K * step}


@from_a_record.mistake(
    "That is the size of the whole change. How much of it, and with which sign, does one percent of the valve make?"
)
def _(K, step):
    return {"K": -K * step}


@from_a_record.mistake("By then 63 % of the change are reached, but a part of that time nothing has moved yet.")
def _(T, delay):
    return {"T": T + delay}


@from_a_record.mistake("The record does not begin with the step. When did the valve move?")
def _(start, delay):
    return {"tau": start + delay}


@from_a_record.mistake("A lag has covered 95 % after three time constants. Which share belongs to one of them?")
def _(T):
    return {"T": 3 * T}


@from_a_record.mistake("That is a time of the record. The time constant counts from the end of the dead time.")
def _(T, delay, start):
    return {"T": start + delay + T}


@from_a_record.mistake("Then half of the change is reached. How much of it is reached after one time constant?")
def _(T):
    return {"T": T * log(2)}


@from_a_record.mistake("By then the response has practically ended. How much of it is behind it after one $T$?")
def _(T):
    return {"T": 4 * T}


@from_a_record.mistake("By then the response has practically ended. How much of it is behind it after one $T$?")
def _(T):
    return {"T": 5 * T}


@from_a_record.mistake("Then the valve has moved. How long does the temperature wait after that?")
def _(start):
    return {"tau": start}


@from_a_record.mistake("That is temperature over opening, before the step. The gain compares changes.")
def _(K, u_0, y_0):
    return {"K": y_0 / u_0} if abs(y_0 / u_0 - K) > 0.08 * K else {}


@from_a_record.mistake("Then 63 % of the change are reached. When does the temperature begin to move?")
def _(T, delay, start):
    return {"tau": T + delay} if abs(T - start) > 0.3 * (delay + start) else {}


@from_a_record.mistake("Does the temperature move at once when the valve does? Look closely at the record.")
def _():
    return {"tau": 0}


from_a_record.hints(
    "A gain is a change divided by a change. For the two times, ask how much of the change is reached when.",
    "With averages before the step and at the end: $K = \\frac{y_{end} - y_0}{u_{end} - u_0}$. Then fit "
    "$y = y_0 + K\\,\\Delta u\\,(1 - e^{-(t - t_0 - \\tau)/T})$ to the samples, with $t_0$ the time of the step.",
    "The valve moves by {step} at $t_0$ = {start}. `identification.fit(t, u, y)` of the library finds the three "
    "parameters, or `scipy.optimize.curve_fit`, or you minimise the sum of squares over $T$ and $\\tau$ on a grid.",
)


def _by_areas(t, u, y):
    """Averages before the step and at the end, gain, T + tau, T and tau of a record with one step."""
    k = int(np.argmax(u != u[0]))
    low, high = y[:k].mean(), y[-len(y) // 6 :].mean()
    since, share = t[k:] - t[k], (y[k:] - low) / (high - low)
    mean = np.trapezoid(1 - share, since)
    until = np.linspace(0, mean, 1001)
    T = np.e * np.trapezoid(np.interp(until, since, share), until)
    return low, high, (high - low) / (u[-1] - u[0]), mean, T, mean - T


@from_a_record.solution
def _(K, T, delay, u_0, step, y_0, start, noise):
    r"""**The gain.** Averages take the noise out: {low} before the step, {high} in the last sixth of the record. The
    valve has moved by {step}, so $K = \frac{ {high} - {low} }{ {step} }$, which is {gain}.

    **The two times.** Two areas are as good as a fit and need only sums. Let $x$ be the share of the change that is
    reached, from 0 to 1. The area between $x$ and 1, from the step to the end, is $T + \tau$: it is {mean}. The area
    below $x$ from the step up to that moment is $T/e$, since a lag with dead time has made $1 - 1/e$ of its change
    there. With the samples it gives $T$ = {time}, and what is left is $\tau$ = {late}.

    **All samples at once.** The least sum of squared errors, by `identification.fit(t, u, y)`, is at $K$ = {K_fit},
    $T$ = {T_fit} and $\tau$ = {tau_fit}. The record was made with {K}, {T} and {tau}.
    """
    from loopbook.identification import fit

    record = _record(K=K, T=T, delay=delay, u_0=u_0, step=step, y_0=y_0, start=start, noise=noise)
    low, high, gain, mean, time, late = _by_areas(*record)
    found = fit(*record).parameters
    return {
        "low": (low, "°C"), "high": (high, "°C"), "gain": (gain, "K/%"),
        "mean": (mean, "s"), "time": (time, "s"), "late": (late, "s"),
        "K_fit": (found["K"], "K/%"), "T_fit": (found["T1"], "s"), "tau_fit": (found["delay"], "s"),
    }  # fmt: skip


def _record(**values):
    return tuple(from_a_record.shown(**values).values())


@from_a_record.picture
def _(K, T, delay, u_0, step, y_0, start, noise):
    """The record: the temperature with its noise, and the step of the valve."""
    t, u, y = _record(K=K, T=T, delay=delay, u_0=u_0, step=step, y_0=y_0, start=start, noise=noise)
    return time_plot([{"temperature [°C]": (y, "measurement")}, {"valve [%]": (u, "control signal")}], t)


@from_a_record.solution_picture
def _(K, T, delay, u_0, step, y_0, start, noise):
    """The record, and the response of the model through it."""
    t, _, y = _record(K=K, T=T, delay=delay, u_0=u_0, step=step, y_0=y_0, start=start, noise=noise)
    model = float(y_0) + float(K * step) * -np.expm1(-np.maximum(t - float(start + delay), 0) / float(T))
    return time_plot({"measured": (y, "raw"), "model": (model, "model")}, t, ylabel="temperature [°C]")


@exercise(
    "10.9",
    title="Four gains in one record",
    points=3,
    insight="A steady oscillation is the limit of stability only if the control signal stays within its limits.",
)
def four_gains(
    K_u=between(2, 9, "%/K", step=0.5, reference=4),
    P_u=between(20, 90, "s", step=5, reference=40),
    place=choice(2, 3, reference=2),
):
    """The temperature of a wash bath is under P control. The operator tries four gains, {tried}, and moves the setpoint
    a little each time. The picture shows the record. The valve cannot do more than open and close.

    Read the ultimate gain and the ultimate period off the record, and give the settings of Ziegler and Nichols for a
    **PI** controller ($K_p = 0.45\\,K_u$, $T_i = P_u/1.2$).
    """
    return answers(
        Ku=number(K_u, "%/K", "the ultimate gain"),
        Pu=number(P_u, "s", "the ultimate period", within=0.06),
        Kp=number(Rational(45, 100) * K_u, "%/K", "the proportional gain"),
        Ti=number(P_u / Rational(12, 10), "s", "the integral time", within=0.06),
    )


#: The four gains in units of the ultimate one, which is the second or the third of them.
_TRIED = {2: (0.6, 1, 1.4, 1.8), 3: (0.5, 0.75, 1, 1.5)}


def _gains(K_u, place):
    return [round(share * float(K_u), 2) for share in _TRIED[int(place)]]


@four_gains.mistake("There the oscillation dies out, however slowly. At the limit it lasts.")
def _(K_u, place):
    before = _gains(K_u, place)[int(place) - 2]
    return {"Ku": before, "Kp": 0.45 * before}


@four_gains.mistake("That oscillation lasts, too. But what does the valve do in it, and would it last without that?")
def _(K_u, place):
    after = _gains(K_u, place)[int(place)]
    return {"Ku": after, "Kp": 0.45 * after}


@four_gains.mistake("From one crossing of the middle to the next is not a whole period yet.")
def _(P_u):
    return {"Pu": P_u / 2, "Ti": P_u / Rational(24, 10)}


@four_gains.mistake("Those are the factors for a P or a PID controller. Look at the formulas of the statement.")
def _(K_u, P_u):
    return {"Kp": Rational(6, 10) * K_u, "Ti": P_u / 2}


@four_gains.mistake("With half of the ultimate gain a P controller is tuned. The integral term costs some more.")
def _(K_u):
    return {"Kp": K_u / 2}


@four_gains.mistake("Count the periods, not the tops: how many periods lie between the first and the last of them?")
def _(P_u):
    return {"Pu": Rational(8, 10) * P_u, "Ti": Rational(8, 12) * P_u}


@four_gains.mistake("Count the periods, not the tops: how many periods lie between the first and the last of them?")
def _(P_u):
    return {"Pu": Rational(3, 4) * P_u}


@four_gains.mistake("That is an angular frequency. The period is the time from one top to the next.")
def _(P_u):
    return {"Pu": 2 * pi / float(P_u), "Ti": 2 * pi / float(P_u) / 1.2}


@four_gains.mistake("This is between two gains of the record. Where exactly does the oscillation last by itself?")
def _(K_u, place):
    mean = (_gains(K_u, place)[int(place) - 2] + K_u) / 2
    return {"Ku": mean, "Kp": Rational(45, 100) * mean}


@four_gains.mistake("At the ultimate gain the loop oscillates forever. Which share of it does a PI controller get?")
def _(K_u):
    return {"Kp": K_u}


@four_gains.mistake("Is the integral time longer or shorter than the period? Look at the formula once more.")
def _(P_u):
    return {"Ti": Rational(12, 10) * P_u}


@four_gains.mistake("That is the period itself. What does the formula do with it?")
def _(P_u):
    return {"Ti": P_u}


@four_gains.mistake("That is several periods together. How many of them lie between those tops?")
def _(P_u):
    return {"Pu": 2 * P_u, "Ti": 2 * P_u / Rational(12, 10)}


@four_gains.mistake("That is several periods together. How many of them lie between those tops?")
def _(P_u):
    return {"Pu": 3 * P_u, "Ti": 3 * P_u / Rational(12, 10)}


@four_gains.mistake("That is several periods together. How many of them lie between those tops?")
def _(P_u):
    return {"Pu": 4 * P_u}


@four_gains.mistake("That is several periods together. How many of them lie between those tops?")
def _(P_u):
    return {"Pu": 5 * P_u}


@four_gains.mistake("An eighth of the period is a derivative time. Which setting is asked for?")
def _(P_u):
    return {"Ti": P_u / 8}


four_gains.hints(
    "At the ultimate gain an oscillation neither grows nor dies out, on its own. What else can keep it from growing?",
    "For each gain, look at the valve as well: where it runs between fully open and closed, the oscillation would grow "
    "if it could. Then count several periods at the right gain and divide their time by their number.",
    "The first gain of the record, {first}, is too small: its oscillation dies out. Is it steady with the next one, "
    "and does the valve stay off its limits there?",
)


@four_gains.shows
def _(K_u, place):
    first, *middle, last = (f"{gain:g}" for gain in _gains(K_u, place))
    unit = "\N{NO-BREAK SPACE}%/K"
    return {"first": first + unit, "tried": f"first {first}, then {', '.join(middle)} and at last {last}{unit}"}


@four_gains.solution
def _(K_u, P_u, place):
    r"""With {smaller} the oscillation dies out. With {Ku} it goes on with the same amplitude, and the valve
    stays between its limits: this is the ultimate gain, $K_u$ = {Ku}. With {larger} the valve runs from open to closed
    and back. That oscillation is steady, too, but only because the valve can do no more: otherwise it would grow.

    **The period.** Between the first and the fifth top at that gain lie four periods, {four} together, so $P_u$ = {Pu}.
    Reading over several periods divides the error of the ruler by their number.

    **The settings.** $K_p = 0.45 \cdot {Ku}$, which is {Kp}, and $T_i = {Pu}/1.2$, which is {Ti}.
    """
    gains = [f"{gain:g}\N{NO-BREAK SPACE}%/K" for gain in _gains(K_u, place)]
    before, after = gains[: int(place) - 1], gains[int(place) :]
    return {"smaller": " and with ".join(before), "larger": " and with ".join(after), "four": (4 * P_u, "s")}


@lru_cache
def _bath(place):
    """The record with a period and an ultimate gain of one: times, setpoint, temperature, and valve in percent."""
    w, late, each = 1.7582, 55, 5.5  # w + atan(3 w) is pi: a time constant of three dead times
    delay = w / (2 * pi)
    h, T, K = delay / (late + 1 / 2), 3 * delay, sqrt(1 + 9 * w**2)  # what is held for h is late by h/2
    times = np.arange(0, 4 * each, h)
    setpoint = np.where((times // each) % 2 == 0, 25.0, 0.0)
    gain = np.array(_TRIED[place])[(times // each).astype(int)]
    u, y, decay, x = np.zeros(times.size + late), np.zeros(times.size), np.exp(-h / T), 0.0
    for k in range(times.size):
        y[k] = x
        u[k + late] = np.clip(gain[k] * (setpoint[k] - x), -50, 50)
        x = decay * x + (1 - decay) * K * u[k]
    return times, setpoint, y, 50 + u[late:]


@four_gains.picture
def _(K_u, P_u, place):
    """The record: the temperature with its setpoint, and the valve, with four gains one after the other."""
    times, setpoint, y, u = _bath(int(place))
    curves = {"setpoint": (60 + setpoint / float(K_u), "setpoint"), "temperature": (60 + y / float(K_u), "measurement")}
    panels = [curves, {"valve [%]": (u, "control signal")}]
    return time_plot(panels, times * float(P_u), ylabel=["temperature [°C]", "valve [%]"], ylim=[None, (-5, 105)])


FAULTS = {
    "gain too high": (2.4, 1),
    "gain too low": (0.22, 1),
    "integral time too short": (1, 0.3),
    "integral time too long": (1, 8),
}


@exercise(
    "10.10",
    title="Three loops, three typing errors",
    points=3,
    where=lambda first, second, third: len({first, second, third}) == 3,
    insight="The period tells why a loop oscillates: four to five dead times mean too much gain, twice as many too "
    "short an integral time.",
)
def three_loops(
    ratio=choice(3, 4, 5, 6, reference=4),
    delay=between(20, 60, "s", step=10, reference=30),
    first=choice(*FAULTS, reference="integral time too short"),
    second=choice(*FAULTS, reference="gain too low"),
    third=choice(*FAULTS, reference="gain too high"),
):
    """A bakery has three equal ovens, A, B and C. From burner to temperature each is a lag with a dead time of {delay}
    and a time constant of {words} dead times. All three PI controllers should have the same settings, by Skogestad's
    rule with $T_C = \\tau$, but in each of them **one** setting was mistyped. The picture shows what the temperatures
    do after a step of the setpoint at time zero and after a load later on.

    Which setting of which loop is wrong, and in which direction?
    """
    faults = {"A": first, "B": second, "C": third}
    return answers(**{name: word(fault, FAULTS, f"what is wrong in loop {name}") for name, fault in faults.items()})


def _not(word, first, second, third):
    """The loops whose fault is another one, with this word for it."""
    return {name: word for name, fault in zip("ABC", (first, second, third), strict=True) if fault != word}


@three_loops.mistake(
    "Too high a gain makes a loop oscillate quickly, with four to five dead times a period. Measure it."
)
def _(first, second, third):
    return _not("gain too high", first, second, third)


@three_loops.mistake("With too low a gain nothing is quick, not even the first part of the response. Is that so here?")
def _(first, second, third):
    return _not("gain too low", first, second, third)


@three_loops.mistake(
    "Too short an integral time makes a loop oscillate slowly, with a period of eight dead times or more. Measure it."
)
def _(first, second, third):
    return _not("integral time too short", first, second, third)


@three_loops.mistake(
    "Too long an integral time leaves the first part of the response quick, and what is missing then creeps away. "
    "Do you see two parts?"
)
def _(first, second, third):
    return _not("integral time too long", first, second, third)


three_loops.hints(
    "Two of the four errors make a loop oscillate, two make it slow. Sort the three loops first.",
    "Oscillating: measure the period in dead times. Slow: look at the first quick part of the response to the "
    "setpoint. Is there one, or is everything slow?",
    "Both gain and integral time cost phase. With too high a gain the loop is fast, and its period is four to five "
    "dead times, here about {fast}. With too short an integral time the crossover stays lower and the period is much "
    "longer.",
)


@three_loops.shows
def _(ratio, delay, first, second, third):
    words = {3: "three", 4: "four", 5: "five", 6: "six"}[int(ratio)]
    curves = {f"y_{name}": _oven(int(ratio), fault) for name, fault in zip("ABC", (first, second, third), strict=True)}
    return {"words": words, "fast": (Rational(44, 10) * delay, "s"), "t": _DEAD_TIMES * float(delay) / 60} | curves


_TELLS = {
    "gain too high": "It oscillates quickly: its period is about {fast}, between four and five dead times",
    "gain too low": "It is slow from the beginning, without any quick part, and it gives way to the load far and long",
    "integral time too short": "It oscillates slowly: its period is {slow} or more, about twice that of a loop with "
    "too much gain",
    "integral time too long": "It makes most of the step quickly and then creeps, as it does after the load",
}


@three_loops.solution
def _(first, second, third, delay):
    r"""**Loop A: {first}.** {a}.

    **Loop B: {second}.** {b}.

    **Loop C: {third}.** {c}.

    With the settings that were meant, $K_p = \frac{{T}}{2K\tau}$ and $T_i = T$, all three would respond as in the
    picture below: quickly, and with hardly any overshoot.
    """
    places = {"fast": written(round(4.4 * delay), "s"), "slow": written(round(7.5 * delay), "s")}
    return {name: _TELLS[fault].format(**places) for name, fault in zip("abc", (first, second, third), strict=True)}


_DEAD_TIMES = np.linspace(0, 60, 601)


@lru_cache
def _oven(ratio, fault):
    """The response of an oven to its setpoint and, 30 dead times later, to a load; the dead time is one."""
    from loopbook.deadtime import Loop

    gain, time = FAULTS.get(fault, (1, 1))
    pid = PID(Rational(ratio, 2) * exact(gain), ratio * exact(time))
    load = stepwise(0, {30: Rational(3, 5)})
    return Loop(exp(-s) / (ratio * s + 1), pid).run(_DEAD_TIMES, setpoint=1, load=load)["y"]


def _ovens(ratio, delay, faults):
    panels = [{name: (_oven(int(ratio), fault), "measurement")} for name, fault in faults.items()]
    times = _DEAD_TIMES * float(delay) / 60
    plot = time_plot(panels, times, xlabel="$t$ [min]", ylim=[(-0.1, 2.0)] * len(faults), low=True)
    for name in faults:
        plot.level(1, "setpoint", name)
    return plot.event(float(delay) / 2, "load")


@three_loops.picture
def _(ratio, delay, first, second, third):
    """The temperatures of three loops, counted in setpoint steps, after the step at time zero and a load later."""
    return _ovens(ratio, delay, {"A": first, "B": second, "C": third})


@three_loops.solution_picture
def _(ratio, delay):
    """The same loop with the settings that were meant."""
    return _ovens(ratio, delay, {"as meant": ""})
