"""Exercises of chapter 17, dead-time compensation: what cannot be avoided, and Smith predictors."""

import math

import numpy as np
from sympy import Heaviside, Rational, exp

from loopbook import diagrams
from loopbook.deadtime import Loop, System
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
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import feedback, first_order


def _until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def _predictor_diagram(controller, G, delay):
    """A Smith predictor: the process, the controller, and the model with its dead time in a block of its own."""
    layout = """
        .     .  .  .  .  .  .  .  .  .
        y_SP  e  C  u  1  .  P  .  2  y
        .     .  .  .  3  G  4  D  m  .
        .     7  .  .  .  .  f  .  6  ."""
    wires = "y_SP e C u 1 P 2 y, 1 3 G 4 D - m, 2 m 6 f, 4 f 7 - e"
    blocks = {"C": controller, "G": G, "D": exp(-delay * s), "P": G * exp(-delay * s)}
    return diagrams.grid_diagram(layout, wires, blocks)


@exercise(
    "17.1",
    title="What nobody can avoid",
    points=2,
    where=lambda T, delay: T / 4 <= delay <= 3 * T,
    insight="Control is felt one dead time after a setpoint step, and two after a load: the process decides that.",
)
def unavoidable(
    K=between(0.5, 4, "", reference=2),
    T=between(5, 40, "s", reference=20),
    delay=between(5, 40, "s", reference=15),
):
    """A gas analyser sits at the end of a long sampling line. From the valve [%] to its signal [%] the process is a
    lag of {T} with the gain {K} and a dead time of {delay}. The picture shows its response to a load of 1 % at its
    input without a controller. Nobody has chosen one yet, and still some things are certain.

    How small can the integral of the squared error (ISE) be after a unit step of the setpoint? When, after a step of
    the load, can the first effect of a controller be seen in the signal? And how small can the ISE be after a unit step
    of the load?
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


@unavoidable.mistake("That is a loop as slow as the lag. How fast may a controller be about which nothing is said?")
def _(T, delay):
    return {"servo": delay + T / 2}


@unavoidable.mistake("A ramp is only the beginning of the response: the lag bends it before the controller is felt.")
def _(K, T, delay):
    return {"load": K**2 * delay**3 / (3 * T**2)}


@unavoidable.mistake("That is the integral of the error itself. It has to be squared first.")
def _(K, T, delay):
    T, theta = float(T), float(delay)
    wrong, right = theta - T * (1 - math.exp(-theta / T)), float(K) * _uncontrolled(T, theta)
    return {"load": float(K) * wrong} if abs(wrong / right - 1) > 0.03 else {}


@unavoidable.mistake("The square of the deviation at the end of this time was there only at the end: it has grown.")
def _(K, T, delay):
    return {"load": float(K**2 * delay) * (1 - math.exp(-float(delay / T))) ** 2}


@unavoidable.mistake(
    "The first effect is its beginning, and a lag begins to respond at once. How often is the dead time passed?"
)
def _(T, delay):
    return {"first_effect": delay + T} if abs(T / delay - 1) > Rational(1, 20) else {}


@unavoidable.mistake("The first effect is its beginning: the lag makes it grow slowly, but not begin later.")
def _(T, delay):
    return {"first_effect": 2 * delay + T}


@unavoidable.mistake("The gain of the process is not in an error that is one: nothing of the process is seen yet.")
def _(K, delay):
    return {"servo": K**2 * delay} if K != 1 else {}


unavoidable.hints(
    "Whatever a controller does, the signal feels it one dead time later. When does it know of the setpoint, and when "
    "of a load?",
    "After a setpoint step the error is one for a dead time at least. After a load, nothing is seen for one dead time, "
    "and nothing can be done about it for another one: in between the error is $K(1 - e^{-t/T})$, with $t$ counted "
    "from the first dead time on.",
    "The first integral is that of 1 over {delay}. The last one is ${K}^2\\int_0^{ {delay} }(1 - e^{-t/{T}})^2 dt$. "
    "Square first, then integrate term by term.",
)


@unavoidable.picture
def _(K, T, delay):
    """The signal after a load step of 1 % without a controller: a dead time, and then a lag."""
    times = _until(delay + 4 * T)
    y = System(first_order(K, T, delay)).step(times)
    return time_plot({"$y$": (y, "measurement")}, times, "A load of 1 %, nobody acts", ylabel="$y$ [%]")


@unavoidable.solution
def _(K, T, delay):
    r"""**Setpoint.** The controller knows the new setpoint immediately, but the signal feels nothing for one dead time.
    Until then the error is one. Square it, and integrate over this time.

    ***

    So the ISE is at least {servo}, and an ideal controller needs no more.

    **First effect.** A load is seen after one dead time, {delay}. The controller acts then, and its action takes
    another dead time to be seen: at {first_effect}.

    **Load.** In between, for one dead time, the error is that of the process alone, $K(1 - e^{-t/T})$ with $t$ counted
    from {delay} on. The integral of its square is
    $K^2\left[\theta - 2T(1 - e^{-\theta/T}) + \frac{{T}}{2}(1 - e^{-2\theta/T})\right]$. The bracket is {bracket}, and
    $K^2$ is {square}: the ISE is at least {load}.
    """
    return {"bracket": (_uncontrolled(T, delay), "s"), "square": K**2}


@unavoidable.solution_picture
def _(K, T, delay):
    """The response to the load without a controller until the first effect can be seen, with the error shaded."""
    times = _until(2 * delay)
    y = System(first_order(K, T, delay)).step(times)
    plot = time_plot({"$y^2$": (y**2, "measurement")}, times, "Nobody can avoid this", ylabel="$y^2$")
    return plot.area("$y^2$", label="the least ISE").event(delay, "seen")


@exercise(
    "17.2",
    title="A predictor for a dairy",
    points=3,
    insight="With the right model the dead time leaves the loop: tune as if it were not there, and wait for it once.",
    where=lambda K, T, Tc: 4 * abs(T - Tc) >= T and 12 * K * Tc >= T,
)
def dairy(
    K=between(0.1, 0.8, "", reference=0.4),
    T=between(10, 60, "s", reference=24),
    delay=between(10, 80, "s", reference=40),
    Tc=between(4, 40, "s", reference=12),
):
    r"""The fat content of milk [%] is measured far behind the valve [%] that adds the cream. The process is a lag of
    {T} with the gain {K} and a dead time of {delay}. A Smith predictor contains this model, and the model is right.

    The PI controller inside the predictor should cancel the lag, and make the loop as fast as a lag of
    $T_C$ = {Tc}, apart from the dead time. Which settings are these? How does the fat content respond to a unit step of
    the setpoint, and what is the ISE of this response?
    """
    return answers(
        controller=settings(PID(T / (K * Tc), T), time="s", what="the settings of the PI controller"),
        y=time_function(
            Heaviside(t - delay) * (1 - exp(-(t - delay) / Tc)), delay + 5 * Tc, "%", "the response to the step"
        ),
        ISE=number(delay + Tc / 2, "s", "the ISE"),
    )


@dairy.mistake(
    "That is for an ordinary loop, which has to be weaker because of the dead time. Inside the predictor there is no "
    "dead time."
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


@dairy.mistake("When the dead time is over, the error begins to fade. It is not gone yet.")
def _(delay):
    return {"ISE": delay}


@dairy.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(T, Tc):
    return {"controller": PID(T / Tc, T)}


@dairy.mistake("The response begins after the dead time, and begins at zero: from when does the exponential count?")
def _(delay, Tc):
    return {"y": Heaviside(t - delay) * (1 - exp(-t / Tc))}


@dairy.mistake("That is the lag of the process. How fast is the loop with this controller?")
def _(T, delay):
    return {"y": Heaviside(t - delay) * (1 - exp(-(t - delay) / T)), "ISE": delay + T / 2}


@dairy.mistake("That is the error after the dead time. How large is it until then?")
def _(delay, Tc):
    return {"ISE": Tc} if abs((delay + Tc / 2) / Tc - 1) > Rational(3, 100) else {}


dairy.hints(
    "With the right model, the controller inside the predictor does not see the dead time. What is its process?",
    "For the lag alone, $K_c = \\frac{{T}}{K\\,T_C}$ and $T_i = T$ make the loop a lag of $T_C$. The output is that, "
    "one dead time late.",
    "$K_c = \\frac{ {T} }{ {K} \\cdot {Tc} }$. The error is one for {delay}, and then $e^{-(t - {delay})/{Tc}}$: "
    "square it before you integrate.",
)


@dairy.picture
def _(K, T, delay):
    """Block diagram of the predictor: controller C, process, and the model with its dead time behind the model."""
    return _predictor_diagram("C", first_order(K, T), delay)


@dairy.solution
def _(K, T, delay, Tc):
    r"""The controller works as if the process were a lag alone. With $T_i = T$, {T}, it cancels the lag, and the open
    loop is $\frac{K K_c}{T s}$. That is $\frac{1}{T_C s}$ for $K_c = \frac{{T}}{K\,T_C} = \frac{ {T} }{ {K} \cdot {Tc}
    }$, which is {gain}.

    The closed loop is a lag of {Tc} behind the dead time of {delay}: $y(t) = 1 - e^{-(t - {delay})/{Tc}}$ from {delay}
    on, and zero before.

    The error is one until {delay}, and $e^{-(t - {delay})/{Tc}}$ from then on. Its square fades twice as fast, so that
    the ISE is the dead time plus half of $T_C$: ${delay} + \frac{ {Tc} }{2}$, which is {ISE}.
    """
    return {"gain": T / (K * Tc)}


@dairy.solution_picture
def _(delay, Tc):
    """The fat content after the step of the setpoint: it waits for the dead time, and then follows like a lag."""
    y = {"$y$": (Heaviside(t - delay) * (1 - exp(-(t - delay) / Tc)), "measurement")}
    plot = time_plot(y, _until(delay + 5 * Tc), "A unit step of the setpoint", ylabel="fat content [%]")
    return plot.level(1, "setpoint").event(delay, "dead time")


@exercise(
    "17.3",
    title="The predictor in one block",
    points=4,
    insight="A predictor is a controller with a model fed back around it; its loop has the poles of a loop without "
    "dead time.",
    where=lambda K, T, Kc, Ti: abs(Ti * (1 + K * Kc) ** 2 - 4 * T * K * Kc) > T * K * Kc / 2 and Ti != T,
)
def one_block(
    K=between(0.5, 3, "", reference=2),
    T=between(4, 20, "min", reference=10),
    delay=between(3, 20, "min", reference=8),
    Kc=between(0.5, 3, "", reference=1),
    Ti=between(2, 12, "min", reference=4),
):
    r"""A rotary kiln is controlled by a Smith predictor, as in the picture. The process is {process}, with the time in
    minutes, and its model is right. Both signals are in percent. $C$ is a PI controller with the gain {Kc} and the
    integral time {Ti}.

    Write the whole predictor as one transfer function, from the error $e = y_{SP} - y$ to the control signal $u$. Then
    find the poles of the closed loop, from the setpoint to the measurement.
    """
    return answers(
        predictor=transfer_function(
            _predictor(K, T, Kc, Ti, 1 - exp(-delay * s)), "the transfer function of the predictor"
        ),
        poles=poles(_poles(K, T, Kc, Ti), "1/min", "the poles"),
    )


def _poles(K, T, Kc, Ti):
    """The poles of a PI loop around a lag."""
    return [complex(p) for p in np.roots([float(T * Ti), float((1 + K * Kc) * Ti), float(K * Kc)])]


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
    return {"poles": [*_poles(K, T, Kc, Ti), -1 / float(T)]}


@one_block.mistake("The poles of the open loop move when the loop is closed.")
def _(T):
    return {"poles": [0, -1 / float(T)]}


@one_block.mistake(
    "These would be the poles with a controller that has a gain alone, and one at zero. Put the integral term in."
)
def _(K, T, Kc):
    return {"poles": [0, -float((1 + K * Kc) / T)]}


@one_block.mistake("The gain of the process is missing. In which places does the lag bring it in?")
def _(K, T, delay, Kc, Ti):
    if K != 1:
        return {"predictor": _predictor(1, T, Kc, Ti, 1 - exp(-delay * s)), "poles": _poles(1, T, Kc, Ti)}


@one_block.mistake(
    "Fed back around $C$ is only what the model knows before the measurement does: $G(1 - e^{-\\theta s})$."
)
def _(K, T, delay, Kc, Ti):
    return {"predictor": _predictor(K, T, Kc, Ti, exp(-delay * s))}


@one_block.mistake("That is the closed loop, from the setpoint to the measurement. Asked is the block from $e$ to $u$.")
def _(K, T, delay, Kc, Ti):
    return {"predictor": _predictor(K, T, Kc, Ti, 1) * first_order(K, T, delay)}


@one_block.mistake("The gain of a PI controller multiplies its integral term as well. What does yours have there?")
def _(K, T, delay, Kc, Ti):
    if abs(Kc - 1) < 0.1:
        return {}
    parallel = Kc + 1 / (Ti * s)
    predictor = parallel / (1 + parallel * K / (T * s + 1) * (1 - exp(-delay * s)))
    wrong = np.roots([float(T * Ti), float((1 + K * Kc) * Ti), float(K)])
    # with a gain near one the two predictors are nearly the same
    return {"poles": [complex(p) for p in wrong]} | ({"predictor": predictor} if abs(Kc - 1) >= 0.5 else {})


@one_block.mistake("The gain multiplies the integral term as well: look at the last term of the polynomial.")
def _(K, T, Kc, Ti):
    wrong = np.roots([float(T * Ti), float((1 + K * Kc) * Ti), 1.0])
    return {"poles": [complex(p) for p in wrong]} if K * Kc != 1 else {}


@one_block.mistake("The lag has a 1 in its denominator, which belongs to the term with $s$ of the polynomial.")
def _(K, T, Kc, Ti):
    return {"poles": [complex(p) for p in np.roots([float(T * Ti), float(K * Kc * Ti), float(K * Kc)])]}


@one_block.mistake("Dividing by the first coefficient is not yet all: the roots have $2a$ in their denominator.")
def _(K, T, Kc, Ti):
    return {"poles": [2 * p for p in _poles(K, T, Kc, Ti)]}


one_block.hints(
    "Follow the signal that comes back to the controller: which part of it needs the measurement, and which part is "
    "computed from $u$ alone?",
    "From $u$ alone comes $G(1 - e^{-\\theta s})\\,u$, with the lag $G$ without dead time. So the predictor is "
    "$\\frac{C}{1 + C\\,G\\,(1 - e^{-\\theta s})}$. In the closed loop the exponential leaves the denominator: $1 + "
    "C\\,G$ remains.",
    "$C = {Kc}\\left(1 + \\frac{1}{ {Ti}\\,s}\\right)$ and $G = \\frac{ {K} }{ {T}\\,s + 1}$. The poles are the zeros "
    "of $T T_i s^2 + (1 + K K_c)T_i s + K K_c$.",
)


@one_block.picture
def _(K, T, delay):
    """Block diagram of the predictor: controller C, process, and the model with its dead time behind the model."""
    return _predictor_diagram("C", first_order(K, T), delay)


@one_block.solution
def _(K, T, delay, Kc, Ti):
    r"""The controller gets the error minus what the model expects now, plus what it expected one dead time ago:
    $u = C\,[e - G(1 - e^{-\theta s})\,u]$. Solved for $u$, the predictor is $\frac{C}{1 + C\,G\,(1 - e^{-\theta s})}$.
    With $C = K_c\frac{T_i s + 1}{T_i s}$ and $G = \frac{{K}}{T s + 1}$, and the small fractions cleared, it is

    $$ {block} $$

    In the closed loop, $\frac{C\,G\,e^{-\theta s}}{1 + C\,G}$ is left, so that the poles are those without dead time:
    the zeros of $T T_i s^2 + (1 + K K_c)T_i s + K K_c$, which is {polynomial}. They are {roots}, in 1/min.
    """
    polynomial = T * Ti * s**2 + (1 + K * Kc) * Ti * s + K * Kc
    return {
        "block": _predictor(K, T, Kc, Ti, 1 - exp(-delay * s)),
        "polynomial": polynomial,
        "roots": " and ".join(map(_written, _poles(K, T, Kc, Ti))),
    }


def _written(pole):
    size = f"{pole.real:.4g}"
    return f"{size} {'-' if pole.imag < 0 else '+'} {abs(pole.imag):.4g}j" if pole.imag else size


@exercise(
    "17.4",
    title="How far does a load push?",
    points=5,
    insight="A predictor cannot predict a load: the deviation grows for two dead times, whatever the controller does.",
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

    At $t = 0$ a load equivalent to {load} of valve position enters at the input of the process, and stays. Find the
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


def _risen(late, T):
    """The step response of a lag, that much later."""
    return Heaviside(late) * (1 - exp(-late / T))


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


@load_response.mistake("So far the load would push if nobody did anything.")
def _(K, load):
    return {"largest": K * load}


@load_response.mistake("The derivative vanishes earlier: what is left of the load's own exponential at that time?")
def _(T, delay):
    return {"time": 2 * delay + T}


@load_response.mistake("What takes the load back goes through two lags: that of the process, and that of the loop.")
def _(K, T, delay, load):
    push = K * load
    return {"y": push * (_risen(t - delay, T) - _risen(t - 2 * delay, T))}


@load_response.mistake("The load enters at $t = 0$, but the temperature feels it one dead time later.")
def _(K, T, delay, load):
    push = K * load
    return {"y": push * (1 - exp(-t / T)) - _taken_back(push, T, delay)}


@load_response.mistake("The gain of the process is missing: the load is in percent, the deviation in K.")
def _(K, T, delay, load):
    if K != 1:
        y = load * _risen(t - delay, T) - _taken_back(load, T, 2 * delay)
        return {"y": y, "largest": float(load) * math.exp(-math.exp(-float(delay / T)))}


@load_response.mistake("One dead time passes until the load is seen, and another one until the action is felt.")
def _(T, delay):
    return {"time": float(delay) + float(T) * math.exp(-float(delay / T))}


@load_response.mistake("At that time the load is felt for the first time. When does the deviation turn?")
def _(delay):
    return {"time": delay}


load_response.hints(
    "The load and the controller's action are both steps that go through the process. When does each of them arrive?",
    "The load arrives at $\\theta$ and goes on like a lag. Its effect is taken back from $2\\theta$ on, by the lag of "
    "the process and the lag $T_C$ of the loop in series, which are equal here.",
    "With $\\tau_1 = t - {delay}$ and $\\tau_2 = t - {twice}$ the deviation is {push} K times $1 - e^{-\\tau_1/T}$ "
    "minus, from {twice} s on, $1 - (1 + \\tau_2/T)\\,e^{-\\tau_2/T}$. Where is its derivative zero?",
)


@load_response.shows
def _(K, delay, load):
    return {"push": f"{float(K * load):g}", "twice": f"{float(2 * delay):g}"}


@load_response.solution
def _(K, T, delay, load):
    r"""Without control the load of {load} would move the temperature by $K$ times as much, {far}, like a lag behind the
    dead time: ${push}\,(1 - e^{-(t - \theta)/T})$ from {delay} on.

    The loop takes it back from $2\theta$ on, {end}. From the load to the output the term that takes it back is
    $\frac{{K}}{(T s + 1)(T_C s + 1)}e^{-2\theta s}$, with $T_C = T$: a double lag, whose step response is
    $1 - (1 + \tau/T)\,e^{-\tau/T}$ with $\tau = t - 2\theta$.

    From $2\theta$ on, the difference is ${push}\left[(1 + \tau/T) - e^{-\theta/T}\right]e^{-\tau/T}$. Its derivative
    vanishes where $\tau/T = e^{-\theta/T}$, which is {x}. So the largest deviation is at $2\theta + T e^{-\theta/T}$,
    that is {time}.

    There the bracket is 1, and what is left is ${push}\,e^{-{x}}$, which is {largest}.

    The whole course is zero until {delay}, then $y(t) = {push}\,(1 - e^{-(t - {delay})/{T}})$, and from {end} on
    $y(t) = {push}\,(1 - e^{-(t - {delay})/{T}}) - {push}\left[1 - \left(1 + \frac{t - {end} }{ {T} }\right)e^{-(t -
    {end})/{T}}\right]$.
    """
    push = K * load
    return {
        "far": (push, "K"),
        "end": (2 * delay, "s"),
        "x": math.exp(-float(delay / T)),
    }


@load_response.solution_picture
def _(K, T, delay, load):
    """The deviation after the load: it grows for two dead times and a little longer, and then fades."""
    push, x = K * load, math.exp(-float(delay / T))
    y = push * Heaviside(t - delay) * (1 - exp(-(t - delay) / T)) - _taken_back(push, T, 2 * delay)
    plot = time_plot({"$y$": (y, "measurement")}, _until(2 * delay + 6 * T), "After the load", ylabel="deviation [K]")
    return plot.mark(float(2 * delay) + float(T) * x, "largest")


@exercise(
    "17.5",
    title="A pipe with two flows",
    points=6,
    insight="A predictor tolerates every error of its dead time below $T_C$: uncertainty is paid for with speed.",
    where=lambda K, T, volume, low, high: (
        Rational(5, 4) * low <= high <= 2 * low and 12 * K * _middle(volume, low, high)[1] >= T
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
    liquid spends in a pipe of {volume}. The flow is anything between {low} and {high}, and nobody measures it. So the
    model in the Smith predictor gets a constant dead time $\theta_m$: the one that is off by the same time at both ends
    of the range.

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
            draws=lambda controller: _size_of_M(K, T, off, controller),
        ),
    )


def _middle(volume, low, high):
    """The dead time in the middle, and how far it is off at either end."""
    longest, shortest = volume / low, volume / high
    return (longest + shortest) / 2, (longest - shortest) / 2


def _ISE_limit(model, off):
    return round(float(model + Rational(3, 5) * off), 2)


def _largest_M(K, T, off, controller):
    return float(np.max(_M(K, T, off, controller, np.geomspace(0.01, 50, 2000) / float(off))))


def _M(K, T, off, controller, w):
    """The size of M at the frequencies w."""
    K, T, off = float(K), float(T), float(off)
    L = np.array(_frequency(controller, 1j * w)) * K / (1j * T * w + 1)
    return abs(L / (1 + L)) * 2 * abs(np.sin(w * off / 2))


def _size_of_M(K, T, off, controller):
    w = _until(12 / off)[1:]
    curve = {"$|M(j\\omega)|$": (_M(K, T, off, controller, w), "measurement")}
    return time_plot(curve, w, "Your predictor", "$\\omega$ [rad/min]").level(0.8, "limit")


def _frequency(controller, jw):
    Kp, Ti, Td, Tf = (float(x) for x in (controller.Kp, controller.Ti, controller.Td, controller.Tf))
    integral = 0 if math.isinf(Ti) else 1 / (Ti * jw)
    return Kp * (1 + integral + Td * jw / (Tf * jw + 1))


def _servo_ISE(K, T, model, controller):
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    if Kp <= 0 or math.isinf(Ti):
        return math.inf
    return float(model) + pi_first_order(float(K), float(T), 0, Kp, Ti, unstable=math.inf)


@two_flows.shows
def _(volume, low, high):
    return {"limit": f"{_ISE_limit(*_middle(volume, low, high)):g} min"}


@two_flows.mistake(
    "That is the dead time at the mean flow. The dead time is not a linear function of the flow, so take the mean of "
    "the dead times."
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


@two_flows.mistake("That is right at one end of the range only, and off by the whole range at the other one.")
def _(volume, low):
    return {"model_delay": volume / low}


@two_flows.mistake("That is right at one end of the range only, and too short everywhere else.")
def _(volume, high):
    return {"model_delay": volume / high}


@two_flows.mistake("A dead time is the volume over the flow. Which unit has the flow over the volume?")
def _(volume, low, high):
    return {"model_delay": (low + high) / (2 * volume)}


@two_flows.mistake(
    "By so much the dead time is off at the ends of the range. In the middle of which two is the model's?"
)
def _(volume, low, high):
    return {"model_delay": _middle(volume, low, high)[1]}


@two_flows.mistake("That is the range of the dead times, from the shortest to the longest.")
def _(volume, low, high):
    return {"model_delay": 2 * _middle(volume, low, high)[1]}


@two_flows.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(K, T, volume, low, high):
    return {"controller": PID(T / _middle(volume, low, high)[1], T)} if K >= 2 or Rational(1, 2) >= K else {}


@two_flows.mistake("Inside the predictor there is no dead time: $T_C$ need not be as long as the whole of it.")
def _(K, T, volume, low, high):
    return {"controller": PID(T / (K * _middle(volume, low, high)[0]), T)}


@two_flows.mistake("That is Skogestad's rule for a loop with the dead time. Inside the predictor there is none.")
def _(K, T, volume, low, high):
    model = _middle(volume, low, high)[0]
    return {"controller": PID(T / (2 * K * model), min(T, 8 * model))}


two_flows.hints(
    "The dead time of a pipe is its volume divided by the flow. Which dead times are possible?",
    "The model takes the mean of the two *dead times*, and is off by half of their difference at both ends. If the "
    "controller cancels the lag, $T_0$ is a lag of $T_C$: compare $T_C$ with this error.",
    "The dead times are $\\frac{ {volume} }{ {low} }$ and $\\frac{ {volume} }{ {high} }$ min. Then $K_c = "
    "\\frac{{T}}{K\\,T_C}$ and $T_i = T$.",
)


@two_flows.solution
def _(K, T, volume, low, high):
    r"""The longest dead time is $\frac{ {volume} }{ {low} }$, which is {longest}, the shortest $\frac{ {volume} }{
    {high} }$, which is {shortest}. The model takes their mean, {model_delay}. At both ends it is off by half of their
    difference, {off}.

    A PI controller that cancels the lag makes $T_0$ a lag of $T_C$. Then
    $|M| = \frac{2\,|\sin(\omega\,\Delta\theta/2)|}{\sqrt{1 + (\omega T_C)^2}}$ with the error $\Delta\theta$ of {off}.
    For $T_C = \Delta\theta$ the largest value is {size}, below the 0.8 that is asked.

    The ISE with the right model is $\theta_m + \frac{T_C}{2}$, which is {value} and within the {limit}.

    So $T_C$ = {off} meets both: $K_c = \frac{{T}}{K\,T_C} = \frac{ {T} }{ {K} \cdot {off} }$, which is {gain}, and
    $T_i$ is {T}.
    """
    model, off = _middle(volume, low, high)
    controller = PID(T / (K * off), T)
    return {
        "longest": (volume / low, "min"),
        "shortest": (volume / high, "min"),
        "off": (off, "min"),
        "size": _largest_M(K, T, off, controller),
        "value": (model + off / 2, "min"),
        "gain": controller.Kp,
    }


@exercise(
    "17.6",
    title="A predictor that is taken by surprise",
    points=4,
    where=lambda T, delay, model: (
        delay / 4 <= abs(model - delay) <= Rational(3, 5) * delay and abs(model - delay) <= Rational(4, 5) * T
    ),
    insight="Where the control signal leaves its way, the model and the process first disagree: that is when to look.",
)
def surprise(
    K=between(0.5, 4, "", step=0.5, reference=2),
    T=between(4, 12, "min", step=1, reference=6),
    delay=between(4, 14, "min", step=0.5, reference=8),
    model=between(3, 20, "min", step=0.5, reference=5),
):
    r"""The weight of paper [%] is controlled by the stock valve [%] in front of the machine, with a Smith predictor.
    Gain and lag of the model are right: the gain is {K}, and the lag {T}. The PI controller inside cancels the lag,
    with $T_C = T$. With the right dead time, the valve would jump to its final position and stay there.

    But the machine runs at another speed now, and the dead time $\theta_m$ of the model is wrong. The picture shows a
    unit step of the setpoint at time zero. Read off the dead time of the process, and that of the model. Is the model's
    too short or too long? And how long should $T_C$ be at least, so that the chapter's rule of thumb, an error of the
    dead time below $T_C$, still covers such an error?
    (`t, y, u = exercise("17.6").given("t", "y", "u")` are the times, the weight and the valve.)
    """
    return answers(
        delay=number(delay, "min", "the dead time of the process", within=0.06),
        model_delay=number(model, "min", "the dead time of the model", within=0.06),
        model=word("too short" if model < delay else "too long", ["too short", "too long"], "the model's dead time is"),
        least_TC=number(abs(model - delay), "min", "the least $T_C$", within=0.2),
    )


def _with_wrong_dead_time(K, T, delay, model):
    """Times, output and control signal after a unit step of the setpoint, with the lag cancelled and T_C = T."""
    lag = first_order(K, T)
    predictor = feedback(PID(1 / K, T).expr, lag - lag * exp(-model * s))
    loop, times = Loop(lag * exp(-delay * s), predictor), np.linspace(0, float(3 * max(delay, model) + 2 * T), 601)
    return times, loop.servo.step(times), loop.setpoint_to_control.step(times)


@surprise.shows
def _(K, T, delay, model):
    return dict(zip("tyu", _with_wrong_dead_time(K, T, delay, model), strict=True))


@surprise.picture
def _(K, T, delay, model):
    """Above the weight, which waits and then rises; below the valve, which leaves its first position after a while."""
    times, y, u = _with_wrong_dead_time(K, T, delay, model)
    panels = [{"weight": (y, "measurement")}, {"valve": (u, "control signal")}]
    return time_plot(panels, times, "A unit step of the setpoint", "$t$ [min]", ["weight [%]", "valve [%]"])


@surprise.mistake("The measurement begins to move when the dead time of the process is over. What does the model know?")
def _(delay, model):
    return {"delay": model, "model_delay": delay}


@surprise.mistake("That is how long the surprise lasts. Count from the step of the setpoint.")
def _(delay, model):
    return {"model_delay": abs(model - delay)} if abs(abs(model - delay) / model - 1) > 0.15 else {}


def _as_long_as(which):
    def wrong(delay, model):
        whole = {"delay": delay, "model": model}[which]
        return {"least_TC": whole} if abs(whole / abs(model - delay) - 1) > Rational(1, 4) else {}

    return wrong


for _which in ("delay", "model"):
    surprise.mistake("The rule is about the *error* of the dead time: how far are the two apart?")(_as_long_as(_which))


@surprise.mistake("The range around a middle value has two halves. Here the whole error is known, and counts.")
def _(delay, model):
    return {"least_TC": abs(model - delay) / 2}


@surprise.mistake(
    "Which of the two dead times is the longer one, the model's or the process's? Where the model expects a response "
    "that does not come, the controller acts more: does the valve first open or close?"
)
def _(delay, model):
    return {"model": "too long" if model < delay else "too short"}


@surprise.mistake("That is where the weight is largest or halfway. Its dead time ends where it begins to rise.")
def _(T, delay):
    return {"delay": float(delay) + math.log(2) * float(T)}


@surprise.mistake("That is the lag. The rule compares $T_C$ with the error of the dead time.")
def _(T, delay, model):
    return {"least_TC": T} if abs(T / abs(model - delay) - 1) > Rational(1, 4) else {}


@surprise.mistake("That is both dead times together: a later corner of the valve. Look for the first two.")
def _(delay, model):
    return {"model_delay": delay + model, "delay": delay + model}


@surprise.mistake("That is about the exact limit of $|M| < 1$. Asked is the simple rule, which compares two times.")
def _(delay, model):
    return {"least_TC": 0.677 * float(abs(model - delay))}  # 2 |sin(x/2)| = |1 + 0.677 jx| at one x only


surprise.hints(
    "As long as model and process agree, the valve stays where it is. What is different when it moves?",
    "At the shorter of the two dead times, one of them responds and the other does not. If the model is first, the "
    "controller misses the response and opens the valve further. If the process is first, it closes it.",
    "The weight begins to rise at $\\theta$: read it above. Below there are two corners, one at $\\theta$ and one at "
    "$\\theta_m$. The rule asks that $|\\theta_m - \\theta| < T_C$.",
)


@surprise.solution
def _(delay, model):
    r"""**Process.** The weight begins to move at {delay}: that is the dead time of the process.

    **Model.** The valve stays at its first position as long as the measurement is what the model expects. It leaves it
    at {first}, and goes {way}: {why}. So the model's dead time is {model_}. The two corners of the valve are at
    {first} and {second}, one of them the dead time of the process, and the other one, {model_delay}, that of the model.

    **Rule.** A predictor tolerates every error of the dead time below its $T_C$. Here the error is
    $|\theta_m - \theta|$, that is {least_TC}. (The exact limit of $|M| < 1$ is somewhat lower.)
    """
    short = model < delay
    return {
        "first": (min(delay, model), "min"),
        "second": (max(delay, model), "min"),
        "way": "up" if short else "down",
        "why": "the model expects a response that the measurement does not show yet"
        if short
        else "the measurement responds although the model does not expect it yet",
        "model_": "too short" if short else "too long",
    }


@surprise.solution_picture
def _(K, T, delay, model):
    """The valve again, with the two corners marked: where the model responds, and where the process does."""
    times, _, u = _with_wrong_dead_time(K, T, delay, model)
    plot = time_plot({"valve": (u, "control signal")}, times, "Two corners", "$t$ [min]", "valve [%]")
    return plot.mark(delay, "process").mark(model, "model")
