"""Exercises of chapter 4, the Laplace transform."""

import numpy as np
from sympy import Heaviside, Symbol, exp, log

from exercisebook.parameters import written
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    exercise,
    number,
    time_function,
    transfer_function,
    words,
)
from loopbook.expressions import s, t
from loopbook.figures import time_plot


def _apart(value, *others):
    """Whether the value of a mistake differs clearly from the key and from the values of other mistakes."""
    return all(abs(value - other) > 0.03 * abs(other) for other in map(float, others))


def _excess(K, full, warmer):
    """How many times warmer full power would make the oven in the end, compared with what is wanted."""
    return K * full / warmer


@exercise(
    "4.6",
    title="Full power first, then just enough",
    points=5,
    insight="To be there soon, aim beyond the goal, and change over to what holds it at the right moment.",
    where=lambda K, full, warmer: 1.25 <= _excess(K, full, warmer) <= 4 and abs(_excess(K, full, warmer) - 2) > 0.1,
)
def full_power_first(
    K=between(20, 60, "K/kW", reference=40, step=5),
    T=between(10, 40, "min", reference=20, step=1),
    full=between(4, 10, "kW", reference=6, step=0.5),
    warmer=between(80, 240, "K", reference=160, step=10),
):
    r"""An oven has the temperature of the room. Its temperature above that of the room, $y(t)$, follows the power
    $u(t)$ of the heater by

    $$T\,\dot y(t) + y(t) = K\,u(t)$$

    with $K$ = {K} and $T$ = {T}. The oven should become {warmer} warmer than the room, soon, and then stay so. At
    $t = 0$ the heater is switched to its full power, $u_1$ = {full}. At the moment $t_1$, when the temperature is
    reached, it is switched back to a power $u_2$ that just holds it (the picture is not to scale). Transform the power,
    in the symbols $u_1$, $u_2$, $t_1$ and $s$. Then find $u_2$ and $t_1$.
    """
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return answers(
        U=transfer_function(
            u_1 / s + (u_2 - u_1) / s * exp(-t_1 * s),
            "the transform of the power, in the symbols $u_1$, $u_2$, $t_1$ and $s$",
        ),
        u_2=number(warmer / K, "kW", "the power that holds the temperature"),
        t_1=number(T * log(K * full / (K * full - warmer)), "min", "the moment of switching back"),
    )


@full_power_first.picture
def _(full):
    """The power against time: $u_1$ = {full} from t = 0 to $t_1$, and from then on a lower one, $u_2$; this is not to
    scale."""
    power = {"$u$": (float(full) * (1 - 0.45 * Heaviside(t - 1)), "control signal")}
    plot = time_plot(power, np.linspace(0, 2.5, 251), ylim=(0, 1.3 * float(full)), xlabel="$t$", low=True)
    axes = plot.figure.axes[0]
    axes.set_xticks([0, 1], ["0", "$t_1$"])
    axes.set_yticks([0, 0.55 * float(full), float(full)], ["0", "$u_2$", f"$u_1$ = {written(full)} kW"])
    return plot


@full_power_first.mistake("Your power is $u_1 + u_2$ after the switch. How large is the step from $u_1$ to $u_2$?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s + u_2 / s * exp(-t_1 * s)}


@full_power_first.mistake("Your power is $u_1 - u_2$ after the switch. How large is the step from $u_1$ to $u_2$?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s - u_2 / s * exp(-t_1 * s)}


@full_power_first.mistake(
    "The second step is a step as well, only later and of another height. Which factor has it lost?"
)
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s + (u_2 - u_1) * exp(-t_1 * s)}


@full_power_first.mistake("Your power is zero after the switch. Which power holds the oven then?")
def _():
    u_1, t_1 = (Symbol(name, positive=True) for name in ("u_1", "t_1"))
    return {"U": u_1 / s * (1 - exp(-t_1 * s))}


@full_power_first.mistake("Your $u_2$ is there from $t = 0$ on. When is it switched on, and how does a delay look?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s * (1 - exp(-t_1 * s)) + u_2 / s}


@full_power_first.mistake("Your power grows at the switch. From which power to which one does it step there?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s + (u_1 - u_2) / s * exp(-t_1 * s)}


@full_power_first.mistake(
    "After three time constants a lag is nearly at its end. Must the oven wait until then, at full power?"
)
def _(T, K, full, warmer):
    excess = _excess(K, full, warmer)
    return {"t_1": 3 * T} if _apart(3, log(excess), log(excess / (excess - 1))) else {}


@full_power_first.mistake("Under full power the temperature does not rise along a straight line to its end: it bends.")
def _(T, K, full, warmer):
    return {"t_1": T * warmer / (K * full)}


@full_power_first.mistake("The exponential is what is still missing on the way to $Ku_1$, not what has been covered.")
def _(T, K, full, warmer):
    return {"t_1": T * log(K * full / warmer)} if abs(_excess(K, full, warmer) - 1.763) > 0.1 else {}


@full_power_first.mistake(
    "After one time constant, 63 % of the way to $Ku_1$ is covered. Is that the wanted temperature?"
)
def _(T, K, full, warmer):
    excess = _excess(K, full, warmer)
    return {"t_1": T} if _apart(1, log(excess), log(excess / (excess - 1))) else {}


@full_power_first.mistake(
    "After five time constants a lag is at its end. Must the oven wait until then, at full power?"
)
def _(T, K, full, warmer):
    return {"t_1": 5 * T}


@full_power_first.mistake("The inverse of $e^{-t/T}$ is the natural logarithm. Which one have you taken?")
def _(T, K, full, warmer):
    return {"t_1": T * log(K * full / (K * full - warmer)) / log(10)}


@full_power_first.mistake(
    "Kelvin times kelvin for each kilowatt does not make kilowatts. Look at the units of the gain."
)
def _(K, warmer):
    return {"u_2": K * warmer}


@full_power_first.mistake("At rest $Ku_2$ must be the temperature that is wanted. What is $u_2$, then?")
def _(K, warmer):
    return {"u_2": K / warmer}


@full_power_first.mistake("That is the power with which the oven would stay at full power. What does it need at rest?")
def _(full):
    return {"u_2": full}


full_power_first.hints(
    "The power is two steps: one up at the beginning, and one down at $t_1$. The oven follows each step like a lag.",
    "At rest $\\dot y = 0$, so $y = Ku$: that is what $u_2$ must do. Until $t_1$ the oven knows nothing of $u_2$ and "
    "goes to $Ku_1$: $y(t) = Ku_1\\,(1 - e^{-t/T})$.",
    "Full power would make the oven ${K}\\cdot{full}$ kelvin warmer in the end. Set ${K}\\cdot{full}\\,(1 - "
    "e^{-t_1/{T}}) = {warmer}$ and solve for $t_1$.",
)


@full_power_first.solution
def _(K, T, full, warmer):
    r"""**The power** goes up by $u_1$ at $t = 0$, and at $t_1$ it changes by $u_2 - u_1$, which is a step down:

    $$U(s) = \frac{u_1}{s} + \frac{u_2 - u_1}{s}\,e^{-t_1 s}$$

    **To hold** the temperature, nothing may change any more: $\dot y = 0$ and $y = Ku_2$, so $u_2 = {warmer}/{K} =$
    {u_2}.

    **The moment.** Until $t_1$ the oven goes to where full power would take it, which is ${K}\cdot{full} =$ {far},
    far beyond the goal: $y(t) = {far}\,(1 - e^{-t/{T}})$. It is at {warmer} when

    $$e^{-t_1/{T}} = 1 - \frac{ {warmer} }{ {far} } = {left}$$

    and the logarithm gives $t_1 = -{T}\,\ln {left} =$ {t_1}. From then on $y$ is where $u_2$ holds it, and stays
    there.
    """
    return {"far": (K * full, "K"), "left": 1 - warmer / (K * full)}


@full_power_first.solution_picture
def _(K, T, full, warmer):
    """The temperature rises under full power, reaches its goal, and stays; else it would go far beyond."""
    t_1 = T * log(K * full / (K * full - warmer))
    times = np.linspace(0, 3 * float(t_1), 301)
    rising = float(K * full) * (1 - np.exp(-times / float(T)))
    switched = np.where(times < float(t_1), rising, float(warmer))
    curves = {"$y$": (switched, "measurement"), "full power all the time": (rising, "raw")}
    powers = {"$u$": (full - (full - warmer / K) * Heaviside(t - t_1), "control signal")}
    names = ["$y$ [K]", "$u$ [kW]"]
    return time_plot([curves, powers], times, xlabel="$t$ [min]", ylabel=names).event(t_1, "$t_1$")


@exercise(
    "4.7",
    title="A pole by ruler",
    points=4,
    where=lambda start, end: abs(start - end) >= 30,
    insight="A curve shows its transform: where it begins, where it ends, and how far left its pole is.",
)
def pole_by_ruler(
    start=between(15, 95, "°C", reference=80, step=1),
    end=between(15, 95, "°C", reference=30, step=1),
    T=between(4, 25, "s", reference=10, step=1),
):
    r"""A temperature sensor is moved from one bath into another, at $t = 0$. The picture shows its reading $y(t)$,
    in °C with the time in seconds. Its transform has two poles, one at zero and one to the left of it.

    Read with a ruler: which value does $y$ have at $t = 0$, and to which one does it tend? Where is the pole to the
    left? And what is the transform $Y(s)$, with the numbers that you have read? (Leave the units out of it. You can
    check it: at $s \to 0$, $sY(s)$ must tend to where the curve ends, and at $s \to \infty$ to where it begins.)

    (`t, y = exercise("4.7").given("t", "y")` are the times [s] and readings [°C] of the picture.)
    """
    return answers(
        y_0=number(start, "°C", "the reading at the beginning", within=0.05),
        y_s=number(end, "°C", "the reading in the end", within=0.05),
        pole=number(-1 / T, "1/s", "the pole to the left", within=0.1),
        Y=transfer_function((start * s + end / T) / (s * (s + 1 / T)), "the transform of the reading", within=0.1),
    )


def _reading(start, end, T):
    times = np.linspace(0, 6 * float(T), 301)
    return times, float(end) + float(start - end) * np.exp(-times / float(T))


@pole_by_ruler.shows
def _(start, end, T):
    times, readings = _reading(start, end, T)
    return {"t": times, "y": readings}


@pole_by_ruler.picture
def _(start, end, T):
    """The reading goes from one level to another, fast at first and then more and more slowly."""
    times, readings = _reading(start, end, T)
    return time_plot({"$y$": (readings, "measurement")}, times, "The sensor changes baths", ylabel="$y$ [°C]")


def _with_pole(pole, start, end):
    """Pole and transform of somebody who has both levels right; where the way is short, a ruler takes any pole."""
    is_long = abs(start - end) >= max(start, end) * 7 / 10
    return {"pole": pole} | ({"Y": end / s + (start - end) / (s - pole)} if is_long else {})


@pole_by_ruler.mistake("That is the time constant. Where is the pole of something that dies out with it?")
def _(T):
    return {"pole": T}


@pole_by_ruler.mistake("That is a time, with a minus. Which pole belongs to something that dies out with it?")
def _(start, end, T):
    return _with_pole(-T, start, end)


@pole_by_ruler.mistake("The curve dies out. On which side of the imaginary axis is its pole?")
def _(T):
    return {"pole": 1 / T}


@pole_by_ruler.mistake(
    "By the time from which that comes, about half of the way is covered. How much is it after a time constant, and "
    "counted from where?"
)
def _(T):
    return {"pole": -1 / (T * log(2))}


@pole_by_ruler.mistake(
    "By the time from which that comes, about 37 % of the way are covered. How much is it after a time constant, and "
    "counted from where?"
)
def _(start, end, T):
    return _with_pole(1 / (T * log(0.632)), start, end)


@pole_by_ruler.mistake(
    "That is the time after which hardly anything is left of the way. After how many time constants is that?"
)
def _(start, end, T):
    return _with_pole(-1 / (4 * T), start, end)


@pole_by_ruler.mistake("Is that 63 % of the way from the beginning to the end, or of a temperature?")
def _(start, end, T):
    left = (0.368 * max(start, end) - (end if start > end else 0)) / abs(start - end)
    after = -log(left) if left > 0.01 else 0
    told = after and all(abs(after / n - 1) > 0.25 for n in (1, 0.693, 0.459, 4))
    return _with_pole(-1 / (T * after), start, end) if told else {}


@pole_by_ruler.mistake("Where does the signal that belongs to your transform begin? Add its two parts at $t = 0$.")
def _(start, end, T):
    return {"Y": end / s + start / (s + 1 / T)}


@pole_by_ruler.mistake("A constant signal is a step: which transform has the value where the curve ends?")
def _(start, end, T):
    return {"Y": end + (start - end) / (s + 1 / T)}


@pole_by_ruler.mistake("That is a reading that begins at zero. Where does this one begin?")
def _(end, T):
    return {"Y": end / T / (s * (s + 1 / T))}


@pole_by_ruler.mistake("What belongs to your transform ends at zero. Which pole keeps a signal at a value?")
def _(start, end, T):
    return {"Y": (start - end) / (s + 1 / T)}


@pole_by_ruler.mistake("Where does the signal that belongs to your transform begin? Add its two parts at $t = 0$.")
def _(start, end, T):
    return {"Y": end / s + (end - start) / (s + 1 / T)}


@pole_by_ruler.mistake("What belongs to your transform runs away: one of its poles is on the right.")
def _(start, end, T):
    return {"Y": (start * s - end / T) / (s * (s - 1 / T))}


@pole_by_ruler.mistake(
    "Beginning and end are interchanged in your transform. Which of them belongs to the pole at zero?"
)
def _(start, end, T):
    return {"Y": (end * s + start / T) / (s * (s + 1 / T))}


pole_by_ruler.hints(
    "A pole at zero is a constant, and a pole at $-1/T$ is an exponential with the time constant $T$. The reading is "
    "the sum of the two.",
    "After one time constant, 63 % of the way from the beginning to the end are covered. So read both levels, go 63 "
    "% of the way from one to the other, and look when the curve is there.",
    "With $y_0$ and $y_s$ as you have read them, $y(t) = y_s + (y_0 - y_s)\\,e^{-t/T}$, and so "
    "$Y(s) = \\frac{{y_s}}{s} + \\frac{y_0 - y_s}{s + 1/T}$.",
)


@pole_by_ruler.solution
def _(start, end, T):
    r"""The curve begins at {y_0} and tends to {y_s}: that is a way of {way}. After one time constant, 63 % of it
    are covered, so the reading is at {after_T}. It is there at $t$ = {T}. The pole is at $-1/{T} =$ {pole}.

    In time, the reading is a constant and an exponential that dies out, $y(t) = {end} + ({start} -
    {end})\,e^{-t/{T}}$. Each has its line in the table:

    $$Y(s) = \frac{ {end} }{s} + \frac{ {start} - {end} }{s + {rate} } = \frac{ {start}\,s + {both} }{s\,(s + {rate})}$$

    The check: $sY(s)$ tends to ${both}/{rate} = {end}$ for $s \to 0$, where the curve ends. For $s \to \infty$ only
    the highest powers count, and ${start}$ is left, where it begins.
    """
    return {
        "way": (end - start, "K"),
        "after_T": (float(start) + 0.632 * float(end - start), "°C"),
        "rate": float(1 / T),
        "both": float(end / T),
    }


@pole_by_ruler.solution_picture
def _(start, end, T):
    """The picture of the statement, with the end and the moment at which 63 % of the way are covered."""
    times, readings = _reading(start, end, T)
    plot = time_plot({"$y$": (readings, "measurement")}, times, "63 % of the way", ylabel="$y$ [°C]")
    return plot.level(end, "the end").mark(T, "one time constant")
