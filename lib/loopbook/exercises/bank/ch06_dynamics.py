"""Exercises of chapter 6, dynamic characteristics."""

from math import exp as exponential
from math import log as logarithm

from sympy import E, Heaviside, exp, log

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
)
from loopbook.expressions import s, t


@exercise(
    "6.1",
    title="Before the tank runs over",
    points=2,
    where=lambda q_in, q_out, start, top: q_in >= q_out + 2 and top >= start + 0.5,
)
def runs_over(
    A=between(2, 12, "m²", reference=5, step=0.5),
    q_in=between(6, 25, "L/s", reference=12, step=1),
    q_out=between(2, 12, "L/s", reference=8, step=1),
    start=between(0.5, 2, "m", reference=1.2, step=0.1),
    top=between(1.5, 4, "m", reference=2.4, step=0.1),
):
    """A tank with the area {A} receives {q_in} of water, and a pump takes out just as much. The level stands at
    {start}. Then the pump is throttled to {q_out}. Take the net inflow [m³/s] as the input and the level [m] as the
    output. Which gain does this integrator have, how fast does the level rise, and after which time does it reach
    the rim at {top}?
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


@exercise("6.2", title="Half of the way", points=2)
def half_way(
    u_1=between(20, 45, "%", reference=40, step=5),
    du=between(5, 20, "%", reference=10, step=5),
    y_1=between(40, 70, "°C", reference=55, step=1),
    dy=between(6, 30, "K", reference=18, step=1),
    t_half=between(2, 15, "min", reference=7, step=0.5),
):
    """The air of a dryer is warmed by steam. The steam valve stood at {u_1}, and the air had a temperature of {y_1}.
    Then the valve was opened further, to {u_2}. The air became {dy} warmer in the end, and it had gone half of this
    way after {t_half}. Take the dryer for a time constant system. Find its gain and its time constant. Which
    temperature did the air have when one time constant had passed since the step?
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


@exercise(
    "6.3",
    title="Brine, a stirred tank and a long pipe",
    points=3,
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
    "The times are inversely proportional to the flow. So they grow by a larger percentage than the one by "
    "which the flow falls."
)
def _(V, V_pipe, F, less):
    return {"t_slow": (V_pipe + V * log(2)) / F * (1 + less / 100)}


@exercise(
    "6.4", title="What is still on the belt", points=3, where=lambda length, v, run: abs(length / v / run - 1) > 0.05
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
    Then find the mass in the hopper as a function of time, and the mass that lies on the belt when the feeder stops.
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


@exercise(
    "6.5",
    title="A sensor in a pocket",
    points=4,
    where=lambda T_1, T_2, delay: T_1 >= 1.25 * T_2 and T_2 >= 0.4 * T_1 and delay <= 0.5 * T_1,
)
def pocket(
    T_1=between(20, 60, "s", reference=40, step=2),
    T_2=between(8, 40, "s", reference=20, step=2),
    delay=between(2, 20, "s", reference=6, step=1),
):
    """Hot water arrives from a boiler after a delay of {delay}. It warms the wall of a pocket, a lag of {T_1}, and the
    wall warms the sensor in it, a lag of {T_2}. All gains are one. The water at the boiler becomes suddenly warmer.
    Estimate the response time of the sensor. Which share of its way has the sensor gone at this moment, and what is the
    exact response time, the time to 63.2 % of the way?
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


@exercise(
    "6.6",
    title="A tank against pulses",
    points=5,
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
        return c * (1 - exponential(-pulse * F / 60 / volume)) if volume > 0 else c

    return answers(
        T_least=number(-pulse / log(1 - c_max / c), "min", "the least time constant"),
        V=design(
            number((least + largest) / 2, "m³", "the volume of the tank"),
            criterion("the highest concentration above normal", highest, below=c_max, unit="g/L"),
            criterion("the time to 90 %", lambda volume: 60 * volume / F * logarithm(10), below=t_max, unit="min"),
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
