"""Exercises of chapter 6, dynamic characteristics."""

from math import exp as exponential
from math import log as logarithm

import numpy as np
from sympy import E, Heaviside, exp, log

from loopbook import diagrams, signals
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    number,
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import time_plot


@exercise(
    "6.1",
    title="Before the tank runs over",
    points=2,
    insight="An integrator has no final value: the smallest difference that lasts fills the tank, and only its speed "
    "is known.",
    where=lambda q_in, q_out, start, top: q_in >= q_out + 2 and top >= start + 0.5,
)
def runs_over(
    A=between(2, 12, "m²", reference=5, step=0.5),
    q_in=between(6, 25, "L/s", reference=12, step=1),
    q_out=between(2, 12, "L/s", reference=8, step=1),
    start=between(0.5, 2, "m", reference=1.2, step=0.1),
    top=between(1.5, 4, "m", reference=2.4, step=0.1),
):
    """A tank with an area of {A} receives {q_in} of water, and a pump takes out just as much. The level is {start}.
    Then the pump is throttled to {q_out}. Take the net inflow [m³/s] as the input and the level [m] as the output.
    Which gain does this integrator have? How fast does the level rise, and after which time does it reach the rim at
    {top}?
    """
    rate = (q_in - q_out) / A  # 1 L/m² is 1 mm
    return answers(
        K=number(1 / A, "1/m²", "the gain of the integrator"),
        rate=number(rate, "mm/s", "the speed at which the level rises"),
        t_full=number(1000 * (top - start) / rate, "s", "the time until the tank is full"),
    )


@runs_over.mistake("The pump still takes something out. Only the difference of the flows fills the tank.")
def _(A, q_in, start, top):
    return {"rate": q_in / A, "t_full": 1000 * (top - start) * A / q_in}


@runs_over.mistake("The tank is not empty at the beginning. How far does the level still have to rise?")
def _(A, q_in, q_out, top):
    return {"t_full": 1000 * top * A / (q_in - q_out)}


@runs_over.mistake("That is the volume that flows in. The level rises by the volume divided by the area.")
def _(q_in, q_out, start, top):
    return {"rate": q_in - q_out, "t_full": 1000 * (top - start) / (q_in - q_out)}


@runs_over.mistake(
    "What is the unit of the inflow? With one cubic metre per second more, how fast would the level rise?"
)
def _(A):
    return {"K": 1 / A / 1000}


@runs_over.picture
def _(q_in, q_out, start, top):
    """A tank with a level; water flows in from above, and a pump takes it out."""
    layout = """
        q_in  1     .     .
        .     tank  .     .
        .     2     pump  q_out"""
    parts = {"tank": diagrams.tank(level="h", filled=float(0.9 * start / top)), "pump": diagrams.pump()}
    names = {"q_in": f"${q_in}$ L/s", "q_out": f"${q_out}$ L/s"}
    return diagrams.instrumentation_diagram(layout, "q_in 1 tank 2 pump q_out", "", parts, names)


@runs_over.mistake("That is what the pump still takes out. What is left in the tank of what flows in?")
def _(A, q_in, q_out, start, top):
    rate = q_out / A
    if _near(q_out, q_in - q_out):
        return {}
    return {"rate": rate, "t_full": 1000 * (top - start) / rate}


@runs_over.mistake("One of the two flows fills the tank, the other one empties it. Do they add up?")
def _(A, q_in, q_out, start, top):
    return {"rate": (q_in + q_out) / A, "t_full": 1000 * (top - start) * A / (q_in + q_out)}


@runs_over.mistake("Does the level rise faster or more slowly if the tank is larger?")
def _(A, q_in, q_out):
    return {"rate": (q_in - q_out) * A}


@runs_over.mistake("That is the way from the bottom to the level. Which way does the level have to go?")
def _(A, q_in, q_out, start, top):
    return {} if _near(start, top - start) else {"t_full": 1000 * start * A / (q_in - q_out)}


runs_over.hints(
    "A tank adds up what flows in and does not flow out: its volume changes by the net inflow.",
    r"The volume is area times level, so $A\,\frac{dh}{dt} = q_{in} - q_{out}$. Compare this with an integrator, "
    r"$\frac{dh}{dt} = K u$. Then the level rises along a straight line from where it is now.",
    r"The net inflow is ${q_in} - {q_out}$ L/s, and 1 L on 1 m² is 1 mm high. The level has ${top} - {start}$ m to go.",
)


@runs_over.solution
def _(A, q_in, q_out, start, top):
    r"""In each second the volume grows by the net inflow, and the volume is $A h$. So $A\,\frac{dh}{dt} = q$, or
    $\frac{dh}{dt} = \frac{1}{{A}}\,q$: an integrator with the gain $K = 1/{A} =$ {K}.

    The net inflow is ${q_in} - {q_out} =$ {net}. One litre on one square metre is 1 mm high, so the level rises by
    ${net}/{A} =$ {rate}.

    ***

    To the rim there are ${top} - {start} =$ {way}, which is {way_mm}. At this speed they take
    ${way_mm}/{rate} =$ {t_full}, or about {minutes}.
    """
    net, way = q_in - q_out, top - start
    return {
        "net": (net, "L/s"), "way": (way, "m"), "way_mm": (1000 * way, "mm"),
        "minutes": (1000 * way * A / net / 60, "min"),
    }  # fmt: skip


@exercise(
    "6.2",
    title="Half of the way",
    points=2,
    insight="Half of the way takes 0.69 time constants: any point of the response gives the time constant, not only "
    "63 %.",
)
def half_way(
    u_1=between(20, 45, "%", reference=40, step=5),
    du=between(5, 20, "%", reference=10, step=5),
    y_1=between(40, 70, "°C", reference=55, step=1),
    dy=between(6, 30, "K", reference=18, step=1),
    t_half=between(2, 15, "min", reference=7, step=0.5),
):
    """Steam warms the air of a dryer. The steam valve was at {u_1}, and the air at {y_1}. Then the valve was opened
    further, to {u_2}. In the end the air was {dy} warmer, and half of this way was behind it after {t_half}. Take the
    dryer for a time constant system, and find its gain and its time constant. Which temperature did the air have one
    time constant after the step?
    """
    return answers(
        K=number(dy / du, "K/%", "the gain"),
        T=number(t_half / log(2), "min", "the time constant"),
        y_T=number(y_1 + (1 - 1 / E) * dy, "°C", "the temperature after one time constant", within=0.005),
    )


@half_way.shows
def _(u_1, du):
    return {"u_2": f"{u_1 + du}\N{NO-BREAK SPACE}%"}


@half_way.mistake("By how much has the valve been opened? The gain is a ratio of changes.")
def _(u_1, du, dy):
    return {"K": dy / (u_1 + du)}


@half_way.mistake("The gain is a ratio of changes. You have divided the values after the step.")
def _(u_1, du, y_1, dy):
    return {"K": (y_1 + dy) / (u_1 + du)} if not _near((y_1 + dy) / (u_1 + du), dy / du) else {}


@half_way.mistake("After one time constant more than half of the way is covered. At which moment is it exactly half?")
def _(t_half):
    return {"T": t_half}


@half_way.mistake(
    "Half of the way is covered before one time constant has passed. On which side does the logarithm belong?"
)
def _(t_half):
    return {"T": t_half * log(2)}


@half_way.mistake("The response is not a straight line, so proportion does not take you from half of the way to 63 %.")
def _(t_half):
    return {"T": t_half * (1 - 1 / E) / 0.5}


@half_way.mistake("The air does not start at zero: that is the change, or a share of the whole. Where does it start?")
def _(y_1, dy):
    return {"y_T": (1 - 1 / E) * dy}


@half_way.mistake("The way is counted from the old temperature, not from zero.")
def _(y_1, dy):
    return {"y_T": (1 - 1 / E) * (y_1 + dy)}


@half_way.mistake(
    "You have used the share that is still missing. Which share of the way is covered, and which is left?"
)
def _(y_1, dy):
    return {"y_T": y_1 + dy / E}


def _near(wrong, right):
    return abs(float(wrong) / float(right) - 1) < 0.03


@half_way.mistake("The gain is a ratio of changes. You have divided the values before the step.")
def _(u_1, du, y_1, dy):
    return {"K": y_1 / u_1} if not _near(y_1 / u_1, dy / du) else {}


@half_way.mistake("Twice the time to the half takes it to three quarters: each such time halves what is still missing.")
def _(t_half):
    return {"T": 2 * t_half}


@half_way.mistake("That is the temperature in the end. How much of the way is gone after one time constant?")
def _(y_1, dy):
    return {"y_T": y_1 + dy}


@half_way.mistake("After one time constant more than half of the way is gone. Which share is it?")
def _(y_1, dy):
    return {"y_T": y_1 + dy / 2}


@half_way.mistake("That is the whole change. How much of it does one percent of the valve make?")
def _(dy):
    return {"K": dy}


@half_way.mistake("The gain is a ratio of changes. By how much has the temperature *changed*?")
def _(du, y_1, dy):
    return {"K": (y_1 + dy) / du}


@half_way.mistake("The time was divided by the share at one time constant. Which share is reached at the half?")
def _(t_half):
    return {"T": t_half / (1 - 1 / E)}


half_way.hints(
    "The gain is a ratio of changes. And a lag goes the same share of its way in the same time, whatever the step is.",
    r"The step response of a lag is $K U\,(1 - e^{-t/T})$. It has gone half of its way when $e^{-t/T} = \frac{1}{2}$, "
    "and $1 - e^{-1}$ of it at $t = T$. Count temperatures from where the air was before.",
    r"The valve was opened by {du}, and that made the air {dy} warmer. At the half, $e^{-{t_half}/T} = 0.5$: take the "
    r"logarithm on both sides, and solve for $T$.",
)


@half_way.solution
def _(u_1, du, y_1, dy, t_half):
    r"""The valve was opened by {du} and the air became {dy} warmer, so $K = {dy}/{du} =$ {K}.

    Half of the way is left when $e^{-t/T} = 0.5$, that is at $t = T \ln 2 = 0.693\,T$. So
    $T = \frac{ {t_half} }{\ln 2} =$ {T}.

    After one time constant the air has gone $1 - e^{-1} = 63.2\ \%$ of its way. It started at {y_1}, so it was at
    ${y_1} + 0.632 \cdot {dy} =$ {y_T}.
    """
    return {}


@half_way.solution_picture
def _(y_1, dy, t_half):
    """The temperature of the air against time, with the points at half of the way and at 63 % of it."""
    T = t_half / log(2)
    curve = {"air": (y_1 + dy * (1 - exp(-t / T)), "measurement")}
    plot = time_plot(curve, np.linspace(0, 5 * float(T), 201), xlabel="$t$ [min]", ylabel="temperature [°C]", low=True)
    return plot.mark(t_half, "half of the way").mark(T, "63 %, at $T$")


@exercise(
    "6.3",
    title="Brine, a stirred tank and a long pipe",
    points=3,
    insight="Mixing makes a lag and flowing makes a delay; both are volume over flow, so that less flow makes "
    "everything slower.",
    where=lambda V, V_pipe: 2 * V_pipe <= V <= 10 * V_pipe,
)
def brine(
    V=between(200, 1200, "L", reference=600, step=50),
    V_pipe=between(30, 250, "L", reference=120, step=10),
    F=between(20, 80, "L/min", reference=40, step=5),
    less=choice(20, 25, 40, 50, reference=25, unit="%"),
):
    """Brine flows through a stirred tank that holds {V}, and then through a pipe that holds {V_pipe}, without being
    mixed there. The flow is {F}. The tank is always full. Give the transfer function from the salt concentration of
    the inflow to that at the end of the pipe, with the time in minutes. The concentration of the inflow steps to a
    new value: after which time has half of the change arrived at the end of the pipe? And after which time, if the
    flow is {less} smaller?
    """
    T, delay = V / F, V_pipe / F
    half = delay + T * log(2)
    return answers(
        H=transfer_function(exp(-delay * s) / (T * s + 1), "the transfer function"),
        t_half=number(half, "min", "the time until half of the change has arrived"),
        t_slow=number(half / (1 - less / 100), "min", "that time with the smaller flow"),
    )


@brine.mistake("In the tank the brine is mixed, in the pipe it only travels. Which of the two makes the delay?")
def _(V, V_pipe, F):
    return {"H": exp(-V / F * s) / (V_pipe / F * s + 1), "t_half": V / F + V_pipe / F * log(2)}


@brine.mistake("That is right with the time in seconds. In the transfer function, too, it should be in minutes.")
def _(V, V_pipe, F):
    return {"H": exp(-60 * V_pipe / F * s) / (60 * V / F * s + 1)}


@brine.mistake("The pipe does not mix. It is not a lag: the brine arrives unchanged, but later.")
def _(V, V_pipe, F):
    return {"H": 1 / ((V / F * s + 1) * (V_pipe / F * s + 1)), "t_half": (V + V_pipe) / F * log(2)}


@brine.mistake("That is the time for the tank alone. The brine has to pass the pipe as well.")
def _(V, F):
    return {"t_half": V / F * log(2)}


@brine.mistake("After the delay and one time constant, more than half of the change has arrived.")
def _(V, V_pipe, F):
    return {"t_half": (V + V_pipe) / F}


@brine.mistake("With less flow everything takes longer. Which flow do time constant and delay contain, and where?")
def _(V, V_pipe, F, less):
    return {"t_slow": (V_pipe + V * log(2)) / F * (1 - less / 100)}


@brine.mistake(
    "The times are inversely proportional to the flow. So they grow by a larger percentage than the one by which the "
    "flow falls."
)
def _(V, V_pipe, F, less):
    return {"t_slow": (V_pipe + V * log(2)) / F * (1 + less / 100)}


@brine.picture
def _(V, V_pipe, F):
    """Brine flows through a stirred tank and then through a long pipe."""
    stirred, pipe = diagrams.tank(f"${V}$ L", stirrer=True), f"Pipe\n${V_pipe}$ L"
    layout = """
        F   tank  pipe  c"""
    names = {"F": f"${F}$ L/min", "c": "out"}
    return diagrams.instrumentation_diagram(layout, "F tank pipe c", "", {"tank": stirred, "pipe": pipe}, names)


@brine.mistake("The tank does not follow a straight line: half of the change takes more than half of a time constant.")
def _(V, V_pipe, F):
    return {"t_half": (V_pipe + V / 2) / F}


@brine.mistake("The delay is right, but the tank does not add up salt forever: what flows in also flows out.")
def _(V, V_pipe, F):
    return {"H": exp(-V_pipe / F * s) / (V / F * s)}


@brine.mistake("With less flow the brine needs longer for the pipe, too.")
def _(V, V_pipe, F, less):
    return {"t_slow": V_pipe / F + V * log(2) / F / (1 - less / 100)}


@brine.mistake("With less flow the tank is slower, too, not only the pipe.")
def _(V, V_pipe, F, less):
    return {"t_slow": V_pipe / F / (1 - less / 100) + V * log(2) / F}


@brine.mistake("Look at the units: is a volume over a flow a time, or a flow over a volume?")
def _(V, V_pipe, F):
    return {"H": exp(-F / V_pipe * s) / (F / V * s + 1), "t_half": F / V_pipe + F / V * log(2)}


@brine.mistake("Then the first of the change arrives. How long does the tank take for half of it?")
def _(V_pipe, F):
    return {"t_half": V_pipe / F}


@brine.mistake("Half of the time is not half of the change: what happens in the tank, and what in the pipe?")
def _(V, V_pipe, F):
    return {"t_half": (V + V_pipe) / F / 2}


@brine.mistake("By so much the flow has become smaller. How much of it is left?")
def _(V, V_pipe, F, less):
    return {"t_slow": (V_pipe + V * log(2)) / F / (less / 100)} if less != 50 else {}


brine.hints(
    "What is mixed becomes a lag. What only travels becomes a delay.",
    r"Both times are volume over flow: $T = V/F$ for the tank and $\tau = V_{pipe}/F$ for the pipe. Half of the "
    r"change is through the tank when $e^{-t/T} = \frac{1}{2}$; the pipe comes on top.",
    r"Here $T = \frac{ {V} }{ {F} }$ min and $\tau = \frac{ {V_pipe} }{ {F} }$ min, and the time to the half is $\tau "
    r"+ T \ln 2$. With {less} less flow, by which factor does each of the two grow?",
)


@brine.solution
def _(V, V_pipe, F, less):
    r"""The tank mixes: it is a lag with the time constant $V/F = {V}/{F} =$ {T}. The pipe only delays, by
    ${V_pipe}/{F} =$ {delay}. What flows in comes out, so the gain is one:

    $$H(s) = {H}$$

    Half of the change has left the tank after $T \ln 2 =$ {in_tank}. The pipe delays it, so it is at the end of the
    pipe after ${delay} + {in_tank} =$ {t_half}.

    With {less} less flow, {rest} of it is left. Both times have the flow in their denominator, so that everything takes
    $1/{share} =$ {factor} times as long: {t_slow}.
    """
    return {
        "T": (V / F, "min"), "delay": (V_pipe / F, "min"), "in_tank": (float(V / F) * logarithm(2), "min"),
        "rest": (100 - less, "%"), "share": 1 - less / 100, "factor": 1 / (1 - less / 100),
        "H": exp(-V_pipe / F * s) / (V / F * s + 1),
    }  # fmt: skip


@brine.solution_picture
def _(V, V_pipe, F, less):
    """The share of the change at the end of the pipe against time, with the flow as it is and with less flow."""
    T, delay, slower = float(V / F), float(V_pipe / F), float(1 / (1 - less / 100))
    times = np.linspace(0, slower * (delay + 4 * T), 400)
    curves = {"flow as it is": 1, f"{less} % less": slower}
    rises = {name: np.maximum(0, 1 - np.exp(-(times / k - delay) / T)) for name, k in curves.items()}
    plot = time_plot(rises, times, xlabel="$t$ [min]", ylabel="share of the change", low=True)
    return plot.mark(delay + T * logarithm(2), "half")


@exercise(
    "6.4",
    title="What is still on the belt",
    points=3,
    insight="A delay keeps a memory of everything that is under way: what is on the belt arrives, whatever you do "
    "meanwhile.",
    where=lambda length, v, run: abs(length / v / run - 1) > 0.05,
)
def belt(
    length=between(6, 30, "m", reference=12, step=1),
    v=between(0.2, 0.8, "m/s", reference=0.4, step=0.1),
    F=between(1, 8, "kg/s", reference=2.5, step=0.5),
    run=between(20, 90, "s", reference=50, step=5),
):
    """A feeder drops grain on a belt, which is {length} long and moves at {v}. At its end the grain falls into an empty
    hopper on scales. At $t = 0$ the feeder starts with {F}, and after {run} it stops. The belt runs on. Give the
    transfer function from the feeder's mass flow [kg/s] to the mass in the hopper [kg], with the time in seconds.
    Then find the mass in the hopper as a function of time (type `Heaviside(t - a)` for a step at $t = a$), and the mass
    that lies on the belt when the feeder stops.
    """
    delay = length / v
    return answers(
        H=transfer_function(exp(-delay * s) / s, "the transfer function"),
        m=time_function(_filled(F, delay, delay + run), 1.5 * (delay + run), "kg", "the mass in the hopper"),
        on_belt=number(F * min(run, delay), "kg", "the mass on the belt"),
    )


def _filled(F, start, stop):
    """A ramp with the slope F from the start to the stop."""
    return F * ((t - start) * Heaviside(t - start) - (t - stop) * Heaviside(t - stop))


@belt.mistake("That is the transfer function to the mass flow at the end of the belt. The hopper adds it up.")
def _(length, v):
    return {"H": exp(-length / v * s)}


@belt.mistake("A transfer function does not contain the size of the input: it multiplies whatever the feeder gives.")
def _(length, v, F):
    return {"H": F * exp(-length / v * s) / s} if F != 1 else {}


@belt.mistake("That is the mass flow at the end of the belt. The hopper adds it up.")
def _(length, v, F, run):
    return {"m": F * (Heaviside(t - length / v) - Heaviside(t - length / v - run))}


@belt.mistake("Your hopper fills forever. But the feeder stops, and after a while nothing more arrives.")
def _(length, v, F):
    return {"m": F * (t - length / v) * Heaviside(t - length / v)}


@belt.mistake("Before the first grain arrives, the hopper is empty. And what happens when the last of it has arrived?")
def _(length, v, F):
    return {"m": F * (t - length / v)}


@belt.mistake("When the feeder stops, there is still grain on the belt. Until when does it arrive?")
def _(length, v, F, run):
    return {"m": _filled(F, length / v, run)} if run > length / v else {}


@belt.mistake("The grain needs its time on the belt before the first of it reaches the hopper.")
def _(F, run):
    return {"m": _filled(F, 0, run)}


@belt.mistake(
    "Where is the grain when the feeder stops? Compare the time on the belt with the time for which the feeder ran."
)
def _(length, v, F, run):
    return {"on_belt": F * max(run, length / v)}


def _share_left(x, T_1, T_2):
    """What two different lags in series still have to go, x after a step."""
    return (T_1 * exponential(-x / T_1) - T_2 * exponential(-x / T_2)) / (T_1 - T_2)


def _response_time(T_1, T_2):
    """The time to 63 % for two different lags in series, by bisection."""
    low, high = T_1, 2 * (T_1 + T_2)
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if _share_left(middle, T_1, T_2) > exponential(-1) else (low, middle)
    return low


@belt.mistake("The delay is right, but the hopper has no outflow. What does it do with the grain that arrives?")
def _(length, v):
    return {"H": exp(-length / v * s) / (s + 1)}


@belt.mistake("The feeder ran that long. How long is a grain on its way?")
def _(run):
    return {"H": exp(-run * s) / s}


@belt.mistake("That has fallen into the hopper already. What is still on its way?")
def _(length, v, F, run):
    on_belt, arrived = F * min(run, length / v), F * (run - length / v)
    return {"on_belt": arrived} if arrived > 0 and not _near(arrived, on_belt) else {}


@belt.mistake("Look at the units: metres and metres per second. How do they make a time?")
def _(length, v, F, run):
    delay = length * v
    on_belt = F * min(run, delay)
    mass = {"m": _filled(F, delay, delay + run)} if not _near(delay, length / v) else {}
    is_apart = not _near(on_belt, F * min(run, length / v))
    return mass | {"H": exp(-delay * s) / s} | ({"on_belt": on_belt} if is_apart else {})


@belt.mistake("A mass flow times a length is no mass. For how long has the grain on the belt been fed?")
def _(length, v, F, run):
    return {"on_belt": F * length} if not _near(length, min(run, length / v)) else {}


belt.hints(
    "A belt delays, and a hopper adds up.",
    r"The delay is the length over the speed, $e^{-\tau s}$, and adding up is $1/s$. In time, the hopper fills along "
    "a straight line while grain arrives, that is from the delay to the delay plus the time for which the feeder ran.",
    r"The delay is $\tau = \frac{ {length} }{ {v} }$ s. The hopper begins to fill at $\tau$ and stops at $\tau + "
    "{run}$ s, at {F}. When the feeder stops, compare {run} with $\\tau$: which part of the grain has arrived by then?",
)


@belt.solution
def _(length, v, F, run):
    r"""The grain needs ${length}/{v} =$ {delay} for the belt, which is a delay. The hopper adds up what falls into it,
    which is an integrator:

    $$H(s) = \frac{e^{-{delay} s}}{s}$$

    So the hopper is empty until the first grain arrives after {delay}. Then it fills by {F}, for as long as the feeder
    ran, until {last}. With a step function $\theta$ for each of the two moments,

    $$m(t) = {F}\,(t - {delay})\,\theta(t - {delay}) - {F}\,(t - {last})\,\theta(t - {last})$$

    in kg, so that it ends with ${F} \cdot {run} =$ {all}.

    When the feeder stops, the belt holds what came on it in the last {under_way}: {compared}. That is
    ${F} \cdot {under_way} =$ {on_belt}.
    """
    delay = length / v
    longer = "what was fed before has reached the hopper"
    shorter = "all that was fed, since the first grain has not reached the hopper"
    return {
        "delay": (delay, "s"), "last": (delay + run, "s"), "all": (F * run, "kg"), "under_way": (min(run, delay), "s"),
        "compared": longer if run > delay else shorter,
    }  # fmt: skip


@belt.solution_picture
def _(length, v, F, run):
    """The mass in the hopper and the mass on the belt against time."""
    delay = length / v
    times = np.linspace(0, 1.15 * float(delay + run), 300)
    fed = np.clip(times, 0, float(run)) * float(F)
    arrived = np.clip(times - float(delay), 0, float(run)) * float(F)
    return time_plot(
        {"in the hopper": arrived, "on the belt": fed - arrived}, times, ylabel="mass [kg]", low=True
    ).event(run, "feeder stops")


@exercise(
    "6.5",
    title="A sensor in a pocket",
    points=4,
    insight="Lags and delays in series add up to the response time, nearly: for two lags the estimate is a little "
    "short, by 7 % at most.",
    where=lambda T_1, T_2, delay: T_1 >= 1.25 * T_2 and T_2 >= 0.4 * T_1 and delay <= 0.5 * T_1,
)
def pocket(
    T_1=between(20, 60, "s", reference=40, step=2),
    T_2=between(8, 40, "s", reference=20, step=2),
    delay=between(2, 20, "s", reference=6, step=1),
):
    """Hot water arrives from a boiler after a delay of {delay}. It warms the wall of a pocket, a lag of {T_1}, and the
    wall warms the sensor in it, a lag of {T_2}. All gains are one. The water at the boiler becomes suddenly warmer.
    Estimate the response time of the sensor by the rule for elements in series. Which share of its way has the sensor
    gone at this moment, and what is the exact response time, the time to 63.2 % of the way?
    """
    T_1, T_2, delay = float(T_1), float(T_2), float(delay)
    return answers(
        estimate=number(T_1 + T_2 + delay, "s", "the estimate of the response time", within=0.002),
        share=number(100 - 100 * _share_left(T_1 + T_2, T_1, T_2), "%", "the share that is reached at the estimate"),
        T_r=number(_response_time(T_1, T_2) + delay, "s", "the exact response time", within=0.005),
    )


@pocket.mistake("The delay adds to the response time as well.")
def _(T_1, T_2):
    return {"estimate": T_1 + T_2, "T_r": _response_time(float(T_1), float(T_2))}


@pocket.mistake("That would be the share for a single lag. Here are two, so look at their own step response.")
def _():
    return {"share": 100 - 100 * exponential(-1)}


@pocket.mistake("That is the share that is still missing.")
def _(T_1, T_2):
    return {"share": 100 * _share_left(float(T_1 + T_2), float(T_1), float(T_2))}


@pocket.mistake(
    "When the time runs from the step at the boiler, the first seconds of it are delay and do not count for the lags."
)
def _(T_1, T_2, delay):
    share = 100 - 100 * _share_left(float(T_1 + T_2 + delay), float(T_1), float(T_2))
    return {"share": share} if not _near(share, 100 - 100 * exponential(-1)) else {}


@pocket.mistake("That is the estimate again. At that time the sensor has not quite reached 63.2 %.")
def _(T_1, T_2, delay):
    return {"T_r": T_1 + T_2 + delay}


def _volumes(F, pulse, c, c_max, t_max):
    """The least and the largest volume [m³] of exercise 6.6."""
    least = float(pulse) / -logarithm(1 - float(c_max / c))
    return least * float(F) / 60, float(t_max) / logarithm(10) * float(F) / 60


@pocket.mistake("Here the delay was subtracted. Does the water arrive sooner because of it?")
def _(T_1, T_2, delay):
    return {"estimate": T_1 + T_2 - delay}


@pocket.mistake("That is how long the slowest of them takes alone. The others take their time as well.")
def _(T_1):
    return {"estimate": T_1, "T_r": T_1}


@pocket.mistake("Squares are not needed: how do lags in series make up the time of the whole?")
def _(T_1, T_2, delay):
    root = (float(T_1) ** 2 + float(T_2) ** 2) ** 0.5
    return {"estimate": root + delay}


@pocket.mistake("Squares are not needed: how do lags and delays in series make up the time of the whole?")
def _(T_1, T_2, delay):
    return {"estimate": float(T_1**2 + T_2**2 + delay**2) ** 0.5}


@pocket.mistake("The sensor itself takes its time, too.")
def _(T_1, T_2, delay):
    return {"T_r": T_1 + delay} | ({} if _near(T_2, 2 * delay) else {"estimate": T_1 + delay})


@pocket.mistake("That is an estimate for the two lags alone. The water arrives later, and 63.2 % are asked for.")
def _(T_1, T_2, delay):
    exact = _response_time(float(T_1), float(T_2)) + float(delay)
    return {} if _near(T_1 + T_2, exact) else {"T_r": T_1 + T_2}


pocket.hints(
    "The response time of elements in series is about the sum of all their lags and delays.",
    "For the exact time look at what is still missing $x$ seconds after the warm water has arrived. For two "
    r"different lags it is $\frac{T_1 e^{-x/T_1} - T_2 e^{-x/T_2}}{T_1 - T_2}$, and the delay comes on top.",
    "The estimate is ${T_1} + {T_2} + {delay}$ s. Of these the first {delay} are delay, so put $x = {T_1} + {T_2}$ "
    "into the share that is missing. Then try a slightly larger $x$ until 36.8 % are left.",
)


@pocket.solution
def _(T_1, T_2, delay):
    r"""The estimate is the sum of all lags and delays: ${T_1} + {T_2} + {delay} =$ {estimate}.

    {delay} of it are delay, in which nothing moves. So the two lags have had $x = {T_1} + {T_2} =$ {x}, and what is
    missing is

    $$\frac{ {T_1}\,e^{-{x}/{T_1}} - {T_2}\,e^{-{x}/{T_2}} }{ {T_1} - {T_2} } = {missing}$$

    So {share} of the way are gone, a little less than 63.2 %.

    The exact response time is where this share is $e^{-1} = 0.368$. There is no formula for it. Trying larger $x$ gives
    $x =$ {exact}, and with the delay {T_r}. The estimate was about {short} too short.
    """
    T_1, T_2, delay = float(T_1), float(T_2), float(delay)
    exact = _response_time(T_1, T_2)
    return {
        "x": (T_1 + T_2, "s"), "missing": _share_left(T_1 + T_2, T_1, T_2), "exact": (exact, "s"),
        "short": (round(100 * (1 - (T_1 + T_2 + delay) / (exact + delay)), 1), "%"),
    }  # fmt: skip


@pocket.solution_picture
def _(T_1, T_2, delay):
    """The share of its way that the sensor has gone, with the estimate marked."""
    T_1, T_2, delay = float(T_1), float(T_2), float(delay)
    times = np.linspace(0, delay + 4 * (T_1 + T_2), 400)
    x = np.maximum(times - delay, 0)
    gone = 1 - (T_1 * np.exp(-x / T_1) - T_2 * np.exp(-x / T_2)) / (T_1 - T_2)
    plot = time_plot({"sensor": (gone, "measurement")}, times, ylabel="share of the way", low=True)
    return plot.mark(T_1 + T_2 + delay, "at the estimate").level(1 - exponential(-1), "63.2 %")


@exercise(
    "6.6",
    title="A tank against pulses",
    points=5,
    insight="A lag smooths what is shorter than itself; the price is that it answers slowly to what is meant to come "
    "through.",
    where=lambda F, pulse, c, c_max, t_max: (
        10 * c_max >= c
        and 2 * c_max <= c
        and 1.2 <= _volumes(F, pulse, c, c_max, t_max)[1] / _volumes(F, pulse, c, c_max, t_max)[0] <= 3
    ),
)
def against_pulses(
    F=between(4, 30, "m³/h", reference=12, step=1),
    pulse=between(2, 10, "min", reference=5, step=1),
    c=between(2, 12, "g/L", reference=6, step=1),
    c_max=between(0.5, 4, "g/L", reference=1.5, step=0.25),
    t_max=between(30, 120, "min", reference=60, step=5),
):
    """Waste water flows at {F} into a treatment plant. From time to time somebody rinses a vessel: for {pulse} the salt
    concentration of the inflow is {c} higher than before, and then it is as it was. The plant tolerates {c_max} above
    normal, not more. A stirred tank at its inlet takes care of this; it is always full, and its volume is yours to
    choose. But it must not be too slow: when the inflow changes for good, 90 % of the change should have come through
    after at most {t_max}.

    Which time constant must the tank have at least? Choose a volume.
    """
    least, largest = _volumes(F, pulse, c, c_max, t_max)
    F, pulse, c = float(F), float(pulse), float(c)

    def highest(volume):
        return c * (1 - exponential(-pulse * F / 60 / volume))

    return answers(
        T_least=number(-pulse / log(1 - c_max / c), "min", "the least time constant"),
        V=design(
            number((least + largest) / 2, "m³", "the volume of the tank"),
            criterion("it is positive", lambda volume: volume > 0, otherwise="a volume is more than zero"),
            criterion("the highest concentration above normal", highest, below=c_max, unit="g/L"),
            criterion("the time to 90 %", lambda volume: 60 * volume / F * logarithm(10), below=t_max, unit="min"),
            draws=lambda volume: _pulse_and_step(60 * volume / F, pulse, c, float(c_max), float(t_max)),
        ),
    )


@against_pulses.mistake(
    "During the pulse the concentration does not rise along a straight line. Use the step response of the tank."
)
def _(pulse, c, c_max):
    return {"T_least": pulse * c / c_max}


@against_pulses.mistake(
    "After that time the exponential is what is *left* of the way. How much of the way may be covered?"
)
def _(pulse, c, c_max):
    return {"T_least": pulse / log(c / c_max)} if abs(c_max / c - 0.5) > 0.02 else {}


@against_pulses.mistake(
    "That is the largest time constant, from the time to 90 %. The smallest one comes from the pulse."
)
def _(t_max):
    return {"T_least": t_max / log(10)}


@against_pulses.mistake(
    "The flow is per hour, the time constant in minutes. Bring them to the same unit of time first."
)
def _(F, pulse, c, c_max, t_max):
    least, largest = _volumes(F, pulse, c, c_max, t_max)
    return {"V": 30 * (least + largest)}


@against_pulses.mistake(
    "That is what flows in during the pulse. How much larger must the tank be to keep the pulse small?"
)
def _(F, pulse):
    return {"V": F * pulse / 60}


@against_pulses.mistake("In that time the whole tank is exchanged. How many time constants does it take to 90 %?")
def _(F, t_max):
    return {"V": F * t_max / 60}


def _pulse_and_step(T, pulse, c, c_max, t_max):
    """What a tank with this time constant makes of the pulse, and of a change that lasts, with the two limits."""
    T = max(float(T), 1e-3)
    times = np.linspace(0, 1.5 * t_max, 400)
    rise = np.exp(-np.maximum(times - pulse, 0) / T) * (1 - np.exp(-np.minimum(times, pulse) / T))
    panels = [{"after a pulse": (c * rise, 0)}, {"after a change that lasts": (100 - 100 * np.exp(-times / T), 1)}]
    names = ["after a pulse [g/L]", "lasting change [%]"]
    plot = time_plot(panels, times, "Outflow of your tank", xlabel="$t$ [min]", ylabel=names, low=True)
    plot.level(c_max, "tolerated", "after a pulse").level(90, "90 %", "after a change that lasts")
    return plot.event(t_max, "at the latest")


@against_pulses.mistake("That is a time constant in minutes. How does a volume follow from it?")
def _(F, pulse, c, c_max, t_max):
    least, largest = _volumes(F, pulse, c, c_max, t_max)
    T = (least + largest) / 2 * 60 / float(F)
    return {"V": T} if not least <= T <= largest else {}


@against_pulses.mistake("That is a time constant in minutes. How does a volume follow from it?")
def _(F, pulse, c, c_max, t_max):
    least, largest = _volumes(F, pulse, c, c_max, t_max)
    T = least * 60 / float(F)
    return {"V": T} if not 0.99 * least <= T <= 1.01 * largest else {}


@against_pulses.mistake("A tank so small lets nearly all of a pulse through. How does its outflow rise meanwhile?")
def _(pulse, c, c_max):
    return {"T_least": pulse * c_max / c}


@against_pulses.mistake("In one time constant 63 % of a step come through. How much may come through here?")
def _(pulse, c, c_max):
    return {} if _near(c_max / c, 1 - 1 / E) else {"T_least": pulse}


@against_pulses.mistake(
    "Solve the exponential for $T$ once more: is the logarithm above the fraction line, or below it?"
)
def _(pulse, c, c_max):
    return {"T_least": -pulse * log(1 - c_max / c)}


@against_pulses.mistake(
    "Solve the exponential for $T$ once more: which share is left, and where does the logarithm end up?"
)
def _(pulse, c, c_max):
    least = -pulse / log(1 - c_max / c)
    return {} if _near(pulse * log(c / c_max), least) else {"T_least": pulse * log(c / c_max)}


against_pulses.hints(
    "The tank is a lag, and the pulse is a step up that is taken back after a while: the highest concentration comes "
    "just before it is taken back.",
    r"Just before the end of the pulse the outflow is at $c\,(1 - e^{-t_p/T})$, with the length $t_p$ of the pulse. "
    r"The plant wants this below its limit, so $T$ must be large enough. The time to 90 % is $T \ln 10$, so $T$ must "
    "be small enough. And $V = T F$.",
    r"At the limit $1 - e^{-{pulse}/T} = \frac{ {c_max} }{ {c} }$. From above, $T \le \frac{ {t_max} }{\ln 10}$.",
)


@against_pulses.solution
def _(F, pulse, c, c_max, t_max):
    r"""For {pulse} the inflow is higher by {c}. The tank is a lag, so at the end of the pulse its concentration is
    higher by $c\,(1 - e^{-t_p/T})$, and that is the highest value. It is to be {c_max} at most:

    $$1 - e^{-{pulse}/T} \le \frac{ {c_max} }{ {c} } = {ratio}$$

    $$T \ge \frac{ {pulse} }{-\ln(1 - {ratio})} = {T_least}\ \text{min}$$

    A change that lasts has come through to 90 % after $T \ln 10 = 2.303\,T$. This may be {t_max}, so $T \le {T_max}$
    min.

    The time constant of the tank is volume over flow, and the flow is ${F}/60 =$ {per_minute}. So its volume is between
    ${T_least} \cdot {per_minute} =$ {least} and ${T_max} \cdot {per_minute} =$ {largest}, for example {middle}.
    """
    least, largest = _volumes(F, pulse, c, c_max, t_max)
    return {
        "ratio": c_max / c, "T_max": float(t_max) / logarithm(10), "per_minute": (F / 60, "m³/min"),
        "least": (least, "m³"), "largest": (largest, "m³"), "middle": ((least + largest) / 2, "m³"),
    }  # fmt: skip


def _record(start, T, u_1, du, y_1, dy, noise):
    """Times, power and noisy temperature of exercise 6.7."""
    times = np.linspace(0, float(start + 7 * T), 400)
    since = np.maximum(times - float(start), 0)
    y = float(y_1) + float(dy) * (1 - np.exp(-since / float(T)))
    power = float(u_1) + float(du) * (times >= float(start))
    return times, power, y + signals.noise(times, 0.012 * float(dy), seed=int(noise))


@exercise(
    "6.7",
    title="An oven by ruler",
    points=3,
    where=lambda K, du, start, T: 8 <= K * du <= 40 and 0.4 * T <= start <= 1.2 * T,
    insight="Noise moves single points, not the curve that you lay through them: read levels as averages, times on "
    "the curve.",
)
def oven(
    K=between(0.8, 4, "K/%", reference=1.6, step=0.2),
    T=between(4, 20, "min", reference=10, step=1),
    start=between(3, 15, "min", reference=5, step=1),
    u_1=between(25, 55, "%", reference=40, step=5),
    du=between(5, 20, "%", reference=10, step=5),
    y_1=between(120, 240, "°C", reference=180, step=10),
    noise=between(1, 999, reference=7, step=1),
):
    """The power of an oven was raised in a step, and its temperature was recorded; the sensor is noisy. Both are in the
    picture. Take the oven for a time constant system, and read its gain and its time constant off the picture with a
    ruler. How long after the step has 90 % of the change come through? (`t, u, y = exercise("6.7").given("t", "u",
    "y")` are the times, the power and the temperature, if you prefer to compute.)
    """
    return answers(
        K=number(K, "K/%", "the gain", within=0.06),
        T=number(T, "min", "the time constant", within=0.1),
        t_90=number(T * log(10), "min", "the time from the step to 90 % of the change", within=0.1),
    )


@oven.shows
def _(K, T, start, u_1, du, y_1, noise):
    times, power, y = _record(start, T, u_1, du, y_1, K * du, noise)
    return {"t": times, "u": power, "y": y}


@oven.picture
def _(K, T, start, u_1, du, y_1, noise):
    """The noisy temperature of an oven, which rises after a step of its power, and the power below."""
    times, power, y = _record(start, T, u_1, du, y_1, K * du, noise)
    panels = [{"temperature": (y, "raw")}, {"power": (power, "control signal")}]
    return time_plot(panels, times, xlabel="$t$ [min]", ylabel=["temperature [°C]", "power [%]"])


@oven.mistake("The gain is a ratio of changes. Here the values after the step were divided.")
def _(K, u_1, du, y_1):
    ratio = (y_1 + K * du) / (u_1 + du)
    return {"K": ratio} if abs(ratio / K - 1) > 0.15 else {}


@oven.mistake("The gain is a ratio of changes. By how much was the power *raised*?")
def _(K, u_1, du):
    return {"K": K * du / (u_1 + du)}


@oven.mistake("The power is the input. Which of the two changes belongs below?")
def _(K):
    return {"K": 1 / K} if abs(K * K - 1) > 0.2 else {}


@oven.mistake("This is a moment of the picture. The time constant is counted from the step.")
def _(T, start):
    return {"T": start + T}


@oven.mistake("Then half of the way is covered. How much of it is covered after one time constant?")
def _(T):
    return {"T": T * log(2)}


@oven.mistake("By then the response has practically ended. The time constant is the time to 63 % of the way.")
def _(T):
    return {"T": 5 * T}


@oven.mistake("The response is no straight line: the last part of the way takes longest. Use the exponential.")
def _(T):
    return {"t_90": T * 0.9 / (1 - 1 / E)}


@oven.mistake("This is a moment of the picture. Count from the step.")
def _(T, start):
    return {"t_90": start + T * log(10)}


@oven.mistake("After nine tenths of a time constant not even 63 % have come through.")
def _(T):
    return {"t_90": 0.9 * T}


@oven.mistake("By then the response has practically ended. The time constant is the time to 63 % of the way.")
def _(T):
    return {"T": 3 * T}


@oven.mistake("By then the response has practically ended. The time constant is the time to 63 % of the way.")
def _(T):
    return {"T": 4 * T}


@oven.mistake("This follows from a time constant that was not counted from the step.")
def _(T, start):
    return {"t_90": (start + T) * log(10)}


@oven.mistake("After one time constant 63 % have come through. How long does it take to 90 %?")
def _(T):
    return {"t_90": T}


@oven.mistake("That is the whole change. How much of it does one percent of the power make?")
def _(K, du):
    return {"K": K * du}


@oven.mistake("By then the response has practically ended. When is a tenth of the way still to go?")
def _(T, start):
    return {"t_90": 5 * T} if start < 0.8 * T else {}


@oven.mistake("Then half of the way is covered. When is a tenth of it still to go?")
def _(T):
    return {"t_90": T * log(2)}


oven.hints(
    "The gain is what the change of the input brings in the end. The time constant is the time to 63 % of the way.",
    "Lay a line through the noise before the step, and one through the noise at the end: their distance is the change "
    "of the temperature. Go up 63 % of it, and across to the middle of the noisy curve. The power's panel shows when "
    "the step came.",
    "The power was raised by {du}. Divide the change of the temperature by it. For the last question, $1 - e^{-t/T} = "
    "0.9$.",
)


@oven.solution
def _(K, T, start, u_1, du, y_1):
    r"""Before the step the temperature is about {y_1}, at the end about {end}. So it has changed by about {dy}. The
    power was raised from {u_1} by {du}, and the gain is ${dy}/{du} =$ {K}.

    63 % of the way are at ${y_1} + 0.632 \cdot {dy} =$ {level}. The middle of the noisy curve is there at about
    {moment}. The step came at {start}, so the time constant is about {T}.

    What is left after a time $t$ is $e^{-t/T}$ of the way. It is a tenth when $t = T \ln 10 = 2.303 \cdot {T} =$
    {t_90}.
    """
    dy = K * du
    return {
        "end": (y_1 + dy, "°C"), "dy": (dy, "K"), "level": (y_1 + dy * (1 - exponential(-1)), "°C"),
        "moment": (start + T, "min"),
    }  # fmt: skip


@oven.solution_picture
def _(K, T, start, u_1, du, y_1, noise):
    """The record with the response of the model through the noise, and the point at 63 %."""
    times, _, y = _record(start, T, u_1, du, y_1, K * du, noise)
    since = np.maximum(times - float(start), 0)
    smooth = float(y_1) + float(K * du) * (1 - np.exp(-since / float(T)))
    curves = {"measured": (y, "raw"), "model": (smooth, "model")}
    plot = time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [°C]")
    return plot.mark(start + T, "63 %, after $T$", "model").event(start, "step")


MODELS = ("lag", "two_lags", "four_lags", "delayed")  # in the order of exercise 6.8


def _rises(T, tau, order):
    """Times and step responses of the four models, each under its letter."""
    T, tau = float(T), float(tau)
    times = np.linspace(0, 3.2 * T, 400)
    two, four, after = 2 * times / T, 4 * times / T, np.maximum(times - tau, 0)
    responses = (
        1 - np.exp(-times / T),
        1 - np.exp(-two) * (1 + two),
        1 - np.exp(-four) * (1 + four + four**2 / 2 + four**3 / 6),
        1 - np.exp(-after / (T - tau)),
    )
    return times, dict(sorted(zip(order, responses, strict=True)))


def _letter(order, model):
    return order[MODELS.index(model)]


@exercise(
    "6.8",
    title="Four models, four curves",
    points=4,
    where=lambda T, tau: 0.3 * T <= tau <= 0.5 * T,
    insight="The end of a response says how long a chain takes; its beginning says of how many parts it is made.",
)
def four_curves(
    T=between(10, 60, "s", reference=20, step=5),
    tau=between(3, 30, "s", reference=8, step=1),
    order=choice(
        "ABCD", "BADC", "CDAB", "DCBA", "BCDA", "CADB", "DBAC", "ACBD", "BDCA", "CBDA", "DACB", "ADCB", reference="CADB"
    ),
):
    r"""Four processes have a gain of one, and all of them have the same sum of lags and delays. The picture shows their
    responses to the same step at $t = 0$, as A, B, C and D. The processes are

    - one lag, $\frac{1}{Ts + 1}$,
    - two equal lags in series, $\frac{1}{(T_2 s + 1)^2}$ with $T_2 = T/2$,
    - four equal lags in series, $\frac{1}{(T_4 s + 1)^4}$ with $T_4 = T/4$,
    - a lag behind a delay, $\frac{e^{-\tau s}}{(T - \tau)s + 1}$.

    Which curve belongs to which? Read the time constant $T$ and the delay $\tau$ off the picture. (`t, A, B, C, D =
    exercise("6.8").given("t", "A", "B", "C", "D")` are the curves.)
    """
    return answers(
        lag=word(_letter(order, "lag"), "ABCD", "the curve of one lag"),
        two_lags=word(_letter(order, "two_lags"), "ABCD", "the curve of two equal lags"),
        four_lags=word(_letter(order, "four_lags"), "ABCD", "the curve of four equal lags"),
        delayed=word(_letter(order, "delayed"), "ABCD", "the curve of the lag behind a delay"),
        T=number(T, "s", "the time constant of the single lag", within=0.08),
        tau=number(tau, "s", "the delay", within=0.1),
    )


@four_curves.shows
def _(T, tau, order):
    times, rises = _rises(T, tau, order)
    return {"t": times} | rises


@four_curves.picture
def _(T, tau, order):
    """Four step responses A to D, all from zero to one; they differ in how they begin."""
    times, rises = _rises(T, tau, order)
    return time_plot(rises, times, ylabel="response")


def _mixed_up(asked, other):
    """A mistake: the curve of one model taken for that of another."""
    return lambda order: {asked: _letter(order, other)}


_AT_ONCE = "This curve sets out with its largest slope, from the first moment on. Is there only one lag in the process?"
_CORNER = "This curve rests, and then sets out with a corner. Can a chain of lags alone rest, and can it make a corner?"
_SMOOTH = "This curve leaves zero without a corner. What does the response of a single lag do when it begins?"
_NO_REST = "This curve moves from the first moment on, if only slowly. Does anything move during a delay?"
_WHICH = "This is a chain of lags. Does a chain of more lags set out faster or more slowly?"
for _asked, _other, _sentence in (
    ("lag", "two_lags", _SMOOTH), ("lag", "four_lags", _SMOOTH),
    ("lag", "delayed", "This one has the corner of a lag, but when does it come? Nothing is in front of this lag."),
    ("two_lags", "lag", _AT_ONCE), ("two_lags", "four_lags", _WHICH), ("two_lags", "delayed", _CORNER),
    ("four_lags", "lag", _AT_ONCE), ("four_lags", "two_lags", _WHICH), ("four_lags", "delayed", _CORNER),
    ("delayed", "lag", "This one has the corner of a lag, but when does it come? Something is in front of this lag."),
    ("delayed", "two_lags", _NO_REST), ("delayed", "four_lags", _NO_REST),
):  # fmt: skip
    four_curves.mistake(_sentence)(_mixed_up(_asked, _other))


@four_curves.mistake("That is the lag behind the delay. How long is the time in which nothing happens?")
def _(T, tau):
    return {"tau": T - tau} if abs(T - 2 * tau) > 0.12 * tau else {}


@four_curves.mistake("By then the curve has gone 63 % of its way: delay and lag together. When does it begin to move?")
def _(T):
    return {"tau": T}


@four_curves.mistake("Then the single lag has gone half of its way. One time constant takes it to 63 %.")
def _(T):
    return {"T": T * log(2)}


@four_curves.mistake("That is the lag behind the delay. Which curve has the whole sum as its one lag?")
def _(T, tau):
    return {"T": T - tau}


@four_curves.mistake("There a smooth curve becomes visible. A delay ends with a corner: which of the curves has it?")
def _(T):
    return {"tau": T / 5}


@four_curves.mistake("There a smooth curve becomes visible. A delay ends with a corner: which of the curves has it?")
def _(T):
    return {"tau": T / 10}


four_curves.hints(
    "Look at the beginning. A lag answers a step with a corner. A second lag makes of this corner a smooth beginning. "
    "A delay lets nothing through for a while.",
    "Two of the curves have a corner: one at $t = 0$, and one later. The other two are smooth at zero; the more lags "
    "there are, the longer they seem to rest. Then read $T$ off the curve of the single lag, at 63 %.",
    r"The corner of the later one is at $t = \tau$. The curve of the single lag is at $1 - e^{-1} = 0.632$ when $t = "
    "T$.",
)


@four_curves.solution
def _(T, tau, order):
    r"""Only a lag that meets the step itself answers it with a corner. Curve {one} has its corner at $t = 0$: it is the
    single lag. Curve {late} has the same corner later, and rests before: there is a delay in front of its lag.

    The other two are smooth where they begin, because each further lag smooths what comes from the one before. Curve
    {few} moves sooner, so it has fewer lags: two. Curve {many} looks at first like a delay, but it has no corner: four
    lags.

    Curve {one} passes 63.2 % at $t = T =$ {T}. Curve {late} leaves zero at $\tau =$ {tau}; its lag is what is left of
    the sum, ${T} - {tau} =$ {rest}.
    """
    one, few, many, late = order
    return {"one": one, "few": few, "many": many, "late": late, "rest": (T - tau, "s")}
