"""Exercises of chapter 15, direct synthesis: from the wish to the controller."""

import math

import numpy as np
from sympy import Rational, exp

from loopbook.exercises.authoring import (
    answers,
    between,
    criterion,
    design,
    exercise,
    largest_sensitivity,
    number,
    pi_controller,
    settings,
    stable,
    time_function,
    transfer_function,
)
from loopbook.expressions import s, t
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import integrator


@exercise(
    "15.1",
    title="A tank that should respond faster",
    points=2,
    where=lambda K, T, Tc: Tc <= Rational(3, 5) * T and T <= 10 * K * Tc,
)
def faster_tank(
    K=between(0.2, 2, "K/%", reference=0.8),
    T=between(10, 60, "min", reference=24),
    Tc=between(2, 20, "min", reference=6),
):
    """A well-stirred tank is heated by steam. From the steam valve to the temperature of the water the process has
    the gain {K}, a lag of {T}, and practically no dead time. The control loop should respond to the setpoint like a lag
    of {Tc}, and without offset. Find by direct synthesis the PI controller that does it. And when has the temperature
    come 95 % of the way to a new setpoint?
    """
    return answers(
        controller=settings(PID(T / (K * Tc), T), gain="%/K", time="min", what="the settings of the PI controller"),
        time=number(Tc * math.log(20), "min", "the time for 95 % of the way"),
    )


@faster_tank.mistake(
    "The zero of the controller should cancel the pole of the tank. Which lag is the integral time then?"
)
def _(K, T, Tc):
    return {"controller": PID(T / (K * Tc), Tc)}


@faster_tank.mistake(
    "With your gain, a faster closed loop would need a weaker controller. Solve for the controller again."
)
def _(K, T, Tc):
    return {"controller": PID(Tc / (K * T), T)}


@faster_tank.mistake("That is how slow the tank is without a controller. Which lag does the closed loop have?")
def _(T):
    return {"time": T * math.log(20)}


@faster_tank.mistake("After that time the temperature has covered only 63 % of the way.")
def _(Tc):
    return {"time": Tc}


@exercise(
    "15.2",
    title="A level that does not come back",
    points=4,
    where=lambda K, delay, Tc: Tc >= delay and K * (Tc + delay) >= Rational(1, 10),
)
def level_offset(
    K=between(0.01, 0.1, "1/min", reference=0.04),
    delay=between(0.5, 3, "min", reference=1, step=0.25),
    Tc=between(1, 8, "min", reference=4, step=0.5),
    load=between(2, 10, "%", reference=5),
):
    r"""The level of a buffer tank [%] integrates the position of the inflow valve [%], after a dead time: {process},
    with the time in minutes.

    First ask the loop for $M = \frac{1 - \theta s}{T_c s + 1}$, where $\theta$ is the dead time and $T_c$ is {Tc},
    and take $1 - \theta s$ for the dead time in the model, too. What comes out is a controller with a gain alone. A
    load as large as {load} of valve position then enters at the input of the tank and stays. How far from the
    setpoint does the level end (as a positive number)?

    Then put a lead into the wish, as in row M of the IMC table: $M = \frac{(1 - \theta s)(a s + 1)}{(T_c s + 1)^2}$,
    with the lead $a$ for which no offset remains. Which PI controller is that?
    """
    gain = 1 / (K * (Tc + delay))
    return answers(
        gain=number(gain, "", "the gain of the first controller"),
        offset=number(load / gain, "%", "the offset of the level"),
        controller=settings(
            PID((2 * Tc + delay) / (K * (Tc + delay) ** 2), 2 * Tc + delay),
            time="min",
            what="the settings of the PI controller",
        ),
    )


@level_offset.shows
def _(K, delay):
    return {"process": integrator(K, delay)}


@level_offset.mistake("The dead time is missing: it is added to the closed-loop time constant in the gain.")
def _(K, delay, Tc):
    return {"gain": 1 / (K * Tc), "controller": PID(2 / (K * Tc), 2 * Tc)}


@level_offset.mistake(
    "With that offset a stronger controller would leave more of it. Which valve position must the gain produce "
    "from the offset?"
)
def _(K, delay, Tc, load):
    gain = 1 / (K * (Tc + delay))
    return {"offset": load * gain} if abs(gain - 1) > Rational(1, 20) else {}


@level_offset.mistake(
    "That is Skogestad's integral time for an integrating process. Here it follows from the desired response "
    "with the lead."
)
def _(K, delay, Tc):
    return {"controller": PID(1 / (K * (Tc + delay)), 4 * (Tc + delay))}


@level_offset.mistake(
    "The integral time is right. The lead changes the gain as well: divide $M/(1 - M)$ by the model once more."
)
def _(K, delay, Tc):
    return {"controller": PID(1 / (K * (Tc + delay)), 2 * Tc + delay)}


@exercise("15.3", title="How wrong may the gain be?", points=4)
def uncertain_gain(
    K=between(0.5, 4, "", reference=1.5),
    T=between(10, 60, "s", reference=30),
    delay=between(2, 12, "s", reference=6),
    margin=between(2.5, 5, "", reference=3, step=0.25),
):
    r"""The consistency of paper pulp [%] is controlled by the valve [%] of the thick stock. The model has the gain
    {K}, a lag of {T} and the dead time $\theta$ = {delay}. The lag and the dead time are well known. The gain changes
    with the sort of pulp, so that the loop should have a gain margin of {margin}.

    Tune a PI controller by direct synthesis: the wish is a lag of $T_c$ after the dead time, and $1 - \theta s$
    stands for the dead time in the controller. Which $T_c$ gives this gain margin, with the exact dead time in the
    loop? Which settings, and which phase margin go with it?
    """
    Tc = float(delay) * (2 * float(margin) / math.pi - 1)
    return answers(
        Tc=number(Tc, "s", "the closed-loop time constant"),
        controller=settings(
            PID(float(T) / (float(K) * (Tc + float(delay))), T), time="s", what="the settings of the PI controller"
        ),
        phase_margin=number(90 * (1 - 1 / margin), "deg", "the phase margin"),
    )


@uncertain_gain.mistake("That is the time constant and the dead time together. Only one of the two can be chosen.")
def _(delay, margin):
    return {"Tc": 2 * float(delay * margin) / math.pi}


@uncertain_gain.mistake("In the gain of the controller the dead time must be added to the closed-loop time constant.")
def _(K, T, delay, margin):
    return {"controller": PID(float(T) / (float(K * delay) * (2 * float(margin) / math.pi - 1)), T)}


@uncertain_gain.mistake(
    "By that angle the dead time turns the phase at crossover. The margin is what the loop has left."
)
def _(margin):
    return {"phase_margin": 90 / margin}


@uncertain_gain.mistake("That gain puts the loop on the limit of stability; the margin is what is left.")
def _(K, T, delay):
    return {"controller": PID(float(T) * math.pi / (2 * float(K * delay)), T)}


@exercise(
    "15.4",
    title="First down, then up",
    points=5,
    where=lambda T1, T2, beta, Tc: T2 < T1 and Tc / 2 <= beta <= 2 * Tc and Tc < T1,
)
def inverse_response(
    K=between(0.2, 2, "K/%", reference=0.5),
    T1=between(8, 30, "min", reference=12),
    T2=between(2, 10, "min", reference=5),
    beta=between(1, 6, "min", reference=2, step=0.5),
    Tc=between(1, 8, "min", reference=2, step=0.5),
):
    r"""More feed makes a reactor hotter, but first colder, because the feed itself is cold. From the feed valve [%]
    to the temperature [K] the process is {process}, with the time in minutes.

    No controller can take the zero in the right half-plane away, so let the wish keep it, and ask for two lags of
    $T_c$ = {Tc}: $M = \frac{1 - \beta s}{(T_c s + 1)^2}$, where the zero is at $1/\beta$ and $\beta$ = {beta}. Which
    controller does it? How does the temperature answer to a setpoint step of 1 K, and how far does it go in the wrong
    direction (as a positive number, in percent of the step)?
    """
    a = float(1 + beta / Tc)
    return answers(
        controller=transfer_function(
            (T1 * s + 1) * (T2 * s + 1) / (K * s * (Tc**2 * s + 2 * Tc + beta)),
            "the transfer function of the controller",
        ),
        y=time_function(1 - exp(-t / Tc) * (1 + (1 + beta / Tc) * t / Tc), 8 * Tc, "K", "the response to the step"),
        undershoot=number(100 * (a * math.exp(1 / a - 1) - 1), "%", "the undershoot"),
    )


@inverse_response.shows
def _(K, T1, T2, beta):
    gain, lead = ("" if x == 1 else f"{float(x):g}\\," for x in (K, beta))
    slow, quick = (f"{float(x):g}" for x in (T1, T2))
    return {"process": rf"$\frac{{{gain}(1 - {lead}s)}}{{({slow}\,s + 1)({quick}\,s + 1)}}$"}


@inverse_response.mistake("Without feedback that would be right. In the loop, $M/(1 - M)$ takes the place of $M$.")
def _(K, T1, T2, Tc):
    return {"controller": (T1 * s + 1) * (T2 * s + 1) / (K * (Tc * s + 1) ** 2)}


@inverse_response.mistake("That is for a desired response with a single lag; here it has two.")
def _(K, T1, T2, beta, Tc):
    return {
        "controller": (T1 * s + 1) * (T2 * s + 1) / (K * (Tc + beta) * s),
        "y": 1 - (1 + beta / Tc) * exp(-t / Tc),
        "undershoot": 100 * beta / Tc,
    }


@inverse_response.mistake("The zero is missing: the desired response has to keep it.")
def _(K, T1, T2, Tc):
    return {
        "controller": (T1 * s + 1) * (T2 * s + 1) / (K * s * (Tc**2 * s + 2 * Tc)),
        "y": 1 - exp(-t / Tc) * (1 + t / Tc),
    }


@inverse_response.mistake(
    "Your desired response has no zero, so the controller cancels that of the process: such a controller is unstable."
)
def _(K, T1, T2, beta, Tc):
    return {"controller": (T1 * s + 1) * (T2 * s + 1) / (K * s * (Tc**2 * s + 2 * Tc) * (1 - beta * s))}


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


@exercise(
    "15.5",
    title="An oven that forgets a disturbance quickly",
    points=6,
    where=lambda T, delay: 20 * delay <= T <= 60 * delay,
)
def oven(
    K=between(2, 20, "K/%", reference=8),
    T=between(20, 90, "min", reference=50),
    delay=between(0.5, 3, "min", reference=2, step=0.25),
):
    r"""A drying oven reacts to its burner with a gain of {K}, a dead time of {delay} and a lag of {T}. With a PI
    controller that cancels the lag, each opened door is felt for a long time.

    Design a PI controller that is robust, with an $M_s$ of at most 1.7, and that recovers: after a step of the load
    at the input of the process, the deviation should stay below 5 % of its largest value from {limit} on, counted from
    the step of the load. Many settings do it, and any that do are right.
    """
    process = float(K), float(T), float(delay)
    return answers(
        controller=design(
            settings(
                PID(T / (2 * K * delay), 8 * delay), gain="%/K", time="min", what="the settings of the PI controller"
            ),
            pi_controller(),
            stable(by=lambda controller: _is_stable(*process, controller)),
            largest_sensitivity(K * exp(-delay * s) / (T * s + 1), 20 / delay, below=1.7),
            criterion(
                "the time of recovery",
                lambda controller: _recovery(*process, controller),
                below=25 * delay,
                unit="min",
            ),
        )
    )


@oven.shows
def _(delay):
    return {"limit": f"{float(25 * delay):g} min"}


@oven.mistake("This cancels the lag of the oven, so a disturbance decays as slowly as without control.")
def _(K, T, delay):
    return {"controller": PID(T / (2 * K * delay), T)}


@oven.mistake(
    "Those are the settings of row M for a closed-loop time constant as short as the dead time: quick, but not robust."
)
def _(K, T, delay):
    return {"controller": PID(3 * T / (4 * K * delay), 3 * delay)}
