"""Exercises of chapter 8, feedforward control."""

import itertools
import math

import numpy as np
from sympy import Symbol, ceiling, exp, sqrt, symbols

from loopbook import diagrams, signals
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    transfer_function,
    word,
)
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.pid import LowpassFilter


def _hot_flows(T_SP, T_c, T_h, before, more):
    """The hot flow after the rise, and what three mistakes make of it."""
    right = (before + more) * (T_SP - T_c) / (T_h - T_SP)
    too_far_down = (before + more) * (T_SP - T_c) / (T_h - T_c)
    upside_down = (before + more) * (T_h - T_SP) / (T_SP - T_c)
    return right, too_far_down, upside_down, more * (T_SP - T_c) / (T_h - T_SP)


def _near(wrong, right, by=0.03):
    """Whether one value can be taken for the other."""
    return abs(float(wrong) - float(right)) <= by * abs(float(right))


def _apart(values):
    """Whether no two of the values can be taken for one another."""
    return all(abs(x - y) > 0.03 * abs(x) for x, y in itertools.permutations(values, 2))


@exercise(
    "8.1",
    title="Wash water for the dairy",
    points=2,
    insight="A feedforward is a balance solved for what you can choose: it knows the plant as well as you do, and "
    "nothing more.",
    where=lambda T_SP, T_c, T_h, before, more: _apart(_hot_flows(T_SP, T_c, T_h, before, more)),
)
def wash_water(
    T_SP=between(40, 60, "°C", reference=48, step=2),
    T_c=between(6, 16, "°C", reference=8, step=1),
    T_h=between(70, 90, "°C", reference=72, step=2),
    before=between(2, 4, "kg/s", reference=3, step=0.2),
    more=between(0.4, 1.6, "kg/s", reference=0.9, step=0.1),
):
    """A dairy mixes wash water of {T_SP} from cold water of {T_c} and hot water of {T_h}. The cold flow $w_c$ [kg/s]
    is what another part of the plant leaves over: it is measured, but cannot be chosen. The hot flow $w_h$ [kg/s] is
    controlled. Both mix at once, and a kilogram of either holds the same heat for each kelvin.

    Find the feedforward from a heat balance: $w_h$ as a formula in $w_c$, in the setpoint $T_{{SP}}$ and in the
    temperatures $T_c$ and $T_h$ (write `w_c`, `T_SP`, `T_c`, `T_h`). The cold flow has been {before}, and rises by
    {more}. Which hot flow does it need now? And how warm is the wash water if the hot flow stays as it was?
    """
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    cold = before + more
    return answers(
        w_h=expression(_hot_flow(), "the feedforward as a formula"),
        w_new=number(_hot_flows(T_SP, T_c, T_h, before, more)[0], "kg/s", "the new hot flow"),
        T_without=number(
            (hot * T_h + cold * T_c) / (hot + cold), "°C", "the temperature without feedforward", within=0.005
        ),
    )


def _hot_flow():
    w_c, T_SP, T_c, T_h = symbols("w_c T_SP T_c T_h")
    return w_c * (T_SP - T_c) / (T_h - T_SP)


@wash_water.mistake("The hot water has to cool down to the setpoint only, not to the temperature of the cold water.")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, cold, hot = symbols("w_c T_SP T_c T_h")
    return {
        "w_h": w_c * (setpoint - cold) / (hot - cold),
        "w_new": _hot_flows(T_SP, T_c, T_h, before, more)[1],
    }


@wash_water.mistake("This ratio is upside down. Test it: the warmer the hot water, the less of it is needed.")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, cold, hot = symbols("w_c T_SP T_c T_h")
    return {
        "w_h": w_c * (hot - setpoint) / (setpoint - cold),
        "w_new": _hot_flows(T_SP, T_c, T_h, before, more)[2],
    }


@wash_water.mistake("Here numbers have been put in. Give the formula with all its symbols.")
def _(T_SP, T_c, T_h):
    return {"w_h": Symbol("w_c") * (T_SP - T_c) / (T_h - T_SP)}


@wash_water.mistake("This is the setpoint. But the cold flow has changed, and nothing has compensated for it.")
def _(T_SP):
    return {"T_without": T_SP}


@wash_water.mistake("The cold flow rises by {more}, from {before}. How large is it now?")
def _(T_SP, T_c, T_h, before, more):
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    return {"T_without": (hot * T_h + more * T_c) / (hot + more)}


@wash_water.mistake("That is the hot water for {more} of cold water. How large is the whole cold flow now?")
def _(T_SP, T_c, T_h, before, more):
    return {"w_new": _hot_flows(T_SP, T_c, T_h, before, more)[3]}


@wash_water.mistake("The temperature of a mixture is the mean of the two only if the flows are equal.")
def _(T_SP, T_c, T_h, before, more):
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    mixed = (hot * T_h + (before + more) * T_c) / (hot + before + more)
    return {"T_without": (T_h + T_c) / 2} if abs(mixed - (T_h + T_c) / 2) > 0.01 * mixed else {}


@wash_water.picture
def _(T_SP, T_c, T_h):
    """Cold and hot water are mixed; the cold flow is measured, and a feedforward sets the valve in the hot flow."""
    layout = """
        w_c   1   2  out
        .     FT  .  .
        T_SP  F   .  .
        w_h   V   3  ."""
    names = {"w_c": rf"$w_c$, ${T_c}$ °C", "w_h": rf"$w_h$, ${T_h}$ °C", "out": rf"${T_SP}$ °C", "T_SP": "$T_{SP}$"}
    parts = {"V": diagrams.control_valve(), "F": "Feed-\nforward"}
    return diagrams.instrumentation_diagram(layout, "w_c 1 2 out, w_h V 3 2", "1 FT F V, T_SP F", parts, names)


@wash_water.mistake("That is the hot flow from before. How large is the cold flow now?")
def _(T_SP, T_c, T_h, before):
    return {"w_new": before * (T_SP - T_c) / (T_h - T_SP)}


@wash_water.mistake("Heat counts by temperature *differences*: by how much does each of the two flows change?")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, hot = symbols("w_c T_SP T_h")
    wrong = (before + more) * T_SP / T_h
    is_near = _near(wrong, _hot_flows(T_SP, T_c, T_h, before, more)[0])
    return {"w_h": w_c * setpoint / hot} | ({} if is_near else {"w_new": wrong})


@wash_water.mistake("By what is the sum divided in a mean: by the flows of before, or by those that are mixed?")
def _(T_SP, T_c, T_h, before, more):
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    return {"T_without": (hot * T_h + (before + more) * T_c) / (hot + before)}


@wash_water.mistake("To which temperature does the hot water cool down? Not to that of ice.")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, cold, hot = symbols("w_c T_SP T_c T_h")
    return {"w_h": w_c * (setpoint - cold) / hot, "w_new": (before + more) * (T_SP - T_c) / T_h}


wash_water.hints(
    "What the hot water gives off, the cold water takes up: a heat balance at the place where they mix.",
    r"$w_h\,(T_h - T_{SP}) = w_c\,(T_{SP} - T_c)$: each flow times the temperature difference that *it* goes through. "
    "Solve it for the flow that you can choose.",
    "The hot water cools by ${T_h} - {T_SP}$ K and the cold water warms by ${T_SP} - {T_c}$ K. After the rise the "
    "cold flow is ${before} + {more}$ kg/s. For the last question, mix that with the hot flow from before.",
)


@wash_water.solution
def _(T_SP, T_c, T_h, before, more):
    r"""In a steady state the hot water gives off what the cold water takes up. Both end at the setpoint, so

    $$w_h\,(T_h - T_{SP}) = w_c\,(T_{SP} - T_c) \quad\Rightarrow\quad w_h = w_c\,\frac{T_{SP} - T_c}{T_h - T_{SP}}$$

    With the temperatures of the dairy the fraction is $\frac{ {T_SP} - {T_c} }{ {T_h} - {T_SP} } =$ {ratio}.

    ***

    The cold flow is now ${before} + {more} =$ {cold}. It needs ${cold} \cdot {ratio} =$ {w_new} of hot water.

    If the hot flow stays as it was, it is ${before} \cdot {ratio} =$ {hot}. The mixture then has the mean temperature,
    by flow:

    $$\frac{ {hot} \cdot {T_h} + {cold} \cdot {T_c} }{ {hot} + {cold} } = {T_without}\ \text{°C}$$
    """
    ratio = (T_SP - T_c) / (T_h - T_SP)
    return {"ratio": ratio, "cold": (before + more, "kg/s"), "hot": (before * ratio, "kg/s")}


@exercise(
    "8.2",
    title="A trolley against the wind",
    points=3,
    insight="Feedforward from the setpoint pays in advance for what is coming: friction for the speed, inertia for "
    "its change.",
    where=lambda m, v, rise, F_w: abs(m * v / rise - 2 * F_w) >= 50,
)
def trolley(
    m=between(500, 2000, "kg", reference=1200, step=100),
    D=between(40, 120, "N s/m", reference=80, step=10),
    v=between(2, 6, "m/s", reference=4, step=0.5),
    rise=between(4, 12, "s", reference=8, step=1),
    F_w=between(100, 600, "N", reference=200, step=50),
):
    """The trolley of a container crane has the mass $m$ [kg] and runs with the speed $v$ [m/s]. The motor pulls it with
    the force $F$ [N], which is the control signal. The friction is $D v$ [N], and head wind pushes it back with the
    force $F_w$ [N], which follows from a wind meter:

    $$m \\frac{{dv}}{{dt}} = F - D v - F_w$$

    Find the feedforward $F_f$ from setpoint and wind, as a formula in $m$, $D$, $F_w$, the setpoint $v_{{SP}}$ and its
    slope $a_{{SP}} = dv_{{SP}}/dt$ (write `m`, `D`, `F_w`, `v_SP`, `a_SP`).

    Now let $m$ = {m}, $D$ = {D} and $F_w$ = {F_w}. The setpoint rises evenly from zero to {v} within {rise}, and stays
    there. Which force does the feedforward ask for at the very end of the rise, and which one after it?
    """
    return answers(
        F_f=expression(_force(), "the feedforward as a formula"),
        F_rise=number(m * v / rise + D * v + F_w, "N", "the force at the end of the rise"),
        F_after=number(D * v + F_w, "N", "the force after the rise"),
    )


def _force(inertia=1, friction=1, wind=1):
    m, D, F_w, v_SP, a_SP = symbols("m D F_w v_SP a_SP")
    return inertia * m * a_SP + friction * D * v_SP + wind * F_w


@trolley.mistake(
    "The wind pushes the trolley back, so the motor needs more force and not less. Look at the sign of $F_w$."
)
def _(m, D, v, rise, F_w):
    if _near(D * v, F_w):  # the two cancel, as if both had been forgotten
        return {"F_f": _force(wind=-1)}
    return {"F_f": _force(wind=-1), "F_rise": m * v / rise + D * v - F_w, "F_after": D * v - F_w}


@trolley.mistake("At a constant speed this would be right. What does it take to become faster?")
def _(D, v, F_w):
    return {"F_f": _force(inertia=0), "F_rise": D * v + F_w}


@trolley.mistake("The friction is missing: what holds the trolley back even at a constant speed and without wind?")
def _(m, D, v, rise, F_w):
    if _near(D * v, 2 * F_w):  # the wrong sign of the wind makes the same forces
        return {"F_f": _force(friction=0)}
    return {"F_f": _force(friction=0), "F_rise": m * v / rise + F_w} | ({} if _near(D * v, F_w) else {"F_after": F_w})


@trolley.mistake("This is the feedforward from the setpoint alone. The disturbance is measured, so use it as well.")
def _(m, D, v, rise, F_w):
    numbers = {} if _near(D * v, F_w) else {"F_rise": m * v / rise + D * v, "F_after": D * v}
    return {"F_f": _force(wind=0)} | numbers


@trolley.mistake("Here numbers have been put in. Give the formula with all its symbols.")
def _(m, D, F_w):
    return {"F_f": m * Symbol("a_SP") + D * Symbol("v_SP") + F_w}


@trolley.mistake("After the rise the setpoint is constant. What is its slope then?")
def _(m, D, v, rise, F_w):
    return {"F_after": m * v / rise + D * v + F_w}


@trolley.picture
def _(v, rise):
    """The setpoint of the speed against time: an even rise from zero, then constant."""
    times = np.linspace(0, 2 * float(rise), 201)
    setpoint = np.minimum(times / float(rise), 1) * float(v)
    return time_plot({"$v_{SP}$": (setpoint, "setpoint")}, times, ylabel="speed [m/s]", low=True)


@trolley.mistake("That is the force for the acceleration alone. What else holds the trolley back at this moment?")
def _(m, v, rise):
    return {"F_rise": m * v / rise}


@trolley.mistake(
    "Against the wind the motor needs force at a constant speed, too, and so it does against the friction."
)
def _():
    return {"F_after": 0}


@trolley.mistake("That is the whole change of the speed. How much of it is there in each second?")
def _(m, D, v, rise, F_w):
    return {"F_rise": m * v + D * v + F_w}


@trolley.mistake("The friction holds the trolley back. Does the motor need more force because of it, or less?")
def _():
    return {"F_f": _force(friction=-1)}


@trolley.mistake("Friction and wind hold the trolley back. Does the motor need more force because of them, or less?")
def _(m, D, v, rise, F_w):
    return {"F_f": _force(friction=-1, wind=-1), "F_rise": m * v / rise - D * v - F_w}


trolley.hints(
    "Feedforward is the model solved for the control signal, with the setpoint in the place of the output.",
    r"Solve the equation for $F$, and put $v_{SP}$ for $v$ and its slope $a_{SP}$ for $\frac{dv}{dt}$. Everything "
    "that holds the trolley back needs force from the motor.",
    r"The setpoint rises with a slope of $\frac{ {v} }{ {rise} }$ m/s². At the very end of the rise the speed is {v} "
    "and this slope is still there; after it, only the speed is.",
)


@trolley.solution
def _(m, D, v, rise, F_w):
    r"""Solve the model for the force, and put the setpoint into it:

    $$F_f = m\,a_{SP} + D\,v_{SP} + F_w$$

    The motor must give the trolley its acceleration, overcome the friction, and hold against the wind.

    The setpoint rises with $a_{SP} = {v}/{rise} =$ {a}. At the very end of the rise it is {v}, so the three parts are
    ${m} \cdot {a} =$ {inertia}, ${D} \cdot {v} =$ {friction} and {F_w}, together {F_rise}.

    After the rise the slope is zero, and the first part is gone: {F_after}.
    """
    return {"a": (v / rise, "m/s²"), "inertia": (m * v / rise, "N"), "friction": (D * v, "N")}


@trolley.solution_picture
def _(m, D, v, rise, F_w):
    """The force that the feedforward asks for: it rises with the speed, and falls where the rise ends."""
    times = np.linspace(0, 2 * float(rise), 401)
    rising = times <= float(rise)
    speed = np.minimum(times / float(rise), 1) * float(v)
    force = float(m) * float(v / rise) * rising + float(D) * speed + float(F_w)
    panels = [{"$v_{SP}$": (speed, "setpoint")}, {"$F_f$": (force, "control signal")}]
    return time_plot(panels, times, ylabel=["speed [m/s]", "force [N]"], low=True)


@exercise(
    "8.3",
    title="Feedforward from two transfer functions",
    points=4,
    insight="The ideal feedforward divides the way of the disturbance by that of the control signal, and waits for "
    "the difference of the dead times.",
    where=lambda K, T, tau, K_d, T_d, tau_d, rise: (
        tau_d > tau and abs(T - T_d) >= 0.2 * T and rise * K_d <= 20 * K and rise * K_d * T <= 30 * K * T_d
    ),
)
def pasteuriser(
    K=between(0.4, 2, "K/%", reference=0.8, step=0.1),
    T=between(20, 60, "s", reference=40, step=5),
    tau=between(2, 10, "s", reference=4, step=1),
    K_d=between(4, 20, "K/(kg/s)", reference=12, step=1),
    T_d=between(10, 60, "s", reference=25, step=5),
    tau_d=between(4, 20, "s", reference=10, step=1),
    rise=between(0.2, 0.9, "kg/s", reference=0.5, step=0.1),
):
    """Milk is heated in a plate heat exchanger. Experiments gave two transfer functions. From the control signal of
    the steam valve [%] to the temperature [K]: a gain of {K}, a lag of {T} and a dead time of {tau}. From the milk
    flow [kg/s] to the temperature: a gain of minus {K_d}, a lag of {T_d} and a dead time of {tau_d}, so that more milk
    makes it colder. Changes are counted from a steady state.

    Which transfer function $F_{{fd}}(s)$ from milk flow to control signal is the ideal feedforward? The milk flow rises
    by {rise} in a step. By how much does the feedforward raise the control signal in the end? And by how much at the
    first moment when it acts?
    """
    return answers(
        F_fd=transfer_function(K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-(tau_d - tau) * s), "the feedforward"),
        u_end=number(rise * K_d / K, "%", "the change of the control signal in the end"),
        u_first=number(rise * K_d * T / (K * T_d), "%", "the first change of the control signal"),
    )


@pasteuriser.mistake("This feedforward is right only in the end. On the way there, the two lags differ.")
def _(K, K_d, tau, tau_d, rise):
    return {"F_fd": K_d / K * exp(-(tau_d - tau) * s), "u_first": rise * K_d / K}


@pasteuriser.mistake(
    "These are the gains alone: right in the end, but on the way there the lags and the dead times count."
)
def _(K, K_d):
    return {"F_fd": K_d / K}


@pasteuriser.mistake(
    "The two lags are interchanged. The lag of the transfer function in the denominator moves to the numerator."
)
def _(K, T, tau, K_d, T_d, tau_d, rise):
    F_fd = K_d * (T_d * s + 1) / (K * (T * s + 1)) * exp(-(tau_d - tau) * s)
    return {"F_fd": F_fd, "u_first": rise * K_d * T_d / (K * T)}


@pasteuriser.mistake(
    "The dead times do not add up. The milk flow needs its time to show; how long may the feedforward wait?"
)
def _(K, T, tau, K_d, T_d, tau_d):
    return {"F_fd": K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-(tau_d + tau) * s)}


@pasteuriser.mistake("The feedforward would come too late: the control signal needs a dead time of its own.")
def _(K, T, K_d, T_d, tau_d):
    return {"F_fd": K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-tau_d * s)}


@pasteuriser.mistake("This is for a rise of 1 kg/s. How large was the step?")
def _(K, T, K_d, T_d):
    return {"u_end": K_d / K, "u_first": K_d * T / (K * T_d)}


def _x(theta, P):
    """The phase that a measurement of that age is behind in a swing of that period, in rad."""
    return 2 * math.pi * float(theta / P)


@pasteuriser.picture
def _(K, T, tau, K_d, T_d, tau_d):
    """Steam valve and milk flow act on the temperature, each through its own transfer function; the two are added."""
    G = diagrams.block(rf"\frac{{{float(K):g}}}{{{T}s+1}}e^{{-{tau}s}}")
    G_d = diagrams.block(rf"\frac{{-{K_d}}}{{{T_d}s+1}}e^{{-{tau_d}s}}")
    return diagrams.block_diagram("u", G, diagrams.disturbance("d", G_d), "y")


@pasteuriser.mistake(
    "The fraction is upside down: the way of the disturbance is undone by dividing by that of the control signal."
)
def _(K, T, tau, K_d, T_d, tau_d, rise):
    F_fd = K * (T_d * s + 1) / (K_d * (T * s + 1)) * exp(-(tau_d - tau) * s)
    return {"F_fd": F_fd, "u_end": rise * K / K_d, "u_first": rise * K * T_d / (K_d * T)}


@pasteuriser.mistake("The two gains do not multiply. How much control signal makes up for one kelvin?")
def _(K, K_d, rise):
    return {"u_end": rise * K * K_d} if K != 1 else {}


@pasteuriser.mistake("The two gains do not multiply. How much control signal makes up for one kelvin?")
def _(K, T, tau, K_d, T_d, tau_d, rise):
    if K == 1:
        return {}
    F_fd = K * K_d * (T * s + 1) / (T_d * s + 1) * exp(-(tau_d - tau) * s)
    return {"F_fd": F_fd, "u_first": rise * K * K_d * T / T_d}


@pasteuriser.mistake("The lags are right. Which of the two gains belongs below the fraction line?")
def _(K, T, tau, K_d, T_d, tau_d, rise):
    F_fd = K / K_d * (T * s + 1) / (T_d * s + 1) * exp(-(tau_d - tau) * s)
    return {"F_fd": F_fd, "u_first": rise * K * T / (K_d * T_d)}


@pasteuriser.mistake("The feedforward divides by the way of the control signal. Where does its lag go?")
def _(K, T, tau, K_d, T_d, tau_d):
    return {"F_fd": K_d / (K * (T * s + 1) * (T_d * s + 1)) * exp(-(tau_d - tau) * s)}


@pasteuriser.mistake("The feedforward waits, that is true. How large is its change when it then begins to act?")
def _():
    return {"u_first": 0}


@pasteuriser.mistake("That is how many kelvins the milk becomes colder. How much control signal makes up for them?")
def _(K, K_d, rise):
    return {"u_end": rise * K_d} if K != 1 else {}


pasteuriser.hints(
    "The feedforward is ideal if the way from the milk flow through the control signal undoes the direct way.",
    "Call the way from the milk flow $H_d$ and that from the control signal $H_u$. Both end in the temperature: "
    r"$H_d\,d + H_u\,F_{fd}\,d = 0$, so $F_{fd} = -H_d/H_u$. The lag of the denominator moves to the numerator, and "
    "the dead times subtract. For a step, $s = 0$ gives the end and large $s$ the first moment.",
    r"The gains give $\frac{ {K_d} }{ {K} }$, the lags $\frac{ {T} s + 1}{ {T_d} s + 1}$, and the dead time that is "
    "left is ${tau_d} - {tau}$ s.",
)


@pasteuriser.solution
def _(K, T, tau, K_d, T_d, tau_d, rise):
    r"""The milk flow acts on the temperature directly, through $H_d$, and through the feedforward and the valve.
    Nothing is to be seen of it if $H_d + H_u F_{fd} = 0$, so

    $$F_{fd} = -\frac{H_d}{H_u} = \frac{ {K_d} }{ {K} } \cdot \frac{ {T} s + 1}{ {T_d} s + 1}\,e^{-({tau_d} - {tau})s}$$

    The disturbance needs {tau_d} to show, and the valve {tau}: the feedforward has to wait for the difference, {wait}.

    A rise of {rise}: in the end ($s = 0$) the control signal has risen by $\frac{ {K_d} }{ {K} } \cdot {rise} =$
    {u_end}. In the first moment (large $s$) the two lags count as well, with the ratio $\frac{ {T} }{ {T_d} }$:
    {u_first}.
    """
    return {"wait": (tau_d - tau, "s")}


@pasteuriser.solution_picture
def _(K, T, tau, K_d, T_d, tau_d, rise):
    """What the feedforward adds to the control signal after the step of the milk flow."""
    wait, T_d, end = float(tau_d - tau), float(T_d), float(rise * K_d / K)
    times = np.linspace(0, wait + 4 * T_d, 400)
    u = (times >= wait) * end * (1 + (float(T) / T_d - 1) * np.exp(-(times - wait) / T_d))
    plot = time_plot({"feedforward [%]": (u, "control signal")}, times, low=True)
    return plot.level(end, "in the end")


@exercise(
    "8.4",
    title="A ship in gusts",
    points=4,
    insight="A feedforward that is a sixth of a period late does nothing; later than that it does harm.",
    where=lambda k, theta, P: k != 1 and 0.7 <= _x(theta, P) <= 2.8 and abs(P - 6 * theta) >= 0.3 * theta,
)
def ship(
    e_0=between(2, 8, "m", reference=5, step=0.5),
    k=between(0.6, 1.4, reference=0.8, step=0.1),
    theta=between(4, 12, "s", reference=6, step=1),
    P=between(15, 90, "s", reference=45, step=5),
):
    """Thrusters hold a ship in its place, and a feedforward from the measured wind helps them. The wind comes in slow
    gusts, a sinusoid, and under feedback alone the position oscillates with an amplitude of {e_0}. What the feedforward
    does to the position is such a sinusoid, too, and the two are subtracted.

    First let the feedforward act at once, but with $k$ = {k} times the force that the wind calls for. Which amplitude
    is left? Then let the force be right, but {theta} late: so old is the measured wind when the computer gets it. The
    gusts have a period of {P}. The amplitude is now that of the difference between two equal sinusoids, one of them
    {theta} behind the other. (In a diagram of arrows: how long is the third side of a triangle with two sides of that
    length?) How large is it, and is that smaller or larger than without feedforward? Above which period does a
    feedforward that is so late always help?
    """
    return answers(
        e_wrong=number(abs(1 - k) * e_0, "m", "the amplitude with the wrong force"),
        e_late=number(2 * math.sin(_x(theta, P) / 2) * e_0, "m", "the amplitude with the late force"),
        compared=word(_compared(theta, P), ["smaller", "larger"], "that amplitude, compared with feedback alone"),
        P_min=number(6 * theta, "s", "the period above which it helps"),
    )


def _compared(theta, P):
    return "smaller" if 6 * theta < P else "larger"


@ship.mistake("That is what the feedforward removes. How much is left? (An amplitude has no sign.)")
def _(e_0, k):
    return {"e_wrong": k * e_0}


@ship.mistake("This is the factor by which the feedforward changes the amplitude. How many metres is that?")
def _(k, theta, P):
    return {"e_wrong": abs(1 - k), "e_late": 2 * math.sin(_x(theta, P) / 2)}


@ship.mistake("Here an angle in radians was put into a sine that takes degrees.")
def _(e_0, theta, P):
    return {"e_late": 2 * math.sin(math.radians(_x(theta, P) / 2)) * e_0}


@ship.mistake(
    "That holds for slow oscillations only. How long is the difference of two arrows of length one with that angle?"
)
def _(e_0, theta, P):
    return {"e_late": _x(theta, P) * e_0}


@ship.mistake("With one radian between them, wind and feedforward differ by less than the wind itself.")
def _(theta):
    return {"P_min": 2 * math.pi * theta}


@ship.mistake("At this period the feedforward is exactly opposite to what is needed. Where does it begin to do harm?")
def _(theta):
    return {"P_min": 2 * theta}


@ship.mistake("Compare the amplitude with the one under feedback alone.")
def _(theta, P):
    return {"compared": "larger" if _compared(theta, P) == "smaller" else "smaller"}


def _needed(u_0, u_full, d):
    return u_0 + (u_full - u_0) * d**2 / 10000


def _line(u_0, u_full, points, d):
    """What a table of so many points, evenly from 0 to 100, gives at d."""
    width = 100 / (points - 1)
    left = d // width * width
    low, high = _needed(u_0, u_full, left), _needed(u_0, u_full, left + width)
    return low + (high - low) * (d - left) / width


def _left_point(u_0, u_full, points, d):
    """The value of the table at its last point before d."""
    width = 100 / (points - 1)
    return _needed(u_0, u_full, d // width * width)


def _fewest(u_0, u_full, e_max):
    """The fewest points of a table whose largest error is at most e_max."""
    return ceiling(sqrt((u_full - u_0) / (4 * e_max))) + 1


@ship.mistake("A quarter of a period is an angle of 90°. How long is the third side of the triangle then?")
def _(theta):
    return {"P_min": 4 * theta}


@ship.mistake("Here the sine is that of the whole angle. Cut the triangle into two equal ones: which angle has each?")
def _(e_0, theta, P):
    wrong, right = 2 * math.sin(_x(theta, P)), 2 * math.sin(_x(theta, P) / 2)
    return {} if _near(wrong, right) else {"e_late": wrong * e_0}


@ship.mistake("That is a half of the third side: the triangle was cut into two equal ones.")
def _(e_0, theta, P):
    return {"e_late": math.sin(_x(theta, P) / 2) * e_0} if e_0 != 2 else {}


ship.hints(
    "What is left is a difference: what the wind does, minus what the feedforward does.",
    "With a wrong force it is the difference of two amplitudes. With a late one it is the difference of two equal "
    r"arrows with an angle between them, $x = 2\pi\theta/P$: the base of an isosceles triangle, $2 \sin\frac{x}{2}$ "
    "times its side.",
    r"The angle is $x = 2\pi \cdot \frac{ {theta} }{ {P} }$ (in radians). The base is as long as the sides when the "
    "triangle has three equal sides: which angle is that, and which share of a period?",
)


@ship.solution
def _(e_0, k, theta, P):
    r"""The feedforward takes away $k$ = {k} of what the wind does. So $|1 - {k}| \cdot {e_0} =$ {e_wrong} are left.

    If it is late by {theta}, the two sinusoids have the same amplitude and an angle of
    $x = 2\pi \cdot \frac{ {theta} }{ {P} } =$ {x} between them, or {degrees}.
    Their difference is the base of a triangle with two equal sides of {e_0}:

    $$2 \sin\frac{ {x} }{2} \cdot {e_0} = {e_late}\ \text{m}$$

    That is {compared} than the {e_0} of feedback alone.

    The base is as long as the sides in a triangle with three equal sides, at an angle of 60°, a sixth of a turn. So the
    late feedforward helps as long as $\theta$ is less than a sixth of the period, for periods above $6 \cdot {theta} =$
    {P_min}.
    """
    return {"x": (_x(theta, P), "rad"), "degrees": (math.degrees(_x(theta, P)), "°"), "compared": _compared(theta, P)}


@ship.solution_picture
def _(e_0, theta, P):
    """What the wind does, what the late feedforward does, and the difference of the two."""
    times = np.linspace(0, 2 * float(P), 400)
    turn = 2 * np.pi / float(P)
    wind, late = float(e_0) * np.sin(turn * times), float(e_0) * np.sin(turn * (times - float(theta)))
    curves = {"wind": (wind, "disturbance"), "feedforward": (late, 3), "difference": (wind - late, "measurement")}
    return time_plot(curves, times, ylabel="position [m]", low=True)


@exercise(
    "8.5",
    title="A table for a water main",
    points=4,
    insight="Half the width of the intervals, a quarter of the error: straight lines are good company for smooth "
    "curves.",
    where=lambda u_0, u_full, points, d, e_max: (
        d % (100 / (points - 1)) != 0
        and _apart((_line(u_0, u_full, points, d), _needed(u_0, u_full, d), _left_point(u_0, u_full, points, d)))
        and _fewest(u_0, u_full, e_max) > points
    ),
)
def water_main(
    u_0=between(20, 40, "%", reference=30, step=5),
    u_full=between(70, 95, "%", reference=90, step=5),
    points=between(3, 5, reference=3, step=1),
    d=between(10, 90, "m³/h", reference=30, step=5),
    e_max=between(0.2, 1, "%", reference=0.5, step=0.1),
):
    """A pump holds the pressure in a water main. The more the town consumes, the more pressure is lost on the way, with
    the square of the consumption $d$ [m³/h]. Without consumption the control signal must be {u_0}, at 100 m³/h it must
    be {u_full}, and in general {curve}, in %. But nobody in the control room knows this formula. The feedforward takes
    straight lines between {points} points of a table. The points are exact, and evenly spaced from $d$ = 0 to 100 m³/h.

    Which control signal does it give at a consumption of {d}? How large is its error at the worst consumption? And how
    many points does it take, at least, if the error is nowhere to be more than {e_max}?
    """
    return answers(
        u_f=number(_line(u_0, u_full, points, d), "%", "the control signal from the table"),
        e_worst=number((u_full - u_0) / (4 * (points - 1) ** 2), "%", "the largest error of the table"),
        N=number(_fewest(u_0, u_full, e_max), what="the number of points", within=0),
    )


@water_main.shows
def _(u_0, u_full):
    d = Symbol("d")
    return {"curve": u_0 + (u_full - u_0) * (d / 100) ** 2}


@water_main.mistake("This is what is needed at that consumption. The table has the curve at its points only.")
def _(u_0, u_full, d):
    return {"u_f": _needed(u_0, u_full, d)}


@water_main.mistake("This is the value of the point before. Between two points the feedforward is on a straight line.")
def _(u_0, u_full, points, d):
    return {"u_f": _left_point(u_0, u_full, points, d)}


@water_main.mistake("This is the value of the next point. Between two points the feedforward is on a straight line.")
def _(u_0, u_full, points, d):
    width = 100 / (points - 1)
    right = _needed(u_0, u_full, d // width * width + width)
    return {"u_f": right} if _apart((right, _line(u_0, u_full, points, d))) else {}


@water_main.mistake("This is the number of intervals. How many points do they need?")
def _(u_0, u_full, e_max):
    return {"N": _fewest(u_0, u_full, e_max) - 1}


@water_main.mistake(
    "With this many points the error is small enough, but fewer will do. How does it fall when the intervals become "
    "shorter?"
)
def _(u_0, u_full, points, e_max):
    # as if the error fell in proportion to the length of the interval
    N = math.ceil((u_full - u_0) / (4 * (points - 1) * e_max)) + 1
    return {"N": N} if _fewest(u_0, u_full, e_max) < N else {}


@water_main.picture
def _(u_0, u_full, points):
    """The needed control signal against the consumption, a curve, and the straight lines of the table."""
    d = np.linspace(0, 100, 201)
    at = np.linspace(0, 100, int(points))
    needed, known = (_needed(float(u_0), float(u_full), x) for x in (d, at))
    curves = {"needed": (needed, "process"), "table": (np.interp(d, at, known), "model")}
    names = {"xlabel": "$d$ [m³/h]", "ylabel": "control signal [%]"}
    return time_plot(curves, d, **names).points(at, known, "points")


@water_main.mistake("That is on a straight line from 0 to 100 m³/h. Between which of its points does the table go?")
def _(u_0, u_full, points, d):
    width = 100 / (points - 1)
    right = _needed(u_0, u_full, d // width * width + width)
    wrong = u_0 + (u_full - u_0) * d / 100
    is_apart = not (_near(wrong, right) or _near(wrong, _line(u_0, u_full, points, d)))
    return {"u_f": wrong} if is_apart else {}


@water_main.mistake(
    "The worst place is in the middle of an interval. How far is it from the points, and what about the square?"
)
def _(u_0, u_full, points):
    return {"e_worst": (u_full - u_0) / (points - 1) ** 2}


@water_main.mistake("How many intervals do so many points make?")
def _(u_0, u_full, points):
    return {"e_worst": (u_full - u_0) / (4 * points**2)}


@water_main.mistake("That is the error at this consumption. Where between two points is it largest?")
def _(u_0, u_full, points, d):
    error = _line(u_0, u_full, points, d) - _needed(u_0, u_full, d)
    return {} if _near(error, (u_full - u_0) / (4 * (points - 1) ** 2)) else {"e_worst": error}


@water_main.mistake("A part of an interval needs an interval of its own, and there is one point more than intervals.")
def _(u_0, u_full, e_max):
    return {"N": _fewest(u_0, u_full, e_max) - 2}


@water_main.mistake(
    "With this many points the error is small enough, but fewer will do. How large is it in the middle?"
)
def _(u_0, u_full, e_max):
    return {"N": ceiling(sqrt((u_full - u_0) / e_max)) + 1}


@water_main.mistake(
    "With this many points the error is small enough, but fewer will do. How large is it in the middle?"
)
def _(u_0, u_full, e_max):
    N = ceiling(sqrt((u_full - u_0) / e_max))
    return {"N": N} if _fewest(u_0, u_full, e_max) < N else {}


@water_main.mistake("How does the error of a parabola fall when the intervals become half as wide: to a half?")
def _(u_0, u_full, points):
    return {"e_worst": (u_full - u_0) / (4 * (points - 1))} if points < 5 else {}


water_main.hints(
    "Between two points the table is a straight line; at the points it is exact.",
    "Find the points on both sides of the consumption, and go the same share of the way between their values. The "
    "error of a straight line under a parabola is largest in the middle: for $a d^2$ and an interval of width $w$ it "
    "is $a w^2/4$.",
    r"The points are $w = \frac{100}{ {points} - 1}$ m³/h apart, and $a = \frac{ {u_full} - {u_0} }{100^2}$. For the "
    r"last question, find the least number of intervals $n$ with $\frac{ {u_full} - {u_0} }{4 n^2} \le {e_max}$, and "
    "count its points.",
)


@water_main.solution
def _(u_0, u_full, points, d, e_max):
    r"""The points are $100/({points} - 1) =$ {width} apart, so {d} is between {left} and {right}. There the curve gives
    {low} and {high}, and the table a share of $\frac{ {d} - {left} }{ {width} }$ of the way from the one to the other:
    {u_f}.

    The curve is a parabola, $a d^2$ with $a = ({u_full} - {u_0})/100^2$, above {u_0}. In an interval of width $w$ it is
    farthest from its straight line in the middle, by $a w^2/4$, and that is the same in all intervals:

    $$\frac{ {u_full} - {u_0} }{4 \cdot ({points} - 1)^2} = {e_worst}\ \%$$

    With $n$ intervals the error is $\frac{ {u_full} - {u_0} }{4 n^2}$. It is at most {e_max} for $n \ge$ {n}, so
    {intervals} intervals are needed, with one point more: {N}.
    """
    width = 100 / (points - 1)
    left = d // width * width
    return {
        "width": (width, "m³/h"), "left": (left, "m³/h"), "right": (left + width, "m³/h"),
        "low": (_needed(u_0, u_full, left), "%"), "high": (_needed(u_0, u_full, left + width), "%"),
        "n": math.sqrt((u_full - u_0) / (4 * e_max)), "intervals": _fewest(u_0, u_full, e_max) - 1,
    }  # fmt: skip


@exercise(
    "8.6",
    title="A filter for the feedforward",
    points=5,
    insight="A filter trades noise for delay; a feedforward that is behind by $T_f$ misses what came in during that "
    "time.",
    where=lambda A, jump, e_max, sigma, sigma_max: (
        1.5 <= float(A * e_max / jump / (sigma**2 / (2 * sigma_max**2))) <= 4
        and float(sigma**2 / (2 * sigma_max**2)) >= 3
    ),
)
def flow_filter(
    A=between(2, 10, "m²", reference=4, step=1),
    jump=between(4, 20, "L/s", reference=10, step=1),
    e_max=between(10, 60, "mm", reference=30, step=5),
    sigma=between(0.5, 3, "L/s", reference=1, step=0.1),
    sigma_max=between(0.1, 0.6, "L/s", reference=0.3, step=0.05),
):
    """The feedforward of a level control sets the inflow of a tank equal to the measured outflow. The tank has an area
    of {A}. The flow is measured once a second, with a noise of {sigma} (standard deviation). If it went straight into
    the inflow, the valve would not live long. So the measurement passes a lowpass filter with the time constant $T_f$
    [s]. Take the share of the noise that it leaves as $\\sqrt{h/(2 T_f)}$, where $h$ is the time between two samples.

    Choose $T_f$ such that two demands are met:

    - The noise in the feedforward has a standard deviation of at most {sigma_max}.
    - When the outflow rises by {jump} in a step, the level falls by at most {e_max}, by the feedforward alone.

    Any time constant that meets both is right.
    """
    low, high = float(sigma**2 / (2 * sigma_max**2)), float(A * e_max / jump)
    return answers(
        T_f=design(
            number(round(math.sqrt(low * high), 2), "s", "the time constant of the filter"),
            criterion("it is positive", lambda T_f: T_f > 0, otherwise="a time constant is more than zero"),
            criterion(
                "the noise in the feedforward", lambda T_f: _noise(sigma, T_f), below=float(sigma_max), unit="L/s"
            ),
            criterion("the fall of the level", lambda T_f: float(jump / A) * T_f, below=float(e_max), unit="mm"),
            draws=lambda T_f: _fall_and_noise(float(T_f), *map(float, (A, jump, e_max, sigma, sigma_max))),
        )
    )


def _noise(sigma, T_f):
    """The standard deviation behind the filter, which leaves all of it if it is very quick."""
    return float(sigma) * math.sqrt(min(1, 1 / (2 * T_f)))


@flow_filter.mistake("The noise falls with the square root of the time constant, not in proportion to it.")
def _(sigma, sigma_max):
    return {"T_f": sigma / (2 * sigma_max)}


def _fall_and_noise(T_f, A, jump, e_max, sigma, sigma_max):
    """The level after the jump of the outflow and the noise behind a filter, with their limits."""
    T_f, times = max(T_f, 0), np.arange(0, 300.0)
    lag = 1 - np.exp(-times / T_f) if T_f else np.ones(len(times))
    lowpass = LowpassFilter(T_f, 1)
    lowpass.update(0)
    record = np.array([lowpass.update(x) for x in signals.noise(times, sigma, seed=1)])
    panels = [{"level": (-jump / A * T_f * lag, "measurement")}, {"noise": (record, "raw")}]
    names = ["change of the level [mm]", "noise [L/s]"]
    plot = time_plot(
        panels, times, "With your filter", ylabel=names, ylim=[(-2 * e_max, 0), (-4 * sigma_max, 4 * sigma_max)]
    )
    return plot.level(-e_max, "at most", "level").level(sigma_max, "standard deviation, at most", "noise")


@flow_filter.mistake(
    "The fall of the level is a volume over an area: the outflow that the filter has not yet shown, over $A$."
)
def _(A, jump, e_max):
    return {"T_f": A * e_max / jump / 60}


@flow_filter.mistake("The share that is left is under a square root. What remains of the 2 when you square it?")
def _(sigma, sigma_max):
    return {"T_f": sigma**2 / (4 * sigma_max**2)}


@flow_filter.mistake("The share that is left has a 2 under its root. What becomes of it when you solve for $T_f$?")
def _(A, jump, e_max, sigma, sigma_max):
    T_f = sigma**2 / sigma_max**2
    return {"T_f": T_f} if T_f > 1.02 * A * e_max / jump else {}


@flow_filter.mistake("Look at the units: one litre on one square metre is how high?")
def _(A, jump, e_max):
    return {"T_f": A * e_max / jump / 1000}


flow_filter.hints(
    "Noise asks for a slow filter, the level for a quick one: one demand is a lower limit of the time constant, the "
    "other an upper one.",
    r"Noise: $\sigma \sqrt{h/(2 T_f)} \le \sigma_{max}$ with $h$ = 1 s. Level: the feedforward is behind the outflow "
    "by the filter, so a volume of *jump times $T_f$* is missing in the end, and the level falls by that over the "
    "area.",
    r"Square ${sigma} \cdot \sqrt{\frac{1}{2 T_f}} \le {sigma_max}$ and solve it for $T_f$: a limit from below. From "
    r"above, ${jump} \cdot T_f/{A} \le {e_max}$ mm (1 L/m² is 1 mm).",
)


@flow_filter.solution
def _(A, jump, e_max, sigma, sigma_max):
    r"""The noise behind the filter is ${sigma} \cdot \sqrt{1/(2 T_f)}$, with $T_f$ in seconds, and must not exceed
    {sigma_max}:

    $$T_f \ge \frac{ {sigma}^2}{2 \cdot {sigma_max}^2} = {least}\ \text{s}$$

    After the step the inflow follows the outflow only with the lag $T_f$. What is missing of it, {jump} times
    $e^{-t/T_f}$, adds up to {jump} times $T_f$. The tank has lost this volume, so the level has fallen by
    ${jump}\,T_f/{A}$, in mm (1 L on 1 m² is 1 mm):

    $$T_f \le \frac{ {A} \cdot {e_max} }{ {jump} } = {most}\ \text{s}$$

    Any time constant between the two will do, for example {T_f}.
    """
    return {"least": sigma**2 / (2 * sigma_max**2), "most": A * e_max / jump}


FAULTS = ["too weak", "too strong", "too late", "too early"]


def _faults(kind, order):
    """The fault of each day: {letter: word}."""
    return dict(sorted(zip(order, (kind, "too late", "too early"), strict=True)))


def _days(drop, share, T, shift, kind, order):
    """Times and temperatures: without feedforward, and on the three days, each with its fault."""
    drop, share, T, shift = map(float, (drop, share, T, shift))
    times = np.linspace(0, 8 * T, 401)
    begins = shift + 0.5 * T  # so that even what comes too early comes after the step

    def pushed(moment):
        x = np.maximum(times - moment, 0) / T
        return drop * (1 - np.exp(-x) * (1 + x))

    gain = 1 - share if kind == "too weak" else 1 + share
    by_fault = {
        kind: gain * pushed(begins), "too late": pushed(begins + shift), "too early": pushed(begins - shift)
    }  # fmt: skip
    days = {letter: by_fault[fault] - pushed(begins) for letter, fault in _faults(kind, order).items()}
    return times, {"without": -pushed(begins)} | days


@exercise(
    "8.7",
    title="Three days of feedforward",
    points=4,
    where=lambda T, shift: 0.3 * T <= shift <= 0.6 * T,
    insight="A wrong gain is seen in the end, a wrong timing on the way: look at both before you change anything.",
)
def three_days(
    drop=between(4, 20, "K", reference=10, step=1),
    share=choice(0.25, 0.3, 0.35, 0.4, reference=0.3),
    T=between(20, 80, "s", reference=40, step=5),
    shift=between(6, 48, "s", reference=20, step=2),
    kind=choice("too weak", "too strong"),
    order=choice("ABC", "ACB", "BAC", "BCA", "CAB", "CBA", reference="CAB"),
):
    """Milk is heated with steam, and a feedforward from the milk flow moves the steam valve. On three days it was
    tested with the feedback switched off: at $t = 0$ the milk flow rose by the same step, which makes the milk colder.
    The picture shows the change of the temperature on the three days A, B and C, and for comparison what happened
    without feedforward. Each time something else was set wrongly: the gain of the feedforward, or its timing.

    What was wrong on each of the days: was the feedforward too weak, too strong, too late or too early? On the day with
    the wrong gain, by which factor does this gain have to be multiplied? (`t, A, B, C, without =
    exercise("8.7").given("t", "A", "B", "C", "without")` are the curves.)
    """
    faults = _faults(kind, order)
    return answers(
        A=word(faults["A"], FAULTS, "the feedforward of day A"),
        B=word(faults["B"], FAULTS, "the feedforward of day B"),
        C=word(faults["C"], FAULTS, "the feedforward of day C"),
        factor=number(1 / _given_share(share, kind), what="the factor for the wrong gain", within=0.05),
    )


def _given_share(share, kind):
    """What the feedforward with the wrong gain gives, as a share of what is needed."""
    return 1 - share if kind == "too weak" else 1 + share


@three_days.shows
def _(drop, share, T, shift, kind, order):
    times, curves = _days(drop, share, T, shift, kind, order)
    return {"t": times} | curves


@three_days.picture
def _(drop, share, T, shift, kind, order):
    """The change of the temperature on three days, A, B and C, and without feedforward; the milk flow steps at zero."""
    times, curves = _days(drop, share, T, shift, kind, order)
    drawn = {"without": (curves["without"], "raw")} | {letter: (curves[letter], n) for n, letter in enumerate("ABC")}
    return time_plot(drawn, times, ylabel="change of temperature [K]")


def _taken(day, fault, gain_is_wrong):
    """A mistake: a fault that was not that of the day, where the gain was wrong, or where the timing was."""

    def mistake(kind, order):
        right = _faults(kind, order)[day]
        return {day: fault} if right != fault and (right == kind) == gain_is_wrong else {}

    return mistake


for _day in "ABC":
    for _fault in FAULTS:
        _of_gain = _fault in FAULTS[:2]
        three_days.mistake(
            "In the end the curve is on one side of zero. Is that the side to which the milk flow pushes, or the "
            "other one?"
            if _of_gain
            else "A wrong timing is over when everything has settled. Where is this curve in the end?"
        )(_taken(_day, _fault, gain_is_wrong=True))
        three_days.mistake(
            "A wrong gain leaves an error that lasts. What is left of this curve in the end?"
            if _of_gain
            else "Look at the first movement: does it go the way in which the milk flow pushes, or the other way?"
        )(_taken(_day, _fault, gain_is_wrong=False))


@three_days.mistake(
    "That is what the feedforward gives now, as a share of what is needed. By which factor does it have to change?"
)
def _(share, kind):
    return {"factor": _given_share(share, kind)}


@three_days.mistake(
    "That is the error that is left, as a share of the one without feedforward. What does the feedforward give?"
)
def _(share):
    return {"factor": share}


@three_days.mistake(
    "The error is a share of what is *needed*, not of what the feedforward gives now. Which of them is the whole?"
)
def _(share, kind):
    return {"factor": 2 - _given_share(share, kind)}


@three_days.mistake("Divide by what the feedforward gives, not by what is left of the error.")
def _(share):
    return {"factor": 1 / share}


three_days.hints(
    "Look at the end first: a wrong gain leaves an error that lasts, a wrong timing does not.",
    "Where the error lasts, compare its sign with that of the curve without feedforward: the same sign, and the "
    "feedforward gave too little. Where it does not last, look at the first movement: who came first, the cold or the "
    "steam?",
    "On the day with the lasting error, read both end values. The feedforward has taken away the difference between "
    "them; it should have taken away all of the curve without feedforward.",
)


@three_days.solution
def _(drop, share, kind, order):
    r"""Two of the curves come back to zero: their gain was right, and only the timing was wrong. On day {late} the
    temperature falls first, as the milk flow wants it: the steam came too late. On day {early} it rises first: the
    steam came before the cold, too early.

    On day {lasting} an error of {end} lasts. Without feedforward it was {without_end}. The two signs are {compared}, so
    the feedforward was {kind}. It has moved the temperature by ${end} - ({without_end}) =$ {moved}, where {drop} were
    needed: that is {given} of it. So its gain has to be multiplied by $\frac{1}{ {given} } =$ {factor}.
    """
    lasting, late, early = order
    given = _given_share(share, kind)
    return {
        "lasting": lasting, "late": late, "early": early, "kind": kind, "given": given,
        "end": (-drop * (1 - given), "K"), "without_end": (-drop, "K"), "moved": (drop * given, "K"),
        "compared": "the same" if kind == "too weak" else "different",
    }  # fmt: skip
