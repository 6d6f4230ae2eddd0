"""Exercises of chapter 17, dead-time compensation: what cannot be avoided, and Smith predictors."""

import math

import numpy as np
from sympy import Heaviside, Poly, Rational, exp

from loopbook.exercises.authoring import (
    answers,
    between,
    criterion,
    design,
    exercise,
    number,
    pi_controller,
    poles,
    settings,
    stable,
    time_function,
    transfer_function,
)
from loopbook.expressions import s, t
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import first_order


@exercise("17.1", title="What nobody can avoid", points=2, where=lambda T, delay: T / 4 <= delay <= 3 * T)
def unavoidable(
    K=between(0.5, 4, "", reference=2),
    T=between(5, 40, "s", reference=20),
    delay=between(5, 40, "s", reference=15),
):
    """A gas analyser sits at the end of a long sampling line. From the valve [%] to its signal [%] the process is a
    lag of {T} with the gain {K} and a dead time of {delay}. Nobody has chosen a controller yet, and still some things
    are certain.

    How small can the integral of the squared error (ISE) be after a unit step of the setpoint? When, after a step of
    the load at the input of the process, can the first effect of the controller be seen in the signal? And how small
    can the ISE be after a unit step of the load?
    """
    return answers(
        servo=number(delay, "s", "the least ISE after a setpoint step"),
        first_effect=number(2 * delay, "s", "the time of the first effect"),
        load=number(float(K) ** 2 * _uncontrolled(T, delay), "s", "the least ISE after a load step"),
    )


def _uncontrolled(T, end):
    """The integral of the square of 1 - exp(-t/T), from 0 to the end."""
    T, end = float(T), float(end)
    return end - 2 * T * (1 - math.exp(-end / T)) + T / 2 * (1 - math.exp(-2 * end / T))


@unavoidable.mistake("A new setpoint is known immediately. How many dead times pass until its effect is seen?")
def _(delay):
    return {"servo": 2 * delay}


@unavoidable.mistake(
    "After one dead time the load is only noticed. How long does it take until the response to it arrives?"
)
def _(delay):
    return {"first_effect": delay}


@unavoidable.mistake("The output is at rest during the first dead time, so there is no error yet.")
def _(K, T, delay):
    return {"load": float(K) ** 2 * _uncontrolled(T, 2 * delay)}


@unavoidable.mistake("The output does not jump to its final value; it goes there with the lag.")
def _(K, delay):
    return {"load": K**2 * delay}


@unavoidable.mistake("The gain of the process is in the error, and the error is squared.")
def _(K, T, delay):
    return {"load": float(K) * _uncontrolled(T, delay)} if K != 1 else {}


@exercise(
    "17.2",
    title="A predictor for a dairy",
    points=3,
    where=lambda K, T, Tc: 4 * abs(T - Tc) >= T and T <= 12 * K * Tc,
)
def dairy(
    K=between(0.1, 0.8, "", reference=0.4),
    T=between(10, 60, "s", reference=24),
    delay=between(10, 80, "s", reference=40),
    Tc=between(4, 40, "s", reference=12),
):
    r"""The fat content of milk [%] is measured far behind the valve [%] that adds the cream. The model is a lag of
    {T} with the gain {K} and a dead time of {delay}. It is right, and it is built into a Smith predictor.

    Tune the PI controller inside the predictor so that it cancels the lag, and the loop is as fast as a lag of $T_C$
    = {Tc} would be without the dead time. How does the fat content answer to a unit step of the setpoint, and what is
    the ISE of this response?
    """
    return answers(
        controller=settings(PID(T / (K * Tc), T), time="s", what="the settings of the PI controller"),
        y=time_function(
            Heaviside(t - delay) * (1 - exp(-(t - delay) / Tc)), delay + 5 * Tc, "%", "the response to the step"
        ),
        ISE=number(delay + Tc / 2, "s", "the ISE"),
    )


@dairy.mistake(
    "That is for an ordinary loop, which has to be weaker because of the dead time. Inside the predictor there "
    "is no dead time."
)
def _(K, T, delay, Tc):
    return {"controller": PID(T / (K * (Tc + delay)), T)}


@dairy.mistake("The integral time should cancel the lag of the model.")
def _(K, T, Tc):
    return {"controller": PID(T / (K * Tc), Tc)}


@dairy.mistake("The predictor takes the dead time out of the loop, but not out of the response.")
def _(Tc):
    return {"y": 1 - exp(-t / Tc), "ISE": Tc / 2}


@dairy.mistake(
    "The integral action brings the fat content to the setpoint. Does the gain of the process still show then?"
)
def _(K, delay, Tc):
    return {"y": K * Heaviside(t - delay) * (1 - exp(-(t - delay) / Tc))}


@dairy.mistake("This is not zero while the dead time lasts. Which factor switches the response on?")
def _(delay, Tc):
    return {"y": 1 - exp(-(t - delay) / Tc)}


@dairy.mistake("That is the integral of the error itself. A squared error fades twice as fast.")
def _(delay, Tc):
    return {"ISE": delay + Tc}


@exercise(
    "17.3",
    title="The predictor in one block",
    points=4,
    where=lambda K, T, Kc, Ti: abs(Ti * (1 + K * Kc) ** 2 - 4 * T * K * Kc) > T * K * Kc / 2 and Ti != T,
)
def one_block(
    K=between(0.5, 3, "", reference=2),
    T=between(4, 20, "min", reference=10),
    delay=between(3, 20, "min", reference=8),
    Kc=between(0.5, 3, "", reference=1),
    Ti=between(2, 12, "min", reference=4),
):
    r"""A rotary kiln is controlled by a Smith predictor. The process is {process}, with the time in minutes, and its
    model is right. Both signals are in percent. Inside the predictor works a PI controller with the gain {Kc} and the
    integral time {Ti}.

    Write the whole predictor, from the control error to the control signal, as one transfer function. Then find the
    poles of the closed loop, from the setpoint to the measurement.
    """
    polynomial = Poly(T * Ti * s**2 + (1 + K * Kc) * Ti * s + K * Kc, s)
    return answers(
        predictor=transfer_function(
            _predictor(K, T, Kc, Ti, 1 - exp(-delay * s)), "the transfer function of the predictor"
        ),
        poles=poles([complex(p) for p in np.roots([float(c) for c in polynomial.all_coeffs()])], "1/min", "the poles"),
    )


def _predictor(K, T, Kc, Ti, share):
    """A PI controller with a share of the model fed back around it."""
    return Kc * (Ti * s + 1) * (T * s + 1) / (Ti * s * (T * s + 1) + K * Kc * (Ti * s + 1) * share)


@one_block.shows
def _(K, T, delay):
    return {"process": first_order(K, T, delay)}


@one_block.mistake("That is the PI controller alone. What does the model feed back around it?")
def _(Kc, Ti):
    return {"predictor": Kc * (1 + 1 / (Ti * s))}


@one_block.mistake(
    "The controller is also told what the process has not shown yet. Which part of the model must be subtracted again?"
)
def _(K, T, Kc, Ti):
    return {"predictor": _predictor(K, T, Kc, Ti, 1)}


@one_block.mistake(
    "The model without dead time and the one with it enter with opposite signs. Look at which one is fed back "
    "negatively."
)
def _(K, T, delay, Kc, Ti):
    return {"predictor": _predictor(K, T, Kc, Ti, exp(-delay * s) - 1)}


@one_block.mistake(
    "One of these is the lag's own, and only a load excites it. On the way from the setpoint, a zero of the predictor "
    "cancels it."
)
def _(K, T, Kc, Ti):
    polynomial = [float(T * Ti), float((1 + K * Kc) * Ti), float(K * Kc)]
    return {"poles": [*(complex(p) for p in np.roots(polynomial)), -1 / float(T)]}


@one_block.mistake("The poles of the open loop move when the loop is closed.")
def _(T):
    return {"poles": [0, -1 / float(T)]}


@one_block.mistake(
    "These would be the poles with a controller that has a gain alone, and one at zero. Put the integral term in."
)
def _(K, T, Kc):
    return {"poles": [0, -float((1 + K * Kc) / T)]}


@exercise(
    "17.4",
    title="How far does a load push?",
    points=5,
    where=lambda K, T, delay, load: T / 5 <= delay <= Rational(3, 2) * T and K * load <= 12,
)
def load_response(
    K=between(0.5, 4, "K/%", reference=1.5),
    T=between(5, 40, "s", reference=20),
    delay=between(3, 30, "s", reference=10),
    load=between(2, 10, "%", reference=4),
):
    r"""Warm water reaches a bottle washer through a long pipe. From the mixing valve to the temperature the process
    is a lag of $T$ = {T} with the gain {K} and the dead time $\theta$ = {delay}. A Smith predictor with the right
    model controls it. Its PI controller cancels the lag, and makes the loop as fast as the process itself, $T_C = T$.

    At $t = 0$ a load as large as {load} of valve position enters at the input of the process, and stays. Find the
    deviation of the temperature over time, its largest value, and the time at which that is reached.
    """
    push, x = K * load, math.exp(-float(delay / T))
    return answers(
        y=time_function(
            push * Heaviside(t - delay) * (1 - exp(-(t - delay) / T)) - _taken_back(push, T, 2 * delay),
            2 * delay + 6 * T,
            "K",
            "the deviation",
        ),
        largest=number(float(push) * math.exp(-x), "K", "the largest deviation"),
        time=number(float(2 * delay) + float(T) * x, "s", "the time of the largest deviation"),
    )


def _taken_back(push, T, start):
    """What a controller with the closed-loop lag T takes back of a load, from `start` on."""
    late = (t - start) / T
    return push * Heaviside(t - start) * (1 - (1 + late) * exp(-late))


@load_response.mistake("That is the course without control. When and how does the controller reverse it?")
def _(K, T, delay, load):
    return {"y": K * load * Heaviside(t - delay) * (1 - exp(-(t - delay) / T))}


@load_response.mistake("The controller acts when it sees the deviation. Its action takes another dead time.")
def _(K, T, delay, load):
    push = K * load
    return {"y": push * Heaviside(t - delay) * (1 - exp(-(t - delay) / T)) - _taken_back(push, T, delay)}


@load_response.mistake("That is the deviation when the first action arrives. It still grows a little before it turns.")
def _(K, T, delay, load):
    return {"largest": float(K * load) * (1 - math.exp(-float(delay / T)))}


@load_response.mistake("At that time the first action arrives. The deviation still grows a little before it turns.")
def _(delay):
    return {"time": 2 * delay}


@load_response.mistake("This is not zero while nothing can happen yet. Which factor switches each part on?")
def _(K, T, delay, load):
    late = (t - 2 * delay) / T
    return {"y": K * load * ((1 + late) * exp(-late) - exp(-(t - delay) / T))}


@load_response.mistake("Count the time from the step of the load, not from the first action of the controller.")
def _(T, delay):
    return {"time": float(T) * math.exp(-float(delay / T))}


@exercise(
    "17.5",
    title="A pipe with two flows",
    points=6,
    where=lambda K, T, volume, low, high: (
        Rational(5, 4) * low <= high <= 2 * low and T <= 12 * K * _middle(volume, low, high)[1]
    ),
)
def two_flows(
    K=between(0.5, 4, "", reference=2),
    T=between(2, 12, "min", reference=6),
    volume=between(10, 60, "L", reference=24),
    low=between(2, 8, "L/min", reference=4),
    high=between(3, 12, "L/min", reference=6),
):
    r"""A dosing loop has the gain {K} (its signals are in percent) and a lag of {T}. Its dead time is the time that the
    liquid spends in a pipe of {volume}. The flow is anything between {low} and {high}, and nobody measures
    it. So the model in the Smith predictor gets a constant dead time $\theta_m$, the one that is off by the same time
    at both ends.

    Which $\theta_m$ is that? Then design the PI controller in the predictor. Let $T_0(s)$ be the closed loop without
    dead time, and $M(s) = T_0(s)\,(e^{-\theta s} - e^{-\theta_m s})$. As long as $|M(j\omega)|$ stays below 1, the
    loop is stable. Here it should stay below 0.8 at all frequencies, both for the longest and for the shortest dead
    time. And when the model is right, the ISE after a unit step of the setpoint should be at most {limit}. Any
    settings that do both are right.
    """
    model, off = _middle(volume, low, high)
    return answers(
        model_delay=number(model, "min", "the dead time of the model"),
        controller=design(
            settings(PID(T / (K * off), T), time="min", what="the settings of the PI controller"),
            pi_controller(),
            stable(by=lambda controller: _servo_ISE(K, T, model, controller) < math.inf),
            criterion("the largest $|M|$", lambda controller: _largest_M(K, T, off, controller), below=0.8),
            criterion(
                "the ISE with the right model",
                lambda controller: _servo_ISE(K, T, model, controller),
                below=_ISE_limit(model, off),
                unit="min",
            ),
        ),
    )


def _middle(volume, low, high):
    """The dead time in the middle, and how far it is off at either end."""
    longest, shortest = volume / low, volume / high
    return (longest + shortest) / 2, (longest - shortest) / 2


def _ISE_limit(model, off):
    return round(float(model + Rational(3, 5) * off), 2)


def _largest_M(K, T, off, controller):
    K, T, off = float(K), float(T), float(off)
    jw = 1j * np.geomspace(0.01, 50, 2000) / off
    L = np.array(_frequency(controller, jw)) * K / (T * jw + 1)
    return float(np.max(abs(L / (1 + L)) * 2 * abs(np.sin(jw.imag * off / 2))))


def _frequency(controller, jw):
    Kp, Ti, Td, Tf = (float(x) for x in (controller.Kp, controller.Ti, controller.Td, controller.Tf))
    return Kp * (1 + 1 / (Ti * jw) + Td * jw / (Tf * jw + 1))


def _servo_ISE(K, T, model, controller):
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    if Kp <= 0 or math.isinf(Ti):
        return math.inf
    return float(model) + pi_first_order(float(K), float(T), 0, Kp, Ti, unstable=math.inf)


@two_flows.shows
def _(volume, low, high):
    return {"limit": f"{_ISE_limit(*_middle(volume, low, high)):g} min"}


@two_flows.mistake(
    "That is the dead time at the mean flow. The dead time is not a linear function of the flow, so take "
    "the mean of the dead times."
)
def _(volume, low, high):
    return {"model_delay": 2 * volume / (low + high)}


@two_flows.mistake("The error of the model is only half of the range, so this loop is slower than necessary.")
def _(K, T, volume, low, high):
    return {"controller": PID(T / (2 * K * _middle(volume, low, high)[1]), T)}


@two_flows.mistake(
    "This controller is tuned for an ordinary loop. In the predictor the dead time need not be added to $T_C$."
)
def _(K, T, volume, low, high):
    model, off = _middle(volume, low, high)
    return {"controller": PID(T / (K * (model + off)), T)}
