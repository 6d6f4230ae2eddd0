"""Exercises of chapter 15, direct synthesis: from the wish to the controller."""

import math

import numpy as np
from sympy import Rational, exp

from loopbook import diagrams
from loopbook.deadtime import Loop, System
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
from loopbook.figures import plane_plot, time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import integrator


def _until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


@exercise(
    "15.1",
    title="A tank that should respond faster",
    points=2,
    insight="A PI controller that cancels the lag makes a loop with the lag of your wish; its gain is the price.",
    where=lambda K, T, Tc: Tc <= Rational(3, 5) * T and 10 * K * Tc >= T,
)
def faster_tank(
    K=between(0.2, 2, "K/%", reference=0.8),
    T=between(10, 60, "min", reference=24),
    Tc=between(2, 20, "min", reference=6),
):
    """A well-stirred tank is heated by steam. From the steam valve to the temperature of the water the process has
    the gain {K}, a lag of {T}, and practically no dead time. The loop should follow its setpoint like a lag of {Tc},
    without offset. Which PI controller does that, by direct synthesis? And how long after a step of the setpoint has
    the temperature covered 95 % of the way?
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


@faster_tank.mistake("The lag of the tank is in the gain, too: compare the numerator of the controller term by term.")
def _(K, T, Tc):
    return {"controller": PID(1 / (K * Tc), T)}


@faster_tank.mistake("After that time 5 % of the way are covered. How much is *left* when 95 % are?")
def _(Tc):
    return {"time": Tc * math.log(1 / 0.95)}


@faster_tank.mistake("The two settings are interchanged: which of them is a time, and which a gain?")
def _(K, T, Tc):
    return {"controller": PID(T, T / (K * Tc))}


@faster_tank.mistake("After that time 90 % of the way are covered. How much is left when 95 % are?")
def _(Tc):
    return {"time": Tc * math.log(10)}


@faster_tank.mistake("After four time constants 98 % of the way are covered. How many does 95 % take?")
def _(Tc):
    return {"time": 4 * Tc}


@faster_tank.mistake("A lag does not go its way with a constant speed. Which share is left after a time $t$?")
def _(Tc):
    return {"time": Rational(19, 20) * Tc}


faster_tank.hints(
    "Direct synthesis writes down the wish $M$ first, here a lag, and then solves for the controller.",
    "$G_c = \\frac{1}{G}\\,\\frac{M}{1 - M}$. For a lag as the wish, $\\frac{M}{1 - M}$ is $\\frac{1}{T_c s}$.",
    "$G_c = \\frac{ {T}\\,s + 1}{ {K} \\cdot {Tc}\\,s}$. Divide the numerator term by term: what is the constant, and "
    "what is the factor of $1/s$?",
)


@faster_tank.solution
def _(K, T, Tc):
    r"""The wish is $M = \frac{1}{T_c s + 1}$, so that $\frac{M}{1 - M} = \frac{1}{T_c s}$. Divided by the tank
    $\frac{{K}}{T s + 1}$, that is the controller

    $$G_c = \frac{T s + 1}{K T_c s} = \frac{{T}}{K T_c}\left(1 + \frac{1}{T s}\right).$$

    ***

    It is a PI controller. Its integral time is the lag of the tank, {T}, and its gain is
    $\frac{{T}}{K T_c} = \frac{ {T} }{ {K} \cdot {Tc} }$, which is {gain}.

    The loop is a lag of {Tc} then. After a step it has covered $1 - e^{-t/T_c}$ of the way, which is 95 % at
    $t = T_c \ln 20$, and that is {time}. Three time constants are a good rule of thumb.
    """
    return {"gain": (T / (K * Tc), "%/K")}


@faster_tank.solution_picture
def _(K, T, Tc):
    """The temperature after a step of the setpoint, with the controller and with the valve alone."""
    curves = {"with the controller": (1 - exp(-t / Tc), "measurement"), "without": (1 - exp(-t / T), 3)}
    plot = time_plot(curves, _until(3 * T), "A step of the setpoint by 1 K", "$t$ [min]", "temperature [K]")
    return plot.mark(float(Tc) * math.log(20), "95 %")


@exercise(
    "15.2",
    title="A level that does not come back",
    points=4,
    insight="A wish that says nothing about loads may leave an offset: beside an integrator it needs a lead.",
    where=lambda K, delay, Tc: Tc >= delay and K * (Tc + delay) >= Rational(1, 10),
)
def level_offset(
    K=between(0.01, 0.1, "1/min", reference=0.04),
    delay=between(0.5, 3, "min", reference=1, step=0.25),
    Tc=between(1, 8, "min", reference=4, step=0.5),
    load=between(2, 10, "%", reference=5),
):
    r"""The level of a buffer tank [%] integrates the position of the inflow valve [%], after a dead time: {process},
    with the time in minutes. (This exercise needs the section *Rows with an integrator*, which is further reading.)

    First ask for $M = \frac{1 - \theta s}{T_c s + 1}$, where $\theta$ is the dead time and $T_c$ is {Tc}, and put
    $1 - \theta s$ in the place of the dead time in the model, too. The result is a controller with a gain alone. Then
    a load $d$ of {load} of valve position enters at the input of the tank and stays. How far from the setpoint does the
    level end (as a positive number)?

    Now put a lead into the wish, as in row M of the IMC table: $M = \frac{(1 - \theta s)(a s + 1)}{(T_c s + 1)^2}$,
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
    "With that offset a stronger controller would leave more of it. Which valve position must the gain produce from "
    "the offset?"
)
def _(K, delay, Tc, load):
    gain = 1 / (K * (Tc + delay))
    return {"offset": load * gain} if abs(gain - 1) > Rational(1, 20) else {}


@level_offset.mistake(
    "That is Skogestad's integral time for an integrating process. Here it follows from the desired response with the "
    "lead."
)
def _(K, delay, Tc):
    return {"controller": PID(1 / (K * (Tc + delay)), 4 * (Tc + delay))}


@level_offset.mistake(
    "The integral time is right. The lead changes the gain as well: divide $M/(1 - M)$ by the model once more."
)
def _(K, delay, Tc):
    return {"controller": PID(1 / (K * (Tc + delay)), 2 * Tc + delay)}


@level_offset.mistake("For the setpoint the integrating tank is enough. But who balances a load in front of it?")
def _():
    return {"offset": 0}


@level_offset.mistake("The slope of the tank is missing in the gain: a tank that rises quickly needs less of it.")
def _(K, delay, Tc):
    return {"gain": 1 / (Tc + delay), "controller": PID((2 * Tc + delay) / (Tc + delay) ** 2, 2 * Tc + delay)}


@level_offset.mistake("The process is an integrator and has no gain of its own. Who takes the load back in the end?")
def _(K, load):
    return {"offset": K * load}


@level_offset.mistake(
    "At rest the slope of the tank does not count any more. Which valve position must the gain make of the offset?"
)
def _(K, delay, Tc, load):
    gain = 1 / (K * (Tc + delay))
    return {"offset": K * load / gain} if abs(gain - 1) > Rational(1, 20) else {}


@level_offset.mistake(
    "That is the offset behind a lag with the gain 1. Here the tank integrates, until the gain takes all of the load "
    "back."
)
def _(K, delay, Tc, load):
    return {"offset": load / (1 + 1 / (K * (Tc + delay)))}


def _short_lead(square):
    def wrong(K, delay, Tc):
        return {"controller": PID(2 * Tc / (K * square(Tc, delay)), 2 * Tc)}

    return wrong


for _square in (lambda Tc, delay: (Tc + delay) ** 2, lambda Tc, delay: Tc**2 + 2 * Tc * delay):
    level_offset.mistake(
        "The dead time is in the term with $s$ as well: which lead makes this term of $1 - M$ vanish?"
    )(_short_lead(_square))


@level_offset.mistake(
    "Multiply $(1 - \\theta s)(a s + 1)$ out once more: with which sign, and how often, is $\\theta$ there?"
)
def _(K, delay, Tc):
    return {"controller": PID(2 / (K * (Tc + delay)), 2 * (Tc + delay))}


@level_offset.mistake("The integral time is right. In the factor of $s^2$ the product $a\\theta$ is missing.")
def _(K, delay, Tc):
    return {"controller": PID((2 * Tc + delay) / (K * Tc**2), 2 * Tc + delay)}


@level_offset.mistake(
    "That would be a lag in the wish that is cancelled. The lead is chosen so that no offset remains."
)
def _(K, delay, Tc):
    return {"controller": PID(1 / (K * (Tc + delay)), Tc)}


level_offset.hints(
    "The formula of direct synthesis is the same for every wish: $G_c = \\frac{1}{G}\\,\\frac{M}{1 - M}$. A load that "
    "stays must be balanced by the controller.",
    "For the first wish, $1 - M = \\frac{(T_c + \\theta)s}{T_c s + 1}$. For the second, $1 - M$ must vanish with $s^2$ "
    "instead of $s$: choose $a$ so that the term in $s$ is zero.",
    "The first gain is $\\frac{1}{K(T_c + \\theta)}$ with $T_c + \\theta = {Tc} + {delay}$. In the second wish the "
    "term in $s$ of $(T_c s + 1)^2 - (1 - \\theta s)(a s + 1)$ is $2T_c + \\theta - a$.",
)


@level_offset.picture
def _(K, delay):
    """Block diagram: the setpoint, a controller, the load d added to its signal, the tank, and the level fed back."""
    forward = ["e", diagrams.block("Controller"), "u", diagrams.disturbance("d"), integrator(K, delay)]
    return diagrams.block_diagram("y_{SP}", diagrams.feedback_loop(forward), "y")


@level_offset.solution
def _(K, delay, Tc):
    r"""With the first wish, $1 - M = \frac{(T_c + \theta)s}{T_c s + 1}$. Divide $\frac{M}{1 - M}$ by the model
    $\frac{K(1 - \theta s)}{s}$, and only a gain is left: $\frac{1}{K(T_c + \theta)} = \frac{1}{ {K} \cdot {total} }$,
    which is {gain}.

    In the end the inflow valve must take back the whole load. A controller with a gain alone moves it only for an
    error: $\frac{ {load} }{ {gain} }$, which is {offset}.

    With the lead, $(T_c s + 1)^2 - (1 - \theta s)(a s + 1) = (T_c^2 + a\theta)s^2 + (2T_c + \theta - a)s$. Without the
    term in $s$ the controller integrates, too, as the tank does, and no offset remains. So $a = 2T_c + \theta$, which
    is {lead}, and $T_c^2 + a\theta$ is $(T_c + \theta)^2$.

    What remains is $\frac{a s + 1}{K(T_c + \theta)^2 s}$, a PI controller: its integral time is {lead}, and its gain
    $\frac{ {lead} }{ {K} \cdot {total}^2}$ is {final}.
    """
    return {
        "total": (Tc + delay, "min"),
        "lead": (2 * Tc + delay, "min"),
        "final": (2 * Tc + delay) / (K * (Tc + delay) ** 2),
    }


@level_offset.solution_picture
def _(K, delay, Tc, load):
    """The level after the load with both controllers: with the gain alone it stays away, with the PI it returns."""
    total, times = Tc + delay, _until(12 * (Tc + delay))
    both = {
        "gain alone": PID(1 / (K * total)),
        "with the lead": PID((2 * Tc + delay) / (K * total**2), 2 * Tc + delay),
    }
    curves = {name: load * Loop(integrator(K, delay), pid).regulator.step(times) for name, pid in both.items()}
    curves = {name: np.array(y, float) for name, y in curves.items()}
    return time_plot(curves, times, "The level after the load", "$t$ [min]", "deviation [%]")


@exercise(
    "15.3",
    title="How wrong may the gain be?",
    points=4,
    insight="With the lag cancelled, $T_c/\\theta$ alone decides how robust the loop is: ask for the margin you need.",
)
def uncertain_gain(
    K=between(0.5, 4, "", reference=1.5),
    T=between(10, 60, "s", reference=30),
    delay=between(2, 12, "s", reference=6),
    margin=between(2.5, 5, "", reference=3, step=0.25),
):
    r"""The consistency of paper pulp [%] is controlled by the valve [%] of the thick stock. The model has the gain
    {K}, a lag of {T} and the dead time $\theta$ = {delay}. Lag and dead time are well known, but the gain changes with
    the sort of pulp. So the loop should have a gain margin of {margin}.

    Tune a PI controller by direct synthesis: the wish is a lag of $T_c$ after the dead time, with $1 - \theta s$ in the
    place of the dead time in the controller. Which $T_c$ gives this gain margin, when the dead time in the loop is
    exact? Which settings are these, and which phase margin do they have?
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


@uncertain_gain.mistake("Where the phase is $-180°$, $\\omega\\theta$ is $\\pi/2$ and not 1. How large is $|L|$ there?")
def _(delay, margin):
    return {"Tc": delay * (margin - 1)}


@uncertain_gain.mistake("The integrator in the open loop takes a right angle as well.")
def _(margin):
    return {"phase_margin": 180 - 90 / margin}


@uncertain_gain.mistake(
    "The integrator has turned the phase by a right angle already. By how much may the dead time turn it?"
)
def _(K, T, delay, margin):
    total = float(delay * margin) / math.pi
    return {"Tc": total - float(delay), "controller": PID(float(T) / (float(K) * total), T)}


@uncertain_gain.mistake(
    "So long is $T_c$ and the dead time together where $\\omega\\theta$ is 1. The phase is not $-180°$ there."
)
def _(K, T, delay, margin):
    return {"Tc": delay * margin, "controller": PID(T / (K * delay * margin), T)}


@uncertain_gain.mistake("That is the usual choice, as long as the dead time. Which gain margin has it?")
def _(K, T, delay):
    return {"Tc": delay, "controller": PID(T / (2 * K * delay), T)}


@uncertain_gain.mistake("An angle in radians was taken from one in degrees.")
def _(margin):
    return {"phase_margin": 90 - math.pi / (2 * float(margin))}


@uncertain_gain.mistake("The crossover frequency is not $1/T_c$: what stands in the denominator of the open loop?")
def _(margin):
    return {"phase_margin": 90 - math.degrees(1 / (2 * float(margin) / math.pi - 1))}


uncertain_gain.hints(
    "The controller cancels the lag. What is left of the open loop?",
    "$L(s) = \\frac{e^{-\\theta s}}{(T_c + \\theta)s}$. Its phase is $-90°$ from the integrator, and $-\\omega\\theta$ "
    "from the dead time. Where is it $-180°$, and how large is $|L|$ there?",
    "The phase is $-180°$ at $\\omega\\theta = \\pi/2$, so the gain margin is $\\frac{\\pi}{2}\\,\\frac{T_c + "
    "\\theta}{\\theta}$, and it should be {margin}.",
)


@uncertain_gain.solution
def _(K, T, delay, margin):
    r"""The settings are $K_p = \frac{{T}}{K(T_c + \theta)}$ and $T_i = T$. They cancel the lag, and the open loop is
    $L(s) = \frac{e^{-\theta s}}{(T_c + \theta)s}$.

    Its phase is $-180°$ at $\omega\theta = \pi/2$, where $|L| = \frac{2\theta}{\pi(T_c + \theta)}$. One over it is the
    gain margin: $\frac{\pi}{2}\,\frac{T_c + \theta}{\theta} = {margin}$. So $T_c + \theta = \frac{2}{\pi} \cdot
    {margin} \cdot {delay}$, which is {total}, and $T_c$ is {Tc}.

    The gain is $\frac{ {T} }{ {K} \cdot {total} }$, that is {gain}, and the integral time {T}.

    At crossover $\omega = \frac{1}{T_c + \theta}$. There the dead time has turned the phase by $\omega\theta$, which is
    {turned}. Of the 90° that the integrator leaves, {phase_margin} remain.
    """
    total = 2 / math.pi * float(margin * delay)
    return {"total": (total, "s"), "gain": float(T) / (float(K) * total), "turned": (90 / margin, "deg")}


@uncertain_gain.solution_picture
def _(delay, margin):
    """The Nyquist curve of the loop. It crosses the negative real axis well to the right of the point minus one."""
    w = np.linspace(0.3, 8, 600) / float(delay)
    L = np.exp(-1j * w * float(delay)) / (1j * w * 2 / math.pi * float(margin * delay))
    limits = {"xlim": (-1.2, 0.4), "ylim": (-1.2, 0.4)}
    plot = plane_plot({"$L(j\\omega)$": (L.real, L.imag)}, "real part", "imaginary part", equal=True, **limits)
    return plot.points([-1], [0], "$-1$", "x").points([-1 / float(margin)], [0], "$-1/$gain margin")


@exercise(
    "15.4",
    title="First down, then up",
    points=5,
    insight="A zero in the right half-plane stays in every loop: ask for more speed, and you get more undershoot.",
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
    to the temperature [K] the process is {process}, with the time in minutes. The picture shows its response to a step
    of the valve by 1 %.

    No controller can remove the zero in the right half-plane. So the wish keeps it, with two lags of $T_c$ = {Tc}:
    $M = \frac{1 - \beta s}{(T_c s + 1)^2}$, where the zero is at $1/\beta$ and $\beta$ = {beta}. Which controller does
    that? How does the temperature respond to a setpoint step of 1 K, and how far does it go in the wrong direction (as
    a positive number, in percent of the step)?
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


def _below(beta, Tc, late):
    """How far the response is on the wrong side after so many time constants, in percent of the step."""
    return 100 * abs(1 - math.exp(-late) * (1 + float(1 + beta / Tc) * late))


def _undershoot_of_the_process(T1, T2, beta):
    """How far the process alone goes the wrong way, in percent of its final value."""
    T1, T2, beta = float(T1), float(T2), float(beta)
    moment = T1 * T2 / (T1 - T2) * math.log(T1 * (T2 + beta) / (T2 * (T1 + beta)))
    slow, quick = (T1 + beta) * math.exp(-moment / T1), (T2 + beta) * math.exp(-moment / T2)
    return 100 * abs(1 - (slow - quick) / (T1 - T2))


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


@inverse_response.mistake("That is the inverse of the process. Where is the wish, and where is the feedback?")
def _(K, T1, T2, beta):
    return {"controller": (T1 * s + 1) * (T2 * s + 1) / (K * (1 - beta * s))}


@inverse_response.mistake("That is the response to an impulse. Which factor makes it the one to a step?")
def _(beta, Tc):
    return {"y": (1 - exp(-t / Tc) * (1 + (1 + beta / Tc) * t / Tc)).diff(t)}


@inverse_response.mistake("That is the process alone, as in the picture. How does the closed loop respond?")
def _(K, T1, T2, beta):
    return {"y": K * (1 - ((T1 + beta) * exp(-t / T1) - (T2 + beta) * exp(-t / T2)) / (T1 - T2))}


@inverse_response.mistake("In the partial fractions the double pole has the factor of $t$ from the lags alone as well.")
def _(beta, Tc):
    return {"y": 1 - exp(-t / Tc) * (1 + beta * t / Tc**2)} if beta != Tc else {}


@inverse_response.mistake("That is the process alone, as in the picture, and the share of its final value.")
def _(T1, T2, beta):
    return {"undershoot": _undershoot_of_the_process(T1, T2, beta)}


def _undershoot_in_the_picture(read):
    def wrong(K, T1, T2, beta, Tc):
        a = float(1 + beta / Tc)
        depth, right = read(float(K) * _undershoot_of_the_process(T1, T2, beta)), 100 * (a * math.exp(1 / a - 1) - 1)
        return {"undershoot": depth} if K != 1 and abs(depth / right - 1) > 0.03 else {}

    return wrong


for _read in (float, lambda depth: float(f"{depth:.1g}")):  # exactly, and as it is read off
    inverse_response.mistake("That is the process alone, as in the picture. How far down does the loop itself go?")(
        _undershoot_in_the_picture(_read)
    )


@inverse_response.mistake("That is after one $T_c$. The lowest point is where the derivative vanishes.")
def _(beta, Tc):
    return {"undershoot": _below(beta, Tc, 1)}


@inverse_response.mistake("That is after the time $\\beta$. The lowest point is where the derivative vanishes.")
def _(beta, Tc):
    return {"undershoot": _below(beta, Tc, float(beta / Tc))}


@inverse_response.mistake("So far the second part of $y$ falls. And where does the step itself lift it?")
def _(beta, Tc):
    a = float(1 + beta / Tc)
    return {"undershoot": 100 * a * math.exp(1 / a - 1)}


inverse_response.hints(
    "Direct synthesis again: $G_c = \\frac{1}{G}\\,\\frac{M}{1 - M}$. The zero is in $M$ and in $G$: what happens to "
    "it?",
    "$1 - M = \\frac{s\\,(T_c^2 s + 2T_c + \\beta)}{(T_c s + 1)^2}$. The response is that of $M$ alone: a step, and a "
    "double pole at $-1/T_c$. It goes furthest down where its derivative vanishes.",
    "With $a = 1 + \\beta/T_c$ the response is $1 - e^{-t/T_c}(1 + a\\,t/T_c)$, and here $a = 1 + \\frac{ {beta} }{ "
    "{Tc} }$. Its derivative vanishes at $t/T_c = 1 - 1/a$.",
)


@inverse_response.picture
def _(K, T1, T2, beta):
    """The temperature after a step of the feed valve by 1 %: first it falls below zero, then it rises to its end."""
    times = _until(5 * T1)
    y = System(K * (1 - beta * s) / ((T1 * s + 1) * (T2 * s + 1))).step(times)
    return time_plot({"$y$": (y, "measurement")}, times, "The process alone", "$t$ [min]", "temperature [K]")


@inverse_response.solution
def _(K, T1, T2, beta, Tc):
    r"""The zero is in $M$ and in $G$, and cancels in $\frac{M}{G}$. What remains of $1 - M$ is
    $(T_c s + 1)^2 - (1 - \beta s) = s\,(T_c^2 s + 2T_c + \beta)$. So the controller is {controller_}. Its poles are at
    zero, from the integral action, and in the left half-plane: the zero of the process is not among them.

    The response is that of $M$. Its transform $\frac{1 - \beta s}{s(T_c s + 1)^2}$ in partial fractions gives
    $y(t) = 1 - e^{-t/T_c}\left(1 + a\,\frac{t}{T_c}\right)$ with $a = 1 + \beta/T_c$, which is {a}: $y(t) =$
    {response}.

    The derivative vanishes at $\frac{t}{T_c} = 1 - \frac{1}{{a}}$, that is at {moment}. There $y = 1 - a\,e^{1/a -
    1}$. In percent of the step, and as a positive number, the undershoot is {undershoot}.
    """
    a = 1 + beta / Tc
    return {
        "controller_": (T1 * s + 1) * (T2 * s + 1) / (K * s * (Tc**2 * s + 2 * Tc + beta)),
        "a": a,
        "response": 1 - exp(-t / Tc) * (1 + a * t / Tc),
        "moment": (Tc * (1 - 1 / a), "min"),
    }


@inverse_response.solution_picture
def _(beta, Tc):
    """The temperature after a step of the setpoint: it dips below zero, and then rises to the setpoint."""
    a = 1 + beta / Tc
    y = {"$y$": (1 - exp(-t / Tc) * (1 + a * t / Tc), "measurement")}
    plot = time_plot(y, _until(8 * Tc), "A step of the setpoint by 1 K", "$t$ [min]", "temperature [K]")
    return plot.mark(Tc * (1 - 1 / a), "undershoot").level(1, "setpoint")


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
    insight="A cancelled lag is still there for the load: a shorter integral time brings the process back sooner.",
    where=lambda T, delay: 20 * delay <= T <= 60 * delay,
)
def oven(
    K=between(2, 20, "K/%", reference=8),
    T=between(20, 90, "min", reference=50),
    delay=between(0.5, 3, "min", reference=2, step=0.25),
):
    r"""A drying oven responds to its burner with a gain of {K}, a dead time of {delay} and a lag of {T}. With a PI
    controller that cancels the lag, the oven suffers for a long time after every opening of its door.

    Design a PI controller that is robust, with an $M_s$ of at most 1.7, and that recovers: {limit} after a step of the
    load at the input of the process, the deviation should have fallen below 5 % of its largest value, and stay there.
    Many settings do that, and any that do are right.
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
            draws=lambda controller: _after_a_load(*process, controller),
        )
    )


def _after_a_load(K, T, delay, controller):
    times = _until(40 * delay)
    y = Loop(K * exp(-delay * s) / (T * s + 1), controller).regulator.step(times)
    plot = time_plot({"$y$": (y, "measurement")}, times, "Your loop after a load step of 1 %", "$t$ [min]", "$y$ [K]")
    return plot.level(0.05 * max(y), "5 % of the largest").event(25 * delay, "recovered?")


@oven.shows
def _(delay):
    return {"limit": f"{float(25 * delay):g} min", "twice": f"{float(2 * delay):g}"}


@oven.mistake("This cancels the lag of the oven, so a disturbance decays as slowly as without control.")
def _(K, T, delay):
    return {"controller": PID(T / (2 * K * delay), T)}


@oven.mistake(
    "Those are the settings of row M for a closed-loop time constant as short as the dead time: quick, but not robust."
)
def _(K, T, delay):
    return {"controller": PID(3 * T / (4 * K * delay), 3 * delay)}


@oven.mistake("Ziegler and Nichols' settings recover quickly. Which of the two demands do they miss, and by how much?")
def _(K, T, delay):
    return {"controller": PID(Rational(9, 10) * T / (K * delay), Rational(333, 100) * delay)}


@oven.mistake("The gain of the oven is missing: what counts for stability is the product of both gains.")
def _(K, T, delay):
    return {"controller": PID(T / (2 * delay), 8 * delay)}


@oven.mistake("The integral time belongs to $T_c$ and the dead time together, four times. Is that four dead times?")
def _(K, T, delay):
    return {"controller": PID(T / (2 * K * delay), 4 * delay)}


@oven.mistake("With no closed-loop time constant at all the gain is doubled. How robust is the loop then?")
def _(K, T, delay):
    return {"controller": PID(T / (K * delay), 4 * delay)}


oven.hints(
    "The lag of {T} is long compared with the dead time of {delay}. What happens to a cancelled lag after a load?",
    "Skogestad's rule keeps the gain of direct synthesis, $K_p = \\frac{{T}}{K(T_c + \\theta)}$, and takes the shorter "
    "of $T$ and $4(T_c + \\theta)$ as the integral time. Begin with $T_c = \\theta$.",
    "With $T_c = \\theta$, $K_p = \\frac{ {T} }{ {K} \\cdot 2 \\cdot {delay} }$. The integral time is four times "
    "{twice} min, not {T}.",
)


@oven.solution
def _(K, T, delay):
    r"""A PI controller that cancels the lag leaves the load to that lag: the oven recovers with its {T}. So the
    integral time must be shorter, and the gain must not be larger.

    Skogestad's rule with $T_c = \theta$ does that. The gain stays $\frac{{T}}{2K\theta} = \frac{ {T} }{2 \cdot {K}
    \cdot {delay} }$, which is {gain}. The integral time is $8\theta$, that is {time}.

    For a lag this long the loop is nearly that of an integrator. Its largest sensitivity is then {sensitivity}, and
    the deviation stays below 5 % of its largest value from {recovery} on: both are within the limits of 1.7 and
    {limit}.
    """
    controller = PID(T / (2 * K * delay), 8 * delay)
    w = np.geomspace(1e-3, 20, 3000) / float(delay)
    L = System(K * exp(-delay * s) / (T * s + 1) * controller.expr).frequency(w)
    return {
        "gain": (controller.Kp, "%/K"),
        "time": (controller.Ti, "min"),
        "sensitivity": f"{max(1 / abs(1 + L)):.3g}",
        "recovery": f"{_recovery(float(K), float(T), float(delay), controller):.3g} min",
    }


@exercise(
    "15.6",
    title="One controller, written twice",
    points=4,
    where=lambda T1, T2, delay, Tc: 2 * T2 <= T1 and delay <= Tc <= 4 * delay,
    insight="In the serial form the two lags stand for themselves; in the parallel form they are a sum and a product.",
)
def written_twice(
    K=between(0.5, 4, "K/%", step=0.5, reference=2),
    T1=between(12, 40, "min", step=2, reference=20),
    T2=between(3, 12, "min", step=1, reference=5),
    delay=between(1, 4, "min", step=0.5, reference=2),
    Tc=between(1, 12, "min", step=0.5, reference=3),
):
    r"""A kettle is heated through its jacket: the contents are a lag of {T1}, the jacket is one of {T2}, and the
    thermowell of the sensor adds a dead time $\theta$ of {delay}. The gain is {K}. The loop should respond to the
    setpoint like a lag of $T_c$ = {Tc} after the dead time. (In the controller, $1 - \theta s$ takes the place of the
    dead time.)

    Which PID controller does that? Write it once in serial form, as the panel of the old controller expects it,
    with the longer time as $T_i$, and once in parallel form for the new one. And what is the gain margin of the loop,
    with its dead time exact?
    """
    total = Tc + delay
    return answers(
        serial=settings(
            PID(T1 / (K * total), T1, T2, form="serial"), "%/K", "min", "the settings for the old panel", form="serial"
        ),
        parallel=settings(
            PID((T1 + T2) / (K * total), T1 + T2, T1 * T2 / (T1 + T2)),
            "%/K",
            "min",
            "the settings for the new controller",
            form="parallel",
        ),
        gain_margin=number(math.pi * float(total / delay) / 2, "", "the gain margin"),
    )


def _both_forms(gain, T1, T2):
    return {
        "serial": PID(T1 * gain, T1, T2, form="serial"),
        "parallel": PID((T1 + T2) * gain, T1 + T2, T1 * T2 / (T1 + T2)),
    }


@written_twice.mistake("In the gain, the closed-loop time constant is not alone: what became of $1 - e^{-\\theta s}$?")
def _(K, T1, T2, Tc):
    return _both_forms(1 / (K * Tc), T1, T2)


@written_twice.mistake("Without the gain of the process, the loop would be faster or slower than you wished.")
def _(K, T1, T2, delay, Tc):
    return _both_forms(1 / (Tc + delay), T1, T2) if K != 1 else {}


@written_twice.mistake("As a transfer function that is the same controller. Which of its two times should be $T_i$?")
def _(K, T1, T2, delay, Tc):
    return {"serial": PID(T2 / (K * (Tc + delay)), T2, T1, form="serial")}


@written_twice.mistake("The two times are right. Multiply $(T_1 s + 1)(T_2 s + 1)$ out: what stands with $s$ alone?")
def _(K, T1, T2, delay, Tc):
    return {"parallel": PID(T1 / (K * (Tc + delay)), T1 + T2, T1 * T2 / (T1 + T2))}


@written_twice.mistake("In the parallel form the derivative time is not one of the lags. Which factor has $s^2$?")
def _(K, T1, T2, delay, Tc):
    return {"parallel": PID((T1 + T2) / (K * (Tc + delay)), T1 + T2, T2)}


@written_twice.mistake("The phase is $-180°$ at $\\omega\\theta = \\pi/2$, and not where $\\omega\\theta$ is 1.")
def _(delay, Tc):
    return {"gain_margin": (Tc + delay) / delay}


@written_twice.mistake("The open loop is an integrator with the time $T_c + \\theta$; a part of it is missing here.")
def _(delay, Tc):
    return {"gain_margin": math.pi * float(Tc / delay) / 2}


@written_twice.mistake("The sum of the lags makes the gain of one of the two forms. Of which one?")
def _(K, T1, T2, delay, Tc):
    return {"serial": PID((T1 + T2) / (K * (Tc + delay)), T1, T2, form="serial")}


@written_twice.mistake("That is the factor of $s^2$. In the parallel form the gain is outside of the bracket: divide.")
def _(K, T1, T2, delay, Tc):
    return {"parallel": PID((T1 + T2) / (K * (Tc + delay)), T1 + T2, T1 * T2)}


@written_twice.mistake("The integrator turns the phase by a right angle, too: $\\omega\\theta$ is not $\\pi$ there.")
def _(delay, Tc):
    return {"gain_margin": math.pi * float((Tc + delay) / delay)}


@written_twice.mistake(
    "The time of the open loop is not $T_c$ alone, and its phase is not $-180°$ where $\\omega\\theta$ is 1."
)
def _(delay, Tc):
    return {"gain_margin": Tc / delay}


@written_twice.mistake("That is the phase margin in degrees. The gain margin is a factor.")
def _(delay, Tc):
    return {"gain_margin": 90 - math.degrees(float(delay / (Tc + delay)))}


@written_twice.mistake("The gain of the process is in the controller already, inverted: it is not in the open loop.")
def _(K, delay, Tc):
    return {"gain_margin": math.pi * float((Tc + delay) / (K * delay)) / 2} if K != 1 else {}


written_twice.hints(
    "Direct synthesis puts the inverse of the two lags into the controller. What comes instead of them?",
    "$G_c = \\frac{(T_1 s + 1)(T_2 s + 1)}{K(T_c + \\theta)s}$. The serial form $K_p\\left(1 + \\frac{1}{T_i "
    "s}\\right)(1 + T_d s)$ has the same two factors. For the parallel form $K_p\\left(1 + \\frac{1}{T_i s} + T_d "
    "s\\right)$ multiply them out.",
    "Serial: $K_p = \\frac{T_1}{K(T_c + \\theta)} = \\frac{ {T1} }{ {K}\\,({Tc} + {delay})}$. Parallel: the sum of the "
    "lags, ${T1} + {T2}$, takes the place of $T_1$, and their product divided by the sum is $T_d$. What is left of the "
    "open loop is $\\frac{e^{-\\theta s}}{(T_c + \\theta)s}$.",
)


@written_twice.picture
def _(K, T1, T2, delay):
    """Block diagram: setpoint, PID controller, the two lags with the dead time, and the temperature fed back."""
    kettle = K * exp(-delay * s) / ((T1 * s + 1) * (T2 * s + 1))
    loop = diagrams.feedback_loop(["e", diagrams.block("PID"), "u", kettle])
    return diagrams.block_diagram("y_{SP}", loop, "y")


@written_twice.solution
def _(K, T1, T2, delay, Tc):
    r"""For this wish $\frac{M}{1 - M}$ is $\frac{e^{-\theta s}}{T_c s + 1 - e^{-\theta s}}$, and with $1 - \theta s$
    in the denominator that is $\frac{e^{-\theta s}}{(T_c + \theta)s}$. Divided by the process:
    $G_c = \frac{(T_1 s + 1)(T_2 s + 1)}{K(T_c + \theta)s}$.

    **Serial.** Take $T_1 s$ out of the first factor: $G_c = \frac{T_1}{K(T_c + \theta)}\left(1 + \frac{1}{T_1
    s}\right)(1 + T_2 s)$. So $K_p = \frac{ {T1} }{ {K} \cdot {total} }$ is {serial_gain}, $T_i$ is {T1} and $T_d$ is
    {T2}.

    **Parallel.** Multiply out: $\frac{T_1 T_2 s^2 + (T_1 + T_2)s + 1}{K(T_c + \theta)s}$. The term with $s$ makes the
    gain, $\frac{ {sum} }{ {K} \cdot {total} }$, which is {parallel_gain}. The integral time is the sum, {sum}, and the
    derivative time the product over the sum, {derivative}.

    **Margin.** The lags cancel, and $\frac{e^{-\theta s}}{(T_c + \theta)s}$ is left of the open loop. Its phase is
    $-180°$ at $\omega = \frac{\pi}{2\theta}$, so the gain margin is $\frac{\pi}{2}\,\frac{ {total} }{ {delay} }$,
    which is {gain_margin}.
    """
    total = Tc + delay
    return {
        "total": (total, "min"),
        "sum": (T1 + T2, "min"),
        "serial_gain": (T1 / (K * total), "%/K"),
        "parallel_gain": ((T1 + T2) / (K * total), "%/K"),
        "derivative": (T1 * T2 / (T1 + T2), "min"),
    }


@exercise(
    "15.7",
    title="The wish as a picture",
    points=4,
    where=lambda T, delay, Tc: (
        3 * T <= 10 * delay <= 6 * T and delay <= Tc <= Rational(6, 5) * T and 5 * abs(Tc - T) >= T
    ),
    insight="Two pictures are a design: what the process does, and what the loop should do.",
)
def wish_as_a_picture(
    step=between(2, 8, "%", step=1, reference=5),
    K=between(0.5, 3, "K/%", step=0.25, reference=1.5),
    T=between(20, 60, "s", step=5, reference=40),
    delay=between(6, 30, "s", step=2, reference=16),
    Tc=between(10, 60, "s", step=2, reference=24),
    noise=between(1, 999, step=1),
):
    r"""The picture has two panels. Above: a valve was opened by {step} at time zero, and this is how the outlet
    temperature of a heat exchanger rose. Below: what the customer asks for after a step of the *setpoint* by 1 K.
    Take ruler and pencil.

    The process is a lag with a dead time, and so is the wish, with the same dead time. Read off the gain and the dead
    time of the process, and the time constant $T_c$ of the wish. Which PI controller does direct synthesis give?
    (`t, y, wish = exercise("15.7").given("t", "y", "wish")` are the times, the record and the wish.)
    """
    return answers(
        K=number(K, "K/%", "the gain of the process", within=0.05),
        delay=number(delay, "s", "the dead time", within=0.12),
        Tc=number(Tc, "s", "the time constant of the wish", within=0.1),
        controller=settings(
            PID(T / (K * (Tc + delay)), T), "%/K", "s", "the settings of the PI controller", within=0.12
        ),
    )


def _rise(times, T, delay):
    return np.where(times > delay, 1 - np.exp(-(times - delay) / T), 0)


@wish_as_a_picture.shows
def _(step, K, T, delay, Tc, noise):
    return dict(zip(("t", "y", "wish"), _record_and_wish(step, K, T, delay, Tc, noise), strict=True))


def _record_and_wish(step, K, T, delay, Tc, noise):
    times = np.linspace(0, float(delay + 5 * max(T, Tc)), 251)
    clean = float(K * step) * _rise(times, float(T), float(delay))
    y = clean + np.random.default_rng(int(noise)).normal(0, 0.008 * float(K * step), len(times))
    return times, y, _rise(times, float(Tc), float(delay))


@wish_as_a_picture.picture
def _(step, K, T, delay, Tc, noise):
    """Above the noisy record of the temperature after the step of the valve, below the desired response to 1 K."""
    times, y, wish = _record_and_wish(step, K, T, delay, Tc, noise)
    panels = [{"record": (y, "measurement")}, {"wish": (wish, 0)}]
    return time_plot(panels, times, ylabel=["temperature rise [K]", "wish [K]"])


@wish_as_a_picture.mistake("The rise in the picture belongs to the whole step of the valve, and not to 1 %.")
def _(step, K, T, delay, Tc):
    return {"K": K * step, "controller": PID(T / (K * step * (Tc + delay)), T)}


def _with_wish(read, step, K, T, delay, Tc):
    """A time constant of the wish that was read wrongly, and the controller for it where that is told from others."""
    total, right = float(read + delay), float(Tc + delay)
    others = (right, float(Tc), float(step) * right, right / float(K))
    is_another = all(abs(total / other - 1) > 0.15 for other in others)
    return {"Tc": read} | ({"controller": PID(T / (K * (read + delay)), T)} if is_another else {})


def _are_alike(T, delay, Tc):
    """Whether the wish has covered 63 % of its way after about the lag of the process."""
    return abs(Tc + delay - T) <= T / 5


@wish_as_a_picture.mistake("Here time was counted from the step. A lag only begins when the dead time is over.")
def _(K, T, delay, Tc):
    pid = {"controller": PID((T + delay) / (K * (Tc + delay)), T + delay)}
    return pid if _are_alike(T, delay, Tc) else {"Tc": Tc + delay, **pid}


@wish_as_a_picture.mistake(
    "About so long is the lag of the process above, and about so long it takes below from the step to 63 %. Where does "
    "the wish begin, and how long is it from there?"
)
def _(step, K, T, delay, Tc):
    return _with_wish(T, step, K, T, delay, Tc) if _are_alike(T, delay, Tc) else {}


@wish_as_a_picture.mistake("In the gain, the dead time is added to the time constant of the wish.")
def _(K, T, Tc):
    return {"controller": PID(T / (K * Tc), T)}


@wish_as_a_picture.mistake("Which lag does the zero of the controller cancel: the one above, or the one below?")
def _(K, T, delay, Tc):
    return {"controller": PID(T / (K * (Tc + delay)), Tc)}


@wish_as_a_picture.mistake("After one time constant a lag has covered 63 % of the way, not half of it.")
def _(step, K, T, delay, Tc):
    return _with_wish(float(Tc) * math.log(2), step, K, T, delay, Tc)


@wish_as_a_picture.mistake("From the start to 95 % three time constants go by, and the dead time before them.")
def _(step, K, T, delay, Tc):
    return _with_wish(3 * Tc, step, K, T, delay, Tc)


@wish_as_a_picture.mistake(
    "That is the time constant of the process, from the upper panel. How fast is the wish below?"
)
def _(K, T, delay, Tc):
    pid = {"controller": PID(Tc / (K * (T + delay)), Tc)}
    return pid if _are_alike(T, delay, Tc) else {"Tc": T, **pid}


@wish_as_a_picture.mistake(
    "That is when 63 % of the way are covered. The dead time ends where the curve begins to move."
)
def _(T, delay):
    return {"delay": delay + T}


@wish_as_a_picture.mistake("By then the wish has covered 63 % of its way. The dead time ends where it begins to move.")
def _(delay, Tc):
    return {"delay": delay + Tc}


@wish_as_a_picture.mistake(
    "The gain is how far the temperature rises for each percent: do you multiply by the step, or divide?"
)
def _(step, K):
    return {"K": K * step**2}


@wish_as_a_picture.mistake("That is the way to 95 % in place of that to 63 %.")
def _(K, T, delay, Tc):
    return {"Tc": 3 * Tc + delay, "controller": PID(3 * T / (K * (Tc + delay)), 3 * T)}


@wish_as_a_picture.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(K, T, delay, Tc):
    return {"controller": PID(T / (Tc + delay), T)} if K != 1 else {}


@wish_as_a_picture.mistake("The two settings are interchanged: which of them is a time, and which a gain?")
def _(K, T, delay, Tc):
    return {"controller": PID(T, T / (K * (Tc + delay)))}


wish_as_a_picture.hints(
    "From each panel you need where the curve begins, where it ends, and when it has covered 63 % of the way.",
    "The gain is the final rise divided by the step of {step}. The time from the beginning of a curve to 63 % is its "
    "time constant. Direct synthesis: $K_p = \\frac{{T}}{K(T_c + \\theta)}$ and $T_i = T$.",
    "The first number is $K = \\frac{\\mathrm{final\\ rise}}{ {step} }$. Then look above for 63 % of the final rise, "
    "and below for 0.63 K. Both curves begin when the dead time is over: count from there.",
)


@wish_as_a_picture.solution
def _(step, K, T, delay, Tc):
    r"""**Above.** The temperature ends {end} higher, after {step} of valve: the gain is {K}. Nothing happens for
    {delay}, the dead time. At 63 % of the way, {most}, it is {at_63}, so the lag is ${at_63} - {delay}$, which is {T}.

    **Below.** The wish begins at the same time, and reaches 0.63 K at {wish_63}. So $T_c$ is ${wish_63} - {delay}$,
    which is {Tc}.

    **Controller.** $T_i = T$, which is {T}, and $K_p = \frac{{T}}{K(T_c + \theta)} = \frac{ {T} }{ {K}\,({Tc} +
    {delay})}$, which is {gain}.

    By ruler you will be a few percent off, as everybody is; the tolerance allows for it.
    """
    return {
        "end": (K * step, "K"),
        "most": (float(K * step) * (1 - math.exp(-1)), "K"),
        "at_63": (T + delay, "s"),
        "wish_63": (Tc + delay, "s"),
        "gain": (T / (K * (Tc + delay)), "%/K"),
    }


@wish_as_a_picture.solution_picture
def _(K, T, delay, Tc):
    """The loop with this controller beside the wish: although its dead time is exact, the two are close."""
    times = _until(delay + 6 * Tc)
    y = Loop(K * exp(-delay * s) / (T * s + 1), PID(T / (K * (Tc + delay)), T)).servo.step(times)
    curves = {"loop": (y, "measurement"), "wish": (_rise(times, float(Tc), float(delay)), "setpoint")}
    return time_plot(curves, times, "A step of the setpoint by 1 K", ylabel="temperature [K]")
